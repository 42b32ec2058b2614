// What the standard figures of a launch and of flights show, for gnuplot and the report alike. A
// new figure is a row more of the table.
#include <string.h>

#include "figures/plot.h"

// clang-format off

// Units as they are written at an axis, with the factor from SI.
#define PLAIN {"", 1}
#define M {"m", 1}
#define MM {"mm", 1e3}
#define M_S {"m/s", 1}
#define MM_S {"mm/s", 1e3}
#define M_S2 {"m/s2", 1}
#define DEG {"deg", 57.29577951308232}
#define MRAD {"mrad", 1e3}
#define RAD_S {"rad/s", 1}
#define MRAD_S {"mrad/s", 1e3}
#define N {"N", 1}
#define KN {"kN", 1e-3}
#define N_M {"N m", 1}
#define KN_M {"kN m", 1e-3}
#define KPA {"kPa", 1e-3}
#define MPA {"MPa", 1e-6}
#define MRAD_OR_MM {"mrad or mm", 1e3}
#define KN_M_OR_KN {"kN m or kN", 1e-3}
#define J {"J", 1}
#define KJ {"kJ", 1e-3}
#define KG {"kg", 1}
#define KG_M3 {"kg/m³", 1}

// Curves over time, in half the width of the page or in all of it; their change since ignition;
// one diagram for each part that has the column; one column against another.
#define HALF(heading, y_name, in, ...) \
    {.title = heading, .y = {y_name, in}, .curve = {__VA_ARGS__}}
#define WIDE(heading, y_name, in, ...) \
    {.title = heading, .y = {y_name, in}, .curve = {__VA_ARGS__}, .wide = true}
#define SINCE(heading, y_name, in, ...) \
    {.title = heading, .y = {y_name, in}, .curve = {__VA_ARGS__}, .since = true}
#define EACH(heading, y_name, in, column) \
    {.title = heading, .y = {y_name, in}, .curve = {{column, ""}}, .wide = true, .each = true}
#define AGAINST(heading, y_name, y_in, y_column, x_name, x_in, of) \
    {.title = heading, .y = {y_name, y_in}, .curve = {{y_column, ""}}, .x_column = of, \
     .x = {x_name, x_in}}
#define BROAD(heading, y_name, y_in, y_column, x_name, x_in, of) \
    {.title = heading, .y = {y_name, y_in}, .curve = {{y_column, ""}}, .x_column = of, \
     .x = {x_name, x_in}, .wide = true}

// A figure of what comes after ignition; one over all the time that a vehicle moves; one of the
// flights of the rockets. OPEN: one of what the report shows first.
#define LAUNCH(name, text, ...) {.about = {name, text}, .panel = {__VA_ARGS__}}
#define VEHICLE(name, text, ...) \
    {.about = {name, text}, .panel = {__VA_ARGS__}, .time = PLOT_VEHICLE}
#define FLIGHT(name, text, ...) \
    {.about = {name, text}, .panel = {__VA_ARGS__}, .time = PLOT_FLIGHT}
#define OPEN_LAUNCH(name, text, ...) \
    {.about = {name, text}, .panel = {__VA_ARGS__}, .open = true}
#define OPEN_VEHICLE(name, text, ...) \
    {.about = {name, text}, .panel = {__VA_ARGS__}, .open = true, .time = PLOT_VEHICLE}
#define OPEN_FLIGHT(name, text, ...) \
    {.about = {name, text}, .panel = {__VA_ARGS__}, .open = true, .time = PLOT_FLIGHT}

