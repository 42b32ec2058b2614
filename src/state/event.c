#include "state/event.h"

#include <math.h>

#include "model/parts.h"

static void add(event_list *self, event_kind kind, int count)
{
    for (int i = 0; i < count; i++)
        self->event[self->count++] = (event){kind, i};
}

event_list events_of(const launch_state *self, bool base)
{
    event_list list = {0};
    const launching_system *launching = &self->launcher.launching;
    int adaptors = launching->adaptors.count, surfaces = launching->surfaces.count;
    bool by_touch = launching->adaptors.law.by_touch;
    add(&list, EVENT_RELEASE, 1);
    add(&list, EVENT_EXIT, adaptors);
    add(&list, EVENT_TOUCH, surfaces ? 0 : adaptors);
    add(&list, EVENT_SURFACE, by_touch || self->course ? adaptors * surfaces : 0);
    add(&list, EVENT_BASE, base ? self->launcher.base.event_count : 0);
    add(&list, EVENT_BREECH, 1);
    add(&list, EVENT_LINE, self->rocket->line.present);
    add(&list, EVENT_STOP, LD_SLIDE_STOPS * model_slide_count(self->model));
    add(&list, EVENT_STATION, self->course ? adaptors : 0);
    return list;
}

int event_find(const event_list *self, event_kind kind, int index)
{
    for (int i = 0; i < self->count; i++)
        if (self->event[i].kind == kind && self->event[i].index == index)
            return i;
    return -1;
}

double event_stop_press(const launch_state *self, int index, const launching_output *out)
{
    // beyond rounding, which would make a tube that lies on a stop without a force come and go
    const double least = 1e-13;
    int slide = index / LD_SLIDE_STOPS, stop = index % LD_SLIDE_STOPS;
    double press =
        supports_stop_press(&self->launcher.launching.supports, slide, stop, &out->slide[slide]);
    return press + self->phase.pushing[slide][stop] * least;
}

int event_walls(const launch_state *self)
{
    int surfaces = self->launcher.launching.surfaces.count;
    return surfaces ? surfaces : 1;
}

static double wall_penetration(const launch_state *self, int i, int wall,
                               const launching_output *out)
{
    return self->launcher.launching.surfaces.count ? out->shoe[i].penetration[wall]
                                                   : out->adaptor[i].penetration;
}

double event_wall_press(const launch_state *self, int i, int wall, const launching_output *out)
{
    const double least = 1e-13; // as that of stops
    return wall_penetration(self, i, wall, out) + self->corner[i].touching[wall] * least;
}

double event_next_station(const launch_state *self, double x)
{
    const flexible_tube *tube = &self->launcher.launching.tube.flexible;
    int e = flexible_tube_find(tube, x);
    return e < tube->element_count - 1 ? tube->element[e].x1 : INFINITY;
}

// The section at the rear adaptor carries the rocket's coordinates; at others it counts where they
// touch. Steps end a nanometre beyond, so that the next ones have the next element alone.
static double station_left(const launch_state *self, int i, const launching_output *out)
{
    const double beyond = 1e-9;
    bool touching = i == 0 || self->launcher.launching.adaptors.law.two_sided;
    for (int k = 0; k < event_walls(self); k++)
        touching |= self->corner[i].touching[k] > 0;
    return touching ? self->corner[i].station + beyond - out->adaptor[i].s : INFINITY;
}

// Rises through zero at a first touch. Zero itself, where between opposite surfaces without play
// one touches and the other releases, counts as touched, else it would be an event of both; by so
// much that the search for a crossing, which goes by the values, does not stay on the spot.
static double touch_of(double penetration)
{
    const double least = 1e-15; // [m]
    return (penetration < 0 ? penetration : fmax(penetration, least)) / 1e-3;
}

// Of a launch with a course every touch counts from the ignition on: what waits before takes long
// steps.
static double wall_value(const launch_state *self, int i, int wall, const launching_output *out)
{
    const contact_law *law = &self->launcher.launching.adaptors.law;
    const double away = 1;
    if (self->phase.passed[i])
        return away;
    if (self->course && launch_is_ignited(self) && !law->two_sided)
        return event_wall_press(self, i, wall, out) / 1e-3;
    return law->by_touch ? touch_of(wall_penetration(self, i, wall, out)) : away;
}

// Of adaptors that leave together the first one's.
static double exit_value(const launch_state *self, int i, const adaptor_report *adaptor)
{
    const launching_system *launching = &self->launcher.launching;
    const adaptor_set *adaptors = &launching->adaptors;
    const double away = 1;
    if (self->phase.passed[i] || adaptors->leaves_with[i] != i)
        return away;
    return (adaptors->end[i] - adaptor[i].s) / launching->tube.flexible.length;
}

static double value_of(event one, const launch_state *self, const launcher_output *out)
{
    const launching_phase *phase = &self->phase;
    const launching_system *launching = &self->launcher.launching;
    const adaptor_report *adaptor = out->launching.adaptor;
    const double away = 1;
    bool touching = launching->adaptors.law.by_touch;
    if (one.kind == EVENT_BASE)
        return out->base.event[one.index] / 1e-3;
    if (one.kind == EVENT_STOP) // the tube still recoils when the rocket has left
        return event_stop_press(self, one.index, &out->launching) / 1e-3;
    if (!phase->rocket)
        return away;
    switch (one.kind) {
    case EVENT_RELEASE:
        return phase->locked && !self->held_down
                   ? 1 - out->launching.lock_force / self->rocket->lock.release_force
                   : away;
    case EVENT_EXIT:
        return exit_value(self, one.index, adaptor);
    case EVENT_TOUCH:
        return wall_value(self, one.index, 0, &out->launching);
    case EVENT_SURFACE: {
        int surfaces = launching->surfaces.count;
        return wall_value(self, one.index / surfaces, one.index % surfaces, &out->launching);
    }
    case EVENT_BREECH: // the rear adaptor is at s
        return touching && !phase->locked ? (phase->breech - adaptor[0].s) / 1e-3 : away;
    case EVENT_LINE:
        return out->launching.line_left;
    case EVENT_STATION:
        return phase->passed[one.index] || !launch_is_ignited(self)
                   ? away
                   : fmin(station_left(self, one.index, &out->launching), away);
    default:
        return away;
    }
}

void events_evaluate(const event_list *self, const launch_state *launch, const launcher_output *out,
                     double *g)
{
    for (int i = 0; i < self->count; i++)
        g[i] = value_of(self->event[i], launch, out);
}
