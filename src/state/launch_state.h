// The state of one launch besides its integrator's: which rocket in which tube, and what events
// have switched; with the workspace that its evaluations want.
#ifndef LD_SIMULATION_LAUNCH_STATE_H
#define LD_SIMULATION_LAUNCH_STATE_H

#include "state/jets.h"
#include "state/simulation.h"

// What the equations depend on beside the state and the system as it was built.
typedef struct run_conditions {
    double t, t_ignition;    // [s]
    int piece, rocket, tube; // of the thrust curve; selected
    int pressure_piece;
    int jets; // how many pieces theirs have begun
    const base_disturbance *disturbed;
    launching_phase phase;
    base_rest rest;
} run_conditions;

typedef struct launch_state {
    const ld_simulation *system;
    const ld_model *model;    // the system's
    launcher_system launcher; // the system's, with the current rocket in its tube
    const motor *motor;       // of the current rocket
    const flight_system *air; // that it flies in, where it feels it in its tube; NULL
    const ld_rocket *rocket;
    int current; // rocket in the order of firing
    double t_ignition;
    launching_phase phase;
    const base_frame *told; // T at the start, of a base that is told; NULL: nobody tells
    base_rest rest;         // of the equilibrium
    bool on_breech;         // the equilibrium is one without a lock, the breech carries the rocket
    m3 A_ignition;          // A_IT, the undeformed tube on its base, as it stood at that ignition
    int piece;              // of the thrust curve
    int pressure_piece;     // of the pressure behind the rocket; 0: not lit
    bool held_down;         // the lock lets go under no force
    bool jammed;
    jets jets; // of the rockets that have left, where the platform feels them
    struct {   // the latest evaluation, which at a step's end is that of the step's end
        bool known;
        run_conditions at;
        double y[LD_MAX_STATES];
        launcher_output out;
    } latest;
    int64_t fallbacks; // evaluations in which the overall form did not hold
    double worst_condition;
} launch_state;

// The first rocket in its tube, its motor not lit; the system must outlive the state.
ld_status launch_state_begin(launch_state *self, const ld_simulation *system, ld_error *error);
void launch_state_end(launch_state *self);
// The rocket of firing i takes the place of the one before; its tube comes by launcher_select.
void launch_state_select(launch_state *self, int i);

// Whether the rocket's motor is lit, or its pressure on.
static inline bool launch_is_lit(const launch_state *self)
{
    return self->piece >= 0 || self->pressure_piece > 0;
}

// Thrust, pressure and mass at time t, and the base there at state y.
void simulation_input(const launch_state *self, double t, const double *y, launcher_input *input);

// Puts tube and rocket on the base as it stands, straight and at rest.
void simulation_straight(const launch_state *self, const base_frame *base, double *y);

// Puts tube and rocket straight and at rest on the base at time t (model.md, section 5), a vehicle
// in its equilibrium under them as a dead load.
ld_status simulation_undeformed(launch_state *self, double t, double *y, ld_error *error);

// Static equilibrium at t of the whole on its wheels, or on a base held still in its pose; fills
// the summary, and what locked hinges rest at.
ld_status simulation_equilibrium(launch_state *self, double t, double *y,
                                 ld_equilibrium_summary *summary, ld_error *error);

// Gives tube and rocket the base's velocity at t, as one rigid body with it; a vehicle its speed.
void simulation_move_with_base(const launch_state *self, double t, double *y);

// When a launch begins [s]; how it does at that t: straight or in equilibrium as the scenario wants
// it, moving with its base.
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
// changes: R's place and attitude (6), q, then y_S, z_S, psi, theta, on the breech s too; of a
// vehicle also chassis y, pitch, roll, the two hinge angles, the two hinge torques [MN m], then the
// wheels' positions.
int simulation_freedoms(const launch_state *self);
void simulation_displace(const launch_state *self, int freedom, double change, double *y);

// Phase before ignition: rocket in the tube, lock closed, no adaptor beyond the tip; the breech
// stands where the rocket starts.
launching_phase simulation_start_phase(const launch_state *self);

// The equations linearised. Displacements: place and attitude of R (6), q, then of the rocket s,
// y_S, z_S, psi, theta, gamma (without the rocket they are left out); with a vehicle place and
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

// [1/s2] pulls back to its place what constraints hold there, where nothing else would keep it.
static const double RESTORING = 1e6;

// Counts the unknowns and finds the equilibrium at the start, a vehicle at its marching speed.
ld_status linear_rest(launch_state *self, linear_system *system, ld_error *error);

// Linearises the whole about its equilibrium at the start, a vehicle on a flat road at its marching
// speed; lock closed, no Coulomb friction in hinges, that of the adaptors as it is where they
// hardly slide (`rubbing`) or none; what constraints hold in place pulled back there (`restored`),
// which adds motions that nothing excites, or not. A base that goes where it is told rests in the
// origin.
ld_status simulation_linearise(launch_state *self, bool rubbing, bool restored,
                               linear_system *system, ld_error *error);

// The tube on its supports alone, straight: its accelerations are -K x - C v of the small changes x
// and v of its displacements and speeds, R's place and attitude and q, R's speeds and q_dot; K and
// C by rows, `count` of them (6 + modes).
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

// Evaluates, and finds what the tube carries where that is asked for.
launching_outcome simulation_loads(const launch_state *self, launcher_input *input, const double *y,
                                   launcher_output *out, launching_loads *loads);

// A row of the history.
void history_row(const launch_state *self, double t, const double *y, double energy_start,
                 double *row);
// Energies and balance at state y, with what the equations gave there.
void simulation_energy(const launch_state *self, const launcher_input *input,
                       const launcher_output *out, const double *y, double energy_start,
                       ld_energy *energy);

// The rocket's axes x and y, its rate, place and velocity of its mass centre, all in I; its
// relative roll, which counts whole turns.
typedef struct rocket_motion {
    v3 axis, side, w, r_C, v_C;
    double gamma;
} rocket_motion;
// Of the rocket with this pose in state y, its mass centre at c in B.
rocket_motion rocket_motion_of(const launching_pose *pose, v3 c, const double *y,
                               const launching_layout *at);

// The rocket against the launcher, as it stands and moves; at time t in the launcher's axes at the
// ignition, before which there are none. Those of no rocket: not a number.
ld_tip_off tip_off_of(const base_frame *base, const rocket_motion *rocket);
ld_since_ignition since_ignition_of(const launch_state *self, double t,
                                    const rocket_motion *rocket);
extern const ld_tip_off no_tip_off;
extern const ld_since_ignition before_ignition;

// The tip's section against the undeformed tube, in the base's tube axes.
typedef struct tip_state {
    v3 offset, offset_dot;
    direction_angles angles;
} tip_state;
tip_state tip_state_of(const launch_state *self, const base_frame *base, const double *y);

#endif
