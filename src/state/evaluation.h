// What the equations give at one instant: their input, the latest evaluation, the rates of all
// states.
#ifndef LD_STATE_EVALUATION_H
#define LD_STATE_EVALUATION_H

#include "state/launch_state.h"

// Thrust, pressure, mass and air at time t and the launching subsystem's state y; its base stays
// as it is.
void simulation_surround(const launch_state *self, double t, const double *y,
                         launching_input *input);
// The jets on the platform, T being `tube`.
jet_wrench simulation_jets(const launch_state *self, double t, const base_frame *tube);
// Thrust, pressure and mass at time t, and the base there at state y.
void simulation_input(const launch_state *self, double t, const double *y, launcher_input *input);

// Evaluates, and finds what the tube carries where that is asked for.
launching_outcome simulation_loads(const launch_state *self, launcher_input *input, const double *y,
                                   launcher_output *out, launching_loads *loads);
// What the equations gave at (t, y): the latest evaluation where it is that of the same state under
// the same conditions, else a new one.
// NULL where they have no solution.
const launcher_output *simulation_output(launch_state *self, double t, const double *y);
// Whether the latest evaluation is that.
bool simulation_is_latest(const launch_state *self, double t, const double *y);
// Rates of all states, which become the latest evaluation; other than 0: there are none, or one is
// not finite.
int simulation_rates(launch_state *self, double t, const double *y, double *y_dot);
// Keeps what an evaluation, whose output is the latest, reports besides the rates.
void simulation_note_outcome(launch_state *self, launching_outcome outcome);
bool all_finite(int n, const double *y);

// Puts what constraints hold in place back there, so that it neither drifts away nor is driven.
void simulation_project(const launch_state *self, double t, double *y);

#endif
