// The scenario language as tables: one table a block, one row a key, each with its unit, default,
// allowed range, place in ld_model and one line of documentation. The reader, the printer, the
// checks and docs/scenario.md all work from these tables.
#ifndef LD_MODEL_FIELD_H
#define LD_MODEL_FIELD_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "model/blocks/limits.h"

typedef enum field_kind {
    FIELD_NUMBER,     // `count` doubles with one unit
    FIELD_INTEGER,    // int
    FIELD_INTEGERS,   // array of int, their number at `other`
    FIELD_WORDS,      // unsigned: a bit, its value, for each of some `words`, or `all`
    FIELD_WORD,       // char[LD_MAX_NAME], a name
    FIELD_QUANTITY,   // char[LD_MAX_QUANTITY], names joined by points
    FIELD_TEXT,       // char *, owned by the model
    FIELD_FILE,       // char *, owned by the model, the full path of a file that is not text; at
                      // `other` a text, its digest, of a row before
    FIELD_CHOICE,     // enum: one of `words`
    FIELD_BLOCK,      // keys of `block`
    FIELD_LIST,       // array of structs described by `block`, their number at `other`
    FIELD_SELECTION,  // some entries of a list read before, by their names or `all`: the bool at
                      // `mark` of each entry, whose name stands first in it
    FIELD_TABLE,      // ld_table
    FIELD_FACTORS,    // ld_factor *, owned by the model, their number at `other`: distributions by
                      // path
    FIELD_CORRELATED, // ld_correlated *, owned by the model, their number at `other`
    FIELD_UNTIL,      // array of ld_until, their number at `other`
    FIELD_BOUNDS,     // array of ld_bounds, their number at `other`
    FIELD_LIMIT,      // double of an ld_aim, in the unit of its result; NaN: not given
    FIELD_SWEEP,      // ld_sweep_axis *, owned by the model, their number at `other`
} field_kind;

// Numbers between `low` and `high`, the ends belonging to it unless open.
typedef struct field_range {
    double low, high;
    bool open_low, open_high;
} field_range;

// A word and what it stands for. The name "" stands for "something else is given": a number (of a
// choice, stored at `other`) or a block (its switch at `other`).
typedef struct field_word {
    const char *name;
    int value;
} field_word;

enum { FIELD_WORD_REFUSED = -2 }; // what was chosen is not a word of the choice

// What is allowed in place of a table's rows.
enum table_source {
    TABLE_CONSTANT = 1,  // one value, of the last column
    TABLE_CSV = 2,       // a CSV file whose header names columns and units
    TABLE_ENGINE = 4,    // a RASP .eng file
    TABLE_BARE = 8,      // the CSV file may do without a header: numbers in SI
    TABLE_SOUNDING = 16, // a sounding (scenario/sounding_file.c)
    TABLE_ROCKSIM = 32,  // a RockSim .rse file (scenario/rocksim_file.c)
    TABLE_MESH = 256,    // a binary glTF 2 file (scenario/mesh_file.c)
};

// What else holds of a table, in the same word.
enum table_trait {
    TABLE_CLOCK = 64,       // its first column is a clock, whose origin stands apart
    TABLE_QUATERNION = 128, // its last four columns are a unit quaternion
    TABLE_GROUPS = 512,     // its first column rises from group to group of rows
};

enum { FIELD_MAX_COLUMNS = 13 };

typedef struct table_format {
    unsigned sources; // any of table_source and table_trait
    int columns;
    const struct field_row *column;   // name, unit and range of each
    const struct table_format *other; // another form, of more columns, or NULL
} table_format;

typedef struct field_row {
    const char *name;
    field_kind kind;
    bool required;
    unsigned optional;       // bit f: not required in form f, where it says nothing
    size_t counted;          // while the int there is 0; 0: it says something anyhow
    size_t offset;           // in the block's struct; FIELD_NOWHERE: nothing is stored
    size_t other;            // list: its count; choice: its number; block with words: its switch;
                             // table of a wind: its axes, read before; of a clock: its origin
    bool other_is_bool;      // the switch is a bool, not an enum
    size_t stride;           // list, selection: size of one entry
    size_t mark;             // selection: place of the mark in an entry
    int count;               // number: how many; list, integers: most entries
    int least;               // list, integers: fewest entries
    bool silent;             // list, block with words: not printed where it is empty
    const char *unit;        // SI, "" without
    double initial;          // default in SI; NaN: none
    const double *initials;  // number: default of each, where they differ
    const char *initial_doc; // default in words, where `initial` is not it, or what holds where the
                             // key is optional
    field_range range;
    const field_word *words;
    const struct field_block *block;
    const struct field_row *alternative; // list: the block that is allowed in its place, whose
                                         // switch says whether it does; or NULL
    const table_format *table;
    unsigned forms; // bit f: the key goes with form f of its block; 0: with every form
    const char *doc;
} field_row;

#define FIELD_NOWHERE ((size_t)-1)

