// launchdyn check: what is wrong with a scenario, or what was understood.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "launchdyn/output.h"
#include "launchdyn/run.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"

enum { MOST_STARTS = 32 }; // of a sweep: they take most of the time

typedef struct check_wishes {
    char **sets;
    int strict, json;
} check_wishes;

// What a check has found: a status, and either messages or, where none is about a key, an error.
typedef struct findings {
    ld_status status;
    ld_messages errors, notes;
    ld_error error;
    bool refused; // its warnings are errors
    int point;    // of the sweep, at which it is wrong; 0: none
    char *bodies; // of a multibody base, in words; NULL: not known
} findings;

// Of the scenario itself, in a sweep.
static void describe_bodies(const ld_simulation *simulation, findings *found)
{
    size_t length = 0;
    FILE *stream = found->bodies ? NULL : ld_text_open(&found->bodies, &length);
    if (!stream)
        return;
    ld_simulation_describe(simulation, stream);
    ld_text_close(stream);
}

// Whether a run can begin: all that it does before its first step. Where a base is that a program
// reports is not known yet.
static void check_start(const ld_model *model, findings *found)
{
    ld_simulation *simulation = NULL;
    ld_run *run = NULL;
    char kind[16];
    found->status = ld_simulation_create(model, &simulation, &found->error);
    bool told = !ld_model_text(model, "base.kind", kind, sizeof kind, NULL) &&
                strcmp(kind, "external") == 0;
    if (!found->status && !told)
        found->status = ld_run_begin(simulation, NULL, &run, &found->error);
    ld_run_end(run, NULL, NULL);
    if (!found->status)
        describe_bodies(simulation, found);
    ld_simulation_free(simulation);
    if (found->status)
        ld_scenario_explain(model, &found->error, &found->errors);
    else
        command_step("found the initial state");
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
static void check_point(const ld_model *model, int point, bool start, findings *found)
{
    ld_model *one = NULL;
    found->status = ld_scenario_read_source(ld_model_source(model), point, &one, &found->errors);
    if (!found->status && start)
        check_start(one, found);
    ld_model_free(one);
    found->point = found->status ? point : 0;
}

// All points, to the first one that is not good.
static void check_points(const ld_model *model, findings *found)
{
    int points = ld_scenario_axes(model) > 0 ? ld_scenario_points(model) : 0;
    check_start(model, found);
    for (int point = 1, starts = 0; point <= points && !found->status; point++) {
        bool start = starts < MOST_STARTS && is_corner(model, point);
        starts += start;
        check_point(model, point, start, found);
    }
}

// Warnings on all points; where one of them is wrong, none.
static void take_notes(const ld_model *model, bool strict, findings *found)
{
    int points = ld_scenario_axes(model) > 0 ? ld_scenario_points(model) : 0;
    ld_status status = ld_scenario_notes(ld_model_source(model), 0, points, &found->notes);
    if (status) {
        ld_messages_free(&found->notes);
        found->notes = (ld_messages){0};
    }
    found->refused = strict && found->notes.count > 0;
    found->status = found->refused ? LD_ERR_INPUT : status == LD_ERR_INPUT ? LD_OK : status;
}

// Reads and checks; NULL where the scenario cannot be read.
static ld_model *check_file(const char *file, const check_wishes *wishes, findings *found)
{
    ld_model *model = NULL;
    found->status = command_read_file(file, wishes->sets, &model, &found->errors);
    if (!found->status)
        take_notes(model, wishes->strict != 0, found);
    if (!found->status)
        check_points(model, found);
    return model;
}

static void print_text(const ld_model *model, const findings *found)
{
    if (found->refused)
        ld_messages_print(&found->notes, stderr);
    else if (!command_is_quiet())
        ld_notes_print(&found->notes, stderr);
    if (found->errors.count > 0)
        ld_messages_print(&found->errors, stderr);
    else if (found->status && !found->refused)
        command_fail(found->status, &found->error);
    if (found->status || command_is_quiet())
        return;
    ld_model_describe(model, stdout);
    if (found->bodies)
        fputs(found->bodies, stdout);
    ld_model_print(model, stdout);
}

// As one document, also what is wrong.
static void print_json(const ld_model *model, findings *found)
{
    char none[] = "";
    ld_message alone = {none, 0, 0, none, found->error.text, none};
    const ld_messages *errors = found->refused ? &found->notes : &found->errors;
    if (found->status && errors->count == 0)
        errors = &(ld_messages){1, &alone};
    ld_status status =
        ld_check_print_json(found->status ? NULL : model, errors,
                            found->refused ? NULL : &found->notes, stdout, &found->error);
    if (status)
        found->status = status;
}

int command_check(const command *self, int argc, char **argv)
{
    check_wishes wishes = {0};
    const command_option options[] = {
        COMMAND_SETS(&wishes.sets),
        COMMAND_STRICT(&wishes.strict),
        {"json", '\0', OPTION_FLAG, &wishes.json,
         "Print the scenario in SI, the warnings and the errors as JSON", NULL},
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (!command_line_read(&line, self, argc, argv, options, &code))
        return code;
    findings found = {.error = {LD_ERR_MEMORY, "no memory"}};
    ld_model *model = check_file(line.word[0], &wishes, &found);
    if (wishes.json)
        print_json(model, &found);
    else
        print_text(model, &found);
    if (found.point > 0) {
        char name[256];
        ld_scenario_point_name(model, found.point, name, sizeof name);
        command_complain("the error is in point %d of the sweep: %s", found.point, name);
    }
    code = command_code(found.status);
    ld_messages_free(&found.errors);
    ld_messages_free(&found.notes);
    ld_free(found.bodies);
    ld_model_free(model);
    options_end(&line);
    return code;
}
