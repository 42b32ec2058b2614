// FMI 3.0 for co-simulation and model exchange over fmu_instance: every function of the standard;
// those of what this FMU does not offer answer with an error and a line of the log.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmu/fmi3_interface.h"
#include "fmu/fmu_derivatives.h"
#include "fmu/fmu_exchange.h"

// An instance and its importer.
typedef struct component {
    fmu_instance *inside;
    fmi3Logger log;
    void *environment;
    bool at_events; // steps end at events, where the importer is ready for them
    bool ended;
    bool exchange; // for model exchange
    bool terminated;
} component;

static fmi3Status answer_status(const component *self, ld_status status, const ld_error *error)
{
    if (!status)
        return fmi3OK;
    if (!self)
        return fmi3Error;
    if (self->log)
        self->log(self->environment, fmi3Error, "logStatusError", error->text);
    return fmi3Error;
}

// A call that cannot be taken; without an instance there is no log to say why.
static fmi3Status refuse_call(const component *self, const char *function, const char *why)
{
    ld_error error;
    return self
               ? answer_status(self, ld_fail(&error, LD_ERR_INPUT, "%s: %s", function, why), &error)
               : fmi3Error;
}

static fmi3Status not_offered(void *instance, const char *function)
{
    ld_error error;
    return answer_status(
        instance, ld_fail(&error, LD_ERR_MISSING, "%s: this FMU does not offer it", function),
        &error);
}

const char *fmi3GetVersion(void)
{
    return "3.0";
}

// Errors are always reported: there is nothing else in the log.
fmi3Status fmi3SetDebugLogging(void *instance, bool on, size_t count, const char *const *categories)
{
    (void)instance, (void)on, (void)count, (void)categories;
    return fmi3OK;
}

// ---- life ----

static void *refuse_instance(fmi3Logger log, void *environment, const char *text)
{
    if (log)
        log(environment, fmi3Error, "logStatusError", text);
    return NULL;
}

// As `kind` says.
static void *open_instance(const char *token, const char *resources, const component *kind,
                           void *environment, fmi3Logger log)
{
    ld_error error;
    if (!token || !resources)
        return refuse_instance(log, environment, "token or location of the resources is missing");
    component *self = calloc(1, sizeof *self);
    if (!self)
        return refuse_instance(log, environment, "no memory");
    *self = *kind;
    self->log = log;
    self->environment = environment;
    self->inside = fmu_instance_new(resources, token, kind->exchange, &error);
    if (self->inside)
        return self;
    free(self);
    return refuse_instance(log, environment, error.text);
}

// NOLINTNEXTLINE(readability-function-size): of the standard
void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources,
                                   bool visible, bool logging, void *environment, fmi3Logger log)
{
    (void)name, (void)visible, (void)logging;
    return open_instance(token, resources, &(component){.exchange = true}, environment, log);
}

// NOLINTNEXTLINE(readability-function-size): of the standard
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources,
                                  bool visible, bool logging, bool event_mode, bool early_return,
                                  const uint32_t *intermediate, size_t intermediates,
                                  void *environment, fmi3Logger log, fmi3IntermediateUpdate update)
{
    (void)name, (void)visible, (void)logging, (void)intermediate, (void)update;
    if (intermediates > 0)
        return refuse_instance(log, environment, "intermediate updates are not supported");
    return open_instance(token, resources, &(component){.at_events = event_mode && early_return},
                         environment, log);
}

// NOLINTNEXTLINE(readability-function-size): of the standard
void *fmi3InstantiateScheduledExecution(const char *name, const char *token, const char *resources,
                                        bool visible, bool logging, void *environment,
                                        fmi3Logger log, void (*clock)(void *), void (*lock)(void),
                                        void (*unlock)(void))
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging;
    (void)clock, (void)lock, (void)unlock;
    return refuse_instance(log, environment, "this FMU supports co-simulation and model exchange");
}

void fmi3FreeInstance(void *instance)
{
    component *self = instance;
    if (!self)
        return;
    fmu_instance_free(self->inside);
    free(self);
}

fmi3Status fmi3EnterInitializationMode(void *instance, bool tolerance_defined, double tolerance,
                                       double start, bool stop_defined, double stop)
{
    component *self = instance;
    NEEDS_ALIVE(true);
    ld_error error;
    (void)stop_defined, (void)stop;
    return answer_status(
        self, fmu_set_experiment(self->inside, start, tolerance_defined ? tolerance : 0, &error),
        &error);
}

