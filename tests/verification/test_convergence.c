// The launch converges: in the modes of every span to the same answer, in the tolerance through
// every event (formulation.md, section 7, items 4 and 10); and it repeats bit by bit.
// ctest: slow
#include <stdlib.h>

#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/reference_model.h"

static ld_summary launch(const ld_model *model)
{
    ld_simulation *simulation;
    ld_summary summary = {0};
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary;
}

// What a user reads, and how far two launches differ in it.
typedef struct exit_change {
    double instant;  // [s] largest of t_release, t_front, t_middle, t_rear
    double speed;    // [m/s] exit speed
    double rates[3]; // [rad/s] pitch rate, yaw rate, spin
    double angle;    // [rad] pitch, yaw
} exit_change;

static exit_change difference(const ld_summary *a, const ld_summary *b)
{
    const ld_rocket_summary *p = &a->rocket[0], *q = &b->rocket[0];
    exit_change d = {.speed = fabs(p->exit_speed - q->exit_speed),
                     .rates = {fabs(p->pitch_rate - q->pitch_rate), fabs(p->yaw_rate - q->yaw_rate),
                               fabs(p->spin_rate - q->spin_rate)},
                     .angle = fmax(fabs(p->pitch - q->pitch), fabs(p->yaw - q->yaw))};
    d.instant = fmax(fmax(fabs(p->t_release - q->t_release), fabs(p->t_front - q->t_front)),
                     fmax(fabs(p->t_middle - q->t_middle), fabs(p->t_rear - q->t_rear)));
    return d;
}

static void eccentric_model(ld_model *model)
{
    reference_model(model);
    model->rocket.eccentricity[0] = 0.5e-3;
}

static void print_head(const char *what)
{
    printf("  %-18s instants [s]  speed [m/s]  pitch rate, yaw rate, spin [rad/s], angles [rad]\n",
           what);
}

static void print_row(const char *what, int steps, const exit_change *d)
{
    printf("  %-18s   %9.1e    %9.1e   %9.1e %9.1e %9.1e %9.1e  %d steps\n", what, d->instant,
           d->speed, d->rates[0], d->rates[1], d->rates[2], d->angle, steps);
}

static const struct {
    ld_mode_span span;
    const char *name;
} spans[] = {{LD_SPAN_SUPPORTED, "supported"},
             {LD_SPAN_CLAMPED, "clamped"},
             {LD_SPAN_FREE_FREE, "free-free"}};

// One row for each span: the greatest of the three differences from `truth`.
static exit_change compare_spans(ld_model *model, const ld_summary *truth)
{
    exit_change worst = {0};
    for (int i = 0; i < 3; i++) {
        char name[32];
        model->tubes.modes.span = spans[i].span;
        ld_summary summary = launch(model);
        exit_change d = difference(&summary, truth);
        snprintf(name, sizeof name, "%s %d, %d", spans[i].name, model->tubes.modes.bending,
                 model->tubes.modes.torsion);
        print_row(name, (int)summary.statistics.steps, &d);
        worst.instant = fmax(worst.instant, d.instant);
        worst.speed = fmax(worst.speed, d.speed);
        for (int k = 0; k < 3; k++)
            worst.rates[k] = fmax(worst.rates[k], d.rates[k]);
    }
    model->tubes.modes.span = LD_SPAN_SUPPORTED;
    return worst;
}

static void spans_converge_in_bending(void **state)
{
    (void)state;
    static const int modes[] = {4, 6, 8, 12, 16};
    static const double instant[] = {3e-7, 1.5e-7, 1e-7, 8e-8, 7e-8};
    static const double speed[] = {1e-4, 6e-5, 3e-5, 8e-6, 6e-6};
    static const double rate[] = {2e-3, 1e-3, 4e-4, 1.5e-4, 1e-4};
    ld_model model;
    eccentric_model(&model);
    model.run.tolerance = 1e-7;
    model.tubes.modes.torsion = 8;
    model.tubes.modes.bending = 24;
    ld_summary truth = launch(&model);
    print_head("span, bending, torsion");
    for (int k = 0; k < 5; k++) {
        model.tubes.modes.bending = modes[k];
        exit_change worst = compare_spans(&model, &truth);
        CHECK_BELOW("instants [s]", worst.instant, instant[k]);
        CHECK_BELOW("exit speed [m/s]", worst.speed, speed[k]);
        CHECK_BELOW("pitch rate [rad/s]", worst.rates[0], rate[k]);
        CHECK_BELOW("yaw rate [rad/s]", worst.rates[1], rate[k]);
        CHECK_BELOW("spin [rad/s]", worst.rates[2], 2e-3);
    }
    reference_model_free(&model);
}

