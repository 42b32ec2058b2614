#include <math.h>
#include <string.h>

#include "launchdyn/version.h"
#include "results/json.h"
#include "studies/show/show_over.h"
#include "studies/store/table_file.h"

// Estimates of a row, by the names that they have in both files.
typedef struct named_estimates {
    int count;
    const char *name[3];
    const estimate *of[3];
} named_estimates;

static const char *statistic_name(const over_asked *asked)
{
    static const char *const name[] = {[OVER_MEAN] = "mean",
                                       [OVER_DEVIATION] = "deviation",
                                       [OVER_QUANTILE] = "quantile",
                                       [OVER_SHARE] = "share",
                                       [OVER_FOOTPRINT] = "area"};
    static const char *const paired[] = {[OVER_MEAN] = "difference",
                                         [OVER_DEVIATION] = "ratio",
                                         [OVER_QUANTILE] = "difference",
                                         [OVER_SHARE] = "difference",
                                         [OVER_FOOTPRINT] = "ratio"};
    return (asked->of.reference.data ? paired : name)[asked->statistic.kind];
}

// @param columns of the row; of all that may come: 1
static named_estimates estimates_of(const over_asked *asked, const over_row *row, int columns)
{
    if (asked->chosen)
        return (named_estimates){1, {statistic_name(asked)}, {&row->found}};
    if (!asked->of.reference.data)
        return (named_estimates){2, {"mean", "deviation"}, {&row->mean, &row->deviation}};
    const paired_statistics *of = &row->pairs;
    if (columns == 2)
        return (named_estimates){2, {"ratio", "ratio_within"}, {&of->spread, &of->within}};
    return (named_estimates){
        3, {"difference", "ratio", "ratio_within"}, {&of->difference, &of->spread, &of->within}};
}

static const char *unit_of(const over_asked *asked, const over_row *row)
{
    if (asked->chosen && asked->statistic.kind == OVER_SHARE)
        return "";
    if (asked->chosen && asked->statistic.kind == OVER_FOOTPRINT)
        return "m2";
    return row->column[0]->unit;
}

static bool is_of_landings(const over_asked *asked)
{
    return asked->chosen && asked->statistic.kind == OVER_FOOTPRINT;
}

// ---- JSON

typedef struct json_rows {
    json_writer *json;
    const over_asked *asked;
    int item; // whose rows have begun; -1: none
    long long rows;
} json_rows;

static void end_item(json_rows *to)
{
    if (to->item < 0)
        return;
    json_close(to->json, ']');
    json_close(to->json, '}');
}

static void begin_item(json_rows *to, const over_row *row)
{
    end_item(to);
    to->item = row->item;
    json_open(to->json, NULL, '{');
    json_open(to->json, "of", '[');
    for (int k = 0; k < row->columns && !is_of_landings(to->asked); k++)
        json_text(to->json, NULL, row->column[k]->name);
    json_close(to->json, ']');
    json_text(to->json, "unit", unit_of(to->asked, row));
    json_open(to->json, "rows", '[');
}

static void json_row(void *self, const over_row *row)
{
    json_rows *to = self;
    json_writer *json = to->json;
    const over *of = &to->asked->of;
    const named_estimates found = estimates_of(to->asked, row, row->columns);
    const bool paired = of->reference.data;
    if (to->item != row->item)
        begin_item(to, row);
    json_open(json, NULL, '{');
    json_open(json, "swept", '{');
    for (int k = 0; k < over_key_count(of); k++)
        json_text(json, over_key_name(of, k), over_text(of, row->cell, k));
    json_close(json, '}');
    json_integer(json, "points", row->points);
    json_integer(json, paired ? "pairs" : "rockets", (long long)row->count);
    json_integer(json, "groups", (long long)row->groups);
    for (int i = 0; i < found.count; i++) {
        const bool known = !paired || to->asked->chosen || row->pairs.groups > 0;
        json_open(json, found.name[i], '{');
        json_number(json, "value", known ? found.of[i]->value : NAN);
        json_number(json, "low", known ? found.of[i]->low : NAN);
        json_number(json, "high", known ? found.of[i]->high : NAN);
        json_close(json, '}');
    }
    json_close(json, '}');
    to->rows++;
}

ld_status show_over_json(const shown *self, over_asked *asked, ld_error *error)
{
    json_writer json = {.file = self->stream};
    json_rows to = {.json = &json, .asked = asked, .item = -1};
    char text[1024];
    json_open(&json, NULL, '{');
    json_integer(&json, "format", 1);
    json_text(&json, "version", LD_VERSION);
    json_text(&json, "title", self->data->title ? self->data->title : "");
    json_text(&json, "statistic", self->statistic ? self->statistic : "");
    over_pooled_text(&asked->of, text, sizeof text);
    json_text(&json, "pooled", text);
    if (asked->of.reference.data) {
        over_reference_text(&asked->of, text, sizeof text);
        json_text(&json, "reference", text);
    }
    json_open(&json, "results", '[');
    ld_status status = over_rows_each(self, asked, json_row, &to, error);
    end_item(&to);
    json_close(&json, ']');
    json_close(&json, '}');
    fputc('\n', self->stream);
    return status || to.rows > 0
               ? status
               : ld_fail(error, LD_ERR_INPUT, "--over: no point has a value of these results");
}

// ---- CSV

typedef struct csv_rows {
    FILE *stream;
    const over_asked *asked;
} csv_rows;

static void csv_number(FILE *stream, double value)
{
    if (isnan(value))
        fputc(',', stream);
    else
        fprintf(stream, ",%.17g", value);
}

static void csv_row(void *self, const over_row *row)
{
    const csv_rows *to = self;
    const over *of = &to->asked->of;
    const bool paired = of->reference.data;
    const named_estimates all = estimates_of(to->asked, row, 1);
    for (int k = 0; k < over_key_count(of); k++) {
        csv_text(to->stream, over_text(of, row->cell, k));
        fputc(',', to->stream);
    }
    if (!is_of_landings(to->asked))
        csv_text(to->stream, row->column[0]->name);
    if (row->columns == 2) {
        fputs(" and ", to->stream);
        csv_text(to->stream, row->column[1]->name);
    }
    fprintf(to->stream, ",%s,%d,%zu,%zu", unit_of(to->asked, row), row->points, row->count,
            row->groups);
    for (int i = 0; i < all.count; i++) {
        bool known =
            !paired || to->asked->chosen || (row->pairs.groups > 0 && (row->columns == 1 || i > 0));
        csv_number(to->stream, known ? all.of[i]->value : NAN);
        csv_number(to->stream, known ? all.of[i]->low : NAN);
        csv_number(to->stream, known ? all.of[i]->high : NAN);
    }
    fputc('\n', to->stream);
}

ld_status show_over_csv(const shown *self, over_asked *asked, FILE *stream, ld_error *error)
{
    const over_row none = {0};
    const named_estimates all = estimates_of(asked, &none, 1);
    csv_rows to = {stream, asked};
    for (int k = 0; k < over_key_count(&asked->of); k++) {
        csv_text(stream, over_key_name(&asked->of, k));
        fputc(',', stream);
    }
    fprintf(stream, "result,unit,points,%s,groups", asked->of.reference.data ? "pairs" : "rockets");
    for (int i = 0; i < all.count; i++)
        fprintf(stream, ",%s,%s_low,%s_high", all.name[i], all.name[i], all.name[i]);
    fputc('\n', stream);
    return over_rows_each(self, asked, csv_row, &to, error);
}
