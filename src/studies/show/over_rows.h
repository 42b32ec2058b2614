// Results over the values of swept keys, row by row, in the order in which they are shown.
#ifndef LD_STUDIES_SHOW_OVER_ROWS_H
#define LD_STUDIES_SHOW_OVER_ROWS_H

#include "studies/points/over_statistic.h"
#include "studies/show/shown.h"

// What is asked of all of them.
typedef struct over_asked {
    over of;
    bool chosen; // a statistic is asked for
    over_statistic statistic;
} over_asked;

// The keys that a view asks for; of differences without keys those that POINT names; of a point by
// its number every point by itself.
// @param asked to be closed in any case
ld_status over_rows_open(const shown *self, over_asked *asked, ld_error *error);
void over_rows_close(over_asked *asked);

// A result, or two of them, at a cell; estimates in SI.
typedef struct over_row {
    int item; // counts the results, or pairs of them
    const study_column *column[2];
    int columns;
    int cell;
    size_t count, groups;     // rockets or pairs of them, independent groups
    int points;               // that have them
    estimate found;           // of the statistic that is asked for
    estimate mean, deviation; // else
    paired_statistics pairs;  // of differences; no groups: fewer than two pairs
} over_row;

typedef void over_row_sink(void *self, const over_row *row);

// First of each result, then of differences of the pairs of two that are shown.
// @return LD_ERR_INPUT where there is none
ld_status over_rows_each(const shown *self, over_asked *asked, over_row_sink *take, void *sink,
                         ld_error *error);

#endif
