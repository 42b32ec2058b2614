// The history of a launch: what is found at an instant, and the quantities that stand in it, each
// of them a column.
#include "state/history.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "model/blocks/tubes.h"
#include "model/parts.h"
#include "quantities/quantity_table.h"
#include "state/energy.h"
#include "state/evaluation.h"
#include "state/exit_figures.h"
#include "state/launch_state.h"
#include "systems/launching/launching_figures.h"
#include "systems/launching/launching_kinematics.h"

// What belongs to one adaptor; nothing touches where it has passed the tip.
typedef struct instant_contact {
    double force, normal, penetration, y, z;
} instant_contact;

typedef struct launch_instant {
    double t, phase;
    launcher_input input;
    launcher_output out;
    double base[3];  // yaw, pitch, roll of Ry(yaw) Rz(pitch) Rx(roll)
    double tube[13]; // r, quaternion, v, w of the state
    double q[LD_MAX_MODAL], q_dot[LD_MAX_MODAL];
    tip_state tip;
    struct {
        v3 r, v;
        direction_angles angles;
    } tip_inertial;
    bool rocket;       // in its tube: what follows is there
    double x[X_COUNT]; // of the state; s at most the tube's length
    v3 v_O1;           // in I
    direction_angles angles;
    double spin;
    v3 w, w_dot, force; // against I, in B; force: specific, at O1
    rocket_motion motion;
    ld_tip_off tip_off;
    ld_since_ignition since_ignition;
    instant_contact contact[LD_MAX_ADAPTORS];
    struct {
        double force_y, force_z, moment;
    } shoe[LD_MAX_ADAPTORS];
    launching_loads loads;
    body_instant section[LD_MAX_STATIONS]; // at each station
    base_instant of_base;
    ld_energy energy;
} launch_instant;

// ---- quantities ----

#define AT(member) .at = QUANTITY_AT(launch_instant, member)
#define EACH(array, member) .at = QUANTITY_OF_EACH(launch_instant, array, member)
#define ITEM(array) .at = QUANTITY_EACH_OF(launch_instant, array)
#define CARRIED(member) EACH(loads.station, member)
#define REACTION(member) EACH(loads.support, member)

