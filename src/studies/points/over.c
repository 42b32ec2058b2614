#include "studies/points/over.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "model/units.h"
#include "scenario/scenario_reader.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's keys");
}

// ---- which keys

// "base.speed, firing.interval"
static void list_keys(const study_data *data, char text[512])
{
    text[0] = '\0';
    for (int k = 0; k < data->swept_count; k++) {
        size_t length = strlen(text);
        snprintf(text + length, 512 - length, "%s%s", k ? ", " : "", data->swept[k]);
    }
}

static ld_status unknown_key(const study_data *data, const char *key, ld_error *error)
{
    char list[512];
    name_suggestion suggestion = suggestion_begin(key);
    for (int k = 0; k < data->swept_count; k++)
        suggestion_offer(&suggestion, data->swept[k]);
    list_keys(data, list);
    return ld_fail(error, LD_ERR_INPUT, "--over %.200s: expected a swept key%s%s%s; swept are %s",
                   key, suggestion.name ? ", did you mean " : "",
                   suggestion.name ? suggestion.name : "", suggestion.name ? "?" : "", list);
}

static bool lists(const over_key *key, const char *text)
{
    for (int i = 0; i < key->count; i++)
        if (strcmp(key->text[i], text) == 0)
            return true;
    return false;
}

static ld_status list_values(const study_data *data, over_key *key, ld_error *error)
{
    key->text = calloc((size_t)data->point_count, sizeof *key->text);
    key->number = calloc((size_t)data->point_count, sizeof *key->number);
    if (!key->text || !key->number)
        return no_memory(error);
    for (int i = 0; i < data->point_count; i++)
        if (!lists(key, data->point[i].text[key->axis]))
            key->text[key->count++] = data->point[i].text[key->axis];
    return LD_OK;
}

// Reads "15 km/h"; the unit of the first value is that of all.
static bool read_number(over_key *key, int i)
{
    char unknown[32];
    const char *reason, *end = number_parse(key->text[i], &key->number[i], &reason);
    double factor;
    if (!end)
        return false;
    end += strspn(end, " ");
    if (i == 0)
        snprintf(key->unit, sizeof key->unit, "%s", end);
    if (units_factor(end, key->unit, &factor, unknown) != UNITS_OK)
        return false;
    key->number[i] = units_scale(key->number[i], factor);
    return true;
}

static ld_status open_key(over *self, const char *name, ld_error *error)
{
    const study_data *data = self->data;
    over_key *key = &self->key[self->count];
    while (key->axis < data->swept_count && strcmp(data->swept[key->axis], name) != 0)
        key->axis++;
    if (key->axis == data->swept_count)
        return unknown_key(data, name, error);
    if (self->count > 0 && key->axis == self->key[0].axis)
        return ld_fail(error, LD_ERR_INPUT, "--over %.200s: given twice", name);
    self->count++;
    key->name = data->swept[key->axis];
    ld_status status = list_values(data, key, error);
    key->numeric = !status;
    for (int i = 0; i < key->count && key->numeric; i++)
        key->numeric = read_number(key, i);
    return status;
}

static ld_status open_keys(over *self, const char *keys, ld_error *error)
{
    char *copy = strdup(keys), *rest = NULL;
    ld_status status = copy ? LD_OK : no_memory(error);
    for (char *name = copy ? strtok_r(copy, ", ", &rest) : NULL; name && !status;
         name = strtok_r(NULL, ", ", &rest))
        status =
            self->count < OVER_KEYS
                ? open_key(self, name, error)
                : ld_fail(error, LD_ERR_INPUT, "--over: at most two keys, found \"%.200s\"", keys);
    if (!status && self->count == 0)
        status = unknown_key(self->data, keys, error);
    free(copy);
    return status;
}

// ---- which reference

// A point by its number: its values of the keys, each point's own of the others.
static ld_status fix_values(over *self, ld_error *error)
{
    against *reference = &self->reference;
    const study_point *fixed = reference->fixed;
    if (!fixed || self->count == 0)
        return LD_OK;
    reference->value = calloc((size_t)self->data->swept_count, sizeof *reference->value);
    if (!reference->value)
        return no_memory(error);
    for (int k = 0; k < self->count; k++)
        reference->value[self->key[k].axis] = fixed->text[self->key[k].axis];
    reference->fixed = NULL;
    return LD_OK;
}

