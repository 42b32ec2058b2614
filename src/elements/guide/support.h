// Supports: spring-dampers between sections of the tube and the base (model.md, section 4).
//
// d = A_T^T (P - r_T) - (x_k, 0, 0), phi the rotation vector of A_TP, both in T; on the tube at P
//   f = -K_t d - C_t d_dot,   m = -J_l(phi)^-T K_r phi - C_r w_rel
// so that the springs derive from d' K_t d/2 + phi' K_r phi/2; on the base the opposite at P. A
// slide takes the place of K_t and C_t along x.
#ifndef LD_ELEMENTS_SUPPORT_H
#define LD_ELEMENTS_SUPPORT_H

#include "elements/tube.h"
#include "math/vectors/rotation_vector.h"

// A slide on which the tube recoils, with the stiffness [N/m] and damping [N s/m] of its stops.
typedef struct recoil_slide {
    ld_recoil given;
    double K, C;
} recoil_slide;

typedef struct tube_support {
    double x;           // [m] station
    v3 K, C, Kr, Cr;    // springs and dampers, base axes
    recoil_slide slide; // in place of those along x
    bool isotropic;     // Kr the same about all three axes
    int element;        // that holds the station
    unsigned clamped;   // directions held rigidly, bits of ld_clamp
    double tau[LD_NT];  // torsion shapes there
    double a[LD_NA];    // axial shapes there
} tube_support;

typedef struct support_set {
    int count;
    tube_support support[LD_MAX_SUPPORTS];
    bool clamps; // some direction is held rigidly (clamp.h)
} support_set;

// A slide's force on the tube along x, what it stores, and the powers of its stops' dampers and of
// its own damping and friction.
typedef struct slide_force {
    double force;         // [N]
    double stored;        // [J]
    double stops, losses; // [W]
} slide_force;

// How far a one-sided stop is pressed in, or less by its damper [m]: positive where it pushes, as
// it never pulls. The front one stands at d = 0, the one behind at d = -stroke.
LD_INLINE double stop_press(const recoil_slide *slide, int stop, double d, double v)
{
    double p = stop ? -d - slide->given.stroke : d, p_dot = stop ? -v : v;
    if (stop && isnan(slide->given.stroke))
        return -1;
    return fmin(p, p + slide->C / slide->K * p_dot);
}

// Adds one's force; whether it pushes is said by the phase, or else by how it lies.
LD_INLINE void stop_add(const recoil_slide *slide, int stop, double d, double v, int pushing,
                        slide_force *to)
{
    bool pushes = pushing ? pushing > 0 : stop_press(slide, stop, d, v) > 0;
    double p = stop ? -d - slide->given.stroke : d, side = stop ? 1 : -1;
    if (!pushes && !(p > 0))
        return;
    double elastic = slide->K * p, damped = pushes ? -side * slide->C * v : -elastic;
    to->force += side * (elastic + damped);
    to->stored += 0.5 * elastic * p;
    to->stops += side * damped * v;
}

// At displacement d (recoil: d < 0) and speed v: the return spring F_0 - k min(d, 0), damping and
// friction, the stops.
LD_INLINE slide_force slide_load(const recoil_slide *slide, double d, double v, bool frictionless,
                                 const int pushing[LD_SLIDE_STOPS])
{
    const ld_recoil *given = &slide->given;
    double back = fmin(d, 0), friction = frictionless ? 0 : given->friction;
    double drag = given->damping * v + given->quadratic_damping * fabs(v) * v +
                  friction * v / sqrt(v * v + given->friction_speed * given->friction_speed);
    slide_force sum = {
        .force = given->preload - given->stiffness * back - drag,
        .stored = 0.5 * given->stiffness * back * back - given->preload * d,
        .losses = -drag * v,
    };
    for (int stop = 0; stop < LD_SLIDE_STOPS; stop++)
        stop_add(slide, stop, d, v, pushing[stop], &sum);
    return sum;
}

// As stop_press, of slide `index` among them as it is reported.
LD_INLINE double supports_stop_press(const support_set *self, int index, int stop,
                                     const slide_report *report)
{
    int k = 0;
    for (int slides = self->support[0].slide.given.present; slides <= index;)
        slides += self->support[++k].slide.given.present;
    return stop_press(&self->support[k].slide, stop, -report->travel, -report->rate);
}

// What carries a support, against the tube.
typedef struct support_carrier {
    m3 A_TR;
    v3 r; // [m] of R's origin, in T
    v3 v, w;
    quat q_TR;
} support_carrier;