// clang-format off
static const quantity frames[] = {
    {"t", "s", "time on the run's clock", AT(t)},
    {"phase", "1", "0 locked before ignition, 1 after it, 2 free in the tube, 3 tube alone", AT(phase)},
    {"base.x", "m", "undeformed tube's rear end, in I", AT(input.launching.base.r.x)},
    {"base.y", "m", "undeformed tube's rear end, in I", AT(input.launching.base.r.y)},
    {"base.z", "m", "undeformed tube's rear end, in I", AT(input.launching.base.r.z)},
    {"base.yaw", "rad", "base: yaw of Ry(yaw) Rz(pitch) Rx(roll)", AT(base[0])},
    {"base.pitch", "rad", "base: pitch", AT(base[1])},
    {"base.roll", "rad", "base: roll", AT(base[2])},
    {"tube.x", "m", "floating frame R: origin in I", AT(tube[0])},
    {"tube.y", "m", "floating frame R: origin in I", AT(tube[1])},
    {"tube.z", "m", "floating frame R: origin in I", AT(tube[2])},
    {"tube.q0", "1", "quaternion of R against I, scalar part first", AT(tube[3])},
    {"tube.q1", "1", "quaternion of R against I, scalar part first", AT(tube[4])},
    {"tube.q2", "1", "quaternion of R against I, scalar part first", AT(tube[5])},
    {"tube.q3", "1", "quaternion of R against I, scalar part first", AT(tube[6])},
    {"tube.vx", "m/s", "inertial velocity of R's origin, in R", AT(tube[7])},
    {"tube.vy", "m/s", "inertial velocity of R's origin, in R", AT(tube[8])},
    {"tube.vz", "m/s", "inertial velocity of R's origin, in R", AT(tube[9])},
    {"tube.wx", "rad/s", "angular velocity of R against I, in R", AT(tube[10])},
    {"tube.wy", "rad/s", "angular velocity of R against I, in R", AT(tube[11])},
    {"tube.wz", "rad/s", "angular velocity of R against I, in R", AT(tube[12])},
};
static const quantity coordinates[] = {
    {"q%s", "kg0.5.m", "modal coordinate %s (bending y, z, torsion, axial)", ITEM(q)},
};
static const quantity coordinate_rates[] = {
    {"q%s_dot", "kg0.5.m/s", "rate of modal coordinate %s", ITEM(q_dot)},
};
static const quantity tip[] = {
    {"tip.y", "m", "tip against the undeformed tube, in its axes", AT(tip.offset.y)},
    {"tip.z", "m", "tip against the undeformed tube, in its axes", AT(tip.offset.z)},
    {"tip.pitch", "rad", "tip's axis against the undeformed tube: pitch", AT(tip.angles.pitch)},
    {"tip.yaw", "rad", "tip's axis against the undeformed tube: yaw", AT(tip.angles.yaw)},
    {"tip.vy", "m/s", "rate of tip.y", AT(tip.offset_dot.y)},
    {"tip.vz", "m/s", "rate of tip.z", AT(tip.offset_dot.z)},
    {"tip.pitch_rate", "rad/s", "rate of tip.pitch", AT(tip.angles.pitch_rate)},
    {"tip.yaw_rate", "rad/s", "rate of tip.yaw", AT(tip.angles.yaw_rate)},
    {"tip.inertial_x", "m", "tip in I", AT(tip_inertial.r.x)},
    {"tip.inertial_y", "m", "tip in I", AT(tip_inertial.r.y)},
    {"tip.inertial_z", "m", "tip in I", AT(tip_inertial.r.z)},
    {"tip.inertial_vx", "m/s", "velocity of the tip, in I", AT(tip_inertial.v.x)},
    {"tip.inertial_vy", "m/s", "velocity of the tip, in I", AT(tip_inertial.v.y)},
    {"tip.inertial_vz", "m/s", "velocity of the tip, in I", AT(tip_inertial.v.z)},
    {"tip.inertial_pitch", "rad", "tip's axis in I: pitch", AT(tip_inertial.angles.pitch)},
    {"tip.inertial_yaw", "rad", "tip's axis in I: yaw, positive to the left", AT(tip_inertial.angles.yaw)},
    {"tip.inertial_pitch_rate", "rad/s", "rate of tip.inertial_pitch", AT(tip_inertial.angles.pitch_rate)},
    {"tip.inertial_yaw_rate", "rad/s", "rate of tip.inertial_yaw", AT(tip_inertial.angles.yaw_rate)},
};
static const quantity rocket[] = {
    {"rocket.s", "m", "travel: rear adaptor's station in the tube", AT(x[X_S])},
    {"rocket.y", "m", "rear adaptor's offset from the axis, in S", AT(x[X_Y])},
    {"rocket.z", "m", "rear adaptor's offset from the axis, in S", AT(x[X_Z])},
    {"rocket.psi", "rad", "relative pitch: A_SB = Rz(psi) Ry(theta) Rx(gamma)", AT(x[X_PSI])},
    {"rocket.theta", "rad", "relative yaw", AT(x[X_THETA])},
    {"rocket.gamma", "rad", "relative roll", AT(x[X_GAMMA])},
    {"rocket.s_dot", "m/s", "rate of rocket.s", AT(out.launching.x_dot[X_S])},
    {"rocket.y_dot", "m/s", "rate of rocket.y", AT(out.launching.x_dot[X_Y])},
    {"rocket.z_dot", "m/s", "rate of rocket.z", AT(out.launching.x_dot[X_Z])},
    {"rocket.psi_dot", "rad/s", "rate of rocket.psi", AT(out.launching.x_dot[X_PSI])},
    {"rocket.theta_dot", "rad/s", "rate of rocket.theta", AT(out.launching.x_dot[X_THETA])},
    {"rocket.gamma_dot", "rad/s", "rate of rocket.gamma", AT(out.launching.x_dot[X_GAMMA])},
    {"rocket.w_x", "rad/s", "rate of the rocket against S, in S", AT(out.launching.y[3])},
    {"rocket.w_y", "rad/s", "rate of the rocket against S, in S", AT(out.launching.y[4])},
    {"rocket.w_z", "rad/s", "rate of the rocket against S, in S", AT(out.launching.y[5])},
    {"rocket.vx", "m/s", "inertial velocity of the rear adaptor, in I", AT(v_O1.x)},
    {"rocket.vy", "m/s", "inertial velocity of the rear adaptor, in I", AT(v_O1.y)},
    {"rocket.vz", "m/s", "inertial velocity of the rear adaptor, in I", AT(v_O1.z)},
    {"rocket.pitch", "rad", "pitch of the rocket's axis in I", AT(angles.pitch)},
    {"rocket.yaw", "rad", "yaw of the rocket's axis in I, positive to the left", AT(angles.yaw)},
    {"rocket.pitch_rate", "rad/s", "rate of rocket.pitch", AT(angles.pitch_rate)},
    {"rocket.yaw_rate", "rad/s", "rate of rocket.yaw", AT(angles.yaw_rate)},
    {"rocket.spin", "rad/s", "rate of the rocket against I about its axis", AT(spin)},
    {"center.x", "m", "mass centre, in I", AT(motion.r_C.x)},
    {"center.y", "m", "mass centre, in I", AT(motion.r_C.y)},
    {"center.z", "m", "mass centre, in I", AT(motion.r_C.z)},
    {"center.vx", "m/s", "inertial velocity of the mass centre, in I", AT(motion.v_C.x)},
    {"center.vy", "m/s", "inertial velocity of the mass centre, in I", AT(motion.v_C.y)},
    {"center.vz", "m/s", "inertial velocity of the mass centre, in I", AT(motion.v_C.z)},
};
// What inertial sensors read: docs/compare.md.
static const quantity inertial[] = {
    {"rocket.wx", "rad/s", "rate of the rocket against I, in B", AT(w.x)},
    {"rocket.wy", "rad/s", "rate of the rocket against I, in B", AT(w.y)},
    {"rocket.wz", "rad/s", "rate of the rocket against I, in B", AT(w.z)},
    {"rocket.wx_dot", "rad/s2", "rate of rocket.wx", AT(w_dot.x)},
    {"rocket.wy_dot", "rad/s2", "rate of rocket.wy", AT(w_dot.y)},
    {"rocket.wz_dot", "rad/s2", "rate of rocket.wz", AT(w_dot.z)},
    {"rocket.fx", "m/s2", "specific force (acceleration less gravity) at the rear adaptor, in B", AT(force.x)},
    {"rocket.fy", "m/s2", "specific force (acceleration less gravity) at the rear adaptor, in B", AT(force.y)},
    {"rocket.fz", "m/s2", "specific force (acceleration less gravity) at the rear adaptor, in B", AT(force.z)},
};
// tip_off: in T, the axes of the undeformed tube on its base; since_ignition: in T as it stood at
// the ignition.
static const quantity against_launcher[] = {
    {"since_ignition.pitch", "rad", "launcher's axes at ignition: pitch of the rocket's axis", AT(since_ignition.pitch)},
    {"since_ignition.yaw", "rad", "launcher's axes at ignition: yaw of the rocket's axis, positive to the left", AT(since_ignition.yaw)},
    {"since_ignition.roll", "rad", "launcher's axes at ignition: roll of Ry(yaw) Rz(pitch) Rx(roll), whole turns counted", AT(since_ignition.roll)},
    {"since_ignition.pitch_rate", "rad/s", "rate of since_ignition.pitch", AT(since_ignition.pitch_rate)},
    {"since_ignition.yaw_rate", "rad/s", "rate of since_ignition.yaw", AT(since_ignition.yaw_rate)},
    {"since_ignition.roll_rate", "rad/s", "rate of since_ignition.roll", AT(since_ignition.roll_rate)},
    {"since_ignition.vy", "m/s", "launcher's axes at ignition: inertial velocity of the mass centre along y", AT(since_ignition.vy)},
    {"since_ignition.vz", "m/s", "launcher's axes at ignition: inertial velocity of the mass centre along z", AT(since_ignition.vz)},
    {"tip_off.pitch", "rad", "rocket's axis in T: pitch", AT(tip_off.pitch)},
    {"tip_off.yaw", "rad", "rocket's axis in T: yaw, positive to the left", AT(tip_off.yaw)},
    {"tip_off.pitch_rate", "rad/s", "rate of tip_off.pitch, T held still", AT(tip_off.pitch_rate)},
    {"tip_off.yaw_rate", "rad/s", "rate of tip_off.yaw, T held still", AT(tip_off.yaw_rate)},
    {"tip_off.pitch_rate_relative", "rad/s", "rate of tip_off.pitch, T moving", AT(tip_off.pitch_rate_relative)},
    {"tip_off.yaw_rate_relative", "rad/s", "rate of tip_off.yaw, T moving", AT(tip_off.yaw_rate_relative)},
    {"tip_off.vy", "m/s", "inertial velocity of the mass centre along T's y", AT(tip_off.vy)},
    {"tip_off.vz", "m/s", "inertial velocity of the mass centre along T's z", AT(tip_off.vz)},
    {"tip_off.vy_relative", "m/s", "velocity of the mass centre against T, its y", AT(tip_off.vy_relative)},
    {"tip_off.vz_relative", "m/s", "velocity of the mass centre against T, its z", AT(tip_off.vz_relative)},
};
static const quantity motor_now[] = {
    {"rocket.mass", "kg", "instantaneous mass", AT(input.launching.mass.m)},
    {"thrust", "N", "thrust", AT(input.launching.thrust)},
};
static const quantity contacts[] = {
    {"contact.%s.force", "N", "adaptor %s: norm of contact force", EACH(contact, force)},
    {"contact.%s.normal", "N", "adaptor %s: normal force, of several surfaces their sum", EACH(contact, normal)},
    {"contact.%s.penetration", "m", "adaptor %s: offset minus clearance (negative: gap), of several surfaces the deepest", EACH(contact, penetration)},
    {"contact.%s.y", "m", "adaptor %s: offset from the axis, or from the guide line", EACH(contact, y)},
    {"contact.%s.z", "m", "adaptor %s: offset from the axis, or from the guide line", EACH(contact, z)},
};
// In the axes of the section at the shoe's foot.
static const quantity shoes[] = {
    {"shoe.%s.force_y", "N", "shoe %s: force of the guide on the rocket, along y of the section", EACH(shoe, force_y)},
    {"shoe.%s.force_z", "N", "shoe %s: force of the guide on the rocket, along z of the section", EACH(shoe, force_z)},
    {"shoe.%s.moment", "N.m", "shoe %s: moment of the guide on the rocket about the guide line", EACH(shoe, moment)},
};
static const quantity knob[] = {
    {"slot.force", "N", "slot force N on the knob", AT(out.launching.N)},
    {"slot.friction", "N", "slot friction on the knob, along the slot", AT(out.launching.slot_friction)},
};
static const quantity guidance[] = {
    {"lock.force", "N", "force carried by the lock", AT(out.launching.lock_force)},
    {"breech.force", "N", "force of the breech on the rocket", AT(out.launching.breech_force)},
};
// In the axes of the floating frame.
static const quantity crossflow[] = {
    {"crossflow.length", "m", "length of the rocket that is out of the tube", AT(out.launching.emerged)},
    {"crossflow.y", "N", "force of the air on it, along y of R", AT(out.launching.crossflow.y)},
    {"crossflow.z", "N", "force of the air on it, along z of R", AT(out.launching.crossflow.z)},
};
static const quantity open_air[] = {
    {"air.mach", "1", "Mach number of the mass centre through the air", AT(out.launching.air_mach)},
    {"air.x", "N", "force of the air on the rocket, along x of R", AT(out.launching.air_force.x)},
    {"air.y", "N", "force of the air on the rocket, along y of R", AT(out.launching.air_force.y)},
    {"air.z", "N", "force of the air on the rocket, along z of R", AT(out.launching.air_force.z)},
    {"air.moment_x", "N.m", "moment of the air about the mass centre, about x of R", AT(out.launching.air_moment.x)},
    {"air.moment_y", "N.m", "moment of the air about the mass centre, about y of R", AT(out.launching.air_moment.y)},
    {"air.moment_z", "N.m", "moment of the air about the mass centre, about z of R", AT(out.launching.air_moment.z)},
};
static const quantity pressures[] = {
    {"pressure.net", "Pa", "pressure behind the rocket minus that before it", AT(out.launching.pressure)},
    {"pressure.force", "N", "its force on the rocket along the tube", AT(out.launching.pressure_force)},
};
static const quantity slides[] = {
    {"recoil.%s.travel", "m", "recoil slide %s: travel back from the front stop", EACH(out.launching.slide, travel)},
    {"recoil.%s.rate", "m/s", "recoil slide %s: rate of that", EACH(out.launching.slide, rate)},
    {"recoil.%s.force", "N", "recoil slide %s: force on the tube, forwards", EACH(out.launching.slide, force)},
};
// Of the part beyond the station on the part behind it, in the axes of the section there.
static const quantity stations[] = {
    {"station.%s.axial", "N", "station %s: axial force carried, tension positive", CARRIED(wrench.f.x)},
    {"station.%s.shear_y", "N", "station %s: shear force carried, along y of the section", CARRIED(wrench.f.y)},
    {"station.%s.shear_z", "N", "station %s: shear force carried, along z of the section", CARRIED(wrench.f.z)},
    {"station.%s.torque", "N.m", "station %s: torque carried", CARRIED(wrench.m.x)},
    {"station.%s.bending_y", "N.m", "station %s: bending moment about y (-E I u_z'')", CARRIED(wrench.m.y)},
    {"station.%s.bending_z", "N.m", "station %s: bending moment about z (E I u_y'')", CARRIED(wrench.m.z)},
    {"station.%s.bending", "N.m", "station %s: magnitude of the bending moment", CARRIED(bending)},
    {"station.%s.stress", "Pa", "station %s: largest bending stress, where the outer fibre is known", CARRIED(stress)},
    {"station.%s.strain", "1", "station %s: strain of the elastic axis", CARRIED(strain)},
    {"station.%s.curvature_y", "1/m", "station %s: curvature u_y''", CARRIED(curvature_y)},
    {"station.%s.curvature_z", "1/m", "station %s: curvature u_z''", CARRIED(curvature_z)},
};
static const quantity sections[] = {
    {"station.%s.x", "m", "section at station %s: axis in I", EACH(section, r[0])},
    {"station.%s.y", "m", "section at station %s: axis in I", EACH(section, r[1])},
    {"station.%s.z", "m", "section at station %s: axis in I", EACH(section, r[2])},
    {"station.%s.yaw", "rad", "section at station %s: yaw of Ry(yaw) Rz(pitch) Rx(roll)", EACH(section, angles[0])},
    {"station.%s.pitch", "rad", "section at station %s: pitch", EACH(section, angles[1])},
    {"station.%s.roll", "rad", "section at station %s: roll", EACH(section, angles[2])},
    {"station.%s.vx", "m/s", "section at station %s: velocity of the axis in I", EACH(section, v[0])},
    {"station.%s.vy", "m/s", "section at station %s: velocity of the axis in I", EACH(section, v[1])},
    {"station.%s.vz", "m/s", "section at station %s: velocity of the axis in I", EACH(section, v[2])},
    {"station.%s.wx", "rad/s", "section at station %s: angular velocity against I in its own axes", EACH(section, w[0])},
    {"station.%s.wy", "rad/s", "section at station %s: angular velocity against I in its own axes", EACH(section, w[1])},
    {"station.%s.wz", "rad/s", "section at station %s: angular velocity against I in its own axes", EACH(section, w[2])},
};
// On the tube, in the axes of the undeformed tube on its base.
static const quantity reactions[] = {
    {"support.%s.force_x", "N", "support %s: force on the tube, along the undeformed tube", REACTION(f.x)},
    {"support.%s.force_y", "N", "support %s: force on the tube, along y", REACTION(f.y)},
    {"support.%s.force_z", "N", "support %s: force on the tube, along z", REACTION(f.z)},
    {"support.%s.moment_x", "N.m", "support %s: moment on the tube at its station, about x", REACTION(m.x)},
    {"support.%s.moment_y", "N.m", "support %s: moment on the tube at its station, about y", REACTION(m.y)},
    {"support.%s.moment_z", "N.m", "support %s: moment on the tube at its station, about z", REACTION(m.z)},
};
static const quantity energies[] = {
    {"energy.kinetic", "J", "kinetic energy of tube, tail and rocket, and of the vehicle", AT(energy.kinetic)},
    {"energy.potential", "J", "potential energy of tube and tail in gravity", AT(energy.potential)},
    {"energy.elastic", "J", "elastic energy of modes, supports and suspensions", AT(energy.elastic)},
};
static const quantity drawn[] = {
    {"line.tension", "N", "pull of the line on the rocket", AT(out.launching.line_tension)},
    {"line.paid_out", "m", "length that has left the container", AT(out.launching.line_paid)},
};
static const quantity blown[] = {
    {"guide_wind.x", "N", "force of the wind on the guide, along x of R", AT(out.launching.guide_wind.x)},
    {"guide_wind.y", "N", "force of the wind on the guide, along y of R", AT(out.launching.guide_wind.y)},
    {"guide_wind.z", "N", "force of the wind on the guide, along z of R", AT(out.launching.guide_wind.z)},
};
static const quantity on_its_front[] = {
    {"guide_jet.force", "N", "force of the jet on the guide's front end, backwards", AT(out.launching.guide_jet)},
};
static const quantity on_its_deflector[] = {
    {"deflector.jet", "N", "force of the jet that hits the deflector", AT(out.launching.deflector)},
};
#define LAUNCHING(place, name, is) {"work." name, "J", is, AT(energy.work[place])},
#define BASE_WORK(place, name, is) LAUNCHING(POWER_COUNT + place, name, is)
#define MARCHING(place, name, is) BASE_WORK(VEHICLE_BODY_POWERS + place, name, is)
static const quantity driving_works[] = {DRIVING_WORKS(LAUNCHING)};
static const quantity slot_works[] = {SLOT_WORKS(LAUNCHING)};
static const quantity holding_works[] = {HOLDING_WORKS(LAUNCHING)};
static const quantity crossflow_works[] = {CROSSFLOW_WORKS(LAUNCHING)};
static const quantity open_air_works[] = {OPEN_AIR_WORKS(LAUNCHING)};
static const quantity pressure_works[] = {PRESSURE_WORKS(LAUNCHING)};
static const quantity recoil_works[] = {RECOIL_WORKS(LAUNCHING)};
static const quantity line_works[] = {LINE_WORKS(LAUNCHING)};
static const quantity guide_wind_works[] = {GUIDE_WIND_WORKS(LAUNCHING)};
static const quantity guide_jet_works[] = {GUIDE_JET_WORKS(LAUNCHING)};
static const quantity vehicle_works[] = {VEHICLE_WORKS(BASE_WORK) MARCHING_WORKS(MARCHING)};
#define ROLLING(place, name, is) BASE_WORK(MECHANISM_POWERS + place, name, is)
static const quantity multibody_works[] = {MECHANISM_WORKS(BASE_WORK)};
static const quantity rolling_works[] = {MARCHING_WORKS(ROLLING)};
static const quantity jet_works[] = {JET_WORKS(BASE_WORK)};
static const quantity balance[] = {
    {"energy.residual", "J", "residual of the energy balance", AT(energy.residual)},
};

