#include "integration/integrator.h"

#include <arkode/arkode_erkstep.h>
#include <assert.h>
#include <float.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_version.h>

#include "integration/serial_vector.h"
#include "math/functions.h"

#if SUNDIALS_VERSION_MAJOR < 7
#define LD_NO_COMMUNICATOR NULL
#else
#define LD_NO_COMMUNICATOR SUN_COMM_NULL
#endif

// What the library asks for in its first step after a load.
typedef enum asked {
    ASKED_ALL,  // everything: no step after a load
    ASKED_RATE, // first the rate where the step begins, which is known
    ASKED_STAGE // then the first stage, from which on the library continues on its own
} asked;

struct integrator {
    integrator_settings settings;
    SUNContext context;
    void *erk;
    serial_vectors *vectors; // these, and the library's
    N_Vector y, atol, rtol, work;
    double t, t_previous;
    double next_step; // size to begin with after a restart; 0: the library chooses
    int *found;       // event flags of the last landing
    int failed_rhs;
    ld_status failure; // of the step that failed
    bool anew;         // the next step starts again
    bool stopped;      // the last step landed on a stop

    // What the library knows but does not report, for those who save it.
    N_Vector y_previous, rate_previous; // where the last step began
    bool needs_rate_previous;           // the next evaluation is that one
    const double *rate;                 // the latest evaluation, at t_rate
    double t_rate;
    N_Vector y_end; // where the last step ended, if `within`
    double t_end;
    bool within;                  // t and y lie within the last step, not at its end
    bool needs_end;               // the events' next call is at the end
    double *g, t_g;               // the events' latest values
    double error, error_previous; // biased local errors of the latest attempt, of the last step
    double h, t_stop;             // of the last step

    // What was loaded, until the next step.
    bool loaded;
    asked asked;
    N_Vector rate_end;
    double h_next;                            // size of the next step if no stop is in its way
    bool shortened;                           // it is so small because of a stop
    int64_t steps_before, evaluations_before; // counts of those who saved

    bool follows; // the step under way has its size from the course
};

static double *data(N_Vector v)
{
    return NV_DATA_S(v);
}

static void copy(N_Vector from, N_Vector to)
{
    memcpy(data(to), data(from), (size_t)NV_LENGTH_S(to) * sizeof(double));
}

// ---- callbacks

static int call_rhs(double t, N_Vector y, N_Vector y_dot, void *user)
{
    integrator *self = user;
    if (self->asked == ASKED_RATE) {
        copy(self->rate_end, y_dot);
        self->evaluations_before--; // the library counts it a second time
        self->asked = ASKED_STAGE;
        return 0;
    }
    if (self->asked == ASKED_STAGE)
        ERKStepSetMaxStep(self->erk, self->settings.max_step);
    self->asked = ASKED_ALL;
    int failed = self->settings.rhs(t, data(y), data(y_dot), self->settings.self);
    self->failed_rhs |= failed;
    if (self->needs_rate_previous)
        copy(y_dot, self->rate_previous);
    self->needs_rate_previous = false;
    self->rate = data(y_dot);
    self->t_rate = t;
    self->needs_end = true;
    return failed ? -1 : 0;
}

static int call_events(double t, N_Vector y, double *g, void *user)
{
    integrator *self = user;
    size_t size = (size_t)self->settings.event_count * sizeof *g;
    // once it has found an event, the library asks at each step's beginning for what it was given
    if (self->asked != ASKED_ALL || t == self->t_g) {
        memcpy(g, self->g, size);
        return 0;
    }
    if (self->needs_end) {
        copy(y, self->y_end);
        self->t_end = t;
    }
    self->needs_end = false;
    int failed = self->settings.events(t, data(y), g, self->settings.self);
    memcpy(self->g, g, size);
    self->t_g = t;
    return failed;
}

static int call_project(double t, N_Vector y, void *user)
{
    integrator *self = user;
    int failed = self->settings.project(t, data(y), self->settings.self);
    self->failed_rhs |= failed;
    return failed ? -1 : 0;
}

