// A comparison as a picture: of each series measured and simulated over each other, below that E
// between -2 u_val and 2 u_val.
#include <math.h>
#include <stdlib.h>

#include "compare/comparison.h"
#include "figures/chart.h"

// What is drawn of a series; rows that a gap parts have one without values between them.
typedef struct drawn_series {
    double *t, *measured, *simulated, *error, *above, *below; // [count] in one block, owned
    size_t count;
    char y_label[2][160];
} drawn_series;

static int by_size(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// Four times the median distance of samples; `room` for all of them.
static double widest_step(const ld_compared_series *series, double *room)
{
    for (size_t i = 1; i < series->count; i++)
        room[i - 1] = series->t[i] - series->t[i - 1];
    qsort(room, series->count - 1, sizeof *room, by_size);
    return series->count > 1 ? 4 * room[(series->count - 1) / 2] : INFINITY;
}

static void add_row(drawn_series *drawn, double t, const double row[4])
{
    size_t i = drawn->count++;
    drawn->t[i] = t;
    drawn->measured[i] = row[0];
    drawn->simulated[i] = row[1];
    drawn->error[i] = row[1] - row[0];
    drawn->above[i] = 2 * row[2];
    drawn->below[i] = -2 * row[2];
}

static ld_status fill(drawn_series *drawn, const ld_compared_series *series, ld_error *error)
{
    static const double nothing[4] = {NAN, NAN, NAN};
    size_t room = 2 * series->count;
    drawn->t = calloc(6 * room, sizeof *drawn->t);
    if (!drawn->t)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the picture");
    drawn->measured = drawn->t + room;
    drawn->simulated = drawn->measured + room;
    drawn->error = drawn->simulated + room;
    drawn->above = drawn->error + room;
    drawn->below = drawn->above + room;
    double step = widest_step(series, drawn->t);
    for (size_t i = 0; i < series->count; i++) {
        const double row[4] = {series->measured[i], series->simulated[i], series->u_val[i]};
        if (i > 0 && series->t[i] - series->t[i - 1] > step)
            add_row(drawn, series->t[i], nothing);
        add_row(drawn, series->t[i], row);
    }
    const char *unit = series->log_unit[0] ? series->log_unit : "-";
    snprintf(drawn->y_label[0], sizeof drawn->y_label[0], "%.95s [%s]", series->name, unit);
    snprintf(drawn->y_label[1], sizeof drawn->y_label[1], "E [%s]", unit);
    return LD_OK;
}

static chart_curve curve_of(const drawn_series *drawn, const char *label, const double *y)
{
    return (chart_curve){.label = label, .count = drawn->count, .x = drawn->t, .y = y};
}

// Times of a short log in ms.
static void place_on_page(const ld_compared_series *series, const drawn_series *drawn,
                          chart charts[2])
{
    bool brief = fabs(series->t[0]) < 2 && fabs(series->t[series->count - 1]) < 2;
    const chart both = {.title = series->name,
                        .x_label = brief ? "time from ignition [ms]" : "time from ignition [s]",
                        .y_label = drawn->y_label[0],
                        .x_factor = brief ? 1e3 : 1,
                        .y_factor = 1 / series->factor,
                        .count = 2,
                        .curve = {curve_of(drawn, "measured", drawn->measured),
                                  curve_of(drawn, "simulated", drawn->simulated)}};
    charts[0] = both;
    charts[1] = both;
    charts[1].title = "simulated less measured";
    charts[1].y_label = drawn->y_label[1];
    charts[1].count = 3;
    charts[1].curve[0] = curve_of(drawn, "E", drawn->error);
    charts[1].curve[1] = curve_of(drawn, "±2 u_val", drawn->above);
    charts[1].curve[2] = curve_of(drawn, "", drawn->below);
    charts[1].curve[2].again = true;
}

ld_status ld_comparison_draw(const ld_comparison *self, const char *file, ld_error *error)
{
    int count = self->log.sensors;
    drawn_series *drawn = calloc((size_t)count + 1, sizeof *drawn);
    chart *charts = calloc(2 * (size_t)count + 1, sizeof *charts);
    ld_status status =
        drawn && charts ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the picture");
    if (!status && count == 0)
        status = ld_fail(error, LD_ERR_INPUT, "the log has no series to draw");
    for (int i = 0; i < count && !status; i++) {
        status = fill(&drawn[i], &self->series[i], error);
        if (!status)
            place_on_page(&self->series[i], &drawn[i], charts + 2 * i);
    }
    const char *title = self->history.title && *self->history.title ? self->history.title : "Run";
    if (!status)
        status = charts_draw(file, title, charts, 2 * (size_t)count, error);
    for (int i = 0; drawn && i < count; i++)
        free(drawn[i].t);
    free(drawn);
    free(charts);
    return status;
}
