// A whole launch on the independent equations of support/dense_launch.h: own equilibrium, own
// base motion or vehicle (support/dense_vehicle.h), own mass and thrust, classical Runge-Kutta at a
// fixed step, located events.
#ifndef LD_TESTS_SUPPORT_DENSE_SIMULATION_H
#define LD_TESTS_SUPPORT_DENSE_SIMULATION_H

#include "support/dense_launch.h"
#include "support/dense_vehicle.h"

// The vehicle at one instant.
typedef struct dense_instant {
    double orientating[VEHICLE_BODY_STATES], marching[DENSE_MARCHING_STATES];
    dense_vehicle_output output;
} dense_instant;

// As ld_rocket_summary (same names, units, frames); NaN where an instant was not reached.
typedef struct dense_summary {
    double t_release, t_front, t_middle, t_rear; // [s] from ignition
    double t_exit[LD_MAX_ADAPTORS];
    double exit_speed, inertial_speed, spin_rate, pitch, yaw, pitch_rate, yaw_rate;
    struct {
        double y, z, psi, theta, gamma, w_x, w_y, w_z;
    } relative;
    struct {
        double y, z, pitch, yaw, vy, vz, pitch_rate, yaw_rate;
    } tip;
    double max_contact_force[LD_MAX_ADAPTORS], max_slot_force;
    struct {
        double lock_force, slot_force, contact_force[LD_MAX_ADAPTORS], tip_sag[2];
        double residual; // largest acceleration of the start, lock closed [m/s2, rad/s2, 1/s2]
        double breech_force;
    } equilibrium;
    dense_instant start, ignition, exit; // of a vehicle
    double slot_drift;                   // [m/s] largest |n . v_rel|
    int evaluations;
    bool complete; // the rocket has left the tube
} dense_summary;

// Pose and rates of the base at time t [s] of the run's clock.
void dense_base_at(const ld_model *model, double t, dense_base *base);

// Net pressure [Pa] over time, `since` the ignition, between the two rows that hold `middle`.
double dense_pressure_at(const ld_pressure *given, double since, double middle);

// Mass, mass centre, inertia and thrust of the rocket `since` seconds after ignition, on the piece
// of the thrust table that holds `middle`.
void dense_rocket_at(const ld_model *model, double since, double middle, dense_conditions *on);

// The air about the rocket: a steady wind of one speed at every height, in uniform air.
void dense_air_at(const ld_model *model, dense_conditions *on);

// Runs `model` (base fixed, prescribed by sines and a velocity, or a vehicle that starts in its
// equilibrium on a flat road, sines or bumps; not by a table) with steps of at most `step` [s].
// Returns false where the equilibrium or the dense system fails or the rocket is still in the tube
// at the model's stuck time.
bool dense_simulate(const ld_model *model, const flexible_tube *tube, double step,
                    dense_summary *summary);

typedef struct dense_pole { // [1/s]
    double real, imaginary;
} dense_pole;

// Eigenvalues of the equations of a vehicle with its launching subsystem, lock closed, linearised
// at the start of a run by central differences, without Coulomb friction, by ascending modulus,
// both of each conjugate pair. Returns their number; 0 where the equilibrium fails.
int dense_poles(const ld_model *model, const flexible_tube *tube, dense_pole *pole, int capacity);

#endif
