// What the standard figures of a launch show.
#include <string.h>

#include "figures/plot.h"

// Factors from SI units to those shown.
#define MILLI 1e3
#define KILO 1e-3
#define DEGREES 57.29577951308232

// Curves over time, in half the width of the page or in all of it; their change since ignition;
// one diagram for each part that has the column; one column against another.
#define HALF(heading, unit, factor, ...)                                                           \
    {                                                                                              \
        .title = heading, .y_label = unit, .y_factor = factor, .curve = { __VA_ARGS__ }            \
    }
#define WIDE(heading, unit, factor, ...)                                                           \
    {                                                                                              \
        .title = heading, .y_label = unit, .y_factor = factor, .curve = {__VA_ARGS__},             \
        .wide = true                                                                               \
    }
#define SINCE(heading, unit, factor, ...)                                                          \
    {                                                                                              \
        .title = heading, .y_label = unit, .y_factor = factor, .curve = {__VA_ARGS__},             \
        .since = true                                                                              \
    }
#define EACH(heading, unit, factor, column)                                                        \
    {                                                                                              \
        .title = heading, .y_label = unit, .y_factor = factor, .curve = {{column, ""}},            \
        .wide = true, .each = true                                                                 \
    }
#define AGAINST(heading, y_name, y_unit_factor, y, x_name, x_unit_factor, x)                       \
    {                                                                                              \
        .title = heading, .y_label = y_name, .y_factor = y_unit_factor, .curve = {{y, ""}},        \
        .x_column = x, .x_label = x_name, .x_factor = x_unit_factor                                \
    }
#define BROAD(heading, y_name, y_unit_factor, y, x_name, x_unit_factor, x)                         \
    {                                                                                              \
        .title = heading, .y_label = y_name, .y_factor = y_unit_factor, .curve = {{y, ""}},        \
        .x_column = x, .x_label = x_name, .x_factor = x_unit_factor, .wide = true                  \
    }

// A figure of what comes after ignition; one over all the time that a vehicle moves; one of the
// flights of the rockets.
#define LAUNCH(name, text, ...)                                                                    \
    {                                                                                              \
        .about = {name, text}, .panel = { __VA_ARGS__ }                                            \
    }
#define VEHICLE(name, text, ...)                                                                   \
    {                                                                                              \
        .about = {name, text}, .panel = {__VA_ARGS__}, .time = PLOT_VEHICLE                        \
    }
#define FLIGHT(name, text, ...)                                                                    \
    {                                                                                              \
        .about = {name, text}, .panel = {__VA_ARGS__}, .time = PLOT_FLIGHT                         \
    }