#define ROCKET .where = QUANTITY_AT(launch_instant, rocket)
static const quantity_group groups[] = {
    {.title = "clock, base, tube's frame", QUANTITY_ROWS(frames)},
    {.title = "modal coordinates", .each = EACH_COORDINATE, QUANTITY_ROWS(coordinates)},
    {.title = "their rates", .each = EACH_COORDINATE, QUANTITY_ROWS(coordinate_rates)},
    {.title = "tip", QUANTITY_ROWS(tip)},
    {.title = "rocket in its tube", ROCKET, QUANTITY_ROWS(rocket)},
    {.title = "rate and specific force of the rocket", ROCKET, QUANTITY_ROWS(inertial)},
    {.title = "rocket against the launcher", ROCKET, QUANTITY_ROWS(against_launcher)},
    {.title = "mass and thrust", ROCKET, QUANTITY_ROWS(motor_now)},
    {.title = "each adaptor", .each = EACH_ADAPTOR, ROCKET, QUANTITY_ROWS(contacts)},
    {.title = "each shoe on a guide of surfaces", .each = EACH_SHOE, ROCKET, QUANTITY_ROWS(shoes)},
    {.title = "slot", .each = EACH_SLOT, ROCKET, QUANTITY_ROWS(knob)},
    {.title = "lock, breech", ROCKET, QUANTITY_ROWS(guidance)},
    {.title = "air on the emerged part of the rocket", .each = EACH_CROSSFLOW, ROCKET, QUANTITY_ROWS(crossflow)},
    {.title = "air on the rocket on an open guide", .each = EACH_OPEN_AIR, ROCKET, QUANTITY_ROWS(open_air)},
    {.title = "pressure behind the rocket", .each = EACH_PRESSURE, ROCKET, QUANTITY_ROWS(pressures)},
    {.title = "line that the rocket pulls", .each = EACH_LINE, ROCKET, QUANTITY_ROWS(drawn)},
    {.title = "wind on the guide", .each = EACH_GUIDE_WIND, QUANTITY_ROWS(blown)},
    {.title = "jet on the guide", .each = EACH_GUIDE_JET, QUANTITY_ROWS(on_its_front)},
    {.title = "jet on the deflector", .each = EACH_DEFLECTOR, QUANTITY_ROWS(on_its_deflector)},
    {.title = "each slide on which the tube recoils", .each = EACH_SLIDE, QUANTITY_ROWS(slides)},
    {.title = "section loads at a station", .each = EACH_STATION, QUANTITY_ROWS(stations)},
    {.title = "section at a station", .each = EACH_STATION, QUANTITY_ROWS(sections)},
    {.title = "loads of a support on the tube", .each = EACH_SUPPORT, QUANTITY_ROWS(reactions)},
};
static const quantity_group balances[] = {
    {.title = "energy", QUANTITY_ROWS(energies)},
    {.title = "works since the start", QUANTITY_ROWS(driving_works)},
    {.title = "works of a slot", .each = EACH_SLOT, QUANTITY_ROWS(slot_works)},
    {.title = "works of lock, supports, damping, base and lost mass", QUANTITY_ROWS(holding_works)},
    {.title = "work of the air on the emerged part of the rocket", .each = EACH_CROSSFLOW, QUANTITY_ROWS(crossflow_works)},
    {.title = "work of the air on the rocket on an open guide", .each = EACH_OPEN_AIR, QUANTITY_ROWS(open_air_works)},
    {.title = "work of the pressure behind the rocket", .each = EACH_PRESSURE, QUANTITY_ROWS(pressure_works)},
    {.title = "work of recoil slides", .each = EACH_SLIDE_WORK, QUANTITY_ROWS(recoil_works)},
    {.title = "work of the line on the rocket", .each = EACH_LINE, QUANTITY_ROWS(line_works)},
    {.title = "work of the wind on the guide", .each = EACH_GUIDE_WIND, QUANTITY_ROWS(guide_wind_works)},
    {.title = "work of the jet on guide and deflector", .each = EACH_GUIDE_JET, QUANTITY_ROWS(guide_jet_works)},
    {.title = "works of a vehicle", .each = EACH_VEHICLE, QUANTITY_ROWS(vehicle_works)},
    {.title = "works of a multibody base", .each = EACH_MULTIBODY, QUANTITY_ROWS(multibody_works)},
    {.title = "works of its wheels", .each = EACH_ROLLING, QUANTITY_ROWS(rolling_works)},
    {.title = "work of jets", .each = EACH_JET, QUANTITY_ROWS(jet_works)},
    {.title = "balance", QUANTITY_ROWS(balance)},
};
// clang-format on

