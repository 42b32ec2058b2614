// A motion that was measured, as a table over time: cubic splines through position and attitude.
#ifndef LD_SYSTEMS_MOTION_TABLE_H
#define LD_SYSTEMS_MOTION_TABLE_H

#include "elements/base_frame.h"
#include "launchdyn/status.h"
#include "model/motion_rows.h"

typedef struct motion_table {
    motion_rows rows; // none: there is no table
    bool turned;      // their attitude is a quaternion
    double *piece;    // [rows - 1][coordinates][4] of (t - t_i)^k
    double *angles;   // [rows][3] yaw, pitch, roll of quaternions, without jumps by a turn; or NULL
} motion_table;

// Of a base with a table in its motion, else without rows.
ld_status motion_table_build(motion_table *self, const ld_base *model, ld_error *error);
void motion_table_free(motion_table *self);

// Adds x, y, z [m], yaw, pitch, roll [rad] at t [s] to x and, of a table of angles, their rates and
// accelerations to u and a.
void motion_table_add(const motion_table *self, double t, double x[6], double u[6], double a[6]);

// Of a table of quaternions: the frame of a tube mounted so, A_base,tube, in the base's origin.
void motion_table_place(const motion_table *self, double t, const m3 *mount, base_frame *tube);

#endif
