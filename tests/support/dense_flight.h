// Free flight a second time, for comparison: written from the model's text alone, plainly, sharing
// no code with src/ but vectors. Rear adaptor and quaternion of B itself in inertial axes, Euler's
// equations about the mass centre, steps of one size by extrapolated midpoints (Gragg, order 6).
#ifndef LD_TESTS_SUPPORT_DENSE_FLIGHT_H
#define LD_TESTS_SUPPORT_DENSE_FLIGHT_H

#include <stdbool.h>

#include "launchdyn/model.h"
#include "math/vec3.h"

typedef struct dense_flight_end {
    double t;           // [s] of the impact on the run's clock
    double center[3];   // [m] mass centre in I
    double velocity[3]; // [m/s] of the mass centre against the ground, in I
    double position[3]; // [m] rear adaptor in I
    double axis[3];     // x axis of B in I
    double rate[3];     // [rad/s] against inertial axes, in B
    double angle;       // [rad] of that velocity below the horizontal there
    double apogee; // [m] greatest height of the mass centre at the ends of the steps: y of I, or
                   // above sphere or ellipsoid
} dense_flight_end;

// A flight alone that begins with position, velocity and angles or quaternion against I, at the
// rear adaptor; no turbulence. `step` [s] at most.
void dense_flight(const ld_model *model, double step, dense_flight_end *end);

// What the air does to a rocket about its mass centre c [m], all in B.
typedef struct dense_wrench {
    v3 f, m; // [N], [N m]
} dense_wrench;

// v: velocity through the air [m/s], w: rate [rad/s]; density [kg/m3] and speed of sound [m/s];
// power: the thrust table has not ended. Of a table's ways between its rows: pchip alone.
dense_wrench dense_air(const ld_model *model, bool power, v3 c, v3 v, v3 w, double density,
                       double sound);

#endif
