// Steps that an integrator outside takes: the point where it is, the last one that counts as a
// step's end, and what has gone through zero between the two.
#ifndef LD_SIMULATION_OUTSIDE_STEPS_H
#define LD_SIMULATION_OUTSIDE_STEPS_H

#include "base/archive.h"
#include "state/event.h"

typedef struct outside_point {
    double t; // [s]
    double y[LD_MAX_STATES], rate[LD_MAX_STATES];
} outside_point;

typedef struct outside_steps {
    int states, events;
    outside_point last, now;    // the rates of `now` once a step ends there
    bool accepted;              // one does
    double value[EVENTS_MOST];  // of the events, at `last`
    int direction[EVENTS_MOST]; // in which each goes through zero up to `now`, 0: it does not
    int64_t steps, evaluations;
} outside_steps;

// Where it is; what was found of another point is found anew.
void outside_steps_place(outside_steps *self, double t, const double *y);
// A step ends at `now`, whose rates are there: finds the directions from the events' values there;
// whether one goes through zero.
bool outside_steps_accept(outside_steps *self, const double *value);
// The next step begins at `now`, whose rates are there, with these values of the events.
void outside_steps_begin(outside_steps *self, const double *value);
// The state between the two points: cubic Hermite interpolation.
void outside_steps_interpolate(const outside_steps *self, double t, double *y);
void outside_steps_archive(outside_steps *self, archive *bytes);

#endif
