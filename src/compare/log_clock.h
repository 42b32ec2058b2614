// The offset of a log's clock, found by least squares of one sensor against the run.
#ifndef LD_COMPARE_LOG_CLOCK_H
#define LD_COMPARE_LOG_CLOCK_H

#include "compare/sensor.h"

// Finds clock.offset and its standard uncertainty,
//   u^2 = s^2 (1 + rho)/(1 - rho) / sum of y_dot^2,
// s the residuals' deviation, rho their correlation from sample to sample, y_dot the slope of what
// is read (least squares of one parameter with correlated residuals).
// @return LD_OK, LD_ERR_INPUT (too few samples, no minimum), LD_ERR_MEMORY
ld_status log_clock_find(measured_log *log, const sensor *by, const run_series *run,
                         ld_error *error);

#endif
