#include "simulation/integrator.h"

#include <arkode/arkode_erkstep.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_version.h>

#include "simulation/serial_vector.h"

#if SUNDIALS_VERSION_MAJOR < 7
#define LD_NO_COMMUNICATOR NULL
#else
#define LD_NO_COMMUNICATOR SUN_COMM_NULL
#endif

struct integrator {
    integrator_settings settings;
    SUNContext context;
    void *erk;
    N_Vector y, atol, rtol, work;
    double *previous; // state where the last step began
    double t, t_previous;
    int *found;       // event flags of the last landing
    double next_step; // size to begin with after a restart; 0: the library chooses
    int failed_rhs;
};

static double *data(N_Vector v)
{
    return NV_DATA_S(v);
}

// ---- callbacks

static int call_rhs(double t, N_Vector y, N_Vector y_dot, void *user)
{
    integrator *self = user;
    int failed = self->settings.rhs(t, data(y), data(y_dot), self->settings.self);
    self->failed_rhs |= failed;
    return failed ? -1 : 0;
}

static int call_events(double t, N_Vector y, double *g, void *user)
{
    integrator *self = user;
    return self->settings.events(t, data(y), g, self->settings.self);
}

static int error_weights(N_Vector y, N_Vector weights, void *user)
{
    integrator *self = user;
    const double *py = data(y), *rtol = data(self->rtol), *atol = data(self->atol);
    double *pw = data(weights);
    for (size_t i = 0; i < self->settings.n; i++)
        pw[i] = 1 / (rtol[i] * fabs(py[i]) + atol[i]);
    return 0;
}

// The library's own messages are not for our users: fail() below says what happened.
static void ignore_message(int code, const char *module, const char *function, char *message,
                           void *user)
{
    (void)code, (void)module, (void)function, (void)message, (void)user;
}

// ---- life

static ARKODE_ERKTableID table_of(integrator_method method)
{
    switch (method) {
    case INTEGRATOR_BOGACKI_SHAMPINE:
        return ARKODE_BOGACKI_SHAMPINE_4_2_3;
    case INTEGRATOR_CASH_KARP:
        return ARKODE_CASH_KARP_6_4_5;
    default:
        return ARKODE_DORMAND_PRINCE_7_4_5;
    }
}

static int configure(integrator *self)
{
    const integrator_settings *settings = &self->settings;
    self->erk = ERKStepCreate(call_rhs, 0.0, self->y, self->context);
    if (!self->erk)
        return -1;
    int bad = 0;
    bad |= ERKStepSetErrHandlerFn(self->erk, ignore_message, NULL);
    bad |= ERKStepSetUserData(self->erk, self);
    bad |= ERKStepWFtolerances(self->erk, error_weights);
    bad |= ERKStepSetTableNum(self->erk, table_of(settings->method));
    bad |= ERKStepSetInterpolantDegree(self->erk, 3);
    bad |= ERKStepSetMaxNumSteps(self->erk, -1);
    if (settings->max_step > 0)
        bad |= ERKStepSetMaxStep(self->erk, settings->max_step);
    if (settings->events)
        bad |= ERKStepRootInit(self->erk, settings->event_count, call_events);
    return bad;
}

static int allocate(integrator *self)
{
    sunindextype n = (sunindextype)self->settings.n;
    self->previous = calloc((size_t)n, sizeof(double));
    self->found = calloc((size_t)self->settings.event_count + 1, sizeof(int));
    if (!self->previous || !self->found || SUNContext_Create(LD_NO_COMMUNICATOR, &self->context))
        return -1;
    self->y = N_VNew_Serial(n, self->context);
    if (!self->y)
        return -1;
    serial_vector_operations(self->y);
    N_VConst(0, self->y);
    self->atol = N_VClone(self->y);
    self->rtol = N_VClone(self->y);
    self->work = N_VClone(self->y);
    return self->atol && self->rtol && self->work ? 0 : -1;
}

ld_status integrator_create(const integrator_settings *settings, integrator **out, ld_error *error)
{
    integrator *self = calloc(1, sizeof *self);
    if (self)
        self->settings = *settings;
    if (!self || allocate(self)) {
        integrator_free(self);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the integrator");
    }
    for (size_t i = 0; i < settings->n; i++) {
        data(self->atol)[i] = settings->atol[i];
        data(self->rtol)[i] = settings->absolute && settings->absolute[i] ? 0 : settings->rtol;
    }
    if (configure(self)) {
        integrator_free(self);
        return ld_fail(error, LD_ERR_NUMERIC, "the integrator refuses its settings");
    }
    *out = self;
    return LD_OK;
}

