#include "fit/fit_log.h"

#include <stdlib.h>
#include <string.h>

#include "compare/log_clock.h"
#include "compare/measured_log.h"
#include "compare/sensor_reading.h"
#include "compare/sensor_samples.h"
#include "launchdyn/scenario.h"
#include "math/functions.h"
#include "run/measure_names.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the log");
}

// ---- the clock

static void place_log(const measured_log *log, double *t)
{
    for (size_t i = 0; i < log->rows; i++)
        t[i] = log->t[i] + log->clock.offset;
}

// The offset from which the fit starts, where it is to be found.
static ld_status find_clock(measured_log *log, const run_series *run, double *t, ld_error *error)
{
    place_log(log, t);
    for (int i = 0; i < log->sensors && log->clock.find; i++) {
        sensor by = log->sensor[i];
        if (strcmp(by.column, log->clock.find) != 0)
            continue;
        ld_status status = sensor_find_bias(&by, run, log->rows, t, error);
        return status ? status : log_clock_find(log, &by, run, error);
    }
    return LD_OK;
}

// ---- series

static ld_status copy_samples(const measured_log *log, const sensor *of, const char *chosen,
                              fit_series *series, ld_error *error)
{
    size_t n = 0;
    series->t = calloc(series->count, sizeof *series->t);
    series->value = calloc(series->count, sizeof *series->value);
    if (!series->t || !series->value)
        return no_memory(error);
    for (size_t i = 0; i < log->rows; i++)
        if (chosen[i]) {
            series->t[n] = log->t[i];
            series->value[n++] = of->value[i];
        }
    return LD_OK;
}

static ld_status read_series(fit_log *self, int k, const run_series *run, const double *t,
                             char *chosen, ld_error *error)
{
    measured_log *log = &self->log;
    sensor *of = &log->sensor[k];
    fit_series *series = &self->series[k];
    sensor_samples found = {.chosen = chosen};
    *series =
        (fit_series){.noise = sqrt(of->noise * of->noise + of->resolution * of->resolution / 12),
                     .correlation = 1,
                     .bias_key = FIT_NO_KEY,
                     .scale_key = FIT_NO_KEY};
    if (!(series->noise > 0))
        return ld_fail(error, LD_ERR_INPUT,
                       "%.300s: %.95s: a fit requires the noise of its sensor, a number > 0",
                       self->file, of->column);
    ld_status status = sensor_find_bias(of, run, log->rows, t, error);
    if (!status)
        status = sensor_choose_samples(of, run, log->rows, t, &found, error);
    if (status)
        return status;
    series->count = found.count;
    return copy_samples(log, of, chosen, series, error);
}

static ld_status read_all_series(fit_log *self, const run_series *run, int *residuals,
                                 ld_error *error)
{
    measured_log *log = &self->log;
    double *t = calloc(log->rows, sizeof *t);
    char *chosen = calloc(log->rows, 1);
    self->series = calloc((size_t)log->sensors + 1, sizeof *self->series);
    ld_status status = t && chosen && self->series ? LD_OK : no_memory(error);
    if (!status)
        status = find_clock(log, run, t, error);
    if (!status)
        place_log(log, t);
    for (int k = 0; k < log->sensors && !status; k++) {
        status = read_series(self, k, run, t, chosen, error);
        self->series[k].first = *residuals;
        if (!status && self->series[k].count > (size_t)(FIT_MOST_SAMPLES - *residuals))
            status = ld_fail(error, LD_ERR_INPUT,
                             "%.300s: %.95s: more than %d samples: choose a narrower window, from "
                             "and to",
                             self->file, log->sensor[k].column, FIT_MOST_SAMPLES);
        *residuals += status ? 0 : (int)self->series[k].count;
    }
    free(t);
    free(chosen);
    return status;
}

// ---- stated results

static ld_status read_number(const fit_log *self, const fit_scalar *scalar, const char *key,
                             const char *text, double *value, ld_error *error)
{
    ld_error why;
    ld_status status = ld_read_quantity(text, scalar->unit, value, &why);
    return status ? ld_fail(error, status, "%.300s: results: %s: %s: %s", self->file, scalar->name,
                            key, why.text)
                  : LD_OK;
}

static ld_status read_scalar(const fit_log *self, const log_result *of,
                             const quantity_things *things, fit_scalar *scalar, ld_error *error)
{
    char near[QUANTITY_NAME];
    const quantity_walk at = study_result_find(things, of->of);
    if (!at.row) {
        study_result_near(things, of->of, near);
        return ld_fail(error, LD_ERR_INPUT, "%.300s: results: no result is called %.95s%s%s%s",
                       self->file, of->of, near[0] ? ", did you mean \"" : "", near,
                       near[0] ? "\"?" : "");
    }
    snprintf(scalar->name, sizeof scalar->name, "%s", of->of);
    scalar->unit = strcmp(quantity_unit(&at), "1") == 0 ? "" : quantity_unit(&at);
    ld_status status =
        read_number(self, scalar, "measured", of->measured, &scalar->measured, error);
    if (!status)
        status =
            read_number(self, scalar, "uncertainty", of->uncertainty, &scalar->uncertainty, error);
    if (!status && !(scalar->uncertainty > 0))
        status = ld_fail(error, LD_ERR_INPUT, "%.300s: results: %s: expected an uncertainty > 0",
                         self->file, scalar->name);
    return status;
}

