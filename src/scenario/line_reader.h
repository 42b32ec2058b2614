// The lines of a table's file, and where what is wrong with them is reported.
#ifndef LD_SCENARIO_LINE_READER_H
#define LD_SCENARIO_LINE_READER_H

#include "base/text_lines.h"
#include "scenario/scenario_reader.h"

typedef struct line_reader {
    scenario_reader *reader;
    const char *path; // of the key that names the file
    const text_source *source;
    text_lines at; // the line at hand
    bool failed;
    bool sounding; // they are those of one
    double *clock; // origin of the times in the first column, or NULL
} line_reader;

// Refuses what stands in a field of the line at hand, from 0; 0 where it has none: the line.
void line_refuse(line_reader *lines, int field, const char *text);
// Refuses what stands at a place of the text, both from 1.
void line_refuse_at(line_reader *lines, int line, int column, const char *text);

// The next line that is neither blank nor a comment, its fields cut at blanks or at commas.
bool line_next(line_reader *lines, char comment, bool commas);

// The number in a field; false after a message.
bool line_number(line_reader *lines, int field, double *value);

// Whether the line at hand has as many fields as a line above, its header; false after a message.
bool line_is_as_long(line_reader *lines, int fields);

// Appends a row to a table; false: there is no memory.
bool line_append(line_reader *lines, ld_table *table, size_t columns, const double *row);

#endif
