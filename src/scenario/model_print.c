// A model as a scenario in SI units: every key, in the order of the tables.
#include <locale.h>
#include <stdlib.h>

#include "base/printed.h"
#include "model/fields/factor.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "quantities/study_results.h"
#include "run/measure_names.h"
#include "scenario/clock_text.h"
#include "scenario/scenario_reader.h"
#include "scenario/scenario_text.h"

#include <string.h>

static void print_number(FILE *stream, const double *values, int count, const char *unit)
{
    char text[32];
    for (int i = 0; i < count; i++) {
        field_number_text(values[i], text);
        fprintf(stream, "%s%s", i ? " " : "", text);
    }
    fprintf(stream, "%s%s", unit[0] ? " " : "", unit);
}

// In quotes; what is not seen is escaped.
void scenario_print_text(FILE *stream, const char *text)
{
    fputc('"', stream);
    while (*text) {
        size_t length;
        int32_t code = printed_code(text, &length);
        if (code == '"' || code == '\\')
            fprintf(stream, "\\%c", (int)code);
        else if (code < 0 || !printed_is_hidden(code))
            fwrite(text, 1, length, stream);
        else if (code < 0x80)
            fprintf(stream, "\\x%02X", (unsigned)code);
        else
            fprintf(stream, code < 0x10000 ? "\\u%04X" : "\\U%08X", (unsigned)code);
        text += length;
    }
    fputc('"', stream);
}

static const char *chosen_word(const field_row *f, const void *base)
{
    int value = f->words[0].value;
    if (f->offset != FIELD_NOWHERE)
        memcpy(&value, field_at_const(base, f), sizeof value);
    return field_word_of(f->words, value)->name;
}

// That stands in place of a word.
static const double *chosen_number(const field_row *f, const void *base)
{
    return (const double *)((const char *)base + f->other);
}

static void print_choice(FILE *stream, const field_row *f, const void *base)
{
    const char *word = chosen_word(f, base);
    if (word[0])
        fprintf(stream, "%s", word);
    else
        print_number(stream, chosen_number(f, base), 1, f->unit);
}

static void print_integers(FILE *stream, const int *values, int count)
{
    fputc('[', stream);
    for (int i = 0; i < count; i++)
        fprintf(stream, "%s%d", i ? ", " : "", values[i]);
    fputc(']', stream);
}

// The names of the marked entries; `all` where that is what they are.
static void print_selection(FILE *stream, const field_row *f, const void *base)
{
    int count = field_switch(base, f), marked = 0;
    for (int i = 0; i < count; i++)
        marked += field_marked(base, f, i);
    if (marked == count) {
        fprintf(stream, "all");
        return;
    }
    const char *between = "[";
    for (int i = 0; i < count; i++)
        if (field_marked(base, f, i)) {
            fprintf(stream, "%s%s", between, (const char *)field_entry_const(base, f, i));
            between = ", ";
        }
    fprintf(stream, marked ? "]" : "[]");
}

// The words whose bits are set; `all` where all are.
static void print_words(FILE *stream, const field_row *f, unsigned bits)
{
    unsigned all = 0;
    for (const field_word *w = f->words; w->name; w++)
        all |= 1u << w->value;
    if (bits == all) {
        fprintf(stream, "all");
        return;
    }
    const char *between = "[";
    for (const field_word *w = f->words; w->name; w++)
        if (bits >> w->value & 1u) {
            fprintf(stream, "%s%s", between, w->name);
            between = ", ";
        }
    fprintf(stream, "]");
}

// A value that fits on one line.
static void print_scalar(FILE *stream, const field_row *f, const void *base)
{
    int value;
    switch (f->kind) {
    case FIELD_NUMBER:
        print_number(stream, field_at_const(base, f), f->count, f->unit);
        return;
    case FIELD_INTEGER:
        value = (int)f->range.low;
        if (f->offset != FIELD_NOWHERE)
            memcpy(&value, field_at_const(base, f), sizeof value);
        fprintf(stream, "%d", value);
        return;
    case FIELD_CHOICE:
        print_choice(stream, f, base);
        return;
    case FIELD_WORD:
    case FIELD_QUANTITY:
        fprintf(stream, "%s", (const char *)field_at_const(base, f));
        return;
    case FIELD_INTEGERS:
        print_integers(stream, field_at_const(base, f), field_switch(base, f));
        return;
    case FIELD_SELECTION:
        print_selection(stream, f, base);
        return;
    case FIELD_WORDS:
        print_words(stream, f, *(const unsigned *)field_at_const(base, f));
        return;
    case FIELD_LIMIT:
        print_number(stream, field_at_const(base, f), 1, ((const ld_aim *)base)->unit);
        return;
    default: // FIELD_TEXT, FIELD_FILE; the others have no place on a line
        scenario_print_text(stream, *(char *const *)field_at_const(base, f));
        return;
    }
}