static ld_status read_scalars(fit_log *self, const quantity_things *things, int *residuals,
                              ld_error *error)
{
    const measured_log *log = &self->log;
    ld_status status = LD_OK;
    self->scalar = calloc((size_t)log->results + 1, sizeof *self->scalar);
    if (!self->scalar)
        return no_memory(error);
    for (int i = 0; i < log->results && !status; i++) {
        if (log->result[i].take != TAKE_RESULT)
            continue;
        fit_scalar *scalar = &self->scalar[self->scalars++];
        status = read_scalar(self, &log->result[i], things, scalar, error);
        scalar->residual = (*residuals)++;
    }
    return status;
}

// NOLINTNEXTLINE(readability-function-size)
ld_status fit_log_read(fit_log *self, const char *file, const char *sensors, const run_series *run,
                       const quantity_things *things, int *residuals, ld_error *error)
{
    *self = (fit_log){.file = strdup(file), .clock_key = FIT_NO_KEY};
    if (!self->file)
        return no_memory(error);
    ld_status status = measured_log_read(&self->log, file, sensors, run, error);
    self->given_offset = self->log.clock.offset;
    if (!status)
        status = read_all_series(self, run, residuals, error);
    return status ? status : read_scalars(self, things, residuals, error);
}

void fit_log_free(fit_log *self)
{
    for (int k = 0; self->series && k < self->log.sensors; k++) {
        free(self->series[k].t);
        free(self->series[k].value);
    }
    free(self->series);
    free(self->scalar);
    free(self->file);
    measured_log_free(&self->log);
    *self = (fit_log){.clock_key = FIT_NO_KEY};
}

size_t fit_log_samples(const fit_log *logs, int count)
{
    size_t samples = 0;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < logs[i].log.sensors; k++)
            samples += logs[i].series[k].count;
    return samples;
}

// ---- residuals

ld_status fit_log_take(const fit_log *self, const run_series *series, fit_log_run *run,
                       ld_error *error)
{
    ld_status status = LD_OK;
    *run = (fit_log_run){.signal = calloc((size_t)self->log.sensors + 1, sizeof *run->signal)};
    if (!run->signal)
        return no_memory(error);
    for (int k = 0; k < self->log.sensors && !status; k++) {
        status = sensor_signal(&self->log.sensor[k], series, &run->signal[k], error);
        run->signals += !status;
    }
    return status;
}

void fit_log_run_free(fit_log_run *self)
{
    for (int k = 0; k < self->signals; k++)
        run_signal_free(&self->signal[k]);
    free(self->signal);
    *self = (fit_log_run){0};
}

// What the sensor reads at its samples, with the keys as they are.
static ld_status read_sensor(const fit_log *self, int k, const run_signal *signal,
                             const double *key, double *reading, ld_error *error)
{
    const fit_series *series = &self->series[k];
    sensor of = self->log.sensor[k];
    double offset = self->clock_key < 0 ? self->log.clock.offset : key[self->clock_key];
    double *t = calloc(series->count, sizeof *t);
    if (!t)
        return no_memory(error);
    for (size_t i = 0; i < series->count; i++)
        t[i] = series->t[i] + offset;
    of.bias = series->bias_key < 0 ? of.bias : key[series->bias_key];
    of.scale = series->scale_key < 0 ? of.scale : key[series->scale_key];
    ld_status status = sensor_read(&of, signal, series->count, t, reading, error);
    free(t);
    return status;
}

ld_status fit_log_weigh_series(const fit_log *self, const fit_log_run *run, const double *key,
                               double *residual, ld_error *error)
{
    ld_status status = LD_OK;
    for (int k = 0; k < self->log.sensors && !status; k++) {
        const fit_series *series = &self->series[k];
        double *row = &residual[series->first];
        double unit = series->noise * sqrt(series->correlation);
        status = read_sensor(self, k, &run->signal[k], key, row, error);
        for (size_t i = 0; i < series->count && !status; i++)
            row[i] = (row[i] - series->value[i]) / unit;
    }
    return status;
}

ld_status fit_log_weigh_scalars(const fit_log *self, const ld_summary *summary,
                                const quantity_things *things, double *residual, ld_error *error)
{
    for (int i = 0; i < self->scalars; i++) {
        const fit_scalar *scalar = &self->scalar[i];
        const quantity_walk at = study_result_find(things, scalar->name);
        double value = quantity_value(&at, &summary->rocket[0]);
        if (isnan(value))
            return ld_fail(error, LD_ERR_LAUNCH, "%s: the launch has no such result", scalar->name);
        residual[scalar->residual] = (value - scalar->measured) / scalar->uncertainty;
    }
    return LD_OK;
}

// ---- correlation

static double lagged_sum(const double *residual, size_t n, size_t lag)
{
    double sum = 0;
    for (size_t i = lag; i < n; i++)
        sum += residual[i] * residual[i - lag];
    return sum;
}

double fit_correlation_sum(const double *residual, size_t n)
{
    const double significant = 2;
    double square = lagged_sum(residual, n, 0), sum = 1;
    if (!(square > 0) || !(lagged_sum(residual, n, 1) > significant / sqrt((double)n) * square))
        return 1;
    for (size_t lag = 1; lag < n; lag++) {
        double now = lagged_sum(residual, n, lag) / square;
        if (!(now > 0))
            break;
        sum += 2 * now;
    }
    return sum;
}
