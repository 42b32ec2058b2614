// A study's data as a handle.
#include <math.h>
#include <stdlib.h>

#include "quantities/study_results.h"
#include "studies/points/footprint.h"
#include "studies/points/influence.h"
#include "studies/points/over_statistic.h"
#include "studies/statistics/sensitivity.h"
#include "studies/store/study_data.h"

struct ld_study_data {
    study_data data;
    study_values read;
    ld_study_values told;
    group_statistics statistics;
    footprint footprint;
    over over; // asked last, whose texts the cells have
    ld_study_cell *cell;
    ld_study_influence *influence;
};

ld_status ld_study_data_open(const char *folder, ld_study_data **out, ld_error *error)
{
    ld_study_data *self = calloc(1, sizeof *self);
    *out = NULL;
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a study's data");
    ld_status status = study_data_open(folder, &self->data, error);
    if (status)
        free(self);
    else
        *out = self;
    return status;
}

void ld_study_data_close(ld_study_data *self)
{
    if (!self)
        return;
    study_values_free(&self->read);
    over_close(&self->over);
    free(self->cell);
    free(self->influence);
    study_data_close(&self->data);
    free(self);
}

const ld_study_column *ld_study_data_column(const ld_study_data *self, int index)
{
    return index >= 0 && index < self->data.column_count ? &self->data.column[index] : NULL;
}

const char *ld_study_data_swept(const ld_study_data *self, int axis)
{
    return axis >= 0 && axis < self->data.swept_count ? self->data.swept[axis] : NULL;
}

const ld_study_point *ld_study_data_point(const ld_study_data *self, int number)
{
    return number >= 1 && number <= self->data.point_count ? &self->data.point[number - 1] : NULL;
}

// Reads columns of a point; what there is of them comes into self->read.
static ld_status read_columns(ld_study_data *self, int number, const char *const *names,
                              size_t count, ld_error *error)
{
    const ld_study_point *point = ld_study_data_point(self, number);
    if (!point)
        return ld_fail(error, LD_ERR_INPUT, "found point %d, expected 1 to %d", number,
                       self->data.point_count);
    const study_column **column = calloc(count ? count : 1, sizeof(void *));
    ld_status status =
        column ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for a study's data");
    for (size_t i = 0; i < count && !status; i++) {
        const char *nearest = NULL;
        column[i] = study_data_find(&self->data, names[i], &nearest);
        if (!column[i])
            status = ld_fail(error, LD_ERR_INPUT, "the study has no column \"%s\"%s%s%s", names[i],
                             nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                             nearest ? "\"?" : "");
    }
    if (!status)
        status = study_data_read(&self->data, point, column, (int)count, &self->read, error);
    free(column);
    return status;
}

ld_status ld_study_data_values(ld_study_data *self, int point, const char *const *names,
                               size_t columns, const ld_study_values **values, ld_error *error)
{
    ld_status status = read_columns(self, point, names, columns, error);
    *values = NULL;
    if (status)
        return status;
    self->told = (ld_study_values){.count = self->read.count,
                                   .sample = self->read.sample,
                                   .rocket = self->read.rocket,
                                   .value = (const double *const *)self->read.value};
    *values = &self->told;
    return LD_OK;
}

ld_status ld_study_data_statistics(ld_study_data *self, int point, const char *name,
                                   const ld_study_statistics **statistics, ld_error *error)
{
    const study_values *read = &self->read;
    ld_status status = read_columns(self, point, &name, 1, error);
    *statistics = NULL;
    if (status)
        return status;
    status = statistics_of(read->count ? read->value[0] : NULL, read->group, read->count,
                           &self->statistics);
    if (status)
        return ld_fail(error, status, "no memory for the study's statistics");
    *statistics = &self->statistics;
    return LD_OK;
}

ld_status ld_study_data_sensitivity(ld_study_data *self, int point, const char *result,
                                    const char *factor, ld_estimate *share, ld_error *error)
{
    const char *const names[] = {factor, result}, *nearest;
    const study_values *read = &self->read;
    ld_status status = read_columns(self, point, names, 2, error);
    *share = (ld_estimate){NAN, NAN, NAN};
    if (!status && read->count)
        *share =
            sensitivity_of(read->value[0], read->value[1], read->sample, read->group, read->count,
                           study_data_find(&self->data, factor, &nearest)->per_rocket);
    return status;
}

static ld_study_influence told_of(const influence *of, influence_kind kind)
{
    const bool effects = kind == INFLUENCE_EFFECTS;
    return (ld_study_influence){.factor = of->factor->name,
                                .first = of->indices.first,
                                .total = of->indices.total,
                                .together = of->indices.together,
                                .mu_star = of->effects.magnitude,
                                .mu = of->effects.mean,
                                .sigma = of->effects.deviation,
                                .count = effects ? of->effects.count : of->indices.count,
                                .groups = effects ? of->effects.groups : of->indices.groups};
}

