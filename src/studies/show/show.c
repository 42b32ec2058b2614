// What a study's folder holds, printed: counts, statistics, sensitivities, point by point and side
// by side; lines of 120 characters, more where names are long.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "base/printed.h"
#include "launchdyn/study.h"
#include "quantities/study_results.h"
#include "quantities/summary.h"
#include "studies/show/show_influence.h"
#include "studies/show/show_json.h"
#include "studies/show/show_numbers.h"
#include "studies/show/show_over.h"
#include "studies/show/shown.h"
#include "studies/statistics/statistics.h"
#include "studies/store/table_file.h"

// ---- a point

static ld_status print_counts(const shown *self, const study_point *point, ld_error *error)
{
    enum { MOST = 20 };
    study_failure failure[MOST];
    int count;
    ld_status status = study_data_failures(self->data, point, failure, MOST, &count, error);
    fprintf(self->stream,
            point->done > point->asked ? "%" PRId64 " samples kept, %" PRId64 " asked for, %" PRId64
                                         " failed\n"
                                       : "%" PRId64 " of %" PRId64 " samples, %" PRId64 " failed\n",
            point->done, point->asked, point->failed);
    for (int i = 0; i < count && !status; i++)
        fprintf(self->stream, "  %" PRId64 " failed (%s), the first of them %" PRId64 ": %s\n",
                failure[i].count, VISIBLE(failure[i].status), failure[i].first,
                VISIBLE(failure[i].reason));
    return status;
}

// How many rockets left with rates that the errors of the steps leave uncertain.
static ld_status print_exit_errors(shown *self, const study_point *point, ld_error *error)
{
    size_t known, above;
    ld_status status = shown_share_of(self, point, &shown_uncertain, &known, &above, error);
    if (above > 0 && !status)
        fprintf(self->stream,
                "exit rates off by more than %g %% through integration errors: %.3g %% of %zu "
                "rockets\n",
                100 * EXIT_ERROR_NOTED, 100 * (double)above / (double)known, known);
    return status;
}

// How many left where yaw in the ground frame is singular.
static ld_status print_vertical(shown *self, const study_point *point, ld_error *error)
{
    size_t known, above;
    ld_status status = shown_share_of(self, point, &shown_vertical, &known, &above, error);
    if (above > 0 && !status)
        fprintf(self->stream,
                "%.3g %% of %zu rockets leave near the vertical, where yaw, yaw_rate and "
                "pitch_rate are not meaningful: see since_ignition\n",
                100 * (double)above / (double)known, known);
    return status;
}

static void print_statistics(const shown *self, const group_statistics *of)
{
    FILE *stream = self->stream;
    const int width = show_name_width(self->column, self->count);
    fprintf(stream, "\n%-*s %-25s %-33s %8s %11s %11s\n", width, "", "mean", "standard deviation",
            "skewness", "least", "greatest");
    for (int i = 0; i < self->count; i++) {
        const group_statistics s = show_in_unit(&of[i], self->column[i]);
        if (s.count == 0)
            continue;
        show_result(stream, width, self->column[i]);
        show_half(stream, 25, &s.mean, 6);
        show_estimate(stream, 33, &s.deviation, NAN);
        show_number(stream, 8, s.skewness, 3);
        show_number(stream, 11, s.least, show_digits(s.least, s.deviation.value, 6));
        show_number(stream, 11, s.greatest, show_digits(s.greatest, s.deviation.value, 6));
        fputc('\n', stream);
    }
    fprintf(stream, "\n%-*s %-30s %-30s %s\n", width, "", "5 %", "median", "95 %");
    for (int i = 0; i < self->count; i++) {
        const group_statistics s = show_in_unit(&of[i], self->column[i]);
        if (s.count == 0)
            continue;
        show_result(stream, width, self->column[i]);
        for (int k = 0; k < STATISTICS_QUANTILES; k++)
            show_estimate(stream, k + 1 < STATISTICS_QUANTILES ? 30 : 0, &s.quantile[k],
                          s.deviation.value);
        fputc('\n', stream);
    }
}

