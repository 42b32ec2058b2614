// The marching subsystem: wheels as lumped masses on tyres and suspension, on a road (model.md,
// section 7). It takes the chassis' motion and gives the wrench on it.
//
// State: for each wheel r_j [3] position and v_j [3] velocity in I, eta [m] lateral and xi [m]
// longitudinal deflection of the tyre (xi stays zero while rolling); then z_d [m], the drive's
// integral.
#ifndef LD_SYSTEMS_MARCHING_H
#define LD_SYSTEMS_MARCHING_H

#include <stdbool.h>

#include "elements/base_frame.h"
#include "elements/tube/work.h"
#include "environment/road.h"
#include "model/blocks/vehicle.h"

enum { WHEEL_STATES = 8, WHEEL_R = 0, WHEEL_V = 3, WHEEL_ETA = 6, WHEEL_XI = 7 };

// Powers [W] by kind of force, on wheels and chassis together, and their works [J]: of the road's
// lateral force, also along while parked; of its longitudinal force while rolling.
#define MARCHING_WORKS(X)                                                                          \
    X(MARCHING_GRAVITY, "gravity_wheels", "work of gravity on the wheels")                         \
    X(MARCHING_SUSPENSION, "suspension_damping", "work of the suspension dampers")                 \
    X(MARCHING_TYRE, "tyre", "work of the road's normal forces on the wheels")                     \
    X(MARCHING_SIDE, "tyre_side", "work of side forces, and of those that hold it parked")         \
    X(MARCHING_DRIVE, "drive", "work of the road on driven wheels")

enum marching_power { MARCHING_WORKS(WORK_PLACE) MARCHING_POWERS };

typedef struct marching_system {
    const ld_vehicle *model;
    double gravity; // [m/s2] along -y of I
    road *road;
    int wheel_count, driven_count;
    double right[LD_MAX_WHEELS]; // share of the right track in the height under each wheel
    bool parked;                 // speed 0
    int state_count;
} marching_system;

typedef struct wheel_report {
    double height, slope;   // of the road under it
    double deflection;      // [m] p
    double normal;          // [N] F_n
    double along, side;     // [N] f_f, f_s on the wheel
    v3 travel, travel_rate; // [m], [m/s] d and its rate, chassis axes
    v3 suspension;          // [N] on the wheel, chassis axes
} wheel_report;

typedef struct marching_output {
    v3 force, moment;   // [N], [N m] on the chassis, in I, about its mass centre
    double speed;       // [m/s] v, of the chassis along its heading
    double drive_force; // [N] F, of all driven wheels (before the friction limit)
    double elastic;     // [J] of suspensions and bump stops
    double power[MARCHING_POWERS];
    wheel_report wheel[LD_MAX_WHEELS];
} marching_output;

// The road's table covers the stretch from x0 to x1 [m]; `kept`: a road that it may take over,
// which is NULL then, or NULL.
ld_status marching_build(marching_system *self, const ld_vehicle *model, double gravity,
                         const double stretch[2], road **kept, ld_error *error);
void marching_free(marching_system *self);

// What is added to the road's height under each wheel [m], and the rate [m/s] at which it meets
// that.
typedef struct road_disturbance {
    const double *height, *rate; // [wheel_count]
} road_disturbance;

// Rates of the state, and the wrench on the chassis, whose frame (r: mass centre) is given; `held`:
// the drive gives nothing (equilibrium, where all stands still). `disturbed`: of the linearised
// equations; NULL: the road is as it is.
void marching_evaluate(const marching_system *self, const base_frame *chassis, bool held,
                       const road_disturbance *disturbed, const double *state, double *state_dot,
                       marching_output *output);

// [J] of the wheels.
double marching_kinetic_energy(const marching_system *self, const double *state);

// Puts every wheel where it is at its mount (suspension unloaded) under the chassis frame, at rest,
// tyre and drive states zero.
void marching_place(const marching_system *self, const base_frame *chassis, double *state);

#endif
