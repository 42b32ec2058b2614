// The integrator's adapter against closed forms: order, events, interpolation, repetition.
#include "integration/dormand_prince.h"
#include "integration/integrator.h"
#include "support/check.h"

// Oscillator y'' = -y: y = (sin t, cos t); event: y[0] = 0.5 first at pi/6.
static int oscillator(double t, const double *y, double *y_dot, void *self)
{
    (void)t, (void)self;
    y_dot[0] = y[1];
    y_dot[1] = -y[0];
    return 0;
}

static int half(double t, const double *y, double *g, void *self)
{
    (void)t, (void)self;
    g[0] = 0.5 - y[0];
    return 0;
}

static integrator *make(double rtol, integrator_events events)
{
    double atol[2] = {rtol, rtol};
    integrator_settings settings = {.n = 2,
                                    .rtol = rtol,
                                    .atol = atol,
                                    .rhs = oscillator,
                                    .events = events,
                                    .event_count = events ? 1 : 0};
    integrator *self = NULL;
    ld_error error;
    assert_int_equal(integrator_create(&settings, &self, &error), LD_OK);
    assert_int_equal(integrator_start(self, 0, (double[]){0, 1}, &error), LD_OK);
    return self;
}

static void error_follows_tolerance(void **state)
{
    (void)state;
    double bounds[] = {1e-6, 5e-8, 8e-10, 1e-11};
    for (int k = 0; k < 4; k++) {
        double rtol = pow(10, -5 - 2 * k);
        integrator *self = make(rtol, NULL);
        while (integrator_step(self, 10.0, NULL) == INTEGRATOR_STEPPED)
            ;
        CHECK_BELOW("oscillator at t = 10: error", integrator_state(self)[0] - sin(10.0),
                    bounds[k]);
        integrator_free(self);
    }
}

// With a state beside it that only counts how far the first has gone, and has no bound.
static int with_quadrature(double t, const double *y, double *y_dot, void *self)
{
    oscillator(t, y, y_dot, self);
    y_dot[2] = fabs(y[1]);
    return 0;
}

static void quadratures_do_not_steer(void **state)
{
    (void)state;
    double atol[3] = {1e-7, 1e-7, INFINITY};
    integrator_settings settings = {.n = 3, .rtol = 1e-7, .atol = atol, .rhs = with_quadrature};
    integrator *beside = NULL, *alone = make(1e-7, NULL);
    assert_int_equal(integrator_create(&settings, &beside, NULL), LD_OK);
    assert_int_equal(integrator_start(beside, 0, (double[]){0, 1, 0}, NULL), LD_OK);
    int steps = 0, differ = 0;
    for (; integrator_step(alone, 10.0, NULL) == INTEGRATOR_STEPPED; steps++) {
        assert_int_equal(integrator_step(beside, 10.0, NULL), INTEGRATOR_STEPPED);
        differ += integrator_time(alone) != integrator_time(beside) ||
                  memcmp((const char *)integrator_state(alone),
                         (const char *)integrator_state(beside), 2 * sizeof(double)) != 0;
    }
    CHECK_WITHIN("steps that differ beside a quadrature", differ, 0, 0);
    assert_true(steps > 10);
    integrator_free(alone);
    integrator_free(beside);
}

// Of the order, over a period of y'' = -y by steps of one size; loose tolerances refuse none.
static double error_of_steps(double step)
{
    double atol[2] = {1e9, 1e9};
    integrator_settings settings = {.n = 2,
                                    .method = INTEGRATOR_OSCILLATING,
                                    .rtol = 1e-3,
                                    .atol = atol,
                                    .max_step = step,
                                    .rhs = oscillator};
    integrator *self = NULL;
    assert_int_equal(integrator_create(&settings, &self, NULL), LD_OK);
    assert_int_equal(integrator_start(self, 0, (double[]){0, 1}, NULL), LD_OK);
    double end = 1000 * step;
    while (integrator_step(self, end, NULL) == INTEGRATOR_STEPPED)
        ;
    const double *y = integrator_state(self);
    double error = hypot(y[0] - sin(end), y[1] - cos(end)), size = hypot(y[0], y[1]);
    integrator_free(self);
    return step > 1 ? size : error / end;
}

// What is undamped does not grow where the method is said to be stable, and does beyond.
static void oscillations_are_stable(void **state)
{
    (void)state;
    double order = log2(error_of_steps(0.1) / error_of_steps(0.05));
    CHECK_NEAR("order on an oscillation", order, 4, 0.02);
    CHECK_BELOW("amplitude after 1000 long steps", error_of_steps(INTEGRATOR_STABLE_TO), 1);
    CHECK_BELOW("one over it, by longer ones", 1 / error_of_steps(INTEGRATOR_STABLE_TO + 0.2),
                1e-6);
}

