// launchdyn check: what is wrong with a scenario, or what was understood.
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "launchdyn/run.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"

enum { MOST_STARTS = 32 }; // of a sweep: they take most of the time

// Whether a run can begin: all that it does before its first step. Where a base is that a program
// tells is not known yet.
static int check_start(const ld_model *model)
{
    ld_simulation *simulation = NULL;
    ld_run *run = NULL;
    ld_error error;
    char kind[16];
    ld_status status = ld_simulation_create(model, &simulation, &error);
    bool told = !ld_model_text(model, "base.kind", kind, sizeof kind, NULL) &&
                strcmp(kind, "external") == 0;
    if (!status && !told)
        status = ld_run_begin(simulation, NULL, &run, &error);
    ld_run_end(run, NULL, NULL);
    ld_simulation_free(simulation);
    return status ? command_fail_on(model, status, &error) : 0;
}

// Whether every axis of the sweep has its first or its last value there.
static bool is_corner(const ld_model *model, int point)
{
    int axes = ld_scenario_axes(model), last = ld_scenario_points(model);
    for (int axis = 0; axis < axes; axis++) {
        int value = ld_scenario_value(model, point, axis);
        if (value > 0 && value < ld_scenario_value(model, last, axis))
            return false;
    }
    return true;
}

// A point of the sweep; with `start`, whether its run can begin, too.
static int check_point(const ld_model *model, int point, bool start)
{
    ld_model *one = NULL;
    int code = command_code(command_read_source(ld_model_source(model), point, &one));
    if (!code && start)
        code = check_start(one);
    if (code) {
        char name[256];
        ld_scenario_point_name(model, point, name, sizeof name);
        command_complain("this is point %d of the sweep: %s", point, name);
    }
    ld_model_free(one);
    return code;
}

// Prints the model, or what is wrong with the first point of its sweep that is not good.
static int check_points(const ld_model *model, void *data)
{
    const int *strict = data;
    int points = ld_scenario_axes(model) > 0 ? ld_scenario_points(model) : 0;
    int code = command_take_notes(ld_model_source(model), 0, points, false, *strict != 0);
    if (!code)
        code = check_start(model);
    for (int point = 1, starts = 0; point <= points && !code; point++) {
        bool start = starts < MOST_STARTS && is_corner(model, point);
        starts += start;
        code = check_point(model, point, start);
    }
    if (!code) {
        ld_model_describe(model, stdout);
        ld_model_print(model, stdout);
    }
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
