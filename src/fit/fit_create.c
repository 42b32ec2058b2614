#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/printed.h"
#include "compare/further_runs.h"
#include "fit/fit.h"
#include "launchdyn/scenario.h"
#include "math/functions.h"
#include "model/parts.h"
#include "scenario/scenario_reader.h"

// Reads one of the numbers of a key, called `what`.
static ld_status read_number(const ld_fit_key *key, const fit_key *self, const char *what,
                             const char *text, double *value, ld_error *error)
{
    ld_error why;
    ld_status status = ld_read_quantity(text, self->unit, value, &why);
    return status ? ld_fail(error, status, "%.200s: %s: %s", key->path, what, why.text) : LD_OK;
}

// The unit in which a bound was given, in which the key is shown.
static void take_unit(const char *text, fit_key *self)
{
    const char *reason;
    double value;
    char unknown[32];
    const char *end = number_parse(text, &value, &reason);
    const char *unit = end ? end + strspn(end, " \t") : "";
    snprintf(self->shown_unit, sizeof self->shown_unit, "%s", *unit ? unit : self->unit);
    if (strlen(unit) >= sizeof self->shown_unit ||
        units_factor(self->shown_unit, self->unit, &self->shown_factor, unknown) != UNITS_OK) {
        snprintf(self->shown_unit, sizeof self->shown_unit, "%s", self->unit);
        self->shown_factor = 1;
    }
}

static ld_status check_range(const fit_key *self, ld_error *error)
{
    const field_range range = self->place.row->range;
    char text[128];
    field_range_text(self->place.row, text, sizeof text);
    if (!(self->width > 0))
        return ld_fail(error, LD_ERR_INPUT, "%s: expected bounds in rising order",
                       self->place.path);
    if (field_in_range(range, self->low) && field_in_range(range, self->low + self->width))
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "%s: expected bounds in %s", self->place.path, text);
}

static ld_status read_prior(const ld_fit_key *key, fit_key *self, ld_error *error)
{
    self->mean = 0;
    self->deviation = INFINITY;
    if (!key->mean && !key->deviation)
        return LD_OK;
    ld_status status = read_number(key, self, "prior", key->mean, &self->mean, error);
    if (!status)
        status = read_number(key, self, "prior", key->deviation, &self->deviation, error);
    if (!status && !(self->deviation > 0))
        status =
            ld_fail(error, LD_ERR_INPUT, "%s: prior: expected a deviation > 0", self->place.path);
    return status;
}

static ld_status read_key(const ld_model *model, const ld_fit_key *key, fit_key *self,
                          ld_error *error)
{
    char why[384];
    double high = 0;
    if (!field_locate(model, key->path, &self->place, why, sizeof why))
        return ld_fail(error, LD_ERR_INPUT, "%.200s: %s", VISIBLE(key->path), why);
    if (self->place.whole)
        return ld_fail(error, LD_ERR_INPUT, "%s: a whole number cannot be fitted",
                       self->place.path);
    self->unit = self->place.row->unit ? self->place.row->unit : "";
    ld_status status = read_number(key, self, "from", key->from, &self->low, error);
    if (!status)
        status = read_number(key, self, "to", key->to, &high, error);
    self->width = high - self->low;
    self->start = field_get(model, &self->place);
    snprintf(self->name, sizeof self->name, "%s", self->place.path);
    take_unit(key->to, self);
    if (!status)
        status = check_range(self, error);
    return status ? status : read_prior(key, self, error);
}

static ld_status read_keys(ld_fit *self, const ld_fit_key *keys, size_t count, ld_error *error)
{
    if (count < 1 || count > FIT_MOST_KEYS)
        return ld_fail(error, LD_ERR_INPUT, "expected 1 to %d keys to fit, found %zu",
                       FIT_MOST_KEYS, count);
    for (size_t i = 0; i < count; i++) {
        ld_status status = read_key(self->model, &keys[i], &self->key[i], error);
        if (status)
            return status;
        for (size_t k = 0; k < i; k++)
            if (strcmp(self->key[k].place.path, self->key[i].place.path) == 0)
                return ld_fail(error, LD_ERR_INPUT, "%s is given twice", self->key[i].place.path);
    }
    self->keys = self->own_keys = (int)count;
    return LD_OK;
}

