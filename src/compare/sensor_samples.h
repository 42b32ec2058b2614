// Which samples of a log count for a sensor: those at rest for its bias, those compared.
#ifndef LD_COMPARE_SENSOR_SAMPLES_H
#define LD_COMPARE_SENSOR_SAMPLES_H

#include "compare/sensor.h"

// Bias of a sensor that has a window at rest: what the log reads there more than the run, which
// before its start is as at its start; its uncertainty grows by that of the mean. A sensor without
// the window stays as it is.
// @param t [rows] s from ignition
// @return LD_OK, LD_ERR_INPUT (no sample at rest), LD_ERR_MEMORY
ld_status sensor_find_bias(sensor *self, const run_series *run, size_t rows, const double *t,
                           ld_error *error);

typedef struct sensor_samples {
    char *chosen; // [rows] the caller's; 1: counts
    size_t count, outside, gaps, saturated;
} sensor_samples;

// Marks the samples in the sensor's window of the run, and counts the others by what they are.
// @return LD_OK, LD_ERR_INPUT (none), LD_ERR_MEMORY
ld_status sensor_choose_samples(const sensor *self, const run_series *run, size_t rows,
                                const double *t, sensor_samples *found, ld_error *error);

#endif
