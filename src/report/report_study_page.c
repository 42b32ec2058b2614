#include "report/report_study_page.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/version.h"
#include "report/report_study_measured.h"
#include "report/report_study_numbers.h"
#include "report/report_study_over.h"
#include "report/report_study_plan.h"
#include "report/report_study_scatter.h"
#include "report/report_study_sensitivity.h"
#include "results/json_text.h"

// Bytes for what grows with the number of series; the rest of a report fits beside them.
enum { BYTES_OF_PLACES = 600000, BYTES_OF_A_PLACE = 70, MOST_FAILURES = 200 };

static int most_places(const study_source *source, int results)
{
    double bytes = source->share * BYTES_OF_PLACES;
    int fit = (int)(bytes / (BYTES_OF_A_PLACE * results * source->series_count));
    return fit < REPORT_PLACES ? fit : REPORT_PLACES;
}

// ---- numbers

static void write_named(FILE *json, const char *name, double value)
{
    fprintf(json, ",\"%s\":", name);
    json_write_number(json, value);
}

static void write_text(FILE *json, const char *name, const char *text)
{
    fprintf(json, ",\"%s\":", name);
    json_write_text(json, text ? text : "");
}

// ---- one result

static size_t count_groups(const study_values *values)
{
    size_t count = 0;
    for (size_t i = 0; i < values->count; i++)
        count += i == 0 || values->group[i] != values->group[i - 1];
    return count;
}

// Estimates from the first groups alone, ever more of them; `values` in the order of their groups.
static ld_status write_running(FILE *json, const study_values *values, int most)
{
    size_t place[REPORT_PLACES], passed = 0, end = 0;
    long samples[REPORT_PLACES], sample_count = 0;
    group_statistics running[REPORT_PLACES];
    int count = study_choose_places(count_groups(values), most, place);
    ld_status status = LD_OK;
    for (int i = 0; i < count && !status; i++) {
        for (; end < values->count; end++) {
            bool next = end == 0 || values->group[end] != values->group[end - 1];
            if (next && passed == place[i])
                break;
            passed += next;
            sample_count += end == 0 || values->sample[end] != values->sample[end - 1];
        }
        samples[i] = sample_count;
        status = moments_of(values->value[0], values->group, end, &running[i]);
    }
    if (status)
        return status;
    fputs("{\"samples\":[", json);
    for (int i = 0; i < count; i++)
        fprintf(json, "%s%ld", i ? "," : "", samples[i]);
    fputs("],\"mean\":[", json);
    for (int i = 0; i < count; i++)
        study_write_estimate(json, i, running[i].mean, study_write_short);
    fputs("],\"deviation\":[", json);
    for (int i = 0; i < count; i++)
        study_write_estimate(json, i, running[i].deviation, study_write_short);
    fputs("]}", json);
    return LD_OK;
}

static void write_statistics(FILE *json, const group_statistics *s)
{
    fprintf(json, "\"count\":%zu,\"groups\":%zu,\"mean\":", s->count, s->groups);
    study_write_estimate(json, 0, s->mean, json_write_number);
    fputs(",\"deviation\":", json);
    study_write_estimate(json, 0, s->deviation, json_write_number);
    write_named(json, "skewness", s->skewness);
    write_named(json, "least", s->least);
    write_named(json, "greatest", s->greatest);
    fputs(",\"quantiles\":[", json);
    for (int k = 0; k < STATISTICS_QUANTILES; k++)
        study_write_estimate(json, k, s->quantile[k], json_write_number);
    fputc(']', json);
}

static void write_bins(FILE *json, const study_bins *bins, const study_values *sorted)
{
    long in_bin[REPORT_BINS];
    study_fill_bins(bins, sorted->value[0], sorted->count, in_bin);
    fputs(",\"bins\":[", json);
    for (int i = 0; i < bins->count; i++)
        fprintf(json, "%s%ld", i ? "," : "", in_bin[i]);
    fputc(']', json);
}

// Sorts the values of all series, and chooses bins for them.
static study_bins sort_into_bins(const study_source *source)
{
    const double *sorted[REPORT_SERIES];
    size_t count[REPORT_SERIES];
    for (int i = 0; i < source->series_count; i++) {
        const study_values *values = &source->series[i].values;
        sorted[i] = values->value ? values->value[0] : NULL;
        count[i] = values->count;
        if (count[i] > 0)
            sort_values(values->value[0], count[i]);
    }
    return study_choose_bins(sorted, count, source->series_count);
}

// Of a result that some series has: running estimates, bins, statistics with a histogram.
static ld_status write_result(FILE *json, const study_source *source, const study_column *result,
                              int places)
{
    group_statistics statistics[REPORT_SERIES];
    ld_status status = LD_OK;
    fputs("{\"name\":", json);
    json_write_text(json, result->name);
    write_text(json, "unit", result->unit);
    fputs(",\"running\":[", json);
    for (int i = 0; i < source->series_count && !status; i++) {
        const study_values *values = &source->series[i].values;
        fputs(i ? ",\n" : "\n", json);
        fputs(values->count ? "" : "null", json);
        if (values->count)
            status = write_running(json, values, places);
        if (values->count && !status)
            status = statistics_of(values->value[0], values->group, values->count, &statistics[i]);
    }
    if (status)
        return status;
    study_bins bins = sort_into_bins(source);
    bool overlaid = source->series_count <= REPORT_OVERLAID;
    fprintf(json, "],\"bins\":{\"from\":%.17g,\"width\":%.17g,\"count\":%d},\"series\":[",
            bins.from, bins.width, bins.count);
    for (int i = 0; i < source->series_count; i++) {
        const study_values *values = &source->series[i].values;
        fputs(i ? ",\n" : "\n", json);
        fputs(values->count ? "{" : "null", json);
        if (values->count)
            write_statistics(json, &statistics[i]);
        if (values->count && overlaid)
            write_bins(json, &bins, values);
        fputs(values->count ? "}" : "", json);
    }
    fputs("]}", json);
    return LD_OK;
}

