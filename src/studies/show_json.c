#include "studies/show_json.h"

#include <stdlib.h>

#include "launchdyn/version.h"
#include "results/json.h"
#include "simulation/study_results.h"

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

static void write_statistics(json_writer *json, const group_statistics *of)
{
    json_integer(json, "count", (long long)of->count);
    json_integer(json, "groups", (long long)of->groups);
    write_estimate(json, "mean", &of->mean);
    write_estimate(json, "deviation", &of->deviation);
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
        if (self->view->sensitivity)
            status = write_shares(json, self, point, i, error);
        else
            write_statistics(json, of);
        json_close(json, '}');
    }
    json_close(json, ']');
    return status;
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
        json_close(json, '}');
    }
    json_close(json, ']');
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
        status = write_results(json, self, point, error);
    if (!status && !self->view->sensitivity)
        status = write_ellipses(json, self, point, error);
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
    json_open(&json, "points", '[');
    for (int i = 0; i < data->point_count && !status; i++)
        status = write_point(&json, self, &data->point[i], error);
    json_close(&json, ']');
    json_close(&json, '}');
    fputc('\n', self->stream);
    return status;
}
