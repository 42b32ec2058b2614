// ld_compare(): from a folder of results and a log to errors, uncertainties and verdicts.
#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compare/evaluation.h"
#include "compare/further_runs.h"
#include "compare/log_clock.h"
#include "compare/measured_log.h"
#include "compare/sensor_reading.h"
#include "compare/uncertainty.h"
#include "math/functions.h"
#include "results/manifest.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for a comparison");
}

// ---- the run

static ld_status open_run(ld_comparison *self, const char *folder, ld_error *error)
{
    char path[4096], doubt[256];
    snprintf(path, sizeof path, "%.4000s/history.h5", folder);
    if (access(path, F_OK) != 0)
        return ld_fail(error, LD_ERR_INPUT, "no results in %.400s: there is no history.h5", folder);
    ld_status status = manifest_check_history(folder, doubt, sizeof doubt, error);
    if (!status)
        status = history_read(path, &self->history, error);
    if (!status && *doubt)
        comparison_note(self, "%.100s: %s", folder, doubt);
    return status ? status : run_series_of_file(&self->run, &self->history, self->rocket, error);
}

// Where accelerometers on the launcher feel it.
static ld_status find_gravity(ld_comparison *self, const char *folder, ld_error *error)
{
    bool felt = false;
    for (int i = 0; i < self->log.sensors; i++)
        felt = felt || (self->log.sensor[i].on && self->log.sensor[i].kind == SENSOR_ACCELEROMETER);
    return felt ? further_runs_gravity(folder, &self->run.gravity, error) : LD_OK;
}

// ---- the log beside it

// First and last time of the run [s] from ignition.
static void span_of(const ld_comparison *self, double span[2])
{
    static const char *const name = "t";
    run_signal times;
    span[0] = span[1] = NAN;
    if (run_series_take(&self->run, &name, 1, &times, NULL))
        return;
    if (times.count > 0) {
        span[0] = times.t[0];
        span[1] = times.t[times.count - 1];
    }
    run_signal_free(&times);
}

static ld_status place_log(ld_comparison *self, ld_error *error)
{
    const measured_log *log = &self->log;
    double span[2], first = log->t[0] + log->clock.offset,
                    last = log->t[log->rows - 1] + log->clock.offset;
    for (size_t i = 0; i < log->rows; i++)
        self->t[i] = log->t[i] + log->clock.offset;
    span_of(self, span);
    if (first > span[1])
        return ld_fail(error, LD_ERR_INPUT,
                       "the log begins %g s after the ignition, after the run's end at %g s", first,
                       span[1]);
    if (last < span[0])
        return ld_fail(error, LD_ERR_INPUT,
                       "the log ends %g s after the ignition, before the run's start at %g s", last,
                       span[0]);
    if (first > self->run.instant[SERIES_REAR])
        comparison_note(self, "the log begins after the launch, %g s after the ignition", first);
    return LD_OK;
}

// Bias of a sensor that has a window at rest: what the log reads there more than the run, which
// before its start is as at its start.
static ld_status find_bias(ld_comparison *self, sensor *of, ld_error *error)
{
    run_signal signal;
    size_t count = 0;
    double sum = 0;
    ld_status status = isnan(of->rest[0]) ? LD_OK : sensor_signal(of, &self->run, &signal, error);
    if (status || isnan(of->rest[0]))
        return status;
    of->bias = 0;
    double *reading = self->nominal.reading;
    status = sensor_read(of, &signal, self->log.rows, self->t, reading, error);
    run_signal_free(&signal);
    for (size_t i = 0; i < self->log.rows && !status; i++)
        if (self->t[i] >= of->rest[0] && self->t[i] <= of->rest[1] && !isnan(of->value[i])) {
            sum += of->value[i] - reading[i];
            count++;
        }
    if (!status && count == 0)
        status = ld_fail(error, LD_ERR_INPUT, "%.95s: no sample lies in rest, %g s to %g s",
                         of->column, of->rest[0], of->rest[1]);
    if (status)
        return status;
    of->bias = sum / (double)count;
    double of_mean = of->noise / sqrt((double)count);
    of->bias_uncertainty = hypot(of->bias_uncertainty, of_mean);
    return LD_OK;
}

static ld_status find_biases(ld_comparison *self, ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; i < self->log.sensors && !status; i++)
        status = find_bias(self, &self->log.sensor[i], error);
    return status;
}

static ld_status find_clock(ld_comparison *self, ld_error *error)
{
    measured_log *log = &self->log;
    ld_status status = LD_OK;
    for (size_t i = 0; i < log->rows; i++)
        self->t[i] = log->t[i] + log->clock.offset;
    for (int i = 0; i < log->sensors && !status && log->clock.find; i++)
        if (strcmp(log->sensor[i].column, log->clock.find) == 0) {
            double given = log->sensor[i].bias_uncertainty;
            status = find_bias(self, &log->sensor[i], error);
            if (!status)
                status = log_clock_find(log, &log->sensor[i], &self->run, error);
            log->sensor[i].bias_uncertainty = given;
        }
    self->clock = (ld_compared_clock){log->clock.offset, log->clock.uncertainty, log->clock.find};
    return status;
}

