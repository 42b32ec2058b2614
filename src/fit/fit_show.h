// What a fit shows, as text and as JSON.
#ifndef LD_FIT_SHOW_H
#define LD_FIT_SHOW_H

#include "fit/fit.h"

// Standard uncertainty of a launch's mean result, SI.
double fit_cell_deviation(const fit_launch *launch, int cell);
// Whether the 95 % interval of the direction is as wide as the bounds.
bool fit_is_untold(const ld_fit *fit, int direction);
double fit_correlation(const ld_fit *fit, int i, int j);
// [s] from the log's clock to the time from ignition, as fitted.
double fit_log_offset(const ld_fit *fit, const fit_log *log);
// How many starts ended at the best chi2, to 1.
int fit_starts_at_best(const ld_fit *fit);

#endif