static void event_is_a_step_end(void **state)
{
    (void)state;
    integrator *self = make(1e-10, half);
    integrator_outcome outcome;
    do
        outcome = integrator_step(self, 10.0, NULL);
    while (outcome == INTEGRATOR_STEPPED);
    assert_int_equal(outcome, INTEGRATOR_EVENT);
    assert_int_equal(integrator_event(self, 0), -1);
    CHECK_BELOW("event time less pi/6", integrator_time(self) - acos(-1.0) / 6, 5e-12);
    CHECK_BELOW("state at the event, against sin t there",
                integrator_state(self)[0] - sin(integrator_time(self)), 5e-12);
    integrator_free(self);
}

static void interpolation_lies_on_the_solution(void **state)
{
    (void)state;
    integrator *self = make(1e-8, NULL);
    double worst = 0;
    while (integrator_time(self) < 3) {
        integrator_step(self, 3.0, NULL);
        for (double x = 0.1; x < 1; x += 0.2) {
            double t0 = integrator_previous_time(self), y[2];
            double t = t0 + x * (integrator_time(self) - t0);
            integrator_interpolate(self, t, y);
            worst = fmax(worst, fabs(y[0] - sin(t)));
        }
    }
    CHECK_BELOW("cubic Hermite between steps", worst, 2e-7);
    integrator_free(self);
}

// Continuing over stops costs no evaluation: each step takes six, seven stages and the first known.
static void a_stop_is_no_restart(void **state)
{
    (void)state;
    integrator *self = make(1e-8, NULL);
    integrator_step(self, 0.1, NULL);
    int64_t begun = integrator_evaluations(self);
    for (int k = 1; k <= 20; k++)
        while (integrator_time(self) < 0.1 * k)
            integrator_step(self, 0.1 * k, NULL);
    assert_int_equal((integrator_evaluations(self) - begun) % 6, 0);
    integrator_free(self);
}

static int not_finite(double t, const double *y, double *y_dot, void *self)
{
    (void)y, (void)self;
    y_dot[0] = 1;
    return t > 1;
}

static void failing_equations_are_reported(void **state)
{
    (void)state;
    double atol = 1e-6;
    integrator_settings settings = {.n = 1, .rtol = 1e-6, .atol = &atol, .rhs = not_finite};
    integrator *self = NULL;
    ld_error error;
    assert_int_equal(integrator_create(&settings, &self, &error), LD_OK);
    assert_int_equal(integrator_start(self, 0, (double[]){0}, &error), LD_OK);
    integrator_outcome outcome;
    do
        outcome = integrator_step(self, 10.0, &error);
    while (outcome == INTEGRATOR_STEPPED);
    assert_int_equal(outcome, INTEGRATOR_FAILED);
    assert_non_null(strstr(error.text, "gave no finite result at t ="));
    integrator_free(self);
}

// ---- saved at every step's end, loaded into another one, continued with: the same bits

enum { STATES = 7, EVENTS = 3, MOST_STEPS = 500, MOST_BYTES = 4096 };

typedef struct problem {
    const char *name;
    integrator_method method;
    double rtol, max_step, end;
    bool stops; // at each tenth of a second, and others that only rounding parts from a step's end
    bool returns; // after an event the state jumps and the integration starts again
    bool events;
    int calls, event_calls; // of the equations and the events
} problem;

// A rough and a smooth oscillation, what they drive, and a state that stays at minus zero.
static int rough(double t, const double *y, double *y_dot, void *self)
{
    ((problem *)self)->calls++;
    y_dot[0] = y[1];
    y_dot[1] = 8 * (1 - y[0] * y[0]) * y[1] - y[0];
    y_dot[2] = 5 * y[3];
    y_dot[3] = -5 * y[2] + (t > 0.5 ? 1 : 0);
    y_dot[4] = y[0] * y[2];
    y_dot[5] = cos(20 * t) * y[3];
    y_dot[6] = -0.0;
    return 0;
}

// The last one is zero for as long as the time is below 0.3, which makes it inactive.
static int crossings(double t, const double *y, double *g, void *self)
{
    ((problem *)self)->event_calls++;
    g[0] = y[2] - 0.25;
    g[1] = y[0] + 1.5;
    g[2] = t < 0.3 ? 0 : 1;
    return 0;
}

static integrator *of_problem(problem *self)
{
    static const double atol[STATES] = {1e-6, 1e-6, 1e-6, 1e-6, 1e300, 1e-8, 1e-6};
    integrator_settings settings = {.n = STATES,
                                    .method = self->method,
                                    .rtol = self->rtol,
                                    .atol = atol,
                                    .max_step = self->max_step,
                                    .rhs = rough,
                                    .events = self->events ? crossings : NULL,
                                    .event_count = self->events ? EVENTS : 0,
                                    .self = self};
    integrator *stepper = NULL;
    assert_int_equal(integrator_create(&settings, &stepper, NULL), LD_OK);
    return stepper;
}

