#include "quantities/summary.h"

#include <stdarg.h>
#include <stdio.h>

void summary_note(ld_summary *summary, const char *format, ...)
{
    int capacity = (int)(sizeof summary->note / sizeof summary->note[0]);
    if (summary->note_count == capacity)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(summary->note[summary->note_count++], sizeof summary->note[0], format, arguments);
    va_end(arguments);
}