// The results of all series in the order of the first that has them; to be freed. NULL: no memory.
static const study_column **list_results(const study_source *source, int *count)
{
    int most = 0;
    for (int i = 0; i < source->series_count; i++)
        most += source->series[i].data->result_count;
    const study_column **list = calloc((size_t)most + 1, sizeof(void *));
    *count = 0;
    for (int i = 0; list && i < source->series_count; i++) {
        const study_data *data = source->series[i].data;
        for (int k = 0; k < data->result_count; k++) {
            int same = 0;
            while (same < *count && strcmp(list[same]->name, data->column[k].name) != 0)
                same++;
            if (same == *count)
                list[(*count)++] = &data->column[k];
        }
    }
    return list;
}

static ld_status write_results(FILE *json, study_source *source)
{
    int results;
    const study_column **result = list_results(source, &results);
    if (!result)
        return LD_ERR_MEMORY;
    int places = most_places(source, results);
    bool first = true;
    ld_status status = LD_OK;
    for (int k = 0; k < results && !status; k++) {
        size_t count = 0;
        for (int i = 0; i < source->series_count; i++) {
            study_read_values(source, &source->series[i], &result[k]->name, 1);
            count += source->series[i].values.count;
        }
        if (count == 0)
            continue;
        fputs(first ? "\n" : ",\n", json);
        first = false;
        status = write_result(json, source, result[k], places);
    }
    free(result);
    return status;
}

// ---- the series

static void write_failures(FILE *json, study_source *source, const study_series *series)
{
    enum { LEAST_EACH = 5 };
    int most = MOST_FAILURES / source->series_count, count = 0;
    most = most > LEAST_EACH ? most : LEAST_EACH;
    study_failed *failed = malloc((size_t)most * sizeof *failed);
    ld_error error = {.status = LD_ERR_MEMORY, .text = "no memory"};
    char what[128];
    snprintf(what, sizeof what, "%.60s: failed samples cannot be read: ", series->label);
    if (!failed || study_data_failed(series->data, series->point, failed, most, &count, &error))
        study_take_problem(source, what, &error);
    fputs(",\"failures\":[", json);
    for (int i = 0; i < count; i++) {
        fprintf(json, "%s[%" PRId64 ",", i ? "," : "", failed[i].sample);
        json_write_text(json, failed[i].status);
        fputc(',', json);
        json_write_text(json, failed[i].reason);
        fputc(']', json);
    }
    fputc(']', json);
    free(failed);
}

// Pairs of a swept key and its value.
static void write_swept(FILE *json, const study_data *data, const study_point *point)
{
    fputs(",\"swept\":[", json);
    for (int i = 0; i < data->swept_count; i++) {
        fputs(i ? ",[" : "[", json);
        json_write_text(json, data->swept[i]);
        fputc(',', json);
        json_write_text(json, point->text[i]);
        fputc(']', json);
    }
    fputc(']', json);
}

static void write_series(FILE *json, study_source *source, const study_series *series)
{
    const study_point *point = series->point;
    fputs("{\"label\":", json);
    json_write_text(json, series->label);
    write_text(json, "title", series->data->title);
    write_text(json, "version", series->data->version);
    fprintf(json,
            ",\"samples\":%" PRId64 ",\"done\":%" PRId64 ",\"failed\":%" PRId64
            ",\"strata\":%" PRId64,
            point->asked, point->done, point->failed, series->data->strata);
    write_swept(json, series->data, point);
    write_failures(json, source, series);
    fputc('}', json);
}

ld_status study_write_data(FILE *json, study_source *source)
{
    fprintf(json, "{\"version\":\"%s\",\"series\":[", LD_VERSION);
    for (int i = 0; i < source->series_count; i++) {
        fputs(i ? ",\n" : "\n", json);
        write_series(json, source, &source->series[i]);
    }
    ld_status status = LD_OK;
    fputs("],\"studies\":[", json);
    for (int i = 0; i < source->study_count && !status; i++) {
        fputs(i ? ",\n" : "\n", json);
        status = study_write_plan(json, source, i);
    }
    fputs("],\"results\":[", json);
    if (!status)
        status = write_results(json, source);
    fputs("],\"over\":", json);
    if (!status)
        status = study_write_over(json, source);
    fputs(",\"pairs\":[", json);
    if (!status)
        status = study_write_pairs(json, source);
    fputs("],\"sensitivities\":[", json);
    if (!status)
        status = study_write_sensitivities(json, source);
    fputs("],\"measured\":", json);
    if (!status)
        status = study_write_measured(json, source);
    // last, when all that is broken is known
    fputs(",\"notes\":[", json);
    for (int i = 0; i < source->report->note_count; i++) {
        fputs(i ? "," : "", json);
        json_write_text(json, source->report->note[i]);
    }
    fputs("]}", json);
    return status;
}