// Before and after those of the base.
const quantity_table launch_quantities = {groups, sizeof groups / sizeof *groups};
const quantity_table balance_quantities = {balances, sizeof balances / sizeof *balances};

// ---- what is found at an instant ----

static double phase_number(const launch_state *self, double t)
{
    if (!self->phase.rocket)
        return 3;
    if (!self->phase.locked)
        return 2;
    return t < self->t_ignition ? 0 : 1;
}

static void find_tube(const launch_state *self, const double *y, launch_instant *now)
{
    const launching_system *launching = &self->launcher.launching;
    const launching_layout *at = &launching->layout;
    memcpy(now->tube, y + at->r, sizeof now->tube);
    memcpy(now->q, y + at->q, (size_t)at->nq * sizeof *y);
    memcpy(now->q_dot, y + at->q_dot, (size_t)at->nq * sizeof *y);
    now->tip = tip_state_of(self, &now->input.launching.base, y);
    launching_section section;
    launching_section_at(launching, y, launching->tube.flexible.length, &section);
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 axis = m3_column(section.A, 0);
    now->tip_inertial.r = v3_add(v3_from(y + at->r), m3_apply(A_IR, section.P));
    now->tip_inertial.v = m3_apply(A_IR, section.v);
    now->tip_inertial.angles =
        direction_angles_of(m3_apply(A_IR, axis), m3_apply(A_IR, v3_cross(section.w, axis)));
}

