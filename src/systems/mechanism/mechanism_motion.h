// Where the bodies of a mechanism are and how they move, and what its holds measure of that.
#ifndef LD_SYSTEMS_MECHANISM_MOTION_H
#define LD_SYSTEMS_MECHANISM_MOTION_H

#include "systems/mechanism/mechanism.h"

// Where a point is and how it moves; its axes turned as said.
body_motion mechanism_point_motion(const mechanism_motion *motion, const mechanism_point *point);

// A strut from one end to the other.
typedef struct strut_line {
    body_motion from, to;
    v3 e;                // along it
    double length, rate; // [m], [m/s]
} strut_line;

void mechanism_strut_line(const mechanism_motion *motion, const mechanism_strut *strut,
                          strut_line *line);

// The chain's coordinates and speeds: those of the state, then the carrier's.
void mechanism_gather(const mechanism_system *self, const base_frame *carrier, const double *state,
                      double *q, double *u);

// Frames and motions of the elements that are seen at time t [s], from the state.
void mechanism_move(const mechanism_system *self, double t, const base_frame *carrier,
                    const double *state, mechanism_motion *motion);

// Takes the chain to a motion, unless it stands there. How an element moves then.
void mechanism_stand(const mechanism_system *self, const mechanism_motion *motion);
body_motion mechanism_body_motion(const mechanism_system *self, int element);

// What a hold is to keep at time t [s], and its rate.
double mechanism_command(const mechanism_hold *hold, double t, double *rate);

// What a hold measures, its command and error; no torque. The chain stands there.
void mechanism_watch(const mechanism_system *self, int hold, const mechanism_motion *motion,
                     hinge_report *report);

#endif
