// The tables of the scenario language as Markdown.
#include "model/fields/field.h"

#include <math.h>
#include <string.h>

// Prints `text` with the characters escaped that would end a cell or start a tag.
static void cell(FILE *stream, const char *text)
{
    for (; *text; text++)
        fprintf(stream, *text == '|' || *text == '<' ? "\\%c" : "%c", *text);
}

// A range with its unit, "0 to 100 m"; the unit alone where all is allowed.
static void write_range(FILE *stream, const field_row *f)
{
    char range[96];
    field_range_text(f, range, sizeof range);
    if (!range[0])
        snprintf(range, sizeof range, "%s", strcmp(f->unit, "rad") == 0 ? "deg" : f->unit);
    cell(stream, strncmp(range, "from ", 5) == 0 ? range + 5 : range);
}

static void write_number(FILE *stream, const field_row *f)
{
    static const char *const many[] = {"", "", "two: ", "three: ", "four: "};
    fprintf(stream, "%s", many[f->count]);
    bool any = f->unit[0] == '\0' && isinf(f->range.low) && isinf(f->range.high);
    if (any)
        fprintf(stream, "a number");
    else
        write_range(stream, f);
}

// The columns of a table with their units and ranges; of another form those that differ.
static void write_columns(FILE *stream, const table_format *table)
{
    int first = 0;
    for (const table_format *form = table; form; form = form->other) {
        fprintf(stream, form == table ? "rows of " : "; or ..., ");
        for (int i = first; i < form->columns; i++) {
            const field_row *column = &form->column[i];
            bool bare = !column->unit[0] && isinf(column->range.low) && isinf(column->range.high);
            fprintf(stream, "%s%s%s", i > first ? ", " : "", column->name, bare ? "" : " (");
            if (!bare)
                write_range(stream, column);
            fprintf(stream, bare ? "" : ")");
        }
        for (first = 0; form->other && first < form->columns; first++)
            if (strcmp(form->column[first].name, form->other->column[first].name) != 0)
                break;
    }
}

static void write_table(FILE *stream, const table_format *table)
{
    static const struct {
        unsigned source;
        const char *text;
    } others[] = {
        {TABLE_CONSTANT, "; one value"},
        {TABLE_CSV, "; `.csv`"},
        {TABLE_ENGINE, "; `.eng`"},
        {TABLE_ROCKSIM, "; `.rse`"},
        {TABLE_SOUNDING, "; sounding `.txt`"},
    };
    write_columns(stream, table);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        fprintf(stream, "%s", table->sources & others[i].source ? others[i].text : "");
}

static void write_words(FILE *stream, const field_row *f, const char *between)
{
    for (const field_word *w = f->words; w && w->name; w++)
        if (w->name[0]) {
            fprintf(stream, "%s`%s`", between, w->name);
            between = ", ";
        } else if (f->kind == FIELD_CHOICE) {
            fprintf(stream, "%s", between);
            write_range(stream, f);
            between = ", ";
        }
}

static void write_kind(FILE *stream, const field_row *f)
{
    char text[FIELD_EXPECTATION];
    if (f->kind == FIELD_NUMBER)
        write_number(stream, f);
    else if (f->kind == FIELD_TABLE)
        write_table(stream, f->table);
    else if (f->kind == FIELD_CHOICE)
        write_words(stream, f, "");
    else if (f->kind == FIELD_INTEGER && f->range.low < f->range.high)
        fprintf(stream, "whole, %g to %.9g", f->range.low, f->range.high);
    else if (f->kind == FIELD_WORD)
        fprintf(stream, "name");
    else if (f->kind == FIELD_TEXT || f->kind == FIELD_FILE)
        fprintf(stream, f->kind == FIELD_TEXT ? "text" : "file");
    else if (f->kind == FIELD_BLOCK)
        fprintf(stream, f->block->shared_value ? "block, or one value for all" : "block");
    else if (f->kind == FIELD_LIST)
        fprintf(stream, "%d to %d blocks%s", f->least, f->count,
                f->alternative ? ", or a block" : "");
    else {
        field_expectation(f, text, sizeof text);
        cell(stream, text);
    }
    if (f->kind == FIELD_BLOCK)
        write_words(stream, f, ", ");
}

