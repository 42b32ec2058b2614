// What the standard figures of a launch show.
#include <string.h>

#include "io/plot.h"

// Factors from SI units to those shown.
#define MILLI 1e3
#define KILO 1e-3
#define DEGREES 57.29577951308232

// Curves over time, in half the width of the page or in all of it; one column against another.
#define HALF(heading, unit, factor, ...)                                                           \
    {                                                                                              \
        .title = heading, .y_label = unit, .y_factor = factor, .curve = { __VA_ARGS__ }            \
    }
#define WIDE(heading, unit, factor, ...)                                                           \
    {                                                                                              \
        .title = heading, .y_label = unit, .y_factor = factor, .curve = {__VA_ARGS__},             \
        .wide = true                                                                               \
    }
#define AGAINST(heading, y_name, y_unit_factor, y, x_name, x_unit_factor, x)                       \
    {                                                                                              \
        .title = heading, .y_label = y_name, .y_factor = y_unit_factor, .curve = {{y, ""}},        \
        .x_column = x, .x_label = x_name, .x_factor = x_unit_factor                                \
    }

// clang-format off
static const plot_figure figures[] = {
    {{"tip", "Tip of the tube against the undeformed tube"},
     {HALF("Position", "mm", MILLI, {"tip.y", "y"}, {"tip.z", "z"}),
      HALF("Direction", "mrad", MILLI, {"tip.pitch", "pitch"}, {"tip.yaw", "yaw"})}},
    {{"tip-rate", "Rates of the tip of the tube"},
     {HALF("Velocity", "m/s", 1, {"tip.vy", "y"}, {"tip.vz", "z"}),
      HALF("Angular rate", "mrad/s", MILLI, {"tip.pitch_rate", "pitch"}, {"tip.yaw_rate", "yaw"})}},
    {{"travel", "Travel of the rocket along the tube"},
     {HALF("Travel", "m", 1, {"rocket.s", "s"}),
      HALF("Speed", "m/s", 1, {"rocket.s_dot", "relative to the tube"}),
      HALF("Roll", "deg", DEGREES, {"rocket.gamma", "relative to the tube"}),
      HALF("Spin", "rad/s", 1, {"rocket.spin", "in inertial space"})}},
    {{"relative", "Rocket relative to the tube"},
     {HALF("Rear adaptor's centre", "mm", MILLI, {"rocket.y", "y"}, {"rocket.z", "z"}),
      HALF("Direction", "mrad", MILLI, {"rocket.psi", "pitch ψ"}, {"rocket.theta", "yaw θ"}),
      AGAINST("Path of the rear adaptor's centre", "y [mm]", MILLI, "rocket.y",
              "z [mm]", MILLI, "rocket.z"),
      AGAINST("Pitch against yaw", "pitch ψ [mrad]", MILLI, "rocket.psi",
              "yaw θ [mrad]", MILLI, "rocket.theta")}},
    {{"phase", "Phase graphs of the rear adaptor's motion across the tube"},
     {AGAINST("Along y", "rate of y [mm/s]", MILLI, "rocket.y_dot", "y [mm]", MILLI, "rocket.y"),
      AGAINST("Along z", "rate of z [mm/s]", MILLI, "rocket.z_dot", "z [mm]", MILLI, "rocket.z")}},
    {{"attitude", "Attitude of the rocket in inertial space"},
     {HALF("Pitch", "deg", DEGREES, {"rocket.pitch", ""}),
      HALF("Yaw", "deg", DEGREES, {"rocket.yaw", ""}),
      WIDE("Rates", "mrad/s", MILLI,
           {"rocket.pitch_rate", "pitch"}, {"rocket.yaw_rate", "yaw"})}},
    {{"contact", "Contact between adaptors and tube"},
     {WIDE("Force, normal and friction together", "kN", KILO, {"contact.*.force", ""}),
      WIDE("Penetration (negative: gap)", "mm", MILLI, {"contact.*.penetration", ""})}},
    {{"slot", "Slot and lock"},
     {HALF("Slot", "kN", KILO, {"slot.force", "force N"}, {"slot.friction", "friction"}),
      HALF("Lock", "kN", KILO, {"lock.force", "force carried"})}},
    {{"energy", "Energy"},
     {HALF("Drive", "kJ", KILO,
           {"work.thrust", "work of the thrust"}, {"energy.kinetic", "kinetic energy"}),
      HALF("Balance", "J", 1, {"energy.residual", "what it misses"}),
      WIDE("Tube and supports", "J", 1,
           {"energy.elastic", "elastic energy"}, {"work.support_damping", "support damping"},
           {"work.modal_damping", "modal damping"}, {"work.contact_normal", "contact, normal"}),
      WIDE("Other work", "J", 1,
           {"work.gravity_rocket", "gravity"}, {"work.contact_friction", "contact friction"},
           {"work.slot_friction", "slot friction"}, {"work.mass_change", "burnt mass"},
           {"work.base", "base"})}},
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
