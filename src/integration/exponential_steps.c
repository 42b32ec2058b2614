#include "integration/exponential_steps.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/matrices/exponential.h"

// No step is longer [s]; there are so many sizes.
static const double LONGEST = 6e-3;
enum { RUNGS = 4 };
// An error is allowed this share of the tolerance: what the works are found to, which have none of
// their own.
static const double SHARE = 0.2;
// A Jacobian is found again after so many steps that were shorter than they had been with it, the
// next time after twice as many: it costs what 100 steps do. A stretch left to explicit steps
// counts for 40.
enum { PATIENCE = 200, MOST_PATIENCE = 100 * PATIENCE, STRETCH = 40 };

// Steps with the Jacobian of equations of one kind.
typedef struct linear_part {
    exponential *steps; // NULL: not asked for yet
    bool prepared;      // there is a Jacobian
    int rung;           // the next step's, if nothing is in its way
    int best;           // the longest one since the Jacobian is there
    int spent, patience;
} linear_part;

struct exponential_steps {
    exponential_steps_settings settings;
    integrator_settings equations;
    linear_part of_kind[EXPONENTIAL_STEPS_KINDS];
    linear_part *part;  // of the equations of now
    size_t n, steering; // states; those of them whose error has a bound
    double *memory;
    double *atol, *rtol; // [n]
    double *y, *slope, *y_end, *slope_end, *error, *drift;
    double *g, *g_end; // [event_count]
    double t, t_previous;
    double
        before;   // the next stop, where the equations may become others: the last instant of these
    double first; // instants of steps count from here
    double resume; // where explicit steps end
    bool known;    // slope and g are those of the present
    int64_t count, evaluations;
};

// ---- life

static int rates(double t, const double *y, double *y_dot, void *user)
{
    exponential_steps *self = user;
    self->evaluations++;
    return self->equations.rhs(fmin(t, self->before), y, y_dot, self->equations.self);
}

static double longest_step(double row)
{
    int power;
    frexp(LONGEST / row, &power); // LONGEST / row = m 2^power, m from 1/2 to 1
    return ldexp(row, power - 1);
}

static const char no_memory[] = "no memory for the integrator";

static int allocate(exponential_steps *self)
{
    double **own[] = {&self->atol,  &self->rtol,      &self->y,     &self->slope,
                      &self->y_end, &self->slope_end, &self->error, &self->drift};
    size_t vectors = sizeof own / sizeof *own, events = (size_t)self->equations.event_count;
    self->memory = calloc(vectors * self->n + 2 * events + 1, sizeof *self->memory);
    if (!self->memory)
        return -1;
    for (size_t i = 0; i < vectors; i++)
        *own[i] = self->memory + i * self->n;
    self->g = self->memory + vectors * self->n;
    self->g_end = self->g + events;
    return 0;
}

ld_status exponential_steps_take(exponential_steps *self, int kind, ld_error *error)
{
    linear_part *part = self->part = &self->of_kind[kind];
    if (part->steps)
        return LD_OK;
    exponential_settings settings = {
        .n = (int)self->n,
        .block = self->settings.block,
        .block_count = self->settings.block_count,
        .longest = longest_step(self->settings.row),
        .rungs = RUNGS,
        .f = rates,
        .self = self,
    };
    part->steps = exponential_new(&settings);
    part->patience = PATIENCE;
    return part->steps ? LD_OK : ld_fail(error, LD_ERR_MEMORY, no_memory);
}

ld_status exponential_steps_create(const exponential_steps_settings *settings,
                                   exponential_steps **out, ld_error *error)
{
    const integrator_settings *equations = settings->equations;
    exponential_steps *self = calloc(1, sizeof *self);
    if (self) {
        self->settings = *settings;
        self->equations = *equations;
        self->n = equations->n;
    }
    if (!self || allocate(self)) {
        exponential_steps_free(self);
        return ld_fail(error, LD_ERR_MEMORY, no_memory);
    }
    for (size_t i = 0; i < self->n; i++) {
        self->atol[i] = equations->atol[i];
        self->rtol[i] = equations->absolute && equations->absolute[i] ? 0 : equations->rtol;
        self->steering += isfinite(equations->atol[i]) != 0;
    }
    *out = self;
    return LD_OK;
}

static void drop_parts(exponential_steps *self)
{
    for (int kind = 0; kind < EXPONENTIAL_STEPS_KINDS; kind++)
        exponential_free(self->of_kind[kind].steps);
    memset(self->of_kind, 0, sizeof self->of_kind);
}

