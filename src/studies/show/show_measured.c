#include "studies/show/show_measured.h"

#include <math.h>
#include <stdbool.h>

#include "base/printed.h"
#include "studies/show/show_numbers.h"

// p below which two numbers are said to differ.
static const double level = 0.05;

// The tests at a point, and how many of them say so.
typedef struct verdict {
    int tests, differing;
} verdict;

void show_launches(FILE *stream, const char *file, const measured *launches)
{
    fprintf(stream, "measured in %s: %zu launches", VISIBLE(file), launches->count);
    if (launches->salvos)
        fprintf(stream, " of %zu salvos, over which intervals go", launches->salvos);
    for (int i = 0; i < launches->results; i++)
        if (launches->result[i].former[0])
            fprintf(stream, "\n%s is called %s now", launches->result[i].former,
                    launches->result[i].name);
    fputs("\n\n", stream);
}

// p, with a star where it is below the level; counts the test, if it is one.
static void print_chance(FILE *stream, double chance, verdict *of)
{
    bool differs = chance < level;
    of->tests += !isnan(chance);
    of->differing += differs;
    if (chance < 5e-4)
        fputs(" <0.001", stream);
    else
        show_number(stream, 6, chance, chance < 0.1 ? 2 : 3);
    fputs(differs ? " *\n" : "\n", stream);
}

// Two lines: mean and difference of the means, deviation and ratio of the deviations.
static void print_result(FILE *stream, const measured_result *result, const measured_comparison *of,
                         verdict *found)
{
    enum { COLUMN = 22, APART = 30 };
    double to = 1 / result->factor;
    const estimate mean[] = {show_scaled(&of->measured.mean, to),
                             show_scaled(&of->simulated.mean, to), show_scaled(&of->by.mean, to)};
    const estimate deviation[] = {show_scaled(&of->measured.deviation, to),
                                  show_scaled(&of->simulated.deviation, to)};
    show_name(stream, SHOW_NAME, result->name, result->unit);
    fprintf(stream, " %5zu", result->count);
    show_half(stream, COLUMN, &mean[0], 5);
    show_half(stream, COLUMN, &mean[1], 5);
    fputs("  ", stream);
    show_estimate(stream, APART, &mean[2], NAN);
    print_chance(stream, of->by.mean_chance, found);
    fprintf(stream, "%-32s", "    deviation");
    show_half(stream, COLUMN, &deviation[0], 3);
    show_half(stream, COLUMN, &deviation[1], 3);
    fputs(" x", stream);
    show_estimate(stream, APART, &of->by.deviation, NAN);
    print_chance(stream, of->by.deviation_chance, found);
}

ld_status show_measured_result(const measured_result *result, const study_data *data,
                               const study_point *point, study_values *values,
                               measured_comparison *of, ld_error *error)
{
    const char *nearest;
    const study_column *column = study_data_find(data, result->name, &nearest);
    ld_status status = study_data_read(data, point, &column, 1, values, error);
    if (!status && measured_compare(result, values, of))
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the study's statistics");
    return status;
}

static void print_verdict(FILE *stream, const verdict *of)
{
    if (of->tests == 0)
        fputs("\nnothing can be tested: each side requires at least three independent groups\n",
              stream);
    else if (of->differing == 0)
        fprintf(stream, "\nno difference at the 5 %% level, in %d tests\n", of->tests);
    else
        fprintf(stream,
                "\n* different at the 5 %% level: %d of %d tests (where nothing differs, one in "
                "twenty)\n",
                of->differing, of->tests);
}

ld_status show_measured(FILE *stream, const measured *launches, const study_data *data,
                        const study_point *point, study_values *values, ld_error *error)
{
    verdict found = {0};
    ld_status status = LD_OK;
    fprintf(stream, "\n%-26s %5s %-22s %-22s   %-30s %6s\n", "mean", "count", "measured",
            "simulated", "difference, x: ratio", "p");
    for (int i = 0; i < launches->results && !status; i++) {
        measured_comparison of;
        status = show_measured_result(&launches->result[i], data, point, values, &of, error);
        if (!status)
            print_result(stream, &launches->result[i], &of, &found);
    }
    if (!status)
        print_verdict(stream, &found);
    return status;
}