// Whether any result shown takes more than one value there.
static bool has_scatter(const shown *self, const group_statistics *of)
{
    for (int i = 0; i < self->count; i++)
        if (of[i].greatest > of[i].least)
            return true;
    return false;
}

// Of a point at which nothing scatters; several points stand side by side in any case.
static void print_values(const shown *self, const group_statistics *of)
{
    fputs("every result has one value\n", self->stream);
    if (self->data->point_count > 1)
        return;
    fputc('\n', self->stream);
    for (int i = 0; i < self->count; i++) {
        if (of[i].count == 0)
            continue;
        char value[32];
        show_text(value, show_in_unit(&of[i], self->column[i]).mean.value, 6);
        show_result(self->stream, show_name_width(self->column, self->count), self->column[i]);
        fprintf(self->stream, " %s\n", value);
    }
}

// The widest count of values among what is shown; NULL: there are none.
static const group_statistics *most_values(const shown *self, const group_statistics *of)
{
    const group_statistics *most = NULL;
    for (int i = 0; i < self->count; i++)
        if (of[i].count > (most ? most->count : 0))
            most = &of[i];
    return most;
}

// ---- ellipses

static void print_normality(FILE *stream, const normality *of)
{
    fputs("    Mardia's test of a normal distribution: ", stream);
    if (!of->tested) {
        fprintf(stream, "too few independent rockets, %.3g of %d\n", of->effective,
                NORMALITY_LEAST);
        return;
    }
    fprintf(stream, "p of skewness %.2g, of kurtosis %.2g: %s at %.3g %%\n", of->chance[0],
            of->chance[1], of->normal ? "not refused" : "refused", 100 * normality_level);
}

static void print_ellipse(FILE *stream, const shown_ellipse *e)
{
    const double degrees = 57.295779513082321;
    const study_column *const *pair = e->column;
    const study_unit unit = study_result_unit(pair[0]->name, pair[0]->unit);
    const double to = unit.factor;
    fprintf(stream, "%s and %s [%s]: centre %.6g, %.6g; %zu rockets\n", VISIBLE(pair[0]->name),
            VISIBLE(pair[1]->name), VISIBLE(unit.name), to * e->of.mean[0], to * e->of.mean[1],
            e->count);
    const estimate axis[] = {show_scaled(&e->axis[0], to), show_scaled(&e->axis[1], to)};
    fputs("    semi-axes of one standard deviation", stream);
    show_estimate(stream, 0, &axis[0], NAN);
    fputs(" and", stream);
    show_estimate(stream, 0, &axis[1], NAN);
    fprintf(stream,
            "\n    of 95 %% of a normal distribution %.4g and %.4g; the long one %.4g deg from %s "
            "towards %s\n",
            ellipse_radius * to * e->of.semi_axis[0], ellipse_radius * to * e->of.semi_axis[1],
            e->of.angle * degrees, VISIBLE(pair[0]->name), VISIBLE(pair[1]->name));
    print_normality(stream, &e->form);
}

static ld_status print_ellipses(shown *self, const study_point *point, ld_error *error)
{
    bool first = true;
    for (size_t i = 0; i < STUDY_PAIRS; i++) {
        shown_ellipse ellipse;
        ld_status status = shown_ellipse_of(self, point, i, &ellipse, error);
        if (status)
            return status;
        if (ellipse.count == 0)
            continue;
        fputs(first ? "\n" : "", self->stream);
        first = false;
        print_ellipse(self->stream, &ellipse);
    }
    return LD_OK;
}

// ---- footprints

