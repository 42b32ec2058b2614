#include "results/json_text.h"

#include <math.h>

#include "base/printed.h"

void json_write_text(FILE *file, const char *text)
{
    fputc('"', file);
    while (*text) {
        size_t length;
        int32_t code = printed_code(text, &length);
        if (code == '"' || code == '\\')
            fprintf(file, "\\%c", (int)code);
        else if (code == '\n')
            fputs("\\n", file);
        else if (code < 0)
            fputs("\\ufffd", file);
        else if (code < 0x20)
            fprintf(file, "\\u%04x", (unsigned)code);
        else
            fwrite(text, 1, length, file);
        text += length;
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
