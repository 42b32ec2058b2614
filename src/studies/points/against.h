// A study's points against points of reference: which point each is compared with, the pairs of
// rockets that drew the same numbers at both.
#ifndef LD_STUDIES_AGAINST_H
#define LD_STUDIES_AGAINST_H

#include "studies/plan/pairs.h"
#include "studies/store/study_data.h"

// Which point a point is compared with, as asked for: by its number, or by values of swept keys,
// "firing.interval=1 s,base.speed=0 km/h", where a point keeps its own values of the other keys.
typedef struct against {
    const study_data *data;
    const study_point *fixed; // of a number
    const char **value;       // [swept_count] else the values asked for; NULL: each point its own
} against;

// @param self to be freed; empty on failure
// @return LD_OK, LD_ERR_INPUT (one point only, no such point, key or value), LD_ERR_MEMORY
ld_status against_read(const char *text, const study_data *data, against *self, ld_error *error);
void against_free(against *self);

// The point that this one is compared with; itself where it is one of reference.
const study_point *against_reference(const against *self, const study_point *point);

// A point of a study, and the one that it is compared with.
typedef struct paired_points {
    const study_data *data;
    const study_point *point, *reference;
} paired_points;

// Reads one result, or two, of the rockets that have them at both points, paired by sample and
// place in the order of firing: the same numbers are drawn for both.
// @param values of the point and of its reference, used again from call to call; `pairs` stands in
//               them
ld_status against_read_pairs(const paired_points *points, const study_column *const *column,
                             int columns, study_values values[2], paired_values *pairs,
                             ld_error *error);

#endif
