// launchdyn optimise: values of keys at which what the scenario names is least.
#include "launchdyn/optimise.h"

#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "cli/progress.h"

typedef struct optimise_wishes {
    char **sets;
    char *folder, *plot;
    int threads, json, strict;
} optimise_wishes;

static int run(ld_optimisation *optimisation, const optimise_wishes *wishes)
{
    run_progress progress;
    ld_error error;
    progress_start(&progress, command_is_quiet());
    const ld_optimise_options options = {.folder = wishes->folder,
                                         .threads = wishes->threads,
                                         .self = &progress,
                                         .progress = progress_candidates,
                                         .go_on = progress_resume};
    ld_status status = ld_optimise_run(optimisation, &options, &error);
    progress_end(&progress);
    command_step("optimised");
    if (status)
        return command_fail(status, &error);
    if (wishes->json)
        ld_optimise_print_json(optimisation, stdout);
    else
        ld_optimise_print(optimisation, command_text());
    if (wishes->plot)
        status = ld_optimise_plot(optimisation, wishes->plot, &error);
    return status ? command_fail(status, &error) : 0;
}

static int optimise_model(const ld_model *model, void *data)
{
    const optimise_wishes *wishes = data;
    ld_optimisation *optimisation = NULL;
    ld_error error;
    int code = command_take_notes(ld_model_source(model), 0, 0, wishes->strict != 0);
    if (code)
        return code;
    ld_status status = ld_optimise_create(model, &optimisation, &error);
    if (status)
        return command_fail(status, &error);
    code = run(optimisation, wishes);
    ld_optimise_free(optimisation);
    return code;
}

int command_optimise(const command *self, int argc, char **argv)
{
    optimise_wishes wishes = {.threads = 1};
    const command_option options[] = {
        COMMAND_SETS(&wishes.sets),
        COMMAND_STRICT(&wishes.strict),
        {"out", 'o', OPTION_TEXT, &wishes.folder,
         "Folder for optimise.json, optimised.yaml and the state by which it continues", "DIR"},
        COMMAND_JOBS(&wishes.threads, "launches"),
        {"plot", '\0', OPTION_TEXT, &wishes.plot, "Draw the course: .svg, .pdf or .png", "PICTURE"},
        COMMAND_JSON(&wishes.json),
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (!command_line_read(&line, self, argc, argv, options, &code))
        return code;
    code = EXIT_INPUT;
    if (line.count != 1)
        command_complain("optimise requires %s; see launchdyn optimise --help", self->arguments);
    else if (command_wrong_jobs(wishes.threads))
        command_complain("%s", command_wrong_jobs(wishes.threads));
    else
        code = command_on_file(line.word[0], wishes.sets, optimise_model, &wishes);
    options_end(&line);
    return code;
}
