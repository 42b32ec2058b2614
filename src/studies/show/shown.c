#include "studies/show/shown.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "quantities/study_results.h"
#include "quantities/summary.h"
#include "studies/statistics/sensitivity.h"

static const char usual[] = "t_front,t_middle,t_rear,exit_speed,spin_rate,since_ignition.pitch,"
                            "since_ignition.yaw,since_ignition.pitch_rate,"
                            "since_ignition.yaw_rate,tip_off.pitch,tip_off.yaw,tip_off.pitch_rate,"
                            "tip_off.yaw_rate,pitch,yaw,pitch_rate,yaw_rate,apogee,downrange,drift,"
                            "time_of_flight,impact_speed,line.reach,"
                            "azimuth.error_rms,azimuth.torque_rms,azimuth.torque_peak,"
                            "azimuth.saturated,azimuth.power_mean,elevation.error_rms,"
                            "elevation.torque_rms,elevation.torque_peak,elevation.saturated,"
                            "elevation.power_mean";
static const char sensitive[] = "t_rear,exit_speed,since_ignition.pitch,since_ignition.yaw,"
                                "since_ignition.pitch_rate,since_ignition.yaw_rate,downrange,drift";

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's statistics");
}

static ld_status add_column(const study_data *data, const char *name, const study_column **list,
                            int *count, ld_error *error)
{
    const char *nearest = NULL;
    const study_column *column = study_data_find(data, name, &nearest);
    if (!column)
        return ld_fail(error, LD_ERR_INPUT, "the study has no result \"%s\"%s%s%s", name,
                       nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                       nearest ? "\"?" : "");
    for (int i = 0; i < *count; i++)
        if (list[i] == column)
            return LD_OK;
    list[(*count)++] = column;
    return LD_OK;
}

// Of a choice, those that there are.
static ld_status add_columns(const study_data *data, const char *names, bool choice,
                             const study_column **list, int *count, ld_error *error)
{
    char *copy = strdup(names), *rest = NULL;
    ld_status status = copy ? LD_OK : no_memory(error);
    for (char *name = copy ? strtok_r(copy, ", ", &rest) : NULL; name && !status;
         name = strtok_r(NULL, ", ", &rest)) {
        status = add_column(data, name, list, count, error);
        status = choice ? LD_OK : status;
    }
    free(copy);
    return status;
}

ld_status shown_add(const study_data *data, const char *names, const study_column **list,
                    int *count, ld_error *error)
{
    ld_status status = add_columns(data, names, false, list, count, error);
    if (!status && *count == 0)
        return ld_fail(error, LD_ERR_INPUT, "\"%s\" names no result", names);
    return status;
}

ld_status shown_add_usual(const study_data *data, const char *names, const study_column **list,
                          int *count, ld_error *error)
{
    return add_columns(data, names, true, list, count, error);
}

void shown_add_measures(const study_data *data, const study_column **list, int *count)
{
    for (int i = 0; i < data->result_count; i++)
        if (study_result_is_measure(data->column[i].name))
            list[(*count)++] = &data->column[i];
}

ld_status shown_choose(shown *self, ld_error *error)
{
    const study_data *data = self->data;
    const ld_study_view *view = self->view;
    self->column = calloc((size_t)data->column_count + 1, sizeof(void *));
    if (!self->column)
        return no_memory(error);
    if (view->what && strcmp(view->what, "all") == 0) {
        for (int i = 0; i < data->result_count; i++)
            self->column[self->count++] = &data->column[i];
        return LD_OK;
    }
    if (view->what)
        return shown_add(data, view->what, self->column, &self->count, error);
    bool few = view->sensitivity || view->over || self->statistic || view->against;
    ld_status status =
        shown_add_usual(data, few ? sensitive : usual, self->column, &self->count, error);
    if (!status)
        shown_add_measures(data, self->column, &self->count);
    return status;
}

group_statistics *shown_statistics(const shown *self, const study_point *point)
{
    return self->of + (point - self->data->point) * self->count;
}

static ld_status compute_point(shown *self, const study_point *point, ld_error *error)
{
    for (int i = 0; i < self->count; i++) {
        study_values *values = &self->values;
        ld_status status = study_data_read(self->data, point, &self->column[i], 1, values, error);
        if (status)
            return status;
        if (statistics_of(values->count ? values->value[0] : NULL, values->group, values->count,
                          &shown_statistics(self, point)[i]))
            return no_memory(error);
    }
    return LD_OK;
}

// Whether any point has a value of it; of the choice a sum that stays 0 is none.
static bool has_values(const shown *self, int column)
{
    const quantity *row = study_result_like(self->column[column]->name);
    bool sum = !self->view->what && row && row->from_zero;
    for (int i = 0; i < self->data->point_count; i++) {
        const group_statistics *of = &shown_statistics(self, &self->data->point[i])[column];
        if (of->count > 0 && !(sum && of->greatest == 0))
            return true;
    }
    return false;
}

