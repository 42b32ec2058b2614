// An FMU for the tests of base.kind fmu, for FMI 2 or 3 as FMI says: a rigid platform whose place
// and rotation vector are held by linear springs and dampers against where they would be without
// load, m r'' = -k r - c r' + F + m g, J p'' = -kr p - cr p' + M. Its equations are solved exactly
// for a wrench that is held. It misbehaves where it is asked to.
#define _GNU_SOURCE // close_range; NOLINT(bugprone-reserved-identifier)
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fmu/fmi2_interface.h"
#include "fmu/fmi3_interface.h"
#include "math/vectors/rotation_vector.h"

enum { // value references
    FORCE = 0,
    MOMENT = 3,
    POSITION = 10,
    QUATERNION = 13,
    VELOCITY = 17,
    RATE = 20,
    ANGLES = 23,    // yaw, pitch, roll
    BODY_RATE = 26, // in its own axes
    MASS = 30,
    STIFFNESS = 31,
    DAMPING = 32,
    INERTIA = 33,
    TURNING_STIFFNESS = 34,
    TURNING_DAMPING = 35,
    GRAVITY = 36,
    MISHAP = 40, // whole number
    MISHAP_AT = 41,
    VALUES = 42,
    TUNING = 60 // text
};

enum {
    NOTHING,
    CRASH,
    HANG,
    LEAVE,
    DISCARD,
    STUCK,
    NOT_A_NUMBER,
    REFUSE,
    NOISE,
    ENDS,
    LONG,
    MOVES,
    FIXED,         // by steps of MISHAP_AT alone (FMI 3)
    DEAF,          // closes all that is open, and waits
    MURDER,        // ends the process that asks, and continues
    MURDER_AT_LAST // the same when it terminates
};

typedef struct platform {
    double value[VALUES], rate[VALUES], t;
    double next;       // where the last step was to end
    double x[6], u[6]; // place, rotation vector; their rates
    bool begun;
    fmi2CallbackFunctions call;
    fmi3Logger log;
    void *environment;
} platform;

static void say(const platform *self, const char *text)
{
    if (self->log)
        (self->log)(self->environment, fmi3Error, "error", text);
    else if (self->call.logger)
        self->call.logger(self->call.componentEnvironment, "base", fmi2Error, "error", "%s", text);
}

static void begin_values(platform *self)
{
    const double start[] = {1000, 1e6, 2e3, 1000, 1e6, 2e3, 9.81};
    memcpy(self->value + MASS, start, sizeof start);
}

// Force or moment i and what holds it.
static double load(const platform *self, int i, double *m, double *k, double *c)
{
    int at = i < 3 ? MASS : INERTIA;
    *m = self->value[at];
    *k = self->value[at + 1];
    *c = self->value[at + 2];
    return self->value[FORCE + i] - (i == 1 ? *m * self->value[GRAVITY] : 0);
}

// In equilibrium under the wrench that it is given before it begins.
static void settle(platform *self)
{
    double m, k, c;
    for (int i = 0; i < 6; i++) {
        self->x[i] = load(self, i, &m, &k, &c) / k;
        self->u[i] = 0;
    }
}

static void leave_initialization(platform *self)
{
    settle(self);
    self->begun = true;
    self->next = self->t;
    if ((int)self->value[MISHAP] == MOVES)
        self->x[1] += 1e-3;
}

// m x'' + c x' + k x = f + s t over h: the damped oscillation about f/k - c s/k^2 + s t/k.
static void swing(double m, double k, double c, const double f[2], double h, double *x, double *u)
{
    double drift = f[1] / k, rest = f[0] / k - c * drift / k;
    double decay = c / (2 * m), omega = sqrt(k / m - decay * decay), a = *x - rest;
    double b = (*u - drift + decay * a) / omega, e = exp(-decay * h), co = cos(omega * h),
           si = sin(omega * h);
    *x = rest + drift * h + e * (a * co + b * si);
    *u = drift + e * ((b * omega - decay * a) * co - (a * omega + decay * b) * si);
}

static void advance(platform *self, double h)
{
    for (int i = 0; i < 6; i++) {
        double m, k, c, f = load(self, i, &m, &k, &c);
        swing(m, k, c, (const double[]){f, self->rate[FORCE + i]}, h, &self->x[i], &self->u[i]);
        self->rate[FORCE + i] = 0; // of that step
    }
    self->t += h;
}

static double get(platform *self, unsigned reference)
{
    if (!self->begun)
        settle(self);
    v3 turn = v3_from(self->x + 3);
    m3 A = rv_exp(turn);
    quat q = q_from_matrix(A);
    v3 w = m3_apply(rv_left_jacobian(turn), v3_from(self->u + 3));
    double *at = self->value;
    memcpy(at + POSITION, self->x, 3 * sizeof *at);
    memcpy(at + QUATERNION, &q, sizeof q);
    memcpy(at + VELOCITY, self->u, 3 * sizeof *at);
    v3_store(at + RATE, w);
    v3_store(at + BODY_RATE, m3_apply_transposed(A, w));
    m3_yaw_pitch_roll(&A, at + ANGLES);
    return self->value[reference];
}

