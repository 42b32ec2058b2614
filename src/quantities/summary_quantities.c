#include "quantities/summary_quantities.h"

#include <math.h>
#include <string.h>

#include "systems/launching/launcher.h"

#define ROCKET(member) .at = QUANTITY_AT(ld_rocket_summary, member)
#define RUN(member) .at = QUANTITY_AT(ld_summary, member)
#define ADAPTOR(array) .at = QUANTITY_EACH_OF(ld_rocket_summary, array)
#define KEPT .studied = true

#define LINE_OF(name, of, from_si, places)                                                         \
    .label = name, .unit = of, .factor = from_si, .digits = places
#define LINE(name, of, from_si, places) .line = {LINE_OF(name, of, from_si, places)}
#define LINE_OFF(name, of, from_si, places, error_of)                                              \
    .line = {LINE_OF(name, of, from_si, places),                                                   \
             .error = QUANTITY_AT(ld_rocket_summary, exit_error.error_of)}
#define NONZERO(name, of, from_si, places)                                                         \
    .line = {LINE_OF(name, of, from_si, places), .nonzero = true}
#define BESIDE(from_si) .line = {.factor = from_si, .beside = true}
#define MILLI 1e3
#define DEGREES 57.29577951308232

// A row is a line, however long; what is said of it stands in docs/quantities.md.
// clang-format off

// ---- a rocket

