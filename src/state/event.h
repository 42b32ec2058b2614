// The events that the integrator lands on, by name.
#ifndef LD_STATE_EVENT_H
#define LD_STATE_EVENT_H

#include "state/launch_state.h"

typedef enum event_kind {
    EVENT_RELEASE, // the lock carries its release force
    EVENT_EXIT,    // adaptor `index` leaves the guide, with those that leave with it
    EVENT_TOUCH,   // adaptor `index` begins or ends to touch the tube (law lankarani-nikravesh, or
                   // with a course)
    EVENT_SURFACE, // an adaptor a surface, index = adaptor * surfaces + surface (the same)
    EVENT_BASE,    // number `index` of the base (integrated together alone)
    EVENT_BREECH,  // the rocket touches the breech (law lankarani-nikravesh alone)
    EVENT_LINE,    // a line that the rocket pulls becomes taut, or breaks
    EVENT_STOP,    // a stop of a recoil slide begins or ends to push, index = 2 slide + stop
    EVENT_STATION, // adaptor `index` passes into the tube's next element (with a course alone)
} event_kind;

typedef struct event {
    event_kind kind;
    int index; // 0 where there is one alone
} event;

enum {
    EVENTS_MOST = 3 + LD_MAX_ADAPTORS * (2 + LD_MAX_SURFACES) + BASE_MOST_EVENTS +
                  LD_SLIDE_STOPS * LD_MAX_SUPPORTS
};

// In the order in which the integrator has them.
typedef struct event_list {
    int count;
    event event[EVENTS_MOST];
} event_list;

// All events that a launch can have; those of the base if asked for.
event_list events_of(const launch_state *self, bool base);
// Where an event stands in the list; -1: it is none of them.
int event_find(const event_list *self, event_kind kind, int index);
// The walls that an adaptor can touch: the surfaces of a guide, or one bore.
int event_walls(const launch_state *self);
// How far adaptor `i` is pressed into one of them [m], as event_stop_press does.
double event_wall_press(const launch_state *self, int i, int wall, const launching_output *out);
// Where the element of the tube ends that x lies in [m]; infinity: the last one.
double event_next_station(const launch_state *self, double x);
// How far a stop of a recoil slide is pressed in [m]: positive where it pushes (stop_press), and
// continues with what it does as far as that may be rounding.
double event_stop_press(const launch_state *self, int index, const launching_output *out);
// What goes through zero at each event of the list; one that is not awaited stays away from it.
// Of `out` the base is read where the list has its events, else the launching subsystem alone.
void events_evaluate(const event_list *self, const launch_state *launch, const launcher_output *out,
                     double *g);

#endif
