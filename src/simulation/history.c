// The history of a launch: columns and rows; energies.
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "model/salvo.h"
#include "simulation/launch_state.h"

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

tip_state tip_state_of(const launch_state *self, const base_frame *base, const double *y)
{
    const launching_system *launching = &self->launcher.launching;
    const launching_layout *at = &launching->layout;
    launching_section tip;
    double length = launching->tube.flexible.length;
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

// The works in the order of the state; those of a vehicle may be missing.
static ld_work works(const double *work, bool vehicle)
{
    ld_work all = {.thrust = work[POWER_THRUST],
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
    if (!vehicle)
        return all;
    const double *orientating = work + POWER_COUNT, *marching = orientating + ORIENTATING_POWERS;
    all.stabilisers = orientating[ORIENTATING_STABILISER];
    all.hinge_friction = orientating[ORIENTATING_FRICTION];
    all.gravity_platform = orientating[ORIENTATING_GRAVITY];
    all.gravity_wheels = marching[MARCHING_GRAVITY];
    all.suspension_damping = marching[MARCHING_SUSPENSION];
    all.tyre = marching[MARCHING_TYRE];
    all.tyre_side = marching[MARCHING_SIDE];
    all.drive = marching[MARCHING_DRIVE];
    return all;
}

void simulation_energy(const launch_state *self, const launcher_input *input,
                       const launcher_output *out, const double *y, double energy_start,
                       ld_energy *energy)
{
    const launcher_system *launcher = &self->launcher;
    const double *work = y + launcher->work_at;
    double sum = 0, largest = 0;
    for (int i = 0; i < launcher->work_count; i++) {
        // between a base that moves with it and the tube nothing is lost
        if (launcher->base.kind->dynamics && i == POWER_BASE)
            continue;
        sum += work[i];
        largest = fmax(largest, fabs(work[i]));
    }
    energy->kinetic = launcher_kinetic_energy(launcher, input, &self->phase, y);
    energy->potential = launching_potential_energy(&launcher->launching, y);
    energy->elastic = launcher_elastic_energy(launcher, out);
    energy->work = works(work, base_as_vehicle(&launcher->base) != NULL);
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
    for (int i = 1; i <= self->launcher.launching.layout.nq; i++) {
        snprintf(number, sizeof number, "%d", i);
        add_named(self, "kg0.5.m", "q%s", "modal coordinate %s (bending y, z, torsion, axial)",
                  number);
    }
    for (int i = 1; i <= self->launcher.launching.layout.nq; i++) {
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
    add(self, "m", "tip.inertial_x", "tip in I");
    add(self, "m", "tip.inertial_y", "tip in I");
    add(self, "m", "tip.inertial_z", "tip in I");
    add(self, "m/s", "tip.inertial_vx", "velocity of the tip, in I");
    add(self, "m/s", "tip.inertial_vy", "velocity of the tip, in I");
    add(self, "m/s", "tip.inertial_vz", "velocity of the tip, in I");
    add(self, "rad", "tip.inertial_pitch", "tip's axis in I: pitch");
    add(self, "rad", "tip.inertial_yaw", "tip's axis in I: yaw, positive to the left");
    add(self, "rad/s", "tip.inertial_pitch_rate", "rate of tip.inertial_pitch");
    add(self, "rad/s", "tip.inertial_yaw_rate", "rate of tip.inertial_yaw");
}

static void add_hinge(ld_simulation *self, const char *part)
{
    add_named(self, "rad", "%s.angle", "%s hinge: angle", part);
    add_named(self, "rad/s", "%s.rate", "%s hinge: rate of the angle", part);
    add_named(self, "rad", "%s.measured", "%s: yaw or pitch of the elevation platform in I", part);
    add_named(self, "rad", "%s.command", "%s: commanded yaw or pitch", part);
    add_named(self, "rad", "%s.error", "%s: command less measured", part);
    add_named(self, "N.m", "%s.torque", "%s: torque of stabiliser or lock", part);
    add_named(self, "N.m", "%s.friction", "%s: friction in the hinge", part);
}

static void add_wheel(ld_simulation *self, const char *name)
{
    add_named(self, "m", "wheel.%s.x", "wheel %s: centre in I", name);
    add_named(self, "m", "wheel.%s.y", "wheel %s: centre in I", name);
    add_named(self, "m", "wheel.%s.z", "wheel %s: centre in I", name);
    add_named(self, "m", "wheel.%s.road", "wheel %s: height of the road under it", name);
    add_named(self, "m", "wheel.%s.travel",
              "wheel %s: suspension travel along the chassis' y, from unloaded", name);
    add_named(self, "m", "wheel.%s.deflection", "wheel %s: tyre deflection", name);
    add_named(self, "N", "wheel.%s.tyre_force", "wheel %s: vertical tyre force", name);
    add_named(self, "N", "wheel.%s.along", "wheel %s: tyre force along the way", name);
    add_named(self, "N", "wheel.%s.side", "wheel %s: tyre force across the way", name);
}

static void add_vehicle(ld_simulation *self)
{
    add(self, "m", "chassis.x", "chassis: mass centre in I");
    add(self, "m", "chassis.y", "chassis: mass centre in I");
    add(self, "m", "chassis.z", "chassis: mass centre in I");
    add(self, "rad", "chassis.yaw", "chassis: yaw of Ry(yaw) Rz(pitch) Rx(roll)");
    add(self, "rad", "chassis.pitch", "chassis: pitch");
    add(self, "rad", "chassis.roll", "chassis: roll");
    add(self, "m/s", "chassis.vx", "chassis: velocity of its mass centre in I");
    add(self, "m/s", "chassis.vy", "chassis: velocity of its mass centre in I");
    add(self, "m/s", "chassis.vz", "chassis: velocity of its mass centre in I");
    add(self, "rad/s", "chassis.wx", "chassis: angular velocity in its own axes");
    add(self, "rad/s", "chassis.wy", "chassis: angular velocity in its own axes");
    add(self, "rad/s", "chassis.wz", "chassis: angular velocity in its own axes");
    add_hinge(self, "azimuth");
    add_hinge(self, "elevation");
    add(self, "m/s", "drive.speed", "speed of the chassis along its heading");
    add(self, "N", "drive.force", "drive force of all driven wheels");
    for (int j = 0; j < self->model->base.vehicle.wheel_count; j++)
        add_wheel(self, self->model->base.vehicle.wheel[j].name);
}

// In T, the axes of the undeformed tube on its base; "aim": as they stood at the ignition.
static void add_against_launcher(ld_simulation *self)
{
    add(self, "rad", "tip_off.pitch", "rocket's axis in T: pitch");
    add(self, "rad", "tip_off.yaw", "rocket's axis in T: yaw, positive to the left");
    add(self, "rad/s", "tip_off.pitch_rate", "rate of tip_off.pitch, T held still");
    add(self, "rad/s", "tip_off.yaw_rate", "rate of tip_off.yaw, T held still");
    add(self, "rad/s", "tip_off.pitch_rate_relative", "rate of tip_off.pitch, T moving");
    add(self, "rad/s", "tip_off.yaw_rate_relative", "rate of tip_off.yaw, T moving");
    add(self, "m/s", "tip_off.vy", "inertial velocity of the mass centre along T's y");
    add(self, "m/s", "tip_off.vz", "inertial velocity of the mass centre along T's z");
    add(self, "m/s", "tip_off.vy_relative", "velocity of the mass centre against T, its y");
    add(self, "m/s", "tip_off.vz_relative", "velocity of the mass centre against T, its z");
    add(self, "rad", "aim.pitch", "rocket's axis in T of the ignition: pitch");
    add(self, "rad", "aim.yaw", "rocket's axis in T of the ignition: yaw");
    add(self, "rad/s", "aim.pitch_rate", "rate of aim.pitch");
    add(self, "rad/s", "aim.yaw_rate", "rate of aim.yaw");
    add(self, "m/s", "aim.vy", "inertial velocity of the mass centre along y of that T");
    add(self, "m/s", "aim.vz", "inertial velocity of the mass centre along z of that T");
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
    add(self, "rad/s", "rocket.psi_dot", "rate of rocket.psi");
    add(self, "rad/s", "rocket.theta_dot", "rate of rocket.theta");
    add(self, "rad/s", "rocket.gamma_dot", "rate of rocket.gamma");
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
    add_against_launcher(self);
    add(self, "kg", "rocket.mass", "instantaneous mass");
    add(self, "N", "thrust", "thrust");
    for (int i = 0; i < self->launcher.launching.adaptors.count; i++) {
        const char *name = salvo_rocket(self->model, 0)->adaptor[i].name;
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
    add(self, "N", "breech.force", "force of the breech on the rocket");
}

void history_build(ld_simulation *self)
{
    add_frames(self);
    self->rocket_columns = -self->column_count;
    add_rocket(self);
    self->rocket_columns += self->column_count;
    if (base_as_vehicle(&self->launcher.base))
        add_vehicle(self);
    add(self, "J", "energy.kinetic", "kinetic energy of tube, tail and rocket, and of the vehicle");
    add(self, "J", "energy.potential", "potential energy of tube and tail in gravity");
    add(self, "J", "energy.elastic", "elastic energy of modes, supports and suspensions");
    add(self, "J", "work.thrust", "work of the thrust");
    add(self, "J", "work.gravity_rocket", "work of gravity on the rocket");
    add(self, "J", "work.contact_normal", "work of the normal forces of adaptors and breech");
    add(self, "J", "work.contact_friction", "work of the contact friction");
    add(self, "J", "work.slot", "work of the slot force (zero but for step errors)");
    add(self, "J", "work.slot_friction", "work of the slot friction");
    add(self, "J", "work.lock", "work of the lock (zero but for step errors)");
    add(self, "J", "work.support_damping", "work of the support dampers");
    add(self, "J", "work.modal_damping", "work of the modal damping");
    add(self, "J", "work.base", "work of the moving base through the supports");
    add(self, "J", "work.mass_change", "kinetic energy carried off by burnt propellant");
    if (base_as_vehicle(&self->launcher.base)) {
        add(self, "J", "work.stabilisers", "work of the stabilisers or locks");
        add(self, "J", "work.hinge_friction", "work of the friction in the hinges");
        add(self, "J", "work.gravity_platform", "work of gravity on chassis and platforms");
        add(self, "J", "work.gravity_wheels", "work of gravity on the wheels");
        add(self, "J", "work.suspension_damping", "work of the suspension dampers");
        add(self, "J", "work.tyre", "work of the road's normal forces on the wheels");
        add(self, "J", "work.tyre_side", "work of side forces, and of those that hold it parked");
        add(self, "J", "work.drive", "work of the road on driven wheels");
    }
    add(self, "J", "energy.residual", "what the energy balance misses");
}

size_t ld_simulation_columns(const ld_simulation *simulation, const ld_column **columns)
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

static double phase_number(const launch_state *self, double t)
{
    if (!self->phase.rocket)
        return 3;
    if (!self->phase.locked)
        return 2;
    return t < self->t_ignition ? 0 : 1;
}

static double *put_tip(const launch_state *self, const base_frame *base, const double *y,
                       double *to)
{
    tip_state tip = tip_state_of(self, base, y);
    to = put(to,
             (double[]){tip.offset.y, tip.offset.z, tip.angles.pitch, tip.angles.yaw,
                        tip.offset_dot.y, tip.offset_dot.z, tip.angles.pitch_rate,
                        tip.angles.yaw_rate},
             8);
    const launching_system *launching = &self->launcher.launching;
    launching_section section;
    launching_section_at(launching, y, launching->tube.flexible.length, &section);
    m3 A_IR = q_matrix(q_from(y + launching->layout.quaternion));
    v3 axis = m3_column(section.A, 0);
    direction_angles angles =
        direction_angles_of(m3_apply(A_IR, axis), m3_apply(A_IR, v3_cross(section.w, axis)));
    to = put_v3(to, v3_add(v3_from(y + launching->layout.r), m3_apply(A_IR, section.P)));
    to = put_v3(to, m3_apply(A_IR, section.v));
    return put(to, (double[]){angles.pitch, angles.yaw, angles.pitch_rate, angles.yaw_rate}, 4);
}

static double *put_vehicle(const launch_state *self, const launcher_input *input, const double *y,
                           const launcher_output *out, double *to)
{
    const double *base = y + self->launcher.base_at, *wheel = base + VEHICLE_MARCHING;
    const marching_output *marching = &out->base.report.vehicle.marching;
    to = put(to, base + ORIENTATING_R, 3);
    m3_yaw_pitch_roll(&input->found.vehicle.chassis.A, to);
    to += 3;
    to = put(to, base + ORIENTATING_V, 6);
    for (int i = 0; i < HINGES; i++) {
        const hinge_report *hinge = &out->base.report.vehicle.hinge[i];
        to = put(to,
                 (double[]){hinge->angle, hinge->rate, hinge->measured, hinge->command,
                            hinge->error, hinge->torque, hinge->friction},
                 7);
    }
    to = put(to, (double[]){marching->speed, marching->drive_force}, 2);
    for (int j = 0; j < self->model->base.vehicle.wheel_count; j++, wheel += WHEEL_STATES) {
        const wheel_report *report = &marching->wheel[j];
        to = put(to, wheel + WHEEL_R, 3);
        to = put(to,
                 (double[]){report->height, report->travel.y, report->deflection, report->normal,
                            report->along, report->side},
                 6);
    }
    return to;
}

static double *put_against_launcher(const launch_state *self, double t,
                                    const launching_input *input, const rocket_motion *rocket,
                                    double *to)
{
    ld_tip_off off = tip_off_of(&input->base, rocket);
    ld_aim aim = aim_of(self, t, rocket);
    to = put(to,
             (double[]){off.pitch, off.yaw, off.pitch_rate, off.yaw_rate, off.pitch_rate_relative,
                        off.yaw_rate_relative, off.vy, off.vz, off.vy_relative, off.vz_relative},
             10);
    return put(to, (double[]){aim.pitch, aim.yaw, aim.pitch_rate, aim.yaw_rate, aim.vy, aim.vz}, 6);
}

static double *put_rocket(const launch_state *self, double t, const launching_input *input,
                          const double *y, const launching_output *out, double *to)
{
    const launching_layout *at = &self->launcher.launching.layout;
    launching_output unused;
    launching_pose pose;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 axis = m3_column(pose.A_RB, 0);
    direction_angles angles =
        direction_angles_of(m3_apply(A_IR, axis), m3_apply(A_IR, v3_cross(pose.w_B, axis)));
    to = put(to, y + at->x, 6);
    to = put(to, out->y, 3);
    to = put(to, out->x_dot + 3, 3);
    to = put(to, out->y + 3, 3);
    to = put_v3(to, m3_apply(A_IR, pose.v_O1));
    to = put(to, (double[]){angles.pitch, angles.yaw, angles.pitch_rate, angles.yaw_rate}, 4);
    *to++ = v3_dot(axis, pose.w_B);
    rocket_motion motion = rocket_motion_of(&pose, input->mass.c, y, at);
    to = put_against_launcher(self, t, input, &motion, to);
    to = put(to, (double[]){input->mass.m, input->thrust}, 2);
    for (int i = 0; i < self->launcher.launching.adaptors.count; i++) {
        const adaptor_report *adaptor = &out->adaptor[i];
        double values[5] = {adaptor->force, adaptor->normal, adaptor->penetration, adaptor->y,
                            adaptor->z};
        if (self->phase.passed[i]) {
            values[0] = values[1] = 0;
            values[2] = values[3] = values[4] = NAN;
        }
        to = put(to, values, 5);
    }
    return put(to, (double[]){out->N, out->slot_friction, out->lock_force, out->breech_force}, 4);
}

void history_row(const launch_state *self, double t, const double *y, double energy_start,
                 double *row)
{
    const launching_layout *at = &self->launcher.launching.layout;
    launcher_input input;
    launcher_output out = {0};
    simulation_input(self, t, y, &input);
    launcher_evaluate(&self->launcher, &input, &self->phase, y, &out);
    const base_frame *base = &input.launching.base;
    double *to = row;
    to = put(to, (double[]){t, phase_number(self, t)}, 2);
    to = put_v3(to, base->r);
    base_angles(&self->launcher.base, t, base, to);
    to += 3;
    to = put(to, y + at->r, 13);
    to = put(to, y + at->q, 2 * at->nq);
    to = put_tip(self, base, y, to);
    if (self->phase.rocket)
        to = put_rocket(self, t, &input.launching, y, &out.launching, to);
    else
        for (int i = 0; i < self->system->rocket_columns; i++)
            *to++ = NAN;
    if (base_as_vehicle(&self->launcher.base))
        to = put_vehicle(self, &input, y, &out, to);
    ld_energy energy;
    simulation_energy(self, &input, &out, y, energy_start, &energy);
    to = put(to, (double[]){energy.kinetic, energy.potential, energy.elastic}, 3);
    to = put(to, y + self->launcher.work_at, self->launcher.work_count);
    *to = energy.residual;
}
