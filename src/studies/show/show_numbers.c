#include "studies/show/show_numbers.h"

#include <string.h>

#include "base/printed.h"
#include "math/functions.h"
#include "quantities/study_results.h"

int show_digits(double value, double spread, int least)
{
    if (!(fabs(value) > 0) || !(spread > 0) || !isfinite(value) || !isfinite(spread))
        return least;
    double digits = floor(log10(fabs(value))) - floor(log10(spread)) + 2;
    return (int)fmin(fmax(digits, least), 12);
}

void show_name(FILE *stream, int width, const char *result, const char *unit)
{
    char name[192];
    snprintf(name, sizeof name, "%s%s%s%s", result, unit[0] ? " [" : "", unit, unit[0] ? "]" : "");
    fprintf(stream, "%-*s", width, VISIBLE(name));
}

int show_name_width(const study_column *const *column, int count)
{
    size_t width = SHOW_NAME;
    for (int i = 0; i < count; i++) {
        size_t unit = strlen(study_result_unit(column[i]->name, column[i]->unit).name);
        size_t own = strlen(column[i]->name) + unit + 3 * !!unit;
        width = own > width && own < 64 ? own : width;
    }
    return (int)width;
}

void show_result(FILE *stream, int width, const study_column *column)
{
    show_name(stream, width, column->name, study_result_unit(column->name, column->unit).name);
}

estimate show_scaled(const estimate *e, double factor)
{
    return (estimate){e->value * factor, e->low * factor, e->high * factor};
}

group_statistics show_in_unit(const group_statistics *of, const study_column *column)
{
    const double factor = study_result_unit(column->name, column->unit).factor;
    group_statistics shown = *of;
    shown.mean = show_scaled(&of->mean, factor);
    shown.deviation = show_scaled(&of->deviation, factor);
    for (int k = 0; k < STATISTICS_QUANTILES; k++)
        shown.quantile[k] = show_scaled(&of->quantile[k], factor);
    shown.least = of->least * factor;
    shown.greatest = of->greatest * factor;
    return shown;
}

void show_text(char text[32], double value, int digits)
{
    if (isnan(value))
        strcpy(text, "-");
    else
        snprintf(text, 32, "%.*g", digits, value + 0.0);
}

void show_number(FILE *stream, int width, double value, int digits)
{
    char text[32];
    show_text(text, value, digits);
    fprintf(stream, " %*s", width, text);
}

void show_half(FILE *stream, int width, const estimate *e, int least)
{
    char text[64], value[32];
    double half = 0.5 * (e->high - e->low);
    int digits = show_digits(e->value, half, least), length;
    do {
        show_text(value, e->value, digits);
        length = snprintf(text, sizeof text, isfinite(half) ? "%s +- %.2g" : "%s", value, half);
    } while (length > width && digits-- > least);
    fprintf(stream, " %-*s", width, text);
}

void show_estimate(FILE *stream, int width, const estimate *e, double spread)
{
    enum { ROOM = 31 }; // of what ends a line
    char text[128], value[32], low[32], high[32];
    double largest = fmax(fabs(e->value), fmax(fabs(e->low), fabs(e->high)));
    int digits = show_digits(largest, spread, 4), length;
    do {
        show_text(value, e->value, digits);
        show_text(low, e->low, digits);
        show_text(high, e->high, digits);
        length =
            snprintf(text, sizeof text, isnan(e->low) ? "%s" : "%s [%s, %s]", value, low, high);
    } while (length > (width ? width : ROOM) && digits-- > 4);
    fprintf(stream, " %-*s", width, text);
}
