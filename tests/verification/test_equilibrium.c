// The start in static equilibrium (formulation.md, section 7, item 9): nothing accelerates,
// supports carry the weight, the tube sags as a beam does, and nothing moves while the lock is
// closed.
#include <stdlib.h>

#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "support/check.h"
#include "support/flight_text.h"
#include "support/fresh_launch.h"
#include "support/launching_run.h"
#include "support/launching_state.h"
#include "support/tube_shape.h"
#include "systems/launching/launching_dynamics.h"

static ld_equilibrium_summary find_equilibrium(launch_state *launch, double *y)
{
    ld_equilibrium_summary found;
    ld_error error;
    if (simulation_equilibrium(launch, 0, y, &found, &error))
        fail_msg("%s", error.text);
    return found;
}

// Largest acceleration [m/s2] of points of the tube's axis and of the rocket by the dense check,
// friction on.
static double dense_acceleration(const launch_state *launch, const double *y)
{
    const launching_system *system = &launch->launcher.launching;
    dense_launch dense;
    dense_launch_output out;
    launching_case c;
    memset(&c, 0, sizeof c);
    memcpy(c.state, y, (size_t)system->layout.count * sizeof(double));
    launcher_input input;
    simulation_input(launch, 0, y, &input);
    c.input = input.launching;
    c.input.base.v = c.input.base.w = v3_zero();
    c.phase = simulation_start_phase(launch);
    c.phase.locked = !launch->on_breech;
    copy_to_dense(system, &c);
    dense_launch_create(&dense, launch->model, &system->tube.flexible);
    assert_true(dense_launch_evaluate(&dense, &c.dense, &out));
    dense_launch_free(&dense);
    const flexible_tube *tube = &system->tube.flexible;
    double largest = 0;
    for (int k = 0; k <= 10; k++) {
        double x = 0.3 * k, y_ddot = out.a[1] + x * out.w_dot[2],
               z_ddot = out.a[2] - x * out.w_dot[1];
        for (int j = 0; j < tube->nb; j++) {
            y_ddot += tube_bending(tube, PLANE_Y, j, x, 0) * out.q_ddot[j];
            z_ddot += tube_bending(tube, PLANE_Z, j, x, 0) * out.q_ddot[tube->nb + j];
        }
        largest = fmax(largest, hypot(y_ddot, z_ddot));
    }
    for (int i = 0; i < 3; i++) { // rocket's rear and front, and what turning does at the bore
        double arm = i == 0 ? 0.0825 : 1.9;
        largest = fmax(largest, fmax(fabs(out.a_O1[i]), arm * fabs(out.alpha_B[i])));
    }
    return largest;
}

static void check_rest(const ld_model *model, const char *name, double bound)
{
    double y[LD_MAX_STATES];
    fresh_launch launch;
    fresh_launch_make(&launch, model);
    ld_equilibrium_summary found = find_equilibrium(&launch.state, y);
    printf("  %s\n", name);
    CHECK_BELOW("largest residual [m/s2, rad/s2, of modes 1/s2]", found.residual, 2 * bound);
    CHECK_BELOW("by the dense check [m/s2]", dense_acceleration(&launch.state, y), bound);
    fresh_launch_free(&launch);
}

