#include "systems/bases/prescribed_motion.h"

#include "math/functions.h"
#include "model/model.h"

static const double TWO_PI = 6.283185307179586476925286766559;

static const ld_sines *sines_of(const ld_base *model, int i)
{
    const ld_sines *all[6] = {&model->surge, &model->heave, &model->sway,
                              &model->yaw,   &model->pitch, &model->roll};
    return all[i];
}

// Value, rate and acceleration of coordinate i: x, y, z, yaw, pitch, roll.
static double coordinate(const prescribed_motion *self, int i, double t, double *rate,
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

void prescribed_motion_at(const prescribed_motion *self, double t, double x[6], double u[6],
                          double a[6])
{
    for (int i = 0; i < 6; i++)
        x[i] = coordinate(self, i, t, &u[i], &a[i]);
    motion_table_add(&self->table, t, x, u, a);
    sea_motion_add(&self->sea, t, x, u, a);
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

ld_status prescribed_motion_build(prescribed_motion *self, const ld_model *model, ld_error *error)
{
    double first, last;
    *self = (prescribed_motion){.model = &model->base};
    course(model, &first, &last);
    ld_status status = sea_motion_build(&self->sea, model, first, last, error);
    return status ? status : motion_table_build(&self->table, &model->base, error);
}

void prescribed_motion_free(prescribed_motion *self)
{
    motion_table_free(&self->table);
    sea_motion_free(&self->sea);
}

void prescribed_motion_span(const prescribed_motion *self, double *first, double *last)
{
    const motion_rows *rows = &self->table.rows;
    *first = rows->count ? rows->t[0] : -INFINITY;
    *last = rows->count ? rows->t[rows->count - 1] : INFINITY;
}

bool prescribed_motion_moves(const prescribed_motion *self)
{
    const ld_base *model = self->model;
    int sines = 0;
    for (int i = 0; i < 6; i++)
        sines += sines_of(model, i)->count;
    return sines || model->sea.present || self->table.rows.count || model->velocity[0] != 0 ||
           model->velocity[1] != 0 || model->velocity[2] != 0;
}
