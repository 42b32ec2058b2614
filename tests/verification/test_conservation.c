// Tube, tail and rocket free in space: what must stay constant (formulation.md, section 7, items 2,
// 3 and 13). Momenta and energy are those of the dense check, which shares no kinematics with the
// program.
// ctest: slow
#include <stdlib.h>

#include "model/model.h"
#include "support/check.h"
#include "support/draw.h"
#include "support/launching_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_kinematics.h"
#include "systems/launching/launching_overall.h"

// No supports, gravity, friction or damping. Either nothing touches (and the bore is wide: the
// rocket flies on straight where the tube bends away), or the adaptors are held on the axis, by
// springs or exactly.
static void free_model(ld_model *model, ld_contact_law law)
{
    reference_model(model);
    model->gravity = 0;
    model->tubes.support_count = 0;
    model->tubes.modes.damping = 0;
    model->tubes.slot.friction = 0;
    bool held = contact_has(law, LD_CONTACT_TWO_SIDED);
    model->tubes.slot.radius = held ? 0.0825 : 0.3;
    model->rocket.knob_angle = 0.6;
    ld_contact *contact = &model->rocket.contact;
    contact->law = law;
    contact->stiffness = 2e5;
    contact->damping = 0;
    contact->friction = 0;
    for (int i = 0; i < model->rocket.adaptor_count; i++)
        model->rocket.adaptor[i].clearance = 10;
    if (law == LD_CONTACT_IDEAL) // rear and middle
        model->rocket.adaptor_count = 2;
}

static const double flight_time = 0.15;

// The tube flies, turns and bends strongly (its tip 15 cm off) while the rocket, unbalanced, slides
// through it.
static void start_strongly(launching_run *run, const launching_system *system)
{
    const launching_layout *at = &system->layout;
    const flexible_tube *tube = &system->tube.flexible;
    launching_run_begin(run, system, 0.3);
    run->input.mass.c.y = 2e-3;
    run->input.mass.c.z = -1e-3;
    run->input.mass.J.a[0][1] = run->input.mass.J.a[1][0] = 0.2;
    v3_store(run->state + at->r, v3_make(0.4, -0.7, 0.2));
    v3_store(run->state + at->v, v3_make(2, -1, 3));
    v3_store(run->state + at->w, v3_make(1, -0.3, 0.4));
    for (int plane = 0; plane < 2; plane++) {
        int sign = plane ? -1 : 1;
        run->state[at->q + plane * tube->nb] = sign * 0.15;
        run->state[at->q + plane * tube->nb + 1] = 0.05;
        run->state[at->q_dot + plane * tube->nb] = 2;
        run->state[at->q_dot + plane * tube->nb + 1] = sign * -2;
    }
    run->state[at->q + 2 * tube->nb] = 1e-3;
    run->state[at->x + 1] = 1e-3;
    run->state[at->x + 3] = 2e-3;
    launching_run_set_speeds(system, run->state, (double[6]){8, 0.1, -0.2, 8, 0.5, -0.4});
    launching_project(system, &run->input, &run->phase, run->state);
}

typedef struct drifts {
    double momentum, angular_momentum, energy; // relative to their start
    double slot, slot_power;                   // largest |n . v_rel| [m/s], |N n . v_rel| [W]
    double tip;                                // [m] largest deflection
} drifts;

static void watch(launching_run *run, double t)
{
    (void)t;
    drifts *d = run->user;
    launching_output out;
    launching_section tip;
    assert_int_equal(launching_evaluate(run->system, &run->input, &run->phase, run->state, &out),
                     LAUNCHING_OK);
    d->slot = fmax(d->slot, fabs(out.drift));
    d->slot_power = fmax(d->slot_power, fabs(out.drift * out.N));
    launching_section_at(run->system, run->state, run->system->tube.flexible.length, &tip);
    d->tip = fmax(d->tip, hypot(tip.P.y, tip.P.z));
}

static double change3(const double *now, const double *start)
{
    double change = 0, size = 0;
    for (int i = 0; i < 3; i++) {
        change += (now[i] - start[i]) * (now[i] - start[i]);
        size += start[i] * start[i];
    }
    return sqrt(change / size);
}

// Energy of the dense check less the work of the adaptors' springs and of the modes' damping.
static double energy_of(const launching_run *run, const dense_launch_output *out)
{
    const double *work = run->state + run->system->layout.count;
    return out->kinetic + out->potential - work[POWER_CONTACT_NORMAL] - work[POWER_MODAL_DAMPING];
}

