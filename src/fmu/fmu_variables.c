#include "fmu/fmu_variables.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"
#include "launchdyn/version.h"
#include "model/fields/digest.h"
#include "model/fields/field.h"
#include "model/parts.h"
#include "quantities/summary.h"
#include "quantities/summary_quantities.h"
#include "systems/launching/launcher.h"

#define KEY_PREFIX "scenario."

enum { NAME_SIZE = 256, TEXT_SIZE = 1024, MOST_MEMBERS = 64 };

void fmu_variable_free(fmu_variable *self)
{
    free(self->name);
    free(self->unit);
    free(self->description);
    free(self->text);
}

void fmu_variables_free(fmu_variables *self)
{
    for (size_t i = 0; i < self->count; i++)
        fmu_variable_free(&self->item[i]);
    free(self->item);
    free(self->order);
    free(self->array_order);
    *self = (fmu_variables){0};
}

// ---- value references ----

// FNV-1a of the name, folded to 31 bits: importers may keep references as signed numbers.
static unsigned reference_of(const char *name)
{
    uint64_t digest = digest_bytes(DIGEST_BEGIN, name, strlen(name));
    return (unsigned)(digest ^ digest >> 32) & 0x7fffffff;
}

typedef struct reference_place {
    unsigned reference;
    size_t place;
} reference_place;

static int compare_references(const void *a, const void *b)
{
    const reference_place *x = a, *y = b;
    if (x->reference != y->reference)
        return x->reference < y->reference ? -1 : 1;
    return x->place < y->place ? -1 : 1;
}

// The next that is free, where the one before has it.
static void pass_former(reference_place *by, size_t i)
{
    if (i > 0 && by[i].reference <= by[i - 1].reference)
        by[i].reference = by[i - 1].reference + 1;
}

static void refer_variables(fmu_variables *self, reference_place *by)
{
    for (size_t i = 0; i < self->count; i++)
        by[i] = (reference_place){reference_of(self->item[i].name), i};
    qsort(by, self->count, sizeof *by, compare_references);
    for (size_t i = 0; i < self->count; i++) {
        pass_former(by, i);
        self->order[i] = by[i].place;
        self->item[by[i].place].reference = by[i].reference;
    }
}

// After the variables, which keep theirs.
static void refer_arrays(fmu_variables *self, reference_place *by)
{
    char name[FMU_ARRAY_NAME];
    size_t count = 0;
    for (size_t i = 0, length; i < self->count; i += length) {
        length = fmu_array_length(self, i);
        fmu_array_name(&self->item[i], name);
        if (length > 1)
            by[count++] = (reference_place){reference_of(name), i};
    }
    qsort(by, count, sizeof *by, compare_references);
    for (size_t i = 0; i < count; i++) {
        pass_former(by, i);
        while (fmu_variables_find(self, by[i].reference) < self->count)
            by[i].reference++;
        self->array_order[i] = by[i].place;
        self->item[by[i].place].array = by[i].reference;
    }
    self->array_count = count;
}

bool fmu_variables_refer(fmu_variables *self)
{
    reference_place *by = malloc((1 + self->count) * sizeof *by);
    free(self->order);
    free(self->array_order);
    self->order = malloc((1 + self->count) * sizeof *self->order);
    self->array_order = malloc((1 + self->count) * sizeof *self->array_order);
    bool fine = by && self->order && self->array_order;
    if (fine) {
        refer_variables(self, by);
        refer_arrays(self, by);
    }
    free(by);
    return fine;
}

static unsigned own_reference(const fmu_variable *one)
{
    return one->reference;
}

static unsigned array_reference(const fmu_variable *one)
{
    return one->array;
}

// Among `count` places in the order of those references.
static size_t find(const fmu_variables *self, const size_t *order, size_t count,
                   unsigned reference_of_one(const fmu_variable *), unsigned reference)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (reference_of_one(&self->item[order[middle]]) < reference)
            low = middle + 1;
        else
            high = middle;
    }
    bool found = low < count && reference_of_one(&self->item[order[low]]) == reference;
    return found ? order[low] : self->count;
}

size_t fmu_variables_find(const fmu_variables *self, unsigned reference)
{
    return find(self, self->order, self->count, own_reference, reference);
}

size_t fmu_variables_find_array(const fmu_variables *self, unsigned reference)
{
    return find(self, self->array_order, self->array_count, array_reference, reference);
}

// ---- arrays ----

