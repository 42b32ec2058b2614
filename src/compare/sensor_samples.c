#include "compare/sensor_samples.h"

#include <stdbool.h>
#include <stdlib.h>

#include "compare/sensor_reading.h"
#include "math/functions.h"

// Mean of the log less the run's readings over the samples at rest; *count of them.
static double mean_at_rest(const sensor *self, size_t rows, const double *t, const double *reading,
                           size_t *count)
{
    double sum = 0;
    *count = 0;
    for (size_t i = 0; i < rows; i++)
        if (t[i] >= self->rest[0] && t[i] <= self->rest[1] && !isnan(self->value[i])) {
            sum += self->value[i] - reading[i];
            ++*count;
        }
    return sum / (double)*count;
}

static ld_status take_bias(sensor *self, size_t rows, const double *t, const double *reading,
                           ld_error *error)
{
    size_t count;
    double bias = mean_at_rest(self, rows, t, reading, &count);
    if (count == 0)
        return ld_fail(error, LD_ERR_INPUT, "%.95s: no sample lies in rest, %g s to %g s",
                       self->column, self->rest[0], self->rest[1]);
    self->bias = bias;
    double of_mean = self->noise / sqrt((double)count);
    self->bias_uncertainty = hypot(self->bias_uncertainty, of_mean);
    return LD_OK;
}

ld_status sensor_find_bias(sensor *self, const run_series *run, size_t rows, const double *t,
                           ld_error *error)
{
    run_signal signal;
    ld_status status = isnan(self->rest[0]) ? LD_OK : sensor_signal(self, run, &signal, error);
    if (status || isnan(self->rest[0]))
        return status;
    double *reading = calloc(rows + 1, sizeof *reading);
    self->bias = 0;
    status = reading ? sensor_read(self, &signal, rows, t, reading, error)
                     : ld_fail(error, LD_ERR_MEMORY, "no memory for a sensor's readings");
    run_signal_free(&signal);
    if (!status)
        status = take_bias(self, rows, t, reading, error);
    free(reading);
    return status;
}

ld_status sensor_choose_samples(const sensor *self, const run_series *run, size_t rows,
                                const double *t, sensor_samples *found, ld_error *error)
{
    run_signal signal;
    ld_status status = sensor_signal(self, run, &signal, error);
    if (status)
        return status;
    double first = fmax(signal.t[0], window_time(run, self->from, -INFINITY));
    double last = fmin(signal.t[signal.count - 1], window_time(run, self->to, INFINITY));
    run_signal_free(&signal);
    size_t there = 0;
    *found = (sensor_samples){.chosen = found->chosen};
    for (size_t i = 0; i < rows; i++) {
        double value = self->value[i];
        bool outside = t[i] < first || t[i] > last, gap = !outside && isnan(value);
        bool saturated = !outside && (value <= self->range[0] || value >= self->range[1]);
        found->outside += outside;
        found->gaps += gap;
        found->saturated += saturated;
        there += !isnan(value);
        found->chosen[i] = !outside && !gap && !saturated;
        found->count += (size_t)found->chosen[i];
    }
    if (found->count == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "%.95s: none of its %zu samples lies between %g s and %g s within its range",
                       self->column, there, first, last);
    return LD_OK;
}
