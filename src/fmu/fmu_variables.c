#include "fmu/fmu_variables.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"
#include "launchdyn/version.h"
#include "model/digest.h"

#define KEY_PREFIX "scenario."

enum { NAME_SIZE = 256, TEXT_SIZE = 1024, MOST_MEMBERS = 64 };

void fmu_variables_free(fmu_variables *self)
{
    for (size_t i = 0; i < self->count; i++) {
        fmu_variable *v = &self->item[i];
        free(v->name);
        free(v->unit);
        free(v->description);
        free(v->text);
    }
    free(self->item);
    *self = (fmu_variables){0};
}

bool fmu_is_boolean(const fmu_variable *variable)
{
    return variable->group == FMU_IGNITE || variable->group == FMU_WAIT;
}

bool fmu_is_text(const fmu_variable *variable)
{
    return variable->group == FMU_TEXT;
}

bool fmu_is_input(const fmu_variable *variable)
{
    return variable->group == FMU_BASE || variable->group == FMU_IGNITE;
}

bool fmu_is_parameter(const fmu_variable *variable)
{
    return variable->group >= FMU_WAIT && variable->group <= FMU_TEXT;
}

bool fmu_is_output(const fmu_variable *variable)
{
    return variable->group >= FMU_WRENCH;
}

const char *fmu_key_of(const fmu_variable *variable)
{
    return variable->name + strlen(KEY_PREFIX);
}

void fmu_token(const char *scenario, size_t length, char token[FMU_TOKEN_SIZE])
{
    uint64_t digest = digest_bytes(DIGEST_BEGIN, ld_version(), strlen(ld_version()));
    snprintf(token, FMU_TOKEN_SIZE, "{launchdyn-%016" PRIx64 "}",
             digest_bytes(digest, scenario, length));
}

ld_run *fmu_run_begin(const ld_simulation *simulation, bool external, const ld_base_frame *base,
                      ld_error *error)
{
    ld_run *run;
    ld_run_options options = {.base = external ? base : NULL};
    if (!ld_run_begin(simulation, &options, &run, error))
        return run;
    if (run)
        ld_run_end(run, NULL, NULL);
    return NULL;
}

ld_base_frame fmu_base_at_origin(void)
{
    return (ld_base_frame){.quaternion = {1, 0, 0, 0}};
}

// ---- gathering ----

// What is gathered into, and whether there was room for it.
typedef struct gathering {
    fmu_variables *into;
    const ld_model *model;
    fmu_group keys; // which group of keys is taken
    int index;      // of the next one in its group
    bool full;
} gathering;

static char *copy_of(const char *text, bool *full)
{
    char *copy = strdup(text ? text : "");
    *full |= !copy;
    return copy;
}

static void add(gathering *self, fmu_group group, const char *name, const char *unit,
                const char *description, double start, const char *text)
{
    fmu_variables *list = self->into;
    if (list->count == list->capacity) {
        size_t capacity = list->capacity ? 2 * list->capacity : 256;
        fmu_variable *item = realloc(list->item, capacity * sizeof *item);
        if (!item) {
            self->full = true;
            return;
        }
        list->item = item;
        list->capacity = capacity;
    }
    list->item[list->count++] = (fmu_variable){.group = group,
                                               .index = self->index++,
                                               .name = copy_of(name, &self->full),
                                               .unit = copy_of(unit, &self->full),
                                               .description = copy_of(description, &self->full),
                                               .start = start,
                                               .text = text ? copy_of(text, &self->full) : NULL};
}

static void begin_group(gathering *self)
{
    self->index = 0;
}

static void add_base(gathering *self)
{
    static const char *const part[FMU_BASE_INPUTS] = {
        "position.x",   "position.y",   "position.z", "quaternion.0", "quaternion.1",
        "quaternion.2", "quaternion.3", "velocity.x", "velocity.y",   "velocity.z",
        "rate.x",       "rate.y",       "rate.z"};
    static const char *const unit[] = {"m", "", "m/s", "rad/s"};
    static const char *const about[] = {"Rear end of the undeformed tube, in I",
                                        "Axes of the undeformed tube against I, scalar first",
                                        "Velocity of that rear end, in I",
                                        "Angular velocity of the base, in I"};
    for (int i = 0; i < FMU_BASE_INPUTS; i++) {
        char name[NAME_SIZE];
        int kind = i < 3 ? 0 : i < 7 ? 1 : i < 10 ? 2 : 3;
        snprintf(name, sizeof name, "input.base.%s", part[i]);
        add(self, FMU_BASE, name, unit[kind], about[kind], i == 3, NULL);
    }
}

