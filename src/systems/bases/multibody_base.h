// What a base of kind multibody is made of.
#ifndef LD_SYSTEMS_MULTIBODY_BASE_H
#define LD_SYSTEMS_MULTIBODY_BASE_H

#include "environment/atmosphere.h"
#include "environment/wind.h"
#include "systems/bases/prescribed_motion.h"
#include "systems/mechanism/mechanism.h"

// The joint that is far from its start in equilibrium; NULL: none.
typedef struct mechanism_moved {
    const ld_joint *joint;
    bool turns;
    double by; // [rad], [m]
} mechanism_moved;

typedef struct multibody_base {
    const ld_model *model;
    mechanism_system of_tube[LD_MAX_FIRINGS]; // while that tube launches, in the order of firing
    int tube_count;
    prescribed_motion carrier;
    marching_system marching;
    marching_system level; // the same wheels on a flat road
    bool has_wheels, has_drag;
    bool shared; // what is constant is another's
    atmosphere air;
    wind wind;
    // its equilibrium under a tube as a dead load, near which the exact one is searched
    double *rest;
    int freedom_count; // displacements that are unknown there
    int freedom[MECHANISM_MOST_SPEEDS];
    int falling;       // speed along which nothing holds it; -1: none
    double falls_with; // [m/s2], [rad/s2]
    mechanism_moved moved;
    char holder[MECHANISM_MOST_HOLDS][2 * LD_MAX_NAME]; // keys of what holds a joint
} multibody_base;

// The carrier at time t [s]; linearised it rests in its attitude, in the origin.
struct base_system;
base_frame multibody_carrier(const struct base_system *base, double t);

#endif
