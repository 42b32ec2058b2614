// A base that stands still.
#include <stdlib.h>

#include "model/model.h"
#include "systems/bases/base_coordinates.h"

static ld_status build(base_system *self, ld_error *error)
{
    base_frame *still = calloc(1, sizeof *still);
    if (!still)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base");
    const ld_base *given = &self->model->base;
    still->A = m3_mul(m3_rotation_y(given->azimuth), m3_rotation_z(given->elevation));
    still->q = q_from_matrix(still->A);
    self->own = still;
    return LD_OK;
}

static void release(base_system *self)
{
    free(self->own);
}

static void find_frame(const base_system *self, double t, const double *state, base_frame *tube,
                       base_found *found)
{
    (void)t, (void)state, (void)found;
    const base_frame *still = self->own;
    const base_disturbance *disturbed = self->disturbed;
    if (disturbed)
        base_frame_at(disturbed->input.motion, disturbed->rate.motion,
                      disturbed->acceleration.motion, &still->A, tube);
    else
        *tube = *still;
}

static void angles(const base_system *self, double t, double angles[3])
{
    (void)t;
    for (int i = 0; i < 3; i++)
        angles[i] = self->disturbed ? self->disturbed->input.motion[3 + i] : 0;
}

const base_interface base_fixed = {.build = build,
                                   .free = release,
                                   .find_frame = find_frame,
                                   .angles = angles,
                                   .inputs = &base_motion_inputs};