static void add_wrench(gathering *self)
{
    static const char axis[] = "xyz";
    for (int i = 0; i < FMU_WRENCH_OUTPUTS; i++) {
        char name[NAME_SIZE];
        snprintf(name, sizeof name, "wrench.%s.%c", i < 3 ? "force" : "moment", axis[i % 3]);
        add(self, FMU_WRENCH, name, i < 3 ? "N" : "N.m",
            i < 3 ? "Force of the tube on its base, in I"
                  : "Moment of the tube on its base about the undeformed tube's rear end, in I",
            NAN, NULL);
    }
}

// The key at `path`, if the model has it and it is of the group that is taken.
static void add_key(gathering *self, const char *path, const ld_key *key)
{
    char name[NAME_SIZE + sizeof KEY_PREFIX], text[TEXT_SIZE];
    double number;
    bool is_number = !ld_model_number(self->model, path, &number, NULL);
    snprintf(name, sizeof name, KEY_PREFIX "%s", path);
    if (self->keys == FMU_NUMBER && is_number && !isnan(number))
        add(self, FMU_NUMBER, name, key->unit, key->description, number, NULL);
    else if (self->keys == FMU_TEXT && !is_number &&
             !ld_model_text(self->model, path, text, sizeof text, NULL) && *text)
        add(self, FMU_TEXT, name, "", key->description, NAN, text);
}

// Keys that say what a study draws are none of a launch; the first one is the language's number.
static bool is_of_launch(const char *path)
{
    return strcmp(path, "launchdyn") != 0 && strncmp(path, "scatter", 7) != 0 &&
           strncmp(path, "sweep", 5) != 0;
}

static void take_key(void *data, const ld_key *key)
{
    gathering *self = data;
    char path[NAME_SIZE];
    const char *member = strstr(key->path, ".N.");
    if (!is_of_launch(key->path))
        return;
    if (!member) {
        add_key(self, key->path, key);
        return;
    }
    for (int i = 1; i <= MOST_MEMBERS; i++) {
        snprintf(path, sizeof path, "%.*s.%d.%s", (int)(member - key->path), key->path, i,
                 member + 3);
        add_key(self, path, key);
    }
}

static void take_result(void *data, const ld_quantity *quantity)
{
    gathering *self = data;
    char name[NAME_SIZE];
    if (strncmp(quantity->name, "rocket.", 7) != 0)
        return;
    snprintf(name, sizeof name, "summary.%s", quantity->name);
    add(self, FMU_RESULT, name, quantity->unit, quantity->description, NAN, NULL);
}

// Numbers of the summary are told by one of a run that has begun.
static ld_status add_results(gathering *self, const ld_simulation *simulation, ld_error *error)
{
    ld_base_frame base = fmu_base_at_origin();
    ld_run *run = fmu_run_begin(simulation, self->into->external, &base, error);
    if (!run)
        return error->status;
    self->into->start = ld_run_time(run);
    ld_summary_each(ld_run_summary(run), take_result, self);
    ld_run_end(run, NULL, NULL);
    return LD_OK;
}

static bool is_external(const ld_model *model)
{
    char kind[32];
    return !ld_model_text(model, "base.kind", kind, sizeof kind, NULL) &&
           strcmp(kind, "external") == 0;
}

ld_status fmu_variables_make(const ld_model *model, const ld_simulation *simulation,
                             fmu_variables *self, ld_error *error)
{
    const ld_column *column;
    *self = (fmu_variables){0};
    gathering all = {.into = self, .model = model};
    if (!ld_model_has_launcher(model))
        return ld_fail(error, LD_ERR_INPUT, "a flight alone has no launcher that could be stepped");

    add(&all, FMU_TIME, "time", "s", "Time", NAN, NULL);
    begin_group(&all);
    self->external = is_external(model);
    if (self->external)
        add_base(&all);
    begin_group(&all);
    add(&all, FMU_IGNITE, "input.ignition", "", "Lights the waiting rocket when it becomes true", 0,
        NULL);
    begin_group(&all);
    add(&all, FMU_WAIT, "ignition_by_input", "",
        "No rocket is lit at its time in the scenario, but by input.ignition alone", 0, NULL);
    for (fmu_group keys = FMU_NUMBER; keys <= FMU_TEXT; keys++) {
        begin_group(&all);
        all.keys = keys;
        ld_scenario_keys(take_key, &all);
    }
    begin_group(&all);
    add_wrench(&all);
    begin_group(&all);
    size_t columns = ld_simulation_columns(simulation, &column);
    for (size_t i = 0; i < columns; i++)
        if (strcmp(column[i].name, "t") != 0)
            add(&all, FMU_COLUMN, column[i].name, column[i].unit, column[i].description, NAN, NULL);
        else
            all.index++;
    begin_group(&all);
    ld_status status = add_results(&all, simulation, error);
    return status || !all.full ? status : ld_fail(error, LD_ERR_MEMORY, "no memory");
}