static void find_sections(const launch_state *self, const double *y, launch_instant *now)
{
    const launching_system *launching = &self->launcher.launching;
    m3 A_IR = q_matrix(q_from(y + launching->layout.quaternion));
    for (int i = 0; i < model_tubes(launching->model)->station_count; i++) {
        launching_section at;
        launching_section_at(launching, y, launching->cut[i].at, &at);
        const body_motion section = {
            .r = v3_add(v3_from(y + launching->layout.r), m3_apply(A_IR, at.P)),
            .v = m3_apply(A_IR, at.v),
            .A = m3_mul(A_IR, at.A),
            .w = m3_apply(A_IR, at.w)};
        body_instant_find(&section, &now->section[i]);
    }
}

static void find_contacts(const launch_state *self, launch_instant *now)
{
    for (int i = 0; i < self->launcher.launching.adaptors.count; i++) {
        const adaptor_report *adaptor = &now->out.launching.adaptor[i];
        now->contact[i] = self->phase.passed[i]
                              ? (instant_contact){0, 0, NAN, NAN, NAN}
                              : (instant_contact){adaptor->force, adaptor->normal,
                                                  adaptor->penetration, adaptor->y, adaptor->z};
        const shoe_report *shoe = &now->out.launching.shoe[i];
        bool touches = self->launcher.launching.surfaces.count && !self->phase.passed[i];
        now->shoe[i].force_y = touches ? shoe->force_y : 0;
        now->shoe[i].force_z = touches ? shoe->force_z : 0;
        now->shoe[i].moment = touches ? shoe->moment_x : 0;
    }
}

