// An importer for model exchange, FMI 2.0 and 3.0: CVODE takes the steps. It does what the standard
// says: a step's end is reported, a root or a time event is an event, after which it begins again.
#ifndef LD_TESTS_SUPPORT_FMU_IMPORTER_H
#define LD_TESTS_SUPPORT_FMU_IMPORTER_H

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "fmu/fmi2_interface.h"
#include "fmu/fmi3_interface.h"
#include "support/fmu.h"

enum { IMPORTER_MOST = 512 };

typedef struct importer importer;

// Says an input before the FMU is asked at time t; NULL: there is none.
typedef void (*importer_input)(importer *self, double t);

struct importer {
    const unpacked_fmu *fmu;
    int version;
    void *instance;
    importer_input input;
    void (*sample)(importer *self); // records, where it continues from and before events; or NULL
    size_t states, indicators;
    double t, x[IMPORTER_MOST], next; // [s] where it is; when the next time event comes
    bool ended;
    int events, steps; // so far
    SUNContext context;
    N_Vector y, tolerance;
    SUNNonlinearSolver solver;
    void *cvode;
};

#define OK_2(self, name, ...)                                                                      \
    assert_int_equal(FMU_FUNCTION((self)->fmu, name)((self)->instance, __VA_ARGS__), fmi2OK)
#define OK_3(self, name, ...)                                                                      \
    assert_int_equal(FMU_FUNCTION((self)->fmu, name)((self)->instance, __VA_ARGS__), fmi3OK)

// ---- the FMU's side ----

static inline void importer_quiet_2(void *environment, const char *name, fmi2Status status,
                                    const char *category, const char *message, ...)
{
    (void)environment, (void)name, (void)status, (void)category;
    printf("    log: %s\n", message);
}

static inline void importer_log_3(void *environment, fmi3Status status, const char *category,
                                  const char *message)
{
    (void)environment, (void)status, (void)category;
    printf("    log: %s\n", message);
}

static inline void importer_open(importer *self, const unpacked_fmu *fmu, int version)
{
    static const fmi2CallbackFunctions call = {.logger = importer_quiet_2};
    char uri[256];
    *self = (importer){.fmu = fmu, .version = version, .next = INFINITY};
    snprintf(uri, sizeof uri, "file://%s", fmu->resources);
    self->instance =
        version == 2 ? FMU_FUNCTION(fmu, fmi2Instantiate)("two", fmi2ModelExchange, fmu->token, uri,
                                                          &call, 0, 0)
                     : FMU_FUNCTION(fmu, fmi3InstantiateModelExchange)(
                           "one", fmu->token, fmu->resources, false, false, NULL, importer_log_3);
    assert_non_null(self->instance);
}

static inline void importer_place(importer *self, double t, const double *x)
{
    if (self->version == 2) {
        OK_2(self, fmi2SetTime, t);
        OK_2(self, fmi2SetContinuousStates, x, self->states);
    } else {
        OK_3(self, fmi3SetTime, t);
        OK_3(self, fmi3SetContinuousStates, x, self->states);
    }
    if (self->input)
        self->input(self, t);
}

static inline void importer_rates(importer *self, double *rate)
{
    if (self->version == 2)
        OK_2(self, fmi2GetDerivatives, rate, self->states);
    else
        OK_3(self, fmi3GetContinuousStateDerivatives, rate, self->states);
}

static inline void importer_indicators(importer *self, double *value)
{
    if (self->version == 2)
        OK_2(self, fmi2GetEventIndicators, value, self->indicators);
    else
        OK_3(self, fmi3GetEventIndicators, value, self->indicators);
}

static inline void importer_get_states(importer *self)
{
    if (self->version == 2)
        OK_2(self, fmi2GetContinuousStates, self->x, self->states);
    else
        OK_3(self, fmi3GetContinuousStates, self->x, self->states);
}

// Whether the FMU asks for event mode at the end of a step.
static inline bool importer_complete(importer *self)
{
    int at_event = 0, terminate = 0;
    bool at_event_3 = false, terminate_3 = false;
    if (self->version == 2)
        OK_2(self, fmi2CompletedIntegratorStep, 1, &at_event, &terminate);
    else
        OK_3(self, fmi3CompletedIntegratorStep, true, &at_event_3, &terminate_3);
    self->ended |= terminate || terminate_3;
    return at_event || at_event_3;
}

// Event mode is on; continuous-time mode after it.
static inline void importer_update(importer *self)
{
    fmi2EventInfo info = {.newDiscreteStatesNeeded = 1};
    bool again = true, terminate = false, nominals, values, defined = false;
    double next = 0;
    while (self->version == 2 && info.newDiscreteStatesNeeded)
        OK_2(self, fmi2NewDiscreteStates, &info);
    while (self->version == 3 && again)
        OK_3(self, fmi3UpdateDiscreteStates, &again, &terminate, &nominals, &values, &defined,
             &next);
    if (self->version == 2) {
        defined = info.nextEventTimeDefined;
        terminate = info.terminateSimulation;
        next = info.nextEventTime;
    }
    self->next = defined ? next : INFINITY;
    self->ended |= terminate;
    importer_get_states(self);
    if (self->ended)
        return;
    if (self->version == 2)
        assert_int_equal(FMU_FUNCTION(self->fmu, fmi2EnterContinuousTimeMode)(self->instance),
                         fmi2OK);
    else
        assert_int_equal(FMU_FUNCTION(self->fmu, fmi3EnterContinuousTimeMode)(self->instance),
                         fmi3OK);
}

