// A result over the values of one swept key or of two, the points that have these values taken
// together (pooled.h).
#ifndef LD_STUDIES_OVER_H
#define LD_STUDIES_OVER_H

#include "studies/points/pooled.h"

enum { OVER_KEYS = 2 };

// The values of a swept key, each once, in the order of the sweep.
typedef struct over_key {
    int axis; // among the swept keys
    const char *name;
    int count;
    const char **text; // [count]
    bool numeric;      // all are numbers of one kind
    char unit[32];     // of numbers: as the first is written, "" without
    double *number;    // [count] of numbers, in that unit
} over_key;

typedef struct over {
    const study_data *data;
    int count; // keys; 0: of each point, by all its keys
    over_key key[OVER_KEYS];
    against reference; // of differences; without data: none
    pooled pool;
} over;

// Opens the keys that the text names, "base.speed" or "base.speed,firing.interval", and the points
// of reference (NULL: none). Without keys each point stands alone. By number POINT stands for its
// values of these keys; other keys are those of each point.
// @param self to be closed in any case
// @return LD_OK, LD_ERR_INPUT (no sweep, no such key, no such point), LD_ERR_MEMORY
ld_status over_open(const char *keys, const char *point, const study_data *data, over *self,
                    ld_error *error);
void over_close(over *self);

// How many keys a cell has, and their names.
int over_key_count(const over *self);
const char *over_key_name(const over *self, int k);

// Combinations of the keys' values, the first key varying most slowly; of each the value `k`.
int over_cell_count(const over *self);
int over_value_of(const over *self, int cell, int k);
const char *over_text(const over *self, int cell, int k);

// Pools the points of a cell that have the columns, of differences those that are not their own
// reference. No rows: there are none.
ld_status over_pool(over *self, int cell, const study_column *const *column, int columns,
                    ld_error *error);
// Whether all points of the cell are ones of reference.
bool over_is_reference(const over *self, int cell);

// "base.speed 0 km/h": what differences are from.
void over_reference_text(const over *self, char *text, size_t size);

// "pooled over base.speed (3 values), firing.order (2)", "" where nothing is.
void over_pooled_text(const over *self, char *text, size_t size);

#endif