void integrator_free(integrator *self)
{
    if (!self)
        return;
    if (self->erk)
        ERKStepFree(&self->erk);
    if (self->y)
        N_VDestroy(self->y);
    if (self->atol)
        N_VDestroy(self->atol);
    if (self->rtol)
        N_VDestroy(self->rtol);
    if (self->work)
        N_VDestroy(self->work);
    if (self->context)
        SUNContext_Free(&self->context);
    free(self->previous);
    free(self->found);
    free(self);
}

ld_status integrator_start(integrator *self, double t, const double *y, ld_error *error)
{
    if (y != data(self->y))
        memcpy(data(self->y), y, self->settings.n * sizeof(double));
    self->t = self->t_previous = t;
    self->failed_rhs = 0;
    if (ERKStepReset(self->erk, t, self->y) || ERKStepSetInitStep(self->erk, self->next_step))
        return ld_fail(error, LD_ERR_NUMERIC, "the integrator cannot restart at t = %.9g s", t);
    return LD_OK;
}

// ---- stepping

static integrator_outcome fail(integrator *self, int flag, ld_error *error)
{
    if (self->failed_rhs)
        ld_fail(error, LD_ERR_NUMERIC,
                "the equations of motion gave no finite result at t = %.9g s", self->t);
    else if (flag == ARK_ERR_FAILURE || flag == ARK_CONV_FAILURE || flag == ARK_TOO_CLOSE)
        ld_fail(error, LD_ERR_NUMERIC, "the step size fell to nothing at t = %.9g s", self->t);
    else
        ld_fail(error, LD_ERR_NUMERIC, "the integrator gave up at t = %.9g s (code %d)", self->t,
                flag);
    return INTEGRATOR_FAILED;
}

// Takes the last step anew so that it ends at the event, now at self->t.
static integrator_outcome land_on_event(integrator *self, ld_error *error)
{
    double t_event = self->t;
    memcpy(data(self->y), self->previous, self->settings.n * sizeof(double));
    int flag = ERKStepReset(self->erk, self->t_previous, self->y);
    if (t_event <= self->t_previous)
        return flag < 0 ? fail(self, flag, error) : INTEGRATOR_EVENT;
    if (flag >= 0)
        flag = ERKStepSetInitStep(self->erk, t_event - self->t_previous);
    if (flag >= 0)
        flag = ERKStepSetStopTime(self->erk, t_event);
    if (flag >= 0)
        flag = ERKStepEvolve(self->erk, t_event, self->y, &self->t, ARK_ONE_STEP);
    if (flag < 0)
        return fail(self, flag, error);
    // a step that error control made shorter ends before the event, which the next ones will find
    int landed = flag == ARK_TSTOP_RETURN || flag == ARK_ROOT_RETURN || self->t >= t_event;
    return landed ? INTEGRATOR_EVENT : INTEGRATOR_STEPPED;
}

integrator_outcome integrator_step(integrator *self, double t_stop, ld_error *error)
{
    memcpy(self->previous, data(self->y), self->settings.n * sizeof(double));
    self->t_previous = self->t;
    int flag = ERKStepSetStopTime(self->erk, t_stop);
    if (flag >= 0)
        flag = ERKStepEvolve(self->erk, t_stop, self->y, &self->t, ARK_ONE_STEP);
    if (flag < 0)
        return fail(self, flag, error);
    if (flag == ARK_ROOT_RETURN) {
        ERKStepGetRootInfo(self->erk, self->found);
        return land_on_event(self, error);
    }
    if (flag == ARK_TSTOP_RETURN || self->t >= t_stop)
        return INTEGRATOR_STOPPED;
    ERKStepGetCurrentStep(self->erk, &self->next_step);
    return INTEGRATOR_STEPPED;
}

double integrator_time(const integrator *self)
{
    return self->t;
}

const double *integrator_state(const integrator *self)
{
    return data(self->y);
}

double integrator_previous_time(const integrator *self)
{
    return self->t_previous;
}

void integrator_interpolate(integrator *self, double t, double *y)
{
    N_Vector from = self->y;
    if (t < self->t && ERKStepGetDky(self->erk, t, 0, self->work) == ARK_SUCCESS)
        from = self->work;
    memcpy(y, data(from), self->settings.n * sizeof(double));
}

int integrator_event(const integrator *self, int i)
{
    return self->found[i];
}

int64_t integrator_steps(const integrator *self)
{
    long steps = 0;
    ERKStepGetNumSteps(self->erk, &steps);
    return steps;
}

int64_t integrator_evaluations(const integrator *self)
{
    long evaluations = 0;
    ERKStepGetNumRhsEvals(self->erk, &evaluations);
    return evaluations;
}
