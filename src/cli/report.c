// launchdyn report: one HTML file of a run.
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "launchdyn/report.h"

int command_write_report(const char *folder, const char *file, bool quiet)
{
    static ld_report report;
    ld_error error;
    ld_status status = ld_report_write(folder, file, &report, &error);
    if (status)
        return command_fail(status, &error);
    for (int i = 0; i < report.note_count; i++)
        command_complain("%s", report.note[i]);
    if (!quiet)
        printf("%s%s: %.0f kB\n", file ? file : folder, file ? "" : "/report.html",
               (double)report.bytes * 1e-3);
    return 0;
}

int command_report(const command *self, int argc, const char **argv)
{
    char *file = NULL;
    const struct poptOption options[] = {
        {"output", 'o', POPT_ARG_STRING, &file, 0, "The report (DIR/report.html)", "FILE"},
        COMMAND_HELP,
        COMMAND_END};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, 1, &code)) {
        code = command_write_report(line.word[0], file, false);
        command_line_end(&line);
    }
    free(file);
    return code;
}
