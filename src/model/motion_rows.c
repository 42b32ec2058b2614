#include "model/motion_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double TURN = 6.283185307179586476925286766559;

// Where all lie within a turn, a step of more than three quarters of it is one of the instrument,
// which continues at the other end.
void motion_unwrap(size_t count, size_t stride, double *angle)
{
    double low = INFINITY, high = -INFINITY, added = 0, before = angle[0];
    for (size_t i = 0; i < count; i++) {
        low = fmin(low, angle[i * stride]);
        high = fmax(high, angle[i * stride]);
    }
    for (size_t i = 1; i < count && high - low <= TURN * (1 + 1e-9); i++) {
        double now = angle[i * stride], step = now - before;
        if (fabs(step) > 0.75 * TURN)
            added -= copysign(TURN, step);
        angle[i * stride] = now + added;
        before = now;
    }
}

// Makes a quaternion of length 1 and of its two signs takes that which is nearer to the one before;
// NULL: there is none.
static void straighten(double *q, const double *before)
{
    double square = 0, along = 0;
    for (int k = 0; k < 4; k++)
        square += q[k] * q[k];
    for (int k = 0; k < 4; k++)
        along += before ? q[k] * before[k] : 0;
    for (int k = 0; k < 4; k++)
        q[k] /= copysign(sqrt(square), along);
}

bool motion_rows_take(motion_rows *self, const ld_base *base, size_t first, size_t count)
{
    const ld_table *table = &base->motion;
    size_t n = table->columns - 1;
    *self = (motion_rows){.count = count, .coordinates = n};
    self->t = malloc(count * (n + 1) * sizeof(double));
    if (!self->t)
        return false;
    self->at = self->t + count;
    for (size_t i = 0; i < count; i++) {
        const double *from = table->data + (first + i) * table->columns;
        double *row = self->at + i * n;
        self->t[i] = from[0] - (base->motion_start - base->motion_origin);
        memcpy(row, from + 1, n * sizeof *row);
        if (n == MOTION_QUATERNION)
            straighten(row + 3, i > 0 ? row + 3 - n : NULL);
    }
    for (size_t k = 3; k < n && n == MOTION_ANGLES; k++)
        motion_unwrap(count, n, self->at + k);
    return true;
}

void motion_rows_free(motion_rows *self)
{
    free(self->t);
    *self = (motion_rows){0};
}
