// The history of a launch: columns and rows; energies.
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "simulation/simulation.h"

direction_angles direction_angles_of(v3 d, v3 d_dot)
{
    double level2 = d.x * d.x + d.z * d.z, level = sqrt(level2);
    double level_dot = level > 0 ? (d.x * d_dot.x + d.z * d_dot.z) / level : 0;
    return (direction_angles){
        .pitch = atan2(d.y, level),
        .yaw = atan2(-d.z, d.x),
        .pitch_rate = (d_dot.y * level - d.y * level_dot) / (level2 + d.y * d.y),
        .yaw_rate = (d.z * d_dot.x - d.x * d_dot.z) / level2,
    };
}

tip_state tip_state_of(const ld_simulation *self, const base_frame *base, const double *y)
{
    const launching_system *launching = &self->launching;
    const launching_layout *at = &launching->layout;
    launching_section tip;
    double length = launching->tube.length;
    launching_section_at(launching, y, length, &tip);
    m3 A_TR = m3_mul(m3_transpose(base->A), q_matrix(q_from(y + at->quaternion)));
    v3 r = m3_apply_transposed(base->A, v3_sub(v3_from(y + at->r), base->r));
    v3 base_v = m3_apply_transposed(base->A, base->v),
       base_w = m3_apply_transposed(base->A, base->w);
    v3 place = v3_add(r, m3_apply(A_TR, tip.P));
    v3 v = v3_sub(m3_apply(A_TR, tip.v), v3_add(base_v, v3_cross(base_w, place)));
    v3 w = v3_sub(m3_apply(A_TR, tip.w), base_w);
    v3 axis = m3_apply(A_TR, m3_column(tip.A, 0));
    return (tip_state){
        .offset = v3_sub(place, v3_make(length, 0, 0)),
        .offset_dot = v, // base_w x place is taken off: the derivative of base coordinates
        .angles = direction_angles_of(axis, v3_cross(w, axis)),
    };
}

void simulation_energy(const ld_simulation *self, const launching_input *input,
                       const launching_output *out, const double *y, double energy_start,
                       ld_energy *energy)
{
    const double *work = y + self->work;
    double sum = 0, largest = 0;
    for (int i = 0; i < POWER_COUNT; i++) {
        sum += work[i];
        largest = fmax(largest, fabs(work[i]));
    }
    energy->kinetic = launching_kinetic_energy(&self->launching, input, &self->phase, y);
    energy->potential = launching_potential_energy(&self->launching, y);
    energy->elastic = out->elastic;
    energy->work = (ld_work){.thrust = work[POWER_THRUST],
                             .gravity_rocket = work[POWER_GRAVITY_ROCKET],
                             .contact_normal = work[POWER_CONTACT_NORMAL],
                             .contact_friction = work[POWER_CONTACT_FRICTION],
                             .slot = work[POWER_SLOT],
                             .slot_friction = work[POWER_SLOT_FRICTION],
                             .lock = work[POWER_LOCK],
                             .support_damping = work[POWER_SUPPORT_DAMPING],
                             .modal_damping = work[POWER_MODAL_DAMPING],
                             .base = work[POWER_BASE],
                             .mass_change = work[POWER_MASS_CHANGE]};
    energy->residual = energy->kinetic + energy->potential + energy->elastic - energy_start - sum;
    energy->residual_relative = largest > 0 ? energy->residual / largest : 0;
}

// ---- columns ----

static void add(ld_simulation *self, const char *unit, const char *name, const char *description)
{
    self->column[self->column_count++] =
        (ld_column){.name = name, .unit = unit, .description = description};
}

// A column whose name and description carry a number or a name.
static void add_named(ld_simulation *self, const char *unit, const char *name,
                      const char *description, const char *which)
{
    char(*text)[96] = self->column_text[self->column_count];
    snprintf(text[0], sizeof text[0], name, which);
    snprintf(text[1], sizeof text[1], description, which);
    add(self, unit, text[0], text[1]);
}

