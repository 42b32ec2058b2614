#include "report/report_study_measured.h"

#include <math.h>

#include "report/report_study_numbers.h"
#include "results/json_text.h"

// Points that a plot shows of one side, where there is room.
enum { MOST_SHOWN = 400, BYTES_OF_POINTS = 300000, BYTES_OF_A_POINT = 12 };

static size_t most_points(const study_source *source)
{
    double bytes = source->share * BYTES_OF_POINTS;
    int sides = source->launches.results * (source->series_count + 1);
    size_t fit = (size_t)(bytes / (BYTES_OF_A_POINT * sides));
    return fit < MOST_SHOWN ? fit : MOST_SHOWN;
}

static void write_number(FILE *json, const char *name, double value)
{
    fprintf(json, ",\"%s\":", name);
    json_write_number(json, value);
}

static void write_estimate(FILE *json, const char *name, estimate e)
{
    fprintf(json, ",\"%s\":", name);
    study_write_estimate(json, 0, e, json_write_number);
}

static void write_points(FILE *json, const double *value, size_t count, size_t most)
{
    bool first = true;
    fputs("\"points\":[", json);
    for (size_t i = 0; i < count; i++) {
        if (!study_shows_point((int64_t)i, 1, count, most))
            continue;
        fputs(first ? "" : ",", json);
        first = false;
        study_write_short(json, value[i]);
    }
    fputc(']', json);
}

static void write_side(FILE *json, const group_statistics *of)
{
    fprintf(json, ",\"count\":%zu", of->count);
    write_estimate(json, "mean", of->mean);
    write_estimate(json, "deviation", of->deviation);
}

// The result of one series with how far it is from the launches; null where it has none.
static ld_status write_series(FILE *json, study_source *source, study_series *series,
                              const measured_result *result)
{
    const char *nearest;
    const study_column *column = study_data_find(series->data, result->name, &nearest);
    measured_comparison of;
    series->values.count = 0;
    if (column)
        study_read(source, series, &column, 1);
    if (series->values.count == 0) {
        fputs("null", json);
        return LD_OK;
    }
    if (measured_compare(result, &series->values, &of))
        return LD_ERR_MEMORY;
    fputc('{', json);
    write_points(json, series->values.value[0], series->values.count, most_points(source));
    write_side(json, &of.simulated);
    write_estimate(json, "difference", of.by.mean);
    write_number(json, "difference_chance", of.by.mean_chance);
    write_estimate(json, "ratio", of.by.deviation);
    write_number(json, "ratio_chance", of.by.deviation_chance);
    fputc('}', json);
    return LD_OK;
}

static ld_status write_result(FILE *json, study_source *source, const measured_result *result)
{
    const char *nearest;
    const study_column *column = study_data_find(source->series[0].data, result->name, &nearest);
    group_statistics own;
    ld_status status = moments_of(result->value, result->group, result->count, &own);
    if (status)
        return status;
    fputs("\n{\"name\":", json);
    json_write_text(json, result->name);
    fputs(",\"unit\":", json);
    json_write_text(json, column ? column->unit : "");
    fputs(",\"own\":{", json);
    write_points(json, result->value, result->count, most_points(source));
    write_side(json, &own);
    fputs("},\"series\":[", json);
    for (int i = 0; i < source->series_count && !status; i++) {
        fputs(i ? ",\n" : "\n", json);
        status = write_series(json, source, &source->series[i], result);
    }
    fputs("]}", json);
    return status;
}

ld_status study_write_measured(FILE *json, study_source *source)
{
    const measured *launches = &source->launches;
    ld_status status = LD_OK;
    if (!source->measured) {
        fputs("null", json);
        return LD_OK;
    }
    fputs("{\"file\":", json);
    json_write_text(json, source->measured);
    fprintf(json, ",\"launches\":%zu,\"salvos\":%zu,\"results\":[", launches->count,
            launches->salvos);
    for (int i = 0; i < launches->results && !status; i++) {
        fputs(i ? "," : "", json);
        status = write_result(json, source, &launches->result[i]);
    }
    fputs("]}", json);
    return status;
}