fmi3Status fmi3ExitInitializationMode(void *instance)
{
    component *self = instance;
    NEEDS_ALIVE(true);
    ld_error error;
    return answer_status(self, fmu_go(self->inside, &error), &error);
}

fmi3Status fmi3EnterConfigurationMode(void *instance)
{
    return not_offered(instance, "fmi3EnterConfigurationMode");
}

fmi3Status fmi3ExitConfigurationMode(void *instance)
{
    return not_offered(instance, "fmi3ExitConfigurationMode");
}

fmi3Status fmi3Terminate(void *instance)
{
    component *self = instance;
    NEEDS_ALIVE(true);
    self->terminated = true;
    return fmi3OK;
}

fmi3Status fmi3Reset(void *instance)
{
    component *self = instance;
    NEEDS(true);
    ld_error error;
    self->ended = false;
    self->terminated = false;
    return answer_status(self, fmu_instance_reset(self->inside, &error), &error);
}

// ---- values ----

static fmi3Status check_counts(const component *self, size_t references, size_t values)
{
    ld_error error;
    return references == values ? fmi3OK
                                : answer_status(self,
                                                ld_fail(&error, LD_ERR_INPUT,
                                                        "found %zu values for %zu scalar variables",
                                                        values, references),
                                                &error);
}

// Value references of which those of arrays are replaced by their elements'. To be freed.
typedef struct number_list {
    size_t count;
    unsigned reference[];
} number_list;

// NULL: no memory.
static number_list *spread(const component *self, const uint32_t *reference, size_t references)
{
    number_list *list =
        malloc(sizeof *list + references * FMU_LONGEST_ARRAY * sizeof *list->reference);
    if (!list)
        return NULL;
    list->count = 0;
    for (size_t i = 0; i < references; i++)
        list->count += fmu_elements(self->inside, reference[i], list->reference + list->count);
    return list;
}

// The same for this many values; where it is NULL, why is answered. Each array has more than one
// element.
static number_list *spread_for(const component *self, const uint32_t *reference, size_t references,
                               size_t values, fmi3Status *status)
{
    ld_error error;
    number_list *list = spread(self, reference, references);
    *status = fmi3OK;
    if (list && list->count == values)
        return list;
    *status = answer_status(self,
                            list ? ld_fail(&error, LD_ERR_INPUT,
                                           "found %zu values, expected %zu for %zu variables",
                                           values, list->count, references)
                                 : ld_fail(&error, LD_ERR_MEMORY, "no memory"),
                            &error);
    free(list);
    return NULL;
}

fmi3Status fmi3GetFloat64(void *instance, const uint32_t *reference, size_t references,
                          double *value, size_t values)
{
    component *self = instance;
    NEEDS(references == 0 || (reference && value));
    ld_error error;
    fmi3Status status = fmi3OK;
    number_list *list =
        references == values ? NULL : spread_for(self, reference, references, values, &status);
    for (size_t i = 0; !status && i < values; i++)
        status =
            answer_status(self,
                          fmu_get_number(self->inside, list ? list->reference[i] : reference[i],
                                         FMU_REAL, &value[i], &error),
                          &error);
    free(list);
    return status;
}

fmi3Status fmi3SetFloat64(void *instance, const uint32_t *reference, size_t references,
                          const double *value, size_t values)
{
    component *self = instance;
    NEEDS_ALIVE(references == 0 || (reference && value));
    ld_error error;
    fmi3Status status = fmi3OK;
    number_list *list =
        references == values ? NULL : spread_for(self, reference, references, values, &status);
    for (size_t i = 0; !status && i < values; i++)
        status =
            answer_status(self,
                          fmu_set_number(self->inside, list ? list->reference[i] : reference[i],
                                         FMU_REAL, value[i], &error),
                          &error);
    free(list);
    return status;
}

fmi3Status fmi3GetBoolean(void *instance, const uint32_t *reference, size_t references, bool *value,
                          size_t values)
{
    component *self = instance;
    NEEDS(references == 0 || (reference && value));
    ld_error error;
    fmi3Status status = check_counts(self, references, values);
    for (size_t i = 0; !status && i < values; i++) {
        double number;
        status = answer_status(
            self, fmu_get_number(self->inside, reference[i], FMU_BOOLEAN, &number, &error), &error);
        value[i] = number == 1;
    }
    return status;
}

