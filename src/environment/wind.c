#include "environment/wind.h"

#include "math/functions.h"

static v3 along(double speed, double heading)
{
    return v3_make(speed * cos(heading), 0, speed * sin(heading));
}

ld_status wind_build(wind *self, const ld_wind *model, ld_error *error)
{
    *self = (wind){.present = model->present,
                   .geographic = model->axes == LD_WIND_GEOGRAPHIC,
                   .scale = model->scale,
                   .steady = v3_from(model->add),
                   .gust_count = model->gust_count};
    if (!self->present)
        return LD_OK;
    for (int i = 0; i < model->gust_count; i++) {
        self->gust[i] = model->gust[i];
        if (isnan(self->gust[i].fall))
            self->gust[i].fall = self->gust[i].rise;
    }
    self->has_profile = model->profile.rows > 0;
    if (self->has_profile)
        return curves_build(&self->profile, model->profile.rows, 3, model->profile.data,
                            CURVE_PCHIP, error);
    self->steady = v3_axpy(self->steady, self->scale, along(model->speed, model->heading));
    return LD_OK;
}

void wind_free(wind *self)
{
    curves_free(&self->profile);
}

// 0 to 1 and back by half cosines.
static double gust_share(const ld_gust *gust, double t)
{
    const double pi = 3.14159265358979323846;
    double since = t - gust->start, left = gust->start + gust->rise + gust->hold + gust->fall - t;
    if (since <= 0 || left <= 0)
        return 0;
    if (since < gust->rise)
        return 0.5 * (1 - cos(pi * since / gust->rise));
    return left < gust->fall ? 0.5 * (1 - cos(pi * left / gust->fall)) : 1;
}

v3 wind_add_gusts(const wind *self, double t, v3 steady)
{
    v3 v = steady;
    for (int i = 0; i < self->gust_count; i++) {
        const ld_gust *gust = &self->gust[i];
        double share = gust_share(gust, t);
        if (share > 0)
            v = v3_add(v, along(share * gust->speed, gust->heading));
    }
    return v;
}

v3 wind_at(const wind *self, double t, double height)
{
    v3 v = self->steady;
    double level[2];
    if (self->has_profile) {
        curves_held(&self->profile, height, level);
        v = v3_axpy(v, self->scale, v3_make(level[0], 0, level[1]));
    }
    return wind_add_gusts(self, t, v);
}

double wind_next_corner(const wind *self, double t)
{
    double next = INFINITY;
    for (int i = 0; i < self->gust_count; i++) {
        const ld_gust *gust = &self->gust[i];
        const double length[4] = {0, gust->rise, gust->hold, gust->fall};
        double corner = gust->start;
        for (int k = 0; k < 4; k++) {
            corner += length[k];
            if (corner > t)
                next = fmin(next, corner);
        }
    }
    return next;
}
