// Results over swept keys as a picture: curves with intervals, or a map.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "figures/chart.h"
#include "launchdyn/study.h"
#include "studies/pictures/plot_influence.h"
#include "studies/points/over_statistic.h"
#include "studies/show/show_numbers.h"
#include "studies/show/shown.h"

enum { MOST_CHARTS = 8, MOST_CURVES = 6, USUAL_CHARTS = 4, TITLE = 1200, LABEL = 160 };

static const char usual[] =
    "since_ignition.pitch_rate,since_ignition.yaw_rate,exit_speed,downrange,"
    "drift";

// One chart with what its pointers point to.
typedef struct over_chart {
    chart_map map;
    double *number;         // x, y, low, high of each curve; or edges and values
    char (*cell)[2][32];    // texts of a map
    const char *(*text)[2]; // [cells] that point to them
    char title[TITLE], x_label[LABEL], y_label[LABEL], bar_label[LABEL];
    char (*curve_label)[LABEL]; // [curves]
} over_chart;

typedef struct study_picture {
    study_data data;
    const ld_study_question *question;
    over over;
    over_statistic statistic;
    const study_column **column; // [count] NULL: the landing points
    int count;
    int *order[OVER_KEYS]; // [values] places of a key's values, the least number first
    over_found *found;     // [cells]
    chart chart[MOST_CHARTS];
    over_chart held[MOST_CHARTS];
    size_t charts;
} study_picture;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's picture");
}

// ---- what is asked

static ld_status choose_results(study_picture *self, ld_error *error)
{
    const study_data *data = &self->data;
    const char *what = self->question->what;
    self->column = calloc((size_t)data->column_count + 1, sizeof(void *));
    if (!self->column)
        return no_memory(error);
    if (self->statistic.kind == OVER_FOOTPRINT) {
        self->count = 1;
        return what ? ld_fail(error, LD_ERR_INPUT,
                              "--statistic footprint is of the landing points; leave out --what")
                    : LD_OK;
    }
    if (what) {
        ld_status status = shown_add(data, what, self->column, &self->count, error);
        if (!status && self->count > MOST_CHARTS)
            return ld_fail(error, LD_ERR_INPUT,
                           "--what: at most %d results fit on a page, found %d", MOST_CHARTS,
                           self->count);
        return status;
    }
    shown_add_measures(data, self->column, &self->count);
    return shown_add_usual(data, usual, self->column, &self->count, error);
}

