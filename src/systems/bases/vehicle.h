// A vehicle that carries the tube: chassis and platforms (orientating.h) on wheels (marching.h).
//
// State: orientating | marching. Works: orientating | marching | jets, where there are any.
#ifndef LD_SYSTEMS_VEHICLE_H
#define LD_SYSTEMS_VEHICLE_H

#include "systems/bases/orientating.h"
#include "systems/mechanism/marching.h"

// The work of the jets, where the platform feels any.
#define JET_WORKS(X) X(VEHICLE_JET, "jet", "work of the jets of rockets that have left")

enum vehicle_power {
    VEHICLE_BEFORE = ORIENTATING_POWERS + MARCHING_POWERS - 1,
    JET_WORKS(WORK_PLACE) VEHICLE_POWERS,
    VEHICLE_ALWAYS = VEHICLE_JET, // those that are always there come first
};

// Force and moment [N], [N m] of jets on the elevation platform, about T's origin, in T.
typedef struct jet_wrench {
    v3 force, moment;
} jet_wrench;

// Its power [W], T moving as `tube` says.
double jet_power(const jet_wrench *jet, const base_frame *tube);

typedef struct vehicle_system {
    const ld_model *model;
    orientating_system of_tube[LD_MAX_FIRINGS]; // while that tube launches, in the order of firing
    int tube_count;
    int marching_at; // where the marching subsystem's states begin
    marching_system marching;
    marching_system level; // the same wheels on a flat road
    bool roads_of_another;
} vehicle_system;

// What an evaluation reports besides rates and works.
typedef struct vehicle_report {
    hinge_report hinge[HINGES];
    marching_output marching;
    double jet; // [N] of all jets, along -x of T
} vehicle_report;

// What its quantities are about: what stands in the state, and what was found with it.
typedef struct vehicle_instant {
    struct {
        double r[3], u[6]; // place, velocity and rate
        double angles[3];  // yaw, pitch, roll
    } chassis;
    struct {
        double r[3];
    } wheel[LD_MAX_WHEELS];
    vehicle_report report;
} vehicle_instant;

#endif