static void print_footprint(FILE *stream, footprint_kind kind, const footprint *of)
{
    static const char *const told[FOOTPRINT_KINDS][3] = {
        [FOOTPRINT_LANDINGS] = {"where landings lie", "rockets", "the launch point"},
        [FOOTPRINT_LINE] = {"where the line lies", "places of lines", "the origin of I"}};
    fprintf(stream,
            "\nfootprints, for range safety: %s; %zu %s, 95 %% intervals\n"
            "%-8s %-30s %-36s farthest from %s [m]\n",
            told[kind][0], of->count, told[kind][1], "", "lie within [%]", "area [m2]",
            told[kind][2]);
    for (int k = 0; k < FOOTPRINT_SHARES; k++) {
        const footprint_region *region = &of->region[k];
        char name[32];
        snprintf(name, sizeof name, "%.4g %%", 100 * region->share);
        fprintf(stream, "%-8s", name);
        if (!region->stated) {
            char why[128];
            footprint_why_not(kind, region, why);
            fprintf(stream, " %s\n", why);
            continue;
        }
        const estimate content = {100 * region->content.value, 100 * region->content.low,
                                  100 * region->content.high};
        show_estimate(stream, 30, &content, content.high - content.low);
        show_estimate(stream, 36, &region->area, NAN);
        show_estimate(stream, 0, &region->distance, NAN);
        fputc('\n', stream);
    }
}

static ld_status print_footprints(shown *self, const study_point *point, ld_error *error)
{
    footprint *of = malloc(sizeof *of);
    if (!of)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the footprints");
    ld_status status = LD_OK;
    for (int kind = 0; kind < FOOTPRINT_KINDS && !status; kind++) {
        status = shown_footprint_of(self, point, (footprint_kind)kind, of, error);
        if (!status && of->count > 0)
            print_footprint(self->stream, (footprint_kind)kind, of);
    }
    free(of);
    return status;
}

// ---- sensitivities

// "64+-7", in percent
static void print_share(FILE *stream, int width, estimate e)
{
    char text[64];
    double half = 50 * (e.high - e.low), value = 100 * fmax(0, e.value);
    if (isnan(e.value))
        snprintf(text, sizeof text, "-");
    else if (isnan(half))
        snprintf(text, sizeof text, "%.0f", value);
    else
        snprintf(text, sizeof text, half < 1 ? "%.1f+-%.1f" : "%.0f+-%.0f", value, half);
    fprintf(stream, " %*s", width, text);
}

static int share_width(const study_column *column)
{
    int length = (int)strlen(VISIBLE(column->name));
    return length > 9 ? length : 9;
}

static void print_shares(const shown *self, const estimate *share)
{
    const study_data *data = self->data;
    int factors = data->column_count - data->result_count;
    fprintf(self->stream,
            "\n%% of the variance that each factor explains alone, estimated from "
            "these samples; +- half a 95 %% interval\n\n%-33s",
            "");
    for (int i = 0; i < self->count; i++)
        fprintf(self->stream, " %*s", share_width(self->column[i]), VISIBLE(self->column[i]->name));
    for (int k = 0; k < factors; k++) {
        const study_column *factor = &data->column[data->result_count + k];
        if (factor->seed)
            continue;
        fprintf(self->stream, "\n%-33s", VISIBLE(factor->name));
        for (int i = 0; i < self->count; i++)
            print_share(self->stream, share_width(self->column[i]), share[i * factors + k]);
    }
    fprintf(self->stream, "\n%-33s", "together");
    for (int i = 0; i < self->count; i++) {
        estimate sum = {0, NAN, NAN};
        for (int k = 0; k < factors; k++)
            sum.value +=
                data->column[data->result_count + k].seed ? 0 : share[i * factors + k].value;
        print_share(self->stream, share_width(self->column[i]), sum);
    }
    fputc('\n', self->stream);
}

static ld_status print_sensitivities(shown *self, const study_point *point, ld_error *error)
{
    int factors = self->data->column_count - self->data->result_count;
    estimate *share = calloc((size_t)(self->count * factors) + 1, sizeof *share);
    ld_status status =
        share ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the sensitivities");
    for (int i = 0; i < self->count && !status; i++)
        status = shown_sensitivities(self, point, i, share + i * factors, error);
    if (!status && factors > 0)
        print_shares(self, share);
    free(share);
    return status;
}

// ---- points

