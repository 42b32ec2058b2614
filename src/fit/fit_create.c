#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/printed.h"
#include "fit/fit.h"
#include "launchdyn/scenario.h"
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
    self->keys = (int)count;
    return LD_OK;
}

// Keys against what was measured.
static ld_status check_together(const ld_fit *self, ld_error *error)
{
    const fit_data *data = &self->data;
    int without_prior = 0;
    for (int i = 0; i < self->keys; i++) {
        without_prior += isinf(self->key[i].deviation);
        for (int k = 0; k < data->settings; k++)
            if (strcmp(self->key[i].place.path, data->setting[k].path) == 0)
                return ld_fail(error, LD_ERR_INPUT,
                               "%s is fitted, and a column of the measured launches sets it",
                               self->key[i].place.path);
    }
    for (int k = 0; k < data->settings; k++)
        if (data->setting[k].whole)
            return ld_fail(error, LD_ERR_INPUT, "%s: a whole number cannot be a column",
                           data->setting[k].path);
    if (without_prior <= data->residuals)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "%d keys without a prior, but %d measured results: expected as many results",
                   without_prior, data->residuals);
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_fit_create(const ld_model *model, const ld_fit_key *keys, size_t key_count,
                        const char *const *files, size_t file_count, ld_fit **out, ld_error *error)
{
    assert(model && keys && files && out);
    ld_error own;
    error = error ? error : &own;
    *out = NULL;
    if (file_count == 0)
        return ld_fail(error, LD_ERR_INPUT, "expected a file of measured launches");
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

void ld_fit_free(ld_fit *self)
{
    if (!self)
        return;
    fit_data_free(&self->data);
    fit_minimum_free(&self->minimum);
    free(self->fitted);
    free(self);
}
