#include "base/text_lines.h"

#include <string.h>

static const char blanks[] = " \t\r";

text_lines text_lines_begin(const char *text, size_t length)
{
    static const char mark[] = "\xef\xbb\xbf"; // a byte order mark, which some programs write
    size_t marked = length >= 3 && memcmp(text, mark, 3) == 0 ? 3 : 0;
    return (text_lines){.next = text + marked, .end = text + length};
}

static bool refuse(text_lines *lines, const char *sentence)
{
    lines->wrong = sentence;
    lines->next = lines->end;
    return false;
}

// Copies the next line; false at the end.
static bool read_line(text_lines *lines)
{
    lines->count = 0;
    if (lines->next >= lines->end)
        return false;
    const char *stop = memchr(lines->next, '\n', (size_t)(lines->end - lines->next));
    size_t length = (size_t)((stop ? stop : lines->end) - lines->next);
    lines->number++;
    if (length >= TEXT_LINES_LENGTH || memchr(lines->next, '\0', length))
        return refuse(lines, "this line is not text, or is too long");
    memcpy(lines->text, lines->next, length);
    lines->text[length] = '\0';
    lines->next += length + (stop ? 1 : 0);
    return true;
}

static char *trim(char *text)
{
    text += strspn(text, blanks);
    size_t length = strlen(text);
    while (length > 0 && strchr(blanks, text[length - 1]))
        text[--length] = '\0';
    return text;
}

static bool cut(text_lines *lines, bool commas)
{
    if (commas && strchr(lines->text, ';'))
        return refuse(lines, "semicolons between fields; expected commas, and points in decimals");
    const char *between = commas ? "," : blanks;
    for (char *part = trim(lines->text); part;) {
        char *end = part + strcspn(part, between);
        char *rest = *end ? end + 1 : NULL;
        *end = '\0';
        char *field = trim(part);
        if (commas || *field) {
            if (lines->count == TEXT_LINES_FIELDS)
                return refuse(lines, "this line has too many fields");
            lines->column[lines->count] = (int)(field - lines->text) + 1;
            lines->field[lines->count++] = field;
        }
        part = rest;
    }
    return true;
}

bool text_lines_next(text_lines *lines, char comment, bool commas)
{
    while (read_line(lines)) {
        if (comment == ';')
            lines->text[strcspn(lines->text, ";")] = '\0';
        char first = lines->text[strspn(lines->text, blanks)];
        if (first != comment && first != '\0')
            return cut(lines, commas);
    }
    return false;
}

int text_lines_column(const text_lines *lines, int field)
{
    return field < lines->count ? lines->column[field] : 1;
}
