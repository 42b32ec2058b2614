// An externally driven base (model.md, section 2): what a motion that is known through and
// through loses when it is given at instants alone, and the wrench that comes back.
// ctest: slow
#include <stdlib.h>

#include "launch/launch_run.h"
#include "launchdyn/run.h"
#include "scenario/scenario.h"
#include "state/evaluation.h"
#include "support/check.h"
#include "support/dense_launch.h"
#include "support/launching_state.h"

// An example, and the frame T that its base has.
typedef struct known_motion {
    ld_model model;
    base_system base;
} known_motion;

// With at most two other texts for --set.
static void know_changed(known_motion *self, const char *example, const char *const change[2],
                         double tolerance)
{
    char path[512];
    ld_error error;
    ld_messages messages = {0};
    const char *const sets[] = {"run.lead_in=0.2 s", change[0], change[1]};
    size_t count = !change[0] ? 1 : !change[1] ? 2 : 3;
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, example);
    if (scenario_read(path, sets, count, &self->model, &messages))
        fail_msg("%s", path);
    self->model.run.tolerance = tolerance;
    if (base_build(&self->base, &self->model, NULL, &error))
        fail_msg("%s", error.text);
}

static void know(known_motion *self, const char *example, double tolerance)
{
    know_changed(self, example, (const char *[2]){NULL}, tolerance);
}

static void forget(known_motion *self)
{
    base_free(&self->base);
    model_clear(&self->model);
}

static ld_base_frame frame_at(const known_motion *self, double t)
{
    base_frame frame;
    base_found unused;
    ld_base_frame told;
    self->base.kind->find_frame(&self->base, t, NULL, &frame, &unused);
    v3_store(told.position, frame.r);
    memcpy(told.quaternion, &frame.q, sizeof told.quaternion);
    v3_store(told.velocity, frame.v);
    v3_store(told.rate, frame.w);
    return told;
}

static ld_model told_model(const known_motion *self, ld_extrapolation extrapolation)
{
    ld_model model = self->model;
    model.base.kind = LD_BASE_EXTERNAL;
    model.base.extrapolation = extrapolation;
    return model;
}

static ld_simulation *create(const ld_model *model)
{
    ld_error error;
    ld_simulation *simulation;
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    return simulation;
}

static ld_summary run_through(const ld_model *model)
{
    ld_error error;
    ld_summary summary;
    ld_simulation *simulation = create(model);
    if (ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary;
}

static ld_run *begin(const ld_simulation *simulation, const ld_base_frame *first)
{
    ld_run *run;
    ld_error error;
    if (ld_run_begin(simulation, &(ld_run_options){.base = first}, &run, &error))
        fail_msg("%s", error.text);
    return run;
}

// Continues to the end, telling the base at `first` [s] and every `step` from there on.
static void go_on(ld_run *run, const known_motion *motion, double first, double step)
{
    ld_error error;
    for (int k = 0; !ld_run_is_finished(run); k++) {
        ld_status status = ld_run_advance(run, first + k * step, &error);
        ld_base_frame now = frame_at(motion, ld_run_time(run));
        if (!status && !ld_run_is_finished(run))
            status = ld_run_set_base(run, &now, &error);
        if (status)
            fail_msg("%s", error.text);
    }
}

static ld_summary end(ld_run *run)
{
    ld_error error;
    ld_summary summary;
    if (ld_run_end(run, &summary, &error))
        fail_msg("%s", error.text);
    return summary;
}

// A run that is reported every `step` [s] so that `one` is among the instants.
static ld_summary run_told(const known_motion *motion, ld_extrapolation extrapolation, double one,
                           double step)
{
    ld_model model = told_model(motion, extrapolation);
    ld_simulation *simulation = create(&model);
    double start = -model.run.lead_in;
    ld_base_frame first = frame_at(motion, start);
    ld_run *run = begin(simulation, &first);
    go_on(run, motion, start + fmod(one - start, step), step);
    ld_summary summary = end(run);
    ld_simulation_free(simulation);
    return summary;
}

// Larger difference of the two exit rates [mrad/s].
static double difference(const ld_summary *a, const ld_summary *b)
{
    const ld_rocket_summary *p = &a->rocket[0], *q = &b->rocket[0];
    return 1e3 * fmax(fabs(p->pitch_rate - q->pitch_rate), fabs(p->yaw_rate - q->yaw_rate));
}

// ---- a motion reported at instants ----

static void a_ship_told_every_millisecond(void **state)
{
    (void)state;
    known_motion ship;
    know(&ship, "ship.yaml", 1e-8);
    ld_summary known = run_through(&ship.model);
    double start = -ship.model.run.lead_in;
    ld_summary told = run_told(&ship, LD_EXTRAPOLATION_ACCELERATION, start, 1e-3);
    CHECK_BELOW("exit rates, with acceleration [mrad/s]", difference(&told, &known), 1e-4);
    told = run_told(&ship, LD_EXTRAPOLATION_VELOCITY, start, 1e-3);
    CHECK_BELOW("exit rates, velocities alone [mrad/s]", difference(&told, &known), 0.02);
    forget(&ship);
}

// A ship's deck with other things on it than springs and a bore. Adaptors that hold on both sides:
// with gaps the exit hangs on what the first millisecond leaves, which nothing damps on clamps.
#define CLAMPS "tubes.supports=[{at: 0.4 m, clamped: all}, {at: 1.8 m, clamped: [y, z]}]"
static const struct {
    const char *example, *change[2], *what;
    double bound; // [mrad/s]
} decks[] = {
    {"ship.yaml",
     {CLAMPS, "rocket.contact={law: bilateral, exponent: 1, friction: 0, damping: 1e3 N.s/m}"},
     "exit rates, on clamps [mrad/s]",
     2e-2},
    {"rail/deck.yaml", {NULL}, "on a rail", 1e-2},
};

static void other_decks_told_every_millisecond(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        known_motion deck;
        know_changed(&deck, decks[i].example, decks[i].change, 1e-6);
        ld_summary known = run_through(&deck.model);
        ld_summary told = run_told(&deck, LD_EXTRAPOLATION_ACCELERATION, 0, 1e-3);
        CHECK_BELOW(decks[i].what, difference(&told, &known), decks[i].bound);
        forget(&deck);
    }
}

