// The start of a launch: undeformed, or in static equilibrium found by Newton's method.
#ifndef LD_STATE_EQUILIBRIUM_H
#define LD_STATE_EQUILIBRIUM_H

#include "state/launch_state.h"

// [1/s2] pulls back to its position what constraints hold there, where nothing else would keep it.
static const double RESTORING = 1e6;

// Puts tube and rocket straight and at rest on the base at time t (model.md, section 5), a vehicle
// in its equilibrium under them as a dead load.
ld_status simulation_undeformed(launch_state *self, double t, double *y, ld_error *error);

// Static equilibrium at t of the whole on its wheels, or on a base held still in its pose; fills
// the summary, and what locked hinges rest at.
ld_status simulation_equilibrium(launch_state *self, double t, double *y,
                                 ld_equilibrium_summary *summary, ld_error *error);

// Gives tube and rocket the base's velocity at t, as one rigid body with it; a vehicle its speed.
void simulation_move_with_base(const launch_state *self, double t, double *y);

// When a launch begins [s]; how it does at that t: straight or in equilibrium as the scenario
// requires it, moving with its base.
double simulation_start_time(const ld_model *model);
ld_status simulation_start(launch_state *self, double t, double *y, ld_equilibrium_summary *summary,
                           ld_error *error);

// Puts the tube of firing `next` and its rocket in place of the one before, which becomes rigid
// with the platform: static equilibrium on the base held still in its pose, at rest relative to it;
// the vehicle's speeds by conservation of the generalised momentum of the orientating coordinates,
// both tubes in the sum (model.md section 9).
ld_status simulation_change_tube(launch_state *self, int next, double t, double *y,
                                 ld_error *error);

// Degrees of freedom besides the rocket's roll and, while it is locked, its travel, and their small
// changes: R's position and attitude (6), q, then y_S, z_S, psi, theta, on the breech s too; of a
// vehicle also chassis y, pitch, roll, the two hinge angles, the two hinge torques [MN m], then the
// wheels' positions.
int simulation_freedoms(const launch_state *self);
void simulation_displace(const launch_state *self, int freedom, double change, double *y);

#endif
