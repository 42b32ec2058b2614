#include "systems/bases/body_instant.h"

#include <math.h>

// Upright, yaw and roll turn about one axis: that is told as roll.
static void find_angles(const m3 *A, double angles[3])
{
    m3_yaw_pitch_roll(A, angles);
    if (hypot(A->a[0][0], A->a[2][0]) > 1e-9)
        return;
    angles[0] = 0;
    angles[2] = atan2(A->a[2][1], A->a[2][2]);
}

void body_instant_find(const body_motion *from, body_instant *to)
{
    v3_store(to->r, from->r);
    v3_store(to->v, from->v);
    v3_store(to->w, m3_apply_transposed(from->A, from->w));
    find_angles(&from->A, to->angles);
}
