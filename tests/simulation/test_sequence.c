// From tube to tube and from the tube to the ground: nothing jumps at a hand-off, momentum is kept
// when one tube takes the place of another, and what does not touch the launch leaves it alone.
// ctest: slow
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"
#include "scenario/scenario.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "support/check.h"
#include "support/fresh_launch.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/bases/mechanism_base.h"
#include "systems/launching/launching_kinematics.h"

static ld_model read_example(const char *file, const char *const *sets, size_t count)
{
    ld_model model;
    ld_messages messages = {0};
    char path[512];
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, file);
    if (scenario_read(path, sets, count, &model, &messages))
        fail_msg("%s cannot be read", file);
    return model;
}

static ld_simulation *simulation_of(const ld_model *model)
{
    ld_simulation *simulation;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    return simulation;
}

static ld_summary run(const ld_model *model, const ld_run_options *options)
{
    ld_simulation *simulation = simulation_of(model);
    ld_summary summary = {0};
    ld_error error;
    if (ld_simulation_run(simulation, options, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary;
}

// ---- hand-off to flight ----

// First row of a flight, and the launcher's columns.
typedef struct first_row {
    size_t count;
    bool waiting, seen;
    ld_column column[128];
    double value[128];
} first_row;

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)self, (void)columns, (void)count, (void)error;
    return LD_OK;
}

static ld_status begin_flight(void *self, int rocket, const ld_column *columns, size_t count,
                              ld_error *error)
{
    first_row *first = self;
    (void)error;
    assert_int_equal(rocket, 1);
    memcpy(first->column, columns, count * sizeof *columns);
    first->count = count;
    first->waiting = true;
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    first_row *first = self;
    (void)error;
    if (first->waiting) {
        memcpy(first->value, values, count * sizeof *values);
        first->seen = true;
    }
    first->waiting = false;
    return LD_OK;
}

static double value_of(const first_row *first, const char *name)
{
    for (size_t i = 0; i < first->count; i++)
        if (strcmp(first->column[i].name, name) == 0)
            return first->value[i];
    fail_msg("no column %s", name);
    return NAN;
}

static void nothing_jumps(void **state)
{
    (void)state;
    const char *const sets[] = {"run.lead_in=0.1 s"};
    ld_model model = read_example("reference.yaml", sets, 1);
    first_row first = {0};
    ld_sink sink = {.self = &first, .begin = begin, .row = row, .flight = begin_flight};
    ld_run_options options = {.sink = &sink};
    ld_summary summary = run(&model, &options);
    const ld_rocket_summary *rocket = &summary.rocket[0];
    assert_true(first.seen);
    static const char *const names[13] = {
        "rocket.x",  "rocket.y",  "rocket.z",  "rocket.vx", "rocket.vy", "rocket.vz", "rocket.q0",
        "rocket.q1", "rocket.q2", "rocket.q3", "rocket.wx", "rocket.wy", "rocket.wz"};
    double exit[13], largest = 0;
    memcpy(exit, rocket->exit.position, 3 * sizeof(double));
    memcpy(exit + 3, rocket->exit.velocity, 3 * sizeof(double));
    memcpy(exit + 6, rocket->exit.quaternion, 4 * sizeof(double));
    memcpy(exit + 10, rocket->exit.rate, 3 * sizeof(double));
    double sign = value_of(&first, "rocket.q0") * exit[6] < 0 ? -1 : 1;
    for (int i = 0; i < 13; i++) {
        double turn = i >= 6 && i < 10 ? sign : 1;
        largest = fmax(largest, fabs(turn * value_of(&first, names[i]) - exit[i]));
    }
    CHECK_BELOW("state at the hand-off [m, m/s, rad/s]", largest, 1e-13);
    CHECK_NEAR("time of the hand-off [s]", value_of(&first, "t"), rocket->t_rear, 1e-15);
    model_clear(&model);
}