static void write_default(FILE *stream, const field_row *f)
{
    char number[32];
    bool angle = f->unit && strcmp(f->unit, "rad") == 0;
    double scale = angle ? 180 / 3.14159265358979323846 : 1;
    if (f->required) {
        fprintf(stream, "required");
        if (f->optional)
            fprintf(stream, "; %s", f->initial_doc);
        return;
    }
    if (f->initial_doc) {
        cell(stream, f->initial_doc);
        return;
    }
    if (f->kind == FIELD_CHOICE) {
        cell(stream, field_word_of(f->words, (int)f->initial)->name);
        return;
    }
    for (int i = 0; i < (f->kind == FIELD_NUMBER ? f->count : 1); i++) {
        field_number_text((f->initials ? f->initials[i] : f->initial) * scale, number);
        fprintf(stream, "%s%s", i ? " " : "", number);
    }
    if (f->unit && f->unit[0])
        fprintf(stream, " %s", angle ? "deg" : f->unit);
}

// Whether an earlier key of the block has the same keys below it.
static bool is_repeated(const field_block *block, const field_row *f)
{
    for (const field_row *g = block->fields; g < f; g++)
        if (g->block == f->block)
            return true;
    return false;
}

// The path of the block below `f`, with its likes in the same block: "motion.surge.N, heave.N".
static void path_below(char *text, size_t size, const field_row *f, const char *path)
{
    const char *entry = f->kind == FIELD_LIST ? ".N" : "";
    snprintf(text, size, "%s%s%s%s", path, path[0] ? "." : "", f->name, entry);
    for (const field_row *g = f + 1; g->name; g++)
        if (g->block == f->block) {
            size_t length = strlen(text);
            snprintf(text + length, size - length, ", %s%s", g->name, entry);
        }
}

// The forms of its block that a key goes with, or the one that it does not go with.
static void write_forms(FILE *stream, const field_block *block, const field_row *f)
{
    int has = 0, all = 0;
    for (const field_word *w = block->form; f->forms && w->name; w++)
        if (w->value >= 0) {
            all++;
            has += field_has_form(f, w->value);
        }
    bool negative = has > 1 && has == all - 1;
    const char *between = negative ? "; not with " : "; only with ";
    bool list = false;
    for (const field_word *w = block->form; has < all && w->name; w++) {
        if (w->value < 0 || field_has_form(f, w->value) == negative)
            continue;
        if (!block->form_key)
            fprintf(stream, "%s%s", between, w->name);
        else
            fprintf(stream, "%s`%s%s%s`", between, list ? "" : block->form_key, list ? "" : ": ",
                    w->name);
        between = ", ";
        list = true;
    }
}

static void write_block(FILE *stream, const field_block *block, const char *path)
{
    char full_path[160];
    fprintf(stream, "\n### %s\n\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n",
            path[0] ? path : "The whole file");
    for (const field_row *f = block->fields; f->name; f++) {
        fprintf(stream, "| `%s` | ", f->name);
        write_kind(stream, f);
        fprintf(stream, " | ");
        write_default(stream, f);
        fprintf(stream, " | ");
        cell(stream, f->doc);
        write_forms(stream, block, f);
        fprintf(stream, " |\n");
    }
    for (const field_row *f = block->fields; f->name; f++) {
        if (!f->block || is_repeated(block, f))
            continue;
        path_below(full_path, sizeof full_path, f, path);
        write_block(stream, f->block, full_path);
        if (f->alternative)
            write_block(stream, f->alternative->block, f->alternative->name);
    }
}

void field_write_markdown(FILE *stream)
{
    write_block(stream, &scenario_block, "");
}
