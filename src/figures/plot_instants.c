// The instants that figures mark, and when they are in a history.
#include <math.h>

#include "figures/plot.h"

enum { LAUNCH = 1 << PLOT_LAUNCH, VEHICLE = 1 << PLOT_VEHICLE, FLIGHT = 1 << PLOT_FLIGHT };

// Marks an instant, where there is one.
static void mark_instant(plot_marks *marks, const char *name, double t, int rank, unsigned figures)
{
    if (!isfinite(t) || marks->count == PLOT_MARKS)
        return;
    plot_mark *added = &marks->mark[marks->count++];
    *added = (plot_mark){.t = t, .rank = rank, .figures = figures};
    snprintf(added->name, sizeof added->name, "%s", name);
}

// Those of a rocket on the launcher; of several they are numbered.
static void mark_launch(plot_marks *marks, const history_data *history, int number, double start)
{
    const history_data *rocket = &history->rocket[number];
    size_t first = marks->count;
    const struct {
        const char *name;
        double t;
        int rank;
        unsigned figures;
    } instant[] = {{"ignition", 0, 0, LAUNCH | VEHICLE},
                   {"release", rocket->t_release, 2, LAUNCH},
                   {"front", rocket->t_front, 3, LAUNCH},
                   {"middle", rocket->t_middle, 4, LAUNCH},
                   {"rear", rocket->t_rear, 1, LAUNCH | VEHICLE}};
    for (size_t i = 0; i < sizeof instant / sizeof *instant; i++) {
        char name[LD_MAX_NAME];
        snprintf(name, sizeof name, history->rockets > 1 ? "%s %d" : "%s", instant[i].name,
                 number + 1);
        mark_instant(marks, name, rocket->t_ignition - start + instant[i].t, instant[i].rank,
                     instant[i].figures);
    }
    for (size_t i = first; i < marks->count; i++)
        marks->mark[i].rocket = number;
}

// When the thrust ends; NaN where a flight has none, or has it to its end.
static double burnout_of(const history_data *history)
{
    const double *t = history_column(history, "t"), *thrust = history_column(history, "thrust");
    size_t after = t && thrust ? history->rows : 0;
    while (after > 0 && !(thrust[after - 1] > 0))
        after--;
    return after > 0 && after < history->rows ? t[after] : NAN;
}

static void mark_flight(plot_marks *marks, const history_data *flight, double start)
{
    mark_instant(marks, "exit", flight->t_rear, 0, FLIGHT);
    mark_instant(marks, "burnout", burnout_of(flight) - start, 2, FLIGHT);
    mark_instant(marks, "apogee", flight->t_apogee, 1, FLIGHT);
    for (int i = 0; i < flight->openings; i++)
        mark_instant(marks, flight->opening[i].name, flight->opening[i].t, 2, FLIGHT);
    mark_instant(marks, "landing", flight->t_impact, 0, FLIGHT);
}

// As they come; what comes at one time stays as it was.
static void sort_marks(plot_marks *marks)
{
    for (size_t i = 1; i < marks->count; i++) {
        plot_mark one = marks->mark[i];
        size_t k = i;
        for (; k > 0 && marks->mark[k - 1].t > one.t; k--)
            marks->mark[k] = marks->mark[k - 1];
        marks->mark[k] = one;
    }
}

void plot_find_marks(const history_data *history, bool flight, plot_marks *marks)
{
    double start = isfinite(history->t_ignition) ? history->t_ignition : 0;
    marks->count = 0;
    for (int i = 0; i < history->rockets && !flight; i++)
        mark_launch(marks, history, i, start);
    if (flight)
        mark_flight(marks, history, start);
    sort_marks(marks);
}
