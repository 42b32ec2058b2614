#include "studies/show/show_over.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/printed.h"
#include "quantities/study_results.h"
#include "studies/show/show_numbers.h"

// ---- what is shown

// The swept keys that POINT names, "base.speed,firing.interval"; "": none.
static void name_keys(const study_data *data, const char *point, char *keys, size_t size)
{
    against of;
    ld_error error;
    keys[0] = '\0';
    if (against_read(point, data, &of, &error))
        return;
    for (int k = 0, count = 0; k < data->swept_count && of.value; k++)
        if (of.value[k] && count++ < OVER_KEYS) {
            size_t length = strlen(keys);
            snprintf(keys + length, size - length, "%s%s", length ? "," : "", data->swept[k]);
        }
    against_free(&of);
}

ld_status show_over_open(const shown *self, over *of, ld_error *error)
{
    const ld_study_view *view = self->view;
    char keys[OVER_KEYS * LD_MAX_PATH + 2] = "";
    if (!view->over && view->against)
        name_keys(self->data, view->against, keys, sizeof keys);
    return over_open(view->over ? view->over
                     : *keys    ? keys
                                : NULL,
                     view->against, self->data, of, error);
}

// The columns of item `i`: first the results, then of differences the pairs of two that are shown.
static int item_columns(const shown *self, int i, const study_column *column[2])
{
    if (i < self->count) {
        column[0] = self->column[i];
        return 1;
    }
    for (int k = 0; k < 2; k++) {
        column[k] = NULL;
        for (int c = 0; c < self->count; c++)
            if (strcmp(self->column[c]->name, study_pairs[i - self->count].name[k]) == 0)
                column[k] = self->column[c];
        if (!column[k])
            return 0;
    }
    return 2;
}

// ---- a table

enum { MEAN = 24, DEVIATION = 33, DIFFERENCE = 36, RATIO = 26, WIDEST = 40, GAP = 2 };

typedef struct over_table {
    FILE *stream;
    over *of;
    const study_column *column[2];
    int columns;
    bool begun, paired;
    bool several; // a sample has several rockets: ratios within samples
    study_unit unit;
    int64_t *rows; // that were printed
} over_table;

static int key_width(const over *of, int k)
{
    size_t width = strlen(over_key_name(of, k));
    for (int i = 0; i < over_cell_count(of); i++) {
        size_t own = strlen(over_text(of, i, k));
        width = own > width ? own : width;
    }
    return (int)(width < WIDEST ? width : WIDEST) + GAP;
}

static void print_keys(const over_table *to, int cell)
{
    for (int k = 0; k < over_key_count(to->of); k++) {
        const char *text = cell < 0 ? over_key_name(to->of, k) : over_text(to->of, cell, k);
        fprintf(to->stream, "%-*.*s", key_width(to->of, k), WIDEST, VISIBLE(text));
    }
}

static void begin_table(over_table *to)
{
    FILE *stream = to->stream;
    char name[512];
    if (to->begun)
        return;
    to->begun = true;
    if (to->columns == 2)
        snprintf(name, sizeof name, "%.180s and %.180s: areas of their ellipses",
                 to->column[0]->name, to->column[1]->name);
    else
        snprintf(name, sizeof name, "%.180s%s%s%s", to->column[0]->name,
                 to->unit.name[0] ? " [" : "", to->unit.name, to->unit.name[0] ? "]" : "");
    fprintf(stream, "\n%s\n", VISIBLE(name));
    print_keys(to, -1);
    if (!to->paired)
        fprintf(stream, " %-*s %-*s %s\n", MEAN, "mean", DEVIATION, "standard deviation",
                "rockets");
    else if (to->columns == 1)
        fprintf(stream, " %-*s %-*s ", DIFFERENCE, "difference of the means", RATIO,
                "ratio of the deviations");
    else
        fprintf(stream, " %-*s ", RATIO, "ratio of the areas");
    if (to->paired)
        fprintf(stream, "%-*s%s\n", to->several ? RATIO + 1 : 0,
                to->several ? "ratio within samples" : "", "pairs");
}

