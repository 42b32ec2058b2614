// A vehicle that carries the tube: chassis and platforms (orientating.h) on wheels (marching.h).
//
// State: orientating | marching. Works: orientating | marching.
#ifndef LD_SYSTEMS_VEHICLE_H
#define LD_SYSTEMS_VEHICLE_H

#include "systems/marching.h"
#include "systems/orientating.h"

typedef struct vehicle_system {
    const ld_model *model;
    orientating_system of_tube[LD_MAX_FIRINGS]; // while that tube launches, in the order of firing
    int tube_count;
    int marching_at; // where the marching subsystem's states begin
    marching_system marching;
    marching_system level; // the same wheels on a flat road
    bool roads_of_another;
} vehicle_system;

// What an evaluation tells besides rates and works.
typedef struct vehicle_report {
    hinge_report hinge[HINGES];
    marching_output marching;
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