// Jumps that come every h shake the tube the less the faster they come, so it falls faster than the
// jumps themselves. The exit stands in the middle between two instants.
static void the_error_falls_with_the_step(void **state)
{
    (void)state;
    static const double step[] = {2e-3, 1e-3, 0.5e-3, 0.25e-3};
    static const char *const names[] = {"with acceleration", "velocities alone"};
    known_motion ship;
    know(&ship, "ship.yaml", 1e-10);
    ld_summary known = run_through(&ship.model);
    double exit = known.rocket[0].t_ignition + known.rocket[0].t_rear;
    double error[2][4], residual[2][4];
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 4; i++) {
            ld_extrapolation how = k ? LD_EXTRAPOLATION_VELOCITY : LD_EXTRAPOLATION_ACCELERATION;
            ld_summary told = run_told(&ship, how, exit - 0.5 * step[i], step[i]);
            error[k][i] = difference(&told, &known);
            residual[k][i] = fabs(told.energy.residual_relative);
            printf("    %s, every %.2f ms: exit rates %.2e mrad/s, order %.2f\n", names[k],
                   1e3 * step[i], error[k][i], i ? log2(error[k][i - 1] / error[k][i]) : NAN);
        }
    // velocities alone: the exit rates, and what the jumps do to the energy, of the first order
    static const double velocities[] = {3.5e-2, 1e-2, 1e-3, 1e-4};
    for (int i = 0; i < 4; i++)
        CHECK_BELOW("velocities alone", error[1][i], velocities[i]);
    CHECK_WITHIN("mean order", log2(error[1][0] / error[1][3]) / 3, 2.8, 3.6);
    CHECK_WITHIN("order of the energy's residual", log2(residual[1][0] / residual[1][3]) / 3, 0.97,
                 1.03);
    // with acceleration: the rest is the integrator's
    static const double accelerations[] = {5e-5, 1e-5, 1e-5, 1e-5};
    for (int i = 0; i < 4; i++)
        CHECK_BELOW("with acceleration", error[0][i], accelerations[i]);
    forget(&ship);
}

// ---- a base at rest ----

static double worst(const ld_summary *a, const ld_summary *b)
{
    const ld_rocket_summary *p = &a->rocket[0], *q = &b->rocket[0];
    double speed = fabs(p->exit_speed - q->exit_speed) / q->exit_speed;
    double instant = fabs(p->t_rear - q->t_rear) / q->t_rear;
    return fmax(fmax(speed, instant), difference(a, b));
}

// Reported once it continues as it stands; set again and again it is where it was. The integrator's
// steps differ: its error norm is a mean over the states, of which what was given are twenty more.
static void a_base_told_to_stand_is_fixed(void **state)
{
    (void)state;
    known_motion still;
    know(&still, "fixed.yaml", 1e-8);
    ld_summary known = run_through(&still.model);
    ld_summary once = run_told(&still, LD_EXTRAPOLATION_ACCELERATION, 0, 1e9);
    CHECK_BELOW("told once: exit instant, speed (relative), rates [mrad/s]", worst(&once, &known),
                5e-5);
    ld_summary often = run_told(&still, LD_EXTRAPOLATION_ACCELERATION, 0, 1e-3);
    CHECK_BELOW("told every 1 ms", worst(&often, &known), 1e-4);
    forget(&still);
}