// 1e-9 g = 9.8e-9 m/s2.
static void nothing_accelerates(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    const double bound = 9.8e-9;
    check_rest(&model, "reference launcher", bound);
    model.tubes.modes.span = LD_SPAN_CLAMPED;
    model.tubes.modes.bending = 12;
    check_rest(&model, "12 clamped modes", bound);
    model.tubes.modes.span = LD_SPAN_SUPPORTED;
    model.tubes.modes.bending = 6;
    model.base.kind = LD_BASE_PRESCRIBED;
    model.base.roll = (ld_sines){1, {{0.1, 0.5, 1}}};
    model.base.yaw = (ld_sines){1, {{0.2, 0.5, 0.3}}};
    model.rocket.eccentricity[0] = 0.5e-3;
    model.rocket.eccentricity[1] = -1e-3;
    check_rest(&model, "rolled base, eccentric rocket", bound);
    model.rocket.contact.exponent = 1.5;
    model.rocket.contact.law = LD_CONTACT_LANKARANI_NIKRAVESH;
    check_rest(&model, "lankarani-nikravesh, n = 1.5", bound);
    model.rocket.contact.law = LD_CONTACT_BILATERAL;
    check_rest(&model, "bilateral", bound);
    model.rocket.contact.law = LD_CONTACT_HUNT_CROSSLEY;
    model.tubes.slot.kind = LD_SLOT_NONE;
    check_rest(&model, "smooth bore", bound);
    reference_model_free(&model);
}

// Towards the vertical the adaptors carry less and less, upright nothing: there the rocket stands
// on the axis; a hair beside it leans on two walls, front and rear on opposite sides.
static void upright(void **state)
{
    (void)state;
    static const double elevation[] = {75, 85, 89, 89.9, 89.99, 89.999, 89.9999, 89.999999, 90};
    const double degree = acos(0) / 90, bound = 9.8e-9;
    double y[LD_MAX_STATES], worst = 0, off = 0;
    for (int k = 0; k < 36; k++) {
        ld_model model;
        reference_model(&model);
        model.base.elevation = elevation[k % 9] * degree;
        model.base.kind = k < 18 ? LD_BASE_FIXED : LD_BASE_PRESCRIBED;
        model.base.azimuth = k < 18 ? 0 : 0.4;
        model.rocket.lock.present = k / 9 % 2 == 0;
        fresh_launch launch;
        fresh_launch_make(&launch, &model);
        ld_equilibrium_summary found = find_equilibrium(&launch.state, y);
        const double *x = y + launch.state.launcher.launching.layout.x;
        double weight = 60 * model.gravity, carried = found.breech_force - found.lock_force;
        double across = weight * cos(model.base.elevation), rear = found.contact_force[0];
        if (k % 9 == 8) {
            for (int i = 1; i < 5; i++)
                off = fmax(off, fabs(x[i]));
            assert_true(rear == 0 && found.contact_force[2] == 0);
        } else {
            // one force, or a couple of the lean
            double rest = x[1] * (x[1] + 1.9 * x[3]) > 0 ? rear + found.contact_force[2]
                                                         : found.contact_force[2] - rear;
            CHECK_BELOW("carried across, less the weight's part [N]", fabs(rest) - across, 2e-2);
        }
        CHECK_BELOW("carried along, less the weight's part [N]",
                    carried - weight * sin(model.base.elevation), 4e-3);
        worst = fmax(worst, dense_acceleration(&launch.state, y));
        fresh_launch_free(&launch);
        reference_model_free(&model);
    }
    CHECK_BELOW("largest acceleration by the dense check [m/s2]", worst, bound);
    CHECK_BELOW("upright: off the axis [m, rad]", off, 1e-14);
}

// An eccentric rocket upright: the couple of its weight, on two adaptors at opposite walls.
static void upright_and_eccentric(void **state)
{
    (void)state;
    double y[LD_MAX_STATES];
    ld_model model;
    reference_model(&model);
    model.base.elevation = acos(0);
    model.rocket.eccentricity[0] = 0.3e-3;
    model.rocket.eccentricity[1] = -0.4e-3;
    fresh_launch launch;
    fresh_launch_make(&launch, &model);
    ld_equilibrium_summary found = find_equilibrium(&launch.state, y);
    const double *x = y + launch.state.launcher.launching.layout.x;
    // the lean of 0.7 mm on 1.9 m takes the mass centre further off
    double lean = 0.7e-3 / 1.9, force = 60 * model.gravity * (0.5e-3 + 1.1 * lean) / 1.9;
    CHECK_NEAR("front adaptor [N]", found.contact_force[2], force, 1e-4);
    CHECK_NEAR("rear adaptor [N]", found.contact_force[0], force, 1e-4);
    CHECK_NEAR("direction of the lean [rad]", atan2(-x[4], x[3]), atan2(-0.4, 0.3), 1e-6);
    CHECK_BELOW("by the dense check [m/s2]", dense_acceleration(&launch.state, y), 9.8e-9);
    fresh_launch_free(&launch);
    reference_model_free(&model);
}

