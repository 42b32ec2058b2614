#include "fmu/fmu_instance.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/archive.h"
#include "base/numeric_locale.h"
#include "base/text_file.h"
#include "fmu/fmu_instance_own.h"
#include "fmu/fmu_source.h"
#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"
#include "model/fields/digest.h"

enum { PATH_SIZE = 4096, SET_SIZE = 2048, SAVED_TEXT = 1024, SCENARIO_BYTES = 64 << 20 };

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory");
}

// ---- model, simulation, run ----

void fmu_forget_outputs(fmu_instance *self)
{
    self->known.row = self->known.result = self->known.outputs = false;
}

void fmu_end_run(fmu_instance *self)
{
    if (self->run)
        self->variables.runner->end(self->run);
    self->run = NULL;
    fmu_forget_outputs(self);
}

static void release_model(fmu_instance *self)
{
    fmu_end_run(self);
    ld_simulation_free(self->simulation);
    ld_model_free(self->model);
    self->simulation = NULL;
    self->model = NULL;
}

// The first message of the reader in one sentence.
static ld_status first_message(const ld_messages *messages, ld_status status, ld_error *error)
{
    if (messages->count == 0)
        return ld_fail(error, status, "no memory");
    return ld_fail(error, status, "%s: %s", messages->item[0].path, messages->item[0].text);
}

// "path=value" of a parameter that was changed.
static void write_set(const fmu_instance *self, size_t i, char *set)
{
    const fmu_variable *v = &self->variables.item[i];
    if (fmu_type_of(v) == FMU_STRING)
        snprintf(set, SET_SIZE, "%s=%s", fmu_key_of(v), self->text[i]);
    else
        snprintf(set, SET_SIZE, "%s=%.17g %s", fmu_key_of(v), self->number[i], v->unit);
}

static bool is_set_key(const fmu_instance *self, size_t i)
{
    fmu_group group = self->variables.item[i].group;
    return self->changed[i] && (group == FMU_NUMBER || group == FMU_TEXT);
}

// What the parameters are now.
static uint64_t parameters_digest(const fmu_instance *self)
{
    uint64_t digest = digest_bytes(DIGEST_BEGIN, &self->tolerance, sizeof self->tolerance);
    for (size_t i = 0; i < self->variables.count; i++) {
        if (!is_set_key(self, i))
            continue;
        digest = digest_bytes(digest, &i, sizeof i);
        digest = digest_bytes(digest, &self->number[i], sizeof self->number[i]);
        if (self->text[i])
            digest = digest_bytes(digest, self->text[i], strlen(self->text[i]));
    }
    return digest;
}

static bool add_sets(const fmu_instance *self, ld_source *source)
{
    char set[SET_SIZE];
    bool fine = true;
    for (size_t i = 0; i < self->variables.count && fine; i++)
        if (is_set_key(self, i)) {
            write_set(self, i, set);
            fine = source_add_set(source, set);
        }
    if (fine && self->tolerance > 0) {
        snprintf(set, sizeof set, "run.tolerance=%.17g", self->tolerance);
        fine = source_add_set(source, set);
    }
    return fine;
}

static ld_status read_model(fmu_instance *self, ld_error *error)
{
    ld_messages messages = {0};
    ld_source *source = source_copy(self->source);
    if (!source)
        return no_memory(error);
    locale_t before = numeric_locale_enter();
    ld_status status = add_sets(self, source) ? LD_OK : no_memory(error);
    numeric_locale_leave(before);
    if (!status) {
        status = ld_scenario_read_source(source, 0, &self->model, &messages);
        if (status)
            first_message(&messages, status, error);
        else
            fmu_part_take(self->part.which, self->model);
        ld_messages_free(&messages);
    }
    source_free(source);
    return status;
}

// A model whose columns are others than those that the FMU has cannot be reported by it.
static ld_status check_columns(const fmu_instance *self, ld_error *error)
{
    const ld_column *column;
    size_t columns = self->variables.runner->columns(self->simulation, &column), found = 0;
    for (size_t i = 0; i < self->variables.count; i++) {
        const fmu_variable *v = &self->variables.item[i];
        if (v->group != FMU_COLUMN)
            continue;
        found++;
        if ((size_t)v->index >= columns || strcmp(column[v->index].name, v->name) != 0)
            return ld_fail(
                error, LD_ERR_INPUT,
                "with these parameters the output %s does not exist: export the FMU with them",
                v->name);
    }
    return found + 1 == columns ? LD_OK
                                : ld_fail(error, LD_ERR_INPUT,
                                          "with these parameters there are %zu columns for %zu "
                                          "outputs: export the FMU with them",
                                          columns, found + 1);
}

