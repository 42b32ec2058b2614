// The vehicle as a Functional Mock-up Unit for co-simulation by FMI 2.0.4.
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmu/fmi2_interface.h"
#include "vehicle.h"

enum { MESSAGE_SIZE = 1024, PATH_SIZE = 4096 };

static const char TOKEN[] = "{launchdyn-mujoco-vehicle-1}";

typedef struct instance {
    vehicle *vehicle;
    char *name;
    fmi2CallbackFunctions call;
    double t;
    char message[MESSAGE_SIZE];
} instance;

// A state that was got.
typedef struct saved {
    size_t count;
    double t, number[];
} saved;

static void log_line(const fmi2CallbackFunctions *call, const char *name, const char *message)
{
    if (call && call->logger)
        call->logger(call->componentEnvironment, name, fmi2Error, "logStatusError", "%s", message);
}

static fmi2Status outcome(instance *self, bool good)
{
    if (!good)
        log_line(&self->call, self->name, self->message);
    return good ? fmi2OK : fmi2Error;
}

static fmi2Status refuse(void *c, const char *function)
{
    instance *self = c;
    snprintf(self->message, sizeof self->message, "%s: this FMU does not offer it", function);
    return outcome(self, false);
}

// The path of a URI file:///PATH or file://HOST/PATH, or a path, with what stands as %XX.
static bool path_of(const char *uri, char *path, size_t size)
{
    size_t n = 0;
    if (!uri)
        return false;
    if (strncmp(uri, "file:", 5) == 0) {
        uri += 5;
        if (strncmp(uri, "//", 2) == 0)
            uri += 2 + strcspn(uri + 2, "/");
    }
    for (; *uri && n + 1 < size; n++) {
        char digits[3] = "", *end = digits;
        long code = 0;
        if (*uri == '%') {
            snprintf(digits, sizeof digits, "%.2s", uri + 1);
            code = strtol(digits, &end, 16);
        }
        bool coded = end == digits + 2;
        path[n] = coded ? (char)code : *uri;
        uri += coded ? 3 : 1;
    }
    path[n] = '\0';
    return !*uri;
}

const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

const char *fmi2GetVersion(void)
{
    return "2.0";
}

fmi2Status fmi2SetDebugLogging(void *c, int on, size_t count, const char *const *categories)
{
    (void)c, (void)on, (void)count, (void)categories;
    return fmi2OK;
}

// NOLINTNEXTLINE(readability-function-size): of the standard
void *fmi2Instantiate(const char *name, fmi2Type type, const char *guid, const char *resources,
                      const fmi2CallbackFunctions *call, int visible, int logging)
{
    char path[PATH_SIZE], message[MESSAGE_SIZE] = "";
    (void)visible, (void)logging;
    instance *self = calloc(1, sizeof *self);
    if (!self)
        return NULL;
    if (type != fmi2CoSimulation)
        snprintf(message, sizeof message, "this FMU is for co-simulation alone");
    else if (!guid || strcmp(guid, TOKEN) != 0)
        snprintf(message, sizeof message, "the token is not that of this FMU, %s", TOKEN);
    else if (!path_of(resources, path, sizeof path))
        snprintf(message, sizeof message, "the place of the resources is no path");
    else
        self->vehicle = vehicle_create(path, message, sizeof message);
    self->name = name ? strdup(name) : NULL;
    if (!self->vehicle || !self->name) {
        log_line(call, name, message);
        fmi2FreeInstance(self);
        return NULL;
    }
    if (call)
        self->call = *call;
    return self;
}

void fmi2FreeInstance(void *c)
{
    instance *self = c;
    if (!self)
        return;
    vehicle_free(self->vehicle);
    free(self->name);
    free(self);
}

