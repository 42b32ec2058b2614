// FMI 2.0 for co-simulation and model exchange over fmu_instance: every function of the standard;
// those of what this FMU does not offer answer with an error and a line of the log.
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmu/fmi2_interface.h"
#include "fmu/fmu_derivatives.h"
#include "fmu/fmu_exchange.h"

enum { PATH_SIZE = 4096 };

// An instance, its importer, and what the last step came to.
typedef struct component {
    fmu_instance *inside;
    fmi2CallbackFunctions call;
    char *name;
    bool terminated;
    fmu_step last;
} component;

static void log_line(const component *self, fmi2Status status, const char *category,
                     const char *text)
{
    if (self->call.logger)
        self->call.logger(self->call.componentEnvironment, self->name, status, category, "%s",
                          text);
}

// What a call came to: LD_OK, or a line of the log.
static fmi2Status answer_status(const component *self, ld_status status, const ld_error *error)
{
    if (!status)
        return fmi2OK;
    if (!self)
        return fmi2Error;
    log_line(self, fmi2Error, "logStatusError", error->text);
    return fmi2Error;
}

// A call that cannot be taken; without an instance there is no log to say why.
static fmi2Status refuse_call(const component *self, const char *function, const char *why)
{
    ld_error error;
    return self
               ? answer_status(self, ld_fail(&error, LD_ERR_INPUT, "%s: %s", function, why), &error)
               : fmi2Error;
}

static fmi2Status not_offered(void *c, const char *function)
{
    ld_error error;
    return answer_status(
        c, ld_fail(&error, LD_ERR_MISSING, "%s: this FMU does not offer it", function), &error);
}

const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

const char *fmi2GetVersion(void)
{
    return "2.0";
}

// Errors are always reported: there is nothing else in the log.
fmi2Status fmi2SetDebugLogging(void *c, int on, size_t count, const char *const *categories)
{
    (void)c, (void)on, (void)count, (void)categories;
    return fmi2OK;
}

// ---- life ----

