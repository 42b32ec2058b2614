// Lines of a text one after the other, each cut into fields.
#ifndef LD_BASE_TEXT_LINES_H
#define LD_BASE_TEXT_LINES_H

#include <stdbool.h>
#include <stddef.h>

enum { TEXT_LINES_FIELDS = 128, TEXT_LINES_LENGTH = 4096 };

typedef struct text_lines {
    const char *next, *end;       // what is still to come
    int number;                   // of the line at hand, from 1
    char text[TEXT_LINES_LENGTH]; // of the line at hand, cut into fields
    int count;
    const char *field[TEXT_LINES_FIELDS];
    int column[TEXT_LINES_FIELDS]; // from 1, where a field begins
    const char *wrong;             // what is wrong with the line at hand, or NULL
} text_lines;

// From the beginning, behind a byte order mark.
text_lines text_lines_begin(const char *text, size_t length);

// The next line that is neither blank nor begins with the sign of a comment, its fields cut at
// blanks or at commas and trimmed. The comment of a ';' begins anywhere in a line. False at the
// end, and where the line is not text, too long, has too many fields, or semicolons where commas
// are expected: then `wrong` is a sentence, and no line comes any more.
bool text_lines_next(text_lines *lines, char comment, bool commas);

// Where a field of the line at hand begins, from 1; 1 where the line has none of that number.
int text_lines_column(const text_lines *lines, int field);

#endif