static const quantity tube[] = {
    {"tube", "", "number of the tube", ROCKET(tube)},
};
static const quantity ignition[] = {
    {"t_ignition", "s", "ignition, on the run's clock", ROCKET(t_ignition), KEPT},
};
static const quantity instants[] = {
    {"t_release", "s", "the lock releases", ROCKET(t_release), KEPT, LINE("lock release", "ms", MILLI, 4)},
    {"t_front", "s", "the front adaptor (the one farthest forward) leaves the guide", ROCKET(t_front), KEPT},
    {"t_middle", "s", "the middle adaptor (of exactly three) leaves the guide", ROCKET(t_middle), KEPT},
    {"t_rear", "s", "the rear adaptor leaves the guide: the rocket has left", ROCKET(t_rear), KEPT},
};
static const quantity exits[] = {
    {"t_exit.%s", "s", "adaptor %s leaves the guide", ADAPTOR(t_exit), LINE("%s adaptor leaves", "ms", MILLI, 4)},
};
static const quantity at_exit[] = {
    {"exit_speed", "m/s", "s_dot at t_rear, relative to the tube", ROCKET(exit_speed), KEPT, LINE("exit speed", "m/s", 1, 4)},
    {"inertial_speed", "m/s", "speed of the rear adaptor's centre in I at t_rear", ROCKET(inertial_speed), KEPT, LINE("inertial speed", "m/s", 1, 4)},
    {"spin_rate", "rad/s", "x component of the rate of B against I at t_rear, in B", ROCKET(spin_rate), KEPT, LINE("spin rate", "rad/s", 1, 4)},
};
static const quantity since_ignition[] = {
    {"since_ignition.pitch", "rad", "launcher's axes at ignition: pitch of the rocket's axis", ROCKET(since_ignition.pitch), KEPT, LINE("since ignition, angles", "mrad", MILLI, 4)},
    {"since_ignition.yaw", "rad", "launcher's axes at ignition: yaw of the rocket's axis, positive to the left", ROCKET(since_ignition.yaw), KEPT, BESIDE(MILLI)},
    {"since_ignition.roll", "rad", "launcher's axes at ignition: roll of Ry(yaw) Rz(pitch) Rx(roll), whole turns counted", ROCKET(since_ignition.roll), KEPT, LINE("since ignition, roll", "deg", DEGREES, 4)},
    {"since_ignition.pitch_rate", "rad/s", "rate of since_ignition.pitch", ROCKET(since_ignition.pitch_rate), KEPT, LINE_OFF("since ignition, rates", "mrad/s", MILLI, 3, rates)},
    {"since_ignition.yaw_rate", "rad/s", "rate of since_ignition.yaw", ROCKET(since_ignition.yaw_rate), KEPT, BESIDE(MILLI)},
    {"since_ignition.roll_rate", "rad/s", "rate of since_ignition.roll", ROCKET(since_ignition.roll_rate), KEPT},
    {"since_ignition.vy", "m/s", "launcher's axes at ignition: inertial velocity of the mass centre along y", ROCKET(since_ignition.vy), KEPT, LINE("since ignition, vy, vz", "m/s", 1, 5)},
    {"since_ignition.vz", "m/s", "launcher's axes at ignition: inertial velocity of the mass centre along z", ROCKET(since_ignition.vz), KEPT, BESIDE(1)},
};
static const quantity tip_off[] = {
    {"tip_off.pitch", "rad", "rocket's axis in T: pitch", ROCKET(tip_off.pitch), KEPT, LINE("tip-off pitch, yaw", "mrad", MILLI, 4)},
    {"tip_off.yaw", "rad", "rocket's axis in T: yaw, positive to the left", ROCKET(tip_off.yaw), KEPT, BESIDE(MILLI)},
    {"tip_off.pitch_rate", "rad/s", "rate of tip_off.pitch, T held still", ROCKET(tip_off.pitch_rate), KEPT, LINE_OFF("tip-off rates", "mrad/s", MILLI, 3, rates)},
    {"tip_off.yaw_rate", "rad/s", "rate of tip_off.yaw, T held still", ROCKET(tip_off.yaw_rate), KEPT, BESIDE(MILLI)},
    {"tip_off.pitch_rate_relative", "rad/s", "rate of tip_off.pitch, T moving", ROCKET(tip_off.pitch_rate_relative), KEPT, LINE_OFF("relative rates", "mrad/s", MILLI, 3, rates)},
    {"tip_off.yaw_rate_relative", "rad/s", "rate of tip_off.yaw, T moving", ROCKET(tip_off.yaw_rate_relative), KEPT, BESIDE(MILLI)},
    {"tip_off.vy", "m/s", "inertial velocity of the mass centre along T's y", ROCKET(tip_off.vy), KEPT, LINE("tip-off vy, vz", "m/s", 1, 5)},
    {"tip_off.vz", "m/s", "inertial velocity of the mass centre along T's z", ROCKET(tip_off.vz), KEPT, BESIDE(1)},
    {"tip_off.vy_relative", "m/s", "velocity of the mass centre against T, its y", ROCKET(tip_off.vy_relative), KEPT, LINE("relative vy, vz", "m/s", 1, 5)},
    {"tip_off.vz_relative", "m/s", "velocity of the mass centre against T, its z", ROCKET(tip_off.vz_relative), KEPT, BESIDE(1)},
};
static const quantity ground[] = {
    {"pitch", "rad", "pitch of the rocket's axis in I at t_rear", ROCKET(pitch), KEPT, LINE("ground pitch, yaw", "deg", DEGREES, 5)},
    {"yaw", "rad", "yaw of the rocket's axis in I at t_rear, positive to the left; not meaningful near the vertical", ROCKET(yaw), KEPT, BESIDE(DEGREES)},
    {"pitch_rate", "rad/s", "rate of pitch", ROCKET(pitch_rate), KEPT, LINE_OFF("ground pitch, yaw rate", "mrad/s", MILLI, 3, yaw_rate)},
    {"yaw_rate", "rad/s", "rate of yaw; not meaningful near the vertical", ROCKET(yaw_rate), KEPT, BESIDE(MILLI)},
};
static const quantity state_at_exit[] = {
    {"exit.x", "m", "rear adaptor's centre in I at t_rear", ROCKET(exit.position[0]), "exit.position[]", KEPT},
    {"exit.y", "m", "rear adaptor's centre in I at t_rear", ROCKET(exit.position[1]), "exit.position[]", KEPT},
    {"exit.z", "m", "rear adaptor's centre in I at t_rear", ROCKET(exit.position[2]), "exit.position[]", KEPT},
    {"exit.vx", "m/s", "velocity of the rear adaptor's centre in I at t_rear", ROCKET(exit.velocity[0]), "exit.velocity[]", KEPT},
    {"exit.vy", "m/s", "velocity of the rear adaptor's centre in I at t_rear", ROCKET(exit.velocity[1]), "exit.velocity[]", KEPT},
    {"exit.vz", "m/s", "velocity of the rear adaptor's centre in I at t_rear", ROCKET(exit.velocity[2]), "exit.velocity[]", KEPT},
    {"exit.q0", "1", "quaternion of B against I at t_rear, scalar part first", ROCKET(exit.quaternion[0]), "exit.quaternion[]"},
    {"exit.q1", "1", "quaternion of B against I at t_rear, scalar part first", ROCKET(exit.quaternion[1]), "exit.quaternion[]"},
    {"exit.q2", "1", "quaternion of B against I at t_rear, scalar part first", ROCKET(exit.quaternion[2]), "exit.quaternion[]"},
    {"exit.q3", "1", "quaternion of B against I at t_rear, scalar part first", ROCKET(exit.quaternion[3]), "exit.quaternion[]"},
    {"exit.wx", "rad/s", "rate of B against I at t_rear, in B", ROCKET(exit.rate[0]), "exit.rate[]"},
    {"exit.wy", "rad/s", "rate of B against I at t_rear, in B", ROCKET(exit.rate[1]), "exit.rate[]"},
    {"exit.wz", "rad/s", "rate of B against I at t_rear, in B", ROCKET(exit.rate[2]), "exit.rate[]"},
};
static const quantity relative[] = {
    {"relative.y", "m", "rear adaptor's offset from the tube's axis, in S", ROCKET(relative.y)},
    {"relative.z", "m", "rear adaptor's offset from the tube's axis, in S", ROCKET(relative.z)},
    {"relative.psi", "rad", "relative pitch: A_SB = Rz(psi) Ry(theta) Rx(gamma)", ROCKET(relative.psi)},
    {"relative.theta", "rad", "relative yaw", ROCKET(relative.theta)},
    {"relative.gamma", "rad", "relative roll", ROCKET(relative.gamma)},
    {"relative.w_x", "rad/s", "rate of the rocket against S, in S", ROCKET(relative.w_x)},
    {"relative.w_y", "rad/s", "rate of the rocket against S, in S", ROCKET(relative.w_y)},
    {"relative.w_z", "rad/s", "rate of the rocket against S, in S", ROCKET(relative.w_z)},
};
static const quantity tip[] = {
    {"tip.y", "m", "tip against the undeformed tube, in its axes", ROCKET(tip.y), KEPT, LINE("tip y, z", "mm", MILLI, 4)},
    {"tip.z", "m", "tip against the undeformed tube, in its axes", ROCKET(tip.z), KEPT, BESIDE(MILLI)},
    {"tip.pitch", "rad", "tip's axis against the undeformed tube: pitch", ROCKET(tip.pitch), KEPT},
    {"tip.yaw", "rad", "tip's axis against the undeformed tube: yaw", ROCKET(tip.yaw), KEPT},
    {"tip.vy", "m/s", "rate of tip.y", ROCKET(tip.vy), KEPT},
    {"tip.vz", "m/s", "rate of tip.z", ROCKET(tip.vz), KEPT},
    {"tip.pitch_rate", "rad/s", "rate of tip.pitch", ROCKET(tip.pitch_rate), KEPT, LINE("tip pitch, yaw rate", "mrad/s", MILLI, 3)},
    {"tip.yaw_rate", "rad/s", "rate of tip.yaw", ROCKET(tip.yaw_rate), KEPT, BESIDE(MILLI)},
};
static const quantity exit_error[] = {
    {"exit_error.rates", "rad/s", "possible integration error of each rate of tip_off and since_ignition", ROCKET(exit_error.rates), KEPT},
    {"exit_error.yaw_rate", "rad/s", "the same of yaw_rate, which is larger near the vertical", ROCKET(exit_error.yaw_rate)},
    {"exit_error.relative", "1", "exit_error.rates over the magnitude of both tip_off rates, or over 1 mrad/s where that is less", ROCKET(exit_error.relative), KEPT},
};
static const quantity contact_peaks[] = {
    {"max_contact_force.%s", "N", "adaptor %s: largest norm of normal force and friction", ADAPTOR(max_contact_force), KEPT, .from_zero = true, LINE("largest force, %s", "N", 1, 1)},
};
static const quantity slot_peak[] = {
    {"max_slot_force", "N", "largest magnitude of the slot force N", ROCKET(max_slot_force), KEPT, .from_zero = true, LINE("largest slot force", "N", 1, 1)},
};
static const quantity pressure_peak[] = {
    {"max_pressure", "Pa", "largest pressure behind the rocket minus that before it", ROCKET(max_pressure), KEPT, .from_zero = true, LINE("largest pressure", "MPa", 1e-6, 4)},
};
static const quantity recoils[] = {
    {"max_recoil.%s", "m", "recoil slide %s: largest travel back from the front stop, until the change of tubes", ADAPTOR(max_recoil), KEPT, .from_zero = true, LINE("largest recoil, slide %s", "mm", MILLI, 3)},
};
#define CARRIED(member) .at = QUANTITY_OF_EACH(ld_rocket_summary, station, member)
static const quantity station_peaks[] = {
    {"station.%s.max_bending", "N.m", "station %s: largest magnitude of the bending moment at the ends of the steps", CARRIED(bending), KEPT, LINE("bending at station %s", "N.m", 1, 2)},
    {"station.%s.t_max_bending", "s", "station %s: when that was, from ignition", CARRIED(t_bending), KEPT},
    {"station.%s.max_shear", "N", "station %s: largest magnitude of the shear force", CARRIED(shear), KEPT, LINE("shear at station %s", "N", 1, 2)},
    {"station.%s.max_torque", "N.m", "station %s: largest magnitude of the torque", CARRIED(torque), KEPT},
    {"station.%s.max_stress", "Pa", "station %s: largest bending stress, where the outer fibre is known", CARRIED(stress), KEPT},
};
#define BORNE(member) .at = QUANTITY_OF_EACH(ld_rocket_summary, support, member)
static const quantity support_peaks[] = {
    {"support.%s.max_force", "N", "support %s: largest magnitude of its force on the tube", BORNE(force), KEPT, LINE("force of support %s", "N", 1, 2)},
    {"support.%s.max_moment", "N.m", "support %s: largest magnitude of its moment", BORNE(moment), KEPT, LINE("moment of support %s", "N.m", 1, 2)},
};
static const quantity measures[] = {
    {"measure.%s", NULL, "value of measure %s, in the unit of its column or expression", .at = QUANTITY_EACH_OF(ld_rocket_summary, measure), KEPT, .line = {.label = "%s", .factor = 1, .digits = 6}},
};
#define HELD(member) .at = QUANTITY_OF_EACH(ld_rocket_summary, hinge, member)
static const quantity held[] = {
    {"%s.error_rms", "rad", "%s: command minus measured, rms", HELD(error_rms), KEPT, LINE("%s error", "mrad, rms", MILLI, 4)},
    {"%s.torque_rms", "N.m", "%s: torque of stabiliser or lock, rms", HELD(torque_rms), KEPT, LINE("%s torque", "N.m, rms and peak", 1, 1)},
    {"%s.torque_peak", "N.m", "%s: its largest magnitude", HELD(torque_peak), KEPT, .from_zero = true, BESIDE(1)},
    {"%s.saturated", "s", "%s: time at the torque limit", HELD(saturated), KEPT, .from_zero = true, NONZERO("%s saturated", "ms", MILLI, 3)},
    {"%s.power_mean", "W", "%s: magnitude of torque times rate of the hinge, mean", HELD(power_mean), KEPT, LINE("%s power", "W, mean and peak", 1, 1)},
    {"%s.power_peak", "W", "%s: its largest value", HELD(power_peak), KEPT, .from_zero = true, BESIDE(1)},
};
#define DRIVEN(member) .at = QUANTITY_OF_EACH(ld_rocket_summary, drive, member)
static const quantity driven[] = {
    {"drive.%s.error_rms", "1", "drive %s: command minus measured [rad] or [m], rms", DRIVEN(error_rms), KEPT, LINE("drive %s error", "mrad or mm, rms", MILLI, 4)},
    {"drive.%s.torque_rms", "1", "drive %s: torque [N m] or force [N] of drive or lock, rms", DRIVEN(torque_rms), KEPT, LINE("drive %s torque", "N m or N, rms and peak", 1, 1)},
    {"drive.%s.torque_peak", "1", "drive %s: its largest magnitude", DRIVEN(torque_peak), KEPT, .from_zero = true, BESIDE(1)},
    {"drive.%s.saturated", "s", "drive %s: time at the limit", DRIVEN(saturated), KEPT, .from_zero = true, NONZERO("drive %s saturated", "ms", MILLI, 3)},
    {"drive.%s.power_mean", "W", "drive %s: magnitude of torque times rate, mean", DRIVEN(power_mean), KEPT},
    {"drive.%s.power_peak", "W", "drive %s: magnitude of torque times rate, largest", DRIVEN(power_peak), KEPT, .from_zero = true},
};
#define STANDING(member) .at = QUANTITY_OF_EACH(ld_rocket_summary, foot, member)
static const quantity standing[] = {
    {"foot.%s.force_peak", "N", "foot %s: largest vertical force", STANDING(force_peak), KEPT, LINE("foot %s force", "N, largest and least", 1, 1)},
    {"foot.%s.force_least", "N", "foot %s: least vertical force; 0: it lifted", STANDING(force_least), KEPT, BESIDE(1)},
};
static const quantity change[] = {
    {"energy_dropped", "J", "kinetic energy lost at the change to its tube; 0 for the first", ROCKET(energy_dropped), .from_zero = true, NONZERO("dropped at tube change", "J", 1, 4)},
};
static const quantity flight[] = {
    {"stability_margin", "1", "at the flight's start (the exit): mass centre ahead of the centre of pressure, in reference diameters", ROCKET(flight.stability_margin), "flight.stability_margin", KEPT, LINE("stability margin", "calibres", 1, 3)},
    {"apogee", "m", "greatest height of the mass centre above the launch site's ground (`environment.ground`); none where the flight ends while rising", ROCKET(flight.apogee), "flight.apogee", KEPT, LINE("apogee above ground", "m", 1, 3)},
    {"apogee_altitude", "m", "the same above sea level (the sphere or ellipsoid of the Earth)", ROCKET(flight.apogee_altitude), "flight.apogee_altitude", KEPT, LINE("apogee above sea level", "m", 1, 3)},
    {"t_apogee", "s", "when the mass centre is there", ROCKET(flight.t_apogee), "flight.t_apogee", KEPT, LINE("apogee from ignition", "s", 1, 4)},
    {"downrange", "m", "x of the landing point in I from the launch point", ROCKET(flight.downrange), "flight.downrange", KEPT, LINE("downrange, drift", "m", 1, 3)},
    {"drift", "m", "z of the landing point in I from the launch point", ROCKET(flight.drift), "flight.drift", KEPT, BESIDE(1)},
    {"range", "m", "distance of the landing point from the launch point", ROCKET(flight.range), "flight.range", KEPT, LINE("range", "m", 1, 3)},
    {"t_impact", "s", "landing", ROCKET(flight.t_impact), "flight.t_impact", KEPT, LINE("landing from ignition", "s", 1, 4)},
    {"time_of_flight", "s", "from t_rear, or from the start of a flight alone", ROCKET(flight.time_of_flight), "flight.time_of_flight", KEPT, LINE("time of flight", "s", 1, 4)},
    {"impact_speed", "m/s", "speed at the landing, against the ground", ROCKET(flight.impact_speed), "flight.impact_speed", KEPT, LINE("landing speed", "m/s", 1, 3)},
    {"impact_angle", "rad", "of that velocity below the horizontal there", ROCKET(flight.impact_angle), "flight.impact_angle", KEPT, LINE("landing angle", "deg", DEGREES, 3)},
    {"max_mach", "", "largest Mach number", ROCKET(flight.max_mach), "flight.max_mach", KEPT, LINE("largest Mach number", "", 1, 4)},
    {"max_dynamic_pressure", "Pa", "largest dynamic pressure", ROCKET(flight.max_dynamic_pressure), "flight.max_dynamic_pressure", KEPT, LINE("dynamic pressure, peak", "kPa", 1e-3, 4)},
    {"t_max_dynamic_pressure", "s", "when that was", ROCKET(flight.t_max_dynamic_pressure), "flight.t_max_dynamic_pressure", KEPT},
    {"max_acceleration", "m/s2", "largest acceleration of the mass centre in flight, against inertial axes, at the ends of the steps", ROCKET(flight.max_acceleration), "flight.max_acceleration", KEPT, LINE("acceleration in flight", "m/s2", 1, 3)},
    {"t_max_acceleration", "s", "when that was", ROCKET(flight.t_max_acceleration), "flight.t_max_acceleration", KEPT},
    {"max_angle_of_attack", "rad", "largest angle of attack at the ends of the steps", ROCKET(flight.max_angle_of_attack), "flight.max_angle_of_attack", KEPT, LINE("largest angle of attack", "deg", DEGREES, 3)},
};
#define OPENED(member) .at = QUANTITY_OF_EACH(ld_rocket_summary, parachute, member)
static const quantity parachutes[] = {
    {"parachute.%s.t_open", "s", "parachute %s: begins to open", OPENED(t_open), KEPT, LINE("%s opens", "s", 1, 4)},
    {"parachute.%s.height", "m", "parachute %s: height of the mass centre above the ground then", OPENED(height), KEPT, LINE("%s, height", "m", 1, 3)},
    {"parachute.%s.airspeed", "m/s", "parachute %s: speed through the air then", OPENED(airspeed), KEPT, LINE("%s, airspeed", "m/s", 1, 3)},
    // with a canopy of its own besides
    {"parachute.%s.t_taut", "s", "parachute %s: its lines are taut for the first time", OPENED(t_taut), KEPT},
    {"parachute.%s.snatch", "N", "parachute %s: first maximum of the force of its lines", OPENED(snatch), KEPT, LINE("%s, snatch, largest force", "N", 1, 1)},
    {"parachute.%s.greatest_force", "N", "parachute %s: largest force of its lines", OPENED(greatest_force), KEPT, BESIDE(1)},
    {"parachute.%s.t_greatest_force", "s", "parachute %s: when that was", OPENED(t_greatest_force), KEPT},
};
static const quantity line_pulled[] = {
    {"line.greatest_tension", "N", "largest pull of the line on the rocket in flight", ROCKET(line.greatest_tension), KEPT, LINE("line, greatest tension", "N", 1, 2)},
    {"line.t_greatest_tension", "s", "when that was", ROCKET(line.t_greatest_tension), KEPT},
    {"line.paid_out", "m", "unstretched length that has left the container", ROCKET(line.paid_out), KEPT, LINE("line paid out, remaining", "m", 1, 2)},
    {"line.remaining", "m", "length that is in the container still", ROCKET(line.remaining), KEPT, BESIDE(1)},
    {"line.t_end", "s", "all of the line is out", ROCKET(line.t_end), KEPT},
    {"line.reach", "m", "at the end, greatest horizontal distance from the container of the part that hangs on it", ROCKET(line.reach), KEPT, LINE("reach of the line", "m", 1, 2)},
    {"line.t_rest", "s", "the line rests, after the landing", ROCKET(line.t_rest), KEPT},
};
static const quantity line_broken[] = {
    {"line.t_break", "s", "the line breaks", ROCKET(line.t_break), KEPT},
    {"line.broken.x", "m", "where it breaks, in I", ROCKET(line.broken[0]), "line.broken.position[]"},
    {"line.broken.y", "m", "where it breaks, in I", ROCKET(line.broken[1]), "line.broken.position[]"},
    {"line.broken.z", "m", "where it breaks, in I", ROCKET(line.broken[2]), "line.broken.position[]"},
    {"line.broken.at", "m", "length from the rocket to there", ROCKET(line.broken_at), KEPT},
};
#define LYING(member) .at = QUANTITY_OF_EACH(ld_rocket_summary, line.place, member)
static const quantity line_places[] = {
    {"line.%s.x", "m", "line at the end, at equal parts of its length, 1 at the container, 12 at the rocket, in I", LYING(x), KEPT},
    {"line.%s.y", "m", "line at the end, at equal parts of its length, 1 at the container, 12 at the rocket, in I", LYING(y), KEPT},
    {"line.%s.z", "m", "line at the end, at equal parts of its length, 1 at the container, 12 at the rocket, in I", LYING(z), KEPT},
};
static const quantity final[] = {
    {"final.t", "s", "end of the flight, on the run's clock", ROCKET(final.t)},
    {"final.x", "m", "rear adaptor's centre in I", ROCKET(final.position[0]), "final.position[]"},
    {"final.y", "m", "rear adaptor's centre in I", ROCKET(final.position[1]), "final.position[]"},
    {"final.z", "m", "rear adaptor's centre in I", ROCKET(final.position[2]), "final.position[]"},
    {"final.vx", "m/s", "velocity of the rear adaptor's centre against the ground, in I", ROCKET(final.velocity[0]), "final.velocity[]"},
    {"final.vy", "m/s", "velocity of the rear adaptor's centre against the ground, in I", ROCKET(final.velocity[1]), "final.velocity[]"},
    {"final.vz", "m/s", "velocity of the rear adaptor's centre against the ground, in I", ROCKET(final.velocity[2]), "final.velocity[]"},
    {"final.q0", "1", "quaternion of B against I, scalar part first", ROCKET(final.quaternion[0]), "final.quaternion[]"},
    {"final.q1", "1", "quaternion of B against I, scalar part first", ROCKET(final.quaternion[1]), "final.quaternion[]"},
    {"final.q2", "1", "quaternion of B against I, scalar part first", ROCKET(final.quaternion[2]), "final.quaternion[]"},
    {"final.q3", "1", "quaternion of B against I, scalar part first", ROCKET(final.quaternion[3]), "final.quaternion[]"},
    {"final.wx", "rad/s", "rate of B against I, in B", ROCKET(final.rate[0]), "final.rate[]"},
    {"final.wy", "rad/s", "rate of B against I, in B", ROCKET(final.rate[1]), "final.rate[]"},
    {"final.wz", "rad/s", "rate of B against I, in B", ROCKET(final.rate[2]), "final.rate[]"},
    {"final.center.x", "m", "mass centre in I", ROCKET(final.center[0]), "final.center[]"},
    {"final.center.y", "m", "mass centre in I", ROCKET(final.center[1]), "final.center[]"},
    {"final.center.z", "m", "mass centre in I", ROCKET(final.center[2]), "final.center[]"},
    {"final.center.vx", "m/s", "velocity of the mass centre against the ground, in I", ROCKET(final.center_velocity[0]), "final.center_velocity[]"},
    {"final.center.vy", "m/s", "velocity of the mass centre against the ground, in I", ROCKET(final.center_velocity[1]), "final.center_velocity[]"},
    {"final.center.vz", "m/s", "velocity of the mass centre against the ground, in I", ROCKET(final.center_velocity[2]), "final.center_velocity[]"},
};
static const quantity final_on_earth[] = {
    {"final.latitude", "rad", "geodetic latitude of the mass centre", ROCKET(final.latitude)},
    {"final.longitude", "rad", "longitude of the mass centre", ROCKET(final.longitude)},
    {"final.altitude", "m", "altitude of the mass centre above the ellipsoid", ROCKET(final.altitude)},
    {"final.v_north", "m/s", "velocity of the mass centre against the ground, to the north", ROCKET(final.velocity_ned[0]), "final.velocity_ned[]"},
    {"final.v_east", "m/s", "velocity of the mass centre against the ground, to the east", ROCKET(final.velocity_ned[1]), "final.velocity_ned[]"},
    {"final.v_down", "m/s", "velocity of the mass centre against the ground, down", ROCKET(final.velocity_ned[2]), "final.velocity_ned[]"},
    {"final.heading", "rad", "of the rocket's axis, clockwise from north", ROCKET(final.heading)},
    {"final.pitch", "rad", "of the rocket's axis above the local horizon", ROCKET(final.pitch)},
    {"final.roll", "rad", "of the rocket, Ry(-heading) Rz(pitch) Rx(roll) against north, up, east", ROCKET(final.roll)},
    {"final.inertial_wx", "rad/s", "rate of B against inertial axes, in B", ROCKET(final.rate_inertial[0]), "final.rate_inertial[]"},
    {"final.inertial_wy", "rad/s", "rate of B against inertial axes, in B", ROCKET(final.rate_inertial[1]), "final.rate_inertial[]"},
    {"final.inertial_wz", "rad/s", "rate of B against inertial axes, in B", ROCKET(final.rate_inertial[2]), "final.rate_inertial[]"},
};