static bool has_value(const field_row *f, const void *base)
{
    if (f->kind == FIELD_NUMBER || f->kind == FIELD_LIMIT)
        return !isnan(*(const double *)field_at_const(base, f));
    if (f->kind == FIELD_CHOICE && f->unit)
        return chosen_word(f, base)[0] || !isnan(*chosen_number(f, base));
    if (f->kind == FIELD_WORD || f->kind == FIELD_QUANTITY)
        return f->required || *(const char *)field_at_const(base, f);
    if (f->kind == FIELD_WORDS)
        return *(const unsigned *)field_at_const(base, f) != 0;
    if (f->kind == FIELD_TEXT || f->kind == FIELD_FILE)
        return *(char *const *)field_at_const(base, f) != NULL;
    if (f->kind == FIELD_TABLE)
        return ((const ld_table *)field_at_const(base, f))->rows > 0;
    if (f->kind == FIELD_CORRELATED || f->kind == FIELD_UNTIL || f->kind == FIELD_SWEEP ||
        f->kind == FIELD_BOUNDS)
        return field_switch(base, f) > 0;
    if (f->kind == FIELD_LIST && f->silent)
        return field_switch(base, f) > 0;
    return true;
}

// Whether the key has a value to print.
static bool is_given(const field_row *f, const void *base, int form)
{
    return field_has_form(f, form) && !field_is_absent(f, base, form) && has_value(f, base);
}

// The word that stands for a block that is not there; "": it is.
static const char *word_in_place(const field_row *f, const void *base)
{
    return f->words ? field_word_of(f->words, field_switch(base, f))->name : "";
}

// One row: "[0 s, 1 m]".
static void print_row(FILE *stream, const field_row *f, const void *base, const double *row)
{
    const ld_table *table = field_at_const(base, f);
    const table_format *format = field_table_format(f->table, table->columns);
    size_t first = 0;
    char text[CLOCK_TEXT];
    fputc('[', stream);
    if (f->table->sources & TABLE_CLOCK) {
        clock_print(row[first++], *(const double *)((const char *)base + f->other), text);
        fprintf(stream, "%s s", text);
    }
    for (size_t k = first; k < table->columns; k++) {
        fputs(k ? ", " : "", stream);
        print_number(stream, &row[k], 1, format->column[k].unit);
    }
    fputc(']', stream);
}

// Rows of a table on one line: "[[0, 1], [2, 3]]".
static void print_rows(FILE *stream, const field_row *f, const void *base)
{
    const ld_table *table = field_at_const(base, f);
    for (size_t i = 0; i < table->rows; i++) {
        fputs(i ? ", " : "[", stream);
        print_row(stream, f, base, &table->data[i * table->columns]);
    }
    fputs("]", stream);
}

static void print_entry(FILE *stream, const field_block *block, const void *base);

// A list on one line: "[{...}, {...}]".
static void print_entries(FILE *stream, const field_row *f, const void *base)
{
    fputs("[", stream);
    for (int i = 0; i < field_switch(base, f); i++) {
        fputs(i ? ", {" : "{", stream);
        print_entry(stream, f->block, field_entry_const(base, f, i));
        fputs("}", stream);
    }
    fputs("]", stream);
}

// An entry of a list on one line, without the blocks that it does not have.
static void print_entry(FILE *stream, const field_block *block, const void *base)
{
    const char *between = "";
    int form = field_form(block, base);
    for (const field_row *f = block->fields; f->name; f++) {
        bool inner = f->kind == FIELD_BLOCK;
        if (!is_given(f, base, form) || (inner && word_in_place(f, base)[0]))
            continue;
        fprintf(stream, inner ? "%s%s: {" : "%s%s: ", between, f->name);
        if (inner)
            print_entry(stream, f->block, field_at_const(base, f));
        else if (f->kind == FIELD_TABLE)
            print_rows(stream, f, base);
        else if (f->kind == FIELD_LIST)
            print_entries(stream, f, base);
        else
            print_scalar(stream, f, base);
        fputs(inner ? "}" : "", stream);
        between = ", ";
    }
}