static void find_rocket(const launch_state *self, const double *y, launch_instant *now)
{
    const launching_layout *at = &self->launcher.launching.layout;
    const launching_input *input = &now->input.launching;
    launching_output unused;
    launching_pose pose;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 axis = m3_column(pose.A_RB, 0);
    memcpy(now->x, y + at->x, sizeof now->x);
    now->v_O1 = m3_apply(A_IR, pose.v_O1);
    now->angles =
        direction_angles_of(m3_apply(A_IR, axis), m3_apply(A_IR, v3_cross(pose.w_B, axis)));
    now->spin = v3_dot(axis, pose.w_B);
    const launching_output *out = &now->out.launching;
    v3 gravity = m3_apply_transposed(A_IR, v3_make(0, -self->launcher.launching.tube.gravity, 0));
    now->w = m3_apply_transposed(pose.A_RB, pose.w_B);
    now->w_dot = m3_apply_transposed(pose.A_RB, out->alpha_B);
    now->force = m3_apply_transposed(pose.A_RB, v3_sub(out->a_O1, gravity));
    now->motion = rocket_motion_of(&pose, input->mass.c, y, at);
    now->tip_off = tip_off_of(&input->base, &now->motion);
    now->since_ignition = since_ignition_of(self, now->t, &now->motion);
    find_contacts(self, now);
}