static void add_frames(ld_simulation *self)
{
    add(self, "s", "t", "time on the run's clock");
    add(self, "1", "phase", "0 before ignition, 1 locked, 2 moving in the tube, 3 tube alone");
    add(self, "m", "base.x", "undeformed tube's rear end, in I");
    add(self, "m", "base.y", "undeformed tube's rear end, in I");
    add(self, "m", "base.z", "undeformed tube's rear end, in I");
    add(self, "rad", "base.yaw", "base: yaw of Ry(yaw) Rz(pitch) Rx(roll)");
    add(self, "rad", "base.pitch", "base: pitch");
    add(self, "rad", "base.roll", "base: roll");
    add(self, "m", "tube.x", "floating frame R: origin in I");
    add(self, "m", "tube.y", "floating frame R: origin in I");
    add(self, "m", "tube.z", "floating frame R: origin in I");
    add(self, "1", "tube.q0", "quaternion of R against I, scalar part");
    add(self, "1", "tube.q1", "quaternion of R against I, x");
    add(self, "1", "tube.q2", "quaternion of R against I, y");
    add(self, "1", "tube.q3", "quaternion of R against I, z");
    add(self, "m/s", "tube.vx", "inertial velocity of R's origin, in R");
    add(self, "m/s", "tube.vy", "inertial velocity of R's origin, in R");
    add(self, "m/s", "tube.vz", "inertial velocity of R's origin, in R");
    add(self, "rad/s", "tube.wx", "angular velocity of R against I, in R");
    add(self, "rad/s", "tube.wy", "angular velocity of R against I, in R");
    add(self, "rad/s", "tube.wz", "angular velocity of R against I, in R");
    char number[16];
    for (int i = 1; i <= self->launching.layout.nq; i++) {
        snprintf(number, sizeof number, "%d", i);
        add_named(self, "kg0.5.m", "q%s", "modal coordinate %s (bending y, z, torsion, axial)",
                  number);
    }
    for (int i = 1; i <= self->launching.layout.nq; i++) {
        snprintf(number, sizeof number, "%d", i);
        add_named(self, "kg0.5.m/s", "q%s_dot", "rate of modal coordinate %s", number);
    }
    add(self, "m", "tip.y", "tip against the undeformed tube, in its axes");
    add(self, "m", "tip.z", "tip against the undeformed tube, in its axes");
    add(self, "rad", "tip.pitch", "tip's axis against the undeformed tube: pitch");
    add(self, "rad", "tip.yaw", "tip's axis against the undeformed tube: yaw");
    add(self, "m/s", "tip.vy", "rate of tip.y");
    add(self, "m/s", "tip.vz", "rate of tip.z");
    add(self, "rad/s", "tip.pitch_rate", "rate of tip.pitch");
    add(self, "rad/s", "tip.yaw_rate", "rate of tip.yaw");
}

static void add_rocket(ld_simulation *self)
{
    add(self, "m", "rocket.s", "travel: rear adaptor's station in the tube");
    add(self, "m", "rocket.y", "rear adaptor's offset from the axis, in S");
    add(self, "m", "rocket.z", "rear adaptor's offset from the axis, in S");
    add(self, "rad", "rocket.psi", "relative pitch: A_SB = Rz(psi) Ry(theta) Rx(gamma)");
    add(self, "rad", "rocket.theta", "relative yaw");
    add(self, "rad", "rocket.gamma", "relative roll");
    add(self, "m/s", "rocket.s_dot", "rate of rocket.s");
    add(self, "m/s", "rocket.y_dot", "rate of rocket.y");
    add(self, "m/s", "rocket.z_dot", "rate of rocket.z");
    add(self, "rad/s", "rocket.w_x", "rate of the rocket against S, in S");
    add(self, "rad/s", "rocket.w_y", "rate of the rocket against S, in S");
    add(self, "rad/s", "rocket.w_z", "rate of the rocket against S, in S");
    add(self, "m/s", "rocket.vx", "inertial velocity of the rear adaptor, in I");
    add(self, "m/s", "rocket.vy", "inertial velocity of the rear adaptor, in I");
    add(self, "m/s", "rocket.vz", "inertial velocity of the rear adaptor, in I");
    add(self, "rad", "rocket.pitch", "pitch of the rocket's axis in I");
    add(self, "rad", "rocket.yaw", "yaw of the rocket's axis in I, positive to the left");
    add(self, "rad/s", "rocket.pitch_rate", "rate of rocket.pitch");
    add(self, "rad/s", "rocket.yaw_rate", "rate of rocket.yaw");
    add(self, "rad/s", "rocket.spin", "rate of the rocket against I about its axis");
    add(self, "kg", "rocket.mass", "instantaneous mass");
    add(self, "N", "thrust", "thrust");
    for (int i = 0; i < self->launching.adaptor_count; i++) {
        const char *name = self->model->rocket.adaptor[i].name;
        add_named(self, "N", "contact.%s.force", "adaptor %s: norm of contact force", name);
        add_named(self, "N", "contact.%s.normal", "adaptor %s: normal force", name);
        add_named(self, "m", "contact.%s.penetration",
                  "adaptor %s: offset less clearance (negative: gap)", name);
        add_named(self, "m", "contact.%s.y", "adaptor %s: offset from the axis", name);
        add_named(self, "m", "contact.%s.z", "adaptor %s: offset from the axis", name);
    }
    add(self, "N", "slot.force", "slot force N on the knob");
    add(self, "N", "slot.friction", "slot friction on the knob, along the slot");
    add(self, "N", "lock.force", "force carried by the lock");
}