static void print_list(FILE *stream, const field_row *f, const void *base, int depth)
{
    int count = field_switch(base, f);
    if (count == 0)
        fprintf(stream, " []");
    fputc('\n', stream);
    for (int i = 0; i < count; i++) {
        fprintf(stream, "%*s- {", depth * 2, "");
        print_entry(stream, f->block, field_entry_const(base, f, i));
        fprintf(stream, "}\n");
    }
}

static void print_table(FILE *stream, const field_row *f, const void *base, int depth)
{
    const ld_table *table = field_at_const(base, f);
    fputc('\n', stream);
    for (size_t i = 0; i < table->rows; i++) {
        fprintf(stream, "%*s- ", depth * 2, "");
        print_row(stream, f, base, &table->data[i * table->columns]);
        fputc('\n', stream);
    }
}

static void print_distribution(FILE *stream, const ld_factor *factor, const char *unit)
{
    const distribution_row *row = distribution_of(factor->distribution);
    const char *between = "";
    fprintf(stream, "%s: ", row->word);
    switch (row->given) {
    case LD_GIVEN_DEVIATION:
        print_number(stream, &factor->deviation, 1, unit);
        break;
    case LD_GIVEN_RATIO:
        print_number(stream, &factor->deviation, 1, "");
        break;
    case LD_GIVEN_SPAN:
        fputs(isnan(factor->between[0]) ? "+-" : "", stream);
        print_number(stream, isnan(factor->between[0]) ? &factor->spread : factor->between,
                     isnan(factor->between[0]) ? 1 : 2, unit);
        return;
    case LD_GIVEN_VALUES:
        fprintf(stream, "[");
        for (int i = 0; i < factor->value_count; i++, between = ", ") {
            fprintf(stream, "%s", between);
            print_number(stream, &factor->value[i], 1, unit);
        }
        fprintf(stream, "], weights: [");
        between = "";
        for (int i = 0; i < factor->value_count; i++, between = ", ") {
            fprintf(stream, "%s", between);
            print_number(stream, &factor->weight[i], 1, "");
        }
        fprintf(stream, "]");
        return;
    case LD_GIVEN_SAMPLE:
        fprintf(stream, "sample");
        return;
    }
    if (!isnan(factor->within)) {
        fprintf(stream, ", within: ");
        print_number(stream, &factor->within, 1, "");
    }
    if (!isnan(factor->between[0])) {
        fprintf(stream, ", between: ");
        print_number(stream, factor->between, 2, unit);
    }
}

// "paths: [one, other], " of several keys under one name.
static void print_together(FILE *stream, const ld_together *together)
{
    for (int i = 0; i < together->count; i++)
        fprintf(stream, "%s%s", i ? ", " : "paths: [", together->path[i]);
    fputs(together->count ? "], " : "", stream);
}

// Its keys where it has a name of its own, its distribution with the unit in the model.
static void print_factor(FILE *stream, const ld_model *model, const ld_factor *factor)
{
    field_place place;
    char why[384];
    field_locate(model, factor_path(factor, 0), &place, why, sizeof why);
    print_together(stream, &factor->together);
    print_distribution(stream, factor, place.row && place.row->unit ? place.row->unit : "");
}

// The model that the scatter is a part of.
static const ld_model *model_of(const ld_scatter *scatter)
{
    return (const void *)((const char *)scatter - offsetof(ld_model, scatter));
}

static void print_factors(FILE *stream, const field_row *f, const ld_scatter *scatter, int depth)
{
    fputc('\n', stream);
    for (int i = 0; i < field_switch(scatter, f); i++) {
        const ld_factor *factor = &scatter->factor[i];
        fprintf(stream, "%*s%s: {", depth * 2, "", factor->path);
        print_factor(stream, model_of(scatter), factor);
        fprintf(stream, "%s}\n",
                factor_may_be_per_rocket(factor) && !factor->per_rocket ? ", per: sample" : "");
    }
}

