// Adaptors: contact of the rocket's rings with the bore (model.md, section 5).
//
// Foot s_i: e_x . A(s_i)' (C_i - P(s_i)) = 0; offset (y, z) there, e = hypot(y, z), penetration
// p = e - clearance. Where p > 0 the law's normal force acts towards the axis at the wall point
// W = P + A (0, y, z) R/e, with friction against the sliding there; on the tube the opposite at W.
#ifndef LD_ELEMENTS_ADAPTOR_H
#define LD_ELEMENTS_ADAPTOR_H

#include "elements/guide/contact.h"
#include "elements/rocket.h"
#include "model/blocks/rocket.h"
#include "model/guide.h"

enum { IDEAL_MOST_ADAPTORS = 2 }; // that can be held on the axis: three hold more than there is

typedef struct adaptor_set {
    int count;
    double at[LD_MAX_ADAPTORS];        // [m] from the rear adaptor
    double clearance[LD_MAX_ADAPTORS]; // [m] radial
    double end[LD_MAX_ADAPTORS];       // [m] station of the guide at which it leaves
    int leaves_with[LD_MAX_ADAPTORS];  // adaptor at whose end it leaves: itself, or one before
    contact_law law;
} adaptor_set;

// One adaptor's foot and offset from the axis, in the section's frame.
typedef struct adaptor_state {
    int number;
    element_motion own_motion;
    axis_section
        own_section; // foot of the adaptors but the rear one, whose foot is the rocket's section
    section_rates own_rates;
    const axis_section *foot;
    const section_rates *rates;
    v3 arm;    // from O1, in R
    v3 C;      // centre, in R
    v3 offset; // C - P(foot), in R
    v3 v_C;    // inertial velocity of the centre, in R
    double y, z, y_dot, z_dot;
} adaptor_state;

// Foot and offset of adaptor i.
LD_INLINE void adaptor_load(const adaptor_set *self, const tube_system *guide,
                            const tube_state *tube, const rocket_state *rocket, int i,
                            adaptor_state *adaptor)
{
    adaptor->number = i;
    adaptor->arm = v3_scale(self->at[i], m3_column(rocket->A_RB, 0));
    adaptor->C = v3_add(rocket->p1, adaptor->arm);
    if (i == 0) {
        adaptor->foot = &rocket->at;
        adaptor->offset = rocket->Ad;
        adaptor->y = rocket->y;
        adaptor->z = rocket->z;
        return;
    }
    axis_section *foot = &adaptor->own_section;
    section_foot(guide, &tube->modal, adaptor->C, adaptor->C.x, &adaptor->own_motion, foot);
    adaptor->foot = foot;
    adaptor->offset = v3_sub(adaptor->C, foot->P);
    adaptor->y = v3_dot(m3_column(foot->A, 1), adaptor->offset);
    adaptor->z = v3_dot(m3_column(foot->A, 2), adaptor->offset);
}

// Velocity of the centre and rates of the offset, the foot's motion included.
LD_INLINE void adaptor_rates(const tube_state *tube, const rocket_state *rocket,
                             adaptor_state *adaptor)
{
    adaptor->v_C = v3_add(rocket->v_O1, v3_cross(rocket->w_B, adaptor->arm));
    if (adaptor->number == 0) {
        adaptor->rates = &rocket->rates;
        adaptor->y_dot = rocket->y_dot;
        adaptor->z_dot = rocket->z_dot;
        return;
    }
    const axis_section *foot = adaptor->foot;
    section_rates *rates = &adaptor->own_rates;
    section_rates_load(&adaptor->own_motion, foot, rates);
    adaptor->rates = rates;
    v3 axis = m3_column(foot->A, 0);
    v3 column = v3_add(foot->t, v3_cross(m3_apply(foot->Jl, foot->k0), adaptor->offset));
    v3 slip = v3_sub(adaptor->v_C, v3_add(tube->v, v3_cross(tube->w, adaptor->C)));
    slip = v3_sub(slip, v3_add(rates->u_dot, v3_cross(rates->w, adaptor->offset)));
    slip = v3_axpy(slip, -v3_dot(axis, slip) / v3_dot(axis, column), column);
    adaptor->y_dot = v3_dot(m3_column(foot->A, 1), slip);
    adaptor->z_dot = v3_dot(m3_column(foot->A, 2), slip);
}

// Velocity of the section's material at the point `from_axis` beyond its axis point, in R.
LD_INLINE v3 adaptor_wall_velocity(const tube_state *tube, const adaptor_state *adaptor, v3 W,
                                   v3 from_axis)
{
    const section_rates *rates = adaptor->rates;
    return v3_add(v3_add(tube->v, v3_cross(tube->w, W)),
                  v3_add(rates->u_dot, v3_cross(rates->w, from_axis)));
}