static const plot_figure figures[] = {
    // the story of a launch
    OPEN_LAUNCH("travel", "Travel of the rocket along the tube",
           HALF("Travel", "travel", M, {"rocket.s", "s"}),
           HALF("Speed", "speed", M_S, {"rocket.s_dot", "relative to the tube"}),
           HALF("Roll", "roll", DEG, {"rocket.gamma", "relative to the tube"}),
           HALF("Spin", "spin", RAD_S, {"rocket.spin", "in inertial space"})),
    OPEN_LAUNCH("contact", "Contact between adaptors and tube",
           WIDE("Force, normal and friction together", "force", KN, {"contact.*.force", ""}),
           WIDE("Penetration (negative: gap)", "penetration", MM, {"contact.*.penetration", ""})),
    OPEN_LAUNCH("relative", "Rocket relative to the tube",
           HALF("Rear adaptor's centre", "offset", MM, {"rocket.y", "y"}, {"rocket.z", "z"}),
           HALF("Direction", "angle", MRAD, {"rocket.psi", "pitch"}, {"rocket.theta", "yaw"}),
           AGAINST("Path of the rear adaptor's centre", "y", MM, "rocket.y",
                   "z", MM, "rocket.z"),
           AGAINST("Pitch against yaw", "pitch", MRAD, "rocket.psi",
                   "yaw", MRAD, "rocket.theta")),
    OPEN_LAUNCH("tip", "Tip of the tube against the undeformed tube",
           HALF("Position", "offset", MM, {"tip.y", "y"}, {"tip.z", "z"}),
           HALF("Direction", "angle", MRAD, {"tip.pitch", "pitch"}, {"tip.yaw", "yaw"})),
    OPEN_LAUNCH("tip-off", "Rocket against the launcher, in the axes of the undeformed tube",
           HALF("Direction", "angle", MRAD, {"tip_off.pitch", "pitch"}, {"tip_off.yaw", "yaw"}),
           HALF("In the launcher's axes at ignition", "angle", MRAD,
                {"since_ignition.pitch", "pitch"}, {"since_ignition.yaw", "yaw"}),
           WIDE("Tip-off rates, the launcher held still", "rate", MRAD_S,
                {"tip_off.pitch_rate", "pitch"}, {"tip_off.yaw_rate", "yaw"}),
           WIDE("Relative rates, against the launcher as it moves", "rate", MRAD_S,
                {"tip_off.pitch_rate_relative", "pitch"}, {"tip_off.yaw_rate_relative", "yaw"}),
           WIDE("Velocity of the mass centre against the launcher", "velocity", M_S,
                {"tip_off.vy_relative", "y"}, {"tip_off.vz_relative", "z"})),
    OPEN_VEHICLE("chassis", "Chassis",
           WIDE("Height of the mass centre", "height", MM, {"chassis.y", ""}),
           HALF("Pitch", "pitch", MRAD, {"chassis.pitch", ""}),
           HALF("Roll", "roll", MRAD, {"chassis.roll", ""}),
           HALF("Speed", "speed", M_S, {"drive.speed", ""}),
           HALF("Drive force", "force", KN, {"drive.force", ""})),
    // what a launch on the march is judged by, in the order of the paper's figures 5 to 9
    LAUNCH("tip-inertial", "Tip of the tube in inertial space",
           SINCE("Height since ignition", "height", MM, {"tip.inertial_y", ""}),
           SINCE("To the right since ignition", "to the right", MM, {"tip.inertial_z", ""}),
           SINCE("Pitch since ignition", "pitch", MRAD, {"tip.inertial_pitch", ""}),
           SINCE("Yaw since ignition", "yaw", MRAD, {"tip.inertial_yaw", ""}),
           HALF("Velocity upwards", "velocity", MM_S, {"tip.inertial_vy", ""}),
           HALF("Velocity to the right", "velocity", MM_S, {"tip.inertial_vz", ""}),
           HALF("Pitch rate", "pitch rate", MRAD_S, {"tip.inertial_pitch_rate", ""}),
           HALF("Yaw rate", "yaw rate", MRAD_S, {"tip.inertial_yaw_rate", ""})),
    LAUNCH("tip-rate", "Rates of the tip of the tube against the undeformed tube",
           HALF("Velocity along y", "velocity", MM_S, {"tip.vy", ""}),
           HALF("Velocity along z", "velocity", MM_S, {"tip.vz", ""}),
           HALF("Pitch rate", "pitch rate", MRAD_S, {"tip.pitch_rate", ""}),
           HALF("Yaw rate", "yaw rate", MRAD_S, {"tip.yaw_rate", ""})),
    LAUNCH("across", "Rocket in the tube: travel, motion across it",
           HALF("Travel", "travel", M, {"rocket.s", ""}),
           AGAINST("Path of the rear adaptor's centre", "y", MM, "rocket.y",
                   "z", MM, "rocket.z"),
           AGAINST("Its velocity", "rate of y", MM_S, "rocket.y_dot",
                   "rate of z", MM_S, "rocket.z_dot"),
           AGAINST("Pitch against yaw", "pitch", MRAD, "rocket.psi",
                   "yaw", MRAD, "rocket.theta")),
    LAUNCH("relative-rate", "Rates of the rocket's angles relative to the tube",
           WIDE("Pitch", "rate of pitch", MRAD_S, {"rocket.psi_dot", ""}),
           WIDE("Yaw", "rate of yaw", MRAD_S, {"rocket.theta_dot", ""}),
           WIDE("Roll", "rate of roll", RAD_S, {"rocket.gamma_dot", ""})),
    LAUNCH("contact-force", "Contact forces, normal and friction together",
           EACH("Adaptor %s", "force", KN, "contact.*.force")),
    // the rest of a launch
    LAUNCH("phase", "Phase graphs of the rear adaptor's motion across the tube",
           AGAINST("Along y", "rate of y", MM_S, "rocket.y_dot", "y", MM, "rocket.y"),
           AGAINST("Along z", "rate of z", MM_S, "rocket.z_dot", "z", MM, "rocket.z")),
    LAUNCH("attitude", "Attitude of the rocket in inertial space",
           HALF("Pitch", "pitch", DEG, {"rocket.pitch", ""}),
           HALF("Yaw", "yaw", DEG, {"rocket.yaw", ""}),
           WIDE("Rates", "rate", MRAD_S,
                {"rocket.pitch_rate", "pitch"}, {"rocket.yaw_rate", "yaw"})),
    LAUNCH("slot", "Slot and lock",
           HALF("Slot", "force", KN, {"slot.force", "force N"}, {"slot.friction", "friction"}),
           HALF("Lock", "force", KN, {"lock.force", "force carried"})),
    LAUNCH("loads", "Loads along the tube",
           WIDE("Bending moment carried at the stations", "bending moment", N_M,
                {"station.*.bending", ""}),
           HALF("Shear force along y", "shear force", N, {"station.*.shear_y", ""}),
           HALF("Shear force along z", "shear force", N, {"station.*.shear_z", ""}),
           HALF("Axial force, tension positive", "axial force", N, {"station.*.axial", ""}),
           HALF("Torque", "torque", N_M, {"station.*.torque", ""}),
           HALF("Supports on the tube, along y", "force", N, {"support.*.force_y", ""}),
           HALF("Supports on the tube, along z", "force", N, {"support.*.force_z", ""})),
    LAUNCH("energy", "Energy",
           HALF("Drive", "energy, work", KJ,
                {"work.thrust", "work of the thrust"}, {"work.pressure", "work of the pressure"},
                {"energy.kinetic", "kinetic energy"}),
           HALF("Balance", "energy", J, {"energy.residual", "residual"}),
           WIDE("Tube and supports", "energy, work", J,
                {"energy.elastic", "elastic energy"}, {"work.support_damping", "support damping"},
                {"work.modal_damping", "modal damping"}, {"work.contact_normal", "contact, normal"}),
           WIDE("Other work", "work", J,
                {"work.gravity_rocket", "gravity"}, {"work.contact_friction", "contact friction"},
                {"work.slot_friction", "slot friction"}, {"work.mass_change", "burnt mass"},
                {"work.base", "base"}, {"work.recoil", "recoil slides"})),
    LAUNCH("pressure", "Pressure behind the rocket",
           HALF("Pressure minus that before the rocket", "pressure", MPA, {"pressure.net", ""}),
           HALF("Force on the rocket", "force", KN, {"pressure.force", ""})),
    LAUNCH("recoil", "Recoil of the tube on its slides",
           HALF("Travel back", "travel back", MM, {"recoil.*.travel", ""}),
           HALF("Speed", "speed", M_S, {"recoil.*.rate", ""}),
           WIDE("Force on the tube, forwards", "force", KN, {"recoil.*.force", ""})),
    VEHICLE("wheels", "Road and wheels",
           WIDE("Road under the wheels", "height", MM, {"wheel.*.road", ""}),
           WIDE("Suspension travel from unloaded", "travel", MM, {"wheel.*.travel", ""}),
           WIDE("Tyre deflection", "deflection", MM, {"wheel.*.deflection", ""})),
    VEHICLE("tyres", "Tyre forces",
           WIDE("Vertical", "force", KN, {"wheel.*.tyre_force", ""}),
           WIDE("Lateral", "force", N, {"wheel.*.side", ""}),
           WIDE("Longitudinal", "force", N, {"wheel.*.along", ""})),
    VEHICLE("platform", "Platforms",
           HALF("Azimuth: yaw in inertial space", "yaw", DEG,
                {"azimuth.measured", "measured"}, {"azimuth.command", "command"}),
           HALF("Elevation: pitch in inertial space", "pitch", DEG,
                {"elevation.measured", "measured"}, {"elevation.command", "command"}),
           WIDE("Error, command minus measured", "error", MRAD,
                {"elevation.error", "elevation"}, {"azimuth.error", "azimuth"}),
           HALF("Torque of the azimuth's stabiliser", "torque", KN_M, {"azimuth.torque", ""}),
           HALF("Torque of the elevation's stabiliser", "torque", KN_M, {"elevation.torque", ""})),
    OPEN_VEHICLE("bodies", "Bodies of a multibody base",
           WIDE("Height of the origin", "height", M, {"body.*.y", ""}, {"beam.*.y", ""}),
           WIDE("Pitch", "pitch", DEG, {"body.*.pitch", ""}, {"beam.*.pitch", ""}),
           HALF("Yaw", "yaw", DEG, {"body.*.yaw", ""}, {"beam.*.yaw", ""}),
           HALF("Roll", "roll", DEG, {"body.*.roll", ""}, {"beam.*.roll", ""}),
           HALF("Along x", "x", M, {"body.*.x", ""}, {"beam.*.x", ""}),
           HALF("To the right", "z", M, {"body.*.z", ""}, {"beam.*.z", ""})),
    OPEN_VEHICLE("joints", "Joints and drives of a multibody base",
           HALF("Angle", "angle", DEG, {"joint.*.angle", ""}),
           HALF("Displacement", "displacement", MM, {"joint.*.displacement", ""}),
           HALF("Rate of the angle", "rate", MRAD_S, {"joint.*.rate", ""}),
           HALF("Rate of the displacement", "speed", MM_S, {"joint.*.speed", ""}),
           HALF("Drives: command minus measured", "error", MRAD_OR_MM, {"drive.*.error", ""}),
           HALF("Drives: torque or force", "load", KN_M_OR_KN, {"drive.*.torque", ""})),
    VEHICLE("struts", "Struts, bushings and feet of a multibody base",
           HALF("Feet: vertical force", "force", KN, {"foot.*.fy", ""}),
           HALF("Feet: depth in the ground", "depth", MM, {"foot.*.deflection", ""}),
           HALF("Struts: length", "length", MM, {"strut.*.length", ""}),
           HALF("Struts: force of the actuator", "force", KN, {"strut.*.push", ""}),
           HALF("Struts: force of spring and damper", "force", KN, {"strut.*.force", ""}),
           HALF("Bushings: force along y", "force", KN, {"bushing.*.fy", ""})),
    // flights
    OPEN_FLIGHT("trajectory", "Trajectories of the rockets",
           BROAD("Altitude above sea level, along x", "altitude", M, "altitude",
                 "x", M, "center.x"),
           BROAD("Ground track", "to the right, z", M, "center.z",
                 "x", M, "center.x")),
    OPEN_FLIGHT("flight", "Free flight",
           HALF("Altitude above sea level", "altitude", M, {"altitude", ""}),
           HALF("Mach number", "Mach number", PLAIN, {"mach", ""}),
           HALF("Pitch", "pitch", DEG, {"rocket.pitch", ""}),
           HALF("Yaw", "yaw", DEG, {"rocket.yaw", ""}),
           HALF("Angle of attack", "angle of attack", DEG, {"angle_of_attack", ""}),
           HALF("Spin", "spin", RAD_S, {"rocket.spin", ""})),
    FLIGHT("flight-speed", "Speed through the air, velocity against the ground",
           HALF("Through the air", "speed", M_S, {"airspeed", ""}),
           HALF("Along x", "velocity", M_S, {"center.vx", ""}),
           HALF("Upwards", "velocity", M_S, {"center.vy", ""}),
           HALF("To the right", "velocity", M_S, {"center.vz", ""})),
    FLIGHT("flight-rate", "Rates in flight, in inertial space",
           HALF("Pitch rate", "pitch rate", RAD_S, {"rocket.pitch_rate", ""}),
           HALF("Yaw rate", "yaw rate", RAD_S, {"rocket.yaw_rate", ""})),
    FLIGHT("flight-wind", "Wind where the rocket flies",
           WIDE("Along x", "velocity", M_S, {"wind.x", ""}),
           HALF("Upwards", "velocity", M_S, {"wind.y", ""}),
           HALF("To the right", "velocity", M_S, {"wind.z", ""})),
    FLIGHT("flight-loads", "Dynamic pressure, acceleration, stability",
           HALF("Dynamic pressure", "dynamic pressure", KPA, {"dynamic_pressure", ""}),
           HALF("Acceleration of the mass centre", "acceleration", M_S2, {"acceleration", ""}),
           WIDE("Mass centre ahead of the centre of pressure", "reference diameters", PLAIN,
                {"stability_margin", ""})),
    FLIGHT("flight-motor", "Motor and air",
           HALF("Thrust", "thrust", KN, {"thrust", ""}),
           HALF("Mass", "mass", KG, {"rocket.mass", ""}),
           HALF("Density of the air", "density", KG_M3, {"density", ""})),
    FLIGHT("flight-canopy", "Canopy of a parachute",
           WIDE("Force of its lines", "force", KN, {"canopy.line_force", ""}),
           HALF("Its velocity upwards", "velocity", M_S, {"canopy.vy", ""}),
           HALF("Its velocity to the right", "velocity", M_S, {"canopy.vz", ""})),
};
// clang-format on

enum { FIGURES = sizeof figures / sizeof *figures };

const plot_figure *plot_figure_at(size_t index)
{
    return index < FIGURES ? &figures[index] : NULL;
}

const plot_figure *plot_figure_find(const char *name)
{
    for (int i = 0; i < FIGURES; i++)
        if (strcmp(figures[i].about.name, name) == 0)
            return &figures[i];
    return NULL;
}

const ld_figure *ld_figure_at(size_t index)
{
    return index < FIGURES ? &figures[index].about : NULL;
}
