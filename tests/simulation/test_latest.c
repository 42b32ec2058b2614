// What the equations gave last is handed out again for the same state under the same conditions
// alone: whatever changes, simulation_output gives what a new evaluation gives, to the bit.
#include "model/model.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "state/stepping/propagator.h"
#include "support/fresh_launch.h"
#include "support/reference_model.h"

typedef struct bench {
    ld_model model;
    fresh_launch launch;
    double y[LD_MAX_STATES];
} bench;

static const double time = 0.3;

static void set_up(bench *b)
{
    ld_error error;
    ld_equilibrium_summary unused;
    fresh_launch_make(&b->launch, &b->model);
    b->launch.state.piece = 1;
    if (simulation_equilibrium(&b->launch.state, 0, b->y, &unused, &error))
        fail_msg("%s", error.text);
}

static void tear_down(bench *b)
{
    fresh_launch_free(&b->launch);
    reference_model_free(&b->model);
}

// Asks before and after a change; false where the second answer is not that of a new evaluation.
#define SEEN_AFTER(b, change)                                                                      \
    (assert_non_null(simulation_output(&(b)->launch.state, time, (b)->y)), (change), is_right(b))

static bool is_right(bench *b)
{
    launch_state *self = &b->launch.state;
    const launcher_system *launcher = &self->launcher;
    double given[LD_MAX_STATES], expected[LD_MAX_STATES];
    launcher_input input;
    launcher_output fresh;
    size_t size = (size_t)launcher->state_count * sizeof(double);
    const launcher_output *out = simulation_output(self, time, b->y);
    assert_non_null(out);
    launcher_rates(launcher, b->y, out, self->phase.rocket, given);
    simulation_input(self, time, b->y, &input);
    assert_int_equal(launcher_evaluate(launcher, &input, &self->phase, b->y, &fresh), LAUNCHING_OK);
    launcher_rates(launcher, b->y, &fresh, self->phase.rocket, expected);
    return memcmp(given, expected, size) == 0;
}

// Nothing has been asked: time and travel 0 are not answer.
static void the_first_answer_is_computed(void **state)
{
    (void)state;
    bench b;
    reference_model(&b.model);
    set_up(&b);
    b.y[b.launch.state.launcher.launching.layout.x] = 0;
    const launcher_output *out = simulation_output(&b.launch.state, 0, b.y);
    CHECK_WITHIN("m/s2 of the tube in the first answer", v3_norm(out->launching.a), 1e-9, 1e9);
    tear_down(&b);
}

static void other_states_are_seen(void **state)
{
    (void)state;
    bench b;
    reference_model(&b.model);
    set_up(&b);
    int stale = 0, works = b.launch.state.launcher.work_at;
    for (int i = 0; i < works; i++)
        stale += !SEEN_AFTER(&b, b.y[i] += 1e-7);
    CHECK_WITHIN("states whose change is not seen, fixed base", stale, 0, 0);
    tear_down(&b);
    reference_vehicle(&b.model, 8);
    set_up(&b);
    stale = 0;
    works = b.launch.state.launcher.work_at;
    for (int i = 0; i < works; i++)
        stale += !SEEN_AFTER(&b, b.y[i] += 1e-7);
    CHECK_WITHIN("states whose change is not seen, vehicle", stale, 0, 0);
    tear_down(&b);
}

static void other_conditions_are_seen(void **state)
{
    static const base_disturbance none;
    (void)state;
    bench b;
    reference_vehicle(&b.model, 8);
    b.model.platform.elevation.lock = (ld_hinge_lock){.present = true, .stiffness = 1e8};
    b.model.base.vehicle.road.form = LD_ROAD_SUM;
    b.model.base.vehicle.road.sine_count = 1;
    b.model.base.vehicle.road.sine[0] = (ld_road_sine){0.01, 5, 1};
    b.model.rocket.contact.law = LD_CONTACT_LANKARANI_NIKRAVESH;
    b.model.rocket.contact.exponent = 1.5;
    b.model.firing_count = 2;
    b.model.firing[1] = (ld_firing){.tube = 7, .at = 2};
    set_up(&b);
    launch_state *self = &b.launch.state;
    for (int i = 0; i < 6; i++)
        b.y[self->launcher.launching.layout.V + i] += 0.1;
    assert_true(SEEN_AFTER(&b, self->phase.frictionless = true));
    assert_true(SEEN_AFTER(&b, self->phase.touch_speed[0] *= 2));
    assert_true(SEEN_AFTER(&b, self->phase.passed[0] = true));
    assert_true(SEEN_AFTER(&b, self->phase.locked = false));
    assert_true(SEEN_AFTER(&b, self->rest.hold[HINGE_ELEVATION].angle += 1e-4));
    assert_true(SEEN_AFTER(&b, self->rest.hold[HINGE_ELEVATION].torque += 10));
    assert_true(SEEN_AFTER(&b, self->launcher.base.disturbed = &none));
    assert_true(SEEN_AFTER(&b, self->piece = -1));
    assert_true(SEEN_AFTER(&b, self->piece = 0));
    assert_true(SEEN_AFTER(&b, self->t_ignition += 0.295));
    assert_true(SEEN_AFTER(&b, launcher_select(&self->launcher, 1)));
    assert_true(SEEN_AFTER(&b, self->phase.rocket = false));
    tear_down(&b);
}

// Rockets that differ stand in the same tube at the same place.
static void another_rocket_is_seen(void **state)
{
    (void)state;
    bench b;
    reference_model(&b.model);
    b.model.firing_count = 2;
    b.model.firing[1] = (ld_firing){.tube = 8, .at = 2};
    ld_rocket rocket[2] = {b.model.rocket, b.model.rocket};
    rocket[1].adaptor[0].clearance *= 2;
    rocket[1].full.mass += 1;
    b.model.salvo = rocket;
    set_up(&b);
    launch_state *self = &b.launch.state;
    double t_ignition = self->t_ignition;
    // at the same piece of the same thrust curve
    assert_true(SEEN_AFTER(
        &b, (launch_state_select(self, 1), self->piece = 1, self->t_ignition = t_ignition)));
    b.model.salvo = NULL;
    tear_down(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_answer_is_computed),
        cmocka_unit_test(other_states_are_seen),
        cmocka_unit_test(other_conditions_are_seen),
        cmocka_unit_test(another_rocket_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