// Where the letter stands that says which element it is: "tip.y", "der(state.tube.rate.y)". NULL:
// nowhere.
static const char *element_letter(const char *name)
{
    size_t length = strlen(name);
    if (length > 0 && name[length - 1] == ')')
        length--;
    return length > 2 && name[length - 2] == '.' ? name + length - 1 : NULL;
}

// Whether the variable is element `i`, by those letters, of the array that `first` begins.
static bool continues_array(const fmu_variable *first, const fmu_variable *v, int i,
                            const char *letters)
{
    const char *letter = element_letter(first->name);
    size_t before = (size_t)(letter - first->name);
    return v->group == first->group && v->index == first->index + i && fmu_type_of(v) == FMU_REAL &&
           strcmp(v->unit, first->unit) == 0 && v->nominal == first->nominal &&
           isnan(v->start) == isnan(first->start) && strlen(v->name) == strlen(first->name) &&
           strncmp(v->name, first->name, before) == 0 && v->name[before] == letters[i] &&
           strcmp(v->name + before + 1, letter + 1) == 0;
}

size_t fmu_array_length(const fmu_variables *self, size_t place)
{
    const fmu_variable *first = &self->item[place];
    const char *letter = element_letter(first->name);
    if (!letter || (*letter != 'x' && *letter != '0'))
        return 1;
    const char *letters = *letter == 'x' ? "xyz" : "0123";
    size_t length = strlen(letters);
    for (size_t i = 0; i < length; i++)
        if (place + i >= self->count || !continues_array(first, first + i, (int)i, letters))
            return 1;
    return length;
}

void fmu_array_name(const fmu_variable *first, char name[FMU_ARRAY_NAME])
{
    const char *letter = element_letter(first->name);
    int before = letter ? (int)(letter - first->name) - 1 : 0;
    snprintf(name, FMU_ARRAY_NAME, "%.*s%s", before, first->name, letter ? letter + 1 : "");
}

// ---- kinds ----

fmu_type fmu_type_of(const fmu_variable *variable)
{
    bool truth = variable->group == FMU_IGNITE || variable->group == FMU_WAIT;
    return truth                         ? FMU_BOOLEAN
           : variable->group == FMU_TEXT ? FMU_STRING
           : variable->whole             ? FMU_INTEGER
                                         : FMU_REAL;
}

bool fmu_is_input(const fmu_variable *variable)
{
    return variable->group == FMU_PART_INPUT || variable->group == FMU_IGNITE;
}

bool fmu_is_parameter(const fmu_variable *variable)
{
    return variable->group >= FMU_WAIT && variable->group <= FMU_TEXT;
}

bool fmu_is_output(const fmu_variable *variable)
{
    return variable->group >= FMU_PART_OUTPUT && !fmu_is_local(variable);
}

bool fmu_is_local(const fmu_variable *variable)
{
    return variable->group >= FMU_STATE;
}

size_t fmu_group_begin(const fmu_variables *self, fmu_group group)
{
    size_t i = 0;
    while (i < self->count && self->item[i].group != group)
        i++;
    return i;
}

size_t fmu_group_count(const fmu_variables *self, fmu_group group)
{
    size_t count = 0;
    for (size_t i = 0; i < self->count; i++)
        count += self->item[i].group == group;
    return count;
}

const char *fmu_key_of(const fmu_variable *variable)
{
    return variable->name + strlen(KEY_PREFIX);
}

void fmu_token(const char *scenario, size_t length, ld_fmu_part part, char token[FMU_TOKEN_SIZE])
{
    const char *name = fmu_part_name(part);
    uint64_t digest = digest_bytes(DIGEST_BEGIN, ld_version(), strlen(ld_version()));
    if (part != LD_FMU_ALL)
        digest = digest_bytes(digest, name, strlen(name));
    snprintf(token, FMU_TOKEN_SIZE, "{launchdyn-%016" PRIx64 "}",
             digest_bytes(digest, scenario, length));
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

// The next variable of a group, with the number or the text that it starts with.
static void add(gathering *self, fmu_group group, ld_column of, double start, const char *text)
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
                                               .name = copy_of(of.name, &self->full),
                                               .unit = copy_of(of.unit, &self->full),
                                               .description = copy_of(of.description, &self->full),
                                               .start = start,
                                               .text = text ? copy_of(text, &self->full) : NULL};
}

static void begin_group(gathering *self)
{
    self->index = 0;
}

// Groups of the numbers that FMUs exchange, and what they are.
typedef struct exchanged {
    const char *name, *unit, *description;
    int count; // 3: x, y, z; 4: 0 to 3
} exchanged;

