// Results over the values of swept keys, printed: a table for each, a row for each value; as JSON
// and CSV (show_over_files.c).
#ifndef LD_STUDIES_SHOW_OVER_H
#define LD_STUDIES_SHOW_OVER_H

#include "studies/show/over_rows.h"

// Prints means and deviations, or a statistic that is asked for; of differences those of the means,
// ratios of deviations, of all pairs and within samples, of the areas of ellipses of two results.
// @return LD_ERR_INPUT where nothing can be compared
ld_status show_over(const shown *self, over_asked *asked, ld_error *error);

// The same in full precision, in SI.
ld_status show_over_json(const shown *self, over_asked *asked, ld_error *error);
ld_status show_over_csv(const shown *self, over_asked *asked, FILE *stream, ld_error *error);

#endif