fmi3Status fmi3SetBoolean(void *instance, const uint32_t *reference, size_t references,
                          const bool *value, size_t values)
{
    component *self = instance;
    NEEDS_ALIVE(references == 0 || (reference && value));
    ld_error error;
    fmi3Status status = check_counts(self, references, values);
    for (size_t i = 0; !status && i < values; i++)
        status = answer_status(
            self, fmu_set_number(self->inside, reference[i], FMU_BOOLEAN, value[i], &error),
            &error);
    return status;
}

fmi3Status fmi3GetString(void *instance, const uint32_t *reference, size_t references,
                         const char **value, size_t values)
{
    component *self = instance;
    NEEDS(references == 0 || (reference && value));
    ld_error error;
    fmi3Status status = check_counts(self, references, values);
    for (size_t i = 0; !status && i < values; i++)
        status = answer_status(self, fmu_get_text(self->inside, reference[i], &value[i], &error),
                               &error);
    return status;
}

fmi3Status fmi3SetString(void *instance, const uint32_t *reference, size_t references,
                         const char *const *value, size_t values)
{
    component *self = instance;
    NEEDS_ALIVE(references == 0 || (reference && value));
    ld_error error;
    fmi3Status status = check_counts(self, references, values);
    for (size_t i = 0; !status && i < values; i++)
        status =
            answer_status(self, fmu_set_text(self->inside, reference[i], value[i], &error), &error);
    return status;
}

fmi3Status fmi3GetInt32(void *instance, const uint32_t *reference, size_t references,
                        int32_t *value, size_t values)
{
    component *self = instance;
    NEEDS(references == 0 || (reference && value));
    ld_error error;
    fmi3Status status = check_counts(self, references, values);
    for (size_t i = 0; !status && i < values; i++) {
        double number;
        status = answer_status(
            self, fmu_get_number(self->inside, reference[i], FMU_INTEGER, &number, &error), &error);
        value[i] = status ? 0 : (int32_t)number;
    }
    return status;
}

fmi3Status fmi3SetInt32(void *instance, const uint32_t *reference, size_t references,
                        const int32_t *value, size_t values)
{
    component *self = instance;
    NEEDS_ALIVE(references == 0 || (reference && value));
    ld_error error;
    fmi3Status status = check_counts(self, references, values);
    for (size_t i = 0; !status && i < values; i++)
        status = answer_status(
            self, fmu_set_number(self->inside, reference[i], FMU_INTEGER, value[i], &error),
            &error);
    return status;
}

