// The rows of a measured motion as they are meant: on the run's clock, angles that do not jump from
// one end of a turn to the other, quaternions of length 1 that keep their sign.
#ifndef LD_MODEL_MOTION_ROWS_H
#define LD_MODEL_MOTION_ROWS_H

#include <stdbool.h>
#include <stddef.h>

#include "model/blocks/base.h"

enum { MOTION_ANGLES = 6, MOTION_QUATERNION = 7 };

typedef struct motion_rows {
    size_t count;
    size_t coordinates; // x, y, z and yaw, pitch, roll, or x, y, z and the quaternion's four
    double *t;          // [count] [s]
    double *at;         // [count][coordinates] [m], [rad], [-]
} motion_rows;

// Rows first .. first + count - 1 of the table; false: there is no memory.
bool motion_rows_take(motion_rows *self, const ld_base *base, size_t first, size_t count);
void motion_rows_free(motion_rows *self);

// Takes the jumps by a turn out of angles [rad] `stride` numbers apart.
void motion_unwrap(size_t count, size_t stride, double *angle);

#endif