// ---- the wrench ----

// That of the supports by the independent program, in I.
static void independent_wrench(const ld_run *run, const double *y, ld_base_wrench *wrench)
{
    static launching_case c;
    const launch_state *launch = &run->launch;
    const launching_system *launching = &launch->launcher.launching;
    launcher_input input;
    dense_launch dense;
    dense_launch_output out;
    memset(&c, 0, sizeof c);
    simulation_input(launch, run->t, y, &input);
    memcpy(c.state, y, (size_t)launching->layout.count * sizeof *y);
    c.input = input.launching;
    c.phase = launch->phase;
    copy_to_dense(launching, &c);
    dense_launch_create(&dense, launch->model, &launching->tube.flexible);
    assert_true(dense_launch_evaluate(&dense, &c.dense, &out));
    dense_launch_free(&dense);
    v3_store(wrench->force, m3_apply(input.launching.base.A, v3_from(out.base_force)));
    v3_store(wrench->moment, m3_apply(input.launching.base.A, v3_from(out.base_moment)));
}

static void the_wrench_at_rest_is_the_weight(void **state)
{
    (void)state;
    ld_error error;
    ld_base_wrench told;
    known_motion motion;
    know(&motion, "fixed.yaml", 1e-8);
    ld_model model = told_model(&motion, LD_EXTRAPOLATION_ACCELERATION);
    ld_simulation *simulation = create(&model);
    ld_base_frame first = frame_at(&motion, -model.run.lead_in);
    ld_run *run = begin(simulation, &first);
    assert_int_equal(ld_run_base_wrench(run, &told, &error), LD_OK);
    double tube = model.tubes.section[0].mass_per_length * model.tubes.length;
    double weight = model.gravity * (tube + model.tubes.tail.mass + model.rocket.full.mass);
    CHECK_BELOW("at rest: force less the weight (relative)",
                hypot(hypot(told.force[0], told.force[1] + weight), told.force[2]) / weight, 1e-9);
    ld_run_end(run, NULL, NULL);
    ld_simulation_free(simulation);
    forget(&motion);
}

// Of a moving deck, before and during the launch.
static void wrench_on_deck(known_motion *motion, double off[2])
{
    ld_error error;
    ld_base_wrench told, known;
    ld_model model = told_model(motion, LD_EXTRAPOLATION_ACCELERATION);
    ld_simulation *simulation = create(&model);
    ld_base_frame first = frame_at(motion, -model.run.lead_in);
    ld_run *run = begin(simulation, &first);
    for (int i = -3; i <= 3; i++) {
        double t = 0.05 * i;
        ld_base_frame now = frame_at(motion, t);
        assert_int_equal(ld_run_advance(run, t, &error), LD_OK);
        assert_int_equal(ld_run_set_base(run, &now, &error), LD_OK);
        assert_int_equal(ld_run_base_wrench(run, &told, &error), LD_OK);
        independent_wrench(run, propagator_state(run->propagator), &known);
        for (int k = 0; k < 3; k++) {
            off[0] = fmax(off[0], fabs(told.force[k] - known.force[k]));
            off[1] = fmax(off[1], fabs(told.moment[k] - known.moment[k]));
        }
    }
    ld_run_end(run, NULL, NULL);
    ld_simulation_free(simulation);
}

static void the_wrench_is_the_supports_on_decks(void **state)
{
    (void)state;
    static const char *const force[] = {"on springs: force against the independent one [N]",
                                        "on clamps: force", "on a rail: force"};
    for (int i = 0; i < 3; i++) {
        known_motion deck;
        double off[2] = {0};
        if (i == 0)
            know(&deck, "ship.yaml", 1e-8);
        else
            know_changed(&deck, decks[i - 1].example, decks[i - 1].change, 1e-8);
        wrench_on_deck(&deck, off);
        CHECK_BELOW(force[i], off[0], 1e-6);
        CHECK_BELOW("moment [N m]", off[1], 1e-6);
        forget(&deck);
    }
}

// ---- state ----

