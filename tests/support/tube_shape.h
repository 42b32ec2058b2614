// For tests of the flexible tube: the reference tubes alone, and shapes at any station, one at a
// time.
#ifndef LD_TESTS_SUPPORT_TUBE_SHAPE_H
#define LD_TESTS_SUPPORT_TUBE_SHAPE_H

#include <stdlib.h>

#include "elements/tube/flexible_tube.h"
#include "model/model.h"
#include "support/reference_model.h"

// The tubes of the reference launcher without their slot, so that nothing needs to be freed.
static inline ld_tubes reference_tubes(void)
{
    ld_model model;
    reference_model(&model);
    free(model.title);
    free(model.rocket.motor.thrust.data);
    free(model.tubes.slot.angle.data);
    model.tubes.slot = (ld_slot){.kind = LD_SLOT_NONE};
    return model.tubes;
}

// Bending shape k of a plane or its first, second or third x-derivative at station x.
static inline double tube_bending(const flexible_tube *tube, int plane, int k, double x,
                                  int derivative)
{
    const tube_element *e = &tube->element[flexible_tube_find(tube, x)];
    double xi = x - e->x0, c[4];
    for (int i = 0; i < 4; i++)
        c[i] = e->b[plane][i][k];
    switch (derivative) {
    case 0:
        return c[0] + xi * (c[1] + xi * (c[2] + xi * c[3]));
    case 1:
        return c[1] + xi * (2 * c[2] + xi * 3 * c[3]);
    case 2:
        return 2 * c[2] + 6 * xi * c[3];
    default:
        return 6 * c[3];
    }
}

// Torsion shape k, or its slope, at station x.
static inline double tube_torsion(const flexible_tube *tube, int k, double x, int derivative)
{
    const tube_element *e = &tube->element[flexible_tube_find(tube, x)];
    return derivative ? e->tau[1][k] : e->tau[0][k] + (x - e->x0) * e->tau[1][k];
}

// Axial shape k, or its slope, at station x.
static inline double tube_stretch(const flexible_tube *tube, int k, double x, int derivative)
{
    const tube_element *e = &tube->element[flexible_tube_find(tube, x)];
    return derivative ? e->a[1][k] : e->a[0][k] + (x - e->x0) * e->a[1][k];
}

#endif
