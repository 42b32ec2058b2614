// launchdyn compare: a run beside a log of what was measured.
#include <stdio.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "launchdyn/compare.h"

typedef struct compare_wishes {
    ld_compare_options options;
    char *sensors, *study, *picture;
    int json;
} compare_wishes;

static void tell_notes(const ld_comparison *comparison)
{
    const char *note;
    for (int i = 0; !command_is_quiet() && (note = ld_comparison_note(comparison, i)) != NULL; i++)
        command_complain("note: %s", note);
}

static int compare(const command_line *line, compare_wishes *asked)
{
    ld_comparison *comparison;
    ld_error error;
    run_progress progress;
    asked->options.sensors = asked->sensors;
    asked->options.study = asked->study;
    asked->options.progress = progress_share;
    asked->options.self = &progress;
    progress_start(&progress, command_is_quiet());
    ld_status status =
        ld_compare(line->word[0], line->word[1], &asked->options, &comparison, &error);
    progress_end(&progress);
    if (status)
        return command_fail(status, &error);
    command_step("compared the run with the log");
    tell_notes(comparison);
    if (asked->json)
        ld_comparison_print_json(comparison, stdout);
    else
        ld_comparison_print(comparison, command_text());
    if (asked->picture) {
        status = ld_comparison_draw(comparison, asked->picture, &error);
        command_step("drew %s", asked->picture);
    }
    ld_comparison_free(comparison);
    return status ? command_fail(status, &error) : 0;
}

int command_compare(const command *self, int argc, char **argv)
{
    compare_wishes asked = {.options = {.rocket = 1}};
    int refine = 0;
    const command_option options[] = {
        {"sensors", '\0', OPTION_TEXT, &asked.sensors,
         "What the log's sensors are (LOG.yaml beside LOG.csv)", "FILE"},
        {"refine", '\0', OPTION_FLAG, &refine,
         "Run twice more, with a tighter tolerance and with more modes, for u_num", NULL},
        {"samples", '\0', OPTION_INTEGER, &asked.options.samples,
         "Run N samples of the scenario's scatter, or of the study's, for u_input", "N"},
        {"study", '\0', OPTION_TEXT, &asked.study,
         "Take u_input of results from the study in this folder", "DIR"},
        {"rocket", '\0', OPTION_INTEGER, &asked.options.rocket,
         "Rocket to compare, in the order of firing (1)", "N"},
        {"plot", '\0', OPTION_TEXT, &asked.picture,
         "Draw measured and simulated series with their residuals: FILE.svg, FILE.pdf or FILE.png",
         "FILE"},
        {"json", '\0', OPTION_FLAG, &asked.json, "Print JSON, in SI, with the rows of all series",
         NULL},
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        asked.options.refine = refine != 0;
        if (line.count != 2) {
            command_complain("compare requires %s; see launchdyn compare --help", self->arguments);
            code = EXIT_INPUT;
        } else {
            code = compare(&line, &asked);
        }
        options_end(&line);
    }
    return code;
}