// Which samples of a sensor are compared.
static ld_status choose_samples(ld_comparison *self, int k, ld_error *error)
{
    const sensor *of = &self->log.sensor[k];
    ld_compared_series *series = &self->series[k];
    char *compared = self->compared + (size_t)k * self->log.rows;
    run_signal signal;
    ld_status status = sensor_signal(of, &self->run, &signal, error);
    if (status)
        return status;
    double first = fmax(signal.t[0], window_time(&self->run, of->from, -INFINITY));
    double last = fmin(signal.t[signal.count - 1], window_time(&self->run, of->to, INFINITY));
    run_signal_free(&signal);
    size_t there = 0;
    for (size_t i = 0; i < self->log.rows; i++) {
        double value = of->value[i];
        bool outside = self->t[i] < first || self->t[i] > last, gap = !outside && isnan(value);
        bool saturated = !outside && (value <= of->range[0] || value >= of->range[1]);
        series->outside += outside;
        series->gaps += gap;
        series->saturated += saturated;
        there += !isnan(value);
        compared[i] = !outside && !gap && !saturated;
        series->count += (size_t)compared[i];
    }
    if (series->count == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "%.95s: none of its %zu samples lies between %g s and %g s within its range",
                       of->column, there, first, last);
    return LD_OK;
}

// ---- what is handed out

static ld_status fill_series(ld_comparison *self, int k, ld_error *error)
{
    const sensor *of = &self->log.sensor[k];
    ld_compared_series *series = &self->series[k];
    size_t rows = self->log.rows, n = 0;
    const char *compared = self->compared + (size_t)k * rows;
    const double *reading = self->nominal.reading + (size_t)k * rows;
    double *value = calloc(4 * series->count, sizeof *value);
    if (!value)
        return no_memory(error);
    double *t = value, *measured = t + series->count, *simulated = measured + series->count,
           *u_val = simulated + series->count;
    series->name = of->column;
    series->unit = of->si;
    series->log_unit = of->head.unit;
    series->factor = of->factor;
    series->t = t;
    series->measured = measured;
    series->simulated = simulated;
    series->u_val = u_val;
    series->bias = of->bias;
    series->bias_uncertainty = of->bias_uncertainty;
    for (size_t i = 0; i < rows; i++) {
        if (!compared[i])
            continue;
        t[n] = self->t[i];
        measured[n] = of->value[i];
        simulated[n] = reading[i];
        u_val[n++] = uncertainty_of_sample(self, k, i).u_val;
    }
    uncertainty_of_series(self, k, series);
    return LD_OK;
}

static ld_status fill_results(ld_comparison *self, ld_error *error)
{
    ld_status status = LD_OK;
    for (int k = 0; k < self->log.results && !status; k++)
        status = uncertainty_of_result(self, k, &self->result[k], error);
    return status;
}

static ld_status make_room(ld_comparison *self, ld_error *error)
{
    const measured_log *log = &self->log;
    self->t = calloc(log->rows, sizeof *self->t);
    self->compared = calloc((size_t)log->sensors * log->rows + 1, 1);
    self->series = calloc((size_t)log->sensors + 1, sizeof *self->series);
    self->result = calloc((size_t)log->results + 1, sizeof *self->result);
    self->result_head = calloc((size_t)log->results + 1, sizeof *self->result_head);
    if (!self->t || !self->compared || !self->series || !self->result || !self->result_head)
        return no_memory(error);
    return run_values_make(&self->nominal, log, error);
}

static ld_status compare_nominal(ld_comparison *self, ld_error *error)
{
    ld_status status = make_room(self, error);
    if (!status)
        status = find_clock(self, error);
    if (!status)
        status = place_log(self, error);
    if (!status)
        status = find_biases(self, error);
    for (int k = 0; k < self->log.sensors && !status; k++)
        status = choose_samples(self, k, error);
    return status ? status : comparison_evaluate(self, &self->run, NULL, &self->nominal, error);
}

static ld_status compare(ld_comparison *self, const char *folder, const char *log,
                         const ld_compare_options *options, ld_error *error)
{
    ld_status status = open_run(self, folder, error);
    if (!status)
        status = measured_log_read(&self->log, log, options->sensors, &self->run, error);
    if (!status)
        status = find_gravity(self, folder, error);
    if (!status)
        status = compare_nominal(self, error);
    if (!status)
        status = uncertainty_find(self, folder, options, error);
    for (int k = 0; k < self->log.sensors && !status; k++)
        status = fill_series(self, k, error);
    return status ? status : fill_results(self, error);
}

ld_status ld_compare(const char *folder, const char *log, const ld_compare_options *options,
                     ld_comparison **comparison, ld_error *error)
{
    static const ld_compare_options usual = {0};
    assert(folder && log && comparison);
    options = options ? options : &usual;
    *comparison = NULL;
    ld_comparison *self = calloc(1, sizeof *self);
    if (!self)
        return no_memory(error);
    self->rocket = options->rocket ? options->rocket : 1;
    ld_status status = compare(self, folder, log, options, error);
    if (status)
        ld_comparison_free(self);
    else
        *comparison = self;
    return status;
}
