#include "studies/show/show_json.h"

#include <stdlib.h>

#include "launchdyn/version.h"
#include "quantities/study_results.h"
#include "results/json.h"
#include "studies/show/show_influence.h"

enum { FORMAT = 1, MOST_FAILURES = 20 };

static void write_interval(json_writer *json, const estimate *e)
{
    json_number(json, "value", e->value);
    json_number(json, "low", e->low);
    json_number(json, "high", e->high);
}

static void write_estimate(json_writer *json, const char *key, const estimate *e)
{
    json_open(json, key, '{');
    write_interval(json, e);
    json_close(json, '}');
}

static ld_status write_counts(json_writer *json, const shown *self, const study_point *point,
                              ld_error *error)
{
    study_failure failure[MOST_FAILURES];
    int count;
    ld_status status =
        study_data_failures(self->data, point, failure, MOST_FAILURES, &count, error);
    json_integer(json, "asked", point->asked);
    json_integer(json, "done", point->done);
    json_integer(json, "failed", point->failed);
    json_open(json, "failures", '[');
    for (int i = 0; i < count && !status; i++) {
        json_open(json, NULL, '{');
        json_integer(json, "count", failure[i].count);
        json_integer(json, "first", failure[i].first);
        json_text(json, "status", failure[i].status);
        json_text(json, "reason", failure[i].reason);
        json_close(json, '}');
    }
    json_close(json, ']');
    return status;
}

static ld_status write_share(json_writer *json, const char *name, const shown_share *share,
                             shown *self, const study_point *point, ld_error *error)
{
    size_t known, above;
    ld_status status = shown_share_of(self, point, share, &known, &above, error);
    json_open(json, name, '{');
    json_integer(json, "known", (long long)known);
    json_integer(json, "above", (long long)above);
    json_close(json, '}');
    return status;
}

static void write_moments(json_writer *json, const group_statistics *of)
{
    json_integer(json, "count", (long long)of->count);
    json_integer(json, "groups", (long long)of->groups);
    write_estimate(json, "mean", &of->mean);
    write_estimate(json, "deviation", &of->deviation);
}

