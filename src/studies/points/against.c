#include "studies/points/against.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's pairs");
}

// ---- which point

// ", did you mean "NAME"?", or nothing.
static const char *suggestion_text(const name_suggestion *suggestion, char text[512])
{
    text[0] = '\0';
    if (suggestion->name)
        snprintf(text, 512, "; did you mean \"%.400s\"?", suggestion->name);
    return text;
}

static ld_status find_axis(const study_data *data, const char *key, int *axis, ld_error *error)
{
    name_suggestion suggestion = suggestion_begin(key);
    char nearest[512];
    for (*axis = 0; *axis < data->swept_count; (*axis)++) {
        if (strcmp(data->swept[*axis], key) == 0)
            return LD_OK;
        suggestion_offer(&suggestion, data->swept[*axis]);
    }
    return ld_fail(error, LD_ERR_INPUT, "--against %.200s: the study does not sweep it%s", key,
                   suggestion_text(&suggestion, nearest));
}

// Whether two values are written alike but for spaces.
static bool same_value(const char *one, const char *other)
{
    for (;; one++, other++) {
        one += strspn(one, " ");
        other += strspn(other, " ");
        if (*one != *other)
            return false;
        if (!*one)
            return true;
    }
}

// The value of a swept key that is written like `text`, as the study has it.
static ld_status find_value(const study_data *data, int axis, const char *text, const char **value,
                            ld_error *error)
{
    name_suggestion suggestion = suggestion_begin(text);
    char nearest[512];
    for (int i = 0; i < data->point_count; i++) {
        *value = data->point[i].text[axis];
        if (same_value(*value, text))
            return LD_OK;
        suggestion_offer(&suggestion, *value);
    }
    return ld_fail(error, LD_ERR_INPUT,
                   "--against %.200s: no point of the study has \"%.200s\" there%s",
                   data->swept[axis], text, suggestion_text(&suggestion, nearest));
}

// Cuts the first KEY=VALUE off a list, at a comma outside brackets; returns what follows.
static char *cut_item(char *text)
{
    int depth = 0;
    for (; *text; text++) {
        depth += strchr("[{(", *text) ? 1 : strchr("]})", *text) ? -1 : 0;
        if (*text == ',' && depth <= 0) {
            *text = '\0';
            return text + 1;
        }
    }
    return text;
}

static char *trimmed(char *text)
{
    text += strspn(text, " ");
    for (size_t length = strlen(text); length > 0 && text[length - 1] == ' '; length--)
        text[length - 1] = '\0';
    return text;
}

static ld_status read_item(against *self, char *item, ld_error *error)
{
    const study_data *data = self->data;
    char *equals = strchr(item, '=');
    int axis;
    if (!equals)
        return ld_fail(error, LD_ERR_INPUT,
                       "--against: found \"%.200s\"; expected the number of a point, from 1 to %d, "
                       "or KEY=VALUE of a swept key, such as \"%.200s=%.200s\"",
                       trimmed(item), data->point_count, data->swept[0], data->point[0].text[0]);
    *equals = '\0';
    char *key = trimmed(item);
    ld_status status = find_axis(data, key, &axis, error);
    if (!status && self->value[axis])
        status = ld_fail(error, LD_ERR_INPUT, "--against %.200s: given twice", key);
    return status ? status : find_value(data, axis, trimmed(equals + 1), &self->value[axis], error);
}

static ld_status read_number(against *self, const char *text, ld_error *error)
{
    const study_data *data = self->data;
    long long number = strtoll(text, NULL, 10);
    if (number < 1 || number > data->point_count)
        return ld_fail(error, LD_ERR_INPUT,
                       "--against: the study has no point %.40s; they go from 1 to %d", text,
                       data->point_count);
    self->fixed = &data->point[number - 1];
    return LD_OK;
}

static ld_status read_items(against *self, char *item, ld_error *error)
{
    ld_status status;
    do {
        char *next = cut_item(item);
        status = read_item(self, item, error);
        item = next;
    } while (!status && *item);
    return status;
}

