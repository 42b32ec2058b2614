// A vehicle's chassis and platforms without its wheels: the mechanism that a vehicle is expanded
// into, with the frames, angles and torques that tests ask for.
#ifndef LD_TESTS_SUPPORT_VEHICLE_BODIES_H
#define LD_TESTS_SUPPORT_VEHICLE_BODIES_H

#include "systems/bases/vehicle.h"

typedef struct vehicle_bodies {
    ld_mechanism *given;
    mechanism_system mechanism;
    int state_count;
    double mass, elevation_mass; // [kg] of the three bodies, of the elevation platform
    v3 elevation_center;         // [m] its mass centre, carried tubes included
    v3 tube_at;                  // [m] the launching tube's rear end
} vehicle_bodies;

typedef struct vehicle_motion {
    base_frame chassis, tube;   // mass centre of the chassis; frame T
    v3 momentum;                // [kg m/s] of the three bodies, in I
    hinge_report hinge[HINGES]; // torques by vehicle_bodies_evaluate
    mechanism_motion all;
} vehicle_motion;

typedef struct vehicle_input {
    v3 chassis_force, chassis_moment; // in I, about the chassis' mass centre
    v3 tube_force, tube_moment;       // in T, about T's origin
    hold_rest rest[HINGES];
    bool linear, held; // as mechanism_input has them
} vehicle_input;

typedef struct vehicle_output {
    double power[VEHICLE_BODY_POWERS];
    double loss;
} vehicle_output;

// Tube `launching` is not carried, those in `fired` [count] have no rocket. The model must outlive
// it; what the model changes later has no effect.
ld_status vehicle_bodies_build(vehicle_bodies *self, const ld_model *model, int launching,
                               const int *fired, int count, ld_error *error);
void vehicle_bodies_free(vehicle_bodies *self);

void vehicle_bodies_move(const vehicle_bodies *self, double t, const double *state,
                         vehicle_motion *motion);
int vehicle_bodies_evaluate(const vehicle_bodies *self, const vehicle_input *input,
                            const double *state, vehicle_motion *motion, double *state_dot,
                            vehicle_output *output);
// Drives at rest under the torques z.
void vehicle_bodies_rest(const vehicle_bodies *self, double *state);
double vehicle_bodies_next_sample(const vehicle_bodies *self, double t);
void vehicle_bodies_sample(const vehicle_bodies *self, double t, double *state);
double vehicle_bodies_kinetic_energy(const vehicle_bodies *self, const double *state);

#endif
