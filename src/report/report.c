// From a folder of results to one HTML file.
#include "launchdyn/report.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "report/report_parts.h"
#include "results/manifest.h"
#include "results/origin.h"

// ---- the results ----

static void join(char *path, const char *folder, const char *name)
{
    snprintf(path, REPORT_PATH_SIZE, "%s/%s", folder, name);
}

// What there is of the history. LD_ERR_INPUT: the file is not to be read, or not all of it.
static ld_status read_history_file(report_source *source, const char *path, ld_error *error)
{
    ld_status status = history_read(path, &source->history, error);
    if (status)
        return status;
    source->has_history = true;
    if (source->history.rows == 0 && source->history.flights == 0)
        report_take_note(source->report, "The history has no rows.");
    status = origin_read_history(path, &source->origin, error);
    source->has_origin = !status && source->origin.scenario; // an earlier version keeps none
    return status;
}

// Reads the history, of a folder in which it is not damaged, where there is one. LD_ERR_INPUT, with
// a warning; LD_ERR_FILE, LD_ERR_MEMORY.
static ld_status read_history(report_source *source, const char *folder, ld_error *error)
{
    char path[REPORT_PATH_SIZE];
    join(path, folder, "history.h5");
    if (access(path, F_OK) != 0) {
        join(path, folder, "history.h5.part");
        if (access(path, F_OK) != 0) {
            report_take_note(source->report, "There is no history.h5: no plots.");
            return LD_OK;
        }
        report_take_note(
            source->report,
            "The run did not reach its end: the plots show history.h5.part, up to its last block.");
    }
    ld_status status = read_history_file(source, path, error);
    if (status == LD_ERR_INPUT)
        report_take_note(source->report, "%s%s.",
                         source->has_history ? "" : "No plots: ", error->text);
    return status;
}

// Takes the summary over, or says why there is none; also where it does not say what is whole.
static void take_summary(report_source *source, manifest *found)
{
    source->summary = found->text;
    source->summary_length = found->length;
    found->text = NULL;
    const char *doubt = manifest_doubt(found);
    if (doubt)
        report_take_note(source->report, "%s: %s.",
                         source->summary ? "The files cannot be verified" : "No summary", doubt);
}

// Records which files are damaged, of which the history is not to be read. LD_ERR_INPUT with the
// first sentence where summary.json or another is; LD_ERR_FILE, LD_ERR_MEMORY.
static ld_status find_damage(report_source *source, const char *folder, const manifest *found,
                             bool *history, ld_error *first)
{
    ld_status damaged = LD_OK;
    if (found->state == MANIFEST_DAMAGED)
        damaged = ld_fail(first, LD_ERR_INPUT, "%s", found->problem);
    for (int i = 0; i < MANIFEST_FILES; i++) {
        ld_error error;
        ld_status status = manifest_check(found, folder, i, &error);
        if (!status)
            continue;
        if (!damaged || status != LD_ERR_INPUT)
            *first = error;
        if (status != LD_ERR_INPUT)
            return status;
        damaged = status;
        *history &= i != MANIFEST_HDF5;
        report_take_note(source->report, "%s%s.", i == MANIFEST_HDF5 ? "No plots: " : "",
                         error.text);
    }
    return damaged;
}

ld_status report_read_folder(report_source *source, const char *folder, ld_error *error)
{
    manifest found;
    ld_error first;
    bool history = true;
    ld_status status = manifest_read(folder, &found, error);
    if (status)
        return status;
    status = find_damage(source, folder, &found, &history, &first);
    ld_status read = history ? read_history(source, folder, error) : LD_OK;
    take_summary(source, &found);
    manifest_free(&found);
    if (read && read != LD_ERR_INPUT)
        return read;
    if (status == LD_ERR_INPUT)
        return ld_fail(error, status, "%.300s is damaged: %s", folder, first.text);
    return status ? ld_fail(error, status, "%.300s/%s", folder, first.text) : read;
}

void report_free_source(report_source *source)
{
    history_free(&source->history);
    free(source->summary);
    ld_origin_free(&source->origin);
    ld_comparison_free(source->comparison);
}

// ---- the file ----

size_t report_title_length(const report_source *source)
{
    return source->history.title ? strlen(source->history.title) : 0;
}

static ld_status write_data(FILE *json, const void *self, const report_detail *detail,
                            ld_error *error)
{
    return report_write_data(json, self, detail, error);
}

static ld_status write_page(FILE *page, const void *self, const char *data, size_t length,
                            ld_error *error)
{
    return report_write_page(page, self, data, length, error);
}

// A log beside a run; none where `file` is NULL.
typedef struct log_choice {
    const char *file, *sensors;
} log_choice;

static ld_status compare_log(report_source *source, const char *folder, log_choice log,
                             ld_error *error)
{
    const ld_compare_options options = {.sensors = log.sensors};
    const char *slash = log.file ? strrchr(log.file, '/') : NULL;
    source->log = slash ? slash + 1 : log.file;
    if (!log.file)
        return LD_OK;
    ld_status status = ld_compare(folder, log.file, &options, &source->comparison, error);
    const char *note;
    for (int i = 0; !status && (note = ld_comparison_note(source->comparison, i)) != NULL; i++)
        report_take_note(source->report, "%s", note);
    return status;
}

static ld_status write_run(const char *folder, const char *file, log_choice log, ld_report *report,
                           ld_error *error)
{
    ld_report unwanted;
    char usual[REPORT_PATH_SIZE];
    report = report ? report : &unwanted;
    memset(report, 0, sizeof *report);
    if (strlen(folder) + 32 > REPORT_PATH_SIZE || (file && strlen(file) + 8 > REPORT_PATH_SIZE))
        return ld_fail(error, LD_ERR_INPUT, "the name of the folder or the report is too long");
    struct stat about;
    if (stat(folder, &about) == 0 && !S_ISDIR(about.st_mode))
        return ld_fail(error, LD_ERR_INPUT, "%.400s is not a folder", folder);
    report_source *source = calloc(1, sizeof *source);
    if (!source)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
    source->report = report;
    join(usual, folder, "report.html");
    ld_error damage;
    ld_status found = report_read_folder(source, folder, &damage);
    bool report_broken = found && found != LD_ERR_INPUT; // the system, not the folder
    ld_status status = report_broken ? ld_fail(error, found, "%s", damage.text)
                                     : report_add_replay(&source->history, error);
    if (!status)
        status = compare_log(source, folder, log, error);
    if (!status && !source->has_history && !source->summary)
        status = ld_fail(error, LD_ERR_INPUT, "no results in %.200s: %s %s", folder,
                         report->note[0], report->note[report->note_count - 1]);
    if (!status)
        status = report_write_as_fits(&(report_page){.self = source,
                                                     .write_data = write_data,
                                                     .write_page = write_page,
                                                     .title = report_title_length(source)},
                                      file ? file : usual, report, error);
    if (!status && found)
        status = ld_fail(error, found, "%s; the report shows the rest", damage.text);
    report_free_source(source);
    free(source);
    return status;
}

ld_status ld_report_write(const char *folder, const char *file, ld_report *report, ld_error *error)
{
    assert(folder);
    return write_run(folder, file, (log_choice){NULL, NULL}, report, error);
}

ld_status ld_report_write_log(const char *folder, const char *log, const char *sensors,
                              const char *file, ld_report *report, ld_error *error)
{
    assert(folder && log);
    return write_run(folder, file, (log_choice){log, sensors}, report, error);
}
