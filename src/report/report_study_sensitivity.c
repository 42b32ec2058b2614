#include "report/report_study_sensitivity.h"

#include <math.h>
#include <stdlib.h>

#include "report/report_study_numbers.h"
#include "results/json_text.h"
#include "studies/statistics/sensitivity.h"

// The most requested first: of many series and factors there is no room for all.
static const char *const results[] = {
    "since_ignition.pitch",
    "since_ignition.yaw",
    "since_ignition.pitch_rate",
    "since_ignition.yaw_rate",
    "downrange",
    "drift",
    "exit_speed",
    "spin_rate",
    "apogee",
    "t_rear",
    "pitch",
    "yaw",
    "pitch_rate",
    "yaw_rate",
    "tip.pitch",
    "tip.yaw",
};
enum { RESULTS = sizeof results / sizeof *results, MOST_ESTIMATES = 4000 };

// Fills in the column of a result, then those of all factors but seeds. Returns how many, 0 where
// the study has no such result.
static int list_columns(const study_data *data, const char *result, const study_column **column)
{
    const char *nearest;
    int count = 0;
    const study_column *found = study_data_find(data, result, &nearest);
    if (!found)
        return 0;
    column[count++] = found;
    for (int i = 0; i < data->column_count; i++)
        if (data->column[i].factor && !data->column[i].seed)
            column[count++] = &data->column[i];
    return count;
}

// Pairs of a factor's path and the estimate of its sensitivity.
static void write_factors(FILE *json, const study_values *values, const study_column *const *column,
                          int count)
{
    bool first = true;
    for (int i = 1; i < count; i++) {
        estimate e = sensitivity_of(values->value[i], values->value[0], values->sample,
                                    values->group, values->count, column[i]->per_rocket);
        if (isnan(e.value))
            continue;
        fputs(first ? "[" : ",[", json);
        first = false;
        json_write_text(json, column[i]->name);
        fputc(',', json);
        study_write_estimate(json, 0, e, study_write_short);
        fputc(']', json);
    }
}

static void write_series(FILE *json, study_source *source, study_series *series, const char *result,
                         const study_column **column)
{
    int count = list_columns(series->data, result, column);
    fputc('[', json);
    if (count > 1) {
        study_read(source, series, column, count);
        write_factors(json, &series->values, column, count);
    }
    fputc(']', json);
}

static int count_estimates(const study_source *source)
{
    int count = 0;
    for (int s = 0; s < source->series_count; s++)
        count += source->series[s].data->column_count - source->series[s].data->result_count;
    return count;
}

static int most_columns(const study_source *source)
{
    int most = 0;
    for (int s = 0; s < source->series_count; s++)
        if (source->series[s].data->column_count > most)
            most = source->series[s].data->column_count;
    return most;
}

ld_status study_write_sensitivities(FILE *json, study_source *source)
{
    int each = count_estimates(source), most = (int)(source->share * MOST_ESTIMATES);
    int fit = each > 0 ? most / each : RESULTS;
    const study_column **column = malloc((size_t)(most_columns(source) + 1) * sizeof(void *));
    if (!column)
        return LD_ERR_MEMORY;
    if (fit < RESULTS)
        report_take_note(source->report,
                         "Sensitivities are shown for the first %d of %d results: the report has "
                         "no room for more.",
                         fit, RESULTS);
    for (int i = 0; i < RESULTS && i < fit; i++) {
        fprintf(json, "%s\n{\"name\":\"%s\",\"series\":[", i ? "," : "", results[i]);
        for (int s = 0; s < source->series_count; s++) {
            fputs(s ? ",\n" : "\n", json);
            write_series(json, source, &source->series[s], results[i], column);
        }
        fputs("]}", json);
    }
    free(column);
    return LD_OK;
}