// Types of which there are no variables.
#define NO_VALUES(name, type)                                                                      \
    fmi3Status fmi3Get##name(void *instance, const uint32_t *reference, size_t references,         \
                             type *value, size_t values)                                           \
    {                                                                                              \
        (void)reference, (void)value, (void)values;                                                \
        return references == 0 ? fmi3OK : not_offered(instance, "fmi3Get" #name);                  \
    }                                                                                              \
    fmi3Status fmi3Set##name(void *instance, const uint32_t *reference, size_t references,         \
                             const type *value, size_t values)                                     \
    {                                                                                              \
        (void)reference, (void)value, (void)values;                                                \
        return references == 0 ? fmi3OK : not_offered(instance, "fmi3Set" #name);                  \
    }

NO_VALUES(Float32, float)
NO_VALUES(Int8, int8_t)
NO_VALUES(UInt8, uint8_t)
NO_VALUES(Int16, int16_t)
NO_VALUES(UInt16, uint16_t)
NO_VALUES(UInt32, uint32_t)
NO_VALUES(Int64, int64_t)
NO_VALUES(UInt64, uint64_t)

fmi3Status fmi3GetBinary(void *instance, const uint32_t *reference, size_t references, size_t *size,
                         const uint8_t **value, size_t values)
{
    (void)reference, (void)size, (void)value, (void)values;
    return references == 0 ? fmi3OK : not_offered(instance, "fmi3GetBinary");
}

fmi3Status fmi3SetBinary(void *instance, const uint32_t *reference, size_t references,
                         const size_t *size, const uint8_t *const *value, size_t values)
{
    (void)reference, (void)size, (void)value, (void)values;
    return references == 0 ? fmi3OK : not_offered(instance, "fmi3SetBinary");
}

fmi3Status fmi3GetClock(void *instance, const uint32_t *reference, size_t references, bool *value)
{
    (void)reference, (void)value;
    return references == 0 ? fmi3OK : not_offered(instance, "fmi3GetClock");
}

fmi3Status fmi3SetClock(void *instance, const uint32_t *reference, size_t references,
                        const bool *value)
{
    (void)reference, (void)value;
    return references == 0 ? fmi3OK : not_offered(instance, "fmi3SetClock");
}

fmi3Status fmi3GetNumberOfVariableDependencies(void *instance, uint32_t reference, size_t *count)
{
    (void)reference, (void)count;
    return not_offered(instance, "fmi3GetNumberOfVariableDependencies");
}

// NOLINTNEXTLINE(readability-function-size): of the standard
fmi3Status fmi3GetVariableDependencies(void *instance, uint32_t dependent, size_t *element,
                                       uint32_t *independent, size_t *of_independent, int *kind,
                                       size_t count)
{
    (void)dependent, (void)element, (void)independent, (void)of_independent, (void)kind;
    (void)count;
    return not_offered(instance, "fmi3GetVariableDependencies");
}

// ---- steps and events ----

// NOLINTNEXTLINE(readability-function-size): of the standard
fmi3Status fmi3DoStep(void *instance, double t, double size, bool no_return, bool *event,
                      bool *terminate, bool *early, double *reached)
{
    component *self = instance;
    NEEDS_ALIVE(event && terminate && early && reached);
    ld_error error;
    fmu_step step;
    (void)no_return;
    ld_status status = fmu_step_on(self->inside, t, size, self->at_events, &step, &error);
    self->ended = step.ended;
    *event = step.event;
    *terminate = step.ended;
    *early = step.event && step.t < t + size;
    *reached = step.t;
    return answer_status(self, status, &error);
}

fmi3Status fmi3EnterEventMode(void *instance)
{
    component *self = instance;
    NEEDS_ALIVE(true);
    ld_error error;
    return self->exchange ? answer_status(self, fmu_enter_event_mode(self->inside, &error), &error)
                          : fmi3OK;
}

fmi3Status fmi3EnterStepMode(void *instance)
{
    component *self = instance;
    NEEDS_ALIVE(true);
    return fmi3OK;
}

// In co-simulation what happened has happened within the step; inputs act on the next one.
// NOLINTNEXTLINE(readability-function-size): of the standard
fmi3Status fmi3UpdateDiscreteStates(void *instance, bool *again, bool *terminate, bool *nominals,
                                    bool *values, bool *next_defined, double *next)
{
    component *self = instance;
    NEEDS_ALIVE(again && terminate && nominals && values && next_defined && next);
    ld_error error;
    fmu_update update = {.ended = self->ended, .next = INFINITY};
    ld_status status = self->exchange ? fmu_update_states(self->inside, &update, &error) : LD_OK;
    *again = *nominals = false;
    *terminate = update.ended;
    *values = update.changed;
    *next_defined = update.next < INFINITY;
    *next = update.next;
    return answer_status(self, status, &error);
}

fmi3Status fmi3EvaluateDiscreteStates(void *instance)
{
    return not_offered(instance, "fmi3EvaluateDiscreteStates");
}

fmi3Status fmi3GetOutputDerivatives(void *instance, const uint32_t *reference, size_t references,
                                    const int32_t *order, double *value, size_t values)
{
    (void)reference, (void)references, (void)order, (void)value, (void)values;
    return not_offered(instance, "fmi3GetOutputDerivatives");
}

// ---- states ----

fmi3Status fmi3FreeFMUState(void *instance, void **state)
{
    component *self = instance;
    NEEDS(state);
    free(*state);
    *state = NULL;
    return fmi3OK;
}

fmi3Status fmi3GetFMUState(void *instance, void **state)
{
    component *self = instance;
    NEEDS(state);
    ld_error error;
    fmu_state *saved;
    ld_status status = fmu_save(self->inside, &saved, &error);
    if (!status) {
        free(*state);
        *state = saved;
    }
    return answer_status(self, status, &error);
}

fmi3Status fmi3SetFMUState(void *instance, void *state)
{
    component *self = instance;
    NEEDS(state);
    ld_error error;
    ld_status status = fmu_load(self->inside, state, &error);
    self->terminated &= status != LD_OK;
    return answer_status(self, status, &error);
}

fmi3Status fmi3SerializedFMUStateSize(void *instance, void *state, size_t *size)
{
    component *self = instance;
    NEEDS(state && size);
    *size = ((const fmu_state *)state)->size;
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(void *instance, void *state, uint8_t *bytes, size_t size)
{
    component *self = instance;
    NEEDS(state && bytes);
    ld_error error;
    return answer_status(self, fmu_state_write(state, bytes, size, &error), &error);
}

fmi3Status fmi3DeserializeFMUState(void *instance, const uint8_t *bytes, size_t size, void **state)
{
    component *self = instance;
    NEEDS(bytes && state);
    ld_error error;
    fmu_state *read;
    ld_status status = fmu_state_read(bytes, size, &read, &error);
    if (!status)
        *state = read;
    return answer_status(self, status, &error);
}

// ---- clocks: there are none ----

static fmi3Status no_clocks(void *instance, const uint32_t *reference, size_t references,
                            const char *function)
{
    (void)reference;
    return references == 0 ? fmi3OK : not_offered(instance, function);
}

fmi3Status fmi3GetIntervalDecimal(void *instance, const uint32_t *reference, size_t references,
                                  double *interval, int *qualifier)
{
    (void)interval, (void)qualifier;
    return no_clocks(instance, reference, references, "fmi3GetIntervalDecimal");
}

fmi3Status fmi3GetIntervalFraction(void *instance, const uint32_t *reference, size_t references,
                                   uint64_t *counter, uint64_t *resolution, int *qualifier)
{
    (void)counter, (void)resolution, (void)qualifier;
    return no_clocks(instance, reference, references, "fmi3GetIntervalFraction");
}

fmi3Status fmi3GetShiftDecimal(void *instance, const uint32_t *reference, size_t references,
                               double *shift)
{
    (void)shift;
    return no_clocks(instance, reference, references, "fmi3GetShiftDecimal");
}

fmi3Status fmi3GetShiftFraction(void *instance, const uint32_t *reference, size_t references,
                                uint64_t *counter, uint64_t *resolution)
{
    (void)counter, (void)resolution;
    return no_clocks(instance, reference, references, "fmi3GetShiftFraction");
}

fmi3Status fmi3SetIntervalDecimal(void *instance, const uint32_t *reference, size_t references,
                                  const double *interval)
{
    (void)interval;
    return no_clocks(instance, reference, references, "fmi3SetIntervalDecimal");
}

fmi3Status fmi3SetIntervalFraction(void *instance, const uint32_t *reference, size_t references,
                                   const uint64_t *counter, const uint64_t *resolution)
{
    (void)counter, (void)resolution;
    return no_clocks(instance, reference, references, "fmi3SetIntervalFraction");
}

fmi3Status fmi3SetShiftDecimal(void *instance, const uint32_t *reference, size_t references,
                               const double *shift)
{
    (void)shift;
    return no_clocks(instance, reference, references, "fmi3SetShiftDecimal");
}

fmi3Status fmi3SetShiftFraction(void *instance, const uint32_t *reference, size_t references,
                                const uint64_t *counter, const uint64_t *resolution)
{
    (void)counter, (void)resolution;
    return no_clocks(instance, reference, references, "fmi3SetShiftFraction");
}

fmi3Status fmi3ActivateModelPartition(void *instance, uint32_t clock, double t)
{
    (void)clock, (void)t;
    return not_offered(instance, "fmi3ActivateModelPartition");
}

// Of what is asked for at a point that is tried: where the equations have no solution, a shorter
// step may find one.
static fmi3Status answer_trial(const component *self, ld_status status, const ld_error *error)
{
    if (status != LD_ERR_NUMERIC)
        return answer_status(self, status, error);
    if (self->log)
        self->log(self->environment, fmi3Discard, "logStatusDiscard", error->text);
    return fmi3Discard;
}

// ---- derivatives ----

// `bent`: found, but less well than elsewhere.
static fmi3Status answer_derivative(const component *self, ld_status status, bool bent,
                                    const ld_error *error)
{
    if (status || !bent)
        return answer_trial(self, status, error);
    if (self->log)
        self->log(self->environment, fmi3Warning, "logStatusWarning", error->text);
    return fmi3Warning;
}

// What a derivative is asked for: `along`: by a seed for each known, else for each unknown.
typedef struct derivative_call {
    const char *function;
    const uint32_t *unknown, *known;
    size_t unknowns, knowns;
    const double *seed;
    double *value;
    size_t seeds, values;
    bool along;
} derivative_call;

static fmi3Status differentiate(const component *self, const derivative_call *call)
{
    ld_error error;
    bool bent = false;
    number_list *unknown = spread(self, call->unknown, call->unknowns),
                *known = spread(self, call->known, call->knowns);
    fmi3Status answer;
    if (!unknown || !known) {
        answer = answer_status(self, ld_fail(&error, LD_ERR_MEMORY, "no memory"), &error);
    } else if (call->seeds != (call->along ? known : unknown)->count ||
               call->values != (call->along ? unknown : known)->count) {
        answer =
            refuse_call(self, call->function,
                        call->along ? "expected a seed for each known, a value for each unknown"
                                    : "expected a seed for each unknown, a value for each known");
    } else {
        const fmu_jacobian of = {unknown->reference, unknown->count, known->reference,
                                 known->count};
        ld_status status = (call->along ? fmu_derivative_along : fmu_derivative_adjoint)(
            self->inside, &of, call->seed, call->value, &bent, &error);
        answer = answer_derivative(self, status, bent, &error);
    }
    free(unknown);
    free(known);
    return answer;
}

// NOLINTNEXTLINE(readability-function-size): of the standard
fmi3Status fmi3GetDirectionalDerivative(void *instance, const uint32_t *unknown, size_t unknowns,
                                        const uint32_t *known, size_t knowns, const double *seed,
                                        size_t seeds, double *value, size_t values)
{
    component *self = instance;
    NEEDS_ALIVE((unknowns == 0 || (unknown && value)) && (knowns == 0 || (known && seed)));
    return differentiate(self, &(derivative_call){__func__, unknown, known, unknowns, knowns, seed,
                                                  value, seeds, values, true});
}

// NOLINTNEXTLINE(readability-function-size): of the standard
fmi3Status fmi3GetAdjointDerivative(void *instance, const uint32_t *unknown, size_t unknowns,
                                    const uint32_t *known, size_t knowns, const double *seed,
                                    size_t seeds, double *value, size_t values)
{
    component *self = instance;
    NEEDS_ALIVE((unknowns == 0 || (unknown && seed)) && (knowns == 0 || (known && value)));
    return differentiate(self, &(derivative_call){__func__, unknown, known, unknowns, knowns, seed,
                                                  value, seeds, values, false});
}

// ---- model exchange ----

fmi3Status fmi3EnterContinuousTimeMode(void *instance)
{
    component *self = instance;
    NEEDS_ALIVE(true);
    ld_error error;
    return answer_status(self, fmu_enter_continuous_time(self->inside, &error), &error);
}

fmi3Status fmi3CompletedIntegratorStep(void *instance, bool no_return, bool *event, bool *terminate)
{
    component *self = instance;
    NEEDS_ALIVE(event && terminate);
    ld_error error;
    (void)no_return;
    return answer_status(self, fmu_complete_step(self->inside, event, terminate, &error), &error);
}

fmi3Status fmi3SetTime(void *instance, double t)
{
    component *self = instance;
    NEEDS_ALIVE(true);
    ld_error error;
    return answer_status(self, fmu_set_time(self->inside, t, &error), &error);
}

fmi3Status fmi3SetContinuousStates(void *instance, const double *x, size_t count)
{
    component *self = instance;
    NEEDS_ALIVE(x || count == 0);
    ld_error error;
    return answer_trial(self, fmu_set_states(self->inside, x, count, &error), &error);
}

static fmi3Status get_vector(component *self, fmu_vector which, double *value, size_t count)
{
    ld_error error;
    NEEDS(value || count == 0);
    return answer_trial(self, fmu_get_vector(self->inside, which, value, count, &error), &error);
}

fmi3Status fmi3GetContinuousStateDerivatives(void *instance, double *rate, size_t count)
{
    return get_vector(instance, FMU_RATES, rate, count);
}

fmi3Status fmi3GetEventIndicators(void *instance, double *indicator, size_t count)
{
    return get_vector(instance, FMU_INDICATORS, indicator, count);
}

fmi3Status fmi3GetContinuousStates(void *instance, double *x, size_t count)
{
    return get_vector(instance, FMU_STATES, x, count);
}

fmi3Status fmi3GetNominalsOfContinuousStates(void *instance, double *nominal, size_t count)
{
    return get_vector(instance, FMU_NOMINALS, nominal, count);
}

fmi3Status fmi3GetNumberOfEventIndicators(void *instance, size_t *count)
{
    component *self = instance;
    NEEDS(count);
    ld_error error;
    return answer_status(self, fmu_count_vector(self->inside, FMU_INDICATORS, count, &error),
                         &error);
}

fmi3Status fmi3GetNumberOfContinuousStates(void *instance, size_t *count)
{
    component *self = instance;
    NEEDS(count);
    ld_error error;
    return answer_status(self, fmu_count_vector(self->inside, FMU_STATES, count, &error), &error);
}