LD_INLINE void support_carrier_load(const base_frame *base, const tube_state *tube,
                                    support_carrier *to)
{
    to->A_TR = m3_mul(m3_transpose(base->A), tube->A_IR);
    to->r = m3_apply_transposed(base->A, v3_sub(tube->r, base->r));
    to->v = m3_apply_transposed(base->A, base->v);
    to->w = m3_apply_transposed(base->A, base->w);
    quat q_TI = {base->q.w, -base->q.x, -base->q.y, -base->q.z};
    quat q = q_multiply(q_TI, tube->q_IR);
    double norm = 1 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    to->q_TR = (quat){norm * q.w, norm * q.x, norm * q.y, norm * q.z};
}

// What foreshortening adds to the displacement along x and to its rate.
LD_OUTLINE void support_shorten(const tube_support *support, const tube_system *guide,
                                const modal_state *q, double *shift, double *rate)
{
    element_motion motion;
    element_load(guide, q, support->element, &motion);
    foreshortening at = shortened_to(&motion, support->x - motion.element->x0);
    *shift += at.shift;
    *rate += at.rate;
}

// Support springs and dampers (model.md, section 4).
LD_INLINE void supports_add(const int lanes, const support_set *self, const tube_system *guide,
                            launching_instant *now)
{
    const base_frame *base = &now->input->base, *station = now->input->station;
    const tube_state *tube = &now->tube;
    tube_force *h = &now->on_tube;
    launching_output *out = now->out;
    support_carrier carrier;
    support_carrier_load(base, tube, &carrier);
    double damping = 0, stored = 0, work = 0;
    int slides = 0;
    out->base_force = out->base_moment = v3_zero();
    for (int k = 0; k < self->count; k++) {
        const tube_support *support = &self->support[k];
        double twist = 0, twist_dot = 0;
        if (__builtin_expect(station != NULL, 0))
            support_carrier_load(&station[k], tube, &carrier);
        const m3 A_TR = carrier.A_TR;
        v3 base_v = carrier.v, base_w = carrier.w;
        for (int j = 0; j < guide->flexible.nt; j++) {
            twist += support->tau[j] * tube->modal.t[j];
            twist_dot += support->tau[j] * tube->modal.t_dot[j];
        }
        double stretch = 0, stretch_dot = 0;
        for (int j = 0; j < guide->flexible.na; j++) {
            stretch += support->a[j] * tube->modal.a[j];
            stretch_dot += support->a[j] * tube->modal.a_dot[j];
        }
        if (__builtin_expect(h->bent != NULL, 0))
            support_shorten(support, guide, h->bent, &stretch, &stretch_dot);
        v3 P = v3_make(support->x + stretch, tube->row_y[2 * k], tube->row_z[2 * k]);
        v3 th = v3_make(twist, -tube->row_z[2 * k + 1], tube->row_y[2 * k + 1]);
        v3 u_dot = v3_make(stretch_dot, tube->row_y_dot[2 * k], tube->row_z_dot[2 * k]);
        v3 th_dot = v3_make(twist_dot, -tube->row_z_dot[2 * k + 1], tube->row_y_dot[2 * k + 1]);
        m3 Jl = rv_left_jacobian(th);
        // displacement and its rate, in base axes
        v3 place = v3_add(carrier.r, m3_apply(A_TR, P));
        v3 d = v3_make(place.x - support->x, place.y, place.z);
        v3 v_P = m3_apply(A_TR, v3_add(v3_add(tube->v, v3_cross(tube->w, P)), u_dot));
        v3 v_base = v3_add(base_v, v3_cross(base_w, place));
        v3 d_dot = v3_sub(v_P, v_base);
        // rotation vector and relative rate, in base axes
        v3 phi = rv_of_quaternion(q_multiply(carrier.q_TR, rv_quaternion(th)));
        v3 w_rel = v3_sub(m3_apply(A_TR, v3_add(tube->w, m3_apply(Jl, th_dot))), base_w);
        v3 spring = v3_mul(support->K, d), moment = v3_mul(support->Kr, phi);
        v3 damper = v3_mul(support->C, d_dot), twister = v3_mul(support->Cr, w_rel);
        stored += v3_dot(spring, d) + v3_dot(moment, phi);
        damping -= v3_dot(damper, d_dot) + v3_dot(twister, w_rel);
        if (!support->isotropic)
            moment = rv_left_jacobian_inverse_transposed(phi, moment);
        v3 f_T = v3_neg(v3_add(spring, damper)), m_T = v3_neg(v3_add(moment, twister));
        if (__builtin_expect(support->slide.given.present, 0)) {
            slide_force slide = slide_load(&support->slide, d.x, d_dot.x, now->phase->frictionless,
                                           now->phase->pushing[slides]);
            f_T.x = slide.force;
            damping += slide.stops;
            stored += 2 * slide.stored;
            out->power[POWER_RECOIL] += slide.losses;
            out->slide[slides++] = (slide_report){-d.x, -d_dot.x, slide.force};
        }
        work += v3_dot(f_T, v_base) + v3_dot(m_T, base_w);
        v3 about = v3_add(m_T, v3_cross(place, f_T));
        if (__builtin_expect(station != NULL, 0)) {
            out->station[k] = (guide_wrench){v3_neg(f_T), v3_neg(about)};
        } else {
            out->base_force = v3_sub(out->base_force, f_T);
            out->base_moment = v3_sub(out->base_moment, about);
        }
        // on the tube, in R
        v3 f = m3_apply_transposed(A_TR, f_T), m = m3_apply_transposed(A_TR, m_T);
        v3 mu = m3_apply_transposed(Jl, m), m_R = v3_add(m, v3_cross(P, f));
        h->f = v3_add(h->f, f);
        h->m = v3_add(h->m, m_R);
        if (__builtin_expect(h->record != NULL, 0)) {
            guide_forces_add(h->record, support->x, f, m_R);
            h->record->support[k] = (guide_wrench){f_T, m_T};
        }
        const double(*y)[LD_NB] = &guide->rows[PLANE_Y][2 * k];
        const double(*z)[LD_NB] = &guide->rows[guide->z][2 * k];
        v4d *hy = v4d_lanes(h->y), *hz = v4d_lanes(h->z);
        for (int i = 0; i < lanes; i++) {
            hy[i] += v4d_all(f.y) * v4d_lanes_of(y[0])[i] + v4d_all(mu.z) * v4d_lanes_of(y[1])[i];
            hz[i] += v4d_all(f.z) * v4d_lanes_of(z[0])[i] - v4d_all(mu.y) * v4d_lanes_of(z[1])[i];
        }
        for (int j = 0; j < guide->flexible.nt; j++)
            h->t[j] += mu.x * support->tau[j];
        for (int j = 0; j < guide->flexible.na; j++)
            h->a[j] += f.x * support->a[j];
        if (__builtin_expect(h->bent != NULL, 0))
            bend_by_axial_force(guide, support->x, f.x, h);
    }
    out->elastic += 0.5 * stored;
    out->power[POWER_SUPPORT_DAMPING] = damping;
    out->power[POWER_BASE] = work;
}

