// launchdyn fmu export: a Functional Mock-up Unit of a launch.
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "launchdyn/fmu.h"
#include "launchdyn/scenario.h"

typedef struct wishes {
    ld_fmu_part part;
    int version;
    const char *out;
} wishes;

static int export(const ld_model *model, void *data)
{
    const wishes *self = data;
    ld_error error;
    ld_status status = ld_fmu_export(model, self->part, self->version, self->out, &error);
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
    command_complain("--part is all, vehicle or launcher, not \"%s\"%s%s%s", name,
                     nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                     nearest ? "\"?" : "");
    return false;
}

int command_fmu(const command *self, int argc, char **argv)
{
    char **sets = NULL, *out = NULL, *part = NULL;
    wishes what = {.version = 3};
    const command_option options[] = {
        COMMAND_SETS(&sets),
        {"part", '\0', OPTION_TEXT, &part, "all, the vehicle alone, or the launcher alone (all)",
         "PART"},
        {"fmi", '\0', OPTION_INTEGER, &what.version, "Version of FMI: 2 or 3 (3)", "N"},
        {"out", 'o', OPTION_TEXT, &out, "The FMU", "FILE"},
        COMMAND_HELP,
        COMMAND_END};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, COMMAND_WORDS, &code)) {
        what.out = out;
        if (line.count != 2 || strcmp(line.word[0], "export") != 0 || !out) {
            command_complain("fmu wants export FILE and --out FILE; see launchdyn fmu --help");
            code = EXIT_INPUT;
        } else if (part && !find_part(part, &what.part)) {
            code = EXIT_INPUT;
        } else {
            code = command_on_file(line.word[1], sets, export, &what);
        }
        options_end(&line);
    }
    return code;
}
