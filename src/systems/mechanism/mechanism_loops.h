// Closed loops of a mechanism: which of the tree's speeds the others follow, and the return stroke
// to where all joints fit. Without loops every speed is independent, and nothing drifts.
#ifndef LD_SYSTEMS_MECHANISM_LOOPS_H
#define LD_SYSTEMS_MECHANISM_LOOPS_H

#include "systems/mechanism/mechanism.h"

// Moves the coordinates, a guess, to where the loops close, and the speeds likewise; coordinates
// that drives and locks hold stay. LD_ERR_INPUT with what is left where they cannot be closed.
ld_status mechanism_assemble(const mechanism_system *self, const base_frame *carrier, double *state,
                             ld_error *error);
// Finds the independent speeds in an assembled state, those of holds among the first.
ld_status mechanism_find_freedoms(mechanism_system *self, const base_frame *carrier,
                                  const double *state, ld_error *error);
// Takes out what the steps' errors have opened.
void mechanism_project(const mechanism_system *self, const base_frame *carrier, double *state);

// Adds a small displacement along freedom i, all joints going with it, of a state; the same of its
// speeds.
void mechanism_displace_freedom(const mechanism_system *self, int i, double change, double *state);
void mechanism_quicken_freedom(const mechanism_system *self, int i, double change, double *state);
// The displacement of a rest: the body on the wheels pitches about z of I and rolls about its own
// x, so that its heading stays.
void mechanism_settle(const mechanism_system *self, int i, double change, double *state);

#endif
