// launchdyn check: what is wrong with a scenario, or what was understood.
#include <stdio.h>

#include "cli/command.h"
#include "launchdyn/scenario.h"

typedef struct check_wishes {
    const char *file;
    char **sets;
} check_wishes;

// Prints the model, or what is wrong with the first point of its sweep that is not good.
static int check_points(const ld_model *model, void *data)
{
    const check_wishes *wishes = data;
    int points = model->sweep_count > 0 ? ld_scenario_points(model) : 0;
    for (int point = 1; point <= points; point++) {
        ld_model one;
        if (command_read(wishes->file, wishes->sets, point, &one)) {
            char name[256];
            ld_scenario_point_name(model, point, name, sizeof name);
            command_complain("this is point %d of the sweep: %s", point, name);
            return EXIT_INPUT;
        }
        ld_model_free(&one);
    }
    ld_model_print(model, stdout);
    return 0;
}

int command_check(const command *self, int argc, const char **argv)
{
    check_wishes wishes = {0};
    const struct poptOption options[] = {COMMAND_SETS(&wishes.sets), COMMAND_HELP, COMMAND_END};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, 1, &code)) {
        wishes.file = line.word[0];
        code = command_on_file(wishes.file, wishes.sets, check_points, &wishes);
        command_line_end(&line);
    }
    command_free_sets(wishes.sets);
    return code;
}
