// The stabiliser of a hinge: what holds a platform at its commanded angle (model.md, section 6).
#ifndef LD_SYSTEMS_STABILISER_H
#define LD_SYSTEMS_STABILISER_H

#include "model/model.h"

typedef struct hinge_report {
    double angle, rate;             // [rad], [rad/s] of the hinge
    double base_rate;               // [rad/s] of the chassis against I, along the hinge's axis
    double measured, measured_rate; // pitch (yaw) of the elevation platform's x axis against I
    double command, command_rate;
    double error;    // wrapped
    double torque;   // [N m] of stabiliser or lock on the outboard body
    double friction; // [N m]
    bool limited;    // torque at its limit
} hinge_report;

// Torque on the outboard body, into the report, whose angles and rates are known; returns the rate
// of the integral z.
double stabiliser_drive(const ld_stabiliser *given, double z, hinge_report *hinge);

#endif