static void print_correlated(FILE *stream, const ld_scatter *scatter, int depth)
{
    fputc('\n', stream);
    for (int g = 0; g < scatter->correlated_count; g++) {
        const ld_correlated *group = &scatter->correlated[g];
        fprintf(stream, "%*s- {factors: [", depth * 2, "");
        for (int i = 0; i < group->count; i++)
            fprintf(stream, "%s%s", i ? ", " : "", scatter->factor[group->factor[i]].path);
        fprintf(stream, "], matrix: [");
        for (int i = 0; i < group->count; i++) {
            fprintf(stream, i ? ", [" : "[");
            for (int k = 0; k < group->count; k++) {
                fprintf(stream, k ? ", " : "");
                print_number(stream, &group->matrix[i][k], 1, "");
            }
            fprintf(stream, "]");
        }
        fprintf(stream, "]}\n");
    }
}

// The number of hundredths that reads back as `share`.
static double percent(double share)
{
    double near = share * 100, low = nextafter(near, 0), high = nextafter(near, INFINITY);
    if (near / 100 == share)
        return near;
    return low / 100 == share ? low : high;
}

static void print_statistic(FILE *stream, const ld_model *model, const ld_until *until)
{
    const quantity_things things = quantity_things_of(model);
    const quantity_walk result = study_result_find(&things, until->result);
    double value = until->relative ? percent(until->half_width) : until->half_width;
    fprintf(stream, "%s.%s: ", until->result,
            until->statistic == LD_STATISTIC_MEAN ? "mean" : "deviation");
    print_number(stream, &value, 1,
                 until->relative ? "%"
                 : result.row    ? quantity_unit(&result)
                                 : "");
}

static void print_until(FILE *stream, const ld_scatter *scatter, int depth)
{
    fputc('\n', stream);
    for (int i = 0; i < scatter->until_count; i++) {
        fprintf(stream, "%*s", depth * 2, "");
        print_statistic(stream, model_of(scatter), &scatter->until[i]);
        fputc('\n', stream);
    }
}

static void print_sweep(FILE *stream, const ld_model *model, int depth)
{
    fputc('\n', stream);
    for (int i = 0; i < model->sweep_count; i++) {
        const ld_sweep_axis *axis = &model->sweep[i];
        bool several = axis->together.count > 0;
        fprintf(stream, "%*s%s: %s", depth * 2, "", axis->path, several ? "{" : "");
        print_together(stream, &axis->together);
        fputs(several ? "values: [" : "[", stream);
        for (int k = 0; k < axis->count; k++)
            fprintf(stream, "%s%s", k ? ", " : "", axis->value[k]);
        fputs(several ? "]}\n" : "]\n", stream);
    }
}

// "rocket.mass: [60 kg, 62 kg]", a line for each key.
static void print_bounds(FILE *stream, const ld_optimise *optimise, int depth)
{
    const ld_model *model = (const void *)((const char *)optimise - offsetof(ld_model, optimise));
    fputc('\n', stream);
    for (int i = 0; i < optimise->key_count; i++) {
        const ld_bounds *bounds = &optimise->key[i];
        field_place place;
        char why[384];
        field_locate(model, bounds->path, &place, why, sizeof why);
        const char *unit = place.row && place.row->unit ? place.row->unit : "";
        fprintf(stream, "%*s%s: [", depth * 2, "", bounds->path);
        print_number(stream, &bounds->from, 1, unit);
        fputs(", ", stream);
        print_number(stream, &bounds->to, 1, unit);
        fputs(bounds->log ? ", log]\n" : "]\n", stream);
    }
}

static void print_block(FILE *stream, const field_block *block, const void *base, int depth);