// ---- beam theory: a free beam under its weight, the tail's, and reactions ----

enum { UNKNOWNS = 6 }; // w(0), w'(0), then force and moment of either support

// Deflection w(x), or its slope, by Macaulay's brackets, as a row over the unknowns and 1.
typedef struct beam_case {
    const ld_tubes *tubes;
    double g;
    int load_count;
    double at[4], load[4]; // [m], [N] upwards
} beam_case;

static void beam_row(const beam_case *c, double x, bool slope, double row[UNKNOWNS + 1])
{
    const ld_tubes *tubes = c->tubes;
    double EI = tubes->section[0].bending_stiffness, mu = tubes->section[0].mass_per_length;
    double tail = -tubes->tail.mass * c->g;
    row[0] = slope ? 0 : 1;
    row[1] = slope ? 1 : x;
    for (int k = 0; k < 2; k++) {
        double r = fmax(0, x - tubes->support[k].at);
        row[2 + 2 * k] = (slope ? r * r / 2 : r * r * r / 6) / EI;
        row[3 + 2 * k] = -(slope ? r : r * r / 2) / EI;
    }
    // weight, tail (its force and the moment of its arm), loads
    double fixed = -mu * c->g * (slope ? x * x * x / 6 : x * x * x * x / 24);
    fixed += tail * (slope ? x * x / 2 : x * x * x / 6);
    fixed -= tail * tubes->tail.center * (slope ? x : x * x / 2);
    for (int i = 0; i < c->load_count; i++) {
        double r = fmax(0, x - c->at[i]);
        fixed += c->load[i] * (slope ? r * r / 2 : r * r * r / 6);
    }
    row[6] = fixed / EI;
}

// Solves the square system with the right side in the last column.
static void solve(double A[UNKNOWNS][UNKNOWNS + 1], double *x)
{
    for (int k = 0; k < UNKNOWNS; k++) {
        int p = k;
        for (int i = k + 1; i < UNKNOWNS; i++)
            p = fabs(A[i][k]) > fabs(A[p][k]) ? i : p;
        for (int j = 0; j <= UNKNOWNS; j++) {
            double swap = A[k][j];
            A[k][j] = A[p][j];
            A[p][j] = swap;
        }
        for (int i = 0; i < UNKNOWNS; i++)
            for (int j = UNKNOWNS; i != k && j >= k; j--)
                A[i][j] -= A[i][k] / A[k][k] * A[k][j];
    }
    for (int i = 0; i < UNKNOWNS; i++)
        x[i] = A[i][UNKNOWNS] / A[i][i];
}

