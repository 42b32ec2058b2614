// Sensitivities in the report of studies: how much of a result's variance each factor makes alone.
#include <math.h>
#include <stdlib.h>

#include "io/json_text.h"
#include "report/report_study.h"
#include "studies/sensitivity.h"

static const char *const results[] = {"pitch",        "yaw",       "pitch_rate", "yaw_rate",
                                      "muzzle_speed", "spin_rate", "t_rear",     "apogee",
                                      "downrange",    "drift",     "tip.pitch",  "tip.yaw"};

// The column of a result, then those of all factors; to be freed. *count becomes how many; NULL:
// the study has no such result, or no memory.
static const study_column **columns_for(const study_data *data, const char *result, int *count)
{
    const char *nearest;
    const study_column *found = study_data_find(data, result, &nearest);
    const study_column **column =
        found ? malloc((size_t)(data->column_count + 1) * sizeof(void *)) : NULL;
    if (!column)
        return NULL;
    *count = 0;
    column[(*count)++] = found;
    for (int i = 0; i < data->column_count; i++)
        if (data->column[i].factor && !data->column[i].seed)
            column[(*count)++] = &data->column[i];
    return column;
}

static bool scatters(const double *value, size_t count)
{
    for (size_t i = 1; i < count; i++)
        if (value[i] != value[0])
            return true;
    return false;
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

static void write_series(FILE *json, study_source *source, study_series *series, const char *result)
{
    int count = 0;
    const study_column **column = columns_for(series->data, result, &count);
    fputc('[', json);
    if (column && count > 1) {
        study_read(source, series, column, count);
        const study_values *values = &series->values;
        if (values->count > 0 && scatters(values->value[0], values->count))
            write_factors(json, values, column, count);
    }
    fputc(']', json);
    free(column);
}

// Of more estimates there is no room.
static bool are_too_many(const study_source *source)
{
    enum { MOST = 4000 };
    int count = 0;
    for (int s = 0; s < source->series_count; s++)
        count += source->series[s].data->column_count - source->series[s].data->result_count;
    return count * (int)(sizeof results / sizeof *results) > MOST;
}

void study_write_sensitivities(FILE *json, study_source *source)
{
    if (are_too_many(source)) {
        report_take_note(source->report, "Sensitivities of so many series are left out.");
        return;
    }
    for (size_t i = 0; i < sizeof results / sizeof *results; i++) {
        fprintf(json, "%s\n{\"name\":\"%s\",\"series\":[", i ? "," : "", results[i]);
        for (int s = 0; s < source->series_count; s++) {
            fputs(s ? ",\n" : "\n", json);
            write_series(json, source, &source->series[s], results[i]);
        }
        fputs("]}", json);
    }
}