void exponential_steps_free(exponential_steps *self)
{
    if (!self)
        return;
    drop_parts(self);
    free(self->memory);
    free(self);
}

void exponential_steps_count_from(exponential_steps *self, double t)
{
    self->first = t;
}

void exponential_steps_start(exponential_steps *self, double t, const double *y)
{
    if (y != self->y)
        memcpy(self->y, y, self->n * sizeof *y);
    self->t = self->t_previous = t;
    self->known = false;
}

// ---- the Jacobian

static double change_of(const exponential_steps *self, int state)
{
    return 1e-5 / self->equations.rtol * self->atol[state];
}

// The state of each block that is changed next, or -1: it has no more; how many there are.
static int next_states(const exponential_steps *self, int *state)
{
    int found = 0;
    for (int b = 0; b < self->settings.block_count; b++) {
        int i = state[b] + 1;
        while (i < (int)self->n && self->settings.block[i] != b)
            i++;
        state[b] = i;
        found += i < (int)self->n;
    }
    return found;
}

// Rates with these states of the blocks changed, by a hundredth of what the tolerance allows one of
// usual size, times `sign`.
static int changed_rates(exponential_steps *self, const int *state, double sign, double *y_dot)
{
    double *trial = self->error;
    memcpy(trial, self->y, self->n * sizeof *trial);
    for (int b = 0; b < self->settings.block_count; b++)
        if (state[b] < (int)self->n)
            trial[state[b]] += sign * change_of(self, state[b]);
    return rates(self->t, trial, y_dot, self);
}

// By central differences, of all blocks at once: what a state of one block does to another's is
// left out.
static int find_jacobian(exponential_steps *self)
{
    double *plus = self->y_end, *minus = self->slope_end;
    int state[EXPONENTIAL_MOST_BLOCKS];
    for (int b = 0; b < self->settings.block_count; b++)
        state[b] = -1;
    for (int column = 0; next_states(self, state) > 0; column++) {
        if (changed_rates(self, state, 1, plus) || changed_rates(self, state, -1, minus))
            return -1;
        for (int b = 0; b < self->settings.block_count; b++) {
            int count, row = 0;
            double *L = exponential_block(self->part->steps, b, &count);
            for (int i = 0; i < (int)self->n && state[b] < (int)self->n; i++)
                if (self->settings.block[i] == b)
                    L[row++ + count * column] =
                        (plus[i] - minus[i]) / (2 * change_of(self, state[b]));
        }
    }
    return exponential_prepare(self->part->steps);
}

static bool refresh_linear(exponential_steps *self)
{
    linear_part *part = self->part;
    part->prepared = find_jacobian(self) == 0;
    part->rung = part->best = RUNGS - 1;
    part->spent = 0;
    return part->prepared;
}

// ---- steps

static double finest(const exponential_steps *self)
{
    return exponential_size(self->part->steps, RUNGS - 1);
}

static exponential_outcome refuse_step(exponential_steps *self, double until)
{
    self->resume = until;
    return EXPONENTIAL_REFUSED;
}

// Slope and events at the present.
static bool find_present(exponential_steps *self)
{
    const integrator_settings *equations = &self->equations;
    if (self->known)
        return true;
    self->known =
        rates(self->t, self->y, self->slope, self) == 0 &&
        (!equations->events || equations->events(self->t, self->y, self->g, equations->self) == 0);
    return self->known;
}

// Root mean square of error against what is allowed; infinity where there is no finite one.
static double size_of_error(const exponential_steps *self)
{
    double sum = 0;
    for (size_t i = 0; i < self->n; i++) {
        double share = self->error[i] / (self->rtol[i] * fabs(self->y[i]) + self->atol[i]);
        sum += share * share;
    }
    double norm = sqrt(sum / (double)self->steering);
    return isfinite(norm) ? norm / SHARE : INFINITY;
}

// The longest rung that ends on an instant of its own grid and not beyond `left`; `at`: how many of
// the finest steps lie between the first instant and the present.
static int fitting_rung(const exponential_steps *self, int64_t at, double left)
{
    int rung = self->part->rung;
    for (; rung < RUNGS; rung++) {
        int64_t length = (int64_t)1 << (RUNGS - 1 - rung);
        if (at % length == 0 && exponential_size(self->part->steps, rung) <= left * (1 + 1e-9))
            break;
    }
    return rung;
}

static bool passes_event(exponential_steps *self)
{
    bool any = false;
    for (int i = 0; i < self->equations.event_count; i++)
        any |= self->g[i] * self->g_end[i] <= 0 && self->g[i] != self->g_end[i];
    return any;
}

