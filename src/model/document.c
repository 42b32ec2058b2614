// The tables of the scenario language as Markdown.
#include "model/field.h"

#include <string.h>

// Prints `text` with the characters escaped that would end a cell or start a tag.
static void cell(FILE *stream, const char *text)
{
    for (; *text; text++)
        fprintf(stream, *text == '|' || *text == '<' ? "\\%c" : "%c", *text);
}

static void write_kind(FILE *stream, const field_row *f)
{
    char text[FIELD_EXPECTATION];
    field_expectation(f, text, sizeof text);
    cell(stream, text);
    for (int i = 0; f->kind == FIELD_TABLE && i < f->table->columns; i++) {
        field_range_text(&f->table->column[i], text, sizeof text);
        if (text[0])
            fprintf(stream, "; %s %s", f->table->column[i].name, text);
    }
}

static void write_default(FILE *stream, const field_row *f)
{
    char number[32];
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
        field_number_text(f->initials ? f->initials[i] : f->initial, number);
        fprintf(stream, "%s%s", i ? " " : "", number);
    }
    if (f->unit && f->unit[0])
        fprintf(stream, " %s", f->unit);
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
        const char *between = "; goes with ";
        for (const field_word *w = block->form; f->forms && w->name; w++) {
            if (w->value < 0 || !field_has_form(f, w->value))
                continue;
            if (!block->form_key)
                fprintf(stream, "%s%s", between, w->name);
            else
                fprintf(stream, "%s`%s: %s`", between, block->form_key, w->name);
            between = " or ";
        }
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
