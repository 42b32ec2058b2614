// Words in which the rows of field tables are written.
#ifndef LD_MODEL_FIELD_ROWS_H
#define LD_MODEL_FIELD_ROWS_H

#include "model/fields/field.h"
#include "model/model.h"

// Kinds, with the member of the block's struct that holds the value.
#define VECTOR(type, member, unit_, n)                                                             \
    .kind = FIELD_NUMBER, .offset = offsetof(type, member), .count = (n), .unit = (unit_)
#define NUMBER(type, member, unit_) VECTOR(type, member, unit_, 1)
#define INTEGER(type, member, least_, most_)                                                       \
    .kind = FIELD_INTEGER, .offset = offsetof(type, member), .range = {least_, most_, 0, 0}
#define WORD(type, member) .kind = FIELD_WORD, .offset = offsetof(type, member)
#define QUANTITY(type, member) .kind = FIELD_QUANTITY, .offset = offsetof(type, member)
#define CHOICE(type, member, words_)                                                               \
    .kind = FIELD_CHOICE, .offset = offsetof(type, member), .words = (words_)
#define BLOCK(type, member, block_)                                                                \
    .kind = FIELD_BLOCK, .offset = offsetof(type, member), .block = &(block_)
#define SAME_STRUCT(block_) .kind = FIELD_BLOCK, .offset = 0, .block = &(block_)
#define SWITCH(type, member, words_) .words = (words_), .other = offsetof(type, member)
#define LIST(type, entries, counter, block_, least_, most_)                                        \
    .kind = FIELD_LIST, .offset = offsetof(type, entries), .other = offsetof(type, counter),       \
    .stride = sizeof(((type *)0)->entries[0]), .block = &(block_), .least = (least_),              \
    .count = (most_)
#define INTEGERS(type, entries, counter, least_, most_, count_)                                    \
    .kind = FIELD_INTEGERS, .offset = offsetof(type, entries), .other = offsetof(type, counter),   \
    .range = {least_, most_, 0, 0}, .count = (count_)
#define SELECTION(type, entries, counter, entry, mark_)                                            \
    .kind = FIELD_SELECTION, .offset = offsetof(type, entries), .other = offsetof(type, counter),  \
    .stride = sizeof(entry), .mark = offsetof(entry, mark_)
#define TABLE(type, member, format_)                                                               \
    .kind = FIELD_TABLE, .offset = offsetof(type, member), .table = &(format_)

// Ranges.
#define ANY .range = {-INFINITY, INFINITY, 1, 1}
#define POSITIVE .range = {0, INFINITY, 1, 1}
#define NOT_NEGATIVE .range = {0, INFINITY, 0, 1}
#define FROM_TO(low_, high_) .range = {low_, high_, 0, 0}
#define ABOVE_TO(low_, high_) .range = {low_, high_, 1, 0}
#define INSIDE(low_, high_) .range = {low_, high_, 1, 1}

// Presence.
#define REQUIRED .required = true, .initial = NAN
#define DEFAULT(value) .initial = (value)
#define NO_DEFAULT(text) .initial = NAN, .initial_doc = (text)

#define FORM(form) (1u << (form))

#endif
