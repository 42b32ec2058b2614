// launchdyn check: what is wrong with a scenario, or what was understood.
#include <stdio.h>

#include "cli/command.h"
#include "launchdyn/scenario.h"

// Prints the model, or what is wrong with the first point of its sweep that is not good.
static int check_points(const ld_model *model, void *data)
{
    const int *strict = data;
    int points = ld_scenario_axes(model) > 0 ? ld_scenario_points(model) : 0;
    for (int point = 1; point <= points; point++) {
        ld_model *one;
        ld_status status = command_read_source(ld_model_source(model), point, &one);
        if (status) {
            char name[256];
            ld_scenario_point_name(model, point, name, sizeof name);
            command_complain("this is point %d of the sweep: %s", point, name);
            return command_code(status);
        }
        ld_model_free(one);
    }
    int code = command_take_notes(ld_model_source(model), 0, points, false, *strict != 0);
    if (!code)
        ld_model_print(model, stdout);
    return code;
}

int command_check(const command *self, int argc, char **argv)
{
    char **sets = NULL;
    int strict = 0;
    const command_option options[] = {COMMAND_SETS(&sets), COMMAND_STRICT(&strict), COMMAND_HELP,
                                      COMMAND_END};
    return command_on_model(self, argc, argv, options, &sets, check_points, &strict);
}
