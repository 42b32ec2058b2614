// Numbers of the report of studies: histograms, places, points, and how they are written.
#ifndef LD_REPORT_REPORT_STUDY_NUMBERS_H
#define LD_REPORT_REPORT_STUDY_NUMBERS_H

#include <stdio.h>

#include "studies/statistics/statistics.h"

enum { REPORT_BINS = 80, REPORT_PLACES = 60 };

// Bins of the same width for all series.
typedef struct study_bins {
    double from, width;
    int count;
} study_bins;

// Bins for values, each series' sorted: the width of Freedman and Diaconis (2 IQR n^(-1/3)) for the
// series that requires the finest, at most REPORT_BINS. count 0: there are no values.
study_bins study_choose_bins(const double *const *sorted, const size_t *count, int series);
// How many of the values lie in each bin; the last one has its upper end too.
void study_fill_bins(const study_bins *bins, const double *sorted, size_t count, long *in_bin);

// Numbers of independent groups at which estimates are shown as the study grows, from 2 to all of
// them, evenly spaced in their logarithm; at most `most`. Returns how many.
int study_choose_places(size_t groups, int most, size_t *place);

// Whether a plot that holds about `most` of `count` points shows this one; depends on its number
// only.
bool study_shows_point(int64_t sample, int rocket, size_t count, size_t most);

// Writes a number with eight digits, enough to draw; null where there is none.
void study_write_short(FILE *json, double value);
// One of a list of estimates, each as [value, low, high].
typedef void study_write_number(FILE *json, double value);
void study_write_estimate(FILE *json, int index, estimate e, study_write_number *write);

#endif