// Supports that turn a hundred times as hard about y as about z: shapes of both planes on them give
// the yaw rate with 12 modes, where shapes without them miss it with 24 by ten times as much, and
// tend to the same as one over their number.
static void spans_converge_in_unlike_planes(void **state)
{
    (void)state;
    static const ld_mode_span of[] = {LD_SPAN_SUPPORTED, LD_SPAN_CLAMPED, LD_SPAN_FREE_FREE};
    ld_model model;
    double yaw_rate[3][2]; // [rad/s] 12, 24 modes
    reference_model(&model);
    model.run.tolerance = 1e-6;
    model.tubes.modes.torsion = 8;
    for (int k = 0; k < 2; k++) {
        model.tubes.support[k].rotational_stiffness[1] = 2e6;
        model.tubes.support[k].rotational_stiffness[2] = 2e4;
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            model.tubes.modes.span = of[i];
            model.tubes.modes.bending = 12 << k;
            yaw_rate[i][k] = launch(&model).rocket[0].yaw_rate;
            printf("  %d modes, span %d: %.4f mrad/s\n", 12 << k, i, 1e3 * yaw_rate[i][k]);
        }
    CHECK_NEAR("12 modes on the supports [rad/s]", yaw_rate[0][0], yaw_rate[0][1], 2e-5);
    for (int i = 1; i < 3; i++)
        CHECK_NEAR("the limit of others [rad/s]", 2 * yaw_rate[i][1] - yaw_rate[i][0],
                   yaw_rate[0][1], 5e-5);
    reference_model_free(&model);
}

// Torsion: the supports and the slot bear moments at points, where the shapes have no kink, so that
// the spin converges with the first power only.
static void spans_converge_in_torsion(void **state)
{
    (void)state;
    static const int modes[] = {1, 2, 4, 8};
    static const double spin[] = {1.6e-2, 8e-3, 3e-3, 1.6e-3};
    ld_model model;
    eccentric_model(&model);
    model.run.tolerance = 1e-7;
    model.tubes.modes.torsion = 8;
    model.tubes.modes.bending = 8;
    ld_summary truth = launch(&model);
    print_head("span, bending, torsion");
    for (int k = 0; k < 4; k++) {
        model.tubes.modes.torsion = modes[k];
        exit_change worst = compare_spans(&model, &truth);
        CHECK_BELOW("spin [rad/s]", worst.rates[2], spin[k]);
    }
    reference_model_free(&model);
}

// What a user gets by default against everything finer at once.
static void defaults_are_converged(void **state)
{
    (void)state;
    ld_model model, by_default;
    model_init(&by_default);
    eccentric_model(&model);
    model.tubes.modes.bending = by_default.tubes.modes.bending;
    model.tubes.modes.torsion = by_default.tubes.modes.torsion;
    print_head("default against fine");
    static const char *const names[] = {"reference", "eccentric 0.5 mm", "moving base"};
    for (int i = 0; i < 3; i++) {
        model.rocket.eccentricity[0] = i == 1 ? 0.5e-3 : 0;
        if (i == 2) {
            model.base.kind = LD_BASE_PRESCRIBED;
            model.base.velocity[0] = 8.33;
            model.base.pitch = (ld_sines){1, {{0.035, 1, 0}}};
            model.base.yaw = (ld_sines){1, {{0.017, 0.7, 0}}};
            model.base.heave = (ld_sines){1, {{0.02, 2, 0}}};
        }
        ld_summary usual = launch(&model);
        ld_model fine = model;
        fine.tubes.modes.bending = 24;
        fine.tubes.modes.torsion = 8;
        fine.tubes.modes.elements = 160;
        fine.run.tolerance = 1e-8;
        ld_summary truth = launch(&fine);
        exit_change d = difference(&usual, &truth);
        print_row(names[i], (int)usual.statistics.steps, &d);
        CHECK_BELOW("instants [s]", d.instant, 4e-8);
        CHECK_BELOW("exit speed [m/s]", d.speed, 1e-5);
        CHECK_BELOW("pitch rate [rad/s]", d.rates[0], 2e-4);
        CHECK_BELOW("yaw rate [rad/s]", d.rates[1], 2e-4);
        CHECK_BELOW("spin [rad/s]", d.rates[2], 2.5e-3);
    }
    reference_model_free(&model);
}

// ---- tolerance ----

// Corners and a jump of the thrust on the way.
static void set_thrust(ld_model *model)
{
    free(model->rocket.motor.thrust.data);
    model->rocket.motor.thrust = reference_table(
        7, 2,
        (double[]){0, 0, 0.01, 15e3, 0.05, 15e3, 0.05, 12e3, 0.09, 17e3, 0.13, 14e3, 2.5, 15e3});
}