// Model and simulation with the parameters of now.
static ld_status build(fmu_instance *self, ld_error *error)
{
    uint64_t digest = parameters_digest(self);
    if (self->simulation && digest == self->built_with)
        return LD_OK;
    release_model(self);
    self->built_with = digest;
    ld_status status = read_model(self, error);
    if (!status)
        status = ld_simulation_create(self->model, &self->simulation, error);
    if (!status && self->variables.count > 0)
        status = check_columns(self, error);
    if (status)
        release_model(self);
    return status;
}

static double number_of(const fmu_instance *self, fmu_group group, int index)
{
    for (size_t i = 0; i < self->variables.count; i++)
        if (self->variables.item[i].group == group && self->variables.item[i].index == index)
            return self->number[i];
    return 0;
}

// What the inputs are that another FMU reports. At the start (`first`) what no one has set is what
// the run finds.
static void find_inputs(const fmu_instance *self, bool first, double inputs[FMU_MOST_NUMBERS])
{
    memcpy(inputs, self->part.start, FMU_MOST_NUMBERS * sizeof *inputs);
    for (size_t i = 0; i < self->variables.count; i++)
        if (self->variables.item[i].group == FMU_PART_INPUT && (self->changed[i] || !first))
            inputs[self->variables.item[i].index] = self->number[i];
}

// Whether this frame has not been reported, nor any before it: a quaternion of zeros, as importers
// have that begin every input at zero. Then the base is, and continues, as at the start.
static bool lacks_inputs(const fmu_instance *self, const double inputs[FMU_MOST_NUMBERS],
                         bool first)
{
    if (self->variables.runner->input_count != FMU_FRAME_NUMBERS || self->exchange.is)
        return false;
    for (int i = 3; i < 7; i++)
        if (inputs[i] != 0)
            return false;
    return first || memcmp((const char *)self->inputs, (const char *)self->part.start,
                           sizeof self->inputs) == 0;
}

// The inputs are what the run has begun with.
static void keep_inputs(fmu_instance *self)
{
    for (size_t i = 0; i < self->variables.count; i++)
        if (self->variables.item[i].group == FMU_PART_INPUT)
            self->number[i] = self->inputs[self->variables.item[i].index];
}

// An importer that takes the steps is where the run is, which has just begun or come back.
static void take_place(fmu_instance *self)
{
    self->exchange.moved = false;
    if (!self->exchange.is)
        return;
    self->exchange.t = self->variables.runner->time(self->run) + self->ahead;
    self->variables.runner->exchanging->get_state(self->run, self->exchange.x);
}

// It is the importer's, and over.
static bool stands_still(const fmu_instance *self)
{
    return self->exchange.is && self->variables.runner->is_finished(self->run);
}

static ld_status fill(int count, double value, double *values)
{
    for (int i = 0; i < count; i++)
        values[i] = value;
    return LD_OK;
}

ld_status fmu_rates(fmu_instance *self, double *rates, ld_error *error)
{
    return stands_still(self)
               ? fill(self->variables.runner->exchanging->states(self->run), 0, rates)
               : self->variables.runner->exchanging->rates(self->run, rates, error);
}

ld_status fmu_indicators(fmu_instance *self, double *values, ld_error *error)
{
    return stands_still(self)
               ? fill(self->variables.runner->exchanging->indicators(self->run), 1, values)
               : self->variables.runner->exchanging->values(self->run, values, error);
}

ld_status fmu_place(fmu_instance *self, ld_error *error)
{
    double inputs[FMU_MOST_NUMBERS];
    if (!self->exchange.is || !self->exchange.moved || stands_still(self))
        return LD_OK;
    find_inputs(self, false, inputs);
    self->exchange.moved = false;
    fmu_forget_outputs(self);
    return self->variables.runner->exchanging->set_state(self->run, self->exchange.t - self->ahead,
                                                         self->exchange.x, inputs, error);
}

