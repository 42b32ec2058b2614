// Free flight a second time, for comparison: written from the model's text alone, plainly, sharing
// no code with src/ but vectors. Rear adaptor and quaternion of B itself in inertial axes, Euler's
// equations about the mass centre, steps of one size by extrapolated midpoints (Gragg, order 6).
#ifndef LD_TESTS_SUPPORT_DENSE_FLIGHT_H
#define LD_TESTS_SUPPORT_DENSE_FLIGHT_H

#include "model/model.h"

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

#endif