// Spring and damper that hold the adaptor on the axis, at its centre.
LD_INLINE v3 bilateral_force(const contact_law *law, const tube_state *tube,
                             const adaptor_state *adaptor, launching_output *out)
{
    double fy = -law->k * adaptor->y - law->c * adaptor->y_dot;
    double fz = -law->k * adaptor->z - law->c * adaptor->z_dot;
    v3 force = v3_add(v3_scale(fy, m3_column(adaptor->foot->A, 1)),
                      v3_scale(fz, m3_column(adaptor->foot->A, 2)));
    adaptor_report *report = &out->adaptor[adaptor->number];
    report->normal = report->force = sqrt(fy * fy + fz * fz);
    v3 v_rel =
        v3_sub(adaptor->v_C, adaptor_wall_velocity(tube, adaptor, adaptor->C, adaptor->offset));
    out->power[POWER_CONTACT_NORMAL] += v3_dot(force, v_rel);
    return force;
}

// Normal force and friction at the wall point W.
LD_INLINE v3 wall_force(const contact_law *law, double wall_radius, const adaptor_state *adaptor,
                        double e, v3 *W, launching_instant *now)
{
    int i = adaptor->number;
    const tube_state *tube = &now->tube;
    const rocket_state *rocket = &now->rocket;
    launching_output *out = now->out;
    adaptor_report *report = &out->adaptor[i];
    double y = adaptor->y, z = adaptor->z;
    double e_dot = (y * adaptor->y_dot + z * adaptor->z_dot) / e;
    double normal = contact_normal(law, report->penetration, e_dot, now->phase->touch_speed[i]);
    v3 outward = v3_scale(1 / e, v3_add(v3_scale(y, m3_column(adaptor->foot->A, 1)),
                                        v3_scale(z, m3_column(adaptor->foot->A, 2))));
    v3 to_wall = v3_scale(wall_radius, outward);
    *W = v3_add(adaptor->foot->P, to_wall);
    v3 rocket_v = v3_add(rocket->v_O1, v3_cross(rocket->w_B, v3_sub(*W, rocket->p1)));
    v3 v_rel = v3_sub(rocket_v, adaptor_wall_velocity(tube, adaptor, *W, to_wall));
    double v_n = v3_dot(v_rel, outward);
    v3 v_t = v3_axpy(v_rel, -v_n, outward);
    double mu = now->phase->frictionless ? 0 : law->mu;
    double rub = mu * normal / sqrt(v3_norm2(v_t) + law->v_eps * law->v_eps);
    v3 force = v3_sub(v3_scale(-normal, outward), v3_scale(rub, v_t));
    report->normal = normal;
    report->force = v3_norm(force);
    out->power[POWER_CONTACT_NORMAL] -= normal * v_n;
    out->power[POWER_CONTACT_FRICTION] -= rub * v3_norm2(v_t);
    return force;
}

// One adaptor's contact: force on the rocket about O1 and, opposite at the same point, on the tube.
LD_INLINE void adaptor_add(const int lanes, const adaptor_set *self, const tube_system *guide,
                           int i, launching_instant *now)
{
    const tube_state *tube = &now->tube;
    const rocket_state *rocket = &now->rocket;
    adaptor_state adaptor;
    adaptor_load(self, guide, tube, rocket, i, &adaptor);
    double e = sqrt(adaptor.y * adaptor.y + adaptor.z * adaptor.z);
    double penetration = e - self->clearance[i];
    now->out->adaptor[i] = (adaptor_report){
        .s = adaptor.foot->x, .y = adaptor.y, .z = adaptor.z, .penetration = penetration};
    if (penetration <= 0 && !self->law.two_sided)
        return;
    adaptor_rates(tube, rocket, &adaptor);
    v3 W = adaptor.C, force;
    if (self->law.two_sided)
        force = bilateral_force(&self->law, tube, &adaptor, now->out);
    else
        force = wall_force(&self->law, guide->flexible.bore_radius, &adaptor, e, &W, now);
    now->f = v3_add(now->f, force);
    now->m = v3_add(now->m, v3_cross(v3_sub(W, rocket->p1), force));
    apply_at_section(lanes, guide, adaptor.foot, W, v3_neg(force), &now->on_tube);
}

// All that have not left; of those that are held ideal.h reports.
LD_INLINE void adaptors_add(const int lanes, const adaptor_set *self, const tube_system *guide,
                            launching_instant *now)
{
    for (int i = 0; !self->law.held && i < self->count; i++)
        if (!now->phase->passed[i])
            adaptor_add(lanes, self, guide, i, now);
}

// Those that would leave a straight guide together do so on one that bends: with the first of them.
LD_INLINE int adaptor_leaves_with(const ld_tubes *tubes, const ld_rocket *rocket, int i,
                                  const int leaves_with[])
{
    double station = guide_exit_station(tubes, &rocket->adaptor[i]);
    for (int j = 0; j < i; j++) {
        double other = guide_exit_station(tubes, &rocket->adaptor[j]);
        if (fabs(station - other) < GUIDE_TOGETHER)
            return leaves_with[j];
    }
    return i;
}

LD_INLINE void adaptors_build(const ld_tubes *tubes, const ld_rocket *rocket, adaptor_set *self)
{
    self->count = rocket->adaptor_count;
    for (int i = 0; i < rocket->adaptor_count; i++) {
        self->at[i] = rocket->adaptor[i].at;
        self->clearance[i] = rocket->adaptor[i].clearance;
        self->end[i] = guide_end(tubes, &rocket->adaptor[i]);
        self->leaves_with[i] = adaptor_leaves_with(tubes, rocket, i, self->leaves_with);
    }
    self->law = contact_law_of(&rocket->contact);
}

#endif