static const quantity_group rocket_groups[] = {
    {.title = "tube", .launch = true, QUANTITY_ROWS(tube)},
    {.title = "ignition", QUANTITY_ROWS(ignition)},
    {.title = "instants from its ignition", .launch = true, .block = SHOWN_LAUNCH, QUANTITY_ROWS(instants)},
    {.title = "of each adaptor", .each = EACH_ADAPTOR, .launch = true, .block = SHOWN_LAUNCH, .backwards = true, QUANTITY_ROWS(exits)},
    {.title = "speeds at the exit", .launch = true, .block = SHOWN_LAUNCH, QUANTITY_ROWS(at_exit)},
    {.title = "at the exit, in the launcher's axes at ignition", .launch = true, .block = SHOWN_LAUNCH, QUANTITY_ROWS(since_ignition)},
    {.title = "at the exit, against the undeformed tube as it stands and moves", .launch = true, .block = SHOWN_LAUNCH, QUANTITY_ROWS(tip_off)},
    {.title = "at the exit, in the ground frame", .launch = true, .block = SHOWN_GROUND, QUANTITY_ROWS(ground)},
    {.title = "state at the exit, in which the flight begins", .launch = true, QUANTITY_ROWS(state_at_exit)},
    {.title = "rocket against the tube's section at t_rear", .launch = true, QUANTITY_ROWS(relative)},
    {.title = "tip against the undeformed tube at t_rear", .launch = true, .block = SHOWN_TIP, QUANTITY_ROWS(tip)},
    {.title = "integration error of the rates at t_rear; null where not estimated", .launch = true, QUANTITY_ROWS(exit_error)},
    {.title = "greatest contact forces", .each = EACH_ADAPTOR, .launch = true, .block = SHOWN_PEAKS, QUANTITY_ROWS(contact_peaks)},
    {.title = "greatest slot force", .each = EACH_SLOT, .launch = true, .block = SHOWN_PEAKS, QUANTITY_ROWS(slot_peak)},
    {.title = "greatest pressure", .each = EACH_PRESSURE, .launch = true, .block = SHOWN_PEAKS, QUANTITY_ROWS(pressure_peak)},
    {.title = "greatest recoil", .each = EACH_SLIDE, .launch = true, .block = SHOWN_PEAKS, QUANTITY_ROWS(recoils)},
    {.title = "largest section loads at a station", .each = EACH_STATION, .launch = true, .block = SHOWN_PEAKS, QUANTITY_ROWS(station_peaks)},
    {.title = "largest loads of a support", .each = EACH_SUPPORT, .launch = true, .block = SHOWN_PEAKS, QUANTITY_ROWS(support_peaks)},
    {.title = "of each measure of the scenario", .each = EACH_MEASURE, .block = SHOWN_MEASURES, QUANTITY_ROWS(measures)},
    {.title = "each hinge of a vehicle, from ignition to exit", .each = EACH_HINGE, .launch = true, .block = SHOWN_HINGES, QUANTITY_ROWS(held)},
    {.title = "each drive of a multibody base, from ignition to exit", .each = EACH_DRIVE, .launch = true, .block = SHOWN_HINGES, QUANTITY_ROWS(driven)},
    {.title = "each foot of a multibody base, from ignition to exit", .each = EACH_FOOT, .launch = true, .block = SHOWN_HINGES, QUANTITY_ROWS(standing)},
    {.title = "change of the tube", .launch = true, .block = SHOWN_CHANGE, QUANTITY_ROWS(change)},
    {.title = "flight", .where = QUANTITY_AT(ld_rocket_summary, flown), .block = SHOWN_FLIGHT, QUANTITY_ROWS(flight)},
    {.title = "of each parachute", .each = EACH_PARACHUTE, .where = QUANTITY_AT(ld_rocket_summary, flown), .block = SHOWN_FLIGHT, .row = parachutes, .rows = 3},
    {.title = "of each parachute with a canopy", .each = EACH_CANOPY, .where = QUANTITY_AT(ld_rocket_summary, flown), .block = SHOWN_FLIGHT, QUANTITY_ROWS(parachutes)},
    {.title = "line that the rocket pulls", .each = EACH_LINE, .where = QUANTITY_AT(ld_rocket_summary, flown), .block = SHOWN_FLIGHT, QUANTITY_ROWS(line_pulled)},
    {.title = "where the line breaks", .each = EACH_LINE, QUANTITY_ROWS(line_broken)},
    {.title = "places of the line", .each = EACH_LINE_PLACE, .where = QUANTITY_AT(ld_rocket_summary, flown), QUANTITY_ROWS(line_places)},
    {.title = "state at the end of the flight", .where = QUANTITY_AT(ld_rocket_summary, flown), QUANTITY_ROWS(final)},
    {.title = "the same on a round or WGS 84 Earth", .where = QUANTITY_AT(ld_rocket_summary, final.earth), QUANTITY_ROWS(final_on_earth)},
};