// Its text.
static int tune(platform *self, const char *word)
{
    if (strcmp(word, "half as stiff") == 0)
        self->value[STIFFNESS] *= 0.5;
    return strcmp(word, "half as stiff") == 0 ? fmi2OK : fmi2Error;
}

// Whatever goes wrong in the step from t; fmi2OK: nothing.
static int mishap(platform *self, double t, double h)
{
    int what = t + h > self->value[MISHAP_AT] ? (int)self->value[MISHAP] : NOTHING;
    switch (what) {
    case CRASH:
        raise(SIGSEGV);
        break;
    case HANG:
        for (;;)
            pause();
    case DEAF:
        close_range(0, ~0U, 0);
        for (;;)
            pause();
    case MURDER:
        kill(getppid(), SIGKILL);
        break;
    case LEAVE:
        exit(3);
    case NOT_A_NUMBER:
        self->x[1] = NAN;
        break;
    case REFUSE:
        say(self, "the platform has had enough.\n");
        return fmi2Error;
    case NOISE:
        printf("noise\n");
        fflush(stdout);
        fprintf(stderr, "noise\n");
        break;
    default:
        break;
    }
    return fmi2OK;
}

static void mishap_at_last(const platform *self)
{
    if ((int)self->value[MISHAP] == MURDER_AT_LAST)
        kill(getppid(), SIGKILL);
}

// Where the step ends; before t + h it is discarded.
static double reach(const platform *self, double t, double h)
{
    switch ((int)self->value[MISHAP]) {
    case DISCARD: // at most a quarter of a millisecond in one go
        return t + fmin(h, 0.25e-3);
    case STUCK: // all of a step or nothing
        return h > 0.3e-3 ? t : t + h;
    case ENDS:
        return t + h > self->value[MISHAP_AT] ? t : t + h;
    default:
        return t + h;
    }
}

#if FMI == 2

#define EXPORTED __attribute__((visibility("default")))

EXPORTED void *fmi2Instantiate(const char *name, fmi2Type type, const char *guid,
                               const char *resources, const fmi2CallbackFunctions *call,
                               int visible, int logging)
{
    (void)name, (void)type, (void)resources, (void)visible, (void)logging;
    platform *self = strcmp(guid, "platform") == 0 ? calloc(1, sizeof *self) : NULL;
    if (self) {
        self->call = *call;
        begin_values(self);
    }
    return self;
}

EXPORTED void fmi2FreeInstance(void *c)
{
    free(c);
}