// The same flight begun alone from the state at exit.
static void same_as_a_flight_alone(void **state)
{
    (void)state;
    const char *const sets[] = {"run.lead_in=0.1 s", "run.flight_tolerance=1e-11"};
    ld_model model = read_example("reference.yaml", sets, 2);
    ld_summary launch = run(&model, NULL);
    const ld_rocket_summary *rocket = &launch.rocket[0];
    model.base.kind = LD_BASE_NONE;
    ld_flight *flight = &model.flight;
    flight->ignition = -rocket->t_rear;
    flight->point = LD_POINT_REAR;
    memcpy(flight->position, rocket->exit.position, sizeof flight->position);
    memcpy(flight->velocity, rocket->exit.velocity, sizeof flight->velocity);
    memcpy(flight->quaternion, rocket->exit.quaternion, sizeof flight->quaternion);
    memcpy(flight->rate, rocket->exit.rate, sizeof flight->rate);
    ld_summary alone = run(&model, NULL);
    double distance = 0;
    for (int i = 0; i < 3; i++)
        distance =
            fmax(distance, fabs(rocket->final.position[i] - alone.rocket[0].final.position[i]));
    CHECK_BELOW("impact of the launch and of the flight alone [m]", distance, 1e-6);
    CHECK_NEAR("time of flight [s]", rocket->flight.time_of_flight,
               alone.rocket[0].flight.time_of_flight, 1e-9);
    model_clear(&model);
}

// Fired downwards the rocket reaches the ground while its motor burns; the run says so.
static void into_the_ground(void **state)
{
    (void)state;
    const char *const sets[] = {"run.lead_in=0 s", "platform.elevation.stabiliser.command=-10 deg"};
    ld_model model = read_example("reference.yaml", sets, 2);
    ld_summary summary = run(&model, NULL);
    assert_int_equal(summary.note_count, 1);
    printf("    %s\n", summary.note[0]);
    assert_non_null(strstr(summary.note[0], "hit the ground"));
    CHECK_BELOW("mass centre's height at the end [m]", summary.rocket[0].final.center[1], 1e-9);
    model_clear(&model);
}

// ---- one tube in place of another ----

// Momentum and angular momentum about I's origin of vehicle (without wheels), tube and, if it is in
// the tube, rocket: the vehicle's as of its bodies, the tube's by slices of its axis, each with its
// polar inertia.
static void momentum(const launch_state *self, const double *y, bool with_rocket, double p[6])
{
    const launcher_system *launcher = &self->launcher;
    const launching_system *tube = &launcher->launching;
    const launching_layout *at = &tube->layout;
    const ld_tail *tail = &self->model->tubes.tail;
    const double *base = y + launcher->base_at;
    ld_mstmm *chain = mechanism_of(&launcher->base)->chain;
    ld_mstmm_momentum(chain, base, base + VEHICLE_V, p, p + 3);
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 r_R = v3_from(y + at->r), P = v3_from(p), H = v3_from(p + 3);
    const ld_section *section = &self->model->tubes.section[0];
    enum { SLICES = 600 };
    double length = self->model->tubes.length, dx = length / SLICES;
    static const double place[2] = {0.21132486540518712, 0.78867513459481288}; // Gauss, 2 points
    for (int i = 0; i < 2 * SLICES; i++) {
        launching_section s;
        launching_section_at(tube, y, (i / 2 + place[i % 2]) * dx, &s);
        double m = 0.5 * dx * section->mass_per_length;
        v3 r = v3_add(r_R, m3_apply(A_IR, s.P)), v = m3_apply(A_IR, s.v);
        // rotary inertia about R's x axis alone, by the rate of the twist
        double spin = 0.5 * dx * section->polar_inertia * s.w.x;
        P = v3_axpy(P, m, v);
        H = v3_axpy(H, m, v3_cross(r, v));
        H = v3_axpy(H, spin, m3_column(A_IR, 0));
    }
    v3 w = v3_from(y + at->w), c = v3_make(tail->center, 0, 0);
    v3 v_tail = m3_apply(A_IR, v3_add(v3_from(y + at->v), v3_cross(w, c)));
    v3 r_tail = v3_add(r_R, m3_apply(A_IR, c));
    P = v3_axpy(P, tail->mass, v_tail);
    H = v3_axpy(H, tail->mass, v3_cross(r_tail, v_tail));
    H = v3_add(H, m3_apply(A_IR, v3_mul(v3_from(tail->inertia), w)));
    if (with_rocket) {
        const rocket_mass *mass = &self->motor->full;
        launching_output unused;
        launching_pose pose;
        launching_rocket_pose(tube, y, &pose, &unused);
        v3 arm = m3_apply(pose.A_RB, mass->c);
        v3 r = v3_add(r_R, m3_apply(A_IR, v3_add(pose.p1, arm)));
        v3 v = m3_apply(A_IR, v3_add(pose.v_O1, v3_cross(pose.w_B, arm)));
        v3 w_B = m3_apply_transposed(pose.A_RB, pose.w_B);
        v3 spin = m3_apply(A_IR, m3_apply(pose.A_RB, m3_apply(mass->J, w_B)));
        P = v3_axpy(P, mass->m, v);
        H = v3_add(v3_axpy(H, mass->m, v3_cross(r, v)), spin);
    }
    v3_store(p, P);
    v3_store(p + 3, H);
}

