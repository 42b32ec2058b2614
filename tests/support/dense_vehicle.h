// An independent vehicle: chassis, azimuth and elevation platform as three free rigid bodies held
// together by two revolute hinges with Lagrange multipliers (five rows each), wheels as mass
// points, all in one dense system; every force as model.md, sections 6 and 7, words it.
//
// States and rates have the layout of systems/bases/vehicle.h and systems/mechanism/marching.h;
// no code of theirs is used. Roads: flat, sines, bumps.
#ifndef LD_TESTS_SUPPORT_DENSE_VEHICLE_H
#define LD_TESTS_SUPPORT_DENSE_VEHICLE_H

#include "systems/bases/vehicle.h"
#include "systems/mechanism/marching.h"

enum { DENSE_MARCHING_STATES = WHEEL_STATES * LD_MAX_WHEELS + 1 };

// A rigid part of a body: mass centre from the body's origin and inertia about it, body axes.
typedef struct dense_part {
    double mass;
    v3 center;
    m3 inertia;
} dense_part;

enum { DENSE_CHASSIS, DENSE_AZIMUTH, DENSE_ELEVATION, DENSE_BODIES };

typedef struct dense_vehicle {
    const ld_model *model;
    struct {
        int count;
        dense_part *part; // the elevation platform's: its frame, carried tubes, tails, rockets
    } body[DENSE_BODIES];
    v3 tube_at; // [m] rear end of the launching tube, elevation platform axes
} dense_vehicle;

// Prepares `vehicle` (keeps the model): tube number `launching` is not carried (0: all are), the
// `fired` ones have no rocket. Free with dense_vehicle_free().
void dense_vehicle_create(dense_vehicle *vehicle, const ld_model *model, int launching,
                          const int *fired, int fired_count);
void dense_vehicle_free(dense_vehicle *vehicle);

typedef struct dense_vehicle_input {
    double t;                   // [s]
    double command_at;          // [s] an instant on the stretch of the command tables that holds
    const double *orientating;  // [VEHICLE_BODY_STATES], with drives [VEHICLE_MOST_BODY_STATES]
    const double *marching;     // [WHEEL_STATES n + 1]
    v3 tube_force, tube_moment; // [N], [N m] on the platform, in T, about T's origin
    double jet;                 // [N] on the elevation platform, along -x of T
    v3 jet_at;                  // [m] where it acts, from T's origin, in T
    hold_rest rest[HINGES];     // of locked hinges
    bool frictionless;          // Coulomb friction off, drives as linear ones
    bool still;                 // the drive gives nothing (equilibrium)
} dense_vehicle_input;

typedef struct dense_vehicle_output {
    double orientating[VEHICLE_MOST_BODY_STATES]; // rates of the states
    double marching[DENSE_MARCHING_STATES];
    v3 acceleration[DENSE_BODIES], alpha[DENSE_BODIES]; // of the bodies' origins, in I
    base_frame tube;                                    // frame T
    struct {
        double deflection, normal, along, side; // [m], [N] p, F_n, f_f, f_s after the friction
        v3 travel;                              // [m] d
    } wheel[LD_MAX_WHEELS];
    struct {
        double measured, measured_rate, error, torque, friction; // [rad], [rad/s], [N m]
        double base_rate; // [rad/s] of the chassis along the hinge's axis
    } hinge[HINGES];
    double kinetic, potential; // [J] of everything: gravity, suspension, bump stops
    double power;              // [W] of all forces that are not in `potential`
} dense_vehicle_output;

// Rates and forces of one state. Returns false where the dense system is singular.
bool dense_vehicle_evaluate(const dense_vehicle *vehicle, const dense_vehicle_input *input,
                            dense_vehicle_output *output);

// Frame T of the undeformed tube at a state of the platforms.
void dense_vehicle_tube(const dense_vehicle *vehicle, const double *orientating, base_frame *tube);

// Height of the road at x [m] under a wheel that has its mount at z [m], and its slope.
double dense_road_height(const ld_road *profile, double z, double x, double *slope);

// Static equilibrium at time t under a constant wrench of the tube (in T): chassis at x [m], z = 0,
// heading 0; fills both states (at rest) and the rest of the hinges. Returns false where Newton's
// method fails; *residual: largest rate left [m/s2, rad/s2, N m/s].
bool dense_vehicle_equilibrium(const dense_vehicle *vehicle, double t, double x, v3 tube_force,
                               v3 tube_moment, double *orientating, double *marching,
                               hold_rest rest[HINGES], double *residual);

#endif