// Keys against the settings of what was measured.
static ld_status check_together(const ld_fit *self, ld_error *error)
{
    const fit_data *data = &self->data;
    for (int i = 0; i < self->keys; i++)
        for (int k = 0; k < data->settings; k++)
            if (strcmp(self->key[i].place.path, data->setting[k].path) == 0)
                return ld_fail(error, LD_ERR_INPUT,
                               "%s is fitted, and a column of the measured launches sets it",
                               self->key[i].place.path);
    for (int k = 0; k < data->settings; k++)
        if (data->setting[k].whole)
            return ld_fail(error, LD_ERR_INPUT, "%s: a whole number cannot be a column",
                           data->setting[k].path);
    return LD_OK;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_fit_create(const ld_model *model, const ld_fit_key *keys, size_t key_count,
                        const char *const *files, size_t file_count, ld_fit **out, ld_error *error)
{
    assert(model && keys && (files || file_count == 0) && out);
    ld_error own;
    error = error ? error : &own;
    *out = NULL;
    if (model_firing_count(model) > 1)
        return ld_fail(error, LD_ERR_INPUT,
                       "fits are of single launches; the scenario fires %d rockets",
                       model_firing_count(model));
    ld_fit *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the fit");
    self->model = model;
    ld_status status = read_keys(self, keys, key_count, error);
    if (!status)
        status = fit_data_read(model, files, file_count, &self->data, error);
    if (!status)
        status = check_together(self, error);
    if (status) {
        ld_fit_free(self);
        return status;
    }
    *out = self;
    return LD_OK;
}

// ---- logs

// The name of a key of a log: "log.clock.offset", of one of several "log.2.clock.offset".
static void name_key(const ld_fit *self, int log, const char *part, const char *of, fit_key *key)
{
    char number[16] = "";
    if (self->logs > 1)
        snprintf(number, sizeof number, "%d.", log + 1);
    snprintf(key->name, sizeof key->name, "log.%s%.95s.%s", number, part, of);
}

// A key of a log; without `uncertainty` it has no prior. *number: FIT_NO_KEY where it is known.
static ld_status add_key(ld_fit *self, const fit_key *key, int *number, ld_error *error)
{
    if (self->keys == FIT_MOST_KEYS)
        return ld_fail(error, LD_ERR_INPUT,
                       "more than %d keys, with those of the logs' clocks and sensors",
                       FIT_MOST_KEYS);
    *number = self->keys;
    self->key[self->keys++] = *key;
    return LD_OK;
}

// A normal distribution, to six deviations; 0: the value is known.
static ld_status add_known(ld_fit *self, fit_key *key, double value, double uncertainty,
                           int *number, ld_error *error)
{
    const double most = 6;
    *number = FIT_NO_KEY;
    if (!(uncertainty > 0))
        return LD_OK;
    key->low = value - most * uncertainty;
    key->width = 2 * most * uncertainty;
    key->start = key->mean = value;
    key->deviation = uncertainty;
    return add_key(self, key, number, error);
}

static ld_status add_clock(ld_fit *self, int number, fit_log *log, double given, ld_error *error)
{
    const log_clock *clock = &log->log.clock;
    fit_key key = {.unit = "s", .shown_unit = "ms", .shown_factor = 1e-3};
    name_key(self, number, "clock", "offset", &key);
    if (!clock->find)
        return add_known(self, &key, clock->offset, clock->uncertainty, &log->clock_key, error);
    key.low = given - clock->within;
    key.width = 2 * clock->within;
    key.start = clock->offset;
    key.deviation = INFINITY;
    return add_key(self, &key, &log->clock_key, error);
}

static ld_status add_sensor(ld_fit *self, int number, fit_log *log, int k, ld_error *error)
{
    const sensor *of = &log->log.sensor[k];
    fit_series *series = &log->series[k];
    fit_key bias = {.unit = of->si, .shown_factor = 1}, scale = {.unit = "", .shown_factor = 1};
    snprintf(bias.shown_unit, sizeof bias.shown_unit, "%.31s", of->si);
    name_key(self, number, of->column, "bias", &bias);
    name_key(self, number, of->column, "scale", &scale);
    ld_status status =
        add_known(self, &bias, of->bias, of->bias_uncertainty, &series->bias_key, error);
    return status ? status
                  : add_known(self, &scale, of->scale, fabs(of->scale) * of->scale_uncertainty,
                              &series->scale_key, error);
}

static ld_status add_log_keys(ld_fit *self, int number, double given, ld_error *error)
{
    fit_log *log = &self->log[number];
    ld_status status = add_clock(self, number, log, given, error);
    for (int k = 0; k < log->log.sensors && !status; k++)
        status = add_sensor(self, number, log, k, error);
    return status;
}

// What is done with the run of the scenario as it is.
typedef struct log_adder {
    ld_fit *fit;
    const char *const *log, *const *sensors;
    size_t count;
} log_adder;

static ld_status read_logs(void *data, const run_series *run, const ld_summary *summary,
                           ld_error *error)
{
    const log_adder *self = data;
    ld_fit *fit = self->fit;
    ld_status status = LD_OK;
    (void)summary;
    for (size_t i = 0; i < self->count && !status; i++)
        status = fit_log_read(&fit->log[fit->logs++], self->log[i],
                              self->sensors ? self->sensors[i] : NULL, run, &fit->data.things,
                              &fit->data.residuals, error);
    for (int i = 0; i < fit->logs && !status; i++)
        status = add_log_keys(fit, i, fit->log[i].given_offset, error);
    return status;
}

ld_status ld_fit_add_logs(ld_fit *self, const char *const *logs, const char *const *sensors,
                          size_t count, ld_error *error)
{
    assert(self && logs);
    ld_error own;
    error = error ? error : &own;
    if (self->logs > 0 || count > FIT_MOST_LOGS)
        return ld_fail(error, LD_ERR_INPUT, "expected at most %d logs, added at once",
                       FIT_MOST_LOGS);
    log_adder adder = {self, logs, sensors, count};
    const series_run nominal = {
        .model = self->model, .rocket = 1, .take = read_logs, .data = &adder};
    ld_status status = series_run_make(&nominal, error);
    return status ? status : fit_data_own_launch(&self->data, &self->log_launch, error);
}

void ld_fit_free(ld_fit *self)
{
    if (!self)
        return;
    while (self->logs > 0)
        fit_log_free(&self->log[--self->logs]);
    fit_data_free(&self->data);
    fit_minimum_free(&self->minimum);
    free(self->fitted);
    free(self);
}
