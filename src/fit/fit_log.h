// Logs of a fit: series of sensors and numbers that were measured in the launch of the scenario,
// with what is not known of their clocks and sensors as keys of their own (docs/fit.md).
#ifndef LD_FIT_LOG_H
#define LD_FIT_LOG_H

#include "compare/sensor.h"
#include "launchdyn/summary.h"
#include "quantities/study_results.h"

enum { FIT_MOST_LOGS = 16, FIT_MOST_SAMPLES = 100000, FIT_NO_KEY = -1 };

// Samples of a sensor: residuals (reading - value)/(noise root(correlation)).
typedef struct fit_series {
    size_t count;
    double *t, *value;       // [count] s of the log, SI; owned
    double noise;            // of a sample, SI
    double correlation;      // sum of the residuals' autocorrelation over all lags; 1: white
    int first;               // number of its first residual
    int bias_key, scale_key; // FIT_NO_KEY: known
} fit_series;

// A result whose value the description of a log states.
typedef struct fit_scalar {
    char name[QUANTITY_NAME];
    const char *unit;             // SI
    double measured, uncertainty; // SI
    int residual;                 // its number
} fit_scalar;

typedef struct fit_log {
    char *file;
    measured_log log;
    fit_series *series; // [log.sensors]
    int scalars;
    fit_scalar *scalar; // [scalars]
    int clock_key;
    double given_offset; // [s] of the clock, before it is found
} fit_log;

// Reads a log; what its windows are, the offset of its clock and biases at rest follow from the run
// of the scenario as it is. Keys are not yet set.
// @param residuals is raised by the number of its residuals
// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE, LD_ERR_MEMORY
ld_status fit_log_read(fit_log *self, const char *file, const char *sensors, const run_series *run,
                       const quantity_things *things, int *residuals, ld_error *error);
void fit_log_free(fit_log *self);

// Samples of all series of so many logs.
size_t fit_log_samples(const fit_log *logs, int count);

// What a launch gives, in the order of the residuals.
typedef struct fit_log_run {
    int signals;
    run_signal *signal; // [signals] of each sensor; owned
} fit_log_run;

// @param run to be freed in any case
ld_status fit_log_take(const fit_log *self, const run_series *series, fit_log_run *run,
                       ld_error *error);
void fit_log_run_free(fit_log_run *self);

// Residuals of the series at values of all keys, SI, into residual[all].
ld_status fit_log_weigh_series(const fit_log *self, const fit_log_run *run, const double *key,
                               double *residual, ld_error *error);
ld_status fit_log_weigh_scalars(const fit_log *self, const ld_summary *summary,
                                const quantity_things *things, double *residual, ld_error *error);

// Sum of the autocorrelation of n residuals, sum of rho_k over all k, up to where it ends; 1 where
// neighbours are not correlated beyond 2/root(n).
double fit_correlation_sum(const double *residual, size_t n);

#endif