static bool refers_to(const against *self, const study_point *point, const study_point *reference)
{
    for (int k = 0; k < self->data->swept_count; k++) {
        const char *value = self->value[k] ? self->value[k] : point->text[k];
        if (strcmp(reference->text[k], value) != 0)
            return false;
    }
    return true;
}

const study_point *against_reference(const against *self, const study_point *point)
{
    const study_data *data = self->data;
    for (int i = 0; i < data->point_count && !self->fixed; i++)
        if (refers_to(self, point, &data->point[i]))
            return &data->point[i];
    return self->fixed;
}

// A sweep has all combinations of its values.
static ld_status check_references(const against *self, ld_error *error)
{
    const study_data *data = self->data;
    for (int i = 0; i < data->point_count; i++)
        if (!against_reference(self, &data->point[i]))
            return ld_fail(error, LD_ERR_INPUT,
                           "--against: the study has no point to compare point %d with", i + 1);
    return LD_OK;
}

static ld_status read_values(against *self, const char *text, ld_error *error)
{
    char *copy = strdup(text);
    self->value = calloc((size_t)self->data->swept_count, sizeof *self->value);
    ld_status status = copy && self->value ? read_items(self, copy, error) : no_memory(error);
    free(copy);
    return status ? status : check_references(self, error);
}

ld_status against_read(const char *text, const study_data *data, against *self, ld_error *error)
{
    bool number = *text && !text[strspn(text, "0123456789")];
    *self = (against){.data = data};
    ld_status status =
        data->point_count < 2 || data->swept_count < 1
            ? ld_fail(error, LD_ERR_INPUT,
                      "--against compares points of a sweep; this study has one point only")
        : number ? read_number(self, text, error)
                 : read_values(self, text, error);
    if (status)
        against_free(self);
    return status;
}

void against_free(against *self)
{
    free(self->value);
    *self = (against){0};
}

// ---- pairs

static int64_t draw_of(const study_data *data, const study_values *values, size_t i)
{
    return (values->sample[i] - 1) / data->point_count;
}

// Below 0: the first's rocket comes before the second's in order of (draw, rocket).
static int compare(const study_data *data, const study_values values[2], const size_t at[2])
{
    int64_t draw[2] = {draw_of(data, &values[0], at[0]), draw_of(data, &values[1], at[1])};
    int rocket[2] = {values[0].rocket[at[0]], values[1].rocket[at[1]]};
    return draw[0] != draw[1] ? (draw[0] > draw[1]) - (draw[0] < draw[1])
                              : (rocket[0] > rocket[1]) - (rocket[0] < rocket[1]);
}

static void keep_row(study_values *values, size_t from, size_t to, int columns)
{
    values->sample[to] = values->sample[from];
    values->group[to] = values->group[from];
    values->rocket[to] = values->rocket[from];
    for (int c = 0; c < columns; c++)
        values->value[c][to] = values->value[c][from];
}

// Leaves what both have, in the same rows.
static void keep_common(const study_data *data, study_values values[2], int columns)
{
    size_t at[2] = {0}, kept = 0;
    while (at[0] < values[0].count && at[1] < values[1].count) {
        int order = compare(data, values, at);
        if (order == 0) {
            for (int k = 0; k < 2; k++)
                keep_row(&values[k], at[k], kept, columns);
            kept++;
        }
        at[0] += order <= 0;
        at[1] += order >= 0;
    }
    values[0].count = values[1].count = kept;
}

ld_status against_read_pairs(const paired_points *points, const study_column *const *column,
                             int columns, study_values values[2], paired_values *pairs,
                             ld_error *error)
{
    const study_data *data = points->data;
    ld_status status = study_data_read(data, points->point, column, columns, &values[0], error);
    if (!status)
        status = study_data_read(data, points->reference, column, columns, &values[1], error);
    if (status)
        return status;
    keep_common(data, values, columns);
    *pairs = (paired_values){.columns = columns,
                             .sample = values[0].sample,
                             .group = values[0].group,
                             .count = values[0].count};
    for (int c = 0; c < columns; c++) {
        pairs->value[c] = values[0].value[c];
        pairs->reference[c] = values[1].value[c];
    }
    return LD_OK;
}
