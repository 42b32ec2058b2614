// The stabiliser of a hinge: loops that hold a platform at its commanded angle, and the actuator
// between them and the hinge (model.md, section 6).
//
// State: z, integral of the loops [N m]; where there is more than the loops, what the actuator has
// in the state [DRIVE_STATES].
#ifndef LD_SYSTEMS_STABILISER_H
#define LD_SYSTEMS_STABILISER_H

#include <stdbool.h>
#include <stdint.h>

#include "model/blocks/stabiliser.h"

enum {
    DRIVE_TORQUE,   // [N m] of an actuator that lags
    DRIVE_HELD,     // [N m] asked for until a digital loop gives out the next
    DRIVE_COMPUTED, // [N m] that it gives out next
    DRIVE_TWIST,    // [rad] of a gear: the motor's angle less the hinge's
    DRIVE_RATE,     // [rad/s] of the motor against what carries it
    DRIVE_STATES
};

typedef struct hinge_report {
    double angle, rate;             // [rad], [rad/s] of the hinge
    double base_rate;               // [rad/s] of the chassis against I, along the hinge's axis
    double measured, measured_rate; // pitch (yaw) of the elevation platform's x axis against I
    double command, command_rate;
    double error;    // wrapped
    double torque;   // [N m] of stabiliser or lock on the outboard body
    double friction; // [N m]
    bool limited;    // torque asked for at its limit
} hinge_report;

// Whether it has anything but z in the state.
bool stabiliser_has_drive(const ld_stabiliser *given);

// Puts the drive at rest under a torque [N m].
void stabiliser_rest(const ld_stabiliser *given, double torque, double *drive);

// Torque on the outboard body, into the report, whose angles and rates are known; rates of the
// state. `drive`, `drive_dot`: unused if it has none. `linear`: a digital loop as a continuous one,
// teeth as if they stuck together.
void stabiliser_evaluate(const ld_stabiliser *given, bool linear, double z, const double *drive,
                         hinge_report *hinge, double *z_dot, double *drive_dot);

// The first instant [s] after t at which a digital loop takes a sample or gives out a torque;
// infinity: none.
double stabiliser_next_sample(const ld_stabiliser *given, double t);

// What it does to its state at such an instant, from the angles and rates in the report; `stream`
// of the sensors' noise.
void stabiliser_sample(const ld_stabiliser *given, double t, uint64_t stream,
                       const hinge_report *hinge, double *z, double *drive);

#endif
