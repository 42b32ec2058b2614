#include "model/fields/field.h"

#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "model/blocks/study.h"

const field_row *field_find(const field_block *block, const char *name)
{
    for (const field_row *f = block->fields; f->name; f++)
        if (strcmp(f->name, name) == 0)
            return f;
    return NULL;
}

const field_word *field_word_find(const field_word *words, const char *name)
{
    for (const field_word *w = words; w->name; w++)
        if (w->name[0] && strcmp(w->name, name) == 0)
            return w;
    return NULL;
}

const field_word *field_word_of(const field_word *words, int value)
{
    for (const field_word *w = words; w->name; w++)
        if (w->value == value)
            return w;
    return NULL;
}

const char *field_nearest_key(const field_block *block, const char *key)
{
    name_suggestion best = suggestion_begin(key);
    for (const field_row *f = block->fields; f->name; f++)
        suggestion_offer(&best, f->name);
    return best.name;
}

const char *field_nearest_word(const field_word *words, const char *name)
{
    name_suggestion best = suggestion_begin(name);
    for (const field_word *w = words; w->name; w++)
        if (w->name[0])
            suggestion_offer(&best, w->name);
    return best.name;
}

void *field_at(void *base, const field_row *field)
{
    return (char *)base + field->offset;
}

const void *field_at_const(const void *base, const field_row *field)
{
    return (const char *)base + field->offset;
}

int field_switch(const void *base, const field_row *field)
{
    const void *place = (const char *)base + field->other;
    return field->other_is_bool ? *(const bool *)place : *(const int *)place;
}

void field_set_switch(void *base, const field_row *field, int value)
{
    void *place = (char *)base + field->other;
    if (field->other_is_bool)
        *(bool *)place = value != 0;
    else
        *(int *)place = value;
}

int field_form(const field_block *block, const void *base)
{
    int form = 0;
    if (block->form)
        memcpy(&form, (const char *)base + block->form_offset, sizeof form);
    return form;
}

bool field_has_form(const field_row *field, int form)
{
    return field->forms == 0 || (form >= 0 && form < 32 && (field->forms >> form & 1u));
}

static bool is_optional(const field_row *field, int form)
{
    return form >= 0 && form < 32 && (field->optional >> form & 1u);
}

bool field_is_required(const field_row *field, int form)
{
    return field->required && !is_optional(field, form);
}

bool field_is_absent(const field_row *field, const void *base, int form)
{
    int count = 1;
    if (field->counted)
        memcpy(&count, (const char *)base + field->counted, sizeof count);
    return is_optional(field, form) && count == 0;
}

void *field_entry(void *base, const field_row *field, int i)
{
    return (char *)field_at(base, field) + (size_t)i * field->stride;
}

const void *field_entry_const(const void *base, const field_row *field, int i)
{
    return (const char *)field_at_const(base, field) + (size_t)i * field->stride;
}

bool field_marked(const void *base, const field_row *field, int i)
{
    return *((const bool *)field_entry_const(base, field, i) + field->mark);
}

void field_set_mark(void *base, const field_row *field, int i, bool mark)
{
    *((bool *)field_entry(base, field, i) + field->mark) = mark;
}

double *field_clock(void *base, const field_row *field)
{
    bool has = field->kind == FIELD_TABLE && field->table->sources & TABLE_CLOCK;
    return has ? (double *)((char *)base + field->other) : NULL;
}

bool field_is_unit(const double quaternion[4])
{
    double square = 0;
    for (int i = 0; i < 4; i++)
        square += quaternion[i] * quaternion[i];
    return fabs(sqrt(square) - 1) <= 0.01;
}

const table_format *field_table_format(const table_format *format, size_t columns)
{
    while (format && (size_t)format->columns != columns)
        format = format->other;
    return format;
}

static void initialise(const field_row *f, void *base)
{
    if (f->kind == FIELD_BLOCK) {
        field_initialise(f->block, field_at(base, f));
        if (f->words)
            field_set_switch(base, f, f->words[0].value);
    } else if (f->offset == FIELD_NOWHERE) {
        return;
    } else if (f->alternative) {
        initialise(f->alternative, base);
    } else if (f->kind == FIELD_LIMIT) {
        *(double *)field_at(base, f) = f->initial;
    } else if (f->kind == FIELD_NUMBER) {
        for (int i = 0; i < f->count; i++)
            ((double *)field_at(base, f))[i] = f->initials ? f->initials[i] : f->initial;
    } else if (f->kind == FIELD_WORDS) {
        memset(field_at(base, f), 0, sizeof(unsigned));
    } else if (f->kind == FIELD_INTEGER || f->kind == FIELD_CHOICE) {
        int whole = isnan(f->initial) ? 0 : (int)f->initial;
        memcpy(field_at(base, f), &whole, sizeof whole);
    }
}

void field_initialise(const field_block *block, void *base)
{
    for (const field_row *f = block->fields; f->name; f++)
        initialise(f, base);
}

