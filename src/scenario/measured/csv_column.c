#include "scenario/measured/csv_column.h"

#include <stdio.h>
#include <string.h>

#include "scenario/scenario_reader.h"

bool csv_column_read(const char *text, csv_column *column)
{
    int end = 0;
    *column = (csv_column){"", ""};
    sscanf(text, "%95[^][ \t]%n [%31[^]]]%n", column->name, &end, column->unit, &end);
    return column->name[0] && !text[end];
}

bool csv_column_factor(const csv_column *column, const char *target, double *factor, char *why,
                       size_t size)
{
    char unknown[32], quoted[64];
    const char *meant = NULL;
    units_result read = units_factor(column->unit, target, factor, unknown);
    if (read == UNITS_OK)
        return true;
    if (read == UNITS_UNKNOWN)
        meant = units_suggestion(unknown);
    if (!column->unit[0])
        snprintf(why, size, "no unit; expected one of %s in brackets, such as \"%s [%s]\"", target,
                 column->name, target);
    else if (target[0])
        snprintf(why, size, "found the unit %s; expected one of %s%s%s%s",
                 reader_quote(column->unit, quoted), target, meant ? ", did you mean \"" : "",
                 meant ? meant : "", meant ? "\"?" : "");
    else
        snprintf(why, size, "found the unit %s; expected none, or %%",
                 reader_quote(column->unit, quoted));
    return false;
}

bool csv_number(const char *text, double *value, char *why, size_t size)
{
    char quoted[64];
    const char *reason, *end = number_parse(text, value, &reason);
    if (end && *end == '\0')
        return true;
    snprintf(why, size, "found %s%s%s; expected a number, or nothing where there is none",
             reader_quote(text, quoted), reason ? ", " : "", reason ? reason : "");
    return false;
}
