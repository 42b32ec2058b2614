// The instants that figures mark, and when they are in a history.
#include <math.h>

#include "figures/plot.h"

enum { LAUNCH = 1 << PLOT_LAUNCH, VEHICLE = 1 << PLOT_VEHICLE, FLIGHT = 1 << PLOT_FLIGHT };
enum { IGNITION, RELEASE, FRONT, MIDDLE, REAR, EXIT, BURNOUT, APOGEE, PARACHUTE, NEXT, IMPACT };

// In the order in which they come, most often.
static const plot_instant instants[] = {
    [IGNITION] = {"ignition", 0, LAUNCH | VEHICLE},
    [RELEASE] = {"release", 2, LAUNCH},
    [FRONT] = {"front", 3, LAUNCH},
    [MIDDLE] = {"middle", 4, LAUNCH},
    [REAR] = {"rear", 1, LAUNCH | VEHICLE},
    [EXIT] = {"exit", 0, FLIGHT},
    [BURNOUT] = {"burnout", 2, FLIGHT},
    [APOGEE] = {"apogee", 1, FLIGHT},
    [PARACHUTE] = {"parachute", 2, FLIGHT},
    [NEXT] = {"next parachute", 2, FLIGHT},
    [IMPACT] = {"impact", 0, FLIGHT},
};
_Static_assert(sizeof instants / sizeof *instants == PLOT_INSTANTS, "an instant is missing");

const plot_instant *plot_instant_at(int index)
{
    return index < PLOT_INSTANTS ? &instants[index] : NULL;
}

bool plot_marks(const plot_figure *figure, int index)
{
    return (instants[index].figures >> figure->time & 1) != 0;
}

// When the thrust ends; NaN where a flight has none, or has it to its end.
static double burnout_of(const history_data *history, const double *t)
{
    const double *thrust = history_column(history, "thrust");
    size_t after = thrust ? history->rows : 0;
    while (after > 0 && !(thrust[after - 1] > 0))
        after--;
    return after > 0 && after < history->rows ? t[after] : NAN;
}

// When parachutes begin to open: after which rows their drag area begins to grow.
static void find_openings(const history_data *history, const double *t, double opening[2])
{
    const double *area = history_column(history, "drag_area");
    opening[0] = opening[1] = NAN;
    bool grew = false;
    for (size_t row = 1, found = 0; area && row < history->rows && found < 2; row++) {
        bool grows = area[row] > area[row - 1] * (1 + 1e-9);
        if (grows && !grew)
            opening[found++] = t[row - 1];
        grew = grows;
    }
}

void plot_find_instants(const history_data *history, double at[PLOT_INSTANTS])
{
    double start = isfinite(history->t_ignition) ? history->t_ignition : 0, opening[2];
    const double *t = history_column(history, "t");
    at[IGNITION] = 0;
    at[RELEASE] = history->t_release;
    at[FRONT] = history->t_front;
    at[MIDDLE] = history->t_middle;
    at[REAR] = at[EXIT] = history->t_rear;
    at[APOGEE] = history->t_apogee;
    at[IMPACT] = history->t_impact;
    at[BURNOUT] = at[PARACHUTE] = at[NEXT] = NAN;
    if (!t)
        return;
    at[BURNOUT] = burnout_of(history, t) - start;
    find_openings(history, t, opening);
    at[PARACHUTE] = opening[0] - start;
    at[NEXT] = opening[1] - start;
}