// Leaves out what no point has a value of.
static void drop_empty(shown *self)
{
    for (int c = self->count - 1; c >= 0; c--) {
        if (has_values(self, c))
            continue;
        size_t kept = 0, all = (size_t)self->data->point_count * (size_t)self->count;
        for (size_t i = 0; i < all; i++)
            if (i % (size_t)self->count != (size_t)c)
                self->of[kept++] = self->of[i];
        self->count--;
        for (int i = c; i < self->count; i++)
            self->column[i] = self->column[i + 1];
    }
}

ld_status shown_compute(shown *self, ld_error *error)
{
    int points = self->data->point_count;
    self->of = calloc((size_t)points * (size_t)self->count + 1, sizeof *self->of);
    if (!self->of)
        return no_memory(error);
    ld_status status = LD_OK;
    for (int i = 0; i < points && !status; i++)
        status = compute_point(self, &self->data->point[i], error);
    if (!status)
        drop_empty(self);
    return status;
}

// ---- sensitivities and ellipses

ld_status shown_sensitivities(shown *self, const study_point *point, int result, estimate *share,
                              ld_error *error)
{
    const study_data *data = self->data;
    int factors = data->column_count - data->result_count;
    study_values *values = &self->values;
    const study_column **column = calloc((size_t)factors + 1, sizeof(void *));
    if (!column)
        return no_memory(error);
    for (int k = 0; k < factors; k++)
        column[k] = &data->column[data->result_count + k];
    column[factors] = self->column[result];
    ld_status status = study_data_read(data, point, column, factors + 1, values, error);
    for (int k = 0; k < factors && !status; k++)
        share[k] = values->count
                       ? sensitivity_of(values->value[k], values->value[factors], values->sample,
                                        values->group, values->count, column[k]->per_rocket)
                       : (estimate){NAN, NAN, NAN};
    free(column);
    return status;
}

static bool is_shown(const shown *self, const study_column *column)
{
    for (int i = 0; i < self->count; i++)
        if (self->column[i] == column)
            return true;
    return false;
}

static bool is_uncertain(double exit_error)
{
    return exit_error > EXIT_ERROR_NOTED;
}

const shown_share shown_uncertain = {"exit_error.relative", is_uncertain};
const shown_share shown_vertical = {"pitch", near_vertical};

ld_status shown_share_of(shown *self, const study_point *point, const shown_share *share,
                         size_t *known, size_t *above, ld_error *error)
{
    const char *nearest;
    const study_column *column = study_data_find(self->data, share->result, &nearest);
    *known = *above = 0;
    if (!column)
        return LD_OK;
    ld_status status = study_data_read(self->data, point, &column, 1, &self->values, error);
    for (size_t i = 0; i < self->values.count && !status; i++) {
        (*known)++;
        *above += share->counts(self->values.value[0][i]);
    }
    return status;
}

// Reads two results that go together, where both are shown; else there are no values.
static ld_status read_pair(shown *self, const study_point *point, size_t index,
                           const study_column *column[2], ld_error *error)
{
    self->values.count = 0;
    for (int k = 0; k < 2; k++) {
        const char *nearest;
        column[k] = study_data_find(self->data, study_pairs[index].name[k], &nearest);
        if (!is_shown(self, column[k]))
            return LD_OK;
    }
    return study_data_read(self->data, point, column, 2, &self->values, error);
}

ld_status shown_ellipse_of(shown *self, const study_point *point, size_t index,
                           shown_ellipse *ellipse, ld_error *error)
{
    study_values *values = &self->values;
    ellipse->count = 0;
    ld_status status = read_pair(self, point, index, ellipse->column, error);
    if (status || values->count < 3)
        return status;
    covariance_ellipse_of(values->value[0], values->value[1], values->count, &ellipse->of);
    if (!isfinite(ellipse->of.semi_axis[0])) // a value is infinite
        return LD_OK;
    ellipse->count = values->count;
    ellipse->form = normality_of(values->value[0], values->value[1], values->group, values->count);
    return covariance_ellipse_intervals(values->value[0], values->value[1], values->group,
                                        values->count, &ellipse->of, ellipse->axis)
               ? no_memory(error)
               : LD_OK;
}

ld_status shown_footprint_of(shown *self, const study_point *point, footprint_kind kind,
                             footprint *of, ld_error *error)
{
    static const char *const told_with[FOOTPRINT_KINDS][2] = {
        [FOOTPRINT_LANDINGS] = {"downrange", "drift"},
        [FOOTPRINT_LINE] = {"line.reach", "line.reach"}};
    *of = (footprint){.on_line = true};
    for (int k = 0; k < 2; k++) {
        const char *nearest;
        if (!is_shown(self, study_data_find(self->data, told_with[kind][k], &nearest)))
            return LD_OK;
    }
    ld_status status = footprint_read(self->data, point, kind, &self->values, of, error);
    if (!status && of->on_line)
        of->count = 0;
    return status;
}
