#include "systems/base_motion.h"

#include <math.h>

#include <stdlib.h>

static const double TWO_PI = 6.283185307179586476925286766559;

static const ld_sines *sines_of(const ld_base *model, int i)
{
    const ld_sines *all[6] = {&model->surge, &model->heave, &model->sway,
                              &model->yaw,   &model->pitch, &model->roll};
    return all[i];
}

// Value and rate of coordinate i: x, y, z, yaw, pitch, roll.
static double coordinate(const base_motion *self, int i, double t, double *rate)
{
    double value = 0;
    *rate = 0;
    if (i < 3) {
        value = self->model->velocity[i] * t;
        *rate = self->model->velocity[i];
    }
    const ld_sines *sines = sines_of(self->model, i);
    for (int k = 0; k < sines->count; k++) {
        double omega = TWO_PI * sines->term[k].frequency;
        double angle = omega * t + sines->term[k].phase;
        value += sines->term[k].amplitude * sin(angle);
        *rate += sines->term[k].amplitude * omega * cos(angle);
    }
    if (self->path[i].count) {
        double slope;
        value += spline_value(&self->path[i], t, &slope);
        *rate += slope;
    }
    return value;
}

static void frame_at(const base_motion *self, double t, base_frame *frame)
{
    double x[6], u[6];
    for (int i = 0; i < 6; i++)
        x[i] = coordinate(self, i, t, &u[i]);
    // A_base = Ry(yaw) Rz(pitch) Rx(roll); w = yaw' e_y + Ry (pitch' e_z + Rz roll' e_x)
    m3 Ry = m3_rotation_y(x[3]), Rz = m3_rotation_z(x[4]), Rx = m3_rotation_x(x[5]);
    m3 A = m3_mul(Ry, m3_mul(Rz, Rx));
    v3 w = m3_apply(Rz, v3_make(u[5], 0, 0));
    w.z += u[4];
    w = m3_apply(Ry, w);
    w.y += u[3];
    frame->r = v3_make(x[0], x[1], x[2]);
    frame->v = v3_make(u[0], u[1], u[2]);
    frame->A = m3_mul(A, self->mount);
    frame->q = q_from_matrix(frame->A);
    frame->w = w;
}

ld_status base_motion_build(base_motion *self, const ld_base *model, ld_error *error)
{
    *self = (base_motion){.model = model};
    self->mount = m3_mul(m3_rotation_y(model->azimuth), m3_rotation_z(model->elevation));
    const ld_table *table = &model->motion;
    if (model->kind == LD_BASE_PRESCRIBED && table->rows) {
        double *column = malloc(2 * table->rows * sizeof(double));
        ld_status status = column ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory");
        for (int i = 0; i < 6 && !status; i++) {
            for (size_t k = 0; k < table->rows; k++) {
                column[k] = table->data[k * table->columns];
                column[table->rows + k] = table->data[k * table->columns + 1 + (size_t)i];
            }
            status = spline_build(&self->path[i], table->rows, column, column + table->rows, error);
        }
        free(column);
        if (status) {
            base_motion_free(self);
            return status;
        }
    }
    if (model->kind == LD_BASE_FIXED) {
        self->fixed.A = self->mount;
        self->fixed.q = q_from_matrix(self->mount);
    }
    return LD_OK;
}

void base_motion_free(base_motion *self)
{
    for (int i = 0; i < 6; i++)
        spline_free(&self->path[i]);
}

void base_motion_at(const base_motion *self, double t, base_frame *frame)
{
    if (self->model->kind == LD_BASE_FIXED)
        *frame = self->fixed;
    else
        frame_at(self, t, frame);
}

void base_motion_angles(const base_motion *self, double t, double angles[3])
{
    double rate;
    for (int i = 0; i < 3; i++)
        angles[i] = self->model->kind == LD_BASE_FIXED ? 0 : coordinate(self, 3 + i, t, &rate);
}

void base_motion_span(const base_motion *self, double *first, double *last)
{
    const spline *path = &self->path[0];
    *first = path->count ? path->x[0] : -INFINITY;
    *last = path->count ? path->x[path->count - 1] : INFINITY;
}
