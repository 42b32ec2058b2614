// A rigid rocket on a rigid rail without gaps and friction: points of the rocket stay on lines that
// are fixed to the base, both shoes' first, then, when the front one has left, the rear one's
// alone, about which the rocket pivots. Newton's and Euler's equations of one body with a
// multiplier a row, classical Runge-Kutta. Nothing of the program is used but the model's numbers.
#ifndef LD_TESTS_SUPPORT_RIGID_RAIL_H
#define LD_TESTS_SUPPORT_RIGID_RAIL_H

#include <stdbool.h>

#include "launchdyn/model.h"

typedef struct rigid_exit {
    double t_release, t_front, t_rear;                              // [s] from ignition
    double exit_speed, pitch, yaw, pitch_rate, yaw_rate, spin_rate; // as ld_rocket_summary
    double front_force[2], rear_force[2]; // [N] on the rocket along the rail's y and z, just before
                                          // the front shoe leaves
    double pivot_force[2];                // [N] of the rear shoe just after
    double roll_moment;                   // [N m] on the rocket about the rail, just after
} rigid_exit;

// Launches the model's rocket (rear and front adaptor, undeformed start, base fixed or prescribed
// by sines and a velocity) along the line at (line[0], line[1]) of the base with steps of at most
// `step` [s]. holds_roll: the shoes do, too. Returns false where it has not left at the stuck time.
bool rigid_rail_launch(const ld_model *model, const double line[2], bool holds_roll, double step,
                       rigid_exit *exit);

#endif
