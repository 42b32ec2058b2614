// From folders of studies to one HTML file.
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "base/numeric_locale.h"
#include "report/report_html.h"
#include "report/report_study_page.h"

// ---- what is laid side by side

// Which of the values of a swept key a point has, from 1.
static int value_number(const study_data *data, const study_point *point, int axis)
{
    int number = 1;
    for (int i = 0; i < data->point_count; i++) {
        bool before = true;
        for (int j = 0; j < i && before; j++)
            before = strcmp(data->point[j].text[axis], data->point[i].text[axis]) != 0;
        if (strcmp(data->point[i].text[axis], point->text[axis]) == 0)
            break;
        number += before;
    }
    return number;
}

// "speed = 15 km/h"; of several keys "15 km/h, 0.5 s", of a long value "order 2".
static void point_name(const study_data *data, const study_point *point, char *name, size_t size)
{
    enum { LONGEST = 24, LONG = 16 };
    const bool one = data->swept_count == 1;
    name[0] = '\0';
    for (int k = 0; k < data->swept_count; k++) {
        const char *dot = strrchr(data->swept[k], '.'), *key = dot ? dot + 1 : data->swept[k];
        bool is_long = strlen(point->text[k]) > (one ? LONGEST : LONG);
        size_t length = strlen(name);
        if (is_long)
            snprintf(name + length, size - length, "%s%s %d", k ? ", " : "", key,
                     value_number(data, point, k));
        else
            snprintf(name + length, size - length, "%s%s%s%s", k ? ", " : "", one ? key : "",
                     one ? " = " : "", point->text[k]);
    }
}

// Distinguishes a series with its label: "salvo (2)".
static void number_label(const study_source *source, study_series *series)
{
    size_t length = strlen(series->label);
    int same = 1;
    for (const study_series *other = source->series; other < series; other++)
        same += strncmp(other->label, series->label, length) == 0 &&
                (other->label[length] == '\0' || strncmp(other->label + length, " (", 2) == 0);
    if (same > 1)
        snprintf(series->label + length, sizeof series->label - length, " (%d)", same);
}

static void add_series(study_source *source, const study_data *data, const char *folder)
{
    for (int i = 0; i < data->point_count; i++) {
        if (source->series_count == REPORT_SERIES) {
            report_take_note(source->report, "More than %d series: the rest of %.120s is left out.",
                             REPORT_SERIES, folder);
            return;
        }
        study_series *series = &source->series[source->series_count++];
        *series = (study_series){.data = data, .point = &data->point[i]};
        char name[100], point[140] = "";
        report_folder_name(folder, name, sizeof name);
        point_name(data, series->point, point, sizeof point);
        bool both = point[0] && source->several;
        snprintf(series->label, sizeof series->label, "%s%s%s", point[0] ? point : name,
                 both ? ", " : "", both ? name : "");
        number_label(source, series);
    }
}

// LD_ERR_FILE, LD_ERR_MEMORY: one could not be read; what is none, or damaged, gives a warning.
static ld_status open_studies(study_source *source, const char *const *folder, size_t count,
                              ld_error *error)
{
    source->several = count > 1;
    for (size_t i = 0; i < count; i++) {
        study_data *data = &source->study[source->study_count];
        if (source->study_count == REPORT_SERIES) {
            report_take_note(source->report, "More than %d studies: the rest is left out.",
                             REPORT_SERIES);
            return LD_OK;
        }
        ld_status status = study_data_open(folder[i], data, error);
        if (status == LD_ERR_INPUT) {
            study_take_problem(source, "", error);
            continue;
        }
        if (status)
            return status;
        status = study_data_origin(data, &source->origin[source->study_count], error);
        source->folder[source->study_count++] = folder[i];
        add_series(source, data, folder[i]);
        if (status)
            return status;
    }
    return LD_OK;
}

static void close_studies(study_source *source)
{
    measured_free(&source->launches);
    for (int i = 0; i < source->series_count; i++)
        study_values_free(&source->series[i].values);
    for (int i = 0; i < source->study_count; i++) {
        study_data_close(&source->study[i]);
        ld_origin_free(&source->origin[i]);
    }
}

// ---- the file

static const char *title_of(const study_source *source)
{
    const study_series *first = &source->series[0];
    if (source->several)
        return "Studies compared";
    return *first->data->title ? first->data->title : first->label;
}

// The page in memory, to be freed.
static ld_status make_page(study_source *source, char **text, size_t *length, ld_error *error)
{
    char *data = NULL;
    size_t data_length = 0;
    FILE *json = memory_stream(&data, &data_length), *page = memory_stream(text, length);
    bool fine = json && page && study_write_data(json, source) == LD_OK;
    fine &= json && fclose(json) == 0;
    if (fine) {
        report_begin_page(page, &study_bundle, title_of(source),
                          "This report draws its plots with JavaScript; study.db has the same "
                          "numbers, and launchdyn study show prints them.");
        report_write_json(page, "data", data, data_length);
        report_end_page(page, &study_bundle);
    }
    fine &= page && fclose(page) == 0;
    free(data);
    if (source->problem.status && source->problem.status != LD_ERR_INPUT)
        return ld_fail(error, source->problem.status, "%s", source->problem.text);
    return fine ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
}

// With as many points, places and sensitivities as fit.
static ld_status make_page_that_fits(study_source *source, char **text, size_t *length,
                                     ld_error *error)
{
    int notes = source->report->note_count;
    for (source->share = 1;; source->share /= 2) {
        ld_status status = make_page(source, text, length, error);
        if (status || *length <= REPORT_BYTES)
            return status;
        if (source->share < 0.1)
            return ld_fail(error, LD_ERR_INPUT, "the studies are too many for a report of %d bytes",
                           REPORT_BYTES);
        free(*text);
        *text = NULL;
        // said again by the next one
        source->report->note_count = notes;
        for (int i = 0; i < source->series_count; i++)
            source->series[i].report_broken = false;
    }
}

static ld_status write_report(study_source *source, const char *file, ld_error *error)
{
    char *text = NULL;
    size_t length = 0;
    locale_t before = numeric_locale_enter();
    ld_status status = make_page_that_fits(source, &text, &length, error);
    numeric_locale_leave(before);
    if (!status)
        status = report_write_file(file, text, length, error);
    source->report->bytes = status ? 0 : length;
    free(text);
    return status;
}

ld_status ld_report_write_measured(const char *const *folder, size_t count, const char *launches,
                                   const char *file, ld_report *report, ld_error *error)
{
    ld_report unwanted;
    report = report ? report : &unwanted;
    memset(report, 0, sizeof *report);
    study_source *source = calloc(1, sizeof *source);
    if (!source)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
    source->report = report;
    source->measured = launches;
    ld_status status = open_studies(source, folder, count, error);
    if (!status && source->series_count == 0)
        status =
            ld_fail(error, LD_ERR_INPUT, "no study to report: %s",
                    report->note_count ? report->note[0] : "none of the named studies has points");
    if (!status && launches)
        status = measured_read(launches, source->series[0].data, &source->launches, error);
    if (!status)
        status = write_report(source, file, error);
    if (!status && source->problem.status)
        status = ld_fail(error, source->problem.status, "%s; the report shows the rest",
                         source->problem.text);
    close_studies(source);
    free(source);
    return status;
}

ld_status ld_report_write_studies(const char *const *folder, size_t count, const char *file,
                                  ld_report *report, ld_error *error)
{
    return ld_report_write_measured(folder, count, NULL, file, report, error);
}
