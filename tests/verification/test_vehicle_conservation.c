// Vehicle, tube and rocket thrown into the air, without gravity: linear and angular momentum stay
// what they are whatever acts inside, and energy where nothing damps. Momenta and energies are
// those of the independent vehicle and the independent launching subsystem.
// ctest: slow
#include <stdlib.h>

#include "support/check.h"
#include "support/dense_vehicle.h"
#include "support/draw.h"
#include "support/launching_run.h"
#include "support/launching_state.h"
#include "support/reference_model.h"
#include "systems/bases/mechanism_base.h"
#include "systems/launching/launcher.h"
#include "systems/launching/launching_dynamics.h"

enum { STATES = LD_MAX_STATES };

typedef struct flight {
    ld_model model;
    launcher_system *system;
    dense_vehicle vehicle;
    dense_launch launch;
    launcher_input input;
    launching_phase phase;
    double state[STATES];
} flight;

// ---- the system ----

// Adaptors held on the axis by springs; `damped`: with all dampers, friction and stabilisers, else
// with springs alone, on the hinges too.
static void fill_model(ld_model *model, bool damped)
{
    reference_vehicle(model, 8);
    model->gravity = 0;
    ld_contact *contact = &model->rocket.contact;
    contact->law = LD_CONTACT_BILATERAL;
    contact->stiffness = 2e5;
    contact->damping = contact->friction = 0;
    if (damped)
        return;
    ld_turret *turret[HINGES] = {&model->platform.azimuth, &model->platform.elevation};
    for (int i = 0; i < HINGES; i++) {
        turret[i]->lock = (ld_hinge_lock){true, 1e7, 0};
        turret[i]->friction.viscous = turret[i]->friction.coulomb = 0;
    }
    for (int k = 0; k < 3; k++)
        model->base.vehicle.suspension.damping[k] = 0;
    for (int i = 0; i < model->tubes.support_count; i++)
        for (int k = 0; k < 3; k++)
            model->tubes.support[i].damping[k] = model->tubes.support[i].rotational_damping[k] = 0;
    model->tubes.modes.damping = 0;
    model->tubes.slot.friction = 0;
}

static void set_up(flight *f, bool damped)
{
    ld_error error;
    memset(f, 0, sizeof *f);
    fill_model(&f->model, damped);
    f->system = aligned_alloc(64, (sizeof *f->system + 63) / 64 * 64);
    if (launcher_build(f->system, &f->model, NULL, &error))
        fail_msg("%s", error.text);
    dense_vehicle_create(&f->vehicle, &f->model, 8, NULL, 0);
    dense_launch_create(&f->launch, &f->model, &f->system->launching.tube.flexible);
    const ld_mass_data *full = &f->model.rocket.full;
    f->input.launching.mass.m = full->mass;
    f->input.launching.mass.c = v3_from(full->center);
    f->input.launching.mass.J = m3_diagonal(full->inertia[0], full->inertia[1], full->inertia[2]);
    f->phase.rocket = true;
}

static void tear_down(flight *f)
{
    dense_launch_free(&f->launch);
    dense_vehicle_free(&f->vehicle);
    launcher_free(f->system);
    free(f->system);
    reference_model_free(&f->model);
}

// ---- the throw ----

// Chassis turning, hinges at angles with rates, wheels centimetres off their mounts with speeds.
static void throw_vehicle(flight *f, uint64_t *seed)
{
    double *base = f->state + f->system->base_at;
    double *wheel = f->state + f->system->base_at + VEHICLE_BODY_STATES;
    quat q =
        q_from_matrix(m3_mul(m3_rotation_y(0.7), m3_mul(m3_rotation_z(0.3), m3_rotation_x(-0.2))));
    v3_store(base + VEHICLE_R, v3_make(1, 4, -1));
    memcpy(base + VEHICLE_QUATERNION, &q, sizeof q);
    v3_store(base + VEHICLE_V, v3_make(3, -1, 2));
    v3_store(base + VEHICLE_W, v3_make(0.4, -0.5, 0.3));
    for (int i = 0; i < HINGES; i++) {
        base[VEHICLE_ANGLE + i] = f->input.rest.hold[i].angle = 0.3 + 0.1 * i;
        base[VEHICLE_RATE + i] = 0.3 - 0.5 * i;
    }
    // the stabilisers want to turn by tenths of a radian
    f->model.platform.azimuth.stabiliser.command.data[1] = 1.0;
    f->model.platform.elevation.stabiliser.command.data[1] = 0.7;
    launcher_place(f->system, 0, f->state, &f->input);
    const mechanism_base *vehicle = f->system->base.own;
    base_frame at = mechanism_base_chassis(&f->system->base, &f->input.found.mechanism);
    const base_frame *chassis = &at;
    marching_place(&vehicle->marching, chassis, wheel);
    for (int j = 0; j < f->model.base.vehicle.wheel_count; j++, wheel += WHEEL_STATES) {
        v3 arm = v3_sub(v3_from(wheel + WHEEL_R), chassis->r);
        v3 v = v3_add(chassis->v, v3_cross(chassis->w, arm));
        v3_store(wheel + WHEEL_R, v3_add(v3_from(wheel + WHEEL_R), draw_v3(seed, 0.02)));
        v3_store(wheel + WHEEL_V, v3_add(v, draw_v3(seed, 0.5)));
    }
}