// What it was given last is part of the state: loaded it continues with the same bits.
static void told_base_is_saved(const known_motion *ship)
{
    static unsigned char bytes[65536];
    size_t size;
    ld_error error;
    ld_model model = told_model(ship, LD_EXTRAPOLATION_ACCELERATION);
    ld_simulation *simulation = create(&model);
    ld_base_frame first = frame_at(ship, -model.run.lead_in);
    ld_run *run = begin(simulation, &first), *loaded;
    for (int i = -19; i < 5; i++) {
        double t = 0.01 * i;
        ld_base_frame now = frame_at(ship, t);
        assert_int_equal(ld_run_advance(run, t, &error), LD_OK);
        assert_int_equal(ld_run_set_base(run, &now, &error), LD_OK);
    }
    assert_int_equal(ld_run_save(run, bytes, sizeof bytes, &size, &error), LD_OK);
    assert_int_equal(ld_run_load(simulation, NULL, bytes, size, &loaded, &error), LD_OK);
    double from = ld_run_time(run) + 0.01;
    // set again at the same time, it was not reported before
    ld_base_frame now = frame_at(ship, from), wrong = now;
    wrong.velocity[1] += 0.1;
    wrong.rate[2] -= 0.01;
    assert_int_equal(ld_run_advance(run, from, &error), LD_OK);
    assert_int_equal(ld_run_advance(loaded, from, &error), LD_OK);
    assert_int_equal(ld_run_set_base(run, &now, &error), LD_OK);
    assert_int_equal(ld_run_set_base(loaded, &wrong, &error), LD_OK);
    assert_int_equal(ld_run_set_base(loaded, &now, &error), LD_OK);
    go_on(run, ship, from + 0.01, 0.01);
    go_on(loaded, ship, from + 0.01, 0.01);
    ld_summary all = end(run), part = end(loaded);
    assert_true(all.rocket[0].t_rear > from);
    assert_memory_equal(&all.rocket[0].exit, &part.rocket[0].exit, sizeof all.rocket[0].exit);
    ld_simulation_free(simulation);
}

static void a_told_base_is_saved(void **state)
{
    (void)state;
    known_motion ship;
    know(&ship, "ship.yaml", 1e-5);
    told_base_is_saved(&ship);
    forget(&ship);
    for (int i = 0; i < 2; i++) {
        know_changed(&ship, decks[i].example, decks[i].change, 1e-5);
        told_base_is_saved(&ship);
        forget(&ship);
    }
}

// ---- what is refused ----

static void fails(ld_status status, const ld_error *error, const char *sentence)
{
    assert_int_equal(status, LD_ERR_INPUT);
    assert_string_equal(error->text, sentence);
}

static void what_makes_no_frame_is_refused(void **state)
{
    (void)state;
    ld_error error;
    ld_run *run;
    ld_summary summary;
    known_motion still;
    know(&still, "fixed.yaml", 1e-5);
    ld_base_frame frame = frame_at(&still, 0), bad = frame;
    ld_model model = told_model(&still, LD_EXTRAPOLATION_ACCELERATION);
    ld_simulation *simulation = create(&model);
    fails(ld_simulation_run(simulation, NULL, &summary, &error), &error,
          "base.kind: external: this base is driven by a program that steps the run; the command "
          "cannot run it");
    bad.velocity[1] = NAN;
    fails(ld_run_begin(simulation, &(ld_run_options){.base = &bad}, &run, &error), &error,
          "the base received a position or a motion that is not finite");
    ld_run_end(run, NULL, NULL);

    run = begin(simulation, &frame);
    assert_int_equal(ld_run_advance(run, -0.1, &error), LD_OK);
    fails(ld_run_set_base(run, &bad, &error), &error,
          "the base received a position or a motion that is not finite");
    bad = frame;
    bad.quaternion[0] *= 1.1;
    assert_int_equal(ld_run_set_base(run, &bad, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "the base received a quaternion of length 1.09"));
    fails(ld_run_advance(run, -0.15, &error), &error,
          "the run is at t = -0.1 s and cannot continue to t = -0.15 s");
    // it continues all the same
    assert_int_equal(ld_run_set_base(run, &frame, &error), LD_OK);
    assert_int_equal(ld_run_advance(run, INFINITY, &error), LD_OK);
    fails(ld_run_set_base(run, &frame, &error), &error,
          "the launch is over: the base's motion can no longer be set");
    end(run);
    ld_simulation_free(simulation);

    simulation = create(&still.model);
    fails(ld_run_begin(simulation, &(ld_run_options){.base = &frame}, &run, &error), &error,
          "the base's motion can be set with base.kind: external only");
    ld_run_end(run, NULL, NULL);
    ld_simulation_free(simulation);
    forget(&still);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ship_told_every_millisecond),
        cmocka_unit_test(other_decks_told_every_millisecond),
        cmocka_unit_test(the_error_falls_with_the_step),
        cmocka_unit_test(a_base_told_to_stand_is_fixed),
        cmocka_unit_test(the_wrench_at_rest_is_the_weight),
        cmocka_unit_test(the_wrench_is_the_supports_on_decks),
        cmocka_unit_test(a_told_base_is_saved),
        cmocka_unit_test(what_makes_no_frame_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