typedef struct field_block {
    const field_row *fields; // ends with a row without name
    const field_word *form;  // the block's forms; NULL: it has but one
    size_t form_offset;      // where the form is stored
    bool form_from_keys;     // the form follows from the keys given
    const char *form_key;    // else it is a key of its own: its path; NULL: see the form's name
    const char *last_form;   // this key, where given, makes the last form hold; NULL: none does
    bool shared_value;       // one number in place of the block gives all its numbers
} field_block;

extern const field_block scenario_block; // the root
extern const field_block tubes_block;    // of ld_tubes

// The row of key `name`, or NULL.
const field_row *field_find(const field_block *block, const char *name);
// The word of that name in a list that ends with a NULL name, or NULL.
const field_word *field_word_find(const field_word *words, const char *name);
// The word that stands for `value`, or NULL.
const field_word *field_word_of(const field_word *words, int value);

// The key or the word that an unknown one probably means, or NULL.
const char *field_nearest_key(const field_block *block, const char *key);
const char *field_nearest_word(const field_word *words, const char *name);

// Pointers into the struct `base` that a block describes.
void *field_at(void *base, const field_row *field);
const void *field_at_const(const void *base, const field_row *field);
// The value that chooses among `words` of a block, and its setter.
int field_switch(const void *base, const field_row *field);
void field_set_switch(void *base, const field_row *field, int value);
// The form of `block` that holds in `base`; 0 where it has but one.
int field_form(const field_block *block, const void *base);
// Whether the key goes with form `form` of its block.
bool field_has_form(const field_row *field, int form);
// Whether the key must be given in form `form`.
bool field_is_required(const field_row *field, int form);
// Whether the key says nothing in the block's struct, which is in form `form`.
bool field_is_absent(const field_row *field, const void *base, int form);

// Sets every value of the block to its default (recursively; tables and lists empty).
void field_initialise(const field_block *block, void *base);
// Frees the texts and tables of the block.
void field_release(const field_block *block, void *base);

// Whether the key has the same value, to the bit, in two structs of its block: numbers, choices,
// blocks and lists of them. Keys of other kinds are never the same.
bool field_same(const field_row *field, const void *a, const void *b);

// Entry `i` of a list or selection.
void *field_entry(void *base, const field_row *field, int i);
const void *field_entry_const(const void *base, const field_row *field, int i);
// Whether entry `i` belongs to a selection, and its setter.
bool field_marked(const void *base, const field_row *field, int i);
void field_set_mark(void *base, const field_row *field, int i, bool mark);
// The form of a table that has so many columns, or NULL.
const table_format *field_table_format(const table_format *format, size_t columns);
// Where the origin [s] of a table's clock stands; NULL: it has none.
double *field_clock(void *base, const field_row *field);
// Whether four numbers are a unit quaternion as measured ones are, to 0.01.
bool field_is_unit(const double quaternion[4]);
#define NO_UNIT_QUATERNION "the last four numbers are not a unit quaternion, within 0.01"

// A number of a model: any scalar key or component.
typedef struct field_place {
    const field_row *row;
    size_t offset;          // in ld_model
    bool whole;             // an int, else a double
    char path[LD_MAX_PATH]; // list members by name where they have one
} field_place;

// Finds the number of `model` with the path of keys; false: `why` says what is wrong with the path.
bool field_locate(const ld_model *model, const char *path, field_place *place, char *why,
                  size_t size);
// The value of a key, whatever it is: its row and the struct that it is in.
typedef struct field_value {
    const field_row *row;
    const void *base;
} field_value;

// Finds the value of `model` with the path of keys; false: `why` says what is wrong with the path,
// or that it leads to a member of a list.
bool field_reach(const ld_model *model, const char *path, field_value *value, char *why,
                 size_t size);

double field_get(const ld_model *model, const field_place *place);
// The number with the path of keys; NaN where the model has none.
double field_number(const ld_model *model, const char *path);
void field_set(ld_model *model, const field_place *place, double value);

bool field_in_range(field_range range, double value);
// "> 0 kg", "0 to 1"; "" where all is allowed. Angles in degrees.
void field_range_text(const field_row *field, char *text, size_t size);
// What a value of this key looks like: "a number with a unit of kg, > 0 kg".
enum { FIELD_EXPECTATION = 384 }; // room that is enough for any
void field_expectation(const field_row *field, char *text, size_t size);
// The shortest decimal number that reads back to the same bits.
void field_number_text(double value, char text[32]);

// Rules that tie several keys together; `report` is called for each one broken, with the path of
// the key that it is about (list members by number; after "@" a character of its text, from 0). A
// value that was refused already is marked by NaN, a choice by FIELD_WORD_REFUSED.
typedef void rule_report(void *self, const char *path, const char *text);
void model_check_rules(const ld_model *model, rule_report *report, void *self);

// The tables as Markdown, for docs/scenario.md.
void field_write_markdown(FILE *stream);

#endif
