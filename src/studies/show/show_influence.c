#include "studies/show/show_influence.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/printed.h"
#include "quantities/study_results.h"
#include "studies/show/show_numbers.h"

enum { NAME = 33, CELL = 30 };

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's sensitivities");
}

// Of what the factors have in common: the rows or trajectories that are complete for all.
static size_t complete_rows(const influence *list, int count, bool effects)
{
    size_t rows = SIZE_MAX;
    for (int i = 0; i < count; i++) {
        size_t own = effects ? list[i].effects.count : list[i].indices.count;
        rows = own < rows ? own : rows;
    }
    return count > 0 ? rows : 0;
}

static void print_percent(FILE *stream, int width, const estimate *e)
{
    char text[96];
    if (isnan(e->value))
        snprintf(text, sizeof text, "-");
    else
        snprintf(text, sizeof text, "%.3g [%.3g, %.3g]", 100 * e->value, 100 * e->low,
                 100 * e->high);
    fprintf(stream, " %-*s", width, text);
}

static void print_indices(FILE *stream, const influence *list, int count, bool by_first)
{
    double sum = 0;
    bool known = false;
    fprintf(stream, "%-*s %-*s %-*s %s\n", NAME, "", CELL, by_first ? "first order" : "total", CELL,
            by_first ? "total" : "first order", "with others: total less first");
    for (int i = 0; i < count; i++) {
        const variance_indices *of = &list[i].indices;
        fprintf(stream, "%-*s", NAME, VISIBLE(list[i].factor->name));
        print_percent(stream, CELL, by_first ? &of->first : &of->total);
        print_percent(stream, CELL, by_first ? &of->total : &of->first);
        print_percent(stream, 0, &of->together);
        fputc('\n', stream);
        known |= !isnan(of->first.value);
        sum += isnan(of->first.value) ? 0 : of->first.value;
    }
    if (known)
        fprintf(stream, "%-*s %.3g\n", NAME, "first orders, sum", 100 * sum);
}

static void print_effects(FILE *stream, const influence *list, int count, double factor)
{
    fprintf(stream, "%-*s %-*s %-*s %s\n", NAME, "", CELL, "mu* (mean magnitude)", CELL,
            "mu (mean)", "sigma");
    for (int i = 0; i < count; i++) {
        const elementary_effects *of = &list[i].effects;
        const estimate magnitude = show_scaled(&of->magnitude, factor);
        const estimate mean = show_scaled(&of->mean, factor);
        fprintf(stream, "%-*s", NAME, VISIBLE(list[i].factor->name));
        show_estimate(stream, CELL, &magnitude, NAN);
        show_estimate(stream, CELL, &mean, of->magnitude.value * factor);
        show_number(stream, 0, factor * of->deviation, 4);
        fputc('\n', stream);
    }
}

static void print_result(shown *self, const study_column *result, const influence *list, int count)
{
    FILE *stream = self->stream;
    const influence_kind kind = influence_kind_of(self->data);
    const bool effects = kind == INFLUENCE_EFFECTS;
    const study_unit unit = study_result_unit(result->name, result->unit);
    char text[INFLUENCE_TEXT];
    fprintf(stream, "\n%s", VISIBLE(result->name));
    if (effects)
        fprintf(stream, "%s%s%s: change for the whole of a factor's probability",
                *unit.name ? " [" : "", VISIBLE(unit.name), *unit.name ? "]" : "");
    else
        fputs(": % of its variance, 95 % intervals", stream);
    fprintf(stream, "; %zu complete %s\n", complete_rows(list, count, effects),
            effects ? "effects of each" : "rows");
    if (effects)
        print_effects(stream, list, count, unit.factor);
    else
        print_indices(stream, list, count, self->view->index == LD_INDEX_FIRST);
    influence_sentence(result, kind, list, count, text);
    fprintf(stream, "%s%s", VISIBLE(text), *text ? "\n" : "");
}

ld_status show_influences(shown *self, const study_point *point, ld_error *error)
{
    const study_data *data = self->data;
    influence *list = calloc((size_t)data->column_count + 1, sizeof *list);
    ld_status status = list ? LD_OK : no_memory(error);
    for (int i = 0; i < self->count && !status; i++) {
        int count;
        const group_statistics *of = &shown_statistics(self, point)[i];
        if (!(of->greatest > of->least))
            continue;
        status = influences_of(
            &(influence_question){data, point, self->column[i], (ld_index)self->view->index},
            &self->values, list, &count, error);
        if (!status)
            print_result(self, self->column[i], list, count);
    }
    free(list);
    return status;
}

// ---- JSON

static void write_estimate(json_writer *json, const char *key, const estimate *e)
{
    json_open(json, key, '{');
    json_number(json, "value", e->value);
    json_number(json, "low", e->low);
    json_number(json, "high", e->high);
    json_close(json, '}');
}

static void write_one(json_writer *json, const influence *of, influence_kind kind)
{
    json_open(json, NULL, '{');
    json_text(json, "path", of->factor->name);
    if (kind == INFLUENCE_INDICES) {
        write_estimate(json, "first", &of->indices.first);
        write_estimate(json, "total", &of->indices.total);
        write_estimate(json, "with_others", &of->indices.together);
        json_integer(json, "count", (long long)of->indices.count);
        json_integer(json, "groups", (long long)of->indices.groups);
    } else {
        write_estimate(json, "mu_star", &of->effects.magnitude);
        write_estimate(json, "mu", &of->effects.mean);
        json_number(json, "sigma", of->effects.deviation);
        json_integer(json, "count", (long long)of->effects.count);
        json_integer(json, "groups", (long long)of->effects.groups);
    }
    json_close(json, '}');
}

ld_status show_influences_json(json_writer *json, shown *self, const study_point *point, int result,
                               ld_error *error)
{
    const study_data *data = self->data;
    const influence_kind kind = influence_kind_of(data);
    int count = 0;
    influence *list = calloc((size_t)data->column_count + 1, sizeof *list);
    ld_status status = list ? LD_OK : no_memory(error);
    if (!status)
        status = influences_of(
            &(influence_question){data, point, self->column[result], (ld_index)self->view->index},
            &self->values, list, &count, error);
    json_open(json, "factors", '[');
    for (int i = 0; i < count && !status; i++)
        write_one(json, &list[i], kind);
    json_close(json, ']');
    if (!status) {
        char text[INFLUENCE_TEXT];
        influence_sentence(self->column[result], kind, list, count, text);
        json_text(json, "says", text);
    }
    free(list);
    return status;
}
