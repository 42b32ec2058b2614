#include "results/json_text.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

// Length of the UTF-8 sequence at `text` (2 to 4), 0 where it is not a valid one.
static size_t utf8_length(const unsigned char *text)
{
    size_t length = text[0] >= 0xC2 && text[0] < 0xE0   ? 2
                    : text[0] >= 0xE0 && text[0] < 0xF0 ? 3
                    : text[0] >= 0xF0 && text[0] < 0xF5 ? 4
                                                        : 0;
    for (size_t i = 1; i < length; i++)
        if ((text[i] & 0xC0) != 0x80)
            return 0;
    bool wrong = (text[0] == 0xE0 && text[1] < 0xA0) || (text[0] == 0xED && text[1] > 0x9F) ||
                 (text[0] == 0xF0 && text[1] < 0x90) || (text[0] == 0xF4 && text[1] > 0x8F);
    return wrong ? 0 : length;
}

void json_write_text(FILE *file, const char *text)
{
    fputc('"', file);
    for (const unsigned char *letter = (const unsigned char *)text; *letter;) {
        size_t length = *letter < 0x80 ? 1 : utf8_length(letter);
        if (*letter == '"' || *letter == '\\')
            fprintf(file, "\\%c", *letter);
        else if (*letter == '\n')
            fputs("\\n", file);
        else if (*letter < 0x20)
            fprintf(file, "\\u%04x", *letter);
        else if (length == 0)
            fputs("\\ufffd", file);
        else
            fwrite(letter, 1, length, file);
        letter += length ? length : 1;
    }
    fputc('"', file);
}

void json_write_number(FILE *file, double value)
{
    if (isfinite(value))
        fprintf(file, "%.17g", value);
    else
        fputs("null", file);
}