// Tube moving with the platform, vibrating; the rocket slides through it.
static void throw_tube(flight *f)
{
    static double local[RUN_STATES]; // states of the launching subsystem alone
    const launching_system *launching = &f->system->launching;
    const launching_layout *at = &launching->layout;
    const base_frame *base = &f->input.launching.base;
    memset(local, 0, sizeof local);
    v3_store(local + at->r, base->r);
    memcpy(local + at->quaternion, &base->q, sizeof base->q);
    v3_store(local + at->v, m3_apply_transposed(base->A, base->v));
    v3_store(local + at->w, m3_apply_transposed(base->A, base->w));
    for (int plane = 0; plane < 2; plane++) {
        local[at->q_dot + plane * launching->tube.flexible.nb] = plane ? -0.5 : 0.5;
        local[at->q_dot + plane * launching->tube.flexible.nb + 1] = 0.3;
    }
    local[at->x] = 0.2;
    launching_run_set_speeds(launching, local, (double[6]){5, 0.02, -0.05, 5, 0.05, -0.04});
    launching_project(launching, &f->input.launching, &f->phase, local);
    memcpy(f->state, local, (size_t)at->count * sizeof *local);
}

// ---- what is conserved ----

typedef struct sums {
    v3 momentum, angular_momentum; // in I about its origin
    double energy;
} sums;

static void add_point(sums *s, double mass, v3 place, v3 v)
{
    s->momentum = v3_axpy(s->momentum, mass, v);
    s->angular_momentum = v3_axpy(s->angular_momentum, mass, v3_cross(place, v));
}

static void add_bodies(const flight *f, sums *s)
{
    const double *base = f->state + f->system->base_at;
    const ld_platform *platform = &f->model.platform;
    const double *hinge_at[HINGES] = {platform->azimuth.hinge_at, platform->elevation.hinge_at};
    v3 r = v3_from(base + VEHICLE_R), v = v3_from(base + VEHICLE_V);
    m3 A = q_matrix(q_from(base + VEHICLE_QUATERNION));
    v3 w = m3_apply(A, v3_from(base + VEHICLE_W));
    for (int i = 0; i < DENSE_BODIES; i++) {
        for (int k = 0; k < f->vehicle.body[i].count; k++) {
            const dense_part *part = &f->vehicle.body[i].part[k];
            v3 arm = m3_apply(A, part->center);
            v3 spin = m3_apply(A, m3_apply(part->inertia, m3_apply_transposed(A, w)));
            add_point(s, part->mass, v3_add(r, arm), v3_add(v, v3_cross(w, arm)));
            s->angular_momentum = v3_add(s->angular_momentum, spin);
        }
        if (i == DENSE_ELEVATION)
            break;
        v3 arm = m3_apply(A, v3_from(hinge_at[i])), axis = m3_column(A, i == 0 ? 1 : 2);
        double angle = base[VEHICLE_ANGLE + i];
        r = v3_add(r, arm);
        v = v3_add(v, v3_cross(w, arm));
        w = v3_axpy(w, base[VEHICLE_RATE + i], axis);
        A = m3_mul(A, i == 0 ? m3_rotation_y(angle) : m3_rotation_z(angle));
    }
}

