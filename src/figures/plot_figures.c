// What the standard figures of a launch and of flights show, for gnuplot and the report alike. A
// new figure is a row more of the table.
#include <string.h>

#include "figures/plot.h"

// clang-format off

// Units as they are written at an axis, with the factor from SI.
#define PLAIN {"", 1}
#define M {"m", 1}
#define KM {"km", 1e-3}
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
#define J {"J", 1}
#define KJ {"kJ", 1e-3}
#define KG {"kg", 1}
#define KG_M3 {"kg/m³", 1}

// Curves over time, in half the width of the page or in all of it; their change since ignition;
// one diagram for each part that has the column; one column against another.
#define HALF(heading, in, ...) {.title = heading, .y = {"", in}, .curve = {__VA_ARGS__}}
#define WIDE(heading, in, ...) \
    {.title = heading, .y = {"", in}, .curve = {__VA_ARGS__}, .wide = true}
#define SINCE(heading, in, ...) \
    {.title = heading, .y = {"", in}, .curve = {__VA_ARGS__}, .since = true}
#define EACH(heading, in, column) \
    {.title = heading, .y = {"", in}, .curve = {{column, ""}}, .wide = true, .each = true}
#define AGAINST(heading, y_name, y_in, y_column, x_name, x_in, of) \
    {.title = heading, .y = {y_name, y_in}, .curve = {{y_column, ""}}, .x_column = of, \
     .x = {x_name, x_in}}
#define BROAD(heading, y_name, y_in, y_column, x_name, x_in, of) \
    {.title = heading, .y = {y_name, y_in}, .curve = {{y_column, ""}}, .x_column = of, \
     .x = {x_name, x_in}, .wide = true}

// A figure of what comes after ignition; one over all the time that a vehicle moves; one of the
// flights of the rockets.
#define LAUNCH(name, text, ...) {.about = {name, text}, .panel = {__VA_ARGS__}}
#define VEHICLE(name, text, ...) \
    {.about = {name, text}, .panel = {__VA_ARGS__}, .time = PLOT_VEHICLE}
#define FLIGHT(name, text, ...) \
    {.about = {name, text}, .panel = {__VA_ARGS__}, .time = PLOT_FLIGHT}