enum { TOLERANCES = 7 };
static const double tolerances[TOLERANCES] = {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

typedef struct tolerance_bounds {
    double instant[TOLERANCES], speed[TOLERANCES], rate[TOLERANCES], spin[TOLERANCES];
} tolerance_bounds;

static double middle(double a, double b, double c)
{
    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

// What one sequence of steps leaves is chance: the middle one of three.
static exit_change typical_difference(ld_model *model, double tolerance, const ld_summary *truth)
{
    exit_change d[3], typical;
    for (int k = 0; k < 3; k++) {
        model->run.tolerance = tolerance * (1 - 0.1 * k);
        ld_summary summary = launch(model);
        d[k] = difference(&summary, truth);
    }
    typical.instant = middle(d[0].instant, d[1].instant, d[2].instant);
    typical.speed = middle(d[0].speed, d[1].speed, d[2].speed);
    typical.angle = middle(d[0].angle, d[1].angle, d[2].angle);
    for (int k = 0; k < 3; k++)
        typical.rates[k] = middle(d[0].rates[k], d[1].rates[k], d[2].rates[k]);
    return typical;
}

static void check_tolerances(ld_model *model, const tolerance_bounds *bound)
{
    model->run.tolerance = 1e-12;
    ld_summary truth = launch(model);
    print_head("tolerance");
    for (int i = 0; i < TOLERANCES; i++) {
        char name[32];
        exit_change d = typical_difference(model, tolerances[i], &truth);
        model->run.tolerance = tolerances[i];
        snprintf(name, sizeof name, "%.0e", tolerances[i]);
        print_row(name, (int)launch(model).statistics.steps, &d);
        CHECK_BELOW("instants [s]", d.instant, bound->instant[i]);
        CHECK_BELOW("exit speed [m/s]", d.speed, bound->speed[i]);
        CHECK_BELOW("pitch and yaw rate [rad/s]", fmax(d.rates[0], d.rates[1]), bound->rate[i]);
        CHECK_BELOW("spin [rad/s]", d.rates[2], bound->spin[i]);
    }
}

// The whole thing, touching and parting adaptors and the nodes of the tube included: they are kinks
// that step control passes. At 1e-10 the instants' error is what the steps happen to leave: 2e-13
// to 2.4e-12 s over 24 masses 1e-7 apart.
static void tolerance_converges(void **state)
{
    (void)state;
    ld_model model;
    eccentric_model(&model);
    set_thrust(&model);
    static const tolerance_bounds bound = {
        .instant = {4e-8, 2.5e-9, 5e-10, 8e-11, 1e-11, 7e-12, 5e-12},
        .speed = {6e-7, 3e-7, 1.6e-7, 8e-8, 3e-8, 1.2e-8, 3.5e-9},
        .rate = {7e-6, 3e-6, 6e-7, 6e-7, 5e-8, 2.5e-8, 6e-9},
        .spin = {1.2e-5, 1.2e-5, 4e-6, 2e-6, 2e-6, 8e-7, 2.5e-7}};
    check_tolerances(&model, &bound);
    reference_model_free(&model);
}

// Smooth between the events (release, corners and jump of the thrust, three exits): adaptors
// without clearance, a tube of one element with its supports at the ends, no friction. The longest
// step allowed, 0.2 ms, makes it exact already at coarse tolerances: what is left at 1e-4 comes
// from the events, nearly nothing.
static void tolerance_converges_between_events(void **state)
{
    (void)state;
    ld_model model;
    eccentric_model(&model);
    set_thrust(&model);
    model.tubes.support[0].at = 0;
    model.tubes.support[1].at = model.tubes.length;
    model.tubes.modes.elements = 1;
    model.tubes.modes.bending = 2;
    model.tubes.modes.torsion = 1;
    model.tubes.slot.friction = 0;
    model.rocket.contact.law = LD_CONTACT_BILATERAL;
    model.rocket.contact.friction = 0;
    static const tolerance_bounds bound = {
        .instant = {8e-12, 8e-12, 8e-12, 8e-12, 8e-12, 8e-12, 5e-12},
        .speed = {5e-9, 4e-10, 4e-10, 5e-10, 2e-10, 5e-11, 2e-11},
        .rate = {1e-8, 1e-8, 1e-8, 8e-9, 1.5e-9, 1.3e-10, 1.5e-11},
        .spin = {3e-6, 1.5e-7, 1.5e-7, 1.8e-7, 6e-8, 6e-9, 6e-10}};
    check_tolerances(&model, &bound);
    reference_model_free(&model);
}

static void same_bits_again(void **state)
{
    (void)state;
    ld_model model;
    ld_summary first, second;
    eccentric_model(&model);
    first = launch(&model);
    second = launch(&model);
    first.statistics.cpu_seconds = second.statistics.cpu_seconds = 0;
    first.statistics.cpu_seconds_setup = second.statistics.cpu_seconds_setup = 0;
    assert_memory_equal(&first, &second, sizeof first);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spans_converge_in_bending),
        cmocka_unit_test(spans_converge_in_unlike_planes),
        cmocka_unit_test(spans_converge_in_torsion),
        cmocka_unit_test(defaults_are_converged),
        cmocka_unit_test(tolerance_converges),
        cmocka_unit_test(tolerance_converges_between_events),
        cmocka_unit_test(same_bits_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