// Deflection of the tip [m] of the exact beam on its two elastic supports.
static double beam_tip(const beam_case *c)
{
    const ld_tubes *tubes = c->tubes;
    double A[UNKNOWNS][UNKNOWNS + 1] = {{0}}, x[UNKNOWNS], tip[UNKNOWNS + 1], L = tubes->length;
    double mu = tubes->section[0].mass_per_length;
    for (int k = 0; k < 2; k++) { // R = -K w, M = -K_r w'
        const ld_support *support = &tubes->support[k];
        beam_row(c, support->at, false, A[2 * k]);
        beam_row(c, support->at, true, A[2 * k + 1]);
        for (int j = 0; j <= UNKNOWNS; j++) {
            A[2 * k][j] *= support->stiffness[1];
            A[2 * k + 1][j] *= support->rotational_stiffness[2];
        }
        A[2 * k][2 + 2 * k] += 1;
        A[2 * k + 1][3 + 2 * k] += 1;
        // balance of forces, and of moments about x = 0
        A[4][2 + 2 * k] = 1;
        A[5][2 + 2 * k] = support->at;
        A[5][3 + 2 * k] = 1;
    }
    A[4][6] = -(mu * L + tubes->tail.mass) * c->g;
    A[5][6] = -(mu * L * L / 2 + tubes->tail.mass * tubes->tail.center) * c->g;
    for (int i = 0; i < c->load_count; i++) {
        A[4][6] += c->load[i];
        A[5][6] += c->load[i] * c->at[i];
    }
    for (int i = 0; i < UNKNOWNS; i++)
        A[i][6] = -A[i][6];
    solve(A, x);
    beam_row(c, L, false, tip);
    double w = tip[6];
    for (int i = 0; i < UNKNOWNS; i++)
        w += tip[i] * x[i];
    return w;
}

// The rocket's weight on its rear and front adaptor (statics of a rigid rocket).
static void check_sag(ld_model *model, double mass, double bound)
{
    double y[LD_MAX_STATES], weight = mass * model->gravity, front = weight * 1.1 / 1.9;
    beam_case beam = {.tubes = &model->tubes,
                      .g = model->gravity,
                      .load_count = 2,
                      .at = {0.1, 2.0},
                      .load = {front - weight, -front}};
    model->rocket.full.mass = mass;
    fresh_launch launch;
    fresh_launch_make(&launch, model);
    ld_equilibrium_summary found = find_equilibrium(&launch.state, y);
    fresh_launch_free(&launch);
    CHECK_BELOW("front adaptor, of the weight", (found.contact_force[2] - front) / weight, 2e-8);
    CHECK_BELOW("rear adaptor, of the weight", (found.contact_force[0] - (weight - front)) / weight,
                2e-8);
    double exact = beam_tip(&beam);
    printf("    tip %.6g m\n", exact);
    CHECK_BELOW("tip, relative", found.tip_sag[0] / exact - 1, bound);
}

static void sag_of_the_beam(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.base.elevation = 0;
    static const int modes[] = {6, 12, 24};
    static const double bound[] = {3e-3, 2e-4, 2.5e-5}, light_bound[] = {3e-5, 7e-7, 1e-7};
    for (int i = 0; i < 3; i++) {
        model.tubes.modes.bending = modes[i];
        printf("  %d modes, rocket of 60 kg\n", modes[i]);
        model.rocket.contact.stiffness = 5e7;
        check_sag(&model, 60, bound[i]);
        printf("  %d modes, rocket of 0.1 kg\n", modes[i]);
        model.rocket.contact.stiffness = 5e5;
        check_sag(&model, 0.1, light_bound[i]);
    }
    reference_model_free(&model);
}

// Reactions: the base carries the weight of everything, at the right place.
static void reactions(void **state)
{
    (void)state;
    ld_model model;
    double y[LD_MAX_STATES];
    reference_model(&model);
    model.base.elevation = 0;
    fresh_launch launch;
    fresh_launch_make(&launch, &model);
    const launching_system *system = &launch.state.launcher.launching;
    find_equilibrium(&launch.state, y);
    launching_phase phase = simulation_start_phase(&launch.state);
    launcher_input input;
    launching_output out;
    simulation_input(&launch.state, 0, y, &input);
    assert_int_equal(launching_evaluate(system, &input.launching, &phase, y, &out), LAUNCHING_OK);
    double tube = system->tube.flexible.m, mass = tube + 8 + 60, g = model.gravity;
    double arm = tube * 1.5 + 8 * -0.1 + 60 * 1.2;
    CHECK_BELOW("along the tube [N]", out.base_force.x, 5e-9);
    CHECK_NEAR("across it [N]", out.base_force.y, -mass * g, 1e-8);
    CHECK_NEAR("moment about z [N m]", out.base_moment.z, -arm * g, 4e-5);
    fresh_launch_free(&launch);
    reference_model_free(&model);
}