fmi2Status fmi2SetupExperiment(void *c, int tolerance_defined, double tolerance, double start,
                               int stop_defined, double stop)
{
    instance *self = c;
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    self->t = start;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(void *c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(void *c)
{
    instance *self = c;
    return outcome(self, vehicle_start(self->vehicle, self->message, sizeof self->message));
}

fmi2Status fmi2Terminate(void *c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2Reset(void *c)
{
    instance *self = c;
    self->t = 0;
    vehicle_reset(self->vehicle);
    return fmi2OK;
}

fmi2Status fmi2GetReal(void *c, const unsigned *reference, size_t count, double *value)
{
    instance *self = c;
    bool good = true;
    for (size_t i = 0; i < count && good; i++)
        good = vehicle_get(self->vehicle, reference[i], value + i, self->message,
                           sizeof self->message);
    return outcome(self, good);
}

fmi2Status fmi2SetReal(void *c, const unsigned *reference, size_t count, const double *value)
{
    instance *self = c;
    bool good = true;
    for (size_t i = 0; i < count && good; i++)
        good =
            vehicle_set(self->vehicle, reference[i], value[i], self->message, sizeof self->message);
    return outcome(self, good);
}

fmi2Status fmi2DoStep(void *c, double t, double size, int no_return)
{
    instance *self = c;
    (void)no_return;
    if (!(fabs(t - self->t) <= 1e-9 * fmax(1, fabs(t)))) {
        snprintf(self->message, sizeof self->message,
                 "a step from %.17g s, the vehicle is at %.17g s", t, self->t);
        return outcome(self, false);
    }
    self->t = t + size;
    return outcome(self, vehicle_step(self->vehicle, size, self->message, sizeof self->message));
}

// ---- states

fmi2Status fmi2FreeFMUstate(void *c, void **state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

static saved *new_state(instance *self, size_t count)
{
    saved *state = malloc(sizeof *state + count * sizeof *state->number);
    if (state)
        state->count = count;
    else
        snprintf(self->message, sizeof self->message, "no memory for the state");
    return state;
}

fmi2Status fmi2GetFMUstate(void *c, void **state)
{
    instance *self = c;
    saved *now = *state ? *state : new_state(self, vehicle_state_count(self->vehicle));
    if (!now)
        return outcome(self, false);
    now->t = self->t;
    vehicle_save(self->vehicle, now->number);
    *state = now;
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(void *c, void *state)
{
    instance *self = c;
    const saved *now = state;
    self->t = now->t;
    vehicle_load(self->vehicle, now->number);
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(void *c, void *state, size_t *size)
{
    const saved *now = state;
    (void)c;
    *size = sizeof *now + now->count * sizeof *now->number;
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(void *c, void *state, char *bytes, size_t size)
{
    instance *self = c;
    size_t wanted;
    fmi2SerializedFMUstateSize(c, state, &wanted);
    if (size < wanted) {
        snprintf(self->message, sizeof self->message, "the state takes %zu bytes", wanted);
        return outcome(self, false);
    }
    memcpy(bytes, state, wanted);
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t size, void **state)
{
    instance *self = c;
    size_t count = vehicle_state_count(self->vehicle);
    saved *now = new_state(self, count);
    if (!now)
        return outcome(self, false);
    if (size >= sizeof *now + count * sizeof *now->number)
        memcpy(now, bytes, sizeof *now + count * sizeof *now->number);
    if (size < sizeof *now + count * sizeof *now->number || now->count != count) {
        free(now);
        snprintf(self->message, sizeof self->message,
                 "these %zu bytes are no state of this vehicle", size);
        return outcome(self, false);
    }
    *state = now;
    return fmi2OK;
}

// ---- what there is none of

#define NONE_OF(Type, type)                                                                        \
    fmi2Status fmi2Get##Type(void *c, const unsigned *reference, size_t count, type *value)        \
    {                                                                                              \
        (void)reference, (void)value;                                                              \
        return count ? refuse(c, "fmi2Get" #Type) : fmi2OK;                                        \
    }                                                                                              \
    fmi2Status fmi2Set##Type(void *c, const unsigned *reference, size_t count, const type *value)  \
    {                                                                                              \
        (void)reference, (void)value;                                                              \
        return count ? refuse(c, "fmi2Set" #Type) : fmi2OK;                                        \
    }

typedef const char *text;

NONE_OF(Integer, int)
NONE_OF(Boolean, int)
NONE_OF(String, text)

fmi2Status fmi2SetRealInputDerivatives(void *c, const unsigned *reference, size_t count,
                                       const int *order, const double *value)
{
    (void)reference, (void)count, (void)order, (void)value;
    return refuse(c, "fmi2SetRealInputDerivatives");
}

fmi2Status fmi2GetRealOutputDerivatives(void *c, const unsigned *reference, size_t count,
                                        const int *order, double *value)
{
    (void)reference, (void)count, (void)order, (void)value;
    return refuse(c, "fmi2GetRealOutputDerivatives");
}

// NOLINTNEXTLINE(readability-function-size): of the standard
fmi2Status fmi2GetDirectionalDerivative(void *c, const unsigned *unknown, size_t unknowns,
                                        const unsigned *known, size_t knowns, const double *seed,
                                        double *sensitivity)
{
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)seed, (void)sensitivity;
    return refuse(c, "fmi2GetDirectionalDerivative");
}

fmi2Status fmi2CancelStep(void *c)
{
    return refuse(c, "fmi2CancelStep");
}

fmi2Status fmi2GetStatus(void *c, fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind, (void)value;
    return refuse(c, "fmi2GetStatus");
}

fmi2Status fmi2GetRealStatus(void *c, fmi2StatusKind kind, double *value)
{
    instance *self = c;
    if (kind != fmi2LastSuccessfulTime)
        return refuse(c, "fmi2GetRealStatus");
    *value = self->t;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(void *c, fmi2StatusKind kind, int *value)
{
    (void)kind, (void)value;
    return refuse(c, "fmi2GetIntegerStatus");
}

fmi2Status fmi2GetBooleanStatus(void *c, fmi2StatusKind kind, int *value)
{
    *value = 0;
    return kind == fmi2Terminated ? fmi2OK : refuse(c, "fmi2GetBooleanStatus");
}

fmi2Status fmi2GetStringStatus(void *c, fmi2StatusKind kind, const char **value)
{
    (void)kind, (void)value;
    return refuse(c, "fmi2GetStringStatus");
}