// ---- the run

static const quantity resting_forces[] = {
    {"equilibrium.lock_force", "N", "carried by the lock, along +x", RUN(equilibrium.lock_force), LINE("lock force", "N, forward positive", 1, 2)},
    {"equilibrium.breech_force", "N", "of the breech on the rocket, along +x", RUN(equilibrium.breech_force), NONZERO("breech force", "N", 1, 2)},
};
static const quantity resting_knob[] = {
    {"equilibrium.slot_force", "N", "slot force N on the knob", RUN(equilibrium.slot_force), LINE("slot force", "N", 1, 2)},
};
static const quantity resting_contacts[] = {
    {"equilibrium.contact_force.%s", "N", "adaptor %s: normal force", .at = QUANTITY_EACH_OF(ld_summary, equilibrium.contact_force), LINE("contact %s", "N", 1, 2)},
};
static const quantity resting_tube[] = {
    {"equilibrium.tip_sag.y", "m", "tip against the undeformed tube, in its axes", RUN(equilibrium.tip_sag[0]), LINE("tip sag y, z", "mm", MILLI, 4)},
    {"equilibrium.tip_sag.z", "m", "tip against the undeformed tube, in its axes", RUN(equilibrium.tip_sag[1]), BESIDE(MILLI)},
    {"equilibrium.residual", "m/s2", "largest acceleration at rest (of angles: rad/s2)", RUN(equilibrium.residual)},
};
#define WHEEL(member) .at = QUANTITY_OF_EACH(ld_summary, equilibrium.wheel, member)
static const quantity resting_wheels[] = {
    {"equilibrium.wheels.%s.tyre_force", "N", "wheel %s: vertical tyre force", WHEEL(tyre_force), "equilibrium.wheels[].%s.tyre_force"},
    {"equilibrium.wheels.%s.suspension.x", "m", "wheel %s: displacement from unloaded suspension, chassis axes", WHEEL(suspension[0]), "equilibrium.wheels[].%s.suspension[]"},
    {"equilibrium.wheels.%s.suspension.y", "m", "wheel %s: displacement from unloaded suspension, chassis axes", WHEEL(suspension[1]), "equilibrium.wheels[].%s.suspension[]"},
    {"equilibrium.wheels.%s.suspension.z", "m", "wheel %s: displacement from unloaded suspension, chassis axes", WHEEL(suspension[2]), "equilibrium.wheels[].%s.suspension[]"},
    {"equilibrium.wheels.%s.tyre_deflection", "m", "wheel %s: tyre deflection", WHEEL(tyre_deflection), "equilibrium.wheels[].%s.tyre_deflection"},
};
static const quantity resting_chassis[] = {
    {"equilibrium.chassis.y", "m", "chassis: mass centre in I", RUN(equilibrium.chassis.y)},
    {"equilibrium.chassis.pitch", "rad", "chassis: pitch of Rz(pitch) Rx(roll)", RUN(equilibrium.chassis.pitch)},
    {"equilibrium.chassis.roll", "rad", "chassis: roll", RUN(equilibrium.chassis.roll)},
};
#define HINGE(member) .at = QUANTITY_OF_EACH(ld_summary, equilibrium.hinge, member)
static const quantity resting_hinges[] = {
    {"equilibrium.%s.angle", "rad", "%s hinge: angle", HINGE(angle)},
    {"equilibrium.%s.torque", "N.m", "%s hinge: torque on the outboard body", HINGE(torque)},
};
#define RESTING(array, member) .at = QUANTITY_OF_EACH(ld_summary, equilibrium.array, member)
static const quantity resting_drives[] = {
    {"equilibrium.drive.%s.measured", "1", "drive %s: angle [rad] or length [m] that it follows", RESTING(drive, measured)},
    {"equilibrium.drive.%s.torque", "1", "drive %s: torque [N m] or force [N] of drive or lock", RESTING(drive, torque)},
};
static const quantity resting_struts[] = {
    {"equilibrium.strut.%s.force", "N", "strut %s: force of spring and actuator, pushing", .at = QUANTITY_EACH_OF(ld_summary, equilibrium.strut_force)},
};
static const quantity resting_feet[] = {
    {"equilibrium.foot.%s.force", "N", "foot %s: vertical force of the ground", .at = QUANTITY_EACH_OF(ld_summary, equilibrium.foot_force)},
};
static const quantity energies[] = {
    {"energy.kinetic", "J", "kinetic energy of tube, tail and rocket, and of the vehicle", RUN(energy.kinetic)},
    {"energy.potential", "J", "potential energy of tube and tail in gravity", RUN(energy.potential)},
    {"energy.elastic", "J", "elastic energy of modes, supports and suspensions", RUN(energy.elastic)},
};
#define LAUNCHING(place, name, is) {"energy.work." name, "J", is, RUN(energy.work[place])},
#define BASE_WORK(place, name, is) LAUNCHING(POWER_COUNT + place, name, is)
#define MARCHING(place, name, is) BASE_WORK(VEHICLE_BODY_POWERS + place, name, is)
static const quantity driving_works[] = {DRIVING_WORKS(LAUNCHING)};
static const quantity slot_works[] = {SLOT_WORKS(LAUNCHING)};
static const quantity holding_works[] = {HOLDING_WORKS(LAUNCHING)};
static const quantity crossflow_works[] = {CROSSFLOW_WORKS(LAUNCHING)};
static const quantity open_air_works[] = {OPEN_AIR_WORKS(LAUNCHING)};
static const quantity pressure_works[] = {PRESSURE_WORKS(LAUNCHING)};
static const quantity line_works[] = {LINE_WORKS(LAUNCHING)};
static const quantity guide_wind_works[] = {GUIDE_WIND_WORKS(LAUNCHING)};
static const quantity guide_jet_works[] = {GUIDE_JET_WORKS(LAUNCHING)};
static const quantity recoil_works[] = {RECOIL_WORKS(LAUNCHING)};
static const quantity vehicle_works[] = {VEHICLE_WORKS(BASE_WORK) MARCHING_WORKS(MARCHING)};
#define ROLLING(place, name, is) BASE_WORK(MECHANISM_POWERS + place, name, is)
static const quantity multibody_works[] = {MECHANISM_WORKS(BASE_WORK)};
static const quantity rolling_works[] = {MARCHING_WORKS(ROLLING)};
static const quantity jet_works[] = {JET_WORKS(BASE_WORK)};
static const quantity balance[] = {
    {"energy.residual", "J", "residual of the energy balance", RUN(energy.residual)},
    {"energy.residual_relative", "1", "the same over the largest single work", RUN(energy.residual_relative)},
};
static const quantity cost[] = {
    {"statistics.steps", "1", "steps of the integration", RUN(statistics.steps)},
    {"statistics.rhs_evaluations", "1", "evaluations of the equations", RUN(statistics.rhs_evaluations)},
    {"statistics.cpu_seconds", "s", "CPU time of the run, without set-up and the history's rows", RUN(statistics.cpu_seconds)},
    {"statistics.cpu_seconds_setup", "s", "CPU time of the set-up: modes, coefficients, tables", RUN(statistics.cpu_seconds_setup)},
};

