// launchdyn run: from a scenario to a table and a folder of results.
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/run.h"
#include "launchdyn/output.h"
#include "launchdyn/simulation.h"

// A run that ended early for reasons of its own leaves results up to there.
static bool leaves_results(ld_status status)
{
    return status == LD_OK || status == LD_ERR_LAUNCH || status == LD_ERR_NUMERIC ||
           status == LD_ERR_INTERRUPTED;
}

// Runs and writes; `status` of the run is returned, or of the writing where the run was fine.
static ld_status simulate(ld_simulation *simulation, const ld_model *model,
                          const run_wishes *wishes, ld_summary *summary, ld_error *error)
{
    ld_output *output = NULL;
    ld_status status = LD_OK;
    if (wishes->folder)
        status = ld_output_open(wishes->folder, model, wishes->csv != 0, &output, error);
    if (status)
        return status;

    run_progress progress;
    progress_start(&progress, wishes->quiet != 0);
    ld_run_options options = {.sink = output ? ld_output_sink(output) : NULL,
                              .self = &progress,
                              .progress = progress_share};
    status = ld_simulation_run(simulation, &options, summary, error);
    progress_end(&progress);

    if (!leaves_results(status)) {
        ld_output_discard(output);
        return status;
    }
    ld_error problem;
    ld_status written = output ? ld_output_finish(output, summary, &problem) : LD_OK;
    if (!written && !wishes->quiet)
        ld_summary_print(model, summary, stdout);
    if (written && status)
        command_complain("%s", problem.text);
    if (!written || status)
        return status;
    *error = problem;
    return written;
}

int run_model(const ld_model *model, void *data)
{
    const run_wishes *wishes = data;
    static ld_summary summary;
    ld_simulation *simulation = NULL;
    ld_error error;
    if (wishes->csv && !wishes->folder) {
        command_complain("--csv needs --out DIR");
        return EXIT_INPUT;
    }
    if (wishes->report && !wishes->folder) {
        command_complain("--report needs --out DIR");
        return EXIT_INPUT;
    }
    ld_status status = ld_simulation_create(model, &simulation, &error);
    if (!status)
        status = simulate(simulation, model, wishes, &summary, &error);
    ld_simulation_free(simulation);
    int code = 0;
    if (wishes->report && leaves_results(status))
        code = command_write_report(wishes->folder, NULL, wishes->quiet != 0);
    if (!status)
        return code;
    fflush(stdout);
    code = command_fail(status, &error);
    return status == LD_ERR_INTERRUPTED ? 128 + progress_signal() : code;
}

int command_run(const command *self, int argc, const char **argv)
{
    run_wishes wishes = {0};
    const struct poptOption options[] = {
        COMMAND_SETS(&wishes.sets),
        {"out", 'o', POPT_ARG_STRING, &wishes.folder, 0,
         "Write summary.json and history.h5 into this folder", "DIR"},
        {"csv", '\0', POPT_ARG_NONE, &wishes.csv, 0, "Write history.csv there too", NULL},
        {"report", '\0', POPT_ARG_NONE, &wishes.report, 0, "Write report.html there too", NULL},
        {"quiet", 'q', POPT_ARG_NONE, &wishes.quiet, 0, "Print nothing but errors", NULL},
        COMMAND_HELP,
        COMMAND_END};
    int code = command_on_model(self, argc, argv, options, &wishes.sets, run_model, &wishes);
    free(wishes.folder);
    return code;
}
