// Random states of the launching subsystem, the same for the program and for the dense check.
#ifndef LD_TESTS_SUPPORT_LAUNCHING_STATE_H
#define LD_TESTS_SUPPORT_LAUNCHING_STATE_H

#include <string.h>

#include "model/model.h"
#include "support/dense_simulation.h"
#include "support/draw.h"
#include "systems/launching/launching.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_kinematics.h"

typedef struct launching_case {
    double state[32 + 2 * LD_MAX_MODAL];
    launching_input input;
    launching_phase phase;
    dense_launch_input dense;
} launching_case;

static inline void copy_matrix(double to[3][3], m3 from)
{
    memcpy(to, from.a, sizeof from.a);
}

// A state with large motion of the frame, centimetre deflections, the rocket somewhere in the tube
// with deep contacts, and speeds of every kind.
static inline void draw_state(const launching_system *system, uint64_t *seed, bool locked,
                              launching_case *c)
{
    const launching_layout *at = &system->layout;
    const flexible_tube *tube = &system->tube.flexible;
    double *y = c->state;
    memset(c, 0, sizeof *c);
    m3 A = draw_rotation(seed);
    quat q = q_from_matrix(A);
    v3_store(y + at->r, draw_v3(seed, 2));
    memcpy(y + at->quaternion, &q, sizeof q);
    v3_store(y + at->v, draw_v3(seed, 3));
    v3_store(y + at->w, draw_v3(seed, 2));
    for (int i = 0; i < at->nq; i++) {
        int mode = i < 2 * tube->nb ? i % tube->nb : i - 2 * tube->nb;
        bool bending = i < 2 * tube->nb;
        y[at->q + i] = draw(seed) * (bending ? 0.05 : 1e-3) / (1 + mode * mode);
        y[at->q_dot + i] = draw(seed) * (bending ? 5 : 0.3) / (1 + mode);
    }
    y[at->x] = 0.3 + 0.25 * (1 + draw(seed));
    for (int i = 1; i < 6; i++)
        y[at->x + i] = draw(seed) * (i < 3 ? 1e-3 : i < 5 ? 2e-3 : 3);
    if (system->surfaces.count) { // near the guide line, hardly rolled
        y[at->x + 1] += system->surfaces.line_y;
        y[at->x + 2] += system->surfaces.line_z;
        y[at->x + 5] *= 0.01;
    }
    v3 v = v3_from(y + at->v), w = v3_from(y + at->w);
    launching_pose pose;
    launching_output out;
    launching_rocket_pose(system, y, &pose, &out);
    v3 v_O1 = v3_add(v3_add(v, v3_cross(w, pose.p1)), draw_v3(seed, 1));
    v_O1 = v3_axpy(v_O1, 20 * (1 + draw(seed)), m3_column(pose.A_RS, 0));
    v3_store(y + at->V, v_O1);
    v3_store(y + at->V + 3, v3_add(w, draw_v3(seed, 10)));
    // base near the tube, moving
    m3 turn = q_matrix((quat){1, 0.01 * draw(seed), 0.01 * draw(seed), 0.01 * draw(seed)});
    c->input.base.A = m3_mul(A, turn);
    c->input.base.q = q_from_matrix(c->input.base.A);
    c->input.base.r = v3_add(v3_from(y + at->r), draw_v3(seed, 1e-3));
    c->input.base.v = draw_v3(seed, 3);
    c->input.base.w = draw_v3(seed, 1);
    if (system->supports.clamps) {
        c->input.base.a = draw_v3(seed, 20);
        c->input.base.alpha = draw_v3(seed, 10);
    }
    c->input.thrust = 7000 * (1 + draw(seed));
    c->input.mass.m = 50 + 10 * draw(seed);
    c->input.mass.c = v3_add(v3_make(1.1, 0, 0), draw_v3(seed, 1e-2));
    c->input.mass.J = draw_inertia(seed, c->input.mass.m);
    const ld_pressure *pressure = &system->model->tubes.pressure;
    c->input.pressure_piece = 1;
    if (pressure->form == LD_PRESSURE_OVER_TIME && pressure->over_time.rows > 1)
        c->input.since = 0.5 * (1 + draw(seed)) * pressure->over_time.data[2];
    uint64_t other = *seed + 1;
    for (int i = 0; i < 2; i++) {
        c->input.across.force[i] = 3000 * draw(&other);
        c->input.across.lean[i] = 0.1 * draw(&other);
        c->input.across.shift[i] = 0.05 * draw(&other);
    }
    // two further motors
    for (int k = 0; k < 2; k++) {
        double *force = c->dense.conditions.further[k].force;
        double *place = c->dense.conditions.further[k].at;
        v3_store(force, v3_add(v3_make(3000, 0, 0), draw_v3(&other, 2000)));
        v3_store(place, draw_v3(&other, 0.3));
        v3 pushes = v3_from(force), turns = v3_cross(v3_from(place), pushes);
        c->input.across.others += v3_norm(pushes);
        c->input.across.others_force = v3_add(c->input.across.others_force, pushes);
        c->input.across.others_moment = v3_add(c->input.across.others_moment, turns);
    }
    c->input.thrust += c->input.across.others;
    c->phase.rocket = true;
    c->phase.locked = locked;
    for (int i = 0; i < LD_MAX_ADAPTORS; i++)
        c->phase.touch_speed[i] = 0.1 + 0.05 * draw(seed);
    c->phase.breech_speed = c->phase.touch_speed[0];
    launching_project(system, &c->input, &c->phase, y);
}

