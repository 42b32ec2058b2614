// The course of an optimisation as a picture: the aim and the keys, candidate by candidate.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "figures/chart.h"
#include "model/parts.h"
#include "optimise/optimise.h"
#include "run/aims.h"

// Candidates in columns: number, aim where all constraints hold, where one is broken, best so far,
// an interval that is none,
// then the keys.
enum { NUMBER, HOLDS, BROKEN, BEST, NO_INTERVAL, KEYS };

static void fill_columns(const ld_optimisation *self, double *column[])
{
    double best = NAN;
    for (int k = 0; k < self->candidates; k++) {
        const optimise_candidate *of = &self->candidate[k];
        bool holds = of->there && !(of->worst > 0);
        if (holds && !(best <= of->value))
            best = of->value;
        column[NUMBER][k] = k + 1;
        column[HOLDS][k] = holds ? of->value : NAN;
        column[BROKEN][k] = of->there && !holds ? of->value : NAN;
        column[BEST][k] = best;
        column[NO_INTERVAL][k] = NAN;
        for (int i = 0; i < self->keys; i++)
            column[KEYS + i][k] = of->x[i];
    }
}

static chart_curve curve_of(const ld_optimisation *self, double *const column[], int y,
                            const char *label)
{
    const double *none = column[NO_INTERVAL];
    return (chart_curve){.label = label,
                         .count = (size_t)self->candidates,
                         .x = column[NUMBER],
                         .y = column[y],
                         .dots = y == HOLDS || y == BROKEN,
                         .low = none,
                         .high = none};
}

static ld_status draw(const ld_optimisation *self, double *const column[], const char *file,
                      ld_error *error)
{
    char aim[256], label[320];
    const study_unit *shown = &self->aim[0].shown;
    const char *title = model_title(self->model);
    aim_text(self->aim[0].as, aim, sizeof aim);
    snprintf(label, sizeof label, "aim%s%s%s", shown->name[0] ? " [" : "", shown->name,
             shown->name[0] ? "]" : "");
    chart charts[2] = {{.title = aim,
                        .x_label = "candidate",
                        .y_label = label,
                        .x_factor = 1,
                        .y_factor = shown->factor},
                       {.title = "keys, from their lower bounds (0) to their upper ones (1)",
                        .x_label = "candidate",
                        .y_label = "share of the bounds",
                        .x_factor = 1,
                        .y_factor = 1}};
    charts[0].curve[charts[0].count++] = curve_of(self, column, BEST, "best so far");
    charts[0].curve[charts[0].count++] = curve_of(self, column, HOLDS, "candidates");
    if (self->aims > 1)
        charts[0].curve[charts[0].count++] =
            curve_of(self, column, BROKEN, "candidates that break a constraint");
    for (int i = 0; i < self->keys && i < CHART_CURVES; i++)
        charts[1].curve[charts[1].count++] =
            curve_of(self, column, KEYS + i, self->key[i].place.path);
    return charts_draw(file, title && *title ? title : "Optimisation", charts, 2, error);
}

ld_status ld_optimise_plot(const ld_optimisation *self, const char *file, ld_error *error)
{
    ld_error own;
    error = error ? error : &own;
    if (!self->done)
        return ld_fail(error, LD_ERR_INPUT, "nothing to draw: the optimisation has not run");
    size_t count = (size_t)self->candidates;
    double *column[KEYS + LD_MAX_BOUNDS];
    double *all = calloc(count * (size_t)(KEYS + self->keys) + 1, sizeof *all);
    if (!all)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the picture");
    for (int i = 0; i < KEYS + self->keys; i++)
        column[i] = all + count * (size_t)i;
    fill_columns(self, column);
    locale_t before = numeric_locale_enter();
    ld_status status = draw(self, column, file, error);
    numeric_locale_leave(before);
    free(all);
    return status;
}
