// Points of a study against others, pair by pair, printed and as CSV.
#ifndef LD_STUDIES_SHOW_AGAINST_H
#define LD_STUDIES_SHOW_AGAINST_H

#include <stdio.h>

#include "studies/against.h"

// What is compared: these results, and the areas of ellipses of two of them.
typedef struct show_against {
    const against *of;
    const study_column *const *column; // [count]
    int count;
    study_values values[2]; // read last, to be freed
    int64_t compared;       // results of which there were two pairs or more
} show_against;

// Prints how far a point is from its reference: mean differences, ratios of standard deviations, of
// all pairs and within samples, ratios of the areas of ellipses; with intervals.
ld_status show_against_point(show_against *self, const study_point *point, FILE *stream,
                             ld_error *error);

// The same of all points as CSV, in full precision, a line for each point and result.
ld_status show_against_csv(show_against *self, FILE *stream, ld_error *error);

#endif
