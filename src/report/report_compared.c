// What a run was compared with, as JSON: series and numbers in the units of the log.
#include <stdbool.h>

#include "report/report_parts.h"
#include "results/json_text.h"

enum { MOST_ROWS = 3000 };

static const char *const verdicts[] = {"agree", "disagree", "cannot tell"};

// Whether row i stays: of many rows those with the least and the greatest value measured in each
// of MOST_ROWS/2 parts.
static bool keeps(const ld_compared_series *series, size_t i)
{
    if (series->count <= MOST_ROWS)
        return true;
    size_t part = 2 * series->count / MOST_ROWS + 1, first = i - i % part;
    size_t least = first, greatest = first;
    for (size_t k = first; k < first + part && k < series->count; k++) {
        if (series->measured[k] < series->measured[least])
            least = k;
        if (series->measured[k] > series->measured[greatest])
            greatest = k;
    }
    return i == least || i == greatest;
}

static void write_array(FILE *json, const char *name, const ld_compared_series *series,
                        const double *value, double factor)
{
    bool any = false;
    fprintf(json, ",\"%s\":[", name);
    for (size_t i = 0; i < series->count; i++)
        if (keeps(series, i)) {
            fprintf(json, "%s%.7g", any ? "," : "", value[i] / factor);
            any = true;
        }
    fputc(']', json);
}

static void write_texts(FILE *json, const char *name, const char *unit, const ld_validation *of)
{
    fputs("{\"name\":", json);
    json_write_text(json, name);
    fputs(",\"unit\":", json);
    json_write_text(json, unit);
    fprintf(json, ",\"verdict\":\"%s\"", verdicts[of->verdict]);
}

static void write_member(FILE *json, const char *name, double value)
{
    fprintf(json, ",\"%s\":", name);
    json_write_number(json, value);
}

static void write_series(FILE *json, const ld_compared_series *series)
{
    write_texts(json, series->name, series->log_unit, &series->of);
    write_member(json, "error", series->of.error / series->factor);
    write_member(json, "uVal", series->of.u_val / series->factor);
    fputs(",\"column\":", json);
    json_write_text(json, series->column);
    write_member(json, "factor", series->factor);
    fprintf(json, ",\"count\":%zu,\"saturated\":%zu,\"gaps\":%zu", series->count, series->saturated,
            series->gaps);
    write_array(json, "t", series, series->t, 1);
    write_array(json, "measured", series, series->measured, series->factor);
    write_array(json, "simulated", series, series->simulated, series->factor);
    write_array(json, "u", series, series->u_val, series->factor);
    fputc('}', json);
}

static void write_result(FILE *json, const ld_compared_result *result)
{
    write_texts(json, result->name, result->log_unit, &result->of);
    write_member(json, "error", result->of.error / result->factor);
    write_member(json, "uVal", result->of.u_val / result->factor);
    write_member(json, "measured", result->measured / result->factor);
    write_member(json, "simulated", result->simulated / result->factor);
    fputc('}', json);
}

void report_write_compared(FILE *json, const report_source *source)
{
    const ld_comparison *comparison = source->comparison;
    const ld_compared_series *series;
    const ld_compared_result *result;
    if (!comparison) {
        fputs("null", json);
        return;
    }
    fputs("{\"log\":", json);
    json_write_text(json, source->log);
    fputs(",\"series\":[", json);
    for (int i = 0; (series = ld_comparison_series(comparison, i)) != NULL; i++) {
        fputs(i ? "," : "", json);
        write_series(json, series);
    }
    fputs("],\"results\":[", json);
    for (int i = 0; (result = ld_comparison_result(comparison, i)) != NULL; i++) {
        fputs(i ? "," : "", json);
        write_result(json, result);
    }
    fputs("]}", json);
}