EXPORTED fmi2Status fmi2SetupExperiment(void *c, int tolerance_defined, double tolerance,
                                        double start, int stop_defined, double stop)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    ((platform *)c)->t = start;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2EnterInitializationMode(void *c)
{
    (void)c;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2ExitInitializationMode(void *c)
{
    leave_initialization(c);
    return fmi2OK;
}

EXPORTED fmi2Status fmi2Terminate(void *c)
{
    mishap_at_last(c);
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetReal(void *c, const unsigned *reference, size_t count, double *value)
{
    for (size_t i = 0; i < count; i++)
        value[i] = get(c, reference[i]);
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetReal(void *c, const unsigned *reference, size_t count,
                                const double *value)
{
    for (size_t i = 0; i < count; i++)
        ((platform *)c)->value[reference[i]] = value[i];
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetRealInputDerivatives(void *c, const unsigned *reference, size_t count,
                                                const int *order, const double *value)
{
    for (size_t i = 0; i < count; i++) {
        if (order[i] != 1 || reference[i] >= POSITION)
            return fmi2Error;
        ((platform *)c)->rate[reference[i]] = value[i];
    }
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetInteger(void *c, const unsigned *reference, size_t count,
                                   const int *value)
{
    for (size_t i = 0; i < count; i++)
        ((platform *)c)->value[reference[i]] = value[i];
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetString(void *c, const unsigned *reference, size_t count,
                                  const char *const *value)
{
    return reference[0] == TUNING && count == 1 ? (fmi2Status)tune(c, value[0]) : fmi2Error;
}

EXPORTED fmi2Status fmi2DoStep(void *c, double t, double size, int no_return)
{
    platform *self = c;
    double end = reach(self, t, size);
    (void)no_return;
    int wrong = mishap(self, t, size);
    if (wrong)
        return (fmi2Status)wrong;
    advance(self, end - t);
    return end < t + size ? fmi2Discard : fmi2OK;
}

EXPORTED fmi2Status fmi2GetRealStatus(void *c, fmi2StatusKind kind, double *value)
{
    (void)kind;
    *value = ((platform *)c)->t;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetBooleanStatus(void *c, fmi2StatusKind kind, int *value)
{
    (void)kind;
    *value = (int)((platform *)c)->value[MISHAP] == ENDS;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetFMUstate(void *c, void **state)
{
    *state = *state ? *state : malloc(sizeof(platform));
    memcpy(*state, c, sizeof(platform));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetFMUstate(void *c, void *state)
{
    memcpy(c, state, sizeof(platform));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2FreeFMUstate(void *c, void **state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

#else

#define EXPORTED __attribute__((visibility("default")))

EXPORTED void *fmi3InstantiateCoSimulation(const char *name, const char *token,
                                           const char *resources, bool visible, bool logging,
                                           bool event_mode, bool early_return,
                                           const uint32_t *intermediate, size_t intermediates,
                                           void *environment, fmi3Logger log,
                                           fmi3IntermediateUpdate update)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)event_mode;
    (void)early_return, (void)intermediate, (void)intermediates, (void)update;
    platform *self = strcmp(token, "platform") == 0 ? calloc(1, sizeof *self) : NULL;
    if (self) {
        self->log = log;
        self->environment = environment;
        begin_values(self);
    }
    return self;
}

EXPORTED void fmi3FreeInstance(void *c)
{
    free(c);
}

EXPORTED fmi3Status fmi3EnterInitializationMode(void *c, bool tolerance_defined, double tolerance,
                                                double start, bool stop_defined, double stop)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    ((platform *)c)->t = start;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3ExitInitializationMode(void *c)
{
    leave_initialization(c);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3Terminate(void *c)
{
    mishap_at_last(c);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetFloat64(void *c, const uint32_t *reference, size_t references,
                                   double *value, size_t values)
{
    bool array = references == 1; // whose elements have the references that follow
    for (size_t i = 0; i < values; i++)
        value[i] = get(c, array ? reference[0] + (uint32_t)i : reference[i]);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFloat64(void *c, const uint32_t *reference, size_t references,
                                   const double *value, size_t values)
{
    bool array = references == 1;
    for (size_t i = 0; i < values; i++)
        ((platform *)c)->value[array ? reference[0] + (uint32_t)i : reference[i]] = value[i];
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetInt32(void *c, const uint32_t *reference, size_t references,
                                 const int32_t *value, size_t values)
{
    (void)values;
    for (size_t i = 0; i < references; i++)
        ((platform *)c)->value[reference[i]] = value[i];
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetString(void *c, const uint32_t *reference, size_t references,
                                  const char *const *value, size_t values)
{
    return reference[0] == TUNING && references == 1 && values == 1 ? (fmi3Status)tune(c, value[0])
                                                                    : fmi3Error;
}

// As a unit does that steps by a step of its own: it stands at the last of these that ends within
// the step, says so, and takes the next step only from where this one was to end.
static int advance_fixed(platform *self, double t, double end)
{
    const double own = self->value[MISHAP_AT], rounding = 1e-12;
    if (fabs(t - self->next) > rounding) {
        say(self, "this step does not begin where the last one was to end");
        return fmi2Error;
    }
    while (self->t + own <= end + rounding)
        advance(self, own);
    self->next = end;
    return fmi2OK;
}

EXPORTED fmi3Status fmi3DoStep(void *c, double t, double size, bool no_return, bool *event,
                               bool *terminate, bool *early, double *reached)
{
    platform *self = c;
    (void)no_return;
    double end = reach(self, t, size);
    *event = *early = *terminate = false;
    if ((int)self->value[MISHAP] == FIXED) {
        int wrong = advance_fixed(self, t, end);
        *reached = self->t;
        return (fmi3Status)wrong;
    }
    *early = end < t + size;
    *reached = *early ? end : end - 0.25 * size; // as if steps of its own had ended there
    *terminate = (int)self->value[MISHAP] == ENDS && end == t;
    int wrong = mishap(self, t, size);
    if (wrong)
        return (fmi3Status)wrong;
    advance(self, end - t);
    return *early && end == t ? fmi3Discard : fmi3OK;
}

EXPORTED fmi3Status fmi3GetFMUState(void *c, void **state)
{
    *state = *state ? *state : malloc(sizeof(platform));
    memcpy(*state, c, sizeof(platform));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFMUState(void *c, void *state)
{
    memcpy(c, state, sizeof(platform));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3FreeFMUState(void *c, void **state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SerializedFMUStateSize(void *c, void *state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(platform);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SerializeFMUState(void *c, void *state, uint8_t *bytes, size_t size)
{
    (void)c;
    memcpy(bytes, state, size);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3DeserializeFMUState(void *c, const uint8_t *bytes, size_t size,
                                            void **state)
{
    platform *read = malloc(sizeof *read);
    memcpy(read, bytes, size);
    read->log = ((platform *)c)->log;
    read->environment = ((platform *)c)->environment;
    *state = read;
    return fmi3OK;
}

#endif