static int hexadecimal(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

// "file:///a%20b" as "/a b"; what is no such URI stays. False: it does not fit.
static bool path_of(const char *uri, char path[PATH_SIZE])
{
    size_t length = 0;
    bool is_uri = strncmp(uri, "file:", 5) == 0;
    if (is_uri) {
        uri += 5;
        if (strncmp(uri, "//", 2) == 0) // with a host, which is none or this one
            uri = strchr(uri + 2, '/') ? strchr(uri + 2, '/') : "";
    }
    while (*uri && length + 1 < PATH_SIZE) {
        int high = is_uri && uri[0] == '%' ? hexadecimal(uri[1]) : -1;
        int low = high >= 0 ? hexadecimal(uri[2]) : -1;
        path[length++] = low >= 0 ? (char)(16 * high + low) : *uri;
        uri += low >= 0 ? 3 : 1;
    }
    path[length] = '\0';
    return *uri == '\0';
}

static ld_status open_instance(component *self, fmi2Type type, const char *guid,
                               const char *resources, ld_error *error)
{
    char path[PATH_SIZE];
    if (type != fmi2CoSimulation && type != fmi2ModelExchange)
        return ld_fail(error, LD_ERR_INPUT, "found FMU type %d, which is unknown", (int)type);
    if (!guid || !resources || !path_of(resources, path))
        return ld_fail(error, LD_ERR_INPUT,
                       "GUID or location of the resources is missing or too long");
    self->inside = fmu_instance_new(path, guid, type == fmi2ModelExchange, error);
    return self->inside ? LD_OK : error->status;
}

static void free_component(component *self)
{
    fmu_instance_free(self->inside);
    free(self->name);
    free(self);
}

// NOLINTNEXTLINE(readability-function-size): of the standard
void *fmi2Instantiate(const char *name, fmi2Type type, const char *guid, const char *resources,
                      const fmi2CallbackFunctions *call, int visible, int logging)
{
    ld_error error;
    (void)visible, (void)logging;
    component *self = call ? calloc(1, sizeof *self) : NULL;
    if (!self)
        return NULL;
    self->call = *call;
    self->name = strdup(name ? name : "");
    if (self->name &&
        !answer_status(self, open_instance(self, type, guid, resources, &error), &error))
        return self;
    free_component(self);
    return NULL;
}

void fmi2FreeInstance(void *c)
{
    if (c)
        free_component(c);
}

fmi2Status fmi2SetupExperiment(void *c, int tolerance_defined, double tolerance, double start,
                               int stop_defined, double stop)
{
    component *self = c;
    NEEDS_ALIVE(true);
    ld_error error;
    (void)stop_defined, (void)stop;
    return answer_status(
        self, fmu_set_experiment(self->inside, start, tolerance_defined ? tolerance : 0, &error),
        &error);
}

fmi2Status fmi2EnterInitializationMode(void *c)
{
    component *self = c;
    NEEDS_ALIVE(true);
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(void *c)
{
    component *self = c;
    NEEDS_ALIVE(true);
    ld_error error;
    return answer_status(self, fmu_go(self->inside, &error), &error);
}

fmi2Status fmi2Terminate(void *c)
{
    component *self = c;
    NEEDS_ALIVE(true);
    self->terminated = true;
    return fmi2OK;
}

fmi2Status fmi2Reset(void *c)
{
    component *self = c;
    NEEDS(true);
    ld_error error;
    self->last = (fmu_step){0};
    self->terminated = false;
    return answer_status(self, fmu_instance_reset(self->inside, &error), &error);
}

// ---- values ----

fmi2Status fmi2GetReal(void *c, const unsigned *reference, size_t count, double *value)
{
    component *self = c;
    NEEDS(count == 0 || (reference && value));
    ld_error error;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; !status && i < count; i++)
        status = answer_status(
            self, fmu_get_number(self->inside, reference[i], FMU_REAL, &value[i], &error), &error);
    return status;
}

fmi2Status fmi2SetReal(void *c, const unsigned *reference, size_t count, const double *value)
{
    component *self = c;
    NEEDS_ALIVE(count == 0 || (reference && value));
    ld_error error;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; !status && i < count; i++)
        status = answer_status(
            self, fmu_set_number(self->inside, reference[i], FMU_REAL, value[i], &error), &error);
    return status;
}

fmi2Status fmi2GetBoolean(void *c, const unsigned *reference, size_t count, int *value)
{
    component *self = c;
    NEEDS(count == 0 || (reference && value));
    ld_error error;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; !status && i < count; i++) {
        double number;
        status = answer_status(
            self, fmu_get_number(self->inside, reference[i], FMU_BOOLEAN, &number, &error), &error);
        value[i] = number == 1;
    }
    return status;
}

fmi2Status fmi2SetBoolean(void *c, const unsigned *reference, size_t count, const int *value)
{
    component *self = c;
    NEEDS_ALIVE(count == 0 || (reference && value));
    ld_error error;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; !status && i < count; i++)
        status = answer_status(
            self, fmu_set_number(self->inside, reference[i], FMU_BOOLEAN, value[i] != 0, &error),
            &error);
    return status;
}

fmi2Status fmi2GetString(void *c, const unsigned *reference, size_t count, const char **value)
{
    component *self = c;
    NEEDS(count == 0 || (reference && value));
    ld_error error;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; !status && i < count; i++)
        status = answer_status(self, fmu_get_text(self->inside, reference[i], &value[i], &error),
                               &error);
    return status;
}

fmi2Status fmi2SetString(void *c, const unsigned *reference, size_t count, const char *const *value)
{
    component *self = c;
    NEEDS_ALIVE(count == 0 || (reference && value));
    ld_error error;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; !status && i < count; i++)
        status =
            answer_status(self, fmu_set_text(self->inside, reference[i], value[i], &error), &error);
    return status;
}

fmi2Status fmi2GetInteger(void *c, const unsigned *reference, size_t count, int *value)
{
    component *self = c;
    NEEDS(count == 0 || (reference && value));
    ld_error error;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; !status && i < count; i++) {
        double number;
        status = answer_status(
            self, fmu_get_number(self->inside, reference[i], FMU_INTEGER, &number, &error), &error);
        value[i] = status ? 0 : (int)number;
    }
    return status;
}