static ld_status print_own(over_table *to, int cell, ld_error *error)
{
    const pooled *of = &to->of->pool;
    uncertain mean;
    estimate deviation;
    if (pooled_mean(of, &mean) || pooled_deviation(of, &deviation))
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's statistics");
    const estimate si = interval_of(&mean), own = show_scaled(&si, to->unit.factor);
    deviation = show_scaled(&deviation, to->unit.factor);
    begin_table(to);
    print_keys(to, cell);
    show_half(to->stream, MEAN, &own, 6);
    show_estimate(to->stream, DEVIATION, &deviation, NAN);
    fprintf(to->stream, " %zu\n", of->count);
    ++*to->rows;
    return LD_OK;
}

static ld_status print_pairs(over_table *to, int cell, ld_error *error)
{
    paired_statistics of;
    if (pooled_pairs(&to->of->pool, &of))
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's statistics");
    const estimate difference = show_scaled(&of.difference, to->unit.factor);
    begin_table(to);
    print_keys(to, cell);
    if (of.groups == 0) {
        fputs(" less than two pairs of rockets\n", to->stream);
        return LD_OK;
    }
    if (to->columns == 1)
        show_estimate(to->stream, DIFFERENCE, &difference, NAN);
    show_estimate(to->stream, RATIO, &of.spread, NAN);
    if (to->several)
        show_estimate(to->stream, RATIO, &of.within, NAN);
    fprintf(to->stream, " %zu\n", of.count);
    ++*to->rows;
    return LD_OK;
}

static ld_status print_table(over_table *to, ld_error *error)
{
    ld_status status = LD_OK;
    for (int cell = 0; cell < over_cell_count(to->of) && !status; cell++) {
        if (to->paired && over_is_reference(to->of, cell))
            continue;
        status = over_pool(to->of, cell, to->column, to->columns, error);
        if (!status && to->of->pool.count > 0)
            status = to->paired ? print_pairs(to, cell, error) : print_own(to, cell, error);
    }
    return status;
}

// ---- all of them

static void print_head(const over_table *to)
{
    const study_data *data = to->of->data;
    char text[1024];
    int64_t done = 0, failed = 0;
    for (int i = 0; i < data->point_count; i++) {
        done += data->point[i].done;
        failed += data->point[i].failed;
    }
    over_pooled_text(to->of, text, sizeof text);
    fprintf(to->stream,
            "%" PRId64 " samples at %d points, %" PRId64 " failed; %s%s95 %% intervals over "
            "independent groups\n",
            done, data->point_count, failed, VISIBLE(text), *text ? "; " : "");
    if (!to->paired)
        return;
    over_reference_text(to->of, text, sizeof text);
    fprintf(to->stream, "differences from %s; pairs of rockets with the same sampled numbers\n",
            VISIBLE(text));
}

static bool has_salvos(const study_data *data)
{
    int64_t samples = 0;
    for (int i = 0; i < data->point_count; i++)
        samples += data->point[i].done - data->point[i].failed;
    return data->rockets > samples;
}

ld_status show_over(shown *self, over *of, ld_error *error)
{
    int64_t rows = 0;
    over_table to = {.stream = self->stream,
                     .of = of,
                     .paired = of->reference.data,
                     .several = has_salvos(self->data),
                     .rows = &rows};
    int items = self->count + (to.paired ? STUDY_PAIRS : 0);
    ld_status status = LD_OK;
    print_head(&to);
    for (int i = 0; i < items && !status; i++) {
        to.begun = false;
        to.columns = item_columns(self, i, to.column);
        if (to.columns == 0)
            continue;
        to.unit = study_result_unit(to.column[0]->name, to.column[0]->unit);
        status = print_table(&to, error);
    }
    if (!status && rows == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       to.paired ? "--against: no point has two pairs of rockets with the one that "
                                   "it is compared with"
                                 : "--over: no point has a value of these results");
    return status;
}