static const plot_figure figures[] = {
    // what a launch on the march is looked at by, in the order of the paper's figures 5 to 9
    LAUNCH("tip-inertial", "Tip of the tube in inertial space",
           SINCE("Height since ignition", MM, {"tip.inertial_y", ""}),
           SINCE("To the right since ignition", MM, {"tip.inertial_z", ""}),
           SINCE("Pitch since ignition", MRAD, {"tip.inertial_pitch", ""}),
           SINCE("Yaw since ignition", MRAD, {"tip.inertial_yaw", ""}),
           HALF("Velocity upwards", MM_S, {"tip.inertial_vy", ""}),
           HALF("Velocity to the right", MM_S, {"tip.inertial_vz", ""}),
           HALF("Pitch rate", MRAD_S, {"tip.inertial_pitch_rate", ""}),
           HALF("Yaw rate", MRAD_S, {"tip.inertial_yaw_rate", ""})),
    LAUNCH("tip-rate", "Rates of the tip of the tube against the undeformed tube",
           HALF("Velocity along y", MM_S, {"tip.vy", ""}),
           HALF("Velocity along z", MM_S, {"tip.vz", ""}),
           HALF("Pitch rate", MRAD_S, {"tip.pitch_rate", ""}),
           HALF("Yaw rate", MRAD_S, {"tip.yaw_rate", ""})),
    LAUNCH("across", "Rocket in the tube: travel, motion across it",
           HALF("Travel", M, {"rocket.s", ""}),
           AGAINST("Path of the rear adaptor's centre", "y", MM, "rocket.y",
                   "z", MM, "rocket.z"),
           AGAINST("Its velocity", "rate of y", MM_S, "rocket.y_dot",
                   "rate of z", MM_S, "rocket.z_dot"),
           AGAINST("Pitch against yaw", "pitch ψ", MRAD, "rocket.psi",
                   "yaw θ", MRAD, "rocket.theta")),
    LAUNCH("relative-rate", "Rates of the rocket's angles relative to the tube",
           WIDE("Pitch ψ", MRAD_S, {"rocket.psi_dot", ""}),
           WIDE("Yaw θ", MRAD_S, {"rocket.theta_dot", ""}),
           WIDE("Roll γ", RAD_S, {"rocket.gamma_dot", ""})),
    LAUNCH("contact-force", "Contact forces, normal and friction together",
           EACH("Adaptor %s", KN, "contact.*.force")),
    // the rest of a launch
    LAUNCH("tip", "Tip of the tube against the undeformed tube",
           HALF("Position", MM, {"tip.y", "y"}, {"tip.z", "z"}),
           HALF("Direction", MRAD, {"tip.pitch", "pitch"}, {"tip.yaw", "yaw"})),
    LAUNCH("travel", "Travel of the rocket along the tube",
           HALF("Travel", M, {"rocket.s", "s"}),
           HALF("Speed", M_S, {"rocket.s_dot", "relative to the tube"}),
           HALF("Roll", DEG, {"rocket.gamma", "relative to the tube"}),
           HALF("Spin", RAD_S, {"rocket.spin", "in inertial space"})),
    LAUNCH("relative", "Rocket relative to the tube",
           HALF("Rear adaptor's centre", MM, {"rocket.y", "y"}, {"rocket.z", "z"}),
           HALF("Direction", MRAD, {"rocket.psi", "pitch ψ"}, {"rocket.theta", "yaw θ"}),
           AGAINST("Path of the rear adaptor's centre", "y", MM, "rocket.y",
                   "z", MM, "rocket.z"),
           AGAINST("Pitch against yaw", "pitch ψ", MRAD, "rocket.psi",
                   "yaw θ", MRAD, "rocket.theta")),
    LAUNCH("phase", "Phase graphs of the rear adaptor's motion across the tube",
           AGAINST("Along y", "rate of y", MM_S, "rocket.y_dot", "y", MM, "rocket.y"),
           AGAINST("Along z", "rate of z", MM_S, "rocket.z_dot", "z", MM, "rocket.z")),
    LAUNCH("attitude", "Attitude of the rocket in inertial space",
           HALF("Pitch", DEG, {"rocket.pitch", ""}),
           HALF("Yaw", DEG, {"rocket.yaw", ""}),
           WIDE("Rates", MRAD_S,
                {"rocket.pitch_rate", "pitch"}, {"rocket.yaw_rate", "yaw"})),
    LAUNCH("tip-off", "Rocket against the launcher, in the axes of the undeformed tube",
           HALF("Direction", MRAD, {"tip_off.pitch", "pitch"}, {"tip_off.yaw", "yaw"}),
           HALF("Against the launcher at ignition", MRAD,
                {"aim.pitch", "pitch"}, {"aim.yaw", "yaw"}),
           WIDE("Rates in inertial space", MRAD_S,
                {"tip_off.pitch_rate", "pitch"}, {"tip_off.yaw_rate", "yaw"}),
           WIDE("Rates against the launcher", MRAD_S,
                {"tip_off.pitch_rate_relative", "pitch"}, {"tip_off.yaw_rate_relative", "yaw"}),
           WIDE("Velocity of the mass centre against the launcher", M_S,
                {"tip_off.vy_relative", "y"}, {"tip_off.vz_relative", "z"})),
    LAUNCH("contact", "Contact between adaptors and tube",
           WIDE("Force, normal and friction together", KN, {"contact.*.force", ""}),
           WIDE("Penetration (negative: gap)", MM, {"contact.*.penetration", ""})),
    LAUNCH("slot", "Slot and lock",
           HALF("Slot", KN, {"slot.force", "force N"}, {"slot.friction", "friction"}),
           HALF("Lock", KN, {"lock.force", "force carried"})),
    LAUNCH("loads", "Loads along the tube",
           WIDE("Bending moment carried at the stations", N_M, {"station.*.bending", ""}),
           HALF("Shear force along y", N, {"station.*.shear_y", ""}),
           HALF("Shear force along z", N, {"station.*.shear_z", ""}),
           HALF("Axial force, tension positive", N, {"station.*.axial", ""}),
           HALF("Torque", N_M, {"station.*.torque", ""}),
           HALF("Supports on the tube, along y", N, {"support.*.force_y", ""}),
           HALF("Supports on the tube, along z", N, {"support.*.force_z", ""})),
    LAUNCH("pressure", "Pressure behind the rocket",
           HALF("Pressure less that before the rocket", MPA, {"pressure.net", ""}),
           HALF("Force on the rocket", KN, {"pressure.force", ""})),
    LAUNCH("recoil", "Recoil of the tube on its slides",
           HALF("Way back", MM, {"recoil.*.travel", ""}),
           HALF("Speed", M_S, {"recoil.*.rate", ""}),
           WIDE("Force on the tube, forwards", KN, {"recoil.*.force", ""})),
    LAUNCH("energy", "Energy",
           HALF("Drive", KJ,
                {"work.thrust", "work of the thrust"}, {"work.pressure", "work of the pressure"},
                {"energy.kinetic", "kinetic energy"}),
           HALF("Balance", J, {"energy.residual", "what it misses"}),
           WIDE("Tube and supports", J,
                {"energy.elastic", "elastic energy"}, {"work.support_damping", "support damping"},
                {"work.modal_damping", "modal damping"}, {"work.contact_normal", "contact, normal"}),
           WIDE("Other work", J,
                {"work.gravity_rocket", "gravity"}, {"work.contact_friction", "contact friction"},
                {"work.slot_friction", "slot friction"}, {"work.mass_change", "burnt mass"},
                {"work.base", "base"}, {"work.recoil", "recoil slides"})),
    VEHICLE("wheels", "Road and wheels",
           WIDE("Road under the wheels", MM, {"wheel.*.road", ""}),
           WIDE("Suspension travel from unloaded", MM, {"wheel.*.travel", ""}),
           WIDE("Tyre deflection", MM, {"wheel.*.deflection", ""})),
    VEHICLE("tyres", "Tyre forces",
           WIDE("Vertical", KN, {"wheel.*.tyre_force", ""}),
           WIDE("Across the way", N, {"wheel.*.side", ""}),
           WIDE("Along the way", N, {"wheel.*.along", ""})),
    VEHICLE("chassis", "Chassis",
           WIDE("Height of the mass centre", MM, {"chassis.y", ""}),
           HALF("Pitch", MRAD, {"chassis.pitch", ""}),
           HALF("Roll", MRAD, {"chassis.roll", ""}),
           HALF("Speed", M_S, {"drive.speed", ""}),
           HALF("Drive force", KN, {"drive.force", ""})),
    VEHICLE("platform", "Platforms",
           HALF("Azimuth: yaw in inertial space", DEG,
                {"azimuth.measured", "measured"}, {"azimuth.command", "command"}),
           HALF("Elevation: pitch in inertial space", DEG,
                {"elevation.measured", "measured"}, {"elevation.command", "command"}),
           WIDE("Error, command less measured", MRAD,
                {"elevation.error", "elevation"}, {"azimuth.error", "azimuth"}),
           HALF("Torque of the azimuth's stabiliser", KN_M, {"azimuth.torque", ""}),
           HALF("Torque of the elevation's stabiliser", KN_M, {"elevation.torque", ""})),
    FLIGHT("trajectory", "Trajectories of the rockets",
           BROAD("Height over the way along x", "altitude", KM, "altitude",
                 "x", KM, "center.x"),
           BROAD("Ground track", "to the right, z", KM, "center.z",
                 "x", KM, "center.x")),
    FLIGHT("flight", "Free flight",
           HALF("Altitude", M, {"altitude", ""}),
           HALF("Mach number", PLAIN, {"mach", ""}),
           HALF("Pitch", DEG, {"rocket.pitch", ""}),
           HALF("Yaw", DEG, {"rocket.yaw", ""}),
           HALF("Angle of attack", DEG, {"angle_of_attack", ""}),
           HALF("Spin", RAD_S, {"rocket.spin", ""})),
    FLIGHT("flight-speed", "Speed through the air, velocity against the ground",
           HALF("Through the air", M_S, {"airspeed", ""}),
           HALF("Along x", M_S, {"center.vx", ""}),
           HALF("Upwards", M_S, {"center.vy", ""}),
           HALF("To the right", M_S, {"center.vz", ""})),
    FLIGHT("flight-rate", "Rates in flight, in inertial space",
           HALF("Pitch rate", RAD_S, {"rocket.pitch_rate", ""}),
           HALF("Yaw rate", RAD_S, {"rocket.yaw_rate", ""})),
    FLIGHT("flight-wind", "Wind where the rocket flies",
           WIDE("Along x", M_S, {"wind.x", ""}),
           HALF("Upwards", M_S, {"wind.y", ""}),
           HALF("To the right", M_S, {"wind.z", ""})),
    FLIGHT("flight-loads", "Dynamic pressure, acceleration, stability",
           HALF("Dynamic pressure", KPA, {"dynamic_pressure", ""}),
           HALF("Acceleration of the mass centre", M_S2, {"acceleration", ""}),
           WIDE("Mass centre ahead of the centre of pressure [reference diameters]", PLAIN,
                {"stability_margin", ""})),
    FLIGHT("flight-motor", "Motor and air",
           HALF("Thrust", KN, {"thrust", ""}),
           HALF("Mass", KG, {"rocket.mass", ""}),
           HALF("Density of the air", KG_M3, {"density", ""})),
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
