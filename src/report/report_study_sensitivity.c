#include "report/report_study_sensitivity.h"

#include <math.h>
#include <stdlib.h>

#include "report/report_study_numbers.h"
#include "results/json_text.h"
#include "studies/points/influence.h"
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

// Of the plans for sensitivities: the path, then the estimates that the plan gives.
static void write_influences(FILE *json, const influence *list, int count, influence_kind kind)
{
    for (int i = 0; i < count; i++) {
        const estimate of[] = {kind == INFLUENCE_EFFECTS ? list[i].effects.magnitude
                                                         : list[i].indices.first,
                               list[i].indices.total, list[i].indices.together};
        fputs(i ? ",[" : "[", json);
        json_write_text(json, list[i].factor->name);
        for (int k = 0; k < (kind == INFLUENCE_EFFECTS ? 1 : 3); k++) {
            fputc(',', json);
            study_write_estimate(json, 0, of[k], study_write_short);
        }
        fputc(']', json);
    }
}

// Of such a plan; what it says in words goes to `said`.
static void write_planned(FILE *json, study_source *source, study_series *series,
                          const study_column *result, char said[INFLUENCE_TEXT])
{
    const study_data *data = series->data;
    const influence_kind kind = influence_kind_of(data);
    const influence_question question = {data, series->point, result, LD_INDEX_USUAL};
    ld_error error = {.status = LD_ERR_MEMORY, .text = "no memory"};
    int count = 0;
    influence *list = calloc((size_t)data->column_count + 1, sizeof *list);
    if (!list || influences_of(&question, &series->values, list, &count, &error))
        study_take_problem(source, "sensitivities: ", &error);
    else if (count > 0 && isfinite(influence_rank(&list[0], kind, LD_INDEX_USUAL)))
        write_influences(json, list, count, kind);
    if (list)
        influence_sentence(result, kind, list, count, said);
    free(list);
}

static void write_series(FILE *json, study_source *source, study_series *series, const char *result,
                         const study_column **column, char said[INFLUENCE_TEXT])
{
    int count = list_columns(series->data, result, column);
    fputc('[', json);
    if (count > 1 && influence_kind_of(series->data) != INFLUENCE_SHARES) {
        write_planned(json, source, series, column[0], said);
    } else if (count > 1) {
        study_read(source, series, column, count);
        write_factors(json, &series->values, column, count);
    }
    fputc(']', json);
}

// A result in all series, and what one study alone says of it. Effects and shares do not go on one
// axis: those of the first series are drawn.
static void write_result(FILE *json, study_source *source, const char *result,
                         const study_column **column)
{
    const bool effects = influence_kind_of(source->series[0].data) == INFLUENCE_EFFECTS;
    char said[INFLUENCE_TEXT] = "";
    const char *nearest;
    const study_column *first = study_data_find(source->series[0].data, result, &nearest);
    fprintf(json, "{\"name\":\"%s\",\"series\":[", result);
    for (int s = 0; s < source->series_count; s++) {
        study_series *series = &source->series[s];
        fputs(s ? ",\n" : "\n", json);
        if ((influence_kind_of(series->data) == INFLUENCE_EFFECTS) == effects)
            write_series(json, source, series, result, column, said);
        else
            fputs("[]", json);
    }
    fprintf(json, "],\"effects\":%s,\"unit\":", effects ? "true" : "false");
    json_write_text(json, effects && first ? first->unit : "");
    fputs(",\"says\":", json);
    json_write_text(json, source->series_count == 1 ? said : "");
    fputc('}', json);
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
        fputs(i ? ",\n" : "\n", json);
        write_result(json, source, results[i], column);
    }
    free(column);
    return LD_OK;
}