ld_status over_open(const char *keys, const char *point, const study_data *data, over *self,
                    ld_error *error)
{
    *self = (over){.data = data};
    if (data->swept_count == 0 && (keys || point))
        return ld_fail(error, LD_ERR_INPUT,
                       "the study sweeps no key (scenario: sweep): it has one point only");
    ld_status status = keys ? open_keys(self, keys, error) : LD_OK;
    if (!status && point)
        status = against_read(point, data, &self->reference, error);
    return status ? status : fix_values(self, error);
}

void over_close(over *self)
{
    for (int k = 0; k < OVER_KEYS; k++) {
        free(self->key[k].text);
        free(self->key[k].number);
    }
    against_free(&self->reference);
    pooled_free(&self->pool);
    *self = (over){0};
}

// ---- cells

int over_key_count(const over *self)
{
    return self->count ? self->count : self->data->swept_count;
}

const char *over_key_name(const over *self, int k)
{
    return self->count ? self->key[k].name : self->data->swept[k];
}

int over_cell_count(const over *self)
{
    if (self->count == 0)
        return self->data->point_count;
    return self->key[0].count * (self->count > 1 ? self->key[1].count : 1);
}

int over_value_of(const over *self, int cell, int k)
{
    int inner = self->count > 1 ? self->key[1].count : 1;
    return k == 0 ? cell / inner : cell % inner;
}

const char *over_text(const over *self, int cell, int k)
{
    return self->count == 0 ? self->data->point[cell].text[k]
                            : self->key[k].text[over_value_of(self, cell, k)];
}

static bool has_point(const over *self, int cell, int point)
{
    if (self->count == 0)
        return point == cell;
    for (int k = 0; k < self->count; k++)
        if (strcmp(self->data->point[point].text[self->key[k].axis], over_text(self, cell, k)) != 0)
            return false;
    return true;
}

// The point that it is compared with; NULL: none, or itself.
static const study_point *reference_of(const over *self, const study_point *point)
{
    const study_point *reference =
        self->reference.data ? against_reference(&self->reference, point) : NULL;
    return reference == point ? NULL : reference;
}

ld_status over_pool(over *self, int cell, const study_column *const *column, int columns,
                    ld_error *error)
{
    const study_data *data = self->data;
    bool paired = self->reference.data;
    pooled_begin(&self->pool, columns);
    for (int i = 0; i < data->point_count; i++) {
        const study_point *point = &data->point[i], *reference = reference_of(self, point);
        if (!has_point(self, cell, i) || (paired && !reference))
            continue;
        ld_status status = pooled_add(&self->pool, data, point, reference, column, error);
        if (status)
            return status;
    }
    return pooled_end(&self->pool) ? no_memory(error) : LD_OK;
}

bool over_is_reference(const over *self, int cell)
{
    for (int i = 0; i < self->data->point_count; i++)
        if (has_point(self, cell, i) &&
            (!self->reference.data || reference_of(self, &self->data->point[i])))
            return false;
    return true;
}

// ---- in words

void over_reference_text(const over *self, char *text, size_t size)
{
    const against *of = &self->reference;
    text[0] = '\0';
    for (int k = 0; k < self->data->swept_count; k++) {
        const char *value = of->fixed ? of->fixed->text[k] : of->value[k];
        size_t length = strlen(text);
        if (value)
            snprintf(text + length, size - length, "%s%s %s", length ? ", " : "",
                     self->data->swept[k], value);
    }
}

void over_pooled_text(const over *self, char *text, size_t size)
{
    bool first = true;
    text[0] = '\0';
    for (int k = 0; k < self->data->swept_count && self->count > 0; k++) {
        over_key key = {.axis = k};
        ld_error error;
        if (k == self->key[0].axis || (self->count > 1 && k == self->key[1].axis))
            continue;
        bool listed = !list_values(self->data, &key, &error);
        size_t length = strlen(text);
        if (listed)
            snprintf(text + length, size - length, "%s%s (%d values)",
                     first ? "pooled over " : ", ", self->data->swept[k], key.count);
        first = false;
        free(key.text);
        free(key.number);
    }
}
