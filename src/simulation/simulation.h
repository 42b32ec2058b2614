// Inside of a simulation: the system computed once, the state's layout, what is switched by events.
#ifndef LD_SIMULATION_SIMULATION_H
#define LD_SIMULATION_SIMULATION_H

#include "elements/motor.h"
#include "simulation/integrator.h"
#include "simulation/summary.h"
#include "systems/flight.h"
#include "systems/launcher.h"

enum { LD_MAX_COLUMNS = 1024 };

// CPU time of the process [s].
double simulation_cpu_now(void);

// What the equations depend on beside the state and the system as it was built.
typedef struct run_conditions {
    double t, t_ignition;    // [s]
    int piece, rocket, tube; // of the thrust curve; selected
    const road *road;
    launching_phase phase;
    hinge_rest rest[HINGES];
} run_conditions;

struct ld_simulation {
    const ld_model *model; // `own` where the rockets of a salvo differ
    ld_model own;          // with the current rocket
    int rocket;            // whose motor and numbers are taken, in the order of firing
    motor motor;           // its, of these:
    motor motor_of[LD_MAX_FIRINGS];
    int motor_count;
    launcher_system launcher;
    flight_system flight;

    // of a run
    launching_phase phase;
    hinge_rest rest[HINGES]; // of the equilibrium
    bool on_breech;          // the equilibrium is one without a lock, the breech carries the rocket
    bool stability_checked;
    ld_pole growing; // what grows about the equilibrium, if anything
    int current;     // rocket in the order of firing
    double t_ignition;
    m3 aim;    // A_IT, the undeformed tube on its base, as it stood at that ignition
    int piece; // of the thrust curve
    bool jammed;
    struct { // the latest evaluation, which at a step's end is that of the step's end
        bool known;
        run_conditions at;
        double y[LD_MAX_STATES];
        launcher_output out;
    } latest;
    int64_t fallbacks; // evaluations in which the overall form did not hold
    double worst_condition;

    double cpu_seconds_setup;
    int mode_count;
    ld_mode mode[LD_MAX_MODES]; // tube and tail on their supports

    int column_count, rocket_columns; // in all; those of the rocket in its tube
    ld_column column[LD_MAX_COLUMNS];
    char column_text[LD_MAX_COLUMNS][2][96]; // names and descriptions of columns that are counted
};

// Makes *simulation (NULL: a new one) that of `model`, as ld_simulation_create does but without the
// modes for the summary. What was found once of an equal tube is used again: the results are the
// same to the bit. After a failure it is empty, to be renewed or freed.
ld_status simulation_renew(ld_simulation **simulation, const ld_model *model, ld_error *error);

// Adds a remark that the user should see.
void simulation_note(ld_summary *summary, const char *format, ...) LD_PRINTF(2, 3);

// Set-up and run of a model without launcher.
ld_status flight_alone_create(ld_simulation *self, ld_error *error);
ld_status flight_alone_run(ld_simulation *self, const ld_run_options *options, ld_summary *summary,
                           ld_error *error);

// The rocket of firing i takes the place of the one before.
void simulation_select_rocket(ld_simulation *self, int i);

// Thrust and mass at time t, and the base there at state y.
void simulation_input(const ld_simulation *self, double t, const double *y, launcher_input *input);

// Puts tube and rocket on the base as it stands, straight and at rest.
void simulation_straight(const ld_simulation *self, const base_frame *base, double *y);

// Puts tube and rocket straight and at rest on the base at time t (model.md, section 5), a vehicle
// in its equilibrium under them as a dead load.
ld_status simulation_undeformed(ld_simulation *self, double t, double *y, ld_error *error);

// Static equilibrium at t of the whole on its wheels, or on a base held still in its pose; fills
// the summary, and what locked hinges rest at.
ld_status simulation_equilibrium(ld_simulation *self, double t, double *y,
                                 ld_equilibrium_summary *summary, ld_error *error);

// Gives tube and rocket the base's velocity at t, as one rigid body with it; a vehicle its speed.
void simulation_move_with_base(const ld_simulation *self, double t, double *y);