fmi2Status fmi2SetInteger(void *c, const unsigned *reference, size_t count, const int *value)
{
    component *self = c;
    NEEDS_ALIVE(count == 0 || (reference && value));
    ld_error error;
    fmi2Status status = fmi2OK;
    for (size_t i = 0; !status && i < count; i++)
        status = answer_status(
            self, fmu_set_number(self->inside, reference[i], FMU_INTEGER, value[i], &error),
            &error);
    return status;
}

// ---- steps ----

fmi2Status fmi2DoStep(void *c, double t, double size, int no_return)
{
    component *self = c;
    NEEDS_ALIVE(true);
    ld_error error;
    (void)no_return;
    fmi2Status status =
        answer_status(self, fmu_step_on(self->inside, t, size, false, &self->last, &error), &error);
    return !status && self->last.ended ? fmi2Discard : status;
}

fmi2Status fmi2CancelStep(void *c)
{
    return not_offered(c, "fmi2CancelStep");
}

fmi2Status fmi2GetStatus(void *c, fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind, (void)value;
    return not_offered(c, "fmi2GetStatus");
}

fmi2Status fmi2GetRealStatus(void *c, fmi2StatusKind kind, double *value)
{
    const component *self = c;
    NEEDS(value);
    if (kind != fmi2LastSuccessfulTime)
        return not_offered(c, "fmi2GetRealStatus");
    *value = self->last.t;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(void *c, fmi2StatusKind kind, int *value)
{
    (void)kind, (void)value;
    return not_offered(c, "fmi2GetIntegerStatus");
}

fmi2Status fmi2GetBooleanStatus(void *c, fmi2StatusKind kind, int *value)
{
    const component *self = c;
    NEEDS(value);
    if (kind != fmi2Terminated)
        return not_offered(c, "fmi2GetBooleanStatus");
    *value = self->last.ended;
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(void *c, fmi2StatusKind kind, const char **value)
{
    (void)kind, (void)value;
    return not_offered(c, "fmi2GetStringStatus");
}

fmi2Status fmi2SetRealInputDerivatives(void *c, const unsigned *reference, size_t count,
                                       const int *order, const double *value)
{
    (void)reference, (void)count, (void)order, (void)value;
    return not_offered(c, "fmi2SetRealInputDerivatives");
}

fmi2Status fmi2GetRealOutputDerivatives(void *c, const unsigned *reference, size_t count,
                                        const int *order, double *value)
{
    (void)reference, (void)count, (void)order, (void)value;
    return not_offered(c, "fmi2GetRealOutputDerivatives");
}

// ---- states ----

fmi2Status fmi2FreeFMUstate(void *c, void **state)
{
    component *self = c;
    NEEDS(state);
    free(*state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2GetFMUstate(void *c, void **state)
{
    component *self = c;
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

fmi2Status fmi2SetFMUstate(void *c, void *state)
{
    component *self = c;
    NEEDS(state);
    ld_error error;
    ld_status status = fmu_load(self->inside, state, &error);
    self->terminated &= status != LD_OK;
    return answer_status(self, status, &error);
}

fmi2Status fmi2SerializedFMUstateSize(void *c, void *state, size_t *size)
{
    component *self = c;
    NEEDS(state && size);
    *size = ((const fmu_state *)state)->size;
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(void *c, void *state, char *bytes, size_t size)
{
    component *self = c;
    NEEDS(state && bytes);
    ld_error error;
    return answer_status(self, fmu_state_write(state, bytes, size, &error), &error);
}

fmi2Status fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t size, void **state)
{
    component *self = c;
    NEEDS(bytes && state);
    ld_error error;
    fmu_state *read;
    ld_status status = fmu_state_read(bytes, size, &read, &error);
    if (!status)
        *state = read;
    return answer_status(self, status, &error);
}

// Of what is asked for at a point that is tried: where the equations have no solution, a shorter
// step may find one.
static fmi2Status answer_trial(const component *self, ld_status status, const ld_error *error)
{
    if (status != LD_ERR_NUMERIC)
        return answer_status(self, status, error);
    log_line(self, fmi2Discard, "logStatusDiscard", error->text);
    return fmi2Discard;
}

// ---- derivatives ----

// `bent`: found, but less well than elsewhere.
static fmi2Status answer_derivative(const component *self, ld_status status, bool bent,
                                    const ld_error *error)
{
    if (status || !bent)
        return answer_trial(self, status, error);
    log_line(self, fmi2Warning, "logStatusWarning", error->text);
    return fmi2Warning;
}

// NOLINTNEXTLINE(readability-function-size): of the standard
fmi2Status fmi2GetDirectionalDerivative(void *c, const unsigned *unknown, size_t unknowns,
                                        const unsigned *known, size_t knowns, const double *seed,
                                        double *sensitivity)
{
    component *self = c;
    NEEDS_ALIVE((unknowns == 0 || (unknown && sensitivity)) && (knowns == 0 || (known && seed)));
    const fmu_jacobian of = {unknown, unknowns, known, knowns};
    bool bent;
    ld_error error;
    ld_status status = fmu_derivative_along(self->inside, &of, seed, sensitivity, &bent, &error);
    return answer_derivative(self, status, bent, &error);
}

// ---- model exchange ----

fmi2Status fmi2EnterEventMode(void *c)
{
    component *self = c;
    NEEDS_ALIVE(true);
    ld_error error;
    return answer_status(self, fmu_enter_event_mode(self->inside, &error), &error);
}

fmi2Status fmi2NewDiscreteStates(void *c, fmi2EventInfo *info)
{
    component *self = c;
    NEEDS_ALIVE(info);
    ld_error error;
    fmu_update update;
    ld_status status = fmu_update_states(self->inside, &update, &error);
    *info = (fmi2EventInfo){
        .terminateSimulation = update.ended,
        .valuesOfContinuousStatesChanged = update.changed,
        .nextEventTimeDefined = update.next < INFINITY,
        .nextEventTime = update.next,
    };
    return answer_status(self, status, &error);
}

fmi2Status fmi2EnterContinuousTimeMode(void *c)
{
    component *self = c;
    NEEDS_ALIVE(true);
    ld_error error;
    return answer_status(self, fmu_enter_continuous_time(self->inside, &error), &error);
}

fmi2Status fmi2CompletedIntegratorStep(void *c, int no_return, int *enter_event, int *terminate)
{
    component *self = c;
    NEEDS_ALIVE(enter_event && terminate);
    ld_error error;
    bool at_event, ended;
    (void)no_return;
    ld_status status = fmu_complete_step(self->inside, &at_event, &ended, &error);
    *enter_event = at_event;
    *terminate = ended;
    return answer_status(self, status, &error);
}

fmi2Status fmi2SetTime(void *c, double t)
{
    component *self = c;
    NEEDS_ALIVE(true);
    ld_error error;
    return answer_status(self, fmu_set_time(self->inside, t, &error), &error);
}

fmi2Status fmi2SetContinuousStates(void *c, const double *x, size_t count)
{
    component *self = c;
    NEEDS_ALIVE(x || count == 0);
    ld_error error;
    return answer_trial(self, fmu_set_states(self->inside, x, count, &error), &error);
}

static fmi2Status get_vector(component *self, fmu_vector which, double *value, size_t count)
{
    ld_error error;
    NEEDS(value || count == 0);
    return answer_trial(self, fmu_get_vector(self->inside, which, value, count, &error), &error);
}

fmi2Status fmi2GetDerivatives(void *c, double *rate, size_t count)
{
    return get_vector(c, FMU_RATES, rate, count);
}

fmi2Status fmi2GetEventIndicators(void *c, double *indicator, size_t count)
{
    return get_vector(c, FMU_INDICATORS, indicator, count);
}

fmi2Status fmi2GetContinuousStates(void *c, double *x, size_t count)
{
    return get_vector(c, FMU_STATES, x, count);
}

fmi2Status fmi2GetNominalsOfContinuousStates(void *c, double *nominal, size_t count)
{
    return get_vector(c, FMU_NOMINALS, nominal, count);
}
