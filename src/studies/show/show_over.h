// Results over the values of swept keys, printed: a table for each, a row for each value.
#ifndef LD_STUDIES_SHOW_OVER_H
#define LD_STUDIES_SHOW_OVER_H

#include "studies/points/over.h"
#include "studies/show/shown.h"

// The keys that a view asks for; of differences without keys those that POINT names; of a point by
// its number every point by itself.
ld_status show_over_open(const shown *self, over *of, ld_error *error);

// Prints means and deviations; of differences those of the means, ratios of deviations, of all
// pairs and within samples, of the areas of ellipses of two results.
// @return LD_ERR_INPUT where nothing can be compared
ld_status show_over(shown *self, over *of, ld_error *error);

#endif