// The lock's force F off the axis by R is a couple F R that the two adaptors carry.
static void couple_of_the_lock(void **state)
{
    (void)state;
    static const double R[] = {0, 0.0825, -0.0825};
    for (int k = 0; k < 3; k++) {
        ld_model model;
        double y[LD_MAX_STATES];
        reference_model(&model);
        ld_rocket *rocket = &model.rocket;
        model.base.elevation = acos(0) / 2;
        model.tubes.slot.kind = LD_SLOT_NONE;
        rocket->adaptor_count = 2;
        rocket->adaptor[1] = rocket->adaptor[2];
        rocket->lock.x = 0.3;
        rocket->lock.radius = fabs(R[k]);
        rocket->lock.angle = R[k] < 0 ? 2 * acos(0) : 0;
        fresh_launch launch;
        fresh_launch_make(&launch, &model);
        ld_equilibrium_summary found = find_equilibrium(&launch.state, y);
        double along = 60 * model.gravity * sin(model.base.elevation), across = along;
        double front = (across * 1.1 + along * R[k]) / 1.9;
        printf("  %g mm above the axis\n", 1e3 * R[k]);
        CHECK_NEAR("front adaptor [N]", found.contact_force[1], front, 0.02);
        CHECK_NEAR("rear adaptor [N]", found.contact_force[0], across - front, 0.1);
        CHECK_BELOW("by the dense check [m/s2]", dense_acceleration(&launch.state, y), 9.8e-9);
        fresh_launch_free(&launch);
        reference_model_free(&model);
    }
}

// Left alone at rest, lock closed, for 0.2 s.
static void nothing_moves_while_locked(void **state)
{
    (void)state;
    ld_model model;
    launching_run run;
    double y[LD_MAX_STATES];
    reference_model(&model);
    fresh_launch launch;
    fresh_launch_make(&launch, &model);
    const launching_system *system = &launch.state.launcher.launching;
    const launching_layout *at = &system->layout;
    find_equilibrium(&launch.state, y);
    launching_run_begin(&run, system, 0.1);
    run.phase = simulation_start_phase(&launch.state);
    launcher_input input;
    simulation_input(&launch.state, 0, y, &input);
    run.input = input.launching;
    memcpy(run.state, y, (size_t)at->count * sizeof(double));
    launching_run_follow(&run, 1e-8, 0.2);
    double moved = 0, speed = 0;
    for (int i = 0; i < at->count; i++) {
        bool is_speed = (i >= at->v && i < at->q) || (i >= at->q_dot && i < at->x) || i >= at->V;
        if (is_speed)
            speed = fmax(speed, fabs(run.state[i]));
        else
            moved = fmax(moved, fabs(run.state[i] - y[i]));
    }
    printf("  %d steps\n", (int)run.steps);
    CHECK_BELOW("places and angles moved by [m, rad]", moved, 5e-11);
    CHECK_BELOW("speeds at the end [m/s, rad/s]", speed, 6e-7);
    fresh_launch_free(&launch);
    reference_model_free(&model);
}