// One step is taken; the next one's rung.
static void control(exponential_steps *self, int rung, double error)
{
    linear_part *part = self->part;
    bool wanted = rung == part->rung;
    part->best = rung < part->best ? rung : part->best;
    part->spent += rung > part->best + 1 && wanted;
    if (wanted && error < 1.0 / 40 && rung > 0)
        part->rung--;
}

// Ends the step at t and makes it the last one.
static bool accept_step(exponential_steps *self, double t)
{
    const integrator_settings *equations = &self->equations;
    memcpy(self->y, self->y_end, self->n * sizeof *self->y);
    memcpy(self->slope, self->slope_end, self->n * sizeof *self->slope);
    memcpy(self->g, self->g_end, (size_t)equations->event_count * sizeof *self->g);
    self->t_previous = self->t;
    self->t = t;
    self->count++;
    if (equations->project || t > self->before)
        self->known = false;
    return !equations->project || equations->project(t, self->y, equations->self) == 0;
}

// Where a step from `at` on, in the finest ones, ends at a rung.
static double end_of(const exponential_steps *self, int64_t at, int rung)
{
    return self->first + (double)(at + (1 << (RUNGS - 1 - rung))) * finest(self);
}

// A Jacobian where there is none, or where that of before has not served for long.
static bool renew_jacobian(exponential_steps *self)
{
    linear_part *part = self->part;
    if (part->prepared && part->spent <= part->patience)
        return true;
    if (part->prepared && part->patience < MOST_PATIENCE)
        part->patience *= 2;
    return refresh_linear(self);
}

// Tries a step at a rung; its error, infinity where there is none that is finite.
static double attempt_step(exponential_steps *self, int rung)
{
    const exponential_start start = {self->t, self->y, self->slope, self->drift};
    const exponential_end end = {self->y_end, self->slope_end, self->error};
    bool failed = exponential_step(self->part->steps, rung, &start, &end);
    return failed ? INFINITY : size_of_error(self);
}

// Tries shorter and shorter steps until one has an error that is allowed; RUNGS: there is none.
static int try_steps(exponential_steps *self, int64_t at, double left, double *error)
{
    int rung = fitting_rung(self, at, left);
    while (rung < RUNGS) {
        *error = attempt_step(self, rung);
        if (*error <= 1)
            break;
        self->part->rung = *error > 16 && rung + 1 < RUNGS ? rung + 2 : rung + 1;
        rung = fitting_rung(self, at, left);
    }
    return rung;
}

// The step that the course has next, and what steered it; NULL: its own.
static const course_step *followed_step(exponential_steps *self)
{
    linear_part *part = self->part;
    step_course *course = self->equations.course;
    const course_step *next =
        course && course->follows ? step_course_next(course, true, true) : NULL;
    if (next) {
        part->rung = next->control[0];
        part->best = next->control[1];
        part->spent = next->control[2];
        part->patience = next->control[3];
    }
    return next;
}

static course_step present_control(const linear_part *part)
{
    return (course_step){.begins = true,
                         .is_long = true,
                         .control = {part->rung, part->best, part->spent, part->patience}};
}

static int follow_step(exponential_steps *self, int rung, double *error)
{
    if (rung == RUNGS)
        return RUNGS;
    *error = attempt_step(self, rung);
    return isinf(*error) ? RUNGS : rung;
}

exponential_outcome exponential_steps_step(exponential_steps *self, double t_stop)
{
    const integrator_settings *equations = &self->equations;
    double x = (self->t - self->first) / finest(self), left = t_stop - self->t, error = 0;
    int64_t at = llround(x);
    self->before = nextafter(t_stop, -INFINITY);
    if (fabs(x - (double)at) > 1e-6)
        return refuse_step(self, self->first + ceil(x) * finest(self));
    if (finest(self) > left * (1 + 1e-9) || !find_present(self))
        return refuse_step(self, end_of(self, at, RUNGS - 1));
    const course_step *next = followed_step(self);
    course_step kept = present_control(self->part);
    if (!renew_jacobian(self))
        return refuse_step(self, end_of(self, at, 0));
    self->settings.drift(self->t, self->y, self->slope, self->drift, equations->self);
    int rung = next ? follow_step(self, next->rung, &error) : try_steps(self, at, left, &error);
    if (equations->course && !equations->course->follows) {
        kept.rung = rung;
        step_course_add(equations->course, &kept);
    }
    if (rung == RUNGS) {
        self->part->rung = RUNGS - 1;
        self->part->spent += STRETCH;
        return refuse_step(self, end_of(self, at, 0));
    }
    double t = end_of(self, at, rung);
    bool stops = t > t_stop - 1e-9 * finest(self);
    t = stops ? t_stop : t;
    if (equations->events &&
        (equations->events(t, self->y_end, self->g_end, equations->self) || passes_event(self)))
        return refuse_step(self, t);
    control(self, rung, error);
    if (!accept_step(self, t))
        return refuse_step(self, t + finest(self));
    return stops ? EXPONENTIAL_STOPPED : EXPONENTIAL_STEPPED;
}