#define WHEELS .where = QUANTITY_AT(ld_summary, equilibrium.wheel_count)
static const quantity_group run_groups[] = {
    {.title = "equilibrium at the start", .launch = true, .block = SHOWN_EQUILIBRIUM, QUANTITY_ROWS(resting_forces)},
    {.title = "in a slot", .each = EACH_SLOT, .launch = true, .block = SHOWN_EQUILIBRIUM, QUANTITY_ROWS(resting_knob)},
    {.title = "of each adaptor", .each = EACH_ADAPTOR, .launch = true, .block = SHOWN_EQUILIBRIUM, QUANTITY_ROWS(resting_contacts)},
    {.title = "of the tube", .launch = true, .block = SHOWN_EQUILIBRIUM, QUANTITY_ROWS(resting_tube)},
    {.title = "of each wheel of a vehicle", .each = EACH_WHEEL, .launch = true, WHEELS, QUANTITY_ROWS(resting_wheels)},
    {.title = "of its chassis", .each = EACH_VEHICLE, .launch = true, WHEELS, QUANTITY_ROWS(resting_chassis)},
    {.title = "of its hinges", .each = EACH_HINGE, .launch = true, WHEELS, QUANTITY_ROWS(resting_hinges)},
    {.title = "of each wheel of a multibody base", .each = EACH_ROLLER, .launch = true, WHEELS, QUANTITY_ROWS(resting_wheels)},
    {.title = "of each drive of a multibody base", .each = EACH_DRIVE, .launch = true, QUANTITY_ROWS(resting_drives)},
    {.title = "of each strut", .each = EACH_STRUT, .launch = true, QUANTITY_ROWS(resting_struts)},
    {.title = "of each foot", .each = EACH_FOOT, .launch = true, QUANTITY_ROWS(resting_feet)},
    {.title = "energy at the end", .launch = true, QUANTITY_ROWS(energies)},
    {.title = "works since the start", .launch = true, QUANTITY_ROWS(driving_works)},
    {.title = "works of a slot", .each = EACH_SLOT, .launch = true, QUANTITY_ROWS(slot_works)},
    {.title = "works of lock, supports, damping, base and lost mass", .launch = true, QUANTITY_ROWS(holding_works)},
    {.title = "work of the air on the emerged part of the rocket", .each = EACH_CROSSFLOW, .launch = true, QUANTITY_ROWS(crossflow_works)},
    {.title = "work of the air on the rocket on an open guide", .each = EACH_OPEN_AIR, .launch = true, QUANTITY_ROWS(open_air_works)},
    {.title = "work of the pressure behind the rocket", .each = EACH_PRESSURE, .launch = true, QUANTITY_ROWS(pressure_works)},
    {.title = "work of recoil slides", .each = EACH_SLIDE_WORK, .launch = true, QUANTITY_ROWS(recoil_works)},
    {.title = "works of a vehicle", .each = EACH_VEHICLE, .launch = true, QUANTITY_ROWS(vehicle_works)},
    {.title = "work of the line on the rocket", .each = EACH_LINE, .launch = true, QUANTITY_ROWS(line_works)},
    {.title = "work of the wind on the guide", .each = EACH_GUIDE_WIND, .launch = true, QUANTITY_ROWS(guide_wind_works)},
    {.title = "work of the jet on guide and deflector", .each = EACH_GUIDE_JET, .launch = true, QUANTITY_ROWS(guide_jet_works)},
    {.title = "works of a multibody base", .each = EACH_MULTIBODY, .launch = true, QUANTITY_ROWS(multibody_works)},
    {.title = "works of its wheels", .each = EACH_ROLLING, .launch = true, QUANTITY_ROWS(rolling_works)},
    {.title = "work of jets", .each = EACH_JET, .launch = true, QUANTITY_ROWS(jet_works)},
    {.title = "balance", .launch = true, QUANTITY_ROWS(balance)},
};
static const quantity_group cost_groups[] = {
    {.title = "cost", QUANTITY_ROWS(cost)},
};

