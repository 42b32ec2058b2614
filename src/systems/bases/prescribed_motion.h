// A frame that moves over time as the scenario says, at constant velocity, in sines, by a table and
// as a ship in its sea: base.velocity, base.motion, base.sea.
#ifndef LD_SYSTEMS_PRESCRIBED_MOTION_H
#define LD_SYSTEMS_PRESCRIBED_MOTION_H

#include "systems/bases/motion_table.h"
#include "systems/bases/sea_motion.h"

typedef struct prescribed_motion {
    const ld_base *model;
    motion_table table;
    sea_motion sea;
} prescribed_motion;

ld_status prescribed_motion_build(prescribed_motion *self, const ld_model *model, ld_error *error);
void prescribed_motion_free(prescribed_motion *self);

// Coordinates x, y, z, yaw, pitch, roll at t [s], of a table of quaternions without the angles'
// rates, their rates u and accelerations a.
void prescribed_motion_at(const prescribed_motion *self, double t, double x[6], double u[6],
                          double a[6]);
// The first and the last time [s] that its table covers; all without one.
void prescribed_motion_span(const prescribed_motion *self, double *first, double *last);
// Whether it moves at all.
bool prescribed_motion_moves(const prescribed_motion *self);

#endif