ld_status ld_study_data_influences(ld_study_data *self, int point, const char *result,
                                   const ld_study_influence **list, size_t *count, ld_error *error)
{
    const study_data *data = &self->data;
    const char *nearest;
    int found = 0;
    *list = NULL;
    *count = 0;
    ld_status status = read_columns(self, point, &result, 1, error);
    if (status)
        return status;
    influence *all = calloc((size_t)data->column_count + 1, sizeof *all);
    free(self->influence);
    self->influence = calloc((size_t)data->column_count + 1, sizeof *self->influence);
    const influence_question question = {data, &data->point[point - 1],
                                         study_data_find(data, result, &nearest), LD_INDEX_USUAL};
    status = all && self->influence ? influences_of(&question, &self->read, all, &found, error)
                                    : ld_fail(error, LD_ERR_MEMORY, "no memory for a study's data");
    for (int i = 0; i < found && !status; i++)
        self->influence[i] = told_of(&all[i], influence_kind_of(data));
    free(all);
    *list = status ? NULL : self->influence;
    *count = status ? 0 : (size_t)found;
    return status;
}

ld_status ld_study_data_footprint(ld_study_data *self, int point, double share,
                                  const ld_study_footprint **found, ld_error *error)
{
    const footprint *of = &self->footprint;
    ld_status status = read_columns(self, point, study_pairs[STUDY_LANDING].name, 2, error);
    *found = NULL;
    if (status)
        return status;
    status = footprint_of_values(&self->read, &self->footprint);
    if (status)
        return ld_fail(error, status, "no memory for the study's footprints");
    if (of->on_line)
        return ld_fail(error, LD_ERR_INPUT, "point %d has no footprints: %s", point,
                       of->count < 3 ? "fewer than three rockets have landed"
                                     : "all rockets land on one line");
    for (int k = 0; k < FOOTPRINT_SHARES; k++)
        if (of->region[k].share == share)
            *found = &of->region[k];
    return *found ? LD_OK
                  : ld_fail(error, LD_ERR_INPUT,
                            "there is no footprint of a share of %g: they are of 0.95, 0.99 and "
                            "0.999",
                            share);
}

// ---- over swept keys

static ld_study_cell cell_of(const over *of, int index, const over_found *found)
{
    ld_study_cell cell = {.number = {NAN, NAN},
                          .unit = {"", ""},
                          .estimate = found->of,
                          .count = found->count,
                          .groups = found->groups,
                          .points = found->points,
                          .reference = found->reference};
    for (int k = 0; k < of->count; k++) {
        const over_key *key = &of->key[k];
        cell.text[k] = over_text(of, index, k);
        cell.number[k] = key->numeric ? key->number[over_value_of(of, index, k)] : NAN;
        cell.unit[k] = key->numeric ? key->unit : "";
    }
    return cell;
}

static ld_status find_result(const ld_study_data *self, const ld_study_over *question,
                             const over_statistic *statistic, const study_column **result,
                             ld_error *error)
{
    const char *nearest = NULL;
    *result = question->result ? study_data_find(&self->data, question->result, &nearest) : NULL;
    if (*result || (!question->result && statistic->kind == OVER_FOOTPRINT))
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "the study has no column \"%.200s\"%s%s%s",
                   question->result ? question->result : "", nearest ? "; did you mean \"" : "",
                   nearest ? nearest : "", nearest ? "\"?" : "");
}

static ld_status fill_cells(ld_study_data *self, const over_statistic *statistic,
                            const study_column *result, size_t *count, ld_error *error)
{
    int cells = over_cell_count(&self->over);
    ld_status status = LD_OK;
    free(self->cell);
    self->cell = calloc((size_t)cells + 1, sizeof *self->cell);
    if (!self->cell)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a study's data");
    for (int i = 0; i < cells && !status; i++) {
        over_found found;
        status = over_find(&self->over, i, statistic, result, &found, error);
        self->cell[i] = cell_of(&self->over, i, &found);
    }
    *count = (size_t)cells;
    return status;
}

ld_status ld_study_data_pool(ld_study_data *self, const ld_study_over *question,
                             const ld_study_cell **cell, size_t *count, ld_error *error)
{
    const study_data *data = &self->data;
    const char *first = data->swept_count > 0 ? data->swept[0] : "";
    over_statistic statistic;
    const study_column *result;
    *cell = NULL;
    *count = 0;
    over_close(&self->over);
    ld_status status = over_statistic_read(question->statistic, &statistic, error);
    if (!status)
        status = over_open(question->over ? question->over : first, question->against, data,
                           &self->over, error);
    if (!status)
        status = find_result(self, question, &statistic, &result, error);
    if (!status)
        status = fill_cells(self, &statistic, result, count, error);
    *cell = status ? NULL : self->cell;
    return status;
}
