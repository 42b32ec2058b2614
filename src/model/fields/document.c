// The tables of the scenario language as Markdown: a list for each block, a line for each key.
#include "model/fields/field.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

// Prints `text` with the characters escaped that would start a tag, or a quotation in a new line.
static void write_text(FILE *stream, const char *text)
{
    for (; *text; text++)
        fprintf(stream, *text == '<' || *text == '>' ? "\\%c" : "%c", *text);
}

// A range with its unit, "0 to 100 m"; the unit alone where all is allowed.
static void write_range(FILE *stream, const field_row *f)
{
    char range[96];
    field_range_text(f, range, sizeof range);
    if (!range[0])
        snprintf(range, sizeof range, "%s", strcmp(f->unit, "rad") == 0 ? "deg" : f->unit);
    write_text(stream, strncmp(range, "from ", 5) == 0 ? range + 5 : range);
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
        {TABLE_CONSTANT, "; one value"}, {TABLE_CSV, "; `.csv`"},
        {TABLE_ENGINE, "; `.eng`"},      {TABLE_ROCKSIM, "; `.rse`"},
        {TABLE_MESH, "; `.glb`"},        {TABLE_SOUNDING, "; sounding `.txt`"},
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
    else if (f->kind == FIELD_WORD || f->kind == FIELD_QUANTITY)
        fprintf(stream, f->kind == FIELD_WORD ? "name" : "name with points");
    else if (f->kind == FIELD_TEXT || f->kind == FIELD_FILE)
        fprintf(stream, f->kind == FIELD_TEXT ? "text" : "file");
    else if (f->kind == FIELD_BLOCK)
        fprintf(stream, f->block->shared_value ? "block, or one value for all" : "block");
    else if (f->kind == FIELD_LIST)
        fprintf(stream, "%d to %d blocks%s", f->least, f->count,
                f->alternative ? ", or a block" : "");
    else {
        field_expectation(f, text, sizeof text);
        write_text(stream, text);
    }
    if (f->kind == FIELD_BLOCK)
        write_words(stream, f, ", ");
}

// The numbers of a default, in the unit of the range; one number where all are equal.
static void write_numbers(FILE *stream, const field_row *f)
{
    char number[32];
    bool angle = f->unit && strcmp(f->unit, "rad") == 0;
    double scale = angle ? 180 / 3.14159265358979323846 : 1;
    for (int i = 0; i < (f->kind == FIELD_NUMBER && f->initials ? f->count : 1); i++) {
        field_number_text((f->initials ? f->initials[i] : f->initial) * scale, number);
        fprintf(stream, "%s%s", i ? " " : "", number);
    }
}

// " (0)"; nothing of a key that is required in all forms.
static void write_default(FILE *stream, const field_row *f)
{
    if (f->required && !f->optional)
        return;
    fprintf(stream, " (");
    if (f->initial_doc)
        write_text(stream, f->initial_doc);
    else if (f->kind == FIELD_CHOICE)
        write_text(stream, field_word_of(f->words, (int)f->initial)->name);
    else
        write_numbers(stream, f);
    fprintf(stream, ")");
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

// The forms of its block in which a key is allowed, or the one in which it is not, behind the first
// or the second start: "only with `kind: fmu`"; nothing where it is allowed in all.
static void write_forms(FILE *stream, const field_block *block, const field_row *f,
                        const char *const start[2], const char *end)
{
    int has = 0, all = 0;
    for (const field_word *w = block->form; f->forms && w->name; w++)
        if (w->value >= 0) {
            all++;
            has += field_has_form(f, w->value);
        }
    if (has == all)
        return;
    bool negative = has > 1 && has == all - 1, list = false;
    fprintf(stream, "%s with ", start[negative]);
    for (const field_word *w = block->form; w->name; w++) {
        if (w->value < 0 || field_has_form(f, w->value) == negative)
            continue;
        if (!block->form_key)
            fprintf(stream, "%s%s", list ? ", " : "", w->name);
        else
            fprintf(stream, "%s`%s%s%s`", list ? ", " : "", list ? "" : block->form_key,
                    list ? "" : ": ", w->name);
        list = true;
    }
    fputs(end, stream);
}

// How many keys of the block are allowed in the same forms as this one, and whether it is the
// first.
static int count_alike(const field_block *block, const field_row *f, bool *first)
{
    int alike = 0;
    *first = true;
    for (const field_row *g = block->fields; g->name; g++) {
        alike += g->forms == f->forms;
        *first &= g >= f || g->forms != f->forms;
    }
    return alike;
}

enum { OWN_LIST = 3 }; // so many keys of the same forms have a list

static bool has_own_list(const field_block *block, const field_row *f)
{
    bool first;
    return f->forms && count_alike(block, f, &first) >= OWN_LIST;
}

static void write_row(FILE *stream, const field_block *block, const field_row *f)
{
    const char *bold = f->required ? "**" : "";
    fprintf(stream, "- %s`%s`%s [", bold, f->name, bold);
    write_kind(stream, f);
    write_default(stream, f);
    fprintf(stream, "]: ");
    write_text(stream, f->doc);
    if (!has_own_list(block, f))
        write_forms(stream, block, f, (const char *const[]){"; only", "; not"}, "");
    fprintf(stream, "\n");
}

// The keys that are allowed in the forms of `like`; NULL: those without a list of their own.
static void write_keys(FILE *stream, const field_block *block, const field_row *like)
{
    fprintf(stream, "\n");
    for (const field_row *f = block->fields; f->name; f++)
        if (like ? f->forms == like->forms : !has_own_list(block, f))
            write_row(stream, block, f);
}

// The last path of `block` below `root`, whose own path is `path`; `last` stays where there is
// none.
static void find_last_path(const field_block *root, const field_block *block, const char *path,
                           char *last, size_t size)
{
    char below[160];
    for (const field_row *f = root->fields; f->name; f++) {
        if (!f->block || is_repeated(root, f))
            continue;
        path_below(below, sizeof below, f, path);
        if (f->block == block)
            snprintf(last, size, "%s", below);
        find_last_path(f->block, block, below, last, size);
    }
}

// A link to the heading `path`, as sites make its anchor: letters, digits, `_`, and `-` for blanks.
static void write_link(FILE *stream, const char *path)
{
    fprintf(stream, "[`%s`](#", path);
    for (const char *c = path; *c; c++)
        if (isalnum((unsigned char)*c) || *c == '_' || *c == ' ')
            fputc(*c == ' ' ? '-' : tolower((unsigned char)*c), stream);
    fprintf(stream, ")");
}

// The keys of a block stand below the last of its paths; the others refer there.
static void write_block(FILE *stream, const field_block *block, const char *path)
{
    char full_path[160], last[160] = "";
    bool first, rest = false;
    fprintf(stream, "\n### %s\n", path[0] ? path : "The whole file");
    find_last_path(&scenario_block, block, "", last, sizeof last);
    if (last[0] && strcmp(last, path) != 0) {
        fprintf(stream, "\nKeys and blocks of ");
        write_link(stream, last);
        fprintf(stream, ".\n");
        return;
    }
    for (const field_row *f = block->fields; f->name; f++)
        rest |= !has_own_list(block, f);
    if (rest)
        write_keys(stream, block, NULL);
    for (const field_row *f = block->fields; f->name; f++)
        if (f->forms && count_alike(block, f, &first) >= OWN_LIST && first) {
            write_forms(stream, block, f, (const char *const[]){"\nOnly", "\nNot"}, ":\n");
            write_keys(stream, block, f);
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
