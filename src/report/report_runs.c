// From several folders of results to one HTML file: runs laid over each other.
#include <stdlib.h>
#include <string.h>

#include "launchdyn/report.h"
#include "launchdyn/version.h"
#include "report/report_origin.h"
#include "report/report_parts.h"
#include "results/json_text.h"

enum { REPORT_RUNS = 8 };

typedef struct report_run {
    report_source source;
    ld_report notes; // of its own
    char name[100];  // of its folder
} report_run;

typedef struct report_runs {
    int count;
    report_run run[REPORT_RUNS];
    ld_report *report; // takes the warnings of all
    ld_error problem;  // the first folder that is damaged or holds nothing
} report_runs;

// ---- the results

// A run without anything to show is left out with a warning. LD_ERR_MEMORY.
static ld_status add_run(report_runs *self, const char *folder, ld_error *error)
{
    report_run *run = &self->run[self->count];
    ld_error why;
    *run = (report_run){.source = {.report = &run->notes}};
    report_folder_name(folder, run->name, sizeof run->name);
    ld_status status = report_read_folder(&run->source, folder, &why);
    bool there = run->source.has_history || run->source.summary;
    if (!status && !there)
        status = ld_fail(&why, LD_ERR_INPUT, "no results in %.200s", folder);
    if (status)
        report_take_note(self->report, "%.230s.", why.text);
    if (status && !self->problem.status)
        self->problem = why;
    for (int i = 0; i < run->notes.note_count && there; i++)
        report_take_note(self->report, "%.60s: %.180s", run->name, run->notes.note[i]);
    if (there && status != LD_ERR_MEMORY) {
        self->count++;
        return LD_OK;
    }
    report_free_source(&run->source);
    return status == LD_ERR_MEMORY ? ld_fail(error, status, "%s", why.text) : LD_OK;
}

static ld_status read_runs(report_runs *self, const char *const *folder, size_t count,
                           ld_error *error)
{
    ld_status status = LD_OK;
    for (size_t i = 0; i < count && !status; i++) {
        if (self->count == REPORT_RUNS) {
            report_take_note(self->report, "More than %d runs: the rest is left out.", REPORT_RUNS);
            break;
        }
        status = add_run(self, folder[i], error);
    }
    if (!status && self->count == 0)
        status = ld_fail(error, LD_ERR_INPUT, "no run to report: %s", self->problem.text);
    return status;
}

// ---- the page

static ld_status write_data(FILE *json, const void *of, const report_detail *detail,
                            ld_error *error)
{
    const report_runs *self = of;
    ld_status status = LD_OK;
    fprintf(json, "{\"version\":\"%s\",\"notes\":[", LD_VERSION);
    for (int i = 0; i < self->report->note_count; i++) {
        fputs(i ? "," : "", json);
        json_write_text(json, self->report->note[i]);
    }
    fputs("],\"runs\":[", json);
    for (int i = 0; i < self->count && !status; i++) {
        fputs(i ? ",\n{\"folder\":" : "{\"folder\":", json);
        json_write_text(json, self->run[i].name);
        fputc(',', json);
        status = report_write_run(json, &self->run[i].source, detail, error);
        fputc('}', json);
    }
    fputs("],\"figures\":", json);
    plot_write_json(json);
    fputc('}', json);
    return status;
}

static ld_status write_page(FILE *page, const void *of, const char *data, size_t length,
                            ld_error *error)
{
    const report_runs *self = of;
    ld_status status = LD_OK;
    report_begin_page(page, &runs_bundle, "Runs overlaid",
                      "This report draws its plots with JavaScript; summary.json and history.h5 of "
                      "each run have the same numbers.");
    report_write_json(page, "data", data, length);
    for (int i = 0; i < self->count && !status; i++) {
        const report_source *source = &self->run[i].source;
        char name[24];
        snprintf(name, sizeof name, "summary-%d", i);
        if (source->summary)
            report_write_json(page, name, source->summary, source->summary_length);
        snprintf(name, sizeof name, "origin-%d", i);
        status =
            report_write_run_origin(page, name, source, REPORT_ORIGIN_BYTES / REPORT_RUNS, error);
    }
    report_end_page(page, &runs_bundle);
    return status;
}

ld_status ld_report_write_runs(const char *const *folder, size_t count, const char *file,
                               ld_report *report, ld_error *error)
{
    ld_report unwanted;
    report = report ? report : &unwanted;
    memset(report, 0, sizeof *report);
    report_runs *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
    self->report = report;
    ld_status status = read_runs(self, folder, count, error);
    report_page page = {self, write_data, write_page, true, 0};
    for (int i = 0; i < self->count; i++)
        page.title += report_title_length(&self->run[i].source);
    if (!status)
        status = report_write_as_fits(&page, file, report, error);
    if (!status && self->problem.status)
        status = ld_fail(error, LD_ERR_INPUT, "%s; the report shows the rest", self->problem.text);
    for (int i = 0; i < self->count; i++)
        report_free_source(&self->run[i].source);
    free(self);
    return status;
}