// In a state in which all moves, the old tube too, against the platform.
static void momentum_is_kept(void **state)
{
    (void)state;
    ld_model model = read_example("sequence.yaml", NULL, 0);
    fresh_launch launch;
    fresh_launch_make(&launch, &model);
    const launcher_system *launcher = &launch.state.launcher;
    const launching_layout *at = &launcher->launching.layout;
    ld_equilibrium_summary unused;
    ld_error error;
    double y[LD_MAX_STATES], before[6], after[6];
    if (simulation_equilibrium(&launch.state, 0, y, &unused, &error))
        fail_msg("%s", error.text);
    simulation_move_with_base(&launch.state, 0, y);
    static const double speed[VEHICLE_SPEEDS] = {4, 0.3, -0.2, 0.05, 0.1, -0.08, 0.3, 0.2};
    memcpy(y + launcher->base_at + VEHICLE_V, speed, sizeof speed);
    for (int i = 0; i < 3; i++) {
        y[at->v + i] += 0.2 * (i + 1);
        y[at->w + i] += 0.1 * (i - 1);
    }
    for (int i = 0; i < at->nq; i++) {
        y[at->q + i] += 1e-3 * (i + 1) / (at->nq + i);
        y[at->q_dot + i] += 0.5 / (i + 1);
    }
    momentum(&launch.state, y, false, before);
    launching_phase without = {.rocket = false};
    launcher_input input;
    simulation_input(&launch.state, 0, y, &input);
    double energy = launcher_kinetic_energy(launcher, &input, &without, y);
    if (simulation_change_tube(&launch.state, 1, 0, y, &error))
        fail_msg("%s", error.text);
    momentum(&launch.state, y, true, after);
    launching_phase with = simulation_start_phase(&launch.state);
    simulation_input(&launch.state, 0, y, &input);
    energy -= launcher_kinetic_energy(launcher, &input, &with, y);
    double scale_P = v3_norm(v3_from(before)), scale_H = v3_norm(v3_from(before + 3));
    v3 dP = v3_sub(v3_from(after), v3_from(before));
    v3 dH = v3_sub(v3_from(after + 3), v3_from(before + 3));
    CHECK_BELOW("momentum, of itself", v3_norm(dP) / scale_P, 1e-11);
    // the slices' twist is their section's rate, the tube's kinetic energy has its first order
    CHECK_BELOW("angular momentum about the origin, of itself", v3_norm(dH) / scale_H, 2e-10);
    CHECK_WITHIN("kinetic energy dropped [J]", energy, 0, 1e3);
    fresh_launch_free(&launch);
    model_clear(&model);
}

// Ten seconds after the first on a launcher at rest the second rocket does not feel it.
static void second_equals_a_single_launch(void **state)
{
    (void)state;
    const char *const sets[] = {
        "base.speed=0 km/h", "base.road=",         "base.road.flat=true",        "run.end=tip",
        "run.lead_in=0 s",   "run.tolerance=1e-7", "run.lead_in_method=explicit"};
    ld_model model = read_example("reference.yaml", sets, sizeof sets / sizeof sets[0]);
    model.firing_count = 2;
    model.firing[0] = (ld_firing){.tube = 8, .at = 0};
    model.firing[1] = (ld_firing){.tube = 11, .at = 10};
    ld_summary both = run(&model, NULL);
    model.firing_count = 1;
    model.firing[0] = (ld_firing){.tube = 11, .at = 0};
    model.tubes.empty_count = 1;
    model.tubes.empty[0] = 8;
    ld_summary single = run(&model, NULL);
    const ld_rocket_summary *p = &both.rocket[1], *q = &single.rocket[0];
    CHECK_NEAR("t_rear [s]", p->t_rear, q->t_rear, 1e-6);
    CHECK_NEAR("exit speed [m/s]", p->exit_speed, q->exit_speed, 1e-6);
    CHECK_NEAR("pitch [rad]", p->pitch, q->pitch, 1e-6);
    CHECK_NEAR("yaw [rad]", p->yaw, q->yaw, 1e-6);
    CHECK_NEAR("pitch rate [rad/s]", p->pitch_rate, q->pitch_rate, 1e-6);
    CHECK_NEAR("yaw rate [rad/s]", p->yaw_rate, q->yaw_rate, 1e-6);
    CHECK_NEAR("spin [rad/s]", p->spin_rate, q->spin_rate, 1e-6);
    // the first rocket leaves with its energy, the second tube comes with its own
    CHECK_BELOW("energy balance of both [J]", both.energy.residual, 1e-6);
    model_clear(&model);
}