static bool same_block(const field_block *block, const void *a, const void *b)
{
    for (const field_row *f = block->fields; f->name; f++)
        if (!field_same(f, a, b))
            return false;
    return field_form(block, a) == field_form(block, b);
}

static bool same_bytes(const field_row *field, const void *a, const void *b, size_t size)
{
    return memcmp(field_at_const(a, field), field_at_const(b, field), size) == 0;
}

// As many entries, and each the same.
static bool same_entries(const field_row *field, const void *a, const void *b)
{
    int count = field_switch(a, field);
    bool same = count == field_switch(b, field);
    for (int i = 0; i < count && same; i++)
        same = same_block(field->block, field_entry_const(a, field, i),
                          field_entry_const(b, field, i));
    return same;
}

bool field_same(const field_row *field, const void *a, const void *b)
{
    switch (field->kind) {
    case FIELD_NUMBER:
        return field->offset == FIELD_NOWHERE ||
               same_bytes(field, a, b, (size_t)field->count * sizeof(double));
    case FIELD_INTEGER:
    case FIELD_WORDS:
        return same_bytes(field, a, b, sizeof(int));
    case FIELD_WORD:
    case FIELD_QUANTITY:
        return strcmp(field_at_const(a, field), field_at_const(b, field)) == 0;
    case FIELD_CHOICE:
        return same_bytes(field, a, b, sizeof(int)) &&
               (!field->unit || memcmp((const char *)a + field->other,
                                       (const char *)b + field->other, sizeof(double)) == 0);
    case FIELD_BLOCK:
        return (!field->words || field_switch(a, field) == field_switch(b, field)) &&
               same_block(field->block, field_at_const(a, field), field_at_const(b, field));
    case FIELD_LIST:
        return !field->alternative && same_entries(field, a, b);
    default:
        return false;
    }
}

static void release_sweep(ld_sweep_axis *axis, int count)
{
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < axis[i].count; k++)
            free(axis[i].value[k]);
        free(axis[i].value);
    }
    free(axis);
}

void field_release(const field_block *block, void *base)
{
    for (const field_row *f = block->fields; f->name; f++) {
        if (f->kind == FIELD_BLOCK) {
            field_release(f->block, field_at(base, f));
        } else if (f->kind == FIELD_LIST) {
            for (int i = 0; i < field_switch(base, f); i++)
                field_release(f->block, field_entry(base, f, i));
        } else if (f->kind == FIELD_TEXT || f->kind == FIELD_FILE) {
            free(*(char **)field_at(base, f));
        } else if (f->kind == FIELD_LIST) {
            for (int i = 0; i < field_switch(base, f); i++)
                field_release(f->block, (char *)field_at(base, f) + (size_t)i * f->stride);
        } else if (f->kind == FIELD_TABLE) {
            free(((ld_table *)field_at(base, f))->data);
        } else if (f->kind == FIELD_FACTORS) {
            free(*(ld_factor **)field_at(base, f));
        } else if (f->kind == FIELD_CORRELATED) {
            free(*(ld_correlated **)field_at(base, f));
        } else if (f->kind == FIELD_SWEEP) {
            release_sweep(*(ld_sweep_axis **)field_at(base, f), field_switch(base, f));
        }
    }
}

bool field_in_range(field_range range, double value)
{
    return (range.open_low ? value > range.low : value >= range.low) &&
           (range.open_high ? value < range.high : value <= range.high);
}

void field_number_text(double value, char text[32])
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, 32, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            return;
    }
}

void field_range_text(const field_row *field, char *text, size_t size)
{
    bool angle = field->unit && strcmp(field->unit, "rad") == 0;
    double scale = angle ? 180 / 3.14159265358979323846 : 1;
    field_range r = field->range;
    double low = r.low * scale, high = r.high * scale;
    char unit[24] = "";
    if (field->unit && field->unit[0])
        snprintf(unit, sizeof unit, " %s", angle ? "deg" : field->unit);
    text[0] = '\0';
    if (isfinite(low) && isfinite(high) && !r.open_low && !r.open_high)
        snprintf(text, size, "from %.6g to %.6g%s", low, high, unit);
    else if (isfinite(low) && isfinite(high))
        snprintf(text, size, "%s%.6g and %s%.6g%s", r.open_low ? "> " : ">= ", low,
                 r.open_high ? "< " : "<= ", high, unit);
    else if (isfinite(low))
        snprintf(text, size, "%s%.6g%s", r.open_low ? "> " : ">= ", low, unit);
    else if (isfinite(high))
        snprintf(text, size, "%s%.6g%s", r.open_high ? "< " : "<= ", high, unit);
}

// Appends to `text`, cutting at its size.
static void append(char *text, size_t size, const char *more)
{
    size_t length = strlen(text);
    snprintf(text + length, size - length, "%s", more);
}

// Appends the words of a field, after `first`.
static void append_words(const field_row *field, const char *first, char *text, size_t size)
{
    const char *between = first;
    for (const field_word *w = field->words; w->name; w++) {
        if (!w->name[0])
            continue;
        append(text, size, between);
        append(text, size, w->name);
        between = ", ";
    }
}

