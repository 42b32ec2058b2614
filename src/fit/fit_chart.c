// A fit as a picture: of each series measured and fitted over each other and their differences
// below, differences of results, and how chi2 rises along each key.
#include <stdlib.h>
#include <string.h>

#include "figures/chart.h"
#include "fit/fit_show.h"
#include "math/functions.h"

enum { CURVE = 121, MOST_CHARTS = 256, BAND = 2 };

// The charts of a page, and what they show.
typedef struct fit_page {
    const ld_fit *fit;
    chart *charts; // [MOST_CHARTS]
    size_t count;
    void *owned[2 * MOST_CHARTS];
    int owned_count;
} fit_page;

static void *keep(fit_page *page, size_t count, size_t size)
{
    void *room = page->owned_count < 2 * MOST_CHARTS ? calloc(count + 1, size) : NULL;
    if (room)
        page->owned[page->owned_count++] = room;
    return room;
}

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the picture");
}

static chart *add_chart(fit_page *page, const chart *made)
{
    if (page->count == MOST_CHARTS)
        return NULL;
    page->charts[page->count] = *made;
    return &page->charts[page->count++];
}

static chart_curve curve_of(const char *label, size_t count, const double *x, const double *y)
{
    return (chart_curve){.label = label, .count = count, .x = x, .y = y};
}

// ---- series

static void add_residuals(fit_page *page, const chart *above, const double *t, const double *apart,
                          size_t n, double *edge)
{
    chart below = *above;
    below.title = "measured less fitted";
    below.y_label = "in its noise";
    below.y_factor = 1;
    below.count = 3;
    below.curve[0] = curve_of("difference", n, t, apart);
    edge[0] = t[0];
    edge[1] = t[n - 1];
    for (int i = 0; i < 2; i++) {
        edge[2 + i] = BAND;
        edge[4 + i] = -BAND;
    }
    below.curve[1] = curve_of("±2 deviations", 2, edge, edge + 2);
    below.curve[2] = curve_of("", 2, edge, edge + 4);
    below.curve[2].again = true;
    add_chart(page, &below);
}

static ld_status add_series(fit_page *page, const fit_log *log, int k, ld_error *error)
{
    const fit_series *series = &log->series[k];
    const sensor *of = &log->log.sensor[k];
    const double *fitted = &page->fit->fitted[series->first];
    size_t n = series->count;
    double *t = keep(page, 2 * n + 6, sizeof *t), *apart = t ? t + n : NULL;
    char *label = keep(page, 160, 1);
    if (!t || !label)
        return no_memory(error);
    for (size_t i = 0; i < n; i++) {
        t[i] = series->t[i] + fit_log_offset(page->fit, log);
        apart[i] = (series->value[i] - fitted[i]) / series->noise;
    }
    const char *unit = of->head.unit[0] ? of->head.unit : "-";
    snprintf(label, 160, "%.95s [%.30s]", of->column, unit);
    bool brief = fabs(t[0]) < 2 && fabs(t[n - 1]) < 2;
    const chart both = {
        .title = of->column,
        .x_label = brief ? "time from ignition [ms]" : "time from ignition [s]",
        .y_label = label,
        .x_factor = brief ? 1e3 : 1,
        .y_factor = 1 / of->factor,
        .count = 2,
        .curve = {curve_of("measured", n, t, series->value), curve_of("fitted", n, t, fitted)}};
    add_chart(page, &both);
    add_residuals(page, &both, t, apart, n, apart + n);
    return LD_OK;
}

// ---- results

static size_t count_results(const ld_fit *fit)
{
    size_t count = 0;
    for (size_t c = 0; c < fit->data.launches; c++)
        count += (size_t)fit->data.launch[c].cells;
    for (int i = 0; i < fit->logs; i++)
        count += (size_t)fit->log[i].scalars;
    return count;
}

// Names of results of all launches and logs, and how far measured ones are from the fitted.
static void fill_results(const ld_fit *fit, const char **name, double *apart)
{
    size_t n = 0;
    for (size_t c = 0; c < fit->data.launches; c++) {
        const fit_launch *launch = &fit->data.launch[c];
        for (int i = 0; i < launch->cells; i++) {
            name[n] = fit->data.result[launch->result[i]].name;
            apart[n++] =
                (launch->mean[i] - fit->fitted[launch->first + i]) / fit_cell_deviation(launch, i);
        }
    }
    for (int i = 0; i < fit->logs; i++)
        for (int k = 0; k < fit->log[i].scalars; k++) {
            const fit_scalar *scalar = &fit->log[i].scalar[k];
            name[n] = scalar->name;
            apart[n++] = (scalar->measured - fit->fitted[scalar->residual]) / scalar->uncertainty;
        }
}