static drifts follow(launching_run *run, const dense_launch *dense, double tolerance)
{
    drifts d = {0};
    dense_launch_output start, end;
    run->after_step = watch;
    run->user = &d;
    launching_run_dense(run, dense, &start);
    double energy_start = energy_of(run, &start);
    launching_run_follow(run, tolerance, flight_time);
    launching_run_dense(run, dense, &end);
    d.momentum = change3(end.momentum, start.momentum);
    d.angular_momentum = change3(end.angular_momentum, start.angular_momentum);
    d.energy = fabs(energy_of(run, &end) / energy_start - 1);
    return d;
}

static void momenta_and_energy(ld_contact_law law, const char *what, int count,
                               const double momentum[], const double energy[])
{
    ld_model model;
    dense_launch dense;
    launching_run run;
    free_model(&model, law);
    launching_system *system = launching_system_of(&model);
    dense_launch_create(&dense, &model, &system->tube.flexible);
    static const double tolerance[] = {1e-6, 1e-8, 1e-10, 1e-12};
    printf("  %s\n", what);
    for (int i = 0; i < count; i++) {
        start_strongly(&run, system);
        if (launching_holds_places(system))
            launching_project(system, &run.input, &run.phase, run.state);
        drifts d = follow(&run, &dense, tolerance[i]);
        printf("  tolerance %.0e, %d steps, tip %.3f m off\n", tolerance[i], (int)run.steps, d.tip);
        CHECK_BELOW("linear momentum", d.momentum, momentum[i]);
        CHECK_BELOW("angular momentum", d.angular_momentum, momentum[i]);
        CHECK_BELOW("energy", d.energy, energy[i]);
    }
    dense_launch_free(&dense);
    launching_system_drop(system);
    reference_model_free(&model);
}

static void free_without_contact(void **state)
{
    (void)state;
    momenta_and_energy(LD_CONTACT_HUNT_CROSSLEY, "nothing touches", 4,
                       (double[4]){1.5e-6, 1.5e-8, 4e-9, 3e-11},
                       (double[4]){2e-5, 4e-7, 8e-9, 4e-11});
}

static void free_with_springs(void **state)
{
    (void)state;
    // energy at 1e-12: eight starts 1e-9 apart leave 1e-13 to 4.2e-11
    momenta_and_energy(LD_CONTACT_BILATERAL, "adaptors on springs", 4,
                       (double[4]){1.5e-6, 1.5e-8, 4e-9, 3e-11},
                       (double[4]){2e-5, 3e-7, 8e-9, 6e-11});
}

// They are put back on the axis after each step, by no more than what the step has erred.
static void free_on_the_axis(void **state)
{
    (void)state;
    momenta_and_energy(LD_CONTACT_IDEAL, "adaptors on the axis", 2, (double[2]){1.5e-6, 8e-9},
                       (double[2]){2e-5, 2e-7});
}

// Modes above 300 Hz slowed: the linear momentum stays; of angular momentum and energy the dense
// check misses what the masses added to modes have of them, of second order in their deflections.
static void free_with_slowed_modes(void **state)
{
    (void)state;
    ld_model model;
    dense_launch dense;
    launching_run run;
    free_model(&model, LD_CONTACT_BILATERAL);
    model.tubes.modes.cut = 300;
    launching_system *system = launching_system_of(&model);
    dense_launch_create(&dense, &model, &system->tube.flexible);
    start_strongly(&run, system);
    drifts d = follow(&run, &dense, 1e-10);
    CHECK_BELOW("slowed modes: linear momentum", d.momentum, 1e-10);
    CHECK_BELOW("slowed modes: angular momentum", d.angular_momentum, 4e-7);
    CHECK_BELOW("slowed modes: energy", d.energy, 1e-4);
    dense_launch_free(&dense);
    launching_system_drop(system);
    reference_model_free(&model);
}

// The slot's power and drift, with and without the projection after each step.
static void check_slot(int elements, const double drift[3], const double power[3])
{
    ld_model model;
    dense_launch dense;
    launching_run run;
    free_model(&model, LD_CONTACT_BILATERAL);
    model.tubes.modes.elements = elements;
    model.tubes.modes.bending = elements == 1 ? 2 : 6;
    model.tubes.modes.torsion = 1;
    launching_system *system = launching_system_of(&model);
    dense_launch_create(&dense, &model, &system->tube.flexible);
    static const double tolerance[] = {1e-6, 1e-8, 1e-10};
    for (int i = 0; i < 3; i++) {
        printf("  %d elements, tolerance %.0e\n", elements, tolerance[i]);
        start_strongly(&run, system);
        drifts d = follow(&run, &dense, tolerance[i]);
        CHECK_BELOW("slot drift n . v_rel [m/s]", d.slot, drift[i]);
        CHECK_BELOW("slot power N (n . v_rel) [W]", d.slot_power, power[i]);
        start_strongly(&run, system);
        run.project = true;
        d = follow(&run, &dense, tolerance[i]);
        CHECK_BELOW("the same with projection [m/s]", d.slot, 1.5e-13);
        CHECK_BELOW("the same with projection [W]", d.slot_power, 5e-9);
    }
    dense_launch_free(&dense);
    launching_system_drop(system);
    reference_model_free(&model);
}

