// What is asked of a result over swept keys: "mean", "deviation", "quantile:0.95",
// "share:>5 mrad/s", "footprint:0.99".
#ifndef LD_STUDIES_OVER_STATISTIC_H
#define LD_STUDIES_OVER_STATISTIC_H

#include "quantities/study_results.h"
#include "studies/points/over.h"

typedef enum over_kind {
    OVER_MEAN,
    OVER_DEVIATION,
    OVER_QUANTILE,
    OVER_SHARE,
    OVER_FOOTPRINT
} over_kind;

typedef struct over_statistic {
    over_kind kind;
    double level;   // of a quantile; of landings within a footprint
    bool above;     // a share counts what is above the limit; else what is below
    char limit[48]; // of a share, as it is written
} over_statistic;

// @param text NULL: the mean
ld_status over_statistic_read(const char *text, over_statistic *statistic, ld_error *error);

// The columns that the statistic is of: `column`, or the landing points.
// @return LD_OK, LD_ERR_INPUT (the study has no landing points)
ld_status over_statistic_columns(const over_statistic *self, const study_data *data,
                                 const study_column *result, const study_column *column[2],
                                 int *columns, ld_error *error);

// What was found in a cell, in SI; of a share its number, 0 to 1. Of differences from points of
// reference: the difference of means, of shares; the ratio of deviations.
typedef struct over_found {
    estimate of;
    size_t count, groups; // rockets or pairs of them, independent groups
    int points;           // that have them
    bool reference;       // the cell is one of reference
} over_found;

// @return LD_OK, LD_ERR_INPUT (the limit's unit is another one; no differences of this statistic),
//         LD_ERR_FILE, LD_ERR_MEMORY
ld_status over_find(over *self, int cell, const over_statistic *statistic,
                    const study_column *result, over_found *found, ld_error *error);

// "standard deviation"; of differences "ratio".
const char *over_statistic_word(const over *self, const over_statistic *statistic);

// What an estimate of a cell of reference is: 0, of a ratio 1.
double over_statistic_same(const over_statistic *statistic);

// "standard deviation of pitch_rate", with the unit in which it is read.
study_unit over_statistic_text(const over *self, const over_statistic *statistic,
                               const study_column *result, char *text, size_t size);

#endif