static ld_status add_results(fit_page *page, ld_error *error)
{
    enum { MOST_WORDS = 12 };
    size_t n = count_results(page->fit);
    if (n == 0)
        return LD_OK;
    const char **name = keep(page, n, sizeof *name);
    double *x = keep(page, 4 * n, sizeof *x);
    if (!name || !x)
        return no_memory(error);
    fill_results(page->fit, name, x + n);
    for (size_t i = 0; i < n; i++) {
        x[i] = (double)i;
        x[2 * n + i] = x[n + i] - 1;
        x[3 * n + i] = x[n + i] + 1;
    }
    chart made = {.title = "measured less fitted results",
                  .x_label = n > MOST_WORDS ? "number of the result" : "",
                  .y_label = "in its deviations",
                  .x_factor = 1,
                  .y_factor = 1,
                  .levelled = true,
                  .count = 1,
                  .curve = {curve_of("difference, one deviation", n, x, x + n)}};
    made.curve[0].dots = true;
    made.curve[0].low = x + 2 * n;
    made.curve[0].high = x + 3 * n;
    if (n <= MOST_WORDS)
        made.x_words = (chart_words){(int)n, name};
    add_chart(page, &made);
    return LD_OK;
}

// ---- keys

// The minimum and where the profile went, in the order of the key's values: the root of the rise
// with the sign of the side. Returns their number.
static int sort_trace(const ld_fit *fit, int number, double *x, double *root)
{
    const fit_trace *trace = &fit->minimum.trace[number];
    double best = fit->estimate[number].value;
    x[0] = best;
    root[0] = 0;
    for (int i = 0; i < trace->count; i++) {
        int k = i + 1;
        double value = fit_key_value(&fit->key[number], trace->p[i]);
        for (; k > 0 && x[k - 1] > value; k--) {
            x[k] = x[k - 1];
            root[k] = root[k - 1];
        }
        x[k] = value;
        root[k] = copysign(sqrt(trace->rise[i]), value - best);
    }
    return trace->count + 1;
}

// The rise along the key, its root a line between the points of the profile.
static void fill_profile(const ld_fit *fit, int number, double *x, double *y)
{
    double at[FIT_MOST_TRACE + 1], root[FIT_MOST_TRACE + 1];
    int n = sort_trace(fit, number, at, root), before = 0;
    for (int i = 0; i < CURVE; i++) {
        x[i] = at[0] + (at[n - 1] - at[0]) * i / (CURVE - 1);
        while (before + 2 < n && at[before + 1] < x[i])
            before++;
        double step = n > 1 ? at[before + 1] - at[before] : 0;
        double share = step > 0 ? (x[i] - at[before]) / step : 0;
        double now = n > 1 ? root[before] + share * (root[before + 1] - root[before]) : 0;
        y[i] = now * now;
    }
}

// As it would rise by the deviation.
static void fill_parabola(const fit_estimate *found, double reach, double *x, double *y)
{
    for (int i = 0; i < CURVE; i++) {
        double u = reach * (2. * i / (CURVE - 1) - 1);
        x[i] = found->value + u * found->deviation;
        y[i] = u * u;
    }
}

static ld_status add_key(fit_page *page, int number, ld_error *error)
{
    const ld_fit *fit = page->fit;
    const fit_key *key = &fit->key[number];
    const fit_estimate *found = &fit->estimate[number];
    double *x = keep(page, 4 * (size_t)CURVE, sizeof *x);
    char *label = keep(page, 160, 1);
    if (!x || !label)
        return no_memory(error);
    fill_profile(fit, number, x, x + CURVE);
    fill_parabola(found, 1.2 * sqrt(fit->level / fit->inflation), x + 2 * (size_t)CURVE,
                  x + 3 * (size_t)CURVE);
    snprintf(label, 160, "%.120s [%.30s]", key->name, key->shown_unit[0] ? key->shown_unit : "-");
    chart made = {.title = key->name,
                  .x_label = label,
                  .y_label = "rise of chi2; line: 95 %",
                  .x_factor = 1 / key->shown_factor,
                  .y_factor = 1,
                  .levelled = true,
                  .level = fit->level,
                  .count = 1,
                  .curve = {curve_of("profile", CURVE, x, x + CURVE)}};
    if (found->deviation > 0)
        made.curve[made.count++] =
            curve_of("by the deviation", CURVE, x + 2 * (size_t)CURVE, x + 3 * (size_t)CURVE);
    if (fit->minimum.trace[number].count > 0 || found->deviation > 0)
        add_chart(page, &made);
    return LD_OK;
}

static ld_status fill_page(fit_page *page, ld_error *error)
{
    const ld_fit *fit = page->fit;
    ld_status status = add_results(page, error);
    for (int i = 0; i < fit->logs && !status; i++)
        for (int k = 0; k < fit->log[i].log.sensors && !status; k++)
            status = add_series(page, &fit->log[i], k, error);
    for (int i = 0; i < fit->own_keys && !status; i++)
        status = add_key(page, i, error);
    return status;
}

ld_status ld_fit_draw(const ld_fit *fit, const char *file, ld_error *error)
{
    ld_error own;
    error = error ? error : &own;
    if (!fit->done)
        return ld_fail(error, LD_ERR_INPUT, "the fit has not run");
    fit_page *page = calloc(1, sizeof *page);
    chart *charts = calloc(MOST_CHARTS, sizeof *charts);
    ld_status status = page && charts ? LD_OK : no_memory(error);
    if (!status) {
        page->fit = fit;
        page->charts = charts;
        status = fill_page(page, error);
    }
    if (!status)
        status = charts_draw(file, "Fit", page->charts, page->count, error);
    while (page && page->owned_count > 0)
        free(page->owned[--page->owned_count]);
    free(page);
    free(charts);
    return status;
}
