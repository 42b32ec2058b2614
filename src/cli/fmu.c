// launchdyn fmu export: a Functional Mock-up Unit of a launch or of a part of it, or both parts in
// an archive.
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "launchdyn/fmu.h"
#include "launchdyn/scenario.h"

typedef struct wishes {
    ld_fmu_options options; // its version 0: the usual one
    bool system;            // vehicle and launcher in an archive of SSP
    const char *out;
} wishes;

static int export(const ld_model *model, void *data)
{
    const wishes *self = data;
    ld_error error;
    ld_fmu_options options = self->options;
    if (options.version == 0)
        options.version = self->system ? 2 : 3; // tools for SSP 1.0 know FMI 2 alone
    ld_status status =
        (self->system ? ld_ssp_export : ld_fmu_export)(model, &options, self->out, &error);
    if (!status)
        command_step("wrote %s", self->out);
    return status ? command_fail_on(model, status, &error) : 0;
}

// The part of that name, as ld_fmu_part counts them; false, and a message: there is none.
static bool find_part(const char *name, ld_fmu_part *part)
{
    static const char *const names[] = {"all", "vehicle", "launcher"};
    enum { PARTS = sizeof names / sizeof *names };
    for (int i = 0; i < PARTS; i++)
        if (strcmp(name, names[i]) == 0) {
            *part = (ld_fmu_part)i;
            return true;
        }
    const char *nearest = ld_nearest_name(name, names, PARTS);
    command_complain("--part: found \"%s\", expected all, vehicle or launcher%s%s%s", name,
                     nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                     nearest ? "\"?" : "");
    return false;
}

int command_fmu(const command *self, int argc, char **argv)
{
    char **sets = NULL, *out = NULL, *part = NULL, *archive = NULL;
    char *outputs = NULL, *parameters = NULL;
    int arrays = 0;
    wishes what = {0};
    const command_option options[] = {
        COMMAND_SETS(&sets),
        {"part", '\0', OPTION_TEXT, &part, "Part of the model to export (all)",
         "all|vehicle|launcher"},
        {"fmi", '\0', OPTION_INTEGER, &what.options.version, "Version of FMI (3; for --ssp 2)",
         "2|3"},
        {"outputs", '\0', OPTION_TEXT, &outputs,
         "Outputs that it has, * for any letters: tip.*,summary.* (all)", "NAME,..."},
        {"parameters", '\0', OPTION_TEXT, &parameters,
         "Parameters that it has, likewise by key: rocket.* (all)", "KEY,..."},
        {"arrays", '\0', OPTION_FLAG, &arrays, "Vectors are one variable each (FMI 3)", NULL},
        {"out", 'o', OPTION_TEXT, &out, "File of the FMU", "FILE"},
        {"ssp", '\0', OPTION_TEXT, &archive,
         "Write vehicle and launcher as an SSP archive in place of an FMU", "FILE"},
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        what.out = archive ? archive : out;
        what.system = archive != NULL;
        what.options.outputs = outputs;
        what.options.parameters = parameters;
        what.options.arrays = arrays != 0;
        if (line.count != 2 || strcmp(line.word[0], "export") != 0 || !what.out) {
            command_complain(
                "fmu requires export FILE and --out FILE or --ssp FILE; see launchdyn fmu --help");
            code = EXIT_INPUT;
        } else if (archive && (out || part)) {
            command_complain("--ssp exports both parts; it excludes --out and --part");
            code = EXIT_INPUT;
        } else if (part && !find_part(part, &what.options.part)) {
            code = EXIT_INPUT;
        } else {
            code = command_on_file(line.word[1], sets, export, &what);
        }
        options_end(&line);
    }
    return code;
}
