// What the figures of a report show: those of a launch are the standard ones, of a flight there are
// more, each of one rocket.
#include "report/report_parts.h"

#define DEGREES 57.29577951308232

#define OVER(heading, unit, factor, ...)                                                           \
    {                                                                                              \
        .title = heading, .y_label = unit, .y_factor = factor, .curve = { __VA_ARGS__ }            \
    }
#define AGAINST(heading, y_name, y, x_name, x)                                                     \
    {                                                                                              \
        .title = heading, .y_label = y_name, .y_factor = 1, .curve = {{y, ""}}, .x_column = x,     \
        .x_label = x_name, .x_factor = 1                                                           \
    }

// clang-format off
static const plot_figure flight[] = {
    {.about = {"trajectory", "Trajectory of the mass centre"},
     .panel = {AGAINST("From the side", "y [m]", "center.y", "x [m]", "center.x"),
               AGAINST("From above", "z, to the right [m]", "center.z", "x [m]", "center.x"),
               OVER("Altitude", "m", 1, {"altitude", ""})}},
    {.about = {"flight-speed", "Speed"},
     .panel = {OVER("Through the air", "m/s", 1, {"airspeed", ""}),
               OVER("Mach number", "1", 1, {"mach", ""}),
               OVER("Against the ground", "m/s", 1,
                    {"center.vx", "x"}, {"center.vy", "y"}, {"center.vz", "z"}),
               OVER("Wind", "m/s", 1, {"wind.x", "x"}, {"wind.y", "y"}, {"wind.z", "z"})}},
    {.about = {"flight-attitude", "Attitude in flight"},
     .panel = {OVER("Pitch and yaw", "deg", DEGREES, {"rocket.pitch", "pitch"}, {"rocket.yaw", "yaw"}),
               OVER("Angle of attack", "deg", DEGREES, {"angle_of_attack", ""}),
               OVER("Rates", "rad/s", 1, {"rocket.pitch_rate", "pitch"}, {"rocket.yaw_rate", "yaw"}),
               OVER("Spin", "rad/s", 1, {"rocket.spin", ""})}},
    {.about = {"flight-motor", "Motor and air"},
     .panel = {OVER("Thrust", "kN", 1e-3, {"thrust", ""}),
               OVER("Mass", "kg", 1, {"rocket.mass", ""}),
               OVER("Density of the air", "kg/m³", 1, {"density", ""})}},
};
// clang-format on

const plot_figure *report_figure_at(bool in_flight, size_t index)
{
    if (in_flight)
        return index < sizeof flight / sizeof *flight ? &flight[index] : NULL;
    const ld_figure *about;
    for (size_t i = 0; (about = ld_figure_at(i)) != NULL; i++) {
        const plot_figure *figure = plot_figure_find(about->name);
        if (figure->time != PLOT_FLIGHT && index-- == 0)
            return figure;
    }
    return NULL;
}

bool report_is_flight(const history_data *history)
{
    return history_column(history, "altitude") != NULL;
}
