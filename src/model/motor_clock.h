// When a row of a motor's tables over time comes (model.md, section 5).
#ifndef LD_MODEL_MOTOR_CLOCK_H
#define LD_MODEL_MOTOR_CLOCK_H

#include "model/blocks/motor.h"

// The end of the rise: the first row of the thrust at MOTOR_RISE of its greatest.
#define MOTOR_RISE 0.9

double motor_rise_time(const ld_motor *motor); // [s], unscaled

// Time after ignition [s] of the tables' time t: the rise is stretched, what follows moves along;
// then all is stretched and delayed.
double motor_clock(const ld_motor *motor, double t);
double further_motor_clock(const ld_further_motor *motor, double t); // without a rise of its own

#endif
