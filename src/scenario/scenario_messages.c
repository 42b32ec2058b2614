#include "base/printed.h"
#include "scenario/scenario_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void free_message(ld_message *message)
{
    free(message->file);
    free(message->path);
    free(message->text);
    free(message->source);
}

void ld_messages_free(ld_messages *messages)
{
    for (size_t i = 0; i < messages->count; i++)
        free_message(&messages->item[i]);
    free(messages->item);
    *messages = (ld_messages){0};
}

// Prints the part of the source line around the column, and a caret below it. Columns count
// characters; tabs stay tabs, and stand below themselves.
static void print_excerpt(const ld_message *m, FILE *stream)
{
    enum { BEFORE = 80, WIDTH = 120 };
    char shown[5], below[16 * BEFORE + 1] = "";
    int from = m->column > BEFORE ? m->column - BEFORE : 1, column = 1;
    fprintf(stream, "    ");
    for (const char *c = m->source; *c && column < from + WIDTH;) {
        bool tab = *c == '\t', plain = *c == '\\';
        c += printed_character(c, shown);
        int width = shown[0] == '\\' && !plain && !tab ? (int)strlen(shown) : 1;
        if (column >= from)
            fputs(tab ? "\t" : shown, stream);
        if (column >= from && column < m->column)
            snprintf(below + strlen(below), sizeof below - strlen(below), "%*s", width,
                     tab ? "\t" : " ");
        column += (*c & 0xc0) != 0x80; // of a character that is shown byte by byte, after its last
    }
    fprintf(stream, "\n    %s^\n", below);
}

// Prints each as what it is: an error, a warning.
static void print_as(const ld_messages *messages, const char *kind, FILE *stream)
{
    for (size_t i = 0; i < messages->count; i++) {
        const ld_message *m = &messages->item[i];
        fprintf(stream, "%s:", VISIBLE(m->file));
        if (m->line > 0)
            fprintf(stream, "%d:%d:", m->line, m->column);
        fprintf(stream, " %s: %s%s%s\n", kind, VISIBLE(m->path), m->path[0] ? ": " : "",
                VISIBLE(m->text));
        if (m->source[0])
            print_excerpt(m, stream);
    }
}

void ld_messages_print(const ld_messages *messages, FILE *stream)
{
    print_as(messages, "error", stream);
}

void ld_notes_print(const ld_messages *notes, FILE *stream)
{
    print_as(notes, "warning", stream);
}

// The line of the source's text that holds `place`.
static char *source_line(text_place place)
{
    const text_source *source = place.source;
    if (place.line == 0)
        return strdup("");
    const char *text = source->text, *end = text + source->length;
    for (int line = source->first_line; line < place.line && text < end; text++)
        line += *text == '\n';
    size_t length = 0;
    while (text + length < end && text[length] != '\n' && text[length] != '\r' && text[length])
        length++;
    return strndup(text, length);
}