static void find_instant(const launch_state *self, double t, const double *y, double energy_start,
                         launch_instant *now)
{
    const launching_system *launching = &self->launcher.launching;
    double within[LD_MAX_STATES], length = launching->tube.flexible.length;
    if (self->phase.rocket && y[launching->layout.x + X_S] > length) {
        // the curvature jumps at the tip: its inner value counts, as in the summary
        memcpy(within, y, (size_t)self->launcher.state_count * sizeof *within);
        within[launching->layout.x + X_S] = length;
        y = within;
    }
    now->t = t;
    now->phase = phase_number(self, t);
    now->rocket = self->phase.rocket;
    now->out = (launcher_output){0};
    simulation_input(self, t, y, &now->input);
    simulation_loads(self, &now->input, y, &now->out, &now->loads);
    base_angles(&self->launcher.base, t, &now->input.launching.base, now->base);
    find_tube(self, y, now);
    find_sections(self, y, now);
    if (now->rocket)
        find_rocket(self, y, now);
    base_find(&self->launcher.base, &now->input.found, &now->out.base, y + self->launcher.base_at,
              &now->of_base);
    simulation_energy(self, &now->input, &now->out, y, energy_start, &now->energy);
}

// ---- columns and rows ----

ld_status history_build(ld_simulation *self, ld_error *error)
{
    quantity_things things = quantity_things_of(self->model);
    things.count[EACH_COORDINATE] = self->launcher.launching.layout.nq;
    const quantity_table *of_base = self->launcher.base.kind->quantities;
    const quantity_part parts[] = {{&launch_quantities, 0},
                                   {of_base, offsetof(launch_instant, of_base)},
                                   {&balance_quantities, 0}};
    ld_status status =
        quantity_columns_make(&self->columns, parts, sizeof parts / sizeof *parts, &things, error);
    assert(status || self->columns.count <= LD_MAX_COLUMNS);
    return status;
}

size_t ld_simulation_columns(const ld_simulation *simulation, const ld_column **columns)
{
    *columns = simulation->columns.column;
    return (size_t)simulation->columns.count;
}

void history_row(const launch_state *self, double t, const double *y, double energy_start,
                 double *row)
{
    launch_instant now;
    find_instant(self, t, y, energy_start, &now);
    quantity_row(&self->system->columns, &now, row);
}
