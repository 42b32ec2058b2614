#include "studies/show/show_over.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/printed.h"
#include "quantities/study_results.h"
#include "studies/show/show_numbers.h"

// ---- a table

enum {
    MEAN = 24,
    DEVIATION = 33,
    DIFFERENCE = 36,
    RATIO = 26,
    STATISTIC = 36,
    WIDEST = 40,
    GAP = 2
};

typedef struct over_table {
    FILE *stream;
    const over_asked *asked;
    int item; // whose table has begun; -1: none
    bool paired;
    bool several; // a sample has several rockets: ratios within samples
    study_unit unit;
    int64_t rows; // that have numbers
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
    const over *of = &to->asked->of;
    for (int k = 0; k < over_key_count(of); k++) {
        const char *text = cell < 0 ? over_key_name(of, k) : over_text(of, cell, k);
        fprintf(to->stream, "%-*.*s", key_width(of, k), WIDEST, VISIBLE(text));
    }
}

static void print_title(const over_table *to, const over_row *row)
{
    char name[512], what[256];
    const char *unit = to->unit.name;
    if (row->columns == 2)
        snprintf(name, sizeof name, "%.180s and %.180s: areas of their ellipses",
                 row->column[0]->name, row->column[1]->name);
    else if (to->asked->chosen)
        over_statistic_text(&to->asked->of, &to->asked->statistic, row->column[0], what,
                            sizeof what);
    if (row->columns == 1)
        snprintf(name, sizeof name, "%.240s%s%s%s", to->asked->chosen ? what : row->column[0]->name,
                 unit[0] ? " [" : "", unit, unit[0] ? "]" : "");
    fprintf(to->stream, "\n%s\n", VISIBLE(name));
}

static void begin_table(over_table *to, const over_row *row)
{
    FILE *stream = to->stream;
    if (to->item == row->item)
        return;
    to->item = row->item;
    print_title(to, row);
    print_keys(to, -1);
    if (to->asked->chosen)
        fprintf(stream, " %-*s ", STATISTIC,
                over_statistic_word(&to->asked->of, &to->asked->statistic));
    else if (!to->paired)
        fprintf(stream, " %-*s %-*s ", MEAN, "mean", DEVIATION, "standard deviation");
    else if (row->columns == 1)
        fprintf(stream, " %-*s %-*s ", DIFFERENCE, "difference of the means", RATIO,
                "ratio of the deviations");
    else
        fprintf(stream, " %-*s ", RATIO, "ratio of the areas");
    if (to->paired && !to->asked->chosen && to->several)
        fprintf(stream, "%-*s", RATIO + 1, "ratio within samples");
    fprintf(stream, "%s\n", to->paired ? "pairs" : "rockets");
}

static void print_pairs(over_table *to, const over_row *row)
{
    const paired_statistics *of = &row->pairs;
    const estimate difference = show_scaled(&of->difference, to->unit.factor);
    if (row->columns == 1)
        show_estimate(to->stream, DIFFERENCE, &difference, NAN);
    show_estimate(to->stream, RATIO, &of->spread, NAN);
    if (to->several)
        show_estimate(to->stream, RATIO, &of->within, NAN);
    fprintf(to->stream, " %zu\n", of->count);
}

static void print_own(const over_table *to, const over_row *row)
{
    const estimate mean = show_scaled(&row->mean, to->unit.factor);
    const estimate deviation = show_scaled(&row->deviation, to->unit.factor);
    show_half(to->stream, MEAN, &mean, 6);
    show_estimate(to->stream, DEVIATION, &deviation, NAN);
    fprintf(to->stream, " %zu\n", row->count);
}

static study_unit unit_of(const over_table *to, const over_row *row)
{
    char text[256];
    return to->asked->chosen ? over_statistic_text(&to->asked->of, &to->asked->statistic,
                                                   row->column[0], text, sizeof text)
                             : study_result_unit(row->column[0]->name, row->column[0]->unit);
}

static void print_row(void *self, const over_row *row)
{
    over_table *to = self;
    to->unit = unit_of(to, row);
    begin_table(to, row);
    print_keys(to, row->cell);
    if (to->asked->chosen) {
        const estimate found = show_scaled(&row->found, to->unit.factor);
        show_estimate(to->stream, STATISTIC, &found, NAN);
        fprintf(to->stream, " %zu\n", row->count);
    } else if (!to->paired) {
        print_own(to, row);
    } else if (row->pairs.groups == 0) {
        fputs(" less than two pairs of rockets\n", to->stream);
        return;
    } else {
        print_pairs(to, row);
    }
    to->rows++;
}

// ---- all of them

static void print_head(const over_table *to)
{
    const over *of = &to->asked->of;
    const study_data *data = of->data;
    char text[1024];
    int64_t done = 0, failed = 0;
    for (int i = 0; i < data->point_count; i++) {
        done += data->point[i].done;
        failed += data->point[i].failed;
    }
    over_pooled_text(of, text, sizeof text);
    fprintf(to->stream,
            "%" PRId64 " samples at %d points, %" PRId64 " failed; %s%s95 %% intervals over "
            "independent groups\n",
            done, data->point_count, failed, VISIBLE(text), *text ? "; " : "");
    if (!to->paired)
        return;
    over_reference_text(of, text, sizeof text);
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

ld_status show_over(const shown *self, over_asked *asked, ld_error *error)
{
    over_table to = {.stream = self->stream,
                     .asked = asked,
                     .item = -1,
                     .paired = asked->of.reference.data,
                     .several = has_salvos(self->data)};
    print_head(&to);
    ld_status status = over_rows_each(self, asked, print_row, &to, error);
    if (!status && to.rows == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       to.paired ? "--against: no point has two pairs of rockets with the one that "
                                   "it is compared with"
                                 : "--over: no point has a value of these results");
    return status;
}
