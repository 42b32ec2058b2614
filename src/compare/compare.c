// ld_compare(): from a folder of results and a log to errors, uncertainties and verdicts.
#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compare/evaluation.h"
#include "compare/further_runs.h"
#include "compare/log_clock.h"
#include "compare/measured_log.h"
#include "compare/sensor_samples.h"
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

static ld_status find_biases(ld_comparison *self, ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; i < self->log.sensors && !status; i++)
        status = sensor_find_bias(&self->log.sensor[i], &self->run, self->log.rows, self->t, error);
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
            status = sensor_find_bias(&log->sensor[i], &self->run, log->rows, self->t, error);
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
    ld_compared_series *series = &self->series[k];
    sensor_samples found = {.chosen = self->compared + (size_t)k * self->log.rows};
    ld_status status = sensor_choose_samples(&self->log.sensor[k], &self->run, self->log.rows,
                                             self->t, &found, error);
    if (status)
        return status;
    series->count = found.count;
    series->outside = found.outside;
    series->gaps = found.gaps;
    series->saturated = found.saturated;
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
    series->column = of->kind == SENSOR_ALTIMETER ? "center.y" : of->of;
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