// The same of two tubes that are clamped to a base at rest, and of two rails.
static void second_clamped_or_on_a_rail(void **state)
{
    (void)state;
    static const char *const file[] = {"fixed.yaml", "rail/pad.yaml"};
#define PAIR                                                                                       \
    "tubes.layout={rows: 1, columns: 2, pitch: 0.4 m, first: 0 0 0 m}",                            \
        "firing=[{tube: 1, at: 0 s}, {tube: 2, at: 1 s}]"
    static const char *const sets[][5] = {
        {"tubes.supports=[{at: 0.4 m, clamped: all}, {at: 1.8 m, clamped: [y, z]}]",
         "rocket.contact={law: bilateral, exponent: 1, friction: 0, damping: 1e3 N.s/m}",
         "run={end: tip, tolerance: 1e-7, lead_in: 0 s}", PAIR},
        {"run.max_step=0.2 ms", "rocket.contact.friction=0.1",
         "run={end: tip, tolerance: 1e-7, lead_in: 0 s}", PAIR},
    };
    for (int i = 0; i < 2; i++) {
        ld_model model = read_example(file[i], sets[i], 5);
        ld_summary both = run(&model, NULL);
        model.firing_count = 1;
        model.firing[0] = (ld_firing){.tube = 2, .at = 0};
        model.tubes.empty_count = 1;
        model.tubes.empty[0] = 1;
        ld_summary single = run(&model, NULL);
        const ld_rocket_summary *p = &both.rocket[1], *q = &single.rocket[0];
        CHECK_NEAR("t_rear [s]", p->t_rear, q->t_rear, 1e-6);
        CHECK_NEAR("exit speed [m/s]", p->exit_speed, q->exit_speed, 1e-6);
        CHECK_NEAR("pitch rate [rad/s]", p->pitch_rate, q->pitch_rate, 1e-5);
        CHECK_NEAR("yaw rate [rad/s]", p->yaw_rate, q->yaw_rate, 1e-5);
        CHECK_BELOW("energy balance of both, of the largest work", both.energy.residual_relative,
                    1e-7);
        model_clear(&model);
    }
}

// What the balance has missed so far stays missed when the next tube takes its position.
static void the_balance_goes_on(void **state)
{
    (void)state;
    const char *const sets[] = {"base.speed=0 km/h", "base.road=",      "base.road.flat=true",
                                "run.end=tip",       "run.lead_in=0 s", "run.tolerance=1e-3"};
    ld_model model = read_example("reference.yaml", sets, sizeof sets / sizeof sets[0]);
    recorded_run launches;
    model.firing_count = 2;
    model.firing[0] = (ld_firing){.tube = 8, .at = 0};
    model.firing[1] = (ld_firing){.tube = 11, .at = 0.5};
    recorded_run_make(&launches, &model);
    size_t phase = recorded_column(&launches, "phase"), i = 1;
    size_t residual = recorded_column(&launches, "energy.residual");
    while (recorded_value(&launches, i - 1, phase) != 3 || recorded_value(&launches, i, phase) != 0)
        i++;
    double before = recorded_value(&launches, i - 1, residual);
    double after = recorded_value(&launches, i, residual);
    CHECK_WITHIN("missed up to the change of tubes [J], magnitude", fabs(before), 1e-6, 1);
    CHECK_BELOW("more after it, relative", after / before - 1, 1e-12);
    recorded_run_free(&launches);
    model_clear(&model);
}

static void overlapping_launches_are_refused(void **state)
{
    (void)state;
    ld_model model = read_example("sequence.yaml", NULL, 0);
    model.run.lead_in = 0;
    model.firing[1].at = 0.1;
    ld_simulation *simulation = simulation_of(&model);
    ld_summary summary = {0};
    ld_error error;
    assert_int_equal(ld_simulation_run(simulation, NULL, &summary, &error), LD_ERR_LAUNCH);
    printf("    %s\n", error.text);
    assert_non_null(strstr(error.text, "firing 2"));
    ld_simulation_free(simulation);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_jumps),
        cmocka_unit_test(same_as_a_flight_alone),
        cmocka_unit_test(into_the_ground),
        cmocka_unit_test(momentum_is_kept),
        cmocka_unit_test(second_equals_a_single_launch),
        cmocka_unit_test(second_clamped_or_on_a_rail),
        cmocka_unit_test(the_balance_goes_on),
        cmocka_unit_test(overlapping_launches_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