// Without nodes the drift falls as the tolerance does; each node (the slot force jumps there, with
// the curvature) adds the error of the step across it.
static void slot_drift(void **state)
{
    (void)state;
    check_slot(1, (double[3]){8e-6, 4e-8, 4e-10}, (double[3]){0.25, 1.2e-3, 2e-5});
    check_slot(40, (double[3]){5e-6, 2e-6, 5e-7}, (double[3]){0.5, 0.25, 0.06});
}

// The state's speeds less those of another one, as if they were speeds.
static double kinetic_of_difference(const launching_run *run, const dense_launch *dense,
                                    const double *less)
{
    const launching_layout *at = &run->system->layout;
    launching_run between = *run;
    dense_launch_output out;
    for (int i = 0; i < 6; i++) {
        between.state[at->v + i] -= less[at->v + i];
        between.state[at->V + i] -= less[at->V + i];
    }
    for (int i = 0; i < at->nq; i++)
        between.state[at->q_dot + i] -= less[at->q_dot + i];
    launching_run_dense(&between, dense, &out);
    return out.kinetic;
}

// Projections of states that break the constraints by metres per second: momenta stay, and what
// is taken off has no part of what is left (Pythagoras, by the kinetic energy), as the impulses of
// constraints make it.
static void check_projection(ld_contact_law law, int axial, const char *what)
{
    ld_model model;
    dense_launch dense;
    launching_run run;
    free_model(&model, law);
    model.tubes.modes.axial = axial;
    launching_system *system = launching_system_of(&model);
    dense_launch_create(&dense, &model, &system->tube.flexible);
    start_strongly(&run, system);
    uint64_t seed = 20260713;
    double momentum = 0, angular_momentum = 0, energy = 0, report_broken = 0, left = 0;
    for (int k = 0; k < 100; k++) {
        dense_launch_output before, after;
        double *V = run.state + system->layout.V, was[RUN_STATES];
        for (int i = 0; i < 6; i++)
            V[i] += draw(&seed);
        memcpy(was, run.state, sizeof was);
        launching_run_dense(&run, &dense, &before);
        launching_project(system, &run.input, &run.phase, run.state);
        launching_run_dense(&run, &dense, &after);
        momentum = fmax(momentum, change3(after.momentum, before.momentum));
        angular_momentum =
            fmax(angular_momentum, change3(after.angular_momentum, before.angular_momentum));
        double taken = kinetic_of_difference(&run, &dense, was);
        energy = fmax(energy, fabs((after.kinetic + taken) / before.kinetic - 1));
        report_broken = fmax(report_broken, fabs(before.slot_drift));
        left = fmax(left, fabs(after.slot_drift));
    }
    printf("  %s: drift before the projection up to %.2f m/s\n", what, report_broken);
    CHECK_BELOW("drift after it [m/s]", left, 1e-14);
    CHECK_BELOW("linear momentum", momentum, 3e-15);
    CHECK_BELOW("angular momentum", angular_momentum, 3e-15);
    CHECK_BELOW("kinetic energy, with that of what was taken off", energy, 1e-14);
    dense_launch_free(&dense);
    launching_system_drop(system);
    reference_model_free(&model);
}

static void projection_keeps_momenta(void **state)
{
    (void)state;
    check_projection(LD_CONTACT_BILATERAL, 0, "slot");
    check_projection(LD_CONTACT_BILATERAL, 2, "slot, axial modes");
    check_projection(LD_CONTACT_IDEAL, 0, "slot and ideal adaptors");
    check_projection(LD_CONTACT_IDEAL, 2, "slot and ideal adaptors, axial modes");
}

// ---- V and y as states ----

// State: y = (s_dot, y_S_dot, z_S_dot, w_SB) in place of V; accelerations by the overall form,
// which gives y_dot.
static int rhs_of_y(double t, const double *state, double *state_dot, void *user)
{
    (void)t;
    launching_run *run = user;
    const launching_layout *at = &run->system->layout;
    double with_V[RUN_STATES];
    launching_output out;
    memcpy(with_V, state, (size_t)at->count * sizeof(double));
    launching_run_set_speeds(run->system, with_V, state + at->V);
    if (launching_evaluate_overall(run->system, &run->input, &run->phase, with_V, &out) ||
        out.fell_back)
        return -1;
    launching_rates(run->system, with_V, &out, true, state_dot);
    memcpy(state_dot + at->V, out.y_dot, sizeof out.y_dot);
    memset(state_dot + at->count, 0, (size_t)run->system->work_count * sizeof(double));
    return 0;
}