// Another time alone leaves the states where they are.
static inline void importer_look_at_states(importer *self)
{
    double x[IMPORTER_MOST];
    memcpy(x, self->x, self->states * sizeof *x);
    OK_3(self, fmi3SetTime, self->t + 1e-9);
    importer_get_states(self);
    assert_memory_equal(x, self->x, self->states * sizeof *x);
    OK_3(self, fmi3SetTime, self->t);
}

static inline void importer_event(importer *self)
{
    self->events++;
    assert_int_equal(self->version == 2
                         ? (int)FMU_FUNCTION(self->fmu, fmi2EnterEventMode)(self->instance)
                         : (int)FMU_FUNCTION(self->fmu, fmi3EnterEventMode)(self->instance),
                     0);
    importer_update(self);
    if (self->version == 3 && !self->ended)
        importer_look_at_states(self);
}

// A number, by name.
static inline double importer_value(importer *self, const char *name)
{
    unsigned reference = reference_of(self->fmu, name);
    double value;
    if (self->version == 2)
        OK_2(self, fmi2GetReal, &reference, 1, &value);
    else
        OK_3(self, fmi3GetFloat64, &reference, 1, &value, 1);
    return value;
}

// From the instance to its first continuous-time mode.
static inline void importer_start(importer *self, double t)
{
    if (self->version == 2) {
        char count[16];
        OK_2(self, fmi2SetupExperiment, 0, 0, t, 0, 0);
        assert_int_equal(FMU_FUNCTION(self->fmu, fmi2EnterInitializationMode)(self->instance), 0);
        assert_int_equal(FMU_FUNCTION(self->fmu, fmi2ExitInitializationMode)(self->instance), 0);
        attribute_after(self->fmu->description, "numberOfEventIndicators", count, sizeof count);
        self->indicators = (size_t)atoi(count);
        for (const char *at = self->fmu->description; (at = strstr(at, " derivative=\"")); at++)
            self->states++;
    } else {
        OK_3(self, fmi3EnterInitializationMode, false, 0, t, false, 0);
        assert_int_equal(FMU_FUNCTION(self->fmu, fmi3ExitInitializationMode)(self->instance), 0);
        OK_3(self, fmi3GetNumberOfContinuousStates, &self->states);
        OK_3(self, fmi3GetNumberOfEventIndicators, &self->indicators);
    }
    assert_true(self->states > 0 && self->states < IMPORTER_MOST);
    self->t = t;
    importer_update(self);
}

static inline void importer_close(importer *self)
{
    if (self->cvode) {
        CVodeFree(&self->cvode);
        SUNNonlinSolFree(self->solver);
        N_VDestroy(self->y);
        N_VDestroy(self->tolerance);
        SUNContext_Free(&self->context);
    }
    if (self->version == 2)
        FMU_FUNCTION(self->fmu, fmi2FreeInstance)(self->instance);
    else
        FMU_FUNCTION(self->fmu, fmi3FreeInstance)(self->instance);
}

// ---- CVODE's side ----

static inline int importer_f(double t, N_Vector y, N_Vector y_dot, void *user)
{
    importer_place(user, t, N_VGetArrayPointer(y));
    importer_rates(user, N_VGetArrayPointer(y_dot));
    return 0;
}

static inline int importer_g(double t, N_Vector y, double *value, void *user)
{
    importer_place(user, t, N_VGetArrayPointer(y));
    importer_indicators(user, value);
    return 0;
}

// Adams methods with functional iteration: these equations are hardly stiff.
static inline void importer_integrate(importer *self, double tolerance)
{
    double *atol;
    assert_int_equal(SUNContext_Create(NULL, &self->context), 0);
    self->y = N_VMake_Serial((sunindextype)self->states, self->x, self->context);
    self->tolerance = N_VNew_Serial((sunindextype)self->states, self->context);
    atol = N_VGetArrayPointer(self->tolerance);
    if (self->version == 2)
        OK_2(self, fmi2GetNominalsOfContinuousStates, atol, self->states);
    else
        OK_3(self, fmi3GetNominalsOfContinuousStates, atol, self->states);
    for (size_t i = 0; i < self->states; i++) {
        assert_true(atol[i] > 0);
        atol[i] *= tolerance;
    }
    self->cvode = CVodeCreate(CV_ADAMS, self->context);
    assert_int_equal(CVodeInit(self->cvode, importer_f, self->t, self->y), 0);
    assert_int_equal(CVodeSetUserData(self->cvode, self), 0);
    assert_int_equal(CVodeSVtolerances(self->cvode, tolerance, self->tolerance), 0);
    assert_int_equal(CVodeRootInit(self->cvode, (int)self->indicators, importer_g), 0);
    assert_int_equal(CVodeSetNoInactiveRootWarn(self->cvode), 0);
    assert_int_equal(CVodeSetMaxNumSteps(self->cvode, 1000000), 0);
    self->solver = SUNNonlinSol_FixedPoint(self->y, 0, self->context);
    assert_int_equal(CVodeSetNonlinearSolver(self->cvode, self->solver), 0);
}

// On to t or to the launch's end, by single steps.
static inline void importer_go(importer *self, double t)
{
    while (!self->ended && self->t < t) {
        if (self->sample)
            self->sample(self);
        double stop = fmin(fmin(t, self->next), self->t + 1); // finite
        CVodeSetStopTime(self->cvode, stop);
        int flag = CVode(self->cvode, stop, self->y, &self->t, CV_ONE_STEP);
        assert_true(flag >= 0);
        self->steps++;
        importer_place(self, self->t, self->x);
        bool asked = importer_complete(self);
        if (!asked && flag != CV_ROOT_RETURN && self->t != self->next)
            continue;
        if (self->sample)
            self->sample(self);
        importer_event(self);
        if (!self->ended)
            assert_int_equal(CVodeReInit(self->cvode, self->t, self->y), 0);
    }
}

#endif
