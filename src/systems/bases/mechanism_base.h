// Bases that are mechanisms, on wheels or not: what the kinds multibody and vehicle have in common.
// A kind adds the description of its bodies, its names and its first guess of an equilibrium.
//
// State: the mechanism's (mechanism.h) | its wheels' (marching.h). Works: the first of the
// mechanism's, as many as the kind tells | the wheels' | the jets', where there are any.
#ifndef LD_SYSTEMS_MECHANISM_BASE_H
#define LD_SYSTEMS_MECHANISM_BASE_H

#include "environment/atmosphere.h"
#include "environment/wind.h"
#include "systems/bases/base.h"
#include "systems/bases/prescribed_motion.h"
#include "systems/mechanism/mechanism_build.h"

// The joint that is far from its start in equilibrium; NULL: none.
typedef struct mechanism_moved {
    const ld_joint *joint;
    bool turns;
    double by; // [rad], [m]
} mechanism_moved;

typedef struct mechanism_base {
    const ld_model *model;
    ld_mechanism *made;        // the description, where the model does not hold it; NULL
    mechanism_system *of_tube; // while that tube launches, in the order of firing
    int tube_count;
    int mechanism_works; // how many of the mechanism's works it tells
    prescribed_motion carrier;
    bool still; // nothing is on the carrier
    marching_system marching;
    marching_system level; // the same wheels on a flat road
    bool has_wheels, has_drag, has_jet;
    bool shared; // what is constant is another's
    atmosphere air;
    wind wind;
    // its equilibrium under a tube as a dead load, near which the exact one is looked for; NULL
    double *rest;
    double *given;                      // where the scenario puts its bodies; NULL
    int freedom_count;                  // displacements that are unknown in an equilibrium,
    int freedom[MECHANISM_MOST_SPEEDS]; // by their places among the mechanism's freedoms
    int falling;                        // speed along which nothing holds it; -1: none
    double falls_with;                  // [m/s2], [rad/s2]
    mechanism_moved moved;
    char holder[MECHANISM_MOST_HOLDS][2 * LD_MAX_NAME]; // keys of what holds a joint
} mechanism_base;

const mechanism_system *mechanism_of(const base_system *self);
// Where the wheels' states begin.
int mechanism_base_marching_at(const base_system *self);
// The carrier at time t [s]; linearised it rests in its attitude, in the origin.
base_frame mechanism_base_carrier(const base_system *self, double t);
// The body on the wheels, without a quaternion.
base_frame mechanism_base_chassis(const base_system *self, const mechanism_motion *motion);

// Density of the air and its velocity in I about the bodies, as at the tube's rear end.
void mechanism_base_find_air(const mechanism_base *self, const mechanism_motion *motion,
                             mechanism_input *input);

// ---- a kind's build()

// Carrier, mechanisms, wheels and air.
ld_status mechanism_base_build(base_system *base, const mechanism_plan *plan, ld_error *error);
// The counts of the base, of what is built and of its freedoms.
void mechanism_base_count(base_system *base);
// Puts the wheels at their mounts.
void mechanism_base_mount_wheels(const base_system *base, double *state);

// LD_ERR_INPUT for a wheel that does not reach the road in an equilibrium.
ld_status mechanism_base_check_wheels(const base_system *self, const base_found *found,
                                      const double *state, ld_error *error);

// ---- columns of wheels and drive; their instant is the first member of the base's

extern const quantity rolling_drive_columns[2], rolling_wheel_columns[9];

void mechanism_base_fill_rolling(const base_system *base, const base_output *output,
                                 const double *state, rolling_instant *now);

// ---- functions of a base's interface and dynamics

void mechanism_base_free(base_system *base);
road *mechanism_base_take_road(base_system *self);
ld_status mechanism_base_share(base_system *base, ld_error *error);
void mechanism_base_find_frame(const base_system *self, double t, const double *state,
                               base_frame *tube, base_found *found);
void mechanism_base_span(const base_system *base, double *first, double *last);
double mechanism_base_next_corner(const base_system *base, double t);
double mechanism_base_next_sample(const base_system *self, double t);
void mechanism_base_sample(const base_system *self, double t, double *state);

int mechanism_base_evaluate(const base_system *self, const base_found *found, const base_load *load,
                            const double *state, base_output *output);
double mechanism_base_kinetic_energy(const base_system *self, const base_found *found,
                                     const double *state);
void mechanism_base_tolerances(const base_system *self, double tolerance, double *atol,
                               bool *absolute);
void mechanism_base_set_start_velocity(const base_system *self, double *state);
void mechanism_base_project(const base_system *self, double t, double *state);
int mechanism_base_part_of(const base_system *self, int state);

// Unknowns of an equilibrium: the displacements in `freedom`, torques of holds, wheel positions.
void mechanism_base_displace(const base_system *self, int freedom, double change, double *state);
void mechanism_base_rest_of(const base_system *self, const double *state, base_rest *rest);
void mechanism_base_residual(const base_system *self, const base_output *output, double *r);

// Displacements: those in the sense of the independent speeds, then wheel positions.
void mechanism_base_displace_slightly(const base_system *self, int displacement, double change,
                                      double *state);
int mechanism_base_speed_of(const base_system *self, int displacement);
void mechanism_base_quicken(const base_system *self, int displacement, double change,
                            double *state);
int mechanism_base_extra_of(const base_system *self, int extra);
const char *mechanism_base_holder_of(const base_system *self, int displacement);
double mechanism_base_held_by(const base_system *self, const base_output *output, int displacement);

#endif
