// A base that moves over time as the scenario says, at constant velocity, in sines, by a table and
// as a ship in its sea.
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/bases/base_coordinates.h"
#include "systems/bases/motion_table.h"
#include "systems/bases/sea_motion.h"

typedef struct base_motion {
    const ld_base *model;
    m3 mount;   // A_base,tube = Ry(azimuth) Rz(elevation)
    v3 arm;     // [m] T's origin from the base's, in T
    bool apart; // it is not 0
    motion_table table;
    sea_motion sea;
} base_motion;

static const double TWO_PI = 6.283185307179586476925286766559;

static const ld_sines *sines_of(const ld_base *model, int i)
{
    const ld_sines *all[6] = {&model->surge, &model->heave, &model->sway,
                              &model->yaw,   &model->pitch, &model->roll};
    return all[i];
}

// Value, rate and acceleration of coordinate i: x, y, z, yaw, pitch, roll.
static double coordinate(const base_motion *self, int i, double t, double *rate,
                         double *acceleration)
{
    double value = 0;
    *rate = *acceleration = 0;
    if (i < 3) {
        value = self->model->velocity[i] * t;
        *rate = self->model->velocity[i];
    }
    const ld_sines *sines = sines_of(self->model, i);
    for (int k = 0; k < sines->count; k++) {
        double omega = TWO_PI * sines->term[k].frequency;
        double s, c;
        sincos(omega * t + sines->term[k].phase, &s, &c);
        value += sines->term[k].amplitude * s;
        *rate += sines->term[k].amplitude * omega * c;
        *acceleration -= sines->term[k].amplitude * omega * omega * s;
    }
    return value;
}

// Where it is at time t, of a table of quaternions without the angles' rates; linearised it rests
// in the attitude of t, in the origin.
static void coordinates(const base_system *base, double t, double x[6], double u[6], double a[6])
{
    const base_disturbance *disturbed = base->disturbed;
    const base_motion *self = base->own;
    for (int i = 0; i < 6; i++)
        x[i] = coordinate(self, i, t, &u[i], &a[i]);
    motion_table_add(&self->table, t, x, u, a);
    sea_motion_add(&self->sea, t, x, u, a);
    for (int i = 0; i < 6 && disturbed; i++) {
        x[i] = (i < 3 ? 0 : x[i]) + disturbed->input.motion[i];
        u[i] = disturbed->rate.motion[i];
        a[i] = disturbed->acceleration.motion[i];
    }
}

static void place(const base_system *base, double t, const double *state, base_frame *frame,
                  base_found *found)
{
    (void)state, (void)found;
    const base_motion *self = base->own;
    double x[6], u[6], a[6];
    if (self->table.turned && !base->disturbed) {
        motion_table_place(&self->table, t, &self->mount, frame);
    } else {
        coordinates(base, t, x, u, a);
        base_frame_at(x, u, a, &self->mount, frame);
    }
    if (self->apart)
        base_frame_go(frame, self->arm);
}

// When the launch begins and, as far as that is known before, ends.
static void course(const ld_model *model, double *first, double *last)
{
    *first = -model->run.lead_in;
    *last = 0;
    for (int i = 0; i < model->firing_count; i++) {
        *first = fmin(*first, model->firing[i].at);
        *last = fmax(*last, model->firing[i].at);
    }
    *last += model->run.end == LD_END_TIME ? model->run.end_time : model->run.stuck_time;
}

static ld_status build(base_system *base, ld_error *error)
{
    base_motion *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base");
    base->own = self;
    self->model = &base->model->base;
    self->mount =
        m3_mul(m3_rotation_y(self->model->azimuth), m3_rotation_z(self->model->elevation));
    self->arm = m3_apply_transposed(self->mount, v3_from(self->model->at));
    self->apart = v3_norm(self->arm) > 0;
    double first, last;
    course(base->model, &first, &last);
    ld_status status = sea_motion_build(&self->sea, base->model, first, last, error);
    return status ? status : motion_table_build(&self->table, self->model, error);
}

static void release(base_system *base)
{
    base_motion *self = base->own;
    if (self) {
        motion_table_free(&self->table);
        sea_motion_free(&self->sea);
    }
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
    const motion_rows *rows = &self->table.rows;
    *first = rows->count ? rows->t[0] : -INFINITY;
    *last = rows->count ? rows->t[rows->count - 1] : INFINITY;
}

const base_interface base_prescribed = {.build = build,
                                        .free = release,
                                        .place = place,
                                        .angles = angles,
                                        .span = span,
                                        .inputs = &base_motion_inputs};