// No error is too large in a step whose size is another's.
static const double allowed_where_followed = 1e-100;

static int error_weights(N_Vector y, N_Vector weights, void *user)
{
    integrator *self = user;
    const double *py = data(y), *rtol = data(self->rtol), *atol = data(self->atol);
    double *pw = data(weights);
    double share = self->follows ? allowed_where_followed : 1;
    for (size_t i = 0; i < self->settings.n; i++)
        pw[i] = share / (rtol[i] * fabs(py[i]) + atol[i]);
    return 0;
}

// Step control: the PI controller that is the library's own by default, with its numbers. Written
// here because the history of errors that it goes by must be saved.
static const double growth = 25; // most from one step to the next
static const double gain_now = 0.8, gain_previous = 0.31, least_error = 1e-10;

// NOLINTNEXTLINE(readability-function-size): of ARKODE
static int control_step(N_Vector y, double t, double h, double h_1, double h_2, double error,
                        double error_1, double error_2, int order, int embedded_order,
                        double *h_next, void *user)
{
    (void)y, (void)t, (void)h_1, (void)h_2, (void)error_1, (void)error_2, (void)order;
    integrator *self = user;
    self->error = error;
    *h_next = h * pow(fmax(error, least_error), -gain_now / embedded_order) *
              pow(fmax(self->error_previous, least_error), gain_previous / embedded_order);
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

// Each stage by the one before alone, so that the order's conditions have closed forms in nodes and
// weights; of what they leave free, R(z) = 1 + z + ... + z^4/24 + z^5/180 + z^6/1098, the
// coefficients of which let |z| be largest where it is nearly imaginary.
static int set_oscillating(void *erk)
{
    enum { STAGES = 6 };
    static const double node[STAGES] = {0,
                                        0.25,
                                        0.55915409488225365,
                                        0.89738980723939799,
                                        0.084811429870224303,
                                        0.70928473156651728};
    static const double weight[STAGES] = {-0.013360746701687912, 0.23814716256711208,
                                          0.25552731950232133,   0.21922964046341073,
                                          0.17976697836152883,   0.12068964580731496};
    static const double embedded[STAGES] = {-0.084420838682161298, 0.41726145460677333,
                                            0.097450341484323272,  0.26245241842222095,
                                            0.17976697836152883,   0.12748964580731495};
    double c[STAGES], b[STAGES], d[STAGES], A[STAGES * STAGES] = {0};
    for (int i = 0; i < STAGES; i++) {
        c[i] = node[i];
        b[i] = weight[i];
        d[i] = embedded[i];
        if (i > 0)
            A[STAGES * i + i - 1] = node[i];
    }
    ARKodeButcherTable table = ARKodeButcherTable_Create(STAGES, 4, 3, c, A, b, d);
    int bad = table ? ERKStepSetTable(erk, table) : -1;
    ARKodeButcherTable_Free(table);
    return bad;
}

static int set_method(void *erk, integrator_method method)
{
    return method == INTEGRATOR_OSCILLATING ? set_oscillating(erk)
                                            : ERKStepSetTableNum(erk, table_of(method));
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
    bad |= set_method(self->erk, settings->method);
    bad |= ERKStepSetInterpolantDegree(self->erk, 3);
    bad |= ERKStepSetMaxNumSteps(self->erk, -1);
    bad |= ERKStepSetAdaptivityFn(self->erk, control_step, self);
    bad |= ERKStepSetMaxGrowth(self->erk, growth);
    if (settings->max_step > 0)
        bad |= ERKStepSetMaxStep(self->erk, settings->max_step);
    if (settings->project)
        bad |= ERKStepSetPostprocessStepFn(self->erk, call_project);
    if (settings->events)
        bad |= ERKStepRootInit(self->erk, settings->event_count, call_events);
    return bad;
}

static int allocate(integrator *self)
{
    size_t events = (size_t)self->settings.event_count + 1;
    self->found = calloc(events, sizeof *self->found);
    self->g = calloc(events, sizeof *self->g);
    if (!self->found || !self->g || SUNContext_Create(LD_NO_COMMUNICATOR, &self->context))
        return -1;
    self->vectors = serial_vectors_new(self->settings.n, self->context);
    if (!self->vectors)
        return -1;
    N_Vector *own[] = {&self->y,          &self->atol,          &self->rtol,  &self->work,
                       &self->y_previous, &self->rate_previous, &self->y_end, &self->rate_end};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        *own[i] = serial_vectors_take(self->vectors);
    return 0;
}

// Whether there is room for what the library makes for itself, which dies where there is none.
static bool has_room(void)
{
    enum { ROOM = 1 << 18 };
    void *volatile room = malloc(ROOM); // else a compiler leaves both away
    free(room);
    return room;
}

ld_status integrator_create(const integrator_settings *settings, integrator **out, ld_error *error)
{
    integrator *self = calloc(1, sizeof *self);
    if (self)
        self->settings = *settings;
    if (!self || !has_room() || allocate(self) || configure(self)) { // it refuses nothing else
        integrator_free(self);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the integrator");
    }
    for (size_t i = 0; i < settings->n; i++) {
        data(self->atol)[i] = settings->atol[i];
        data(self->rtol)[i] = settings->absolute && settings->absolute[i] ? 0 : settings->rtol;
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
    serial_vectors_free(self->vectors);
    if (self->context)
        SUNContext_Free(&self->context);
    free(self->found);
    free(self->g);
    free(self);
}

ld_status integrator_start(integrator *self, double t, const double *y, ld_error *error)
{
    (void)error;
    if (y != data(self->y))
        memcpy(data(self->y), y, self->settings.n * sizeof(double));
    self->t = self->t_previous = self->t_end = t;
    self->anew = true;
    self->stopped = false;
    // no step lies behind
    copy(self->y, self->y_end);
    self->within = false;
    self->rate = NULL;
    N_Vector unknown[] = {self->y_previous, self->rate_previous, self->rate_end};
    for (int i = 0; i < 3; i++)
        N_VConst(0, unknown[i]);
    return LD_OK;
}

// ---- stepping

static integrator_outcome fail(integrator *self, int flag, ld_error *error)
{
    self->failure = flag == ARK_MEM_FAIL && !self->failed_rhs ? LD_ERR_MEMORY : LD_ERR_NUMERIC;
    if (self->failed_rhs)
        ld_fail(error, self->failure, "the equations of motion gave no finite result at t = %.9g s",
                self->t);
    else if (flag == ARK_MEM_FAIL) // the first step takes the rest of its memory
        ld_fail(error, self->failure, "no memory for the integrator");
    else if (flag == ARK_ERR_FAILURE || flag == ARK_CONV_FAILURE || flag == ARK_TOO_CLOSE)
        ld_fail(error, self->failure, "the step size fell to 0 at t = %.9g s", self->t);
    else
        ld_fail(error, self->failure, "the integrator failed at t = %.9g s (code %d)", self->t,
                flag);
    return INTEGRATOR_FAILED;
}

ld_status integrator_failure(const integrator *self)
{
    return self->failure;
}

// The library begins here with a step of size h; 0: it chooses.
static int reset(integrator *self, double h)
{
    self->t_g = NAN;
    int flag = ERKStepReset(self->erk, self->t, self->y);
    if (flag >= 0)
        flag = ERKStepSetInitStep(self->erk, h);
    // a size of its choice may grow more, by its default, which is 0 here
    return flag < 0 ? flag : ERKStepSetMaxFirstGrowth(self->erk, h > 0 ? growth : 0);
}

// As reset, with nothing of what was before.
static int start(integrator *self, double h)
{
    self->failed_rhs = 0;
    self->error = 1;
    self->needs_rate_previous = true;
    return reset(self, h);
}

// One step of the library's.
static int evolve_step(integrator *self, double t_stop)
{
    self->loaded = self->stopped = false;
    self->error_previous = self->error;
    self->t_stop = t_stop;
    int flag = ERKStepSetStopTime(self->erk, t_stop);
    if (flag >= 0)
        flag = ERKStepEvolve(self->erk, t_stop, self->y, &self->t, ARK_ONE_STEP);
    self->within = flag == ARK_ROOT_RETURN;
    if (!self->within)
        self->t_end = self->t;
    ERKStepGetLastStep(self->erk, &self->h);
    return flag;
}

// Takes the last step again, to t. With a course it ends there, also where the library has found an
// event a little earlier and interpolates.
static int repeat_step(integrator *self, double t)
{
    self->t = self->t_previous;
    copy(self->y_previous, self->y);
    int flag = start(self, t - self->t);
    if (flag >= 0)
        flag = evolve_step(self, t);
    if (flag == ARK_ROOT_RETURN && self->settings.course) {
        copy(self->y_end, self->y);
        self->t = self->t_end;
        self->within = false;
    }
    return flag;
}

// Whether a step has ended where it had to: error control may have made it shorter.
static bool has_reached(const integrator *self, int flag, double t)
{
    return flag == ARK_TSTOP_RETURN || flag == ARK_ROOT_RETURN || self->t >= t;
}

static double event_value(integrator *self, int event, double t, N_Vector y)
{
    self->t_g = NAN;
    bool failed = self->settings.events(t, data(y), self->g, self->settings.self);
    return failed ? NAN : self->g[event];
}

// The library has located an event in the interpolated step. With a course the step is repeated, by
// secants, until it ends on the event itself: what remained would change from launch to launch.
// *t_event: the end asked for. Returns the library's latest flag.
static int land_closer(integrator *self, int flag, double t_end, double *t_event)
{
    enum { MOST = 5 };
    const double landed = 2 * DBL_EPSILON * fabs(*t_event);
    int event = 0;
    while (event < self->settings.event_count && !self->found[event])
        event++;
    if (!self->settings.course || event == self->settings.event_count)
        return flag;
    double t = self->t_previous, g = event_value(self, event, t, self->y_previous);
    for (int k = 0; k < MOST && flag >= 0 && self->t >= *t_event; k++) {
        double now = event_value(self, event, self->t, self->y);
        double next = self->t - now * (self->t - t) / (now - g);
        if (!(fabs(next - self->t) > landed && next > self->t_previous && next < t_end))
            break;
        t = self->t;
        g = now;
        *t_event = next;
        flag = repeat_step(self, next);
    }
    return flag;
}

// Takes the last step again so that it ends at the event, or where else it is requested, now at
// self->t.
static integrator_outcome land_on_event(integrator *self, ld_error *error)
{
    double t_event = self->t, t_end = self->t_previous + self->h;
    self->t = self->t_previous;
    self->anew = true;
    if (t_event <= self->t) {
        copy(self->y_previous, self->y);
        return INTEGRATOR_EVENT;
    }
    int flag = repeat_step(self, t_event);
    if (flag >= 0 && has_reached(self, flag, t_event))
        flag = land_closer(self, flag, t_end, &t_event);
    if (flag < 0)
        return fail(self, flag, error);
    // a step that error control made shorter ends before the event, which the next ones will find
    self->anew = has_reached(self, flag, t_event);
    return self->anew ? INTEGRATOR_EVENT : INTEGRATOR_STEPPED;
}

// The rate where the last step ended: the latest one asked for, of which the library has made the
// time a stop's where only rounding parts them.
static void rate_at_end(integrator *self, N_Vector rate)
{
    if (self->rate && fabs(self->t_rate - self->t_end) <= 1e-3 * self->h)
        memcpy(data(rate), self->rate, self->settings.n * sizeof(double));
    else if (self->rate)
        ERKStepGetDky(self->erk, self->t_end, 1, rate);
}

static int continue_steps(integrator *self)
{
    rate_at_end(self, self->rate_previous);
    return 0;
}

// What is left to a stop, as the library takes it.
static double left_to(double t_stop, double t)
{
    return (t_stop - t) * (1 - 4 * DBL_EPSILON);
}

// The size of the step after a load, as the library would have computed it.
static double resumed_size(const integrator *self, double t_stop)
{
    double h = self->h, h_next = self->h_next;
    bool shortened = self->shortened;
    if ((self->t + h_next - t_stop) * h > 0) {
        h_next = left_to(t_stop, self->t);
        shortened = true;
    }
    return shortened && h_next != h ? h * (h_next / h) : h_next;
}

// After a load the library starts again, but as if it continued. The bound on the size, which would
// round it, comes back at the first stage.
static int resume(integrator *self, double t_stop)
{
    self->asked = ASKED_RATE;
    copy(self->rate_end, self->rate_previous);
    int flag = reset(self, resumed_size(self, t_stop));
    return flag < 0 ? flag : ERKStepSetMaxStep(self->erk, 0);
}

// State at t in the step that was loaded, by the library's formulas.
static void interpolate_loaded(const integrator *self, double t, N_Vector y)
{
    double h = self->h, s = (t - self->t_end) / h, s2 = s * s, s3 = s * s2;
    if (self->settings.method == INTEGRATOR_BOGACKI_SHAMPINE) {
        N_Vector x[] = {self->y_previous, self->y_end, self->rate_end};
        N_VLinearCombination(3, (double[]){s2, 1 - s2, h * (s2 + s)}, x, y);
    } else {
        N_Vector x[] = {self->y_previous, self->y_end, self->rate_previous, self->rate_end};
        double a[] = {3 * s2 + 2 * s3, 1 - 3 * s2 - 2 * s3, h * (s2 + s3), h * (s + 2 * s2 + s3)};
        N_VLinearCombination(4, a, x, y);
    }
}

// As the library has it: but for rounding, the last step has ended on this stop.
static bool is_at(const integrator *self, double t_stop)
{
    double rounding = 100 * DBL_EPSILON * (fabs(self->t) + fabs(self->h));
    return !self->anew && fabs(self->t - t_stop) <= rounding;
}

static integrator_outcome stop_at_once(integrator *self, double t_stop)
{
    if (!self->within)
        copy(self->y, self->y_end);
    if (self->loaded)
        interpolate_loaded(self, t_stop, self->y);
    else
        ERKStepGetDky(self->erk, t_stop, 0, self->y);
    self->within = true;
    self->t = t_stop;
    self->stopped = true;
    return INTEGRATOR_STOPPED;
}

// The size that the course has for the next step; 0: its own.
static double followed_size(integrator *self, double t_stop)
{
    step_course *course = self->settings.course;
    const course_step *next =
        course && course->follows ? step_course_next(course, self->anew, false) : NULL;
    self->follows = next;
    return next ? fmin(next->size, t_stop - self->t) : 0;
}

static void record_size(integrator *self, bool began, bool stopped)
{
    step_course *course = self->settings.course;
    if (course && !course->follows)
        step_course_add(course,
                        &(course_step){.begins = began, .size = stopped ? INFINITY : self->h});
}

integrator_outcome integrator_step(integrator *self, double t_stop, ld_error *error)
{
    if (is_at(self, t_stop))
        return stop_at_once(self, t_stop);
    bool anew = self->anew;
    double size = followed_size(self, t_stop);
    int flag = size > 0       ? start(self, size)
               : anew         ? start(self, self->next_step)
               : self->loaded ? resume(self, t_stop)
                              : continue_steps(self);
    copy(self->y, self->y_previous);
    self->t_previous = self->t;
    self->anew = false;
    if (flag >= 0)
        flag = evolve_step(self, t_stop);
    if (flag < 0)
        return fail(self, flag, error);
    record_size(self, anew, flag == ARK_TSTOP_RETURN || self->t >= t_stop);
    if (flag == ARK_ROOT_RETURN) {
        ERKStepGetRootInfo(self->erk, self->found);
        return land_on_event(self, error);
    }
    self->stopped = flag == ARK_TSTOP_RETURN || self->t >= t_stop;
    if (self->stopped)
        return INTEGRATOR_STOPPED;
    ERKStepGetCurrentStep(self->erk, &self->next_step);
    return INTEGRATOR_STEPPED;
}

integrator_outcome integrator_return(integrator *self, double t, ld_error *error)
{
    assert(t >= self->t_previous && t <= self->t);
    self->t = t;
    integrator_outcome outcome = land_on_event(self, error);
    return outcome == INTEGRATOR_FAILED ? outcome : INTEGRATOR_STEPPED;
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
    if (t < self->t && self->loaded) {
        interpolate_loaded(self, t, self->work);
        from = self->work;
    } else if (t < self->t && ERKStepGetDky(self->erk, t, 0, self->work) == ARK_SUCCESS) {
        from = self->work;
    }
    memcpy(y, data(from), self->settings.n * sizeof(double));
}

int integrator_event(const integrator *self, int i)
{
    return self->found[i];
}

void integrator_error(integrator *self, double *error)
{
    if (ERKStepGetEstLocalErrors(self->erk, self->work) != ARK_SUCCESS)
        N_VConst(0, self->work);
    memcpy(error, data(self->work), self->settings.n * sizeof(double));
}

int64_t integrator_steps(const integrator *self)
{
    long steps = 0;
    ERKStepGetNumSteps(self->erk, &steps);
    return self->steps_before + steps;
}

int64_t integrator_evaluations(const integrator *self)
{
    long evaluations = 0;
    ERKStepGetNumRhsEvals(self->erk, &evaluations);
    return self->evaluations_before + evaluations;
}

// ---- saving and loading

// What the library knows of the last step and of the next, as it would be loaded.
static void gather_state(integrator *self)
{
    if (!self->loaded) {
        rate_at_end(self, self->rate_end);
        if (!self->within)
            copy(self->y, self->y_end);
        ERKStepGetCurrentStep(self->erk, &self->h_next);
        self->shortened = self->h_next == left_to(self->t_stop, self->t);
    }
    if (self->anew || self->stopped) {
        self->h_next = 0;
        self->shortened = false;
    }
}

static void archive_step(integrator *self, archive *bytes)
{
    N_Vector vectors[5] = {self->y, self->y_previous, self->rate_previous, self->y_end,
                           self->rate_end};
    double *numbers[] = {&self->t,     &self->t_previous, &self->t_end, &self->next_step,
                         &self->error, &self->h,          &self->h_next};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        archive_double(bytes, numbers[i]);
    bool anew = self->anew || self->stopped;
    archive_bool(bytes, &anew);
    if (bytes->loading) {
        self->anew = anew;
        self->stopped = false;
    }
    archive_bool(bytes, &self->within);
    archive_bool(bytes, &self->shortened);
    for (int i = 0; i < 5; i++)
        archive_doubles(bytes, data(vectors[i]), self->settings.n);
    bytes->failed |= !(self->t_previous <= self->t) || !(self->anew || self->h > 0);
}

void integrator_archive(integrator *self, archive *bytes)
{
    archive_expect(bytes, (int64_t)self->settings.n);
    archive_expect(bytes, self->settings.event_count);
    archive_expect(bytes, self->settings.method);
    if (bytes->loading && bytes->failed)
        return;
    if (!bytes->loading)
        gather_state(self);
    archive_step(self, bytes);
    archive_doubles(bytes, self->g, (size_t)self->settings.event_count);
    for (int i = 0; i < self->settings.event_count; i++)
        archive_int(bytes, &self->found[i], -1, 1);
    int64_t steps = integrator_steps(self), evaluations = integrator_evaluations(self);
    int64_t steps_now = steps, evaluations_now = evaluations;
    archive_count(bytes, &steps);
    archive_count(bytes, &evaluations);
    self->steps_before += steps - steps_now;
    self->evaluations_before += evaluations - evaluations_now;
    if (bytes->loading)
        self->loaded = true;
}
