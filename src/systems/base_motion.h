// The base that carries the tube: where the undeformed tube is and how it moves (model.md, section
// 2).
#ifndef LD_SYSTEMS_BASE_MOTION_H
#define LD_SYSTEMS_BASE_MOTION_H

#include "elements/base_frame.h"
#include "math/spline.h"
#include "model/model.h"

// The frame T of the undeformed tube: origin at its rear end, x along it.

typedef struct base_motion {
    const ld_base *model;
    base_frame fixed; // the pose of kind fixed, at rest
    m3 mount;         // A_base,tube = Ry(azimuth) Rz(elevation)
    spline path[6];   // x, y, z, yaw, pitch, roll over time (table)
} base_motion;

ld_status base_motion_build(base_motion *self, const ld_base *model, ld_error *error);
void base_motion_free(base_motion *self);

// Frame at time t [s] of the run's clock.
void base_motion_at(const base_motion *self, double t, base_frame *frame);

// Pose angles of the base itself (without azimuth and elevation): yaw, pitch, roll [rad], for
// output.
void base_motion_angles(const base_motion *self, double t, double angles[3]);

// First and last time [s] that a table covers; without a table, all.
void base_motion_span(const base_motion *self, double *first, double *last);

#endif