static ld_status order_values(study_picture *self, int k, ld_error *error)
{
    const over_key *key = &self->over.key[k];
    int *order = calloc((size_t)key->count + 1, sizeof *order);
    self->order[k] = order;
    if (!order)
        return no_memory(error);
    for (int i = 0; i < key->count; i++) {
        int at = i;
        for (; at > 0 && key->numeric && key->number[order[at - 1]] > key->number[i]; at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
    return LD_OK;
}

static ld_status open_question(study_picture *self, ld_error *error)
{
    const ld_study_question *question = self->question;
    const study_data *data = &self->data;
    ld_status status = over_statistic_read(question->statistic, &self->statistic, error);
    if (!status)
        status = over_open(question->over          ? question->over
                           : data->swept_count > 0 ? data->swept[0]
                                                   : "",
                           question->against, data, &self->over, error);
    if (!status)
        status = choose_results(self, error);
    for (int k = 0; k < self->over.count && !status; k++)
        status = order_values(self, k, error);
    if (!status &&
        !(self->found = calloc((size_t)over_cell_count(&self->over) + 1, sizeof *self->found)))
        status = no_memory(error);
    return status;
}

// ---- one result

static int inner_count(const study_picture *self)
{
    return self->over.count > 1 ? self->over.key[1].count : 1;
}

static bool is_map(const study_picture *self)
{
    return self->over.count > 1 && (self->question->map || self->over.key[1].count > MOST_CURVES);
}

// The cell of the i-th value of the first key and the j-th of the second, in their order.
static const over_found *found_at(const study_picture *self, int i, int j)
{
    int inner = self->over.count > 1 ? self->order[1][j] : 0;
    return &self->found[self->order[0][i] * inner_count(self) + inner];
}

// In the unit that is shown; of a cell of reference what is the same.
static estimate estimate_at(const study_picture *self, int i, int j, double factor)
{
    const over_found *found = found_at(self, i, j);
    if (found->reference)
        return (estimate){over_statistic_same(&self->statistic), NAN, NAN};
    return (estimate){found->of.value * factor, found->of.low * factor, found->of.high * factor};
}

static void label_key(const over_key *key, char text[LABEL])
{
    snprintf(text, LABEL, "%.100s%s%s%s", key->name, key->unit[0] ? " [" : "",
             key->numeric ? key->unit : "", key->unit[0] ? "]" : "");
}

// "mean of pitch_rate against base.speed 0 km/h; pooled over ...; 95 % intervals"
static void write_title(const study_picture *self, const study_column *result, over_chart *held,
                        study_unit *unit)
{
    const over *of = &self->over;
    char text[256], others[512], reference[256] = "";
    *unit = over_statistic_text(of, &self->statistic, result, text, sizeof text);
    over_pooled_text(of, others, sizeof others);
    if (of->reference.data)
        over_reference_text(of, reference, sizeof reference);
    snprintf(held->title, TITLE, "%s%s%s%s%s; 95 %% intervals", text, *reference ? " against " : "",
             reference, *others ? "; " : "", others);
    snprintf(held->bar_label, LABEL, "%s%s%s%s", over_statistic_word(of, &self->statistic),
             unit->name[0] ? " [" : "", unit->name, unit->name[0] ? "]" : "");
}

static bool allocate(over_chart *held, size_t numbers, size_t curves, size_t cells)
{
    held->number = calloc(numbers + 1, sizeof(double));
    held->curve_label = calloc(curves + 1, sizeof *held->curve_label);
    held->cell = calloc(cells + 1, sizeof *held->cell);
    held->text = calloc(cells + 1, sizeof *held->text);
    return held->number && held->curve_label && held->cell && held->text;
}

// ---- curves

// Words stand beside each other. The curves of a family stand a little apart, of numbers by 0.5 %
// of the axis, so that their intervals are seen.
static double place_of(const study_picture *self, int i, int j)
{
    const over_key *key = &self->over.key[0];
    const int *order = self->order[0];
    double from_middle = j - 0.5 * (inner_count(self) - 1);
    if (!key->numeric)
        return i + 0.6 / inner_count(self) * from_middle;
    double span = key->number[order[key->count - 1]] - key->number[order[0]];
    return key->number[order[i]] + 0.005 * span * from_middle;
}

static void fill_curve(const study_picture *self, int j, double factor, over_chart *held,
                       chart_curve *curve)
{
    int count = self->over.key[0].count;
    double *x = held->number + (size_t)4 * (size_t)count * (size_t)j, *y = x + count;
    double *low = y + count, *high = low + count;
    for (int i = 0; i < count; i++) {
        estimate e = estimate_at(self, i, j, factor);
        x[i] = place_of(self, i, j);
        y[i] = e.value;
        low[i] = e.low;
        high[i] = e.high;
    }
    if (self->over.count > 1)
        snprintf(held->curve_label[j], LABEL, "%.80s %.60s", self->over.key[1].name,
                 self->over.key[1].text[self->order[1][j]]);
    *curve = (chart_curve){.label = held->curve_label[j],
                           .count = (size_t)count,
                           .x = x,
                           .y = y,
                           .dots = true,
                           .low = low,
                           .high = high};
}

static ld_status fill_curves(study_picture *self, double factor, over_chart *held, chart *to,
                             ld_error *error)
{
    size_t count = (size_t)self->over.key[0].count, curves = (size_t)inner_count(self);
    if (!allocate(held, 4 * count * curves, curves, 0))
        return no_memory(error);
    to->levelled = self->over.reference.data;
    to->level = over_statistic_same(&self->statistic);
    to->count = (int)curves;
    for (int j = 0; j < to->count; j++)
        fill_curve(self, j, factor, held, &to->curve[j]);
    return LD_OK;
}

// ---- a map

// Halfway between numbers, as far out at the ends; words stand at whole numbers.
static void fill_edges(const study_picture *self, int k, double *edge)
{
    const over_key *key = &self->over.key[k];
    int n = key->count;
    for (int i = 1; i < n; i++)
        edge[i] = key->numeric
                      ? 0.5 * (key->number[self->order[k][i - 1]] + key->number[self->order[k][i]])
                      : i - 0.5;
    double first = key->numeric ? key->number[self->order[k][0]] : 0;
    double last = key->numeric ? key->number[self->order[k][n - 1]] : n - 1;
    edge[0] = n > 1 ? 2 * first - edge[1] : first - 0.5;
    edge[n] = n > 1 ? 2 * last - edge[n - 1] : first + 0.5;
}

static const double *fill_ticks(const study_picture *self, int k, double *tick)
{
    const over_key *key = &self->over.key[k];
    for (int i = 0; i < key->count; i++)
        tick[i] = key->number[self->order[k][i]];
    return key->numeric ? tick : NULL;
}

static void write_cell(char text[2][32], const estimate *e)
{
    double half = 0.5 * (e->high - e->low);
    show_text(text[0], e->value, isfinite(half) ? show_digits(e->value, half, 3) : 4);
    text[1][0] = '\0';
    if (isfinite(half))
        snprintf(text[1], 32, "\u00b1 %.2g", half);
}

static ld_status fill_map(study_picture *self, double factor, over_chart *held, chart *to,
                          ld_error *error)
{
    int columns = self->over.key[0].count, rows = self->over.key[1].count;
    size_t cells = (size_t)columns * (size_t)rows;
    if (!allocate(held, cells + 2 * ((size_t)columns + (size_t)rows + 1), 0, cells))
        return no_memory(error);
    double *x_edge = held->number + cells, *y_edge = x_edge + columns + 1;
    fill_edges(self, 0, x_edge);
    fill_edges(self, 1, y_edge);
    for (int i = 0; i < columns; i++)
        for (int j = 0; j < rows; j++) {
            int cell = i * rows + j;
            estimate e = estimate_at(self, i, j, factor);
            held->number[cell] = e.value;
            write_cell(held->cell[cell], &e);
            for (int k = 0; k < 2; k++)
                held->text[cell][k] = held->cell[cell][k];
        }
    held->map = (chart_map){.columns = columns,
                            .rows = rows,
                            .x_edge = x_edge,
                            .y_edge = y_edge,
                            .x_tick = fill_ticks(self, 0, y_edge + rows + 1),
                            .y_tick = fill_ticks(self, 1, y_edge + rows + 1 + columns),
                            .value = held->number,
                            .text = held->text,
                            .label = held->bar_label,
                            .centred = self->over.reference.data,
                            .middle = over_statistic_same(&self->statistic)};
    to->map = &held->map;
    return LD_OK;
}

// ---- the page

static bool has_value(const study_picture *self)
{
    for (int cell = 0; cell < over_cell_count(&self->over); cell++)
        if (isfinite(self->found[cell].of.value))
            return true;
    return false;
}

static ld_status add_chart(study_picture *self, const study_column *result, ld_error *error)
{
    const over_key *key = self->over.key;
    over_chart *held = &self->held[self->charts];
    chart *to = &self->chart[self->charts];
    study_unit unit;
    ld_status status = LD_OK;
    for (int cell = 0; cell < over_cell_count(&self->over) && !status; cell++)
        status = over_find(&self->over, cell, &self->statistic, result, &self->found[cell], error);
    if (status || !has_value(self))
        return status;
    self->charts++;
    write_title(self, result, held, &unit);
    label_key(&key[0], held->x_label);
    *to = (chart){.title = held->title,
                  .x_label = held->x_label,
                  .y_label = is_map(self) ? held->y_label : held->bar_label,
                  .x_factor = 1,
                  .y_factor = 1};
    if (!key[0].numeric)
        to->x_words = (chart_words){key[0].count, key[0].text};
    if (!is_map(self))
        return fill_curves(self, unit.factor, held, to, error);
    label_key(&key[1], held->y_label);
    if (!key[1].numeric)
        to->y_words = (chart_words){key[1].count, key[1].text};
    return fill_map(self, unit.factor, held, to, error);
}

static ld_status draw(study_picture *self, const char *file, ld_error *error)
{
    const study_data *data = &self->data;
    size_t most = self->question->what ? MOST_CHARTS : USUAL_CHARTS;
    ld_status status = LD_OK;
    for (int i = 0; i < self->count && !status && self->charts < most; i++)
        status = add_chart(self, self->column[i], error);
    if (status)
        return status;
    if (self->charts == 0)
        return ld_fail(error, LD_ERR_INPUT, "nothing to draw: no rocket has a value of %s",
                       self->question->what ? self->question->what : "these results");
    return charts_draw(file, data->title && *data->title ? data->title : "Study", self->chart,
                       self->charts, error);
}

static void free_picture(study_picture *self)
{
    for (size_t i = 0; i < self->charts; i++) {
        free(self->held[i].number);
        free(self->held[i].curve_label);
        free(self->held[i].cell);
        free(self->held[i].text);
    }
    for (int k = 0; k < OVER_KEYS; k++)
        free(self->order[k]);
    free(self->column);
    free(self->found);
    over_close(&self->over);
    study_data_close(&self->data);
    free(self);
}

ld_status ld_study_plot(const char *folder, const ld_study_question *question, const char *file,
                        ld_error *error)
{
    static const ld_study_question usual_question = {0};
    study_picture *self = calloc(1, sizeof *self);
    if (!self)
        return no_memory(error);
    self->question = question ? question : &usual_question;
    ld_status status = study_data_open(folder, &self->data, error);
    locale_t before = numeric_locale_enter();
    if (!status && self->question->sensitivity) {
        status = plot_influences(&self->data, self->question, file, error);
    } else {
        if (!status)
            status = open_question(self, error);
        if (!status)
            status = draw(self, file, error);
    }
    numeric_locale_leave(before);
    free_picture(self);
    return status;
}
