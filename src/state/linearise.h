// The equations of motion linearised, and the modes that follow.
#ifndef LD_STATE_LINEARISE_H
#define LD_STATE_LINEARISE_H

#include "state/launch_state.h"

// The equations linearised. Displacements: position and attitude of R (6), q, then of the rocket s,
// y_S, z_S, psi, theta, gamma (without the rocket they are left out); with a vehicle position and
// attitude of the chassis (6, the rotation in its own axes), the hinge angles, the wheels' places.
// Speeds in the same order: v, w, q_dot, V, ... Then what has a rate alone: the stabilisers'
// integrals, eta and xi of each wheel, the drive's integral. d/dt of all: the Jacobian J.
typedef struct linear_system {
    double t; // [s] about what: time, phase, state
    launching_phase phase;
    double y[LD_MAX_STATES];
    int tube, rocket, base; // displacements of each
    int half, count;        // displacements in all; unknowns in all
    double *J;              // count x count, by columns; to be freed
    double *held;           // base x count, by columns, behind J: what holds the base's
                            // displacements still, d/dt of them in [N], [N m]
    double *step;           // [count], behind that: of the differences in each unknown [its unit]
} linear_system;

// Counts the unknowns and finds the equilibrium at the start, a vehicle at its marching speed.
ld_status linear_rest(launch_state *self, linear_system *system, ld_error *error);

// Linearises the whole about its equilibrium at the start, a vehicle on a flat road at its marching
// speed; lock closed, no Coulomb friction in hinges, that of the adaptors as it is where they
// hardly slide (`rubbing`) or none; what constraints hold in place pulled back there (`restored`),
// which adds motions that nothing excites, or not. A base with a given motion rests in the origin.
ld_status simulation_linearise(launch_state *self, bool rubbing, bool restored,
                               linear_system *system, ld_error *error);

// The tube on its supports alone, straight: its accelerations are -K x - C v of the small changes x
// and v of its displacements and speeds, R's position and attitude and q, R's speeds and q_dot; K
// and C by rows, `count` of them (6 + modes).
ld_status simulation_tube_matrices(const ld_simulation *simulation, int *count, double *K,
                                   double *C, ld_error *error);

// Changes an unknown in the state y.
void linear_displace(const launch_state *self, const linear_system *system, int unknown,
                     double change, double *y);
// Changes all unknowns of the state about which the system is linearised by `share` times `change`
// [count]; `y` takes the outcome. The tube against its base and the rocket against the tube change
// linearly, so a base that turns strains no support.
void linear_displace_all(const launch_state *self, const linear_system *system,
                         const double *change, double share, double *y);
// d/dt of the unknowns [count] in the state y, behind them what holds the base's displacements
// [base]. Other than 0: there are none.
int linear_rates(const launch_state *self, const linear_system *system, const double *y, double *r);

// Modes and eigenvalues found, the first of them up to the capacities.
typedef struct system_modes {
    ld_mode *mode;
    int capacity, count;
    ld_pole *pole;
    int pole_capacity, pole_count;
} system_modes;

// ld_simulation_system_modes() of a launcher, with the tube's modes as the simulation has them.
ld_status simulation_system_modes(const ld_simulation *simulation, system_modes *found,
                                  ld_error *error);

// ld_simulation_tube_modes(), found: LD_ERR_MEMORY, LD_ERR_NUMERIC.
ld_status simulation_tube_modes(const ld_simulation *self, ld_mode *modes, int capacity, int *count,
                                ld_error *error);

// Refuses a vehicle's stabiliser that cannot hold its platform, by the equations linearised about
// the equilibrium on a flat road. `growing`: the fastest growing eigenvalue of any part, zero where
// there is none.
ld_status simulation_check_stability(const ld_simulation *self, ld_pole *growing, ld_error *error);

#endif
