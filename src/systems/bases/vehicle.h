// A vehicle that carries the tube: chassis, azimuth and elevation platform on wheels, which are a
// mechanism (vehicle_mechanism.h).
//
// Works: the first of the mechanism's | the wheels' | the jets', where there are any.
#ifndef LD_SYSTEMS_VEHICLE_H
#define LD_SYSTEMS_VEHICLE_H

#include "systems/bases/body_instant.h"
#include "systems/mechanism/marching.h"
#include "systems/mechanism/mechanism.h"

// The holds of its mechanism, where it has an azimuth platform; else elevation is the only one.
enum { HINGE_AZIMUTH, HINGE_ELEVATION, HINGES };

// Its state up to the wheels, by the mechanism's layout, with both hinges.
enum {
    VEHICLE_R = 0,          // mass centre of the chassis in I
    VEHICLE_QUATERNION = 3, // its attitude
    VEHICLE_ANGLE = 7,      // azimuth, elevation
    VEHICLE_V = 9,          // velocity of the mass centre, in I
    VEHICLE_W = 12,         // angular velocity of the chassis, in its own axes
    VEHICLE_RATE = 15,      // of the two angles
    VEHICLE_SPEEDS = 8,
    VEHICLE_Z = 17, // integrals of the stabilisers
    VEHICLE_DRIVE = 19,
    VEHICLE_BODY_STATES = VEHICLE_DRIVE, // where no stabiliser has a drive of its own
    VEHICLE_MOST_BODY_STATES = VEHICLE_DRIVE + HINGES * DRIVE_STATES
};

// What it tells of the mechanism's works, under its own names.
#define VEHICLE_WORKS(X)                                                                           \
    X(VEHICLE_STABILISERS, "stabilisers", "work of the stabilisers or locks")                      \
    X(VEHICLE_FRICTION, "hinge_friction", "work of the friction in the hinges")                    \
    X(VEHICLE_GRAVITY, "gravity_platform", "work of gravity on chassis and platforms")

// The work of the jets, where the platform feels any.
#define JET_WORKS(X) X(VEHICLE_JET, "jet", "work of the jets of rockets that have left")

enum vehicle_power {
    VEHICLE_WORKS(WORK_PLACE) VEHICLE_BODY_POWERS,
    VEHICLE_BEFORE = VEHICLE_BODY_POWERS + MARCHING_POWERS - 1,
    JET_WORKS(WORK_PLACE) VEHICLE_POWERS,
};
_Static_assert((int)VEHICLE_STABILISERS == (int)MECHANISM_HOLDS &&
                   (int)VEHICLE_FRICTION == (int)MECHANISM_FRICTION &&
                   (int)VEHICLE_GRAVITY == (int)MECHANISM_GRAVITY,
               "works of a vehicle are the first ones of its mechanism");

// Force and moment [N], [N m] of jets on the elevation platform, about T's origin, in T.
typedef struct jet_wrench {
    v3 force, moment;
} jet_wrench;

// Its power [W], T moving as `tube` says.
double jet_power(const jet_wrench *jet, const base_frame *tube);

// Wheels and drive as their columns have them, of a vehicle or a multibody base.
typedef struct rolling_instant {
    struct {
        double r[3];
    } wheel[LD_MAX_WHEELS];
    marching_output marching;
} rolling_instant;

// What its quantities are about.
typedef struct vehicle_instant {
    rolling_instant rolling; // first, as of a multibody base
    struct {
        double r[3], u[6]; // place, velocity and rate
        double angles[3];  // yaw, pitch, roll
    } chassis;
    hinge_report hinge[HINGES];
    body_instant platform[HINGES]; // that the hinge carries
    double jet;                    // [N] of all jets, along -x of T
} vehicle_instant;

#endif
