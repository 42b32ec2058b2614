// launchdyn run: from a scenario to a table and a folder of results.
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/run.h"
#include "launchdyn/origin.h"
#include "launchdyn/output.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"

// A run that ended early for reasons of its own leaves results up to there.
static bool leaves_results(ld_status status)
{
    return status == LD_OK || status == LD_ERR_LAUNCH || status == LD_ERR_NUMERIC ||
           status == LD_ERR_INTERRUPTED;
}

// Prints what the run has found.
static ld_status print_summary(const ld_model *model, const ld_summary *summary, bool json,
                               ld_error *error)
{
    if (json)
        return ld_summary_print_json(model, summary, stdout, error);
    if (!command_is_quiet())
        ld_summary_print(model, summary, stdout);
    return LD_OK;
}

// Runs and writes; the status of the run is returned, or of the writing where that fails.
static ld_status simulate(ld_simulation *simulation, const ld_model *model,
                          const run_wishes *wishes, ld_summary *summary, ld_error *error)
{
    ld_output *output = NULL;
    ld_status status = LD_OK;
    run_progress progress;
    progress_start(&progress, command_is_quiet()); // first: a stop leaves no half a file behind
    if (wishes->folder)
        status = ld_output_open(wishes->folder, model, wishes->csv != 0, &output, error);
    if (status)
        return status;

    ld_run_options options = {.sink = output ? ld_output_sink(output) : NULL,
                              .self = &progress,
                              .progress = progress_share};
    status = ld_simulation_run(simulation, &options, summary, error);
    progress_end(&progress);
    command_step("ran the launch from the equilibrium to its end");

    if (!leaves_results(status)) {
        ld_output_discard(output);
        return status;
    }
    ld_error problem;
    ld_status written = output ? ld_output_finish(output, summary, &problem) : LD_OK;
    if (output && !written)
        command_step("wrote %s", wishes->folder);
    // of a start that is refused there is nothing to report but the reason
    double steps = 0;
    bool refused =
        status && !ld_summary_number(summary, "statistics.steps", &steps, NULL) && !(steps > 0);
    if (!written && !refused)
        written = print_summary(model, summary, wishes->json != 0, &problem);
    if (!written)
        return status;
    if (status)
        command_complain("%s", error->text);
    *error = problem;
    return written;
}

int run_model(const ld_model *model, void *data)
{
    const run_wishes *wishes = data;
    ld_error error;
    if (wishes->csv && !wishes->folder) {
        command_complain("--csv requires --out DIR");
        return EXIT_INPUT;
    }
    if (wishes->report && !wishes->folder) {
        command_complain("--report requires --out DIR");
        return EXIT_INPUT;
    }
    ld_simulation *simulation = NULL;
    ld_summary *summary = ld_summary_new();
    ld_status status = summary ? ld_simulation_create(model, &simulation, &error)
                               : ld_fail(&error, LD_ERR_MEMORY, "no memory for a summary");
    bool begun = !status;
    command_step(begun ? "built the system: modes, coefficients, tables"
                       : "could not build the system");
    if (begun)
        status = simulate(simulation, model, wishes, summary, &error);
    ld_simulation_free(simulation);
    ld_summary_free(summary);
    int code = 0;
    if (wishes->report && begun && leaves_results(status))
        code = command_write_report(wishes->folder, NULL, wishes->json != 0);
    if (!status)
        return code;
    fflush(stdout);
    int failed = command_fail_on(model, status, &error);
    return code ? code : failed;
}

// Runs what a scenario says, after warnings on it.
static int run_with_warnings(const ld_model *model, void *data)
{
    const run_wishes *wishes = data;
    int code = command_take_notes(ld_model_source(model), 0, 0, wishes->strict != 0);
    return code ? code : run_model(model, data);
}

static int run_sample(const ld_model *point, int number, run_wishes *wishes)
{
    ld_sample *sample = NULL;
    ld_error error;
    ld_status status = ld_sample_create(point, number, &sample, &error);
    if (status)
        return command_fail(status, &error);
    int code = run_model(ld_sample_model(sample), wishes);
    ld_sample_free(sample);
    return code;
}

// Runs what the results in a folder are of, from the texts that they keep.
static int run_again(const char *folder, run_wishes *wishes)
{
    ld_model *model;
    ld_origin origin;
    ld_error error;
    ld_status status = ld_origin_read(folder, &origin, &error);
    if (status)
        return command_fail(status, &error);
    int code = EXIT_INPUT;
    if (!origin.source) {
        command_complain("%s cannot be repeated: its model was not read from a scenario", folder);
    } else if ((status = command_read_source(origin.source, origin.point, &model)) != LD_OK) {
        code = command_code(status);
    } else {
        command_warn_difference(folder, &origin);
        code = command_take_notes(origin.source, origin.point, origin.point, wishes->strict != 0);
        if (!code)
            code = origin.sample > 0 ? run_sample(model, origin.sample, wishes)
                                     : run_model(model, wishes);
        ld_model_free(model);
    }
    ld_origin_free(&origin);
    return code;
}

static int run_words(const command *self, const command_line *line, const char *again,
                     run_wishes *wishes)
{
    if (again && (line->count > 0 || wishes->sets))
        command_complain(
            "--again FOLDER repeats the run stored in FOLDER; it excludes FILE and --set");
    else if (again)
        return run_again(again, wishes);
    else if (line->count != 1)
        command_complain("run requires %s; see launchdyn run --help", self->arguments);
    else
        return command_on_file(line->word[0], wishes->sets, run_with_warnings, wishes);
    return EXIT_INPUT;
}

int command_run(const command *self, int argc, char **argv)
{
    run_wishes wishes = {0};
    char *again = NULL;
    const command_option options[] = {
        COMMAND_SETS(&wishes.sets),
        {"out", 'o', OPTION_TEXT, &wishes.folder,
         "Write summary.json, history.h5 and, if the scenario gives a position on the Earth, "
         "trajectories.kml into this folder",
         "DIR"},
        {"again", '\0', OPTION_TEXT, &again,
         "Repeat the run stored in FOLDER, bit for bit, in place of FILE", "FOLDER"},
        {"csv", '\0', OPTION_FLAG, &wishes.csv,
         "Also write history.csv and, for rockets in free flight, flights.csv", NULL},
        {"report", '\0', OPTION_FLAG, &wishes.report, "Also write report.html", NULL},
        {"json", '\0', OPTION_FLAG, &wishes.json, "Print the summary as JSON, as in summary.json",
         NULL},
        COMMAND_STRICT(&wishes.strict),
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        code = run_words(self, &line, again, &wishes);
        options_end(&line);
    }
    return code;
}