// Puts the tube of firing `next` and its rocket in place of the one before, which becomes rigid
// with the platform: static equilibrium on the base held still in its pose, at rest relative to it;
// the vehicle's speeds by conservation of the generalised momentum of the orientating coordinates,
// both tubes in the sum (model.md section 9).
ld_status simulation_change_tube(ld_simulation *self, int next, double t, double *y,
                                 ld_error *error);

// Degrees of freedom besides the rocket's roll and, while it is locked, its travel, and their small
// changes: R's place and attitude (6), q, then y_S, z_S, psi, theta, on the breech s too; of a
// vehicle also chassis y, pitch, roll, the two hinge angles, the two hinge torques [MN m], then the
// wheels' positions.
int simulation_freedoms(const ld_simulation *self);
void simulation_displace(const ld_simulation *self, int freedom, double change, double *y);

// Before a vehicle's run: refuses a stabiliser that cannot hold its platform, by the equations
// linearised about the equilibrium on a flat road. `growing`: the fastest growing eigenvalue of any
// part, zero where there is none.
ld_status simulation_check_stability(ld_simulation *self, ld_pole *growing, ld_error *error);

// Phase before ignition: rocket in the tube, lock closed, no adaptor beyond the tip; the breech
// stands where the rocket starts.
launching_phase simulation_start_phase(const ld_simulation *self);

// The equations linearised. Displacements: place and attitude of R (6), q, then of the rocket s,
// y_S, z_S, psi, theta, gamma (without the rocket they are left out); with a vehicle place and
// attitude of the chassis (6, the rotation in its own axes), the hinge angles, the wheels' places.
// Speeds in the same order: v, w, q_dot, V, ... Then what has a rate alone: the stabilisers'
// integrals, eta and xi of each wheel, the drive's integral. d/dt of all: the Jacobian J.
typedef struct linear_system {
    int tube, rocket, vehicle; // displacements of each
    int half, count;           // displacements in all; unknowns in all
    double *J;                 // count x count, by columns; to be freed
} linear_system;

// Linearises the whole about its equilibrium at the start, a vehicle on a flat road at its marching
// speed; lock closed, no Coulomb friction.
ld_status simulation_linearise(ld_simulation *self, linear_system *system, ld_error *error);

// Hands places, sizes and mode shapes of the launcher to the sink, where it wants them.
ld_status simulation_geometry(const ld_simulation *self, const ld_sink *sink, ld_error *error);

// History: column names once, then a row of values.
void history_build(ld_simulation *self);
void history_row(const ld_simulation *self, double t, const double *y, double energy_start,
                 double *row);
// Energies and balance at state y, with what the equations gave there.
void simulation_energy(const ld_simulation *self, const launcher_input *input,
                       const launcher_output *out, const double *y, double energy_start,
                       ld_energy *energy);

// Direction angles: pitch and yaw of d (any length) and their rates under d_dot (model.md, section
// 1).
typedef struct direction_angles {
    double pitch, yaw, pitch_rate, yaw_rate;
} direction_angles;
direction_angles direction_angles_of(v3 d, v3 d_dot);

// The rocket's x axis, its rate, place and velocity of its mass centre, all in I.
typedef struct rocket_motion {
    v3 axis, w, r_C, v_C;
} rocket_motion;
// Of the rocket with this pose in state y, its mass centre at c in B.
rocket_motion rocket_motion_of(const launching_pose *pose, v3 c, const double *y,
                               const launching_layout *at);

// The rocket against the launcher, as it stands and moves; at time t against where it stood at the
// ignition, before which there is no aim. Those of no rocket: not a number.
ld_tip_off tip_off_of(const base_frame *base, const rocket_motion *rocket);
ld_aim aim_of(const ld_simulation *self, double t, const rocket_motion *rocket);
extern const ld_tip_off no_tip_off;
extern const ld_aim no_aim;

// The tip's section against the undeformed tube, in the base's tube axes.
typedef struct tip_state {
    v3 offset, offset_dot;
    direction_angles angles;
} tip_state;
tip_state tip_state_of(const ld_simulation *self, const base_frame *base, const double *y);

#endif