static const exchanged frame_parts[] = {
    {"position", "m", "Rear end of the undeformed tube, in I", 3},
    {"quaternion", "", "Axes of the undeformed tube against I, scalar first", 4},
    {"velocity", "m/s", "Velocity of that rear end, in I", 3},
    {"rate", "rad/s", "Angular velocity of the base, in I", 3},
};
static const exchanged wrench_parts[] = {
    {"force", "N", "Force of the tube on its base, in I", 3},
    {"moment", "N.m", "Moment of the tube on its base about the undeformed tube's rear end, in I",
     3},
};

// `start`: of each number; NULL: they are calculated.
static void add_exchanged(gathering *self, fmu_group group, const char *prefix,
                          const exchanged *part, int parts, const double *start)
{
    begin_group(self);
    for (int i = 0; i < parts; i++)
        for (int k = 0; k < part[i].count; k++) {
            char name[NAME_SIZE];
            snprintf(name, sizeof name, "%s.%s.%c", prefix, part[i].name,
                     (part[i].count == 3 ? "xyz" : "0123")[k]);
            add(self, group, (ld_column){name, part[i].unit, part[i].description},
                start ? start[self->index] : NAN, NULL);
        }
}

static void add_frame(gathering *self, fmu_group group, const char *prefix, const double *start)
{
    enum { PARTS = sizeof frame_parts / sizeof *frame_parts, QUATERNION = 1 };
    exchanged part[PARTS];
    memcpy(part, frame_parts, sizeof part);
    if (group == FMU_PART_INPUT)
        part[QUATERNION].description = "Axes of the undeformed tube against I, scalar first; all "
                                       "zero: not reported yet, the frame continues as it began";
    add_exchanged(self, group, prefix, part, PARTS, start);
}

static void add_wrench(gathering *self, fmu_group group, const char *prefix, const double *start)
{
    add_exchanged(self, group, prefix, wrench_parts, sizeof wrench_parts / sizeof *wrench_parts,
                  start);
}

// The number at `path`, of a key, if that is one, and if numbers are taken.
static bool add_number(gathering *self, const char *path, const ld_key *key)
{
    char name[NAME_SIZE + sizeof KEY_PREFIX + 2], why[LD_ERROR_TEXT];
    field_place place;
    if (!field_locate(self->model, path, &place, why, sizeof why))
        return false;
    double number = field_get(self->model, &place);
    if (self->keys != FMU_NUMBER || isnan(number))
        return true;
    snprintf(name, sizeof name, KEY_PREFIX "%s", path);
    add(self, FMU_NUMBER, (ld_column){name, key->unit, key->description}, number, NULL);
    if (!self->full)
        self->into->item[self->into->count - 1].whole = place.whole;
    return true;
}

static void add_text(gathering *self, const char *path, const ld_key *key)
{
    char name[NAME_SIZE + sizeof KEY_PREFIX], text[TEXT_SIZE];
    if (ld_model_text(self->model, path, text, sizeof text, NULL) || !*text)
        return;
    snprintf(name, sizeof name, KEY_PREFIX "%s", path);
    add(self, FMU_TEXT, (ld_column){name, "", key->description}, NAN, text);
}