// Tens of kilometres from the origin, where places are rounded to 7e-12 m, as a ship is after
// hours.
static void far_from_the_origin(void **state)
{
    (void)state;
    ld_model model;
    ld_equilibrium_summary found[2];
    double y[LD_MAX_STATES];
    reference_model(&model);
    model.base.kind = LD_BASE_PRESCRIBED;
    for (int i = 0; i < 2; i++) {
        fresh_launch launch;
        model.base.at[0] = i ? -5e4 : 0;
        model.base.at[2] = i ? 2e4 : 0;
        fresh_launch_make(&launch, &model);
        found[i] = find_equilibrium(&launch.state, y);
        fresh_launch_free(&launch);
    }
    CHECK_BELOW("residual there [m/s2]", found[1].residual, 1e-4);
    for (int i = 0; i < 3; i += 2)
        CHECK_BELOW("what an adaptor carries there, relative",
                    found[1].contact_force[i] / found[0].contact_force[i] - 1, 1e-8);
    CHECK_BELOW("sag of the tip there, relative", found[1].tip_sag[0] / found[0].tip_sag[0] - 1,
                1e-8);
    reference_model_free(&model);
}

// Four adaptors of unequal clearance, 1.7 deg from upright: the two in the middle of the row of
// clearances carry, one of them less than a newton. Forces of a rigid rocket in a rigid bore by
// Nelder and Mead's method, from 40 starts.
static void carried_by_little(void **state)
{
    (void)state;
    ld_model model = read_text(
        "{launchdyn: 1, base: {kind: fixed, elevation: 88.313749 deg}, tubes: {length: 4.3418 m,"
        " sections: [{from: 0 m, bore_radius: 80 mm, mass_per_length: 24.7128 kg/m,"
        "  axial_stiffness: 6.3672e8 N, bending_stiffness: 1.5918e6 N.m2,"
        "  torsion_stiffness: 1.5918e6 N.m2, polar_inertia: 0.3044 kg.m}],"
        " modes: {bending: 4, torsion: 2}, slot: none, supports: ["
        "  {at: 0.2605 m, stiffness: 5.243e6 5.243e6 5.243e6 N/m,"
        "   rotational_stiffness: 4.762e4 4.762e4 4.762e4 N.m/rad},"
        "  {at: 2.0803 m, stiffness: 7.194e6 7.194e6 7.194e6 N/m,"
        "   rotational_stiffness: 7.509e4 7.509e4 7.509e4 N.m/rad}]},"
        "rocket: {start_at: 0.2171 m, mass: 19.3264 kg, center: 0.3913 0 0 m,"
        " inertia: 0.0369 8.13 8.13 kg.m2, eccentricity: 0.5207 -0.6456 mm, adaptors: ["
        "  {name: a, at: 0 m, clearance: 0.4876 mm}, {name: b, at: 0.2540 m, clearance: 0.4478 mm},"
        "  {name: c, at: 0.3643 m, clearance: 0.2116 mm},"
        "  {name: d, at: 0.8897 m, clearance: 1.4527 mm}],"
        " contact: {stiffness: 4.6074e7 N/m}, lock: none,"
        " motor: {thrust: [[0 s, 6 kN], [4 s, 0 N]]}}, firing: [{tube: 1, at: 0 s}],"
        "run: {end: tip}}");
    static const double expected[] = {0.706, 0, 6.027, 0};
    for (int locks = 0; locks < 2; locks++) {
        fresh_launch launch;
        double y[LD_MAX_STATES];
        model.rocket.lock.present = locks;
        fresh_launch_make(&launch, &model);
        ld_equilibrium_summary found = find_equilibrium(&launch.state, y);
        for (int i = 0; i < 4; i++)
            CHECK_NEAR("an adaptor [N]", found.contact_force[i], expected[i], 0.01);
        CHECK_NEAR("lock or breech [N]", found.breech_force - found.lock_force,
                   19.3264 * model.gravity * sin(model.base.elevation), 0.001);
        fresh_launch_free(&launch);
    }
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_accelerates),
        cmocka_unit_test(carried_by_little),
        cmocka_unit_test(upright),
        cmocka_unit_test(upright_and_eccentric),
        cmocka_unit_test(sag_of_the_beam),
        cmocka_unit_test(reactions),
        cmocka_unit_test(couple_of_the_lock),
        cmocka_unit_test(nothing_moves_while_locked),
        cmocka_unit_test(far_from_the_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
