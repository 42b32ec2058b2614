// A comparison as tables for a terminal.
#include <math.h>
#include <string.h>

#include "base/printed.h"
#include "compare/comparison.h"

enum { NAME = 20 };

static const char *const verdict_words[] = {"agree", "disagree", "cannot tell"};

static void print_name(FILE *stream, const char *name, const char *unit)
{
    char text[192];
    snprintf(text, sizeof text, "%.95s%s%s%s", name, unit[0] ? " [" : "", unit, unit[0] ? "]" : "");
    fprintf(stream, "%-*s", NAME, VISIBLE(text));
    if (strlen(text) >= NAME)
        fprintf(stream, "\n%*s", NAME, "");
}

static void print_number(FILE *stream, double value)
{
    if (isnan(value))
        fprintf(stream, " %9s", "-");
    else
        fprintf(stream, " %9.4g", value);
}

static void print_uncertainties(FILE *stream, const ld_validation *of, double factor)
{
    const double values[] = {of->u_num, of->u_input, of->u_data, of->u_val};
    for (int i = 0; i < 4; i++)
        print_number(stream, values[i] / factor);
    fprintf(stream, "  %s\n", verdict_words[of->verdict]);
}

static void print_series(FILE *stream, const ld_compared_series *series)
{
    double factor = series->factor;
    print_name(stream, series->name, series->log_unit);
    fprintf(stream, " %6zu", series->count);
    print_number(stream, series->mean / factor);
    print_number(stream, series->of.error / factor);
    print_number(stream, series->largest / factor);
    print_number(stream, series->t_largest);
    print_uncertainties(stream, &series->of, factor);
    if (series->saturated + series->gaps > 0)
        fprintf(stream, "    left out: %zu saturated, %zu missing\n", series->saturated,
                series->gaps);
}

static void print_result(FILE *stream, const ld_compared_result *result)
{
    double factor = result->factor;
    print_name(stream, result->name, result->log_unit);
    fprintf(stream, " %6s", "");
    print_number(stream, result->measured / factor);
    print_number(stream, result->simulated / factor);
    print_number(stream, result->of.error / factor);
    fprintf(stream, "%10s", "");
    print_uncertainties(stream, &result->of, factor);
}

static void print_head(FILE *stream, const char *const *words)
{
    fprintf(stream, "\n%-*s", NAME, words[0]);
    fprintf(stream, " %6s", words[1]);
    for (int i = 2; i < 10; i++)
        fprintf(stream, " %9s", words[i]);
    fputs("  verdict\n", stream);
}

void ld_comparison_print(const ld_comparison *self, FILE *stream)
{
    static const char *const series_head[] = {"series",   "count", "E mean",  "E rms", "|E| max",
                                              "at t [s]", "u_num", "u_input", "u_D",   "u_val"};
    static const char *const result_head[] = {"result", "",      "measured", "simulated", "E",
                                              "",       "u_num", "u_input",  "u_D",       "u_val"};
    const ld_compared_clock *clock = &self->clock;
    fprintf(stream, "clock: time from ignition = time of the log %+.6g s, u = %.2g s%s%s\n",
            clock->offset, clock->uncertainty, clock->found_by ? ", found by " : "",
            clock->found_by ? VISIBLE(clock->found_by) : "");
    if (self->log.sensors > 0)
        print_head(stream, series_head);
    for (int i = 0; i < self->log.sensors; i++)
        print_series(stream, &self->series[i]);
    if (self->log.results > 0)
        print_head(stream, result_head);
    for (int i = 0; i < self->log.results; i++)
        print_result(stream, &self->result[i]);
}