static sums sums_of(flight *f)
{
    sums s = {0};
    static launching_case c;
    dense_launch_output launch;
    dense_vehicle_output vehicle;
    // vehicle
    add_bodies(f, &s);
    const double *wheel = f->state + f->system->base_at + VEHICLE_BODY_STATES;
    for (int j = 0; j < f->model.base.vehicle.wheel_count; j++, wheel += WHEEL_STATES)
        add_point(&s, f->model.base.vehicle.wheel[j].mass, v3_from(wheel + WHEEL_R),
                  v3_from(wheel + WHEEL_V));
    const double *base = f->state + f->system->base_at;
    dense_vehicle_input given = {.orientating = base,
                                 .marching = f->state + f->system->base_at + VEHICLE_BODY_STATES};
    assert_true(dense_vehicle_evaluate(&f->vehicle, &given, &vehicle));
    s.energy = vehicle.kinetic + vehicle.potential;
    for (int i = 0; i < HINGES; i++) {
        double turned = base[VEHICLE_ANGLE + i] - f->input.rest.hold[i].angle;
        s.energy += 0.5 * 1e7 * turned * turned;
    }
    // tube and rocket
    memset(&c, 0, sizeof c);
    launcher_place(f->system, 0, f->state, &f->input);
    memcpy(c.state, f->state, (size_t)f->system->launching.layout.count * sizeof(double));
    c.input = f->input.launching;
    c.phase = f->phase;
    copy_to_dense(&f->system->launching, &c);
    assert_true(dense_launch_evaluate(&f->launch, &c.dense, &launch));
    s.momentum = v3_add(s.momentum, v3_from(launch.momentum));
    s.angular_momentum = v3_add(s.angular_momentum, v3_from(launch.angular_momentum));
    s.energy +=
        launch.kinetic + launch.potential - f->state[f->system->work_at + POWER_CONTACT_NORMAL];
    return s;
}

// ---- in time ----

static int rhs(double t, const double *state, double *state_dot, void *user)
{
    flight *f = user;
    launcher_output out;
    launcher_place(f->system, t, state, &f->input);
    if (launcher_evaluate(f->system, &f->input, &f->phase, state, &out))
        return -1;
    launcher_rates(f->system, state, &out, true, state_dot);
    return 0;
}

static void follow(flight *f, double tolerance, double time)
{
    ld_error error;
    integrator *stepper;
    double atol[STATES];
    int count = f->system->state_count;
    for (int i = 0; i < count; i++)
        atol[i] = i < f->system->work_at ? 1e-2 * tolerance : 1e300;
    for (int i = 0; i < HINGES; i++)
        atol[f->system->base_at + VEHICLE_Z + i] = tolerance;
    integrator_settings settings = {
        .n = (size_t)count, .rtol = tolerance, .atol = atol, .rhs = rhs, .self = f};
    assert_int_equal(integrator_create(&settings, &stepper, &error), LD_OK);
    assert_int_equal(integrator_start(stepper, 0, f->state, &error), LD_OK);
    integrator_outcome outcome = INTEGRATOR_STEPPED;
    while (outcome == INTEGRATOR_STEPPED)
        outcome = integrator_step(stepper, time, &error);
    assert_int_equal(outcome, INTEGRATOR_STOPPED);
    memcpy(f->state, integrator_state(stepper), (size_t)count * sizeof(double));
    printf("  tolerance %.0e, %d steps\n", tolerance, (int)integrator_steps(stepper));
    integrator_free(stepper);
}

static double change(v3 now, v3 start)
{
    return v3_norm(v3_sub(now, start)) / v3_norm(start);
}

static void conserve(bool damped, const double momentum[3], const double energy[3])
{
    static flight f;
    static const double tolerance[] = {1e-4, 1e-6, 1e-8};
    set_up(&f, damped);
    for (int i = 0; i < 3; i++) {
        uint64_t seed = 4;
        memset(f.state, 0, sizeof f.state);
        throw_vehicle(&f, &seed);
        throw_tube(&f);
        sums start = sums_of(&f);
        follow(&f, tolerance[i], 0.15);
        sums end = sums_of(&f);
        CHECK_BELOW("linear momentum", change(end.momentum, start.momentum), momentum[i]);
        CHECK_BELOW("angular momentum", change(end.angular_momentum, start.angular_momentum),
                    momentum[i]);
        double gain = end.energy / start.energy - 1;
        if (damped)
            CHECK_WITHIN("energy that they bring in", gain, 0.044, 0.047);
        else
            CHECK_BELOW("energy", gain, energy[i]);
    }
    tear_down(&f);
}

static void springs_alone(void **state)
{
    (void)state;
    conserve(false, (double[3]){2e-11, 2e-11, 4e-12}, (double[3]){1.5e-10, 1e-11, 2e-12});
}

static void with_dampers_friction_and_stabilisers(void **state)
{
    (void)state;
    conserve(true, (double[3]){2e-11, 3e-11, 4e-12}, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_alone),
        cmocka_unit_test(with_dampers_friction_and_stabilisers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
