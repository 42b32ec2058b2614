#include "systems/bases/multibody_base.h"

#include "systems/bases/base_coordinates.h"

base_frame multibody_carrier(const base_system *base, double t)
{
    static const m3 E = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const multibody_base *self = base->own;
    const base_disturbance *disturbed = base->disturbed;
    base_frame frame;
    double x[6], u[6], a[6];
    if (self->carrier.table.turned && !disturbed) {
        motion_table_place(&self->carrier.table, t, &E, &frame);
        return frame;
    }
    prescribed_motion_at(&self->carrier, t, x, u, a);
    for (int i = 0; i < 6 && disturbed; i++) {
        x[i] = (i < 3 ? 0 : x[i]) + disturbed->input.motion[i];
        u[i] = disturbed->rate.motion[i];
        a[i] = disturbed->acceleration.motion[i];
    }
    base_frame_at(x, u, a, &E, &frame);
    return frame;
}
