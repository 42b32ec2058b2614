#include "studies/pictures/plot_influence.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "figures/chart.h"
#include "quantities/study_results.h"
#include "studies/points/influence.h"
#include "studies/show/shown.h"

enum { MOST_CHARTS = 8, USUAL_CHARTS = 4, MOST_BARS = 20, TITLE = 1400 };

static const char usual[] = "since_ignition.pitch_rate,since_ignition.yaw_rate,t_rear,exit_speed,"
                            "downrange,drift";

// One chart with what its pointers point to.
typedef struct bar_chart {
    const char *name[MOST_BARS];
    double x[2][MOST_BARS], low[2][MOST_BARS], high[2][MOST_BARS], y[2][MOST_BARS];
    char title[TITLE], x_label[200];
} bar_chart;

typedef struct bar_page {
    const study_data *data;
    const ld_study_question *question;
    const study_column **column; // [count] results
    int count;
    influence *list; // [factors]
    study_values values;
    chart chart[MOST_CHARTS];
    bar_chart held[MOST_CHARTS];
    size_t charts;
} bar_page;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's picture");
}

static ld_status choose(bar_page *self, ld_error *error)
{
    const study_data *data = self->data;
    const char *what = self->question->what;
    self->list = calloc((size_t)data->column_count + 1, sizeof *self->list);
    self->column = calloc((size_t)data->column_count + 1, sizeof(void *));
    if (!self->list || !self->column)
        return no_memory(error);
    if (what)
        return shown_add(data, what, self->column, &self->count, error);
    shown_add_measures(data, self->column, &self->count);
    return shown_add_usual(data, usual, self->column, &self->count, error);
}

// "; base.speed 30 km/h"
static void add_point(const study_data *data, const study_point *point, char title[TITLE])
{
    for (int k = 0; k < data->swept_count; k++) {
        size_t length = strlen(title);
        snprintf(title + length, TITLE - length, "; %.60s %.60s", data->swept[k], point->text[k]);
    }
}

static void set_bar(bar_chart *held, int which, int i, const estimate *e, double factor)
{
    held->x[which][i] = e->value * factor;
    held->low[which][i] = e->low * factor;
    held->high[which][i] = e->high * factor;
}

static void set_bars(const bar_page *self, bar_chart *held, int bars, double factor)
{
    const influence_kind kind = influence_kind_of(self->data);
    for (int i = 0; i < bars; i++) {
        const influence *of = &self->list[i];
        held->name[i] = of->factor->name;
        for (int k = 0; k < 2; k++)
            held->y[k][i] = kind == INFLUENCE_INDICES ? i + 0.38 * (k - 0.5) : i;
        set_bar(held, 0, i,
                kind == INFLUENCE_INDICES   ? &of->indices.total
                : kind == INFLUENCE_EFFECTS ? &of->effects.magnitude
                                            : &of->indices.first,
                factor);
        set_bar(held, 1, i, &of->indices.first, factor);
    }
}

// Of indices two bars, the total above the first order.
static void set_chart(bar_page *self, chart *to, int bars)
{
    bar_chart *held = &self->held[self->charts];
    const influence_kind kind = influence_kind_of(self->data);
    static const char *const labels[][2] = {[INFLUENCE_SHARES] = {"", ""},
                                            [INFLUENCE_INDICES] = {"total", "first order"},
                                            [INFLUENCE_EFFECTS] = {"", ""}};
    *to = (chart){.title = held->title,
                  .x_label = held->x_label,
                  .y_label = "",
                  .x_factor = 1,
                  .y_factor = 1,
                  .y_words = {bars, held->name},
                  .count = kind == INFLUENCE_INDICES ? 2 : 1};
    for (int k = 0; k < to->count; k++)
        to->curve[k] = (chart_curve){.label = labels[kind][k],
                                     .count = (size_t)bars,
                                     .x = held->x[k],
                                     .y = held->y[k],
                                     .low = held->low[k],
                                     .high = held->high[k],
                                     .bar = kind == INFLUENCE_INDICES ? 0.34 : 0.7};
}

static void write_texts(const bar_page *self, const study_point *point, const study_column *result,
                        int count, bar_chart *held)
{
    const influence_kind kind = influence_kind_of(self->data);
    const study_unit unit = study_result_unit(result->name, result->unit);
    const size_t fits = 80;
    char said[INFLUENCE_TEXT] = "";
    if (kind == INFLUENCE_INDICES)
        influence_together(self->list, count, said);
    if (strlen(said) > fits) // the bars show which
        snprintf(said, sizeof said, "factors whose total exceeds the first order act with others");
    snprintf(held->title, TITLE, "%.200s%s%s", result->name, *said ? ": " : "", said);
    add_point(self->data, point, held->title);
    if (kind == INFLUENCE_EFFECTS)
        snprintf(held->x_label, sizeof held->x_label,
                 "mu*: mean magnitude of the change for the whole of a factor's probability%s%s%s",
                 *unit.name ? " [" : "", unit.name, *unit.name ? "]" : "");
    else
        snprintf(held->x_label, sizeof held->x_label,
                 "share of the variance [%%], 95 %% intervals");
}

static ld_status add_chart(bar_page *self, const study_point *point, const study_column *result,
                           ld_error *error)
{
    int count;
    const influence_kind kind = influence_kind_of(self->data);
    const ld_index index = (ld_index)self->question->index;
    const influence_question question = {self->data, point, result, index};
    ld_status status = influences_of(&question, &self->values, self->list, &count, error);
    if (status || count == 0 || isinf(influence_rank(&self->list[0], kind, index)))
        return status;
    const int bars = count < MOST_BARS ? count : MOST_BARS;
    const double in_unit = study_result_unit(result->name, result->unit).factor;
    bar_chart *held = &self->held[self->charts];
    set_bars(self, held, bars, kind == INFLUENCE_EFFECTS ? in_unit : 100);
    write_texts(self, point, result, count, held);
    set_chart(self, &self->chart[self->charts], bars);
    self->charts++;
    return LD_OK;
}

static ld_status add_charts(bar_page *self, ld_error *error)
{
    const study_data *data = self->data;
    const size_t most = self->question->what ? MOST_CHARTS : USUAL_CHARTS;
    ld_status status = influence_check(data, (ld_index)self->question->index, error);
    if (!status)
        status = choose(self, error);
    if (!status && (size_t)self->count * (size_t)data->point_count > most && self->question->what)
        return ld_fail(error, LD_ERR_INPUT, "--what: at most %d charts fit on a page, found %d",
                       MOST_CHARTS, self->count * data->point_count);
    for (int i = 0; i < self->count && !status; i++)
        for (int p = 0; p < data->point_count && !status && self->charts < most; p++)
            status = add_chart(self, &data->point[p], self->column[i], error);
    if (!status && self->charts == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "nothing to draw: fewer than three complete rows, or no factor moves %s",
                       self->question->what ? self->question->what : "these results");
    return status;
}

ld_status plot_influences(const study_data *data, const ld_study_question *question,
                          const char *file, ld_error *error)
{
    bar_page *self = calloc(1, sizeof *self);
    if (!self)
        return no_memory(error);
    self->data = data;
    self->question = question;
    ld_status status = add_charts(self, error);
    if (!status)
        status = charts_draw(file, data->title && *data->title ? data->title : "Study", self->chart,
                             self->charts, error);
    study_values_free(&self->values);
    free(self->column);
    free(self->list);
    free(self);
    return status;
}
