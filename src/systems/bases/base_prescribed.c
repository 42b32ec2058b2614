// A base that moves over time as the scenario says, at constant velocity, in sines, by a table and
// as a ship in its sea.
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/bases/base_coordinates.h"
#include "systems/bases/prescribed_motion.h"

typedef struct base_motion {
    m3 mount;   // A_base,tube = Ry(azimuth) Rz(elevation)
    v3 arm;     // [m] T's origin from the base's, in T
    bool apart; // it is not 0
    prescribed_motion motion;
} base_motion;

// Where it is at time t, of a table of quaternions without the angles' rates; linearised it rests
// in the attitude of t, in the origin.
static void coordinates(const base_system *base, double t, double x[6], double u[6], double a[6])
{
    const base_disturbance *disturbed = base->disturbed;
    const base_motion *self = base->own;
    prescribed_motion_at(&self->motion, t, x, u, a);
    for (int i = 0; i < 6 && disturbed; i++) {
        x[i] = (i < 3 ? 0 : x[i]) + disturbed->input.motion[i];
        u[i] = disturbed->rate.motion[i];
        a[i] = disturbed->acceleration.motion[i];
    }
}

static void find_frame(const base_system *base, double t, const double *state, base_frame *frame,
                       base_found *found)
{
    (void)state, (void)found;
    const base_motion *self = base->own;
    double x[6], u[6], a[6];
    if (self->motion.table.turned && !base->disturbed) {
        motion_table_place(&self->motion.table, t, &self->mount, frame);
    } else {
        coordinates(base, t, x, u, a);
        base_frame_at(x, u, a, &self->mount, frame);
    }
    if (self->apart)
        base_frame_go(frame, self->arm);
}

static ld_status build(base_system *base, ld_error *error)
{
    base_motion *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base");
    base->own = self;
    const ld_base *given = &base->model->base;
    self->mount = m3_mul(m3_rotation_y(given->azimuth), m3_rotation_z(given->elevation));
    self->arm = m3_apply_transposed(self->mount, v3_from(given->at));
    self->apart = v3_norm(self->arm) > 0;
    return prescribed_motion_build(&self->motion, base->model, error);
}

static void release(base_system *base)
{
    base_motion *self = base->own;
    if (self)
        prescribed_motion_free(&self->motion);
    free(self);
}

// Of the base itself, without azimuth and elevation.
static void angles(const base_system *base, double t, double angles[3])
{
    double x[6], u[6], a[6];
    coordinates(base, t, x, u, a);
    memcpy(angles, x + 3, 3 * sizeof *angles);
}

static void span(const base_system *base, double *first, double *last)
{
    const base_motion *self = base->own;
    prescribed_motion_span(&self->motion, first, last);
}

const base_interface base_prescribed = {.build = build,
                                        .free = release,
                                        .find_frame = find_frame,
                                        .angles = angles,
                                        .span = span,
                                        .inputs = &base_motion_inputs};