static ld_status print_point(shown *self, const study_point *point, ld_error *error)
{
    const study_data *data = self->data;
    if (data->swept_count > 0) {
        fprintf(self->stream, "%s%" PRId64 ".", point > data->point ? "\n" : "", point->number);
        for (int k = 0; k < data->swept_count; k++)
            fprintf(self->stream, "%s %s: %s", k ? "," : "", VISIBLE(data->swept[k]),
                    VISIBLE(point->text[k]));
        fputc('\n', self->stream);
    }
    ld_status status = print_counts(self, point, error);
    if (!status && self->view->measured)
        return show_measured(self->stream, &self->launches, data, point, &self->values, error);
    const group_statistics *of = shown_statistics(self, point), *most = most_values(self, of);
    if (status || !most)
        return status;
    if (!has_scatter(self, of)) {
        print_values(self, of);
        return LD_OK;
    }
    fprintf(self->stream, "%zu rockets, %zu independent groups; 95 %% intervals over groups\n",
            most->count, most->groups);
    status = print_exit_errors(self, point, error);
    if (!status)
        status = print_vertical(self, point, error);
    if (status)
        return status;
    if (self->view->sensitivity)
        return influence_kind_of(self->data) == INFLUENCE_SHARES
                   ? print_sensitivities(self, point, error)
                   : show_influences(self, point, error);
    if (self->data->plan.kind == LD_PLAN_MORRIS)
        fputs("samples of Morris's plan: these statistics are over its levels, not over the "
              "factors' distributions\n",
              self->stream);
    print_statistics(self, of);
    status = print_ellipses(self, point, error);
    return status ? status : print_footprints(self, point, error);
}

enum { CELL = 22, CELLS = 4 };

// Whether a result scatters at any of these points.
static bool column_scatters(const shown *self, int column, int from, int to)
{
    for (int i = from; i < to; i++) {
        const group_statistics *of = &shown_statistics(self, &self->data->point[i])[column];
        if (of->greatest > of->least)
            return true;
    }
    return false;
}

// Of a result at a point, in the unit in which it is shown.
static group_statistics shown_at(const shown *self, int point, int column)
{
    return show_in_unit(&shown_statistics(self, &self->data->point[point])[column],
                        self->column[column]);
}

// Points `from` to before `to`, a column each.
static void print_beside(const shown *self, int from, int to)
{
    const study_data *data = self->data;
    const int width = show_name_width(self->column, self->count);
    for (int k = 0; k < data->swept_count; k++) {
        fprintf(self->stream, "\n%-*s", width, VISIBLE(data->swept[k]));
        for (int i = from; i < to; i++)
            fprintf(self->stream, " %-*.*s", CELL, CELL, VISIBLE(data->point[i].text[k]));
    }
    for (int c = 0; c < self->count; c++) {
        fputc('\n', self->stream);
        show_result(self->stream, width, self->column[c]);
        for (int i = from; i < to; i++) {
            const group_statistics of = shown_at(self, i, c);
            show_half(self->stream, CELL, &of.mean, 6);
        }
        if (!column_scatters(self, c, from, to))
            continue;
        fprintf(self->stream, "\n%-*s", width, "    deviation");
        for (int i = from; i < to; i++) {
            const group_statistics of = shown_at(self, i, c);
            show_half(self->stream, CELL, &of.deviation, 4);
        }
    }
    fputc('\n', self->stream);
}

static void print_side_by_side(const shown *self)
{
    int points = self->data->point_count;
    bool any = false;
    for (int c = 0; c < self->count; c++)
        any |= column_scatters(self, c, 0, points);
    fprintf(self->stream, "\nAll points%s\n",
            any ? ": mean and standard deviation, +- half a 95 % interval" : "");
    for (int from = 0; from < points; from += CELLS)
        print_beside(self, from, from + CELLS < points ? from + CELLS : points);
}

// Whether rows of keys' values are asked for, pooled; of differences by themselves JSON and CSV
// have every point.
static bool asks_for_rows(const shown *self)
{
    return self->view->over || self->statistic;
}