// The key at `path`, a vector by its components, if the model has it and it is of the group that is
// taken.
static void add_key(gathering *self, const char *path, const ld_key *key)
{
    char component[NAME_SIZE + 2];
    bool numeric = add_number(self, path, key);
    for (const char *axis = numeric ? "" : "wxyz"; *axis; axis++) {
        snprintf(component, sizeof component, "%.*s.%c", NAME_SIZE - 1, path, *axis);
        numeric |= add_number(self, component, key);
    }
    if (self->keys == FMU_TEXT && !numeric)
        add_text(self, path, key);
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

static void take_result(void *data, const ld_quantity *result)
{
    gathering *self = data;
    char name[NAME_SIZE];
    // a run that is stepped estimates no errors
    if (strncmp(result->name, "rocket.", 7) != 0 ||
        strncmp(result->name, "rocket.exit_error.", 18) == 0)
        return;
    snprintf(name, sizeof name, "summary.%s", result->name);
    add(self, FMU_RESULT, (ld_column){name, result->unit, result->description}, NAN, NULL);
}

static void add_states(gathering *self, const void *run)
{
    const fmu_exchanging *by = self->into->runner->exchanging;
    double nominal[LD_MAX_STATES];
    char name[NAME_SIZE];
    int count = by->states(run);
    by->nominals(run, nominal);
    begin_group(self);
    for (int i = 0; i < count && !self->full; i++) {
        const exchange_quantity state = by->state(run, i);
        snprintf(name, sizeof name, "state.%s", state.name);
        add(self, FMU_STATE, (ld_column){name, state.unit, state.description}, NAN, NULL);
        if (!self->full)
            self->into->item[self->into->count - 1].nominal = nominal[i];
    }
    begin_group(self);
    for (int i = 0; i < count; i++) {
        const exchange_quantity state = by->state(run, i);
        snprintf(name, sizeof name, "der(state.%s)", state.name);
        add(self, FMU_RATE, (ld_column){name, state.rate_unit, "Its rate"}, NAN, NULL);
    }
    begin_group(self);
    for (int i = 0; i < by->indicators(run); i++) {
        const exchange_quantity indicator = by->indicator(run, i);
        snprintf(name, sizeof name, "indicator.%s", indicator.name);
        add(self, FMU_INDICATOR, (ld_column){name, indicator.unit, indicator.description}, NAN,
            NULL);
    }
}

// Of all rockets, of which those that come later have no numbers yet.
static void add_results(gathering *self, const ld_summary *started)
{
    ld_summary *summary = malloc(sizeof *summary);
    if (!summary) {
        self->full = true;
        return;
    }
    *summary = *started;
    for (; summary->rocket_count < model_firing_count(self->model); summary->rocket_count++)
        rocket_clear(&summary->rocket[summary->rocket_count], true);
    begin_group(self);
    ld_summary_each(summary, take_result, self);
    free(summary);
}

static void add_keys(gathering *self)
{
    for (fmu_group keys = FMU_NUMBER; keys <= FMU_TEXT; keys++) {
        begin_group(self);
        self->keys = keys;
        ld_scenario_keys(take_key, self);
    }
}

static void add_columns(gathering *self, const ld_simulation *simulation)
{
    const ld_column *column;
    size_t columns = self->into->runner->columns(simulation, &column);
    begin_group(self);
    for (size_t i = 0; i < columns; i++)
        if (strcmp(column[i].name, "t") != 0)
            add(self, FMU_COLUMN, column[i], NAN, NULL);
        else
            self->index++;
}

static void add_inputs(gathering *self, const double *start)
{
    if (self->into->runner == &fmu_vehicle)
        add_wrench(self, FMU_PART_INPUT, "input.wrench", start);
    else if (self->into->runner->input_count > 0)
        add_frame(self, FMU_PART_INPUT, "input.base", start);
}

static void add_outputs(gathering *self)
{
    if (self->into->runner == &fmu_vehicle)
        add_frame(self, FMU_PART_OUTPUT, "base", NULL);
    else
        add_wrench(self, FMU_PART_OUTPUT, "wrench", NULL);
}

static void add_ignition(gathering *self)
{
    if (!self->into->runner->ignite)
        return;
    begin_group(self);
    add(self, FMU_IGNITE,
        (ld_column){"input.ignition", "", "Ignites the waiting rocket when it becomes true"}, 0,
        NULL);
    begin_group(self);
    add(self, FMU_WAIT,
        (ld_column){"ignition_by_input", "",
                    "Rockets are ignited by input.ignition, not at their times in the scenario"},
        0, NULL);
}

ld_status fmu_variables_make(const fmu_part *part, const ld_model *model,
                             const ld_simulation *simulation, fmu_variables *self, ld_error *error)
{
    const fmu_runner *runner = fmu_part_runner(part->which, model);
    *self = (fmu_variables){.runner = runner, .stop = NAN};
    gathering all = {.into = self, .model = model};
    double inputs[FMU_MOST_NUMBERS];
    if (!ld_model_has_launcher(model))
        return ld_fail(error, LD_ERR_INPUT, "a scenario of flight only has no launcher to step");
    memcpy(inputs, part->start, sizeof inputs);
    void *run = runner->begin(simulation, inputs, error);
    if (!run)
        return error->status;
    self->start = runner->time(run);
    add(&all, FMU_TIME, (ld_column){"time", "s", "Time"}, NAN, NULL);
    add_inputs(&all, inputs);
    add_ignition(&all);
    add_keys(&all);
    add_outputs(&all);
    add_columns(&all, simulation);
    if (runner->summary)
        add_results(&all, runner->summary(run));
    self->exchange = !runner->exchanging->check || !runner->exchanging->check(simulation, error);
    if (self->exchange)
        add_states(&all, run);
    runner->end(run);
    all.full |= !fmu_variables_refer(self);
    return all.full ? ld_fail(error, LD_ERR_MEMORY, "no memory") : LD_OK;
}