// Fills the dense check's input from the same numbers.
static inline void copy_to_dense(const launching_system *system, launching_case *c)
{
    const launching_layout *at = &system->layout;
    const double *y = c->state;
    dense_launch_input *d = &c->dense;
    dense_conditions *conditions = &d->conditions;
    memcpy(d->r, y + at->r, sizeof d->r);
    memcpy(d->quaternion, y + at->quaternion, sizeof d->quaternion);
    memcpy(d->v, y + at->v, sizeof d->v);
    memcpy(d->w, y + at->w, sizeof d->w);
    memcpy(d->q, y + at->q, (size_t)at->nq * sizeof(double));
    memcpy(d->q_dot, y + at->q_dot, (size_t)at->nq * sizeof(double));
    d->s = y[at->x];
    d->y = y[at->x + 1];
    d->z = y[at->x + 2];
    d->psi = y[at->x + 3];
    d->theta = y[at->x + 4];
    d->gamma = y[at->x + 5];
    memcpy(d->V, y + at->V, sizeof d->V);
    v3_store(conditions->base.r, c->input.base.r);
    copy_matrix(conditions->base.A, c->input.base.A);
    v3_store(conditions->base.v, c->input.base.v);
    v3_store(conditions->base.w, c->input.base.w);
    v3_store(conditions->base.a, c->input.base.a);
    v3_store(conditions->base.alpha, c->input.base.alpha);
    const rocket_mass *mass = &c->input.mass;
    conditions->mass = mass->m;
    v3_store(conditions->center, mass->c);
    for (int i = 0; i < 3; i++)
        conditions->inertia[i] = mass->J.a[i][i];
    conditions->products[0] = mass->J.a[0][1];
    conditions->products[1] = mass->J.a[0][2];
    conditions->products[2] = mass->J.a[1][2];
    conditions->thrust = c->input.thrust - c->input.across.others;
    for (int i = 0; i < 2; i++) {
        const ld_motor *given = &system->rocket->motor;
        conditions->across[i] = c->input.across.force[i];
        conditions->across[2 + i] = given->misalignment[i] + c->input.across.lean[i];
        conditions->across[4 + i] = given->at[1 + i] + c->input.across.shift[i];
    }
    conditions->pressed = c->input.pressure_piece > 0;
    conditions->pressure =
        dense_pressure_at(&system->model->tubes.pressure, c->input.since, c->input.since);
    conditions->locked = c->phase.locked;
    conditions->frictionless = c->phase.frictionless;
    memcpy(conditions->passed, c->phase.passed, sizeof conditions->passed);
    memcpy(conditions->touch_speed, c->phase.touch_speed, sizeof conditions->touch_speed);
    conditions->breech = c->phase.breech;
    v3_store(conditions->air, c->input.air.v);
    conditions->density = c->input.air.density;
    conditions->sound = c->input.air.speed_of_sound;
    conditions->power = c->input.power;
    v3_store(conditions->jet_face, c->input.jet_face.force);
    v3_store(conditions->jet_face_at, c->input.jet_face.at);
    v3_store(conditions->deflector, c->input.deflector.force);
    v3_store(conditions->deflector_at, c->input.deflector.at);
    conditions->breech_speed = c->phase.breech_speed;
}

#endif
