// A quantity is written once, as a row of a table: how it is called, what it is, where its number
// stands. From the rows follow columns, the numbers of summary.json, the table after a run, what a
// study keeps of a rocket (`studied`), docs/quantities.md, and what a program finds by name.
// Tables: launch_quantities (history.c) and flight_history.c of an instant, summary_quantities.c of
// a summary.
#ifndef LD_SIMULATION_QUANTITY_H
#define LD_SIMULATION_QUANTITY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/archive.h"
#include "launchdyn/results.h"
#include "model/model.h"

// What there is one of each: a run; a vehicle, where the base is one; a round or WGS 84 Earth; then
// several.
typedef enum quantity_each {
    EACH_RUN,
    EACH_VEHICLE,
    EACH_EARTH,
    EACH_COORDINATE, // modal, of the tube
    EACH_ADAPTOR,
    EACH_HINGE, // azimuth, elevation
    EACH_WHEEL,
    EACH_COUNT
} quantity_each;

// A number in the struct that a table is about.
typedef struct quantity_place {
    enum { QUANTITY_NONE, QUANTITY_NUMBER, QUANTITY_INT, QUANTITY_INT64, QUANTITY_BOOL } type;
    size_t offset, stride; // [bytes] stride: from one of several to the next
} quantity_place;

#define QUANTITY_TYPE(of)                                                                          \
    _Generic((of), double                                                                          \
             : QUANTITY_NUMBER, int                                                                \
             : QUANTITY_INT, int64_t                                                               \
             : QUANTITY_INT64, bool                                                                \
             : QUANTITY_BOOL)
// The member of a struct; a member of each item of an array in it, or the item itself.
#define QUANTITY_AT(type, member)                                                                  \
    {                                                                                              \
        QUANTITY_TYPE(((type *)0)->member), offsetof(type, member), 0                              \
    }
#define QUANTITY_OF_EACH(type, array, member)                                                      \
    {                                                                                              \
        QUANTITY_TYPE(((type *)0)->array[0].member), offsetof(type, array[0].member),              \
            sizeof(((type *)0)->array[0])                                                          \
    }
#define QUANTITY_EACH_OF(type, array)                                                              \
    {                                                                                              \
        QUANTITY_TYPE(((type *)0)->array[0]), offsetof(type, array), sizeof(((type *)0)->array[0]) \
    }

// How the table after a run shows it.
typedef struct quantity_line {
    const char *label; // NULL: not shown, or as the second number of the line before it
    const char *unit;
    double factor; // from SI
    int digits;    // after the point
    bool beside;   // the second number of the line before it
    bool nonzero;  // shown only where it is not 0
} quantity_line;

typedef struct quantity {
    const char *name; // %s: of which
    const char *unit; // SI; "" or "1": none
    const char *description;
    quantity_place at;
    const char *json; // path in summary.json, where that is not the name; [] at its end: in a list
    bool studied;     // kept by a study
    bool from_zero;   // a greatest value or a sum, 0 at first; others are NaN until they are known
    quantity_line line; // label with %s: of which
} quantity;

// Rows that are there together, of one or, item by item, of several.
typedef struct quantity_group {
    quantity_each each;
    const char *title; // in docs/quantities.md
    const quantity *row;
    int rows;
    quantity_place where; // there only where this is not 0
    bool launch;          // not of a flight alone
    int block;            // of lines in the table after a run
    bool backwards;       // there the last item comes first
} quantity_group;

#define QUANTITY_ROWS(list) .row = list, .rows = sizeof(list) / sizeof *(list)

typedef struct quantity_table {
    const quantity_group *group;
    int groups;
} quantity_table;

// How many there are of each, and their names: that of item i stands i * stride behind the first;
// NULL: they are numbered from 1.
typedef struct quantity_things {
    int count[EACH_COUNT];
    const char *name[EACH_COUNT];
    size_t stride[EACH_COUNT]; // [bytes]
    bool launcher;             // there is one
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

// A column each, in order, of a table that has numbers alone.
typedef struct quantity_columns {
    int count;
    ld_column *column;
    quantity_cell *cell;
    char *text; // of names and descriptions that say of which
} quantity_columns;

ld_status quantity_columns_make(quantity_columns *self, const quantity_table *table,
                                const quantity_things *things, ld_error *error);
void quantity_columns_free(quantity_columns *self);
// The values of all columns, NaN of those that are not there.
void quantity_row(const quantity_columns *self, const void *from, double *row);

#endif