// ---- natural modes of tube and tail

static const quantity modes[] = {
    {"frequency", "Hz", "natural frequency", .at = QUANTITY_AT(ld_mode, frequency)},
    {"damping", "1", "damping ratio", .at = QUANTITY_AT(ld_mode, damping)},
    {"real", "1/s", "-damping 2 pi frequency", .at = QUANTITY_AT(ld_mode, real)},
};
static const quantity_group mode_groups[] = {
    {.title = "modes", .launch = true, QUANTITY_ROWS(modes)},
};
// clang-format on

#define TABLE(list)                                                                                \
    {                                                                                              \
        list, sizeof(list) / sizeof *(list)                                                        \
    }
const quantity_table rocket_quantities = TABLE(rocket_groups);
const quantity_table run_quantities = TABLE(run_groups);
const quantity_table mode_quantities = TABLE(mode_groups);
const quantity_table cost_quantities = TABLE(cost_groups);

void rocket_clear(ld_rocket_summary *rocket, bool launched)
{
    static const int most[EACH_COUNT] = {[EACH_ADAPTOR] = LD_MAX_ADAPTORS,
                                         [EACH_MEASURE] = LD_MAX_TAKEN,
                                         [EACH_STATION] = LD_MAX_STATIONS,
                                         [EACH_SUPPORT] = LD_MAX_SUPPORTS,
                                         [EACH_SLIDE] = LD_MAX_SUPPORTS,
                                         [EACH_HINGE] = HINGES,
                                         [EACH_PARACHUTE] = LD_MAX_PARACHUTES,
                                         [EACH_CANOPY] = LD_MAX_PARACHUTES,
                                         [EACH_LINE] = 1,
                                         [EACH_LINE_PLACE] = LD_LINE_PLACES,
                                         [EACH_DRIVE] = LD_MAX_DRIVES,
                                         [EACH_FOOT] = LD_MAX_FEET};
    memset(rocket, 0, sizeof *rocket);
    for (int i = 0; i < rocket_quantities.groups; i++) {
        const quantity_group *group = &rocket_groups[i];
        for (int k = 0; k < group->rows; k++) {
            const quantity *row = &group->row[k];
            int items = most[group->each] ? most[group->each] : 1;
            for (int item = 0; item < items && row->at.type == QUANTITY_NUMBER; item++)
                quantity_put(&row->at, item, row->from_zero && launched ? 0 : NAN, rocket);
        }
    }
}
