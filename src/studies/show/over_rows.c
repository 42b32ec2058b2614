#include "studies/show/over_rows.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "quantities/study_results.h"

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

ld_status over_rows_open(const shown *self, over_asked *asked, ld_error *error)
{
    const ld_study_view *view = self->view;
    char keys[OVER_KEYS * LD_MAX_PATH + 2] = "";
    *asked = (over_asked){.chosen = self->statistic != NULL};
    if (!view->over && view->against)
        name_keys(self->data, view->against, keys, sizeof keys);
    ld_status status = over_statistic_read(self->statistic, &asked->statistic, error);
    return status ? status
                  : over_open(view->over ? view->over
                              : *keys    ? keys
                                         : NULL,
                              view->against, self->data, &asked->of, error);
}

void over_rows_close(over_asked *asked)
{
    over_close(&asked->of);
}

// How many there are of them.
static int item_count(const shown *self, const over_asked *asked)
{
    if (asked->chosen)
        return asked->statistic.kind == OVER_FOOTPRINT ? 1 : self->count;
    return self->count + (asked->of.reference.data ? STUDY_PAIRS : 0);
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

// ---- numbers

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's statistics");
}

static ld_status find_asked(over_asked *asked, over_row *row, ld_error *error)
{
    over_found found;
    ld_status status =
        over_find(&asked->of, row->cell, &asked->statistic, row->column[0], &found, error);
    row->found = found.of;
    row->count = found.count;
    row->groups = found.groups;
    row->points = found.points;
    return status;
}

static ld_status find_usual(over_asked *asked, over_row *row, ld_error *error)
{
    const pooled *pool = &asked->of.pool;
    uncertain mean;
    ld_status status = over_pool(&asked->of, row->cell, row->column, row->columns, error);
    row->count = pool->count;
    row->groups = pooled_groups(pool);
    row->points = pool->points;
    if (status || pool->count == 0)
        return status;
    if (asked->of.reference.data)
        return pooled_pairs(pool, &row->pairs) ? no_memory(error) : LD_OK;
    if (pooled_mean(pool, &mean) || pooled_deviation(pool, &row->deviation))
        return no_memory(error);
    row->mean = interval_of(&mean);
    return LD_OK;
}

static ld_status take_item(over_asked *asked, over_row *row, over_row_sink *take, void *sink,
                           ld_error *error)
{
    const bool paired = asked->of.reference.data;
    ld_status status = LD_OK;
    for (row->cell = 0; row->cell < over_cell_count(&asked->of) && !status; row->cell++) {
        if (paired && over_is_reference(&asked->of, row->cell))
            continue;
        status = asked->chosen ? find_asked(asked, row, error) : find_usual(asked, row, error);
        if (!status && row->count > 0)
            take(sink, row);
    }
    return status;
}

ld_status over_rows_each(const shown *self, over_asked *asked, over_row_sink *take, void *sink,
                         ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; i < item_count(self, asked) && !status; i++) {
        over_row row = {.item = i};
        row.columns = item_columns(self, i, row.column);
        if (row.columns > 0)
            status = take_item(asked, &row, take, sink, error);
    }
    return status;
}
