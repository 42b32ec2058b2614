// What happens at events and stops of a launch.
#ifndef LD_LAUNCH_LAUNCH_EVENTS_H
#define LD_LAUNCH_LAUNCH_EVENTS_H

#include "launch/launch_run.h"

// Switches what the events just located say; true where the equations changed.
bool launch_switch_phase(ld_run *run, double t, const double *y);
// The same of the stops of recoil slides, after each step; `at_event`: which ended at one.
bool launch_hold_stops(ld_run *run, double t, const double *y, bool at_event);
// The same of the corners of adaptors, of a launch with a course, at its start, events and stops.
void launch_pass_corners(ld_run *run, double t, const double *y, bool at_event);
// Lays out the slack of a line, at the start.
void launch_lay_line(ld_run *run, double t, const double *y);
// Opens a lock that carries more than its release force without a crossing to be located; breaks a
// line likewise.
void launch_release_at_once(ld_run *run, double t, const double *y);
// When the next tube takes the place of the one that is empty now [s].
double launch_change_instant(const launch_state *self);
// The next instant at which a step must end [s]; at one: what begins there, true where the
// equations change. The first one is finite where nothing is to come, the other one not.
double launch_next_stop(const ld_run *run, double t);
double launch_next_instant(const ld_run *run, double t);
bool launch_pass_stop(ld_run *run, double t);

#endif