typedef struct flight {
    double s, position[3]; // [m] station of O1; O1 in R
    double V[6];
    double momentum, angular_momentum; // relative drift
} flight;

// One flight with V or with y as states.
static flight fly(const launching_system *system, const dense_launch *dense, bool as_y,
                  double tolerance)
{
    launching_run run;
    launching_output out;
    launching_pose pose;
    dense_launch_output start, end;
    const launching_layout *at = &system->layout;
    start_strongly(&run, system);
    launching_run_dense(&run, dense, &start);
    if (as_y) {
        launching_rocket_pose(system, run.state, &pose, &out);
        memcpy(run.state + at->V, out.y, sizeof out.y);
        run.rhs = rhs_of_y;
    }
    launching_run_follow(&run, tolerance, flight_time);
    if (as_y) {
        double y[6];
        memcpy(y, run.state + at->V, sizeof y);
        launching_run_set_speeds(system, run.state, y);
    }
    launching_rocket_pose(system, run.state, &pose, &out);
    launching_run_dense(&run, dense, &end);
    flight f = {.s = run.state[at->x],
                .momentum = change3(end.momentum, start.momentum),
                .angular_momentum = change3(end.angular_momentum, start.angular_momentum)};
    v3_store(f.position, pose.p1);
    memcpy(f.V, run.state + at->V, sizeof f.V);
    printf("    %s, tolerance %.0e: momentum off by %.1e, angular momentum by %.1e (relative)\n",
           as_y ? "y" : "V", tolerance, f.momentum, f.angular_momentum);
    return f;
}

static double difference(int n, const double *a, const double *b)
{
    double largest = 0;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, fabs(a[i] - b[i]));
    return largest;
}

// The tube of one finite element: its shapes are polynomials without nodes.
static void smooth_shapes(void **state)
{
    (void)state;
    ld_model model;
    dense_launch dense;
    free_model(&model, LD_CONTACT_BILATERAL);
    model.tubes.modes.elements = 1;
    model.tubes.modes.bending = 2;
    model.tubes.modes.torsion = 1;
    launching_system *system = launching_system_of(&model);
    assert_int_equal(system->tube.flexible.element_count, 1);
    dense_launch_create(&dense, &model, &system->tube.flexible);
    flight truth = fly(system, &dense, false, 1e-12);
    static const double tolerance[] = {1e-6, 1e-8, 1e-10};
    for (int i = 0; i < 3; i++) {
        flight y = fly(system, &dense, true, tolerance[i]);
        flight V = fly(system, &dense, false, tolerance[i]);
        double t = tolerance[i];
        CHECK_BELOW("V: place of the rocket [m]", difference(3, V.position, truth.position), 3 * t);
        CHECK_BELOW("y: place of the rocket [m]", difference(3, y.position, truth.position), 3 * t);
        CHECK_BELOW("V: velocity and rate [m/s, rad/s]", difference(6, V.V, truth.V), 800 * t);
        CHECK_BELOW("y: velocity and rate [m/s, rad/s]", difference(6, y.V, truth.V), 800 * t);
        CHECK_BELOW("y: angular momentum", y.angular_momentum, 6 * t);
    }
    dense_launch_free(&dense);
    launching_system_drop(system);
    reference_model_free(&model);
}

// Finite elements: the curvature jumps at each node, and y with it, which its derivative misses.
static void curvature_jumps(void **state)
{
    (void)state;
    ld_model model;
    dense_launch dense;
    free_model(&model, LD_CONTACT_BILATERAL);
    model.tubes.modes.elements = 3;
    model.tubes.modes.bending = 3;
    launching_system *system = launching_system_of(&model);
    dense_launch_create(&dense, &model, &system->tube.flexible);
    // eight starts 1e-9 apart leave 8e-7 to 1.5e-5 and 7e-8 to 6.9e-7: by where the steps end
    static const double tolerance[] = {1e-6, 1e-8}, bound[] = {3e-5, 1e-6};
    for (int i = 0; i < 2; i++) {
        flight y = fly(system, &dense, true, tolerance[i]);
        flight V = fly(system, &dense, false, tolerance[i]);
        CHECK_WITHIN("y: angular momentum lost, of the whole", y.angular_momentum, 0.06, 0.07);
        CHECK_BELOW("V: angular momentum", V.angular_momentum, bound[i]);
    }
    dense_launch_free(&dense);
    launching_system_drop(system);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_without_contact), cmocka_unit_test(free_with_springs),
        cmocka_unit_test(free_on_the_axis),     cmocka_unit_test(free_with_slowed_modes),
        cmocka_unit_test(slot_drift),           cmocka_unit_test(projection_keeps_momenta),
        cmocka_unit_test(smooth_shapes),        cmocka_unit_test(curvature_jumps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