// Springs and dampers along or about x, y, z, `first` being that of x: 0 where held rigidly.
LD_INLINE v3 springs_of(const ld_support *from, int first)
{
    return v3_make(support_spring(from, (ld_clamp)first),
                   support_spring(from, (ld_clamp)(first + 1)),
                   support_spring(from, (ld_clamp)(first + 2)));
}

LD_INLINE v3 dampers_of(const ld_support *from, int first, const double value[3])
{
    double left[3];
    for (int i = 0; i < 3; i++)
        left[i] = support_clamps(from, (ld_clamp)(first + i)) ? 0 : value[i];
    return v3_from(left);
}

// What support k of the model is at its station: springs, dampers, and the shapes there, of which b
// and b' become rows of the tube.
LD_INLINE void support_build(const ld_support *from, int k, tube_system *guide, tube_support *to)
{
    const flexible_tube *tube = &guide->flexible;
    const tube_element *element = &tube->element[tube->support_element[k]];
    double xi = from->at - element->x0;
    to->x = from->at;
    to->element = tube->support_element[k];
    to->clamped = from->clamped;
    to->K = springs_of(from, LD_CLAMP_X);
    to->C = dampers_of(from, LD_CLAMP_X, from->damping);
    to->Kr = springs_of(from, LD_CLAMP_ROLL);
    to->Cr = dampers_of(from, LD_CLAMP_ROLL, from->rotational_damping);
    to->isotropic = to->Kr.x == to->Kr.y && to->Kr.y == to->Kr.z;
    to->slide = (recoil_slide){from->recoil, to->K.x, to->C.x};
    if (from->recoil.present)
        to->K.x = to->C.x = 0;
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++)
        for (int j = 0; j < tube->nb; j++) {
            double b0 = element->b[plane][0][j], b1 = element->b[plane][1][j];
            double b2 = element->b[plane][2][j], b3 = element->b[plane][3][j];
            tube_set_row(guide, plane, 2 * k, j, b0 + xi * (b1 + xi * (b2 + xi * b3)));
            double strain = tube->shear ? tube->shear->strain[to->element][plane][j] : 0;
            tube_set_row(guide, plane, 2 * k + 1, j, b1 + xi * (2 * b2 + xi * 3 * b3) - strain);
        }
    for (int j = 0; j < tube->nt; j++)
        to->tau[j] = element->tau[0][j] + xi * element->tau[1][j];
    for (int j = 0; j < tube->na; j++)
        to->a[j] = element->a[0][j] + xi * element->a[1][j];
}

LD_INLINE void supports_build(const ld_tubes *model, tube_system *guide, support_set *self)
{
    self->count = model->support_count;
    self->clamps = false;
    for (int k = 0; k < model->support_count; k++) {
        support_build(&model->support[k], k, guide, &self->support[k]);
        self->clamps |= model->support[k].clamped != 0;
    }
}

#endif
