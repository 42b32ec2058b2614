// The tables of the scenario language as Markdown.
#include "model/field.h"

#include <string.h>

// Prints `text` with the characters escaped that would end a cell or start emphasis.
static void cell(FILE *stream, const char *text)
{
    for (; *text; text++)
        fprintf(stream, *text == '|' || *text == '<' || *text == '_' ? "\\%c" : "%c", *text);
}

static void write_kind(FILE *stream, const field_row *f)
{
    char text[256];
    if (f->kind == FIELD_LATER) {
        fprintf(stream, "not simulated yet");
        return;
    }
    if (f->kind == FIELD_INTEGER && f->range.low == f->range.high)
        snprintf(text, sizeof text, "%g", f->range.low);
    else
        field_expectation(f, text, sizeof text);
    cell(stream, text);
}

static void write_default(FILE *stream, const field_row *f)
{
    char text[64], number[32];
    if (f->required || f->kind == FIELD_LATER) {
        fprintf(stream, f->required ? "required" : "");
        return;
    }
    if (f->initial_doc) {
        cell(stream, f->initial_doc);
        return;
    }
    field_number_text(f->initial, number);
    snprintf(text, sizeof text, "%s%s%s", number, f->unit && f->unit[0] ? " " : "",
             f->unit ? f->unit : "");
    if (f->kind == FIELD_CHOICE)
        snprintf(text, sizeof text, "%s", field_word_of(f->words, (int)f->initial)->name);
    cell(stream, text);
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
            fprintf(stream, "%s%s%s", between, block->form_from_keys ? "" : "`kind: ", w->name);
            fprintf(stream, block->form_from_keys ? "" : "`");
            between = " or ";
        }
        fprintf(stream, " |\n");
    }
    for (const field_row *f = block->fields; f->name; f++) {
        if (!f->block)
            continue;
        snprintf(full_path, sizeof full_path, "%s%s%s%s", path, path[0] ? "." : "", f->name,
                 f->kind == FIELD_LIST ? ".N" : "");
        write_block(stream, f->block, full_path);
    }
}

void field_write_markdown(FILE *stream)
{
    write_block(stream, &scenario_block, "");
}