double exponential_steps_resume(const exponential_steps *self)
{
    return self->resume;
}

double exponential_steps_time(const exponential_steps *self)
{
    return self->t;
}

double exponential_steps_previous_time(const exponential_steps *self)
{
    return self->t_previous;
}

const double *exponential_steps_state(const exponential_steps *self)
{
    return self->y;
}

const double *exponential_steps_previous(const exponential_steps *self)
{
    return exponential_last(self->part->steps)->y;
}

void exponential_steps_interpolate(exponential_steps *self, double t, double *y)
{
    if (t < self->t && t >= self->t_previous)
        exponential_between(self->part->steps, t - self->t_previous, y);
    else
        memcpy(y, self->y, self->n * sizeof *y);
}

int64_t exponential_steps_count(const exponential_steps *self)
{
    return self->count;
}

int64_t exponential_steps_evaluations(const exponential_steps *self)
{
    return self->evaluations;
}

// ---- saving and loading ----

static void archive_course(exponential *steps, size_t n, archive *bytes)
{
    exponential_course *course = exponential_last(steps);
    double *vectors[] = {course->y, course->y_dot, course->drift, course->linear,
                         course->quadratic};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        archive_doubles(bytes, vectors[i], n);
    archive_int(bytes, &course->rung, 0, RUNGS - 1);
    exponential_forget(steps);
}

static void archive_part(exponential_steps *self, linear_part *part, archive *bytes)
{
    archive_bool(bytes, &part->prepared);
    archive_int(bytes, &part->rung, 0, RUNGS - 1);
    archive_int(bytes, &part->best, 0, RUNGS - 1);
    archive_int(bytes, &part->spent, 0, INT_MAX);
    archive_int(bytes, &part->patience, PATIENCE, 2 * MOST_PATIENCE);
    for (int b = 0; b < self->settings.block_count && part->prepared; b++) {
        int count;
        double *L = exponential_block(part->steps, b, &count);
        archive_doubles(bytes, L, (size_t)count * (size_t)count);
    }
    archive_course(part->steps, self->n, bytes);
    if (bytes->loading && !bytes->failed && part->prepared && exponential_prepare(part->steps))
        bytes->failed = true;
}

// Those of the kinds that have been taken, which loading takes; the present one, if there is any.
static void archive_parts(exponential_steps *self, archive *bytes)
{
    int present = self->part ? (int)(self->part - self->of_kind) : -1;
    archive_int(bytes, &present, -1, EXPONENTIAL_STEPS_KINDS - 1);
    if (bytes->loading)
        drop_parts(self);
    for (int kind = 0; kind < EXPONENTIAL_STEPS_KINDS; kind++) {
        bool taken = self->of_kind[kind].steps;
        archive_bool(bytes, &taken);
        if (taken && exponential_steps_take(self, kind, NULL) == LD_OK)
            archive_part(self, &self->of_kind[kind], bytes);
        else
            bytes->failed |= taken;
    }
    self->part = present < 0 ? NULL : &self->of_kind[present];
    bytes->failed |= self->part && !self->part->steps;
}

void exponential_steps_archive(exponential_steps *self, archive *bytes)
{
    double *instants[] = {&self->t, &self->t_previous, &self->first};
    archive_expect(bytes, (int64_t)self->n);
    for (size_t i = 0; i < sizeof instants / sizeof *instants; i++)
        archive_double(bytes, instants[i]);
    archive_doubles(bytes, self->y, self->n);
    archive_doubles(bytes, self->slope, self->n);
    archive_doubles(bytes, self->g, (size_t)self->equations.event_count);
    archive_bool(bytes, &self->known);
    archive_count(bytes, &self->count);
    archive_count(bytes, &self->evaluations);
    archive_parts(self, bytes);
    bytes->failed |= !(self->t_previous <= self->t);
}
