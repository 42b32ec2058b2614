// Points of a study against others, pair by pair, one by one: as CSV, for JSON.
#ifndef LD_STUDIES_SHOW_AGAINST_H
#define LD_STUDIES_SHOW_AGAINST_H

#include <stdio.h>

#include "studies/points/against.h"

// What is compared: these results, and the areas of ellipses of two of them.
typedef struct show_against {
    const against *of;
    const study_column *const *column; // [count]
    int count;
    study_values values[2]; // read last, to be freed
    int64_t compared;       // results of which there were two pairs or more
} show_against;

// What is found at a point, item by item: of a result (columns 1), or of the areas of the ellipses
// of two (columns 2).
typedef void show_against_sink(void *sink, const study_column *const *column, int columns,
                               const paired_statistics *of);

// Hands over the differences of a point from its reference, those of less than two pairs left out;
// of one of reference, none.
ld_status show_against_each(show_against *self, const study_point *point, show_against_sink *take,
                            void *sink, ld_error *error);

// Mean differences, ratios of standard deviations, of all pairs and within samples, ratios of the
// areas of ellipses, with intervals: of all points as CSV, in full precision, a line for each point
// and result.
ld_status show_against_csv(show_against *self, FILE *stream, ld_error *error);

#endif
