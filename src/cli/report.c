// launchdyn report: one HTML file of a run, of several laid over each other, or of studies.
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cli/command.h"
#include "launchdyn/report.h"

static int finish(ld_status status, const ld_error *error, const ld_report *report,
                  const char *file, bool silent)
{
    bool written = report->bytes > 0;
    if (written)
        command_step("wrote %s", file);
    for (int i = 0; written && i < report->note_count; i++)
        command_complain("%s", report->note[i]);
    if (status)
        return command_fail(status, error);
    char visible[1024];
    if (!silent && !command_is_quiet())
        printf("%s: %.0f kB\n", ld_visible_text(file, visible, sizeof visible),
               (double)report->bytes * 1e-3);
    return 0;
}

enum { PATH_SIZE = 4096 };

// The report's usual place, where none is asked for.
static const char *place_of(const char *folder, const char *file, char usual[PATH_SIZE])
{
    snprintf(usual, PATH_SIZE, "%.4000s/report.html", folder);
    return file ? file : usual;
}

int command_write_report(const char *folder, const char *file, bool silent)
{
    static ld_report report;
    ld_error error;
    char usual[PATH_SIZE];
    ld_status status = ld_report_write(folder, file, &report, &error);
    return finish(status, &error, &report, place_of(folder, file, usual), silent);
}

// `launches`: of studies, the file with measured ones, or NULL.
static int write_several(const char *const *folder, size_t count, bool studies,
                         const char *launches, const char *file)
{
    static ld_report report;
    ld_error error;
    char usual[PATH_SIZE];
    if (count > 1 && !file) {
        command_complain("report of several folders requires -o FILE");
        return EXIT_INPUT;
    }
    file = place_of(folder[0], file, usual);
    ld_status status =
        studies ? ld_report_write_measured(folder, count, launches, file, &report, &error)
                : ld_report_write_runs(folder, count, file, &report, &error);
    return finish(status, &error, &report, file, false);
}

static bool holds_study(const char *folder)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%.4000s/study.db", folder);
    return access(path, F_OK) == 0;
}

static int write_with_log(const char *folder, const char *log, const char *sensors,
                          const char *file)
{
    static ld_report report;
    ld_error error;
    char usual[PATH_SIZE];
    ld_status status = ld_report_write_log(folder, log, sensors, file, &report, &error);
    return finish(status, &error, &report, place_of(folder, file, usual), false);
}

int command_report(const command *self, int argc, char **argv)
{
    char *file = NULL, *launches = NULL, *log = NULL, *sensors = NULL;
    const command_option options[] = {
        {"output", 'o', OPTION_TEXT, &file, "File of the report (DIR/report.html)", "FILE"},
        {"measured", '\0', OPTION_TEXT, &launches,
         "Compare studies with the measured launches in this CSV file", "FILE"},
        {"log", '\0', OPTION_TEXT, &log, "Compare a run with this log (launchdyn compare)", "FILE"},
        {"sensors", '\0', OPTION_TEXT, &sensors,
         "What the log's sensors are (LOG.yaml beside LOG.csv)", "FILE"},
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        bool studies = false;
        for (size_t i = 0; i < line.count; i++)
            studies |= holds_study(line.word[i]);
        if (launches && !studies) {
            command_complain("--measured requires at least one study");
            code = EXIT_INPUT;
        } else if (log && (line.count > 1 || studies)) {
            command_complain("--log requires one run");
            code = EXIT_INPUT;
        } else if (log) {
            code = write_with_log(line.word[0], log, sensors, file);
        } else if (line.count > 1 || studies) {
            code = write_several(line.word, line.count, studies, launches, file);
        } else {
            code = command_write_report(line.word[0], file, false);
        }
        options_end(&line);
    }
    return code;
}