static void write_statistics(json_writer *json, const group_statistics *of)
{
    write_moments(json, of);
    json_number(json, "skewness", of->skewness);
    json_number(json, "least", of->least);
    json_number(json, "greatest", of->greatest);
    json_open(json, "quantiles", '[');
    for (int k = 0; k < STATISTICS_QUANTILES; k++) {
        json_open(json, NULL, '{');
        json_number(json, "level", statistics_level[k]);
        write_interval(json, &of->quantile[k]);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static ld_status write_shares(json_writer *json, shown *self, const study_point *point, int result,
                              ld_error *error)
{
    const study_data *data = self->data;
    int factors = data->column_count - data->result_count;
    estimate *share = calloc((size_t)factors + 1, sizeof *share);
    if (!share)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's sensitivities");
    ld_status status = shown_sensitivities(self, point, result, share, error);
    json_open(json, "factors", '[');
    for (int k = 0; k < factors && !status; k++) {
        if (data->column[data->result_count + k].seed)
            continue;
        json_open(json, NULL, '{');
        json_text(json, "path", data->column[data->result_count + k].name);
        write_estimate(json, "share", &share[k]);
        json_close(json, '}');
    }
    json_close(json, ']');
    free(share);
    return status;
}

static ld_status write_results(json_writer *json, shown *self, const study_point *point,
                               ld_error *error)
{
    ld_status status = LD_OK;
    json_open(json, "results", '[');
    for (int i = 0; i < self->count && !status; i++) {
        const group_statistics *of = &shown_statistics(self, point)[i];
        if (of->count == 0)
            continue;
        json_open(json, NULL, '{');
        json_text(json, "name", self->column[i]->name);
        json_text(json, "unit", self->column[i]->unit);
        if (self->view->sensitivity && influence_kind_of(self->data) == INFLUENCE_SHARES)
            status = write_shares(json, self, point, i, error);
        else if (self->view->sensitivity)
            status = show_influences_json(json, self, point, i, error);
        else
            write_statistics(json, of);
        json_close(json, '}');
    }
    json_close(json, ']');
    return status;
}

static void write_normality(json_writer *json, const normality *of)
{
    json_open(json, "normality", '{');
    json_truth(json, "tested", of->tested);
    json_truth(json, "normal", of->normal);
    json_number(json, "effective", of->effective);
    json_number(json, "skewness", of->skewness);
    json_number(json, "kurtosis", of->kurtosis);
    json_open(json, "chance", '[');
    json_number(json, NULL, of->chance[0]);
    json_number(json, NULL, of->chance[1]);
    json_close(json, ']');
    json_close(json, '}');
}

static ld_status write_ellipses(json_writer *json, shown *self, const study_point *point,
                                ld_error *error)
{
    ld_status status = LD_OK;
    json_open(json, "ellipses", '[');
    for (size_t i = 0; i < STUDY_PAIRS && !status; i++) {
        shown_ellipse e;
        status = shown_ellipse_of(self, point, i, &e, error);
        if (status || e.count == 0)
            continue;
        json_open(json, NULL, '{');
        json_open(json, "of", '[');
        json_text(json, NULL, e.column[0]->name);
        json_text(json, NULL, e.column[1]->name);
        json_close(json, ']');
        json_text(json, "unit", e.column[0]->unit);
        json_integer(json, "count", (long long)e.count);
        json_open(json, "centre", '[');
        json_number(json, NULL, e.of.mean[0]);
        json_number(json, NULL, e.of.mean[1]);
        json_close(json, ']');
        json_open(json, "semi_axes", '[');
        write_estimate(json, NULL, &e.axis[0]);
        write_estimate(json, NULL, &e.axis[1]);
        json_close(json, ']');
        json_number(json, "angle", e.of.angle);
        write_normality(json, &e.form);
        json_close(json, '}');
    }
    json_close(json, ']');
    return status;
}

// Empty where rockets do not land, or on one line, or without line.
static ld_status write_footprints(json_writer *json, shown *self, const study_point *point,
                                  footprint_kind kind, ld_error *error)
{
    footprint *of = malloc(sizeof *of);
    if (!of)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the footprints");
    ld_status status = shown_footprint_of(self, point, kind, of, error);
    json_open(json, kind == FOOTPRINT_LINE ? "line_footprints" : "footprints", '[');
    for (int k = 0; k < FOOTPRINT_SHARES && !status && of->count > 0; k++) {
        const footprint_region *region = &of->region[k];
        json_open(json, NULL, '{');
        json_number(json, "share", region->share);
        json_truth(json, "stated", region->stated);
        json_number(json, "needed", region->needed);
        json_number(json, "independent", region->independent);
        write_estimate(json, "content", &region->content);
        write_estimate(json, "area", &region->area);
        write_estimate(json, "distance", &region->distance);
        json_close(json, '}');
    }
    json_close(json, ']');
    free(of);
    return status;
}

// ---- against a point

static void write_difference(void *self, const study_column *const *column, int columns,
                             const paired_statistics *of)
{
    json_writer *json = self;
    json_open(json, NULL, '{');
    json_open(json, "of", '[');
    for (int k = 0; k < columns; k++)
        json_text(json, NULL, column[k]->name);
    json_close(json, ']');
    json_text(json, "unit", column[0]->unit);
    json_integer(json, "pairs", (long long)of->count);
    json_integer(json, "groups", (long long)of->groups);
    if (columns == 1)
        write_estimate(json, "difference", &of->difference);
    write_estimate(json, "ratio", &of->spread);
    write_estimate(json, "ratio_within", &of->within);
    json_close(json, '}');
}

static ld_status write_against(json_writer *json, shown *self, const study_point *point,
                               ld_error *error)
{
    json_integer(json, "reference", against_reference(&self->reference, point)->number);
    json_open(json, "differences", '[');
    ld_status status = show_against_each(&self->pairs, point, write_difference, json, error);
    json_close(json, ']');
    return status;
}

// ---- beside measured launches

static void write_side(json_writer *json, const char *key, const group_statistics *of)
{
    json_open(json, key, '{');
    write_moments(json, of);
    json_close(json, '}');
}

// An estimate with its p.
static void write_tested(json_writer *json, const char *key, const estimate *e, double chance)
{
    json_open(json, key, '{');
    write_interval(json, e);
    json_number(json, "chance", chance);
    json_close(json, '}');
}

static ld_status write_measured(json_writer *json, shown *self, const study_point *point,
                                ld_error *error)
{
    const study_data *data = self->data;
    ld_status status = LD_OK;
    json_open(json, "comparisons", '[');
    for (int i = 0; i < self->launches.results && !status; i++) {
        const measured_result *result = &self->launches.result[i];
        const char *nearest;
        measured_comparison of;
        status = show_measured_result(result, data, point, &self->values, &of, error);
        if (status)
            break;
        json_open(json, NULL, '{');
        json_text(json, "name", result->name);
        json_text(json, "unit", study_data_find(data, result->name, &nearest)->unit);
        write_side(json, "measured", &of.measured);
        write_side(json, "simulated", &of.simulated);
        write_tested(json, "difference", &of.by.mean, of.by.mean_chance);
        write_tested(json, "ratio", &of.by.deviation, of.by.deviation_chance);
        json_close(json, '}');
    }
    json_close(json, ']');
    return status;
}

// ---- all

// What the view asks for.
static ld_status write_view(json_writer *json, shown *self, const study_point *point,
                            ld_error *error)
{
    if (self->view->measured)
        return write_measured(json, self, point, error);
    if (self->view->against)
        return write_against(json, self, point, error);
    ld_status status = write_results(json, self, point, error);
    if (!status && !self->view->sensitivity)
        status = write_ellipses(json, self, point, error);
    if (!status && !self->view->sensitivity)
        status = write_footprints(json, self, point, FOOTPRINT_LANDINGS, error);
    if (!status && !self->view->sensitivity)
        status = write_footprints(json, self, point, FOOTPRINT_LINE, error);
    return status;
}

static ld_status write_point(json_writer *json, shown *self, const study_point *point,
                             ld_error *error)
{
    const study_data *data = self->data;
    json_open(json, NULL, '{');
    json_integer(json, "number", point->number);
    json_open(json, "swept", '{');
    for (int k = 0; k < data->swept_count; k++)
        json_text(json, data->swept[k], point->text[k]);
    json_close(json, '}');
    ld_status status = write_counts(json, self, point, error);
    if (!status)
        status = write_share(json, "exit_errors", &shown_uncertain, self, point, error);
    if (!status)
        status = write_share(json, "near_vertical", &shown_vertical, self, point, error);
    if (!status)
        status = write_view(json, self, point, error);
    json_close(json, '}');
    return status;
}

ld_status show_json(shown *self, ld_error *error)
{
    const study_data *data = self->data;
    json_writer json = {.file = self->stream};
    ld_status status = LD_OK;
    json_open(&json, NULL, '{');
    json_integer(&json, "format", FORMAT);
    json_text(&json, "version", LD_VERSION);
    json_text(&json, "title", data->title ? data->title : "");
    json_integer(&json, "asked", data->asked);
    if (self->view->measured) {
        json_integer(&json, "launches", (long long)self->launches.count);
        json_integer(&json, "salvos", (long long)self->launches.salvos);
    }
    json_open(&json, "points", '[');
    for (int i = 0; i < data->point_count && !status; i++)
        status = write_point(&json, self, &data->point[i], error);
    json_close(&json, ']');
    json_close(&json, '}');
    fputc('\n', self->stream);
    return status;
}
