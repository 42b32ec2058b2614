// A model as a scenario in SI units: every key, in the order of the tables.

#include "base/memory_stream.h"
#include "base/numeric_locale.h"
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

static void print_number(text_writer *to, const double *values, int count, const char *unit)
{
    char text[32];
    for (int i = 0; i < count; i++) {
        field_number_text(values[i], text);
        text_print(to, "%s%s", i ? " " : "", text);
    }
    text_print(to, "%s%s", unit[0] ? " " : "", unit);
}

// In quotes; what is not seen is escaped.
void scenario_print_text(text_writer *to, const char *text)
{
    text_put(to, "\"");
    while (*text) {
        size_t length;
        int32_t code = printed_code(text, &length);
        if (code == '"' || code == '\\')
            text_print(to, "\\%c", (int)code);
        else if (code < 0 || !printed_is_hidden(code))
            text_add(to, text, length);
        else if (code < 0x80)
            text_print(to, "\\x%02X", (unsigned)code);
        else
            text_print(to, code < 0x10000 ? "\\u%04X" : "\\U%08X", (unsigned)code);
        text += length;
    }
    text_put(to, "\"");
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

static void print_choice(text_writer *to, const field_row *f, const void *base)
{
    const char *word = chosen_word(f, base);
    if (word[0])
        text_print(to, "%s", word);
    else
        print_number(to, chosen_number(f, base), 1, f->unit);
}

static void print_integers(text_writer *to, const int *values, int count)
{
    text_put(to, "[");
    for (int i = 0; i < count; i++)
        text_print(to, "%s%d", i ? ", " : "", values[i]);
    text_put(to, "]");
}

// The names of the marked entries; `all` where that is what they are.
static void print_selection(text_writer *to, const field_row *f, const void *base)
{
    int count = field_switch(base, f), marked = 0;
    for (int i = 0; i < count; i++)
        marked += field_marked(base, f, i);
    if (marked == count) {
        text_put(to, "all");
        return;
    }
    const char *between = "[";
    for (int i = 0; i < count; i++)
        if (field_marked(base, f, i)) {
            text_print(to, "%s%s", between, (const char *)field_entry_const(base, f, i));
            between = ", ";
        }
    text_print(to, marked ? "]" : "[]");
}

// The words whose bits are set; `all` where all are.
static void print_words(text_writer *to, const field_row *f, unsigned bits)
{
    unsigned all = 0;
    for (const field_word *w = f->words; w->name; w++)
        all |= 1u << w->value;
    if (bits == all) {
        text_put(to, "all");
        return;
    }
    const char *between = "[";
    for (const field_word *w = f->words; w->name; w++)
        if (bits >> w->value & 1u) {
            text_print(to, "%s%s", between, w->name);
            between = ", ";
        }
    text_put(to, "]");
}

// A value that fits on one line.
static void print_scalar(text_writer *to, const field_row *f, const void *base)
{
    int value;
    switch (f->kind) {
    case FIELD_NUMBER:
        print_number(to, field_at_const(base, f), f->count, f->unit);
        return;
    case FIELD_INTEGER:
        value = (int)f->range.low;
        if (f->offset != FIELD_NOWHERE)
            memcpy(&value, field_at_const(base, f), sizeof value);
        text_print(to, "%d", value);
        return;
    case FIELD_CHOICE:
        print_choice(to, f, base);
        return;
    case FIELD_WORD:
    case FIELD_QUANTITY:
        text_print(to, "%s", (const char *)field_at_const(base, f));
        return;
    case FIELD_INTEGERS:
        print_integers(to, field_at_const(base, f), field_switch(base, f));
        return;
    case FIELD_SELECTION:
        print_selection(to, f, base);
        return;
    case FIELD_WORDS:
        print_words(to, f, *(const unsigned *)field_at_const(base, f));
        return;
    case FIELD_LIMIT:
        print_number(to, field_at_const(base, f), 1, ((const ld_aim *)base)->unit);
        return;
    default: // FIELD_TEXT, FIELD_FILE; the others have no place on a line
        scenario_print_text(to, *(char *const *)field_at_const(base, f));
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
    if (f->silent && (f->kind == FIELD_LIST || f->kind == FIELD_BLOCK))
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
static void print_row(text_writer *to, const field_row *f, const void *base, const double *row)
{
    const ld_table *table = field_at_const(base, f);
    const table_format *format = field_table_format(f->table, table->columns);
    size_t first = 0;
    char text[CLOCK_TEXT];
    text_put(to, "[");
    if (f->table->sources & TABLE_CLOCK) {
        clock_print(row[first++], *(const double *)((const char *)base + f->other), text);
        text_print(to, "%s s", text);
    }
    for (size_t k = first; k < table->columns; k++) {
        text_put(to, k ? ", " : "");
        print_number(to, &row[k], 1, format->column[k].unit);
    }
    text_put(to, "]");
}

// Rows of a table on one line: "[[0, 1], [2, 3]]".
static void print_rows(text_writer *to, const field_row *f, const void *base)
{
    const ld_table *table = field_at_const(base, f);
    for (size_t i = 0; i < table->rows; i++) {
        text_put(to, i ? ", " : "[");
        print_row(to, f, base, &table->data[i * table->columns]);
    }
    text_put(to, "]");
}

static void print_entry(text_writer *to, const field_block *block, const void *base);

// A list on one line: "[{...}, {...}]".
static void print_entries(text_writer *to, const field_row *f, const void *base)
{
    text_put(to, "[");
    for (int i = 0; i < field_switch(base, f); i++) {
        text_put(to, i ? ", {" : "{");
        print_entry(to, f->block, field_entry_const(base, f, i));
        text_put(to, "}");
    }
    text_put(to, "]");
}

// An entry of a list on one line, without the blocks that it does not have.
static void print_entry(text_writer *to, const field_block *block, const void *base)
{
    const char *between = "";
    int form = field_form(block, base);
    for (const field_row *f = block->fields; f->name; f++) {
        bool inner = f->kind == FIELD_BLOCK;
        if (!is_given(f, base, form) || (inner && word_in_place(f, base)[0]))
            continue;
        text_print(to, inner ? "%s%s: {" : "%s%s: ", between, f->name);
        if (inner)
            print_entry(to, f->block, field_at_const(base, f));
        else if (f->kind == FIELD_TABLE)
            print_rows(to, f, base);
        else if (f->kind == FIELD_LIST)
            print_entries(to, f, base);
        else
            print_scalar(to, f, base);
        text_put(to, inner ? "}" : "");
        between = ", ";
    }
}

static void print_list(text_writer *to, const field_row *f, const void *base, int depth)
{
    int count = field_switch(base, f);
    if (count == 0)
        text_put(to, " []");
    text_put(to, "\n");
    for (int i = 0; i < count; i++) {
        text_print(to, "%*s- {", depth * 2, "");
        print_entry(to, f->block, field_entry_const(base, f, i));
        text_put(to, "}\n");
    }
}

static void print_table(text_writer *to, const field_row *f, const void *base, int depth)
{
    const ld_table *table = field_at_const(base, f);
    text_put(to, "\n");
    for (size_t i = 0; i < table->rows; i++) {
        text_print(to, "%*s- ", depth * 2, "");
        print_row(to, f, base, &table->data[i * table->columns]);
        text_put(to, "\n");
    }
}

static void print_distribution(text_writer *to, const ld_factor *factor, const char *unit)
{
    const distribution_row *row = distribution_of(factor->distribution);
    const char *between = "";
    text_print(to, "%s: ", row->word);
    switch (row->given) {
    case LD_GIVEN_DEVIATION:
        print_number(to, &factor->deviation, 1, unit);
        break;
    case LD_GIVEN_RATIO:
        print_number(to, &factor->deviation, 1, "");
        break;
    case LD_GIVEN_SPAN:
        text_put(to, isnan(factor->between[0]) ? "+-" : "");
        print_number(to, isnan(factor->between[0]) ? &factor->spread : factor->between,
                     isnan(factor->between[0]) ? 1 : 2, unit);
        return;
    case LD_GIVEN_VALUES:
        text_put(to, "[");
        for (int i = 0; i < factor->value_count; i++, between = ", ") {
            text_print(to, "%s", between);
            print_number(to, &factor->value[i], 1, unit);
        }
        text_put(to, "], weights: [");
        between = "";
        for (int i = 0; i < factor->value_count; i++, between = ", ") {
            text_print(to, "%s", between);
            print_number(to, &factor->weight[i], 1, "");
        }
        text_put(to, "]");
        return;
    case LD_GIVEN_SAMPLE:
        text_put(to, "sample");
        return;
    }
    if (!isnan(factor->within)) {
        text_put(to, ", within: ");
        print_number(to, &factor->within, 1, "");
    }
    if (!isnan(factor->between[0])) {
        text_put(to, ", between: ");
        print_number(to, factor->between, 2, unit);
    }
}

// "paths: [one, other], " of several keys under one name.
static void print_together(text_writer *to, const ld_together *together)
{
    for (int i = 0; i < together->count; i++)
        text_print(to, "%s%s", i ? ", " : "paths: [", together->path[i]);
    text_put(to, together->count ? "], " : "");
}

// Its keys where it has a name of its own, its distribution with the unit in the model.
static void print_factor(text_writer *to, const ld_model *model, const ld_factor *factor)
{
    field_place place;
    char why[384];
    field_locate(model, factor_path(factor, 0), &place, why, sizeof why);
    print_together(to, &factor->together);
    print_distribution(to, factor, place.row && place.row->unit ? place.row->unit : "");
}

// The model that the scatter is a part of.
static const ld_model *model_of(const ld_scatter *scatter)
{
    return (const void *)((const char *)scatter - offsetof(ld_model, scatter));
}

static void print_factors(text_writer *to, const field_row *f, const ld_scatter *scatter, int depth)
{
    text_put(to, "\n");
    for (int i = 0; i < field_switch(scatter, f); i++) {
        const ld_factor *factor = &scatter->factor[i];
        text_print(to, "%*s%s: {", depth * 2, "", factor->path);
        print_factor(to, model_of(scatter), factor);
        text_print(to, "%s}\n",
                   factor_may_be_per_rocket(factor) && !factor->per_rocket ? ", per: sample" : "");
    }
}

static void print_correlated(text_writer *to, const ld_scatter *scatter, int depth)
{
    text_put(to, "\n");
    for (int g = 0; g < scatter->correlated_count; g++) {
        const ld_correlated *group = &scatter->correlated[g];
        text_print(to, "%*s- {factors: [", depth * 2, "");
        for (int i = 0; i < group->count; i++)
            text_print(to, "%s%s", i ? ", " : "", scatter->factor[group->factor[i]].path);
        text_put(to, "], matrix: [");
        for (int i = 0; i < group->count; i++) {
            text_print(to, i ? ", [" : "[");
            for (int k = 0; k < group->count; k++) {
                text_print(to, k ? ", " : "");
                print_number(to, &group->matrix[i][k], 1, "");
            }
            text_put(to, "]");
        }
        text_put(to, "]}\n");
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

static void print_statistic(text_writer *to, const ld_model *model, const ld_until *until)
{
    const quantity_things things = quantity_things_of(model);
    const quantity_walk result = study_result_find(&things, until->result);
    double value = until->relative ? percent(until->half_width) : until->half_width;
    text_print(to, "%s.%s: ", until->result,
               until->statistic == LD_STATISTIC_MEAN ? "mean" : "deviation");
    print_number(to, &value, 1, until->relative ? "%" : result.row ? quantity_unit(&result) : "");
}

static void print_until(text_writer *to, const ld_scatter *scatter, int depth)
{
    text_put(to, "\n");
    for (int i = 0; i < scatter->until_count; i++) {
        text_print(to, "%*s", depth * 2, "");
        print_statistic(to, model_of(scatter), &scatter->until[i]);
        text_put(to, "\n");
    }
}

static void print_sweep(text_writer *to, const ld_model *model, int depth)
{
    text_put(to, "\n");
    for (int i = 0; i < model->sweep_count; i++) {
        const ld_sweep_axis *axis = &model->sweep[i];
        bool several = axis->together.count > 0;
        text_print(to, "%*s%s: %s", depth * 2, "", axis->path, several ? "{" : "");
        print_together(to, &axis->together);
        text_put(to, several ? "values: [" : "[");
        for (int k = 0; k < axis->count; k++)
            text_print(to, "%s%s", k ? ", " : "", axis->value[k]);
        text_put(to, several ? "]}\n" : "]\n");
    }
}

// "rocket.mass: [60 kg, 62 kg]", a line for each key.
static void print_bounds(text_writer *to, const ld_optimise *optimise, int depth)
{
    const ld_model *model = (const void *)((const char *)optimise - offsetof(ld_model, optimise));
    text_put(to, "\n");
    for (int i = 0; i < optimise->key_count; i++) {
        const ld_bounds *bounds = &optimise->key[i];
        field_place place;
        char why[384];
        field_locate(model, bounds->path, &place, why, sizeof why);
        const char *unit = place.row && place.row->unit ? place.row->unit : "";
        text_print(to, "%*s%s: [", depth * 2, "", bounds->path);
        print_number(to, &bounds->from, 1, unit);
        text_put(to, ", ");
        print_number(to, &bounds->to, 1, unit);
        text_put(to, bounds->log ? ", log]\n" : "]\n");
    }
}

static void print_block(text_writer *to, const field_block *block, const void *base, int depth);

static void print_field(text_writer *to, const field_row *f, const void *base, int depth)
{
    text_print(to, "%*s%s:", depth * 2, "", f->name);
    if (f->kind == FIELD_BLOCK) {
        const char *word = word_in_place(f, base);
        text_print(to, "%s%s\n", word[0] ? " " : "", word);
        if (!word[0])
            print_block(to, f->block, field_at_const(base, f), depth + 1);
    } else if (f->kind == FIELD_LIST && f->alternative && field_switch(base, f->alternative)) {
        text_put(to, "\n");
        print_block(to, f->alternative->block, field_at_const(base, f->alternative), depth + 1);
    } else if (f->kind == FIELD_LIST) {
        print_list(to, f, base, depth + 1);
    } else if (f->kind == FIELD_FACTORS) {
        print_factors(to, f, base, depth + 1);
    } else if (f->kind == FIELD_CORRELATED) {
        print_correlated(to, base, depth + 1);
    } else if (f->kind == FIELD_UNTIL) {
        print_until(to, base, depth + 1);
    } else if (f->kind == FIELD_BOUNDS) {
        print_bounds(to, base, depth + 1);
    } else if (f->kind == FIELD_SWEEP) {
        print_sweep(to, base, depth + 1);
    } else if (f->kind == FIELD_TABLE) {
        print_table(to, f, base, depth + 1);
    } else {
        text_put(to, " ");
        print_scalar(to, f, base);
        text_put(to, "\n");
    }
}

static bool anything_given(const field_block *block, const void *base)
{
    for (const field_row *f = block->fields; f->name; f++)
        if (is_given(f, base, field_form(block, base)))
            return true;
    return false;
}

static void print_block(text_writer *to, const field_block *block, const void *base, int depth)
{
    int form = field_form(block, base);
    for (const field_row *f = block->fields; f->name; f++) {
        bool empty = f->kind == FIELD_BLOCK && !f->words &&
                     !anything_given(f->block, field_at_const(base, f));
        if (is_given(f, base, form) && !empty)
            print_field(to, f, base, depth);
    }
}

// A vector is printed whole or not at all: what one of its numbers follows from is kept.
static void keep_whole(double to[3], const double from[3])
{
    bool given = !isnan(to[0]) || !isnan(to[1]) || !isnan(to[2]);
    for (int i = 0; i < 3; i++)
        to[i] = given ? from[i] : NAN;
}

// Samples or points change numbers that others follow from.
static bool changes(const ld_model *model)
{
    bool sweeps = model->sweep_count > 0 && model->point == 0;
    return model->scatter.factor_count > 0 || sweeps;
}

// Without the numbers that follow from others. The copy is on the stack, where no memory is short.
static void print_given(text_writer *to, const ld_model *model)
{
    ld_model copy = *model;
    model_forget(&copy);
    keep_whole(copy.rocket.empty.center, model->rocket.empty.center);
    keep_whole(copy.rocket.empty.inertia, model->rocket.empty.inertia);
    print_block(to, &scenario_block, &copy, 0);
}

void ld_model_print(const ld_model *model, FILE *stream)
{
    text_writer to = {.stream = stream};
    locale_t before = numeric_locale_enter();
    if (changes(model))
        print_given(&to, model);
    else
        print_block(&to, &scenario_block, model, 0);
    numeric_locale_leave(before);
}

// Into `text`, of `size` bytes; what is too long is cut.
static text_writer writer_into(char *text, size_t size)
{
    text[0] = '\0';
    return (text_writer){.text = text, .capacity = size, .fixed = true};
}

void scenario_factor_text(const ld_model *model, const ld_factor *factor, char *text, size_t size)
{
    text_writer to = writer_into(text, size);
    print_factor(&to, model, factor);
}

void scenario_until_text(const ld_model *model, const ld_until *until, char *text, size_t size)
{
    text_writer to = writer_into(text, size);
    print_statistic(&to, model, until);
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
    text_writer to = writer_into(text, size);
    if (block ? !word_of_block(value) : f->kind > FIELD_CHOICE && f->kind != FIELD_SELECTION)
        return LD_ERR_INPUT;
    if (block)
        text_put(&to, word_of_block(value));
    else if (has_value(f, value->base))
        print_scalar(&to, f, value->base);
    return LD_OK;
}
