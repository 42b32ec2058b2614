// The state of one launch besides its integrator's: which rocket in which tube, and what events
// have switched; with the workspace that its evaluations want.
#ifndef LD_STATE_LAUNCH_STATE_H
#define LD_STATE_LAUNCH_STATE_H

#include "integration/step_course.h"
#include "state/jets.h"
#include "state/simulation.h"
#include "systems/launching/launching_figures.h"
#include "systems/launching/launching_kinematics.h"

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

// Where the forces on an adaptor have corners: at the wall, and at the ends of the tube's elements,
// whose shapes meet there with a jump of curvature. Launches with a course end steps there, so that
// their results stay as smooth as the equations are.
typedef struct adaptor_corner {
    bool known;
    int touching[LD_MAX_SURFACES]; // of a bore the first: 1, -1
    double station;                // [m] the end of the element that it is in; infinity: the last
} adaptor_corner;

typedef struct launch_state {
    const ld_simulation *system;
    const ld_model *model;    // the system's
    launcher_system launcher; // the system's, with the current rocket in its tube
    const motor *motor;       // of the current rocket
    const flight_system *air; // that it flies in, where it or its guide feels it; NULL
    const ld_rocket *rocket;
    int current; // rocket in the order of firing
    double t_ignition;
    launching_phase phase;
    const base_frame
        *reported;      // T at the start, of an externally driven base; NULL: no one reports
    base_rest rest;     // of the equilibrium
    bool on_breech;     // the equilibrium is one without a lock, the breech carries the rocket
    m3 A_ignition;      // A_IT, the undeformed tube on its base, as it stood at that ignition
    int piece;          // of the thrust curve
    int pressure_piece; // of the pressure behind the rocket; 0: not lit
    bool held_down;     // the lock releases under no force
    bool jammed;
    jets jets; // of the rockets that have left, where the platform feels them
    struct {   // the latest evaluation, which at a step's end is that of the step's end
        bool known;
        run_conditions at;
        double y[LD_MAX_STATES];
        launcher_output out;
    } latest;
    step_course *course;                    // that its steps are kept in, or taken from; NULL: none
    adaptor_corner corner[LD_MAX_ADAPTORS]; // with a course
    int64_t fallbacks;                      // evaluations in which the overall form did not hold
    double worst_condition;
} launch_state;

// The first rocket in its tube, its motor not lit; the system must outlive the state.
ld_status launch_state_begin(launch_state *self, const ld_simulation *system, ld_error *error);
void launch_state_end(launch_state *self);
// The rocket of firing i takes the place of the one before; its tube comes by launcher_select.
void launch_state_select(launch_state *self, int i);

// Whether the rocket's motor is ignited, or its pressure on.
static inline bool launch_is_ignited(const launch_state *self)
{
    return self->piece >= 0 || self->pressure_piece > 0;
}

// Puts tube and rocket on the base as it stands, straight and at rest.
void simulation_straight(const launch_state *self, const base_frame *base, double *y);

// Phase before ignition: rocket in the tube, lock closed, no adaptor beyond the tip; the breech
// stands where the rocket starts.
launching_phase simulation_start_phase(const launch_state *self);

#endif