void reader_refuse(scenario_reader *reader, text_place place, const char *path, const char *format,
                   ...)
{
    char text[768];
    ld_messages *messages = reader->messages;
    if (messages->count == READER_MAX_MESSAGES) {
        reader->cut = true;
        return;
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ld_message *larger = realloc(messages->item, (messages->count + 1) * sizeof *larger);
    if (!larger) {
        reader->no_memory = true;
        return;
    }
    messages->item = larger;
    ld_message m = {
        strdup(place.source->name), place.line, place.column, strdup(path), strdup(text),
        source_line(place)};
    messages->item[messages->count++] = m;
    if (!m.file || !m.path || !m.text || !m.source)
        reader->no_memory = true;
}

void reader_refuse_key(scenario_reader *reader, text_place place, const char *path,
                       const char *meant, const char *allowed)
{
    if (meant)
        reader_refuse(reader, place, path, "unknown key, did you mean \"%s\"?", meant);
    else
        reader_refuse(reader, place, path, "unknown key; allowed here: %s", allowed);
}

bool reader_check_keys(scenario_reader *reader, const tree_node *map, const char *path,
                       const char *const *names, size_t count)
{
    char allowed[256] = "", key_path[READER_MAX_PATH];
    bool good = true;
    for (size_t i = 0, used = 0; i < count && used < sizeof allowed; i++)
        used += (size_t)snprintf(allowed + used, sizeof allowed - used, "%s%s", i ? ", " : "",
                                 names[i]);
    for (const tree_node *member = map->first; member; member = member->next) {
        size_t i = 0;
        while (i < count && strcmp(names[i], member->key) != 0)
            i++;
        if (i < count)
            continue;
        snprintf(key_path, sizeof key_path, "%s.%s", path, member->key);
        reader_refuse_key(reader, member->key_at, key_path,
                          ld_nearest_name(member->key, names, count), allowed);
        good = false;
    }
    return good;
}

void reader_refuse_word(scenario_reader *reader, text_place place, const char *path,
                        const char *word, const char *meant, const char *expected)
{
    char quoted[64];
    reader_quote(word, quoted);
    if (meant)
        reader_refuse(reader, place, path, "found %s, did you mean \"%s\"? expected %s", quoted,
                      meant, expected);
    else
        reader_refuse(reader, place, path, "found %s; expected %s", quoted, expected);
}

static int in_order_of_text(const void *left, const void *right)
{
    const ld_message *a = left, *b = right;
    int files = strcmp(a->file, b->file);
    if (files)
        return files;
    if (a->line != b->line)
        return a->line < b->line ? -1 : 1;
    if (a->column != b->column)
        return a->column < b->column ? -1 : 1;
    int paths = strcmp(a->path, b->path);
    return paths ? paths : strcmp(a->text, b->text);
}

void reader_finish_messages(scenario_reader *reader)
{
    ld_messages *messages = reader->messages;
    if (!reader->no_memory && messages->count > 1)
        qsort(messages->item, messages->count, sizeof *messages->item, in_order_of_text);
    if (!reader->cut)
        return;
    // the last one kept makes room
    ld_message *last = &messages->item[messages->count - 1];
    free(last->text);
    last->text = strdup("more errors of this kind are not shown");
    reader->no_memory = reader->no_memory || !last->text;
}

// Whether the path `inner` is `outer` or a key below it.
static bool is_at_or_below(const char *inner, const char *outer)
{
    size_t length = strlen(outer);
    return length > 0 && strncmp(inner, outer, length) == 0 &&
           (inner[length] == '\0' || inner[length] == '.');
}

bool reader_has_refused(const scenario_reader *reader, size_t count, const char *path)
{
    for (size_t i = 0; i < count; i++) {
        const char *other = reader->messages->item[i].path;
        if (other && (is_at_or_below(other, path) || is_at_or_below(path, other)))
            return true;
    }
    return false;
}

static bool is_same(const ld_message *a, const ld_message *b)
{
    return a->line == b->line && a->column == b->column && strcmp(a->file, b->file) == 0 &&
           strcmp(a->path, b->path) == 0 && strcmp(a->text, b->text) == 0;
}

static bool is_about(const ld_message *message, const ld_together *keys)
{
    bool about = false;
    for (int i = 0; i < keys->count; i++)
        about |= is_at_or_below(message->path, keys->path[i]) ||
                 is_at_or_below(keys->path[i], message->path);
    return about;
}

void reader_keep_messages(scenario_reader *reader, size_t count, const ld_together *keys)
{
    ld_messages *messages = reader->messages;
    size_t kept = count;
    for (size_t i = count; i < messages->count && !reader->no_memory; i++) {
        ld_message *m = &messages->item[i];
        bool wanted = !keys || is_about(m, keys);
        for (size_t k = 0; wanted && k < kept; k++)
            wanted = !is_same(m, &messages->item[k]);
        if (wanted)
            messages->item[kept++] = *m;
        else
            free_message(m);
    }
    if (!reader->no_memory)
        messages->count = kept;
}

const char *reader_quote(const char *text, char buffer[64])
{
    enum { LONGEST = 40 };
    size_t n = 0;
    buffer[n++] = '"';
    const char *c = text;
    for (; *c && n < LONGEST; c++)
        buffer[n++] = *c;
    // no half of a UTF-8 character at the cut
    while (*c && n > 1 && ((unsigned char)*c & 0xc0) == 0x80) {
        c--;
        n--;
    }
    snprintf(buffer + n, 64 - n, "%s\"", *c ? "..." : "");
    return buffer;
}