// clang-format off
static const plot_figure figures[] = {
    LAUNCH("tip", "Tip of the tube against the undeformed tube",
           HALF("Position", "mm", MILLI, {"tip.y", "y"}, {"tip.z", "z"}),
           HALF("Direction", "mrad", MILLI, {"tip.pitch", "pitch"}, {"tip.yaw", "yaw"})),
    LAUNCH("tip-rate", "Rates of the tip of the tube",
           HALF("Velocity", "m/s", 1, {"tip.vy", "y"}, {"tip.vz", "z"}),
           HALF("Angular rate", "mrad/s", MILLI, {"tip.pitch_rate", "pitch"}, {"tip.yaw_rate", "yaw"})),
    LAUNCH("tip-inertial", "Tip of the tube in inertial space",
           SINCE("Height since ignition", "mm", MILLI, {"tip.inertial_y", ""}),
           SINCE("To the right since ignition", "mm", MILLI, {"tip.inertial_z", ""}),
           SINCE("Pitch since ignition", "mrad", MILLI, {"tip.inertial_pitch", ""}),
           SINCE("Yaw since ignition", "mrad", MILLI, {"tip.inertial_yaw", ""}),
           HALF("Velocity upwards", "mm/s", MILLI, {"tip.inertial_vy", ""}),
           HALF("Velocity to the right", "mm/s", MILLI, {"tip.inertial_vz", ""}),
           HALF("Pitch rate", "mrad/s", MILLI, {"tip.inertial_pitch_rate", ""}),
           HALF("Yaw rate", "mrad/s", MILLI, {"tip.inertial_yaw_rate", ""})),
    LAUNCH("travel", "Travel of the rocket along the tube",
           HALF("Travel", "m", 1, {"rocket.s", "s"}),
           HALF("Speed", "m/s", 1, {"rocket.s_dot", "relative to the tube"}),
           HALF("Roll", "deg", DEGREES, {"rocket.gamma", "relative to the tube"}),
           HALF("Spin", "rad/s", 1, {"rocket.spin", "in inertial space"})),
    LAUNCH("relative", "Rocket relative to the tube",
           HALF("Rear adaptor's centre", "mm", MILLI, {"rocket.y", "y"}, {"rocket.z", "z"}),
           HALF("Direction", "mrad", MILLI, {"rocket.psi", "pitch ψ"}, {"rocket.theta", "yaw θ"}),
           AGAINST("Path of the rear adaptor's centre", "y [mm]", MILLI, "rocket.y",
                   "z [mm]", MILLI, "rocket.z"),
           AGAINST("Pitch against yaw", "pitch ψ [mrad]", MILLI, "rocket.psi",
                   "yaw θ [mrad]", MILLI, "rocket.theta")),
    LAUNCH("phase", "Phase graphs of the rear adaptor's motion across the tube",
           AGAINST("Along y", "rate of y [mm/s]", MILLI, "rocket.y_dot", "y [mm]", MILLI, "rocket.y"),
           AGAINST("Along z", "rate of z [mm/s]", MILLI, "rocket.z_dot", "z [mm]", MILLI, "rocket.z")),
    LAUNCH("across", "Motion of the rocket across the tube",
           HALF("Travel", "m", 1, {"rocket.s", ""}),
           AGAINST("Path of the rear adaptor's centre", "y [mm]", MILLI, "rocket.y",
                   "z [mm]", MILLI, "rocket.z"),
           AGAINST("Its velocity", "rate of y [mm/s]", MILLI, "rocket.y_dot",
                   "rate of z [mm/s]", MILLI, "rocket.z_dot"),
           AGAINST("Pitch against yaw", "pitch ψ [mrad]", MILLI, "rocket.psi",
                   "yaw θ [mrad]", MILLI, "rocket.theta")),
    LAUNCH("relative-rate", "Rates of the rocket's angles relative to the tube",
           WIDE("Pitch ψ", "mrad/s", MILLI, {"rocket.psi_dot", ""}),
           WIDE("Yaw θ", "mrad/s", MILLI, {"rocket.theta_dot", ""}),
           WIDE("Roll γ", "rad/s", 1, {"rocket.gamma_dot", ""})),
    LAUNCH("attitude", "Attitude of the rocket in inertial space",
           HALF("Pitch", "deg", DEGREES, {"rocket.pitch", ""}),
           HALF("Yaw", "deg", DEGREES, {"rocket.yaw", ""}),
           WIDE("Rates", "mrad/s", MILLI,
                {"rocket.pitch_rate", "pitch"}, {"rocket.yaw_rate", "yaw"})),
    LAUNCH("tip-off", "Rocket against the launcher, in the axes of the undeformed tube",
           HALF("Direction", "mrad", MILLI, {"tip_off.pitch", "pitch"}, {"tip_off.yaw", "yaw"}),
           HALF("Against the launcher at ignition", "mrad", MILLI,
                {"aim.pitch", "pitch"}, {"aim.yaw", "yaw"}),
           WIDE("Rates in inertial space", "mrad/s", MILLI,
                {"tip_off.pitch_rate", "pitch"}, {"tip_off.yaw_rate", "yaw"}),
           WIDE("Rates against the launcher", "mrad/s", MILLI,
                {"tip_off.pitch_rate_relative", "pitch"}, {"tip_off.yaw_rate_relative", "yaw"}),
           WIDE("Velocity of the mass centre against the launcher", "m/s", 1,
                {"tip_off.vy_relative", "y"}, {"tip_off.vz_relative", "z"})),
    LAUNCH("contact", "Contact between adaptors and tube",
           WIDE("Force, normal and friction together", "kN", KILO, {"contact.*.force", ""}),
           WIDE("Penetration (negative: gap)", "mm", MILLI, {"contact.*.penetration", ""})),
    LAUNCH("contact-force", "Contact forces, normal and friction together",
           EACH("Adaptor %s", "kN", KILO, "contact.*.force")),
    LAUNCH("slot", "Slot and lock",
           HALF("Slot", "kN", KILO, {"slot.force", "force N"}, {"slot.friction", "friction"}),
           HALF("Lock", "kN", KILO, {"lock.force", "force carried"})),
    LAUNCH("energy", "Energy",
           HALF("Drive", "kJ", KILO,
                {"work.thrust", "work of the thrust"}, {"energy.kinetic", "kinetic energy"}),
           HALF("Balance", "J", 1, {"energy.residual", "what it misses"}),
           WIDE("Tube and supports", "J", 1,
                {"energy.elastic", "elastic energy"}, {"work.support_damping", "support damping"},
                {"work.modal_damping", "modal damping"}, {"work.contact_normal", "contact, normal"}),
           WIDE("Other work", "J", 1,
                {"work.gravity_rocket", "gravity"}, {"work.contact_friction", "contact friction"},
                {"work.slot_friction", "slot friction"}, {"work.mass_change", "burnt mass"},
                {"work.base", "base"})),
    VEHICLE("wheels", "Road and wheels",
           WIDE("Road under the wheels", "mm", MILLI, {"wheel.*.road", ""}),
           WIDE("Suspension travel from unloaded", "mm", MILLI, {"wheel.*.travel", ""}),
           WIDE("Tyre deflection", "mm", MILLI, {"wheel.*.deflection", ""})),
    VEHICLE("tyres", "Tyre forces",
           WIDE("Vertical", "kN", KILO, {"wheel.*.tyre_force", ""}),
           WIDE("Across the way", "N", 1, {"wheel.*.side", ""}),
           WIDE("Along the way", "N", 1, {"wheel.*.along", ""})),
    VEHICLE("chassis", "Chassis",
           WIDE("Height of the mass centre", "mm", MILLI, {"chassis.y", ""}),
           HALF("Pitch", "mrad", MILLI, {"chassis.pitch", ""}),
           HALF("Roll", "mrad", MILLI, {"chassis.roll", ""}),
           HALF("Speed", "m/s", 1, {"drive.speed", ""}),
           HALF("Drive force", "kN", KILO, {"drive.force", ""})),
    VEHICLE("platform", "Platforms",
           HALF("Azimuth: yaw in inertial space", "deg", DEGREES,
                {"azimuth.measured", "measured"}, {"azimuth.command", "command"}),
           HALF("Elevation: pitch in inertial space", "deg", DEGREES,
                {"elevation.measured", "measured"}, {"elevation.command", "command"}),
           WIDE("Error, command less measured", "mrad", MILLI,
                {"elevation.error", "elevation"}, {"azimuth.error", "azimuth"}),
           HALF("Torque of the azimuth's stabiliser", "kN m", KILO, {"azimuth.torque", ""}),
           HALF("Torque of the elevation's stabiliser", "kN m", KILO, {"elevation.torque", ""})),
    FLIGHT("trajectory", "Trajectories of the rockets",
           BROAD("Height over the way along x", "altitude [km]", KILO, "altitude",
                 "x [km]", KILO, "center.x"),
           BROAD("Ground track", "to the right, z [km]", KILO, "center.z",
                 "x [km]", KILO, "center.x")),
    FLIGHT("flight", "Free flight",
           HALF("Altitude", "m", 1, {"altitude", ""}),
           HALF("Mach number", "", 1, {"mach", ""}),
           HALF("Pitch", "deg", DEGREES, {"rocket.pitch", ""}),
           HALF("Yaw", "deg", DEGREES, {"rocket.yaw", ""}),
           HALF("Angle of attack", "deg", DEGREES, {"angle_of_attack", ""}),
           HALF("Spin", "rad/s", 1, {"rocket.spin", ""})),
};
// clang-format on

enum { FIGURES = sizeof figures / sizeof *figures };

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
