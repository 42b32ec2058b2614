#include "elements/guide/guide_wind.h"

#include <stdlib.h>

#include "elements/section.h"

enum { POINTS = 3 };
static const double node[POINTS] = {-0.77459666924148337704, 0, 0.77459666924148337704};
static const double weight[POINTS] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

ld_status guide_wind_build(const ld_tubes *tubes, guide_wind *self, ld_error *error)
{
    int most = tubes->wind_drag_count * (tubes->modes.bending + 1);
    *self = (guide_wind){0};
    if (most == 0)
        return LD_OK;
    self->panel = calloc((size_t)most, sizeof *self->panel);
    if (!self->panel)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the wind on the guide");
    for (int i = 0; i < tubes->wind_drag_count; i++) {
        const ld_wind_drag *given = &tubes->wind_drag[i];
        double length = given->to - given->from;
        int panels = (int)ceil(length / tubes->length * tubes->modes.bending);
        for (int k = 0; k < panels; k++)
            self->panel[self->count++] =
                (wind_panel){.from = given->from + length * k / panels,
                             .to = given->from + length * (k + 1) / panels,
                             .half_width = 0.5 * given->coefficient * given->width};
    }
    return LD_OK;
}

void guide_wind_free(guide_wind *self)
{
    free(self->panel);
    *self = (guide_wind){0};
}

// The force per length at a station, and the velocity of the axis; in R.
typedef struct blown {
    axis_section at;
    v3 force, v;
} blown;

static void blow_at(double x, double half_width, const tube_system *guide,
                    const launching_instant *now, blown *to)
{
    const tube_state *tube = &now->tube;
    const air_about *about = &now->input->about;
    axis_section *at = &to->at;
    v3 w;
    to->v = axis_point_load(guide, tube, x, at, &w);
    v3 place = v3_add(tube->r, m3_apply(tube->A_IR, at->P));
    moving_air air = about->at(about->self, about->t, place);
    v3 flow = v3_add(air.v, about->turbulence);
    if (about->going)
        flow = v3_sub(flow, v3_add(about->going->v,
                                   v3_cross(about->going->w, v3_sub(place, about->going->r))));
    v3 slip = v3_sub(m3_apply_transposed(tube->A_IR, flow), to->v);
    v3 axis = m3_column(at->A, 0), across = v3_axpy(slip, -v3_dot(slip, axis), axis);
    to->force = v3_scale(half_width * air.density * v3_norm(across), across);
}

// The part of a panel beyond a station in it, as it is and as its points were taken for it.
static void mend_record(const wind_panel *panel, const tube_system *guide,
                        const launching_instant *now, guide_forces *record, int station)
{
    double at = record->at[station];
    guide_wrench *beyond = &record->beyond[station];
    for (int part = 0; part < 2; part++) {
        double from = part ? at : panel->from, half = 0.5 * (panel->to - from);
        for (int k = 0; k < POINTS; k++) {
            double x = from + half * (1 + node[k]), share = part ? half * weight[k] : 0;
            if (!part && x >= at)
                share = -half * weight[k];
            blown point;
            blow_at(x, panel->half_width, guide, now, &point);
            beyond->f = v3_axpy(beyond->f, share, point.force);
            beyond->m = v3_axpy(beyond->m, share, v3_cross(point.at.P, point.force));
        }
    }
}

void guide_wind_add(const guide_wind *self, const tube_system *guide, launching_instant *now)
{
    const int lanes = guide->flexible.nbp / 4;
    launching_output *out = now->out;
    tube_force *h = &now->on_tube;
    out->guide_wind = v3_zero();
    if (!now->input->about.at)
        return;
    for (int i = 0; i < self->count; i++) {
        const wind_panel *panel = &self->panel[i];
        double half = 0.5 * (panel->to - panel->from);
        for (int k = 0; k < POINTS; k++) {
            blown point;
            blow_at(panel->from + half * (1 + node[k]), panel->half_width, guide, now, &point);
            v3 force = v3_scale(half * weight[k], point.force);
            apply_at_section(lanes, guide, &point.at, point.at.P, force, h);
            out->guide_wind = v3_add(out->guide_wind, force);
            out->power[POWER_GUIDE_WIND] += v3_dot(force, point.v);
        }
        for (int s = 0; h->record && s < h->record->count; s++)
            if (panel->from < h->record->at[s] && h->record->at[s] < panel->to)
                mend_record(panel, guide, now, h->record, s);
    }
}
