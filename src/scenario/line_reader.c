#include "scenario/line_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void line_refuse_at(line_reader *lines, int line, int column, const char *text)
{
    reader_refuse(lines->reader, (text_place){lines->source, line, column}, lines->path, "%s",
                  text);
    lines->failed = true;
}

void line_refuse(line_reader *lines, int field, const char *text)
{
    line_refuse_at(lines, lines->at.number, text_lines_column(&lines->at, field), text);
}

bool line_next(line_reader *lines, char comment, bool commas)
{
    bool there = !lines->failed && text_lines_next(&lines->at, comment, commas);
    if (!there && !lines->failed && lines->at.wrong)
        line_refuse(lines, 0, lines->at.wrong);
    return there;
}

bool line_number(line_reader *lines, int field, double *value)
{
    const char *reason, *end = number_parse(lines->at.field[field], value, &reason);
    char text[160], quoted[64];
    if (end && *end == '\0')
        return true;
    snprintf(text, sizeof text, "found %s%s%s; expected a number",
             reader_quote(lines->at.field[field], quoted), reason ? ", " : "",
             reason ? reason : "");
    line_refuse(lines, field, text);
    return false;
}

bool line_is_as_long(line_reader *lines, int fields)
{
    char text[128];
    if (lines->at.count == fields)
        return true;
    snprintf(text, sizeof text,
             "found %d fields; expected %d, as in the header (decimals are written with a point)",
             lines->at.count, fields);
    line_refuse(lines, 0, text);
    return false;
}

bool line_append(line_reader *lines, ld_table *table, size_t columns, const double *row)
{
    // room is doubled at each power of two
    if ((table->rows & (table->rows - 1)) == 0) {
        size_t room = table->rows ? 2 * table->rows : 1;
        double *larger = realloc(table->data, room * columns * sizeof *larger);
        if (!larger) {
            lines->reader->no_memory = lines->failed = true;
            return false;
        }
        table->data = larger;
    }
    memcpy(table->data + table->rows * columns, row, columns * sizeof *row);
    table->rows++;
    table->columns = columns;
    return true;
}