// What is seen of a step.
typedef struct seen {
    double t, t_previous, y[STATES], between[3][STATES];
    integrator_outcome outcome;
    int found[EVENTS], calls, event_calls;
    int64_t steps, evaluations;
} seen;

static void look(const problem *self, integrator *stepper, integrator_outcome outcome, seen *out)
{
    memset(out, 0, sizeof *out);
    out->t = integrator_time(stepper);
    out->t_previous = integrator_previous_time(stepper);
    memcpy(out->y, integrator_state(stepper), sizeof out->y);
    for (int k = 0; k < 3; k++)
        integrator_interpolate(stepper,
                               out->t_previous + (0.1 + 0.4 * k) * (out->t - out->t_previous),
                               out->between[k]);
    out->outcome = outcome;
    for (int i = 0; i < EVENTS && self->events; i++)
        out->found[i] = integrator_event(stepper, i);
    out->calls = self->calls;
    out->event_calls = self->event_calls;
    out->steps = integrator_steps(stepper);
    out->evaluations = integrator_evaluations(stepper);
}

// The stop depends on the time alone, so that all go the same way.
static integrator_outcome step_of(const problem *self, integrator *stepper)
{
    double t = integrator_time(stepper), stop = self->end;
    if (self->stops) {
        int64_t steps = integrator_steps(stepper);
        stop = fmin(stop, 0.1 * (floor(10 * t + 1e-9) + 1));
        if (steps % 16 == 11 && t > 0)
            stop = t * (1 + 8 * 2.3e-16);
    }
    ld_error error;
    integrator_outcome outcome = integrator_step(stepper, stop, &error);
    assert_int_not_equal(outcome, INTEGRATOR_FAILED);
    return outcome;
}

// What follows on a stop or an event.
static void go_back(const problem *self, integrator *stepper, integrator_outcome outcome)
{
    bool jumps = outcome == INTEGRATOR_EVENT && self->returns;
    if (outcome != INTEGRATOR_STOPPED && !jumps)
        return;
    double y[STATES];
    memcpy(y, integrator_state(stepper), sizeof y);
    if (jumps)
        y[3] *= -0.9;
    assert_int_equal(integrator_start(stepper, integrator_time(stepper), y, NULL), LD_OK);
}

static size_t save(integrator *stepper, unsigned char *bytes)
{
    archive saved = archive_save(bytes, MOST_BYTES);
    integrator_archive(stepper, &saved);
    assert_false(saved.failed);
    return saved.at;
}

static void load(integrator *stepper, const unsigned char *bytes, size_t size)
{
    archive loaded = archive_load(bytes, size);
    integrator_archive(stepper, &loaded);
    assert_false(loaded.failed);
    assert_int_equal(loaded.at, size);
}

static integrator_outcome started(integrator *stepper)
{
    double y[STATES] = {2, 0, 0.2, 0, 0, 0, -0.0};
    assert_int_equal(integrator_start(stepper, 0, y, NULL), LD_OK);
    return INTEGRATOR_STEPPED;
}

// All that is seen of a run, and its states after each step.
typedef struct course {
    seen seen[MOST_STEPS];
    unsigned char bytes[MOST_STEPS][MOST_BYTES];
    size_t size;
    int count;
} course;

static void same_at(const problem *self, integrator *stepper, integrator_outcome outcome,
                    const course *way, int k)
{
    seen now;
    unsigned char bytes[MOST_BYTES];
    look(self, stepper, outcome, &now);
    assert_memory_equal(&now, &way->seen[k], sizeof now);
    assert_int_equal(save(stepper, bytes), way->size);
    assert_memory_equal(bytes, way->bytes[k], way->size);
}

// From the state saved after step k to the end.
static void go_on_from(problem *self, integrator *other, const course *way, int k)
{
    integrator_outcome outcome = way->seen[k].outcome;
    load(other, way->bytes[k], way->size);
    self->calls = way->seen[k].calls;
    self->event_calls = way->seen[k].event_calls;
    for (;;) {
        same_at(self, other, outcome, way, k);
        if (++k == way->count)
            return;
        go_back(self, other, outcome);
        outcome = step_of(self, other);
    }
}