// Reads what the view asks for, and computes what all points want together.
static ld_status prepare(shown *self, ld_error *error)
{
    const ld_study_view *view = self->view;
    if (view->measured) {
        ld_status status = measured_read(view->measured, self->data, &self->launches, error);
        if (!status && view->what && strcmp(view->what, "all") != 0)
            status = measured_choose(&self->launches, view->what, self->data, error);
        if (!status && !view->json)
            show_launches(self->stream, view->measured, &self->launches);
        return status;
    }
    ld_status status = influence_check(self->data, (ld_index)view->index, error);
    if (!status)
        status = shown_choose(self, error);
    if (!status && !view->against && !asks_for_rows(self))
        status = shown_compute(self, error);
    if (status || !view->against)
        return status;
    self->pairs =
        (show_against){.of = &self->reference, .column = self->column, .count = self->count};
    return against_read(view->against, self->data, &self->reference, error);
}

static ld_status print_csv(void *pairs, FILE *stream, ld_error *error)
{
    return show_against_csv(pairs, stream, error);
}

// All points in turn, then side by side.
static ld_status print_points(shown *self, ld_error *error)
{
    const study_data *data = self->data;
    const ld_study_view *view = self->view;
    ld_status status = LD_OK;
    for (int i = 0; i < data->point_count && !status; i++)
        status = print_point(self, &data->point[i], error);
    if (!status && data->point_count > 1 && !view->sensitivity && !view->measured)
        print_side_by_side(self);
    return status;
}

typedef struct over_csv {
    const shown *self;
    over_asked *asked;
} over_csv;

static ld_status print_over_csv(void *context, FILE *stream, ld_error *error)
{
    const over_csv *of = context;
    return show_over_csv(of->self, of->asked, stream, error);
}

// Rows of keys' values, as a table or JSON, and in a file.
static ld_status print_over(shown *self, ld_error *error)
{
    const ld_study_view *view = self->view;
    over_asked asked;
    ld_status status = over_rows_open(self, &asked, error);
    if (!status)
        status = view->json ? show_over_json(self, &asked, error) : show_over(self, &asked, error);
    if (!status && view->csv && asks_for_rows(self))
        status = table_file_print(print_over_csv, &(over_csv){self, &asked}, view->csv, error);
    over_rows_close(&asked);
    return status;
}

static ld_status print_differences(shown *self, ld_error *error)
{
    const ld_study_view *view = self->view;
    if (asks_for_rows(self))
        return print_over(self, error);
    ld_status status = view->json ? show_json(self, error) : print_over(self, error);
    if (!status && view->json && self->pairs.compared == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "--against: no point has two pairs of rockets with the one that it is "
                       "compared with");
    return status || !view->csv ? status
                                : table_file_print(print_csv, &self->pairs, view->csv, error);
}

static ld_status print_all(shown *self, ld_error *error)
{
    const ld_study_view *view = self->view;
    ld_status status = prepare(self, error);
    if (status)
        return status;
    if (view->against && !view->measured)
        return print_differences(self, error);
    if (asks_for_rows(self))
        return print_over(self, error);
    return view->json ? show_json(self, error) : print_points(self, error);
}

ld_status ld_study_show(const char *folder, const ld_study_view *view, FILE *stream,
                        ld_error *error)
{
    return ld_study_show_statistic(folder, NULL, view, stream, error);
}

ld_status ld_study_show_statistic(const char *folder, const char *statistic,
                                  const ld_study_view *view, FILE *stream, ld_error *error)
{
    static const ld_study_view none = {0};
    study_data data;
    ld_status status = study_data_open(folder, &data, error);
    if (status)
        return status;
    shown self = {
        .data = &data, .view = view ? view : &none, .statistic = statistic, .stream = stream};
    locale_t before = numeric_locale_enter();
    status = print_all(&self, error);
    numeric_locale_leave(before);
    free(self.column);
    free(self.of);
    measured_free(&self.launches);
    against_free(&self.reference);
    for (int k = 0; k < 2; k++)
        study_values_free(&self.pairs.values[k]);
    study_values_free(&self.values);
    study_data_close(&data);
    return status;
}
