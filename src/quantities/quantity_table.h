// The tables of quantities: walked in their order, asked by name, made into columns, saved.
#ifndef LD_QUANTITIES_QUANTITY_TABLE_H
#define LD_QUANTITIES_QUANTITY_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/archive.h"
#include "launchdyn/model.h"
#include "launchdyn/results.h"
#include "model/blocks/limits.h"
#include "model/quantity.h"

// How many there are of each, and their names: that of item i stands i * stride behind the first;
// NULL: they are numbered from 1.
typedef struct quantity_things {
    int count[EACH_COUNT];
    const char *name[EACH_COUNT];
    size_t stride[EACH_COUNT]; // [bytes]
    bool launcher;             // there is one
    const ld_model *model;     // whose they are
} quantity_things;

// Those of a model, which must outlive them (NULL: none); coordinates are of the tube as built.
quantity_things quantity_things_of(const ld_model *model);

const char *quantity_name_of(const quantity_things *things, quantity_each each, int item);
// The item of that name; -1: there is none.
int quantity_item_named(const quantity_things *things, quantity_each each, const char *name);

// The longest name: the longest of a row with the longest of a thing.
enum { QUANTITY_NAME = 2 * LD_MAX_NAME, QUANTITY_TEXT = 96 + LD_MAX_NAME };

// Writes `text` with the name of item `item` in the place of %s.
void quantity_text(const char *text, quantity_each each, int item, const quantity_things *things,
                   char *to, size_t size);

// A way through a table in its order; after the last, `row` is NULL.
typedef struct quantity_walk {
    const quantity_table *table;
    const quantity_things *things;
    int at_group, at_row;
    const quantity_group *group;
    const quantity *row;
    int item; // of the group's things, from 0
} quantity_walk;

quantity_walk quantity_first(const quantity_table *table, const quantity_things *things);
void quantity_next(quantity_walk *walk);

// The quantity of that name; row NULL: there is none.
quantity_walk quantity_find(const quantity_table *table, const quantity_things *things,
                            const char *name);

// The row that the name is one of, whatever the things are called; NULL: none.
const quantity *quantity_like(const quantity_table *table, const char *name);

// Its value in the struct that the table is about; NaN where its group is not there.
double quantity_value(const quantity_walk *at, const void *from);
bool quantity_is_there(const quantity_group *group, const void *from);
double quantity_number(const quantity_place *place, int item, const void *from);
void quantity_put(const quantity_place *place, int item, double value, void *in);
// Saves or loads the numbers of a struct that the table has and that are there; not the whole ones.
void quantity_archive(const quantity_table *table, const quantity_things *things, void *in,
                      archive *bytes);

// Where a column's number is found in the struct; where not 0, it is there if that bool is set.
typedef struct quantity_cell {
    size_t offset, where; // [bytes]
} quantity_cell;

// A column each, in order, of tables that have numbers alone.
typedef struct quantity_columns {
    int count;
    ld_column *column;
    quantity_cell *cell;
    char *text; // of names and descriptions that say of which
} quantity_columns;

// A table, and where the struct that it is about stands in that of all; NULL: nothing.
typedef struct quantity_part {
    const quantity_table *table;
    size_t offset; // [bytes]
} quantity_part;

ld_status quantity_columns_make(quantity_columns *self, const quantity_part *parts, int part_count,
                                const quantity_things *things, ld_error *error);
void quantity_columns_free(quantity_columns *self);
// The values of all columns, NaN of those that are not there.
void quantity_row(const quantity_columns *self, const void *from, double *row);

#endif