static const char *unit_name(const char *unit)
{
    return strcmp(unit, "rad") == 0 ? "deg or rad" : unit;
}

static void number_expectation(const field_row *field, char *text, size_t size)
{
    static const char *const many[] = {"", "a number", "two numbers", "three numbers",
                                       "four numbers"};
    if (field->unit[0])
        snprintf(text, size, "%s %s unit of %s", many[field->count],
                 field->count > 1 ? "and one" : "with a", unit_name(field->unit));
    else if (field->count > 1)
        snprintf(text, size, "%s without unit", many[field->count]);
    else
        snprintf(text, size, "a plain number");
    char range[96];
    field_range_text(field, range, sizeof range);
    if (range[0]) {
        append(text, size, ", ");
        append(text, size, range);
    }
}

static void table_expectation(const table_format *table, char *text, size_t size)
{
    static const struct {
        unsigned source;
        const char *text;
    } others[] = {
        {TABLE_CONSTANT, " or one value of the last"},
        {TABLE_CSV, " or the name of a .csv file"},
        {TABLE_ENGINE, " or the name of an .eng file"},
        {TABLE_ROCKSIM, " or that of an .rse file"},
        {TABLE_MESH, " or the name of a .glb file"},
        {TABLE_SOUNDING, " or that of a sounding's .txt file"},
    };
    snprintf(text, size, "rows [");
    for (const table_format *form = table; form; form = form->other) {
        for (int i = 0; i < form->columns; i++) {
            const char *unit = form->column[i].unit;
            append(text, size, i ? ", " : "");
            append(text, size, form->column[i].name);
            append(text, size, unit[0] ? " in " : "");
            append(text, size, unit_name(unit));
        }
        append(text, size, form->other ? "] or [" : "]");
    }
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        append(text, size, table->sources & others[i].source ? others[i].text : "");
}

void field_expectation(const field_row *field, char *text, size_t size)
{
    switch (field->kind) {
    case FIELD_NUMBER:
        number_expectation(field, text, size);
        return;
    case FIELD_INTEGER:
        if (field->range.low < field->range.high)
            snprintf(text, size, "a whole number from %g to %.9g", field->range.low,
                     field->range.high);
        else
            snprintf(text, size, "%g", field->range.low);
        return;
    case FIELD_INTEGERS:
        if (field->least > 0)
            snprintf(text, size, "a list of %d to %d", field->least, field->count);
        else
            snprintf(text, size, "a list of at most %d", field->count);
        append(text, size, " whole numbers ");
        field_range_text(field, text + strlen(text), size - strlen(text));
        return;
    case FIELD_SELECTION:
        snprintf(text, size, "all or a list of names");
        return;
    case FIELD_WORDS:
        text[0] = '\0';
        append_words(field, "all or a list of ", text, size);
        return;
    case FIELD_WORD:
        snprintf(text, size, "a name of letters, digits, - and _ that begins with a letter");
        return;
    case FIELD_QUANTITY:
        snprintf(text, size, "a name of letters, digits, - and _, or several joined by points");
        return;
    case FIELD_TEXT:
        snprintf(text, size, "a text");
        return;
    case FIELD_FILE:
        snprintf(text, size, "the name of a file");
        return;
    case FIELD_CHOICE:
        text[0] = '\0';
        append_words(field, "one of ", text, size);
        for (const field_word *w = field->words; w->name; w++)
            if (!w->name[0]) {
                append(text, size, ", or a number with a unit of ");
                append(text, size, field->unit);
            }
        return;
    case FIELD_BLOCK:
        snprintf(text, size, "a block of keys");
        if (field->words)
            append_words(field, " or ", text, size);
        if (field->block->shared_value)
            append(text, size, " or one value for all");
        return;
    case FIELD_LIST:
        if (field->least == field->count)
            snprintf(text, size, "a list of %d block%s", field->count, field->count > 1 ? "s" : "");
        else
            snprintf(text, size, "a list of %d to %d blocks", field->least, field->count);
        if (field->alternative)
            append(text, size, ", or a block of keys");
        return;
    case FIELD_TABLE:
        table_expectation(field->table, text, size);
        return;
    case FIELD_FACTORS:
        snprintf(text, size, "a block of paths or names, each with its distribution");
        return;
    case FIELD_CORRELATED:
        snprintf(text, size, "a list of blocks, each with the keys factors and matrix");
        return;
    case FIELD_UNTIL:
        snprintf(text, size, "a block of at most %d statistics, each with its half width",
                 field->count);
        return;
    case FIELD_BOUNDS:
        snprintf(text, size, "a block of at most %d paths, each with [from, to] or [from, to, log]",
                 field->count);
        return;
    case FIELD_LIMIT:
        snprintf(text, size, "a number with the unit of the result");
        return;
    case FIELD_SWEEP:
        snprintf(text, size, "a block of paths or names, each with a list of values");
        return;
    }
}
