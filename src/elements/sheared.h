// Shear of the launching tube, where it has that: its sections turn by the slope of the axis less
// an element's strain (flexible_tube.h). Out of line: most tubes have none.
#ifndef LD_ELEMENTS_SHEARED_H
#define LD_ELEMENTS_SHEARED_H

#include "elements/instant.h"

// The element's strains and their rates.
LD_OUTLINE void element_shear(const tube_system *self, const modal_state *q, int index,
                              element_motion *motion)
{
    const double *bent[2] = {q->y, q->z}, *rate[2] = {q->y_dot, q->z_dot};
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
        const double *strain = self->flexible.shear->strain[index][plane];
        motion->strain[plane] = motion->strain_dot[plane] = 0;
        for (int i = 0; i < self->flexible.nb; i++) {
            motion->strain[plane] += strain[i] * bent[plane][i];
            motion->strain_dot[plane] += strain[i] * rate[plane][i];
        }
    }
}

// A rotation vector by slopes, or its rate, less strains.
LD_INLINE void turn_less(const double strain[2], v3 *th)
{
    th->y += strain[PLANE_Z];
    th->z -= strain[PLANE_Y];
}

// What a moment mu on a section of the element does to the modes besides by its slope.
LD_OUTLINE void shear_by_moment(const tube_system *self, int index, v3 mu, tube_force *h)
{
    double(*strain)[LD_NB] = self->flexible.shear->strain[index];
    for (int i = 0; i < self->flexible.nb; i++) {
        h->y[i] -= mu.z * strain[PLANE_Y][i];
        h->z[i] += mu.y * strain[PLANE_Z][i];
    }
}

#endif