static void same_bits(problem self)
{
    static course way;
    int events = 0, stops = 0, k = 0;
    integrator *stepper = of_problem(&self), *used = of_problem(&self);
    integrator_outcome outcome = started(stepper);
    for (;; k++) {
        assert_true(k < MOST_STEPS);
        look(&self, stepper, outcome, &way.seen[k]);
        way.size = save(stepper, way.bytes[k]);
        events += outcome == INTEGRATOR_EVENT;
        stops += outcome == INTEGRATOR_STOPPED;
        if (integrator_time(stepper) >= self.end)
            break;
        go_back(&self, stepper, outcome);
        outcome = step_of(&self, stepper);
    }
    way.count = k + 1;
    printf("    %-28s %d steps, %d events, %d stops, %zu bytes\n", self.name, k, events, stops,
           way.size);
    assert_int_equal(events > 2, self.events);
    assert_int_equal(stops > 20, self.stops);
    for (k = 0; k < way.count; k++) { // into a new one, and into one that went elsewhere
        integrator *fresh = of_problem(&self);
        go_on_from(&self, fresh, &way, k);
        integrator_free(fresh);
        go_on_from(&self, used, &way, k);
    }
    integrator_free(stepper);
    integrator_free(used);
}

static void saved_at_every_step(void **state)
{
    (void)state;
    for (integrator_method method = 0; method <= INTEGRATOR_OSCILLATING; method++) {
        printf("  method %d\n", (int)method);
        double rtol = method == INTEGRATOR_BOGACKI_SHAMPINE ? 1e-3 : 1e-5;
        problem plain = {.name = "free", .method = method, .rtol = rtol, .end = 2.5};
        problem bounded = plain, stopped = plain, event = plain, all = plain;
        bounded.name = "longest step";
        bounded.max_step = 0.013;
        stopped.name = "stops";
        stopped.stops = true;
        event.name = "events";
        event.events = true;
        all.name = "all, jumps at events";
        all.max_step = 0.021;
        all.events = all.stops = all.returns = true;
        same_bits(plain);
        same_bits(bounded);
        same_bits(stopped);
        same_bits(event);
        same_bits(all);
    }
}

static void foreign_bytes_are_refused(void **state)
{
    (void)state;
    problem with = {.method = INTEGRATOR_CASH_KARP, .rtol = 1e-5, .end = 1, .events = true};
    problem without = with, other = with;
    without.events = false;
    other.method = INTEGRATOR_DORMAND_PRINCE;
    unsigned char bytes[MOST_BYTES];
    integrator *stepper = of_problem(&with);
    started(stepper);
    step_of(&with, stepper);
    size_t size = save(stepper, bytes);
    integrator *others[] = {of_problem(&without), of_problem(&other)};
    for (int i = 0; i < 2; i++) {
        archive loaded = archive_load(bytes, size);
        integrator_archive(others[i], &loaded);
        assert_true(loaded.failed);
        integrator_free(others[i]);
    }
    for (size_t cut = 0; cut < size; cut++) {
        archive loaded = archive_load(bytes, cut);
        integrator_archive(stepper, &loaded);
        assert_true(loaded.failed);
    }
    integrator_free(stepper);
}

static void decay(const double *t, const double *y, double *y_dot, void *self)
{
    (void)t, (void)self;
    for (int i = 0; i < DORMAND_PRINCE_STATES; i++)
        y_dot[i] = -y[i];
}

static void no_slopes(const double *t, const double *y, double *y_dot, void *self)
{
    (void)t, (void)y, (void)self;
    for (int i = 0; i < DORMAND_PRINCE_STATES; i++)
        y_dot[i] = NAN;
}

// As of a gust and of a thrust curve whose corners are the same but for rounding.
static void stops_a_rounding_apart(void **state)
{
    (void)state;
    dormand_prince steps = {.f = decay, .count = 1};
    double y[DORMAND_PRINCE_STATES] = {1}, first = nextafter(0.5, 0), end = 1;
    steps.step.absolute[0] = 1e-10;
    for (int i = 1; i < DORMAND_PRINCE_STATES; i++)
        steps.step.absolute[i] = 1;
    dormand_prince_start(&steps, 0, y);
    const double stop[] = {first, 0.5, end};
    for (int i = 0; i < 3; i++)
        while (steps.step.t < stop[i])
            assert_true(dormand_prince_step(&steps, stop[i]));
    CHECK_NEAR("decay over two stops", steps.step.y[0], 0.36787944117144233, 3e-10);
    steps.f = no_slopes;
    assert_false(dormand_prince_step(&steps, nextafter(end, 2)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_follows_tolerance),
        cmocka_unit_test(quadratures_do_not_steer),
        cmocka_unit_test(oscillations_are_stable),
        cmocka_unit_test(event_is_a_step_end),
        cmocka_unit_test(interpolation_lies_on_the_solution),
        cmocka_unit_test(a_stop_is_no_restart),
        cmocka_unit_test(failing_equations_are_reported),
        cmocka_unit_test(saved_at_every_step),
        cmocka_unit_test(foreign_bytes_are_refused),
        cmocka_unit_test(stops_a_rounding_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