ld_status fmu_begin(fmu_instance *self, ld_error *error)
{
    const fmu_runner *runner = self->variables.runner;
    if (self->run)
        return LD_OK;
    ld_status status = build(self, error);
    if (status)
        return status;
    find_inputs(self, true, self->inputs);
    if (lacks_inputs(self, self->inputs, true))
        memcpy(self->inputs, self->part.start, sizeof self->inputs);
    self->run = (self->exchange.is ? runner->exchanging->begin
                                   : runner->begin)(self->simulation, self->inputs, error);
    if (!self->run)
        return error->status;
    keep_inputs(self);
    self->inputs_at = runner->time(self->run);
    self->ahead = isnan(self->start) ? 0 : self->start - self->inputs_at;
    take_place(self);
    self->inputs_set = false;
    if (number_of(self, FMU_WAIT, 0) != 0 && runner->ignite(self->run, INFINITY, NULL))
        status = ld_fail(error, LD_ERR_INPUT,
                         "ignition_by_input requires a rocket that is not ignited at the start: "
                         "set scenario.run.lead_in, or a later firing");
    if (status)
        fmu_end_run(self);
    return status;
}

ld_status fmu_go(fmu_instance *self, ld_error *error)
{
    ld_status status = fmu_begin(self, error);
    self->going = !status;
    return status;
}

// ---- instance ----

