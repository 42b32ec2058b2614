// A launch of a rigid rocket from a rigid tube on any base, by point masses
// (support/point_masses.h): the base says where its points and the tube are, written out by hand;
// the rocket slides on the tube's axis, locked until the release force, then on two adaptors, then
// about the rear one alone.
#ifndef LD_TESTS_SUPPORT_LUMPED_LAUNCH_H
#define LD_TESTS_SUPPORT_LUMPED_LAUNCH_H

#include "launchdyn/results.h"
#include "model/model.h"
#include "support/point_masses.h"
#include "support/recorded_run.h"

// Origin and axes of the undeformed tube in I.
typedef struct lumped_frame {
    cplx r[3];
    cplx_matrix A;
} lumped_frame;

typedef struct lumped_base {
    int coordinates, extra, points;
    double mass[MOST_POINTS];
    void (*place)(const void *self, cplx t, const cplx *q, cplx (*r)[3], lumped_frame *tube);
    void (*push)(const void *self, double t, const mass_motion *now, double (*F)[3], double *Q,
                 double *z_dot);
    const void *self;
} lumped_base;

// Coordinates of the rocket, behind those of the base: travel [m]; roll, yaw, pitch [rad].
enum { ROCKET_S, ROCKET_ROLL, ROCKET_YAW, ROCKET_PITCH, ROCKET_COORDINATES };

typedef struct lumped_launch {
    const ld_model *model;
    const lumped_base *base;
    mass_system system;
    double y[2 * MOST_COORDINATES + MOST_EXTRA];
    double t, step;      // [s]
    int first;           // the rocket's first coordinate
    int carried, rocket; // first points of the tube and of the rocket
    double tube_point[64][3], rocket_point[RIGID_POINTS + 2][3];
    bool locked, both, gone;
    double t_release, t_front, t_rear; // [s]
} lumped_launch;

// Starts at t [s] in the place q of the base with the speeds u (NULL: zeros) and extra states z
// (NULL: zeros).
void lumped_begin(lumped_launch *self, const ld_model *model, const lumped_base *base, double t,
                  double step, const double *q, const double *u, const double *z);
// Puts coordinates of the base where they have no acceleration, by Newton's method from where they
// are, without motion.
void lumped_settle(lumped_launch *self, const int *coordinate, int count);
// Goes on to an instant, or to the rocket's exit.
void lumped_advance(lumped_launch *self, double t);

// What is compared: a coordinate of the lumped model and a column of the run.
typedef struct lumped_pair {
    const char *column;
    int coordinate;        // -1: the rocket's travel
    double factor, offset; // column = factor * coordinate + offset
    double bound;
} lumped_pair;

// How far exit time [s], exit speed [m/s] and the rates of pitch and yaw at the exit [rad/s], in
// the tube's axes held still, may differ.
typedef struct lumped_exit {
    double time, speed, rates;
} lumped_exit;

// Advances from row to row of the run and checks the largest difference of each pair, then the
// exit.
void lumped_compare(lumped_launch *self, const recorded_run *run, const lumped_pair *pair,
                    int count, const lumped_exit *bound);

// Reads examples/multibody/NAME with a rail or tube and its supports rigid for all purposes, the
// rocket of constant mass on its axis without play and friction, no air; with more keys set.
void lumped_model(const char *name, const char *const *sets, size_t count, ld_model *model);

// Body and joint of a scenario by name; fails the test where there is none.
const ld_body *lumped_body(const ld_model *model, const char *name);
const ld_joint *lumped_joint(const ld_model *model, const char *name);
// Adds a rigid body's points to the base's, in the body's axes; number of the first.
int lumped_add_body(lumped_base *base, double (*point)[3], const ld_body *body);
// A marker without mass.
int lumped_add_marker(lumped_base *base, double (*point)[3], const double at[3]);

#endif