static void print_field(FILE *stream, const field_row *f, const void *base, int depth)
{
    fprintf(stream, "%*s%s:", depth * 2, "", f->name);
    if (f->kind == FIELD_BLOCK) {
        const char *word = word_in_place(f, base);
        fprintf(stream, "%s%s\n", word[0] ? " " : "", word);
        if (!word[0])
            print_block(stream, f->block, field_at_const(base, f), depth + 1);
    } else if (f->kind == FIELD_LIST && f->alternative && field_switch(base, f->alternative)) {
        fputc('\n', stream);
        print_block(stream, f->alternative->block, field_at_const(base, f->alternative), depth + 1);
    } else if (f->kind == FIELD_LIST) {
        print_list(stream, f, base, depth + 1);
    } else if (f->kind == FIELD_FACTORS) {
        print_factors(stream, f, base, depth + 1);
    } else if (f->kind == FIELD_CORRELATED) {
        print_correlated(stream, base, depth + 1);
    } else if (f->kind == FIELD_UNTIL) {
        print_until(stream, base, depth + 1);
    } else if (f->kind == FIELD_BOUNDS) {
        print_bounds(stream, base, depth + 1);
    } else if (f->kind == FIELD_SWEEP) {
        print_sweep(stream, base, depth + 1);
    } else if (f->kind == FIELD_TABLE) {
        print_table(stream, f, base, depth + 1);
    } else {
        fputc(' ', stream);
        print_scalar(stream, f, base);
        fputc('\n', stream);
    }
}

static bool anything_given(const field_block *block, const void *base)
{
    for (const field_row *f = block->fields; f->name; f++)
        if (is_given(f, base, field_form(block, base)))
            return true;
    return false;
}

static void print_block(FILE *stream, const field_block *block, const void *base, int depth)
{
    int form = field_form(block, base);
    for (const field_row *f = block->fields; f->name; f++) {
        bool empty = f->kind == FIELD_BLOCK && !f->words &&
                     !anything_given(f->block, field_at_const(base, f));
        if (is_given(f, base, form) && !empty)
            print_field(stream, f, base, depth);
    }
}

// A vector is printed whole or not at all: what one of its numbers follows from is kept.
static void keep_whole(double to[3], const double from[3])
{
    bool given = !isnan(to[0]) || !isnan(to[1]) || !isnan(to[2]);
    for (int i = 0; i < 3; i++)
        to[i] = given ? from[i] : NAN;
}

// A copy without the numbers that follow from others, where samples or points change those; to be
// freed alone. NULL: there is nothing to leave out, or no memory.
static ld_model *without_completed(const ld_model *model)
{
    bool sweeps = model->sweep_count > 0 && model->point == 0;
    bool changes = model->scatter.factor_count > 0 || sweeps;
    ld_model *copy = changes ? malloc(sizeof *copy) : NULL;
    if (!copy)
        return NULL;
    *copy = *model;
    model_forget(copy);
    keep_whole(copy->rocket.empty.center, model->rocket.empty.center);
    keep_whole(copy->rocket.empty.inertia, model->rocket.empty.inertia);
    return copy;
}

void ld_model_print(const ld_model *model, FILE *stream)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = uselocale(plain);
    ld_model *copy = without_completed(model);
    print_block(stream, &scenario_block, copy ? copy : model, 0);
    free(copy);
    uselocale(before);
    freelocale(plain);
}

// A stream into `text`, closed with its end marked; NULL, and "" in `text`: no memory.
static FILE *open_text(char *text, size_t size)
{
    memset(text, 0, size);
    return fmemopen(text, size - 1, "w");
}

ld_status scenario_factor_text(const ld_model *model, const ld_factor *factor, char *text,
                               size_t size)
{
    FILE *stream = open_text(text, size);
    if (!stream)
        return LD_ERR_MEMORY;
    print_factor(stream, model, factor);
    fclose(stream);
    return LD_OK;
}

ld_status scenario_until_text(const ld_model *model, const ld_until *until, char *text, size_t size)
{
    FILE *stream = open_text(text, size);
    if (!stream)
        return LD_ERR_MEMORY;
    print_statistic(stream, model, until);
    fclose(stream);
    return LD_OK;
}

// The word that stands in place of a block, or NULL.
static const char *word_of_block(const field_value *value)
{
    const char *word = word_in_place(value->row, value->base);
    return word[0] ? word : NULL;
}

ld_status scenario_value_text(const field_value *value, char *text, size_t size)
{
    const field_row *f = value->row;
    bool block = f->kind == FIELD_BLOCK;
    text[0] = '\0';
    if (block ? !word_of_block(value) : f->kind > FIELD_CHOICE && f->kind != FIELD_SELECTION)
        return LD_ERR_INPUT;
    FILE *stream = open_text(text, size);
    if (!stream)
        return LD_ERR_MEMORY;
    if (block)
        fputs(word_of_block(value), stream);
    else if (has_value(f, value->base))
        print_scalar(stream, f, value->base);
    fclose(stream);
    return LD_OK;
}