static ld_status read_scenario(fmu_instance *self, const char *resources, const char *token,
                               ld_error *error)
{
    char path[PATH_SIZE], own[FMU_TOKEN_SIZE], *text;
    size_t length;
    ld_error why;
    snprintf(path, sizeof path, "%.4000s/" FMU_SCENARIO_FILE, resources);
    ld_status status = text_file_read(path, SCENARIO_BYTES, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.300s %s", path, why.text);
    status = fmu_part_read(resources, &self->part, error);
    if (!status)
        fmu_token(text, length, self->part.which, own);
    self->scenario = digest_bytes(DIGEST_BEGIN, text, length);
    free(text);
    if (status)
        return status;
    if (strcmp(token, own) != 0)
        return ld_fail(error, LD_ERR_INPUT, "found the token %.100s, expected %s", token, own);
    self->source = fmu_source_read(resources, error);
    return self->source ? LD_OK : error->status;
}

// A row has the time, too.
static ld_status make_room(fmu_instance *self, ld_error *error)
{
    size_t count = self->variables.count;
    self->number = malloc(count * sizeof *self->number);
    self->text = calloc(count, sizeof *self->text);
    self->changed = calloc(count, sizeof *self->changed);
    self->row = calloc(1 + fmu_group_count(&self->variables, FMU_COLUMN), sizeof *self->row);
    self->result = calloc(1 + fmu_group_count(&self->variables, FMU_RESULT), sizeof *self->result);
    return self->number && self->text && self->changed && self->row && self->result
               ? LD_OK
               : no_memory(error);
}

// Whether the instance can be one for model exchange; else why not.
static ld_status check_exchange(const fmu_instance *self, ld_error *error)
{
    const fmu_exchanging *by = self->variables.runner->exchanging;
    return by->check ? by->check(self->simulation, error) : LD_OK;
}

fmu_instance *fmu_instance_new(const char *resources, const char *token, bool exchange,
                               ld_error *error)
{
    fmu_instance *self = calloc(1, sizeof *self);
    ld_status status = self ? read_scenario(self, resources, token, error) : no_memory(error);
    if (!status)
        status = build(self, error);
    if (!status)
        status =
            fmu_variables_make(&self->part, self->model, self->simulation, &self->variables, error);
    if (!status && exchange)
        status = check_exchange(self, error);
    if (!status)
        status = make_room(self, error);
    if (!status)
        status = fmu_instance_reset(self, error);
    if (!status) {
        self->exchange.is = exchange;
        return self;
    }
    fmu_instance_free(self);
    return NULL;
}

// Run, simulation and all that was set.
static void forget(fmu_instance *self)
{
    release_model(self);
    for (size_t i = 0; self->text && i < self->variables.count; i++)
        free(self->text[i]);
    free(self->number);
    free(self->text);
    free(self->changed);
    free(self->row);
    free(self->result);
}

void fmu_instance_free(fmu_instance *self)
{
    if (!self)
        return;
    forget(self);
    fmu_variables_free(&self->variables);
    source_free(self->source);
    free(self);
}

static void set_nothing(fmu_instance *self)
{
    for (size_t i = 0; i < self->variables.count; i++) {
        self->number[i] = self->variables.item[i].start;
        self->changed[i] = false;
        free(self->text[i]);
        self->text[i] = NULL;
    }
}

ld_status fmu_instance_reset(fmu_instance *self, ld_error *error)
{
    set_nothing(self);
    self->tolerance = 0;
    self->start = NAN;
    self->going = self->inputs_set = self->lit = false;
    self->exchange.continuous = self->exchange.moved = false;
    fmu_end_run(self);
    return build(self, error);
}

ld_status fmu_set_experiment(fmu_instance *self, double start, double tolerance, ld_error *error)
{
    double usual = NAN;
    if (self->going)
        return ld_fail(error, LD_ERR_INPUT, "the run has begun");
    if (self->model) // else its parameters were refused
        ld_model_number(self->model, "run.tolerance", &usual, NULL);
    if (!isfinite(start))
        return ld_fail(error, LD_ERR_INPUT, "the start time is not a number");
    fmu_end_run(self);
    self->start = start;
    self->tolerance = tolerance > 0 && tolerance != usual ? tolerance : 0;
    return LD_OK;
}

// ---- values ----

size_t fmu_elements(const fmu_instance *self, unsigned reference,
                    unsigned element[FMU_LONGEST_ARRAY])
{
    const fmu_variables *all = &self->variables;
    size_t first = fmu_variables_find_array(all, reference);
    if (first == all->count) {
        element[0] = reference;
        return 1;
    }
    size_t length = fmu_array_length(all, first);
    for (size_t i = 0; i < length; i++)
        element[i] = all->item[first + i].reference;
    return length;
}

// NULL: there is none, or one of another type.
static const fmu_variable *find(const fmu_instance *self, unsigned reference, fmu_type type,
                                ld_error *error)
{
    size_t place = fmu_variables_find(&self->variables, reference);
    if (place == self->variables.count) {
        size_t array = fmu_variables_find_array(&self->variables, reference);
        if (array < place)
            ld_fail(error, LD_ERR_INPUT, "variable %u is an array: found 1 value, expected %zu",
                    reference, fmu_array_length(&self->variables, array));
        else
            ld_fail(error, LD_ERR_INPUT, "variable %u does not exist", reference);
        return NULL;
    }
    const fmu_variable *variable = &self->variables.item[place];
    if (fmu_type_of(variable) == type)
        return variable;
    ld_fail(error, LD_ERR_INPUT, "%s is of another type", variable->name);
    return NULL;
}

static size_t place_of(const fmu_instance *self, const fmu_variable *variable)
{
    return (size_t)(variable - self->variables.item);
}

// States and what goes with them, which importers that take the steps seldom ask for one by one.
static ld_status exchanged(fmu_instance *self, const fmu_variable *variable, double *value,
                           ld_error *error)
{
    double all[LD_MAX_STATES];
    ld_status status = LD_OK;
    if (variable->group == FMU_STATE)
        self->variables.runner->exchanging->get_state(self->run, all);
    else if (variable->group == FMU_RATE)
        status = fmu_rates(self, all, error);
    else
        status = fmu_indicators(self, all, error);
    *value = status ? NAN : all[variable->index];
    return status;
}

// The variable of a result that is next in its place, as they come in their order.
typedef struct result_reader {
    fmu_instance *self;
    size_t next, first, end;
} result_reader;

static void take_result(void *data, const ld_quantity *one)
{
    result_reader *at = data;
    const fmu_variable *item = at->self->variables.item;
    bool is_rocket = strncmp(one->name, "rocket.", strlen("rocket.")) == 0;
    for (size_t i = at->next; i < at->end && is_rocket; i++)
        if (strcmp(item[i].name + strlen("summary."), one->name) == 0) {
            at->self->result[i - at->first] = one->value;
            at->next = i + 1;
            return;
        }
}

// Of a rocket that is still to come there is none.
static void read_results(fmu_instance *self)
{
    const fmu_variables *all = &self->variables;
    size_t first = fmu_group_begin(all, FMU_RESULT), count = fmu_group_count(all, FMU_RESULT);
    result_reader at = {self, first, first, first + count};
    for (size_t i = 0; i < count; i++)
        self->result[i] = NAN;
    ld_summary_each(all->runner->summary(self->run), take_result, &at);
}

static ld_status tell_inputs(fmu_instance *self, ld_error *error);

// Outputs follow inputs at once.
static ld_status output(fmu_instance *self, const fmu_variable *variable, double *value,
                        ld_error *error)
{
    const fmu_runner *runner = self->variables.runner;
    ld_status status = fmu_begin(self, error);
    if (!status && self->inputs_set && !self->exchange.is)
        status = tell_inputs(self, error);
    if (!status)
        status = fmu_place(self, error);
    if (status)
        return status;
    switch (variable->group) {
    case FMU_TIME:
        *value = runner->time(self->run) + self->ahead;
        return LD_OK;
    case FMU_PART_OUTPUT:
        if (!self->known.outputs)
            status = runner->get_outputs(self->run, self->outputs, error);
        self->known.outputs = !status;
        *value = self->outputs[variable->index];
        return status;
    case FMU_COLUMN:
        if (!self->known.row)
            status = runner->get_row(self->run, self->row, error);
        self->known.row = !status;
        *value = self->row[variable->index];
        return status;
    case FMU_STATE:
    case FMU_RATE:
    case FMU_INDICATOR:
        return exchanged(self, variable, value, error);
    default:
        if (!self->known.result)
            read_results(self);
        self->known.result = true;
        *value = self->result[variable->index];
        return LD_OK;
    }
}

ld_status fmu_get_number(fmu_instance *self, unsigned reference, fmu_type type, double *value,
                         ld_error *error)
{
    const fmu_variable *variable = find(self, reference, type, error);
    *value = NAN;
    if (!variable)
        return LD_ERR_INPUT;
    if (variable->group == FMU_TIME || fmu_is_output(variable) || fmu_is_local(variable))
        return output(self, variable, value, error);
    *value = self->number[place_of(self, variable)];
    return LD_OK;
}

ld_status fmu_get_text(fmu_instance *self, unsigned reference, const char **text, ld_error *error)
{
    const fmu_variable *variable = find(self, reference, FMU_STRING, error);
    *text = "";
    if (!variable)
        return LD_ERR_INPUT;
    *text = self->text[place_of(self, variable)];
    if (!*text)
        *text = variable->text;
    return LD_OK;
}

// What is set holds from the next step on, or, before the run goes, from its start on.
static ld_status take_change(fmu_instance *self, const fmu_variable *variable, ld_error *error)
{
    if (!fmu_is_input(variable) && !fmu_is_parameter(variable))
        return ld_fail(error, LD_ERR_INPUT, "%s is neither an input nor a parameter",
                       variable->name);
    if (fmu_is_parameter(variable) && self->going)
        return ld_fail(error, LD_ERR_INPUT, "%s is fixed once the run has begun", variable->name);
    if (!self->going)
        fmu_end_run(self);
    self->inputs_set |= variable->group == FMU_PART_INPUT;
    self->exchange.moved |= variable->group == FMU_PART_INPUT;
    self->changed[place_of(self, variable)] = true;
    return LD_OK;
}

ld_status fmu_set_number(fmu_instance *self, unsigned reference, fmu_type type, double value,
                         ld_error *error)
{
    const fmu_variable *variable = find(self, reference, type, error);
    if (!variable)
        return LD_ERR_INPUT;
    if (!isfinite(value))
        return ld_fail(error, LD_ERR_INPUT, "%s cannot be %g", variable->name, value);
    ld_status status = take_change(self, variable, error);
    if (!status)
        self->number[place_of(self, variable)] = value;
    return status;
}

ld_status fmu_set_text(fmu_instance *self, unsigned reference, const char *text, ld_error *error)
{
    const fmu_variable *variable = find(self, reference, FMU_STRING, error);
    if (!variable)
        return LD_ERR_INPUT;
    if (!text)
        return ld_fail(error, LD_ERR_INPUT, "the text of %s is a null pointer", variable->name);
    if (strlen(text) >= SAVED_TEXT)
        return ld_fail(error, LD_ERR_INPUT, "the text of %s is too long", variable->name);
    char *copy = strdup(text);
    ld_status status = copy ? take_change(self, variable, error) : no_memory(error);
    if (status) {
        free(copy);
        return status;
    }
    char **text_there = &self->text[place_of(self, variable)];
    free(*text_there);
    *text_there = copy;
    return LD_OK;
}

// ---- steps ----

// Once at an instant, unless it says something else then.
static ld_status tell_inputs(fmu_instance *self, ld_error *error)
{
    const fmu_runner *runner = self->variables.runner;
    double inputs[FMU_MOST_NUMBERS], now = runner->time(self->run);
    find_inputs(self, false, inputs);
    self->inputs_set = false;
    if (lacks_inputs(self, inputs, false))
        return LD_OK;
    if (now == self->inputs_at &&
        memcmp((const char *)inputs, (const char *)self->inputs, sizeof inputs) == 0)
        return LD_OK;
    memcpy(self->inputs, inputs, sizeof inputs);
    self->inputs_at = now;
    fmu_forget_outputs(self);
    return runner->set_inputs(self->run, inputs, error);
}

ld_status fmu_ignite(fmu_instance *self, bool *lit, ld_error *error)
{
    const fmu_runner *runner = self->variables.runner;
    bool is = number_of(self, FMU_IGNITE, 0) != 0, was = self->lit;
    self->lit = is;
    if (!is || was)
        return LD_OK;
    *lit = true;
    fmu_forget_outputs(self);
    return runner->ignite(self->run, runner->time(self->run), error);
}

// Passes to the run what was set since the last step.
static ld_status apply_inputs(fmu_instance *self, ld_error *error)
{
    bool lit;
    ld_status status = self->inputs_set ? tell_inputs(self, error) : LD_OK;
    return status ? status : fmu_ignite(self, &lit, error);
}

ld_status fmu_step_on(fmu_instance *self, double t, double size, bool at_events, fmu_step *step,
                      ld_error *error)
{
    const fmu_runner *runner = self->variables.runner;
    double now = self->run ? runner->time(self->run) + self->ahead : NAN,
           end = t + size - self->ahead;
    *step = (fmu_step){.t = now};
    if (self->exchange.is)
        return ld_fail(error, LD_ERR_INPUT,
                       "this is a model-exchange instance: its importer integrates it");
    if (!self->going)
        return ld_fail(error, LD_ERR_INPUT, "the run has not begun");
    if (!(fabs(t - now) <= 1e-9 * fmax(1, fabs(t))) || !(size >= 0) || !isfinite(t + size))
        return ld_fail(error, LD_ERR_INPUT,
                       "found a step of %.17g s from %.17g s; the run is at %.17g s", size, t, now);
    ld_status status = apply_inputs(self, error);
    fmu_forget_outputs(self);
    if (!status && at_events)
        status = runner->advance_to_event(self->run, end, &step->event, error);
    else if (!status)
        status = runner->advance(self->run, end, error);
    step->t = runner->time(self->run) + self->ahead;
    step->ended = runner->is_finished(self->run);
    return status;
}

// ---- states ----

static const int64_t MAGIC = INT64_C(0x554d4664796c31), FORM = 4;

static void archive_set_text(fmu_instance *self, archive *state, size_t i)
{
    char text[SAVED_TEXT] = "";
    bool there = self->text[i] != NULL;
    archive_bool(state, &there);
    if (!there) {
        if (state->loading) {
            free(self->text[i]);
            self->text[i] = NULL;
        }
        return;
    }
    if (!state->loading)
        snprintf(text, sizeof text, "%s", self->text[i]);
    archive_text(state, text, sizeof text);
    if (state->loading) {
        free(self->text[i]);
        self->text[i] = strdup(text);
        state->failed |= !self->text[i];
    }
}

// All but the run; `run_size` bytes of that follow.
static void archive_head(fmu_instance *self, archive *state, int64_t *run_size)
{
    archive_expect(state, MAGIC);
    archive_expect(state, FORM);
    archive_expect(state, (int64_t)self->scenario);
    archive_double(state, &self->tolerance);
    archive_double(state, &self->start);
    archive_double(state, &self->ahead);
    archive_bool(state, &self->going);
    archive_bool(state, &self->inputs_set);
    archive_doubles(state, self->inputs, FMU_MOST_NUMBERS);
    archive_double(state, &self->inputs_at);
    archive_bool(state, &self->lit);
    archive_expect(state, self->exchange.is);
    archive_bool(state, &self->exchange.continuous);
    for (size_t i = 0; i < self->variables.count; i++)
        if (fmu_is_input(&self->variables.item[i]) || fmu_is_parameter(&self->variables.item[i])) {
            archive_double(state, &self->number[i]);
            archive_bool(state, &self->changed[i]);
            archive_set_text(self, state, i);
        }
    archive_count(state, run_size);
}

ld_status fmu_save(fmu_instance *self, fmu_state **state, ld_error *error)
{
    size_t run_size = 0;
    archive count = archive_save(NULL, 0);
    if (self->run && fmu_place(self, error))
        return error->status;
    if (self->run) {
        self->variables.runner->save(self->run, NULL, 0, &run_size, error);
        if (run_size == 0)
            return error->status;
    }
    int64_t following = (int64_t)run_size;
    archive_head(self, &count, &following);
    fmu_state *made = malloc(sizeof *made + count.at + run_size);
    if (!made)
        return no_memory(error);
    made->size = count.at + run_size;
    archive head = archive_save(made->bytes, count.at);
    archive_head(self, &head, &following);
    ld_status status = LD_OK;
    if (self->run)
        status = self->variables.runner->save(self->run, made->bytes + count.at, run_size,
                                              &run_size, error);
    if (status)
        free(made);
    else
        *state = made;
    return status;
}

// An instance of the same FMU that a state is read into: it shares what no state changes.
static fmu_instance *new_twin(const fmu_instance *self, ld_error *error)
{
    fmu_instance *twin = calloc(1, sizeof *twin);
    if (!twin) {
        no_memory(error);
        return NULL;
    }
    twin->source = self->source;
    twin->scenario = self->scenario;
    twin->part = self->part;
    twin->variables = self->variables;
    twin->exchange.is = self->exchange.is;
    if (!make_room(twin, error)) {
        set_nothing(twin);
        return twin;
    }
    forget(twin);
    free(twin);
    return NULL;
}

// What the state holds, and a run of it: of the simulation of `self` where the parameters are the
// same.
static ld_status read_state(fmu_instance *twin, const fmu_instance *self, const fmu_state *state,
                            ld_error *error)
{
    int64_t following = 0;
    archive head = archive_load(state->bytes, state->size);
    archive_head(twin, &head, &following);
    if (head.failed || head.at + (size_t)following != state->size)
        return ld_fail(error, LD_ERR_INPUT, "this is not a state of this FMU, or is damaged");
    if (self->simulation && parameters_digest(twin) == self->built_with) {
        twin->model = self->model;
        twin->simulation = self->simulation;
        twin->built_with = self->built_with;
    }
    ld_status status = build(twin, error);
    if (status || following == 0)
        return status;
    const fmu_runner *runner = twin->variables.runner;
    twin->run = (twin->exchange.is ? runner->exchanging->load : runner->load)(
        twin->simulation, state->bytes + head.at, (size_t)following, error);
    if (!twin->run)
        return error->status;
    take_place(twin);
    return LD_OK;
}

// A state that is refused leaves the instance as it is.
ld_status fmu_load(fmu_instance *self, const fmu_state *state, ld_error *error)
{
    if (!state)
        return ld_fail(error, LD_ERR_INPUT, "there is no state");
    fmu_instance *twin = new_twin(self, error);
    if (!twin)
        return error->status;
    ld_status status = read_state(twin, self, state, error);
    if (!status) {
        const fmu_instance before = *self;
        *self = *twin;
        *twin = before;
    }
    if (twin->simulation == self->simulation) { // which stays
        fmu_end_run(twin);
        twin->model = NULL;
        twin->simulation = NULL;
    }
    forget(twin);
    free(twin);
    return status;
}

ld_status fmu_state_read(const void *bytes, size_t size, fmu_state **state, ld_error *error)
{
    fmu_state *made = malloc(sizeof *made + size);
    if (!made)
        return no_memory(error);
    made->size = size;
    memcpy(made->bytes, bytes, size);
    *state = made;
    return LD_OK;
}

ld_status fmu_state_write(const fmu_state *state, void *bytes, size_t size, ld_error *error)
{
    if (size < state->size)
        return ld_fail(error, LD_ERR_INPUT, "a buffer of %zu bytes is too small for a state of %zu",
                       size, state->size);
    memcpy(bytes, state->bytes, state->size);
    return LD_OK;
}