void history_build(ld_simulation *self)
{
    add_frames(self);
    add_rocket(self);
    add(self, "J", "energy.kinetic", "kinetic energy of tube, tail and rocket");
    add(self, "J", "energy.potential", "potential energy of tube and tail in gravity");
    add(self, "J", "energy.elastic", "elastic energy of the tube's modes and the supports");
    add(self, "J", "work.thrust", "work of the thrust");
    add(self, "J", "work.gravity_rocket", "work of gravity on the rocket");
    add(self, "J", "work.contact_normal", "work of the normal contact forces");
    add(self, "J", "work.contact_friction", "work of the contact friction");
    add(self, "J", "work.slot", "work of the slot force (zero but for step errors)");
    add(self, "J", "work.slot_friction", "work of the slot friction");
    add(self, "J", "work.lock", "work of the lock (zero but for step errors)");
    add(self, "J", "work.support_damping", "work of the support dampers");
    add(self, "J", "work.modal_damping", "work of the modal damping");
    add(self, "J", "work.base", "work of the moving base through the supports");
    add(self, "J", "work.mass_change", "kinetic energy carried off by burnt propellant");
    add(self, "J", "energy.residual", "what the energy balance misses");
}

size_t ld_history_columns(const ld_simulation *simulation, const ld_column **columns)
{
    *columns = simulation->column;
    return (size_t)simulation->column_count;
}

// ---- rows ----

static double *put(double *to, const double *from, int count)
{
    memcpy(to, from, (size_t)count * sizeof(double));
    return to + count;
}

static double *put_v3(double *to, v3 a)
{
    v3_store(to, a);
    return to + 3;
}

static double phase_number(const ld_simulation *self, double t)
{
    if (!self->phase.rocket)
        return 3;
    if (!self->phase.locked)
        return 2;
    return t < self->t_ignition ? 0 : 1;
}

static double *put_rocket(const ld_simulation *self, const launching_input *input, const double *y,
                          const launching_output *out, double *to)
{
    const launching_layout *at = &self->launching.layout;
    launching_output unused;
    launching_pose pose;
    launching_rocket_pose(&self->launching, y, &pose, &unused);
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 axis = m3_column(pose.A_RB, 0);
    direction_angles angles =
        direction_angles_of(m3_apply(A_IR, axis), m3_apply(A_IR, v3_cross(pose.w_B, axis)));
    to = put(to, y + at->x, 6);
    to = put(to, out->y, 6);
    to = put_v3(to, m3_apply(A_IR, pose.v_O1));
    to = put(to, (double[]){angles.pitch, angles.yaw, angles.pitch_rate, angles.yaw_rate}, 4);
    to = put(to, (double[]){v3_dot(axis, pose.w_B), input->mass.m, input->thrust}, 3);
    for (int i = 0; i < self->launching.adaptor_count; i++) {
        const adaptor_report *adaptor = &out->adaptor[i];
        double values[5] = {adaptor->force, adaptor->normal, adaptor->penetration, adaptor->y,
                            adaptor->z};
        if (self->phase.passed[i]) {
            values[0] = values[1] = 0;
            values[2] = values[3] = values[4] = NAN;
        }
        to = put(to, values, 5);
    }
    return put(to, (double[]){out->N, out->slot_friction, out->lock_force}, 3);
}

void history_row(const ld_simulation *self, double t, const double *y, double energy_start,
                 double *row)
{
    const launching_layout *at = &self->launching.layout;
    launching_input input;
    launching_output out = {0};
    simulation_input(self, t, &input);
    simulation_evaluate(self, &input, &self->phase, y, &out);
    double *to = row, angles[3];
    base_motion_angles(&self->base, t, angles);
    to = put(to, (double[]){t, phase_number(self, t)}, 2);
    to = put_v3(to, input.base.r);
    to = put(to, angles, 3);
    to = put(to, y + at->r, 13);
    to = put(to, y + at->q, 2 * at->nq);
    tip_state tip = tip_state_of(self, &input.base, y);
    to = put(to,
             (double[]){tip.offset.y, tip.offset.z, tip.angles.pitch, tip.angles.yaw,
                        tip.offset_dot.y, tip.offset_dot.z, tip.angles.pitch_rate,
                        tip.angles.yaw_rate},
             8);
    if (self->phase.rocket)
        to = put_rocket(self, &input, y, &out, to);
    else
        for (int i = 0; i < 25 + 5 * self->launching.adaptor_count; i++)
            *to++ = NAN;
    ld_energy energy;
    simulation_energy(self, &input, &out, y, energy_start, &energy);
    to = put(to, (double[]){energy.kinetic, energy.potential, energy.elastic}, 3);
    to = put(to, y + self->work, POWER_COUNT);
    *to = energy.residual;
}
