// Forces and constraints of the launching subsystem in the fast layout of formulation.md, section
// 5: pieces of one evaluation, inlined into it. Letters as there. Private to the launching
// subsystem.
#ifndef LD_SYSTEMS_LAUNCHING_FORCES_H
#define LD_SYSTEMS_LAUNCHING_FORCES_H

#include <string.h>

#include "systems/launching_kinematics.h"

// Generalised force on the tube: the rigid part about R's origin, the modal part in lanes.
typedef struct tube_force {
    v3 f, m;
    LANE_ARRAY(y, LD_NB);
    LANE_ARRAY(z, LD_NB);
    double t[LD_NT];
    double a[LD_NA];
} tube_force;

// Everything of the tube that does not depend on forces.
typedef struct tube_state {
    v3 r;
    m3 A_IR;
    quat q_IR;
    v3 v, w, g;
    modal_state modal;
    double qy_qy, qz_qz, qy_qz;
    LANE_ARRAY(row_y, LD_FIXED_ROWS); // fixed rows on q_y, q_z
    LANE_ARRAY(row_z, LD_FIXED_ROWS);
    LANE_ARRAY(row_y_dot, LD_FIXED_ROWS);
    LANE_ARRAY(row_z_dot, LD_FIXED_ROWS);
    double ct_y, ct_z, c_y, c_z; // ct . q_y ...
    double cp_t_dot;             // cp . q_t_dot
    // factors of the condensed 6 x 6 matrix: see factor()
    double per_m, per_my, per_jx, per_dy, per_dz, l_yx, l_yz, l_zx, l_zy, l_zwy;
} tube_state;

// A direction of constraint: unit wrench on the rocket about O1 and on the tube (formulation.md,
// section 3, G_e and B_e), and what the solve makes of them.
typedef struct direction {
    v3 G_f, G_m;     // on the rocket
    v3 r_a, r_alpha; // M3^-1 G
    v3 force, mu;    // at the section: force, and Jl^T moment, that act on the modes
    double rigid[6]; // L^-1 (B_r - C B_q): forward-substituted
    double beta;     // right-hand side besides accelerations
    double drift;    // e . v_rel
} direction;

// Shapes at the rocket's section, for products between directions.
typedef struct section_shapes {
    LANE_ARRAY(b, LD_NB);
    LANE_ARRAY(b1, LD_NB);
    double tau[LD_NT];
    double ct0, ct1, c0, c1; // ct . b, ct . b', c . b, c . b'
    double bb, bb1, b1b1, tt, cp_tau;
} section_shapes;

// ---- the tube ----

LD_INLINE void load_tube(const int lanes, const launching_system *self, const double *state,
                         tube_state *tube)
{
    const launching_layout *at = &self->layout;
    int nb = self->tube.nb;
    tube->r = v3_from(state + at->r);
    tube->q_IR = q_from(state + at->quaternion);
    tube->A_IR = q_matrix(tube->q_IR);
    tube->v = v3_from(state + at->v);
    tube->w = v3_from(state + at->w);
    tube->g = m3_apply_transposed(tube->A_IR, v3_make(0, -self->gravity, 0));
    modal_state *q = &tube->modal;
    const double *from = state + at->q, *rate = state + at->q_dot;
    memset(q->y, 0, (size_t)lanes * sizeof(v4d));
    memset(q->z, 0, (size_t)lanes * sizeof(v4d));
    memset(q->y_dot, 0, (size_t)lanes * sizeof(v4d));
    memset(q->z_dot, 0, (size_t)lanes * sizeof(v4d));
    memcpy(q->y, from, (size_t)nb * sizeof(double));
    memcpy(q->z, from + nb, (size_t)nb * sizeof(double));
    memcpy(q->y_dot, rate, (size_t)nb * sizeof(double));
    memcpy(q->z_dot, rate + nb, (size_t)nb * sizeof(double));
    q->t = from + 2 * nb;
    q->t_dot = rate + 2 * nb;
    q->a = q->t + self->tube.nt;
    q->a_dot = q->t_dot + self->tube.nt;
    // the fixed rows (supports, ct, c) times the four vectors of modal coordinates and speeds
    for (int r = 0; r < self->row_lanes; r++) {
        v4d y = v4d_all(0), z = y, y_dot = y, z_dot = y;
        for (int j = 0; j < nb; j++) {
            v4d row = v4d_lanes_of(self->rows_by_mode[j])[r];
            y += row * v4d_all(q->y[j]);
            z += row * v4d_all(q->z[j]);
            y_dot += row * v4d_all(q->y_dot[j]);
            z_dot += row * v4d_all(q->z_dot[j]);
        }
        v4d_lanes(tube->row_y)[r] = y;
        v4d_lanes(tube->row_z)[r] = z;
        v4d_lanes(tube->row_y_dot)[r] = y_dot;
        v4d_lanes(tube->row_z_dot)[r] = z_dot;
    }
    int ct = 2 * self->support_count, c = ct + 1;
    tube->ct_y = tube->row_y[ct];
    tube->ct_z = tube->row_z[ct];
    tube->c_y = tube->row_y[c];
    tube->c_z = tube->row_z[c];
    tube->qy_qy = v4d_dot(lanes, q->y, q->y);
    tube->qz_qz = v4d_dot(lanes, q->z, q->z);
    tube->qy_qz = v4d_dot(lanes, q->y, q->z);
}

// Gyroscopic forces, gravity, stiffness and damping of tube and tail: h of formulation.md section 1
// with the arrays of section 5 (no axial modes here).
LD_INLINE void tube_own_forces(const int lanes, const launching_system *self, tube_state *tube,
                               tube_force *h, launching_output *out)
{
    const flexible_tube *data = &self->tube;
    const modal_state *q = &tube->modal;
    v3 w = tube->w, g = tube->g;
    int ct = 2 * self->support_count, c = ct + 1;
    double ct_yd = tube->row_y_dot[ct], ct_zd = tube->row_z_dot[ct];
    double c_yd = tube->row_y_dot[c], c_zd = tube->row_z_dot[c];
    double cp_td = 0;
    for (int j = 0; j < data->nt; j++)
        cp_td += data->cp[j] * q->t_dot[j];
    tube->cp_t_dot = cp_td;
    // translation: S with the tail folded in
    v3 S = v3_make(self->Sx, tube->ct_y, tube->ct_z);
    v3 inner = v3_add(v3_cross(w, S), v3_make(0, 2 * ct_yd, 2 * ct_zd));
    h->f = v3_sub(v3_scale(self->m, g), v3_cross(w, inner));
    // rotation: J_line w, with the tail's inertia in place
    double p_xy = tube->c_y, p_xz = tube->c_z, p_yy = tube->qy_qy, p_zz = tube->qz_qz,
           p_yz = tube->qy_qz, p_xx = data->j0;
    v3 Jw = v3_make((p_yy + p_zz) * w.x - p_xy * w.y - p_xz * w.z,
                    (p_xx + p_zz) * w.y - p_xy * w.x - p_yz * w.z,
                    (p_xx + p_yy) * w.z - p_xz * w.x - p_yz * w.y);
    v3 tail =
        v3_make(self->tail_inertia.x * w.x, self->tail_inertia.y * w.y, self->tail_inertia.z * w.z);
    Jw = v3_add(Jw, tail);
    // W_ab = int p_a u_b dm: 2 (tr(W) w - W^T w)
    double W_xy = c_yd, W_xz = c_zd;
    double W_yy = v4d_dot(lanes, q->y, q->y_dot), W_yz = v4d_dot(lanes, q->y, q->z_dot);
    double W_zy = v4d_dot(lanes, q->z, q->y_dot), W_zz = v4d_dot(lanes, q->z, q->z_dot);
    double trace = W_yy + W_zz;
    v3 coriolis =
        v3_make(2 * trace * w.x, 2 * (trace * w.y - (W_xy * w.x + W_yy * w.y + W_zy * w.z)),
                2 * (trace * w.z - (W_xz * w.x + W_yz * w.y + W_zz * w.z)));
    double spin = data->j * w.x + cp_td;
    h->m = v3_sub(v3_cross(S, g), v3_add(v3_cross(w, Jw), coriolis));
    h->m = v3_sub(h->m, v3_cross(w, v3_make(spin, 0, 0)));
    // modes: part y: (w^2 - w_y^2) q_y - w_x w_y c - w_y w_z q_z + 2 w_x q_z_dot, part z alike
    double yy = w.x * w.x + w.z * w.z, zz = w.x * w.x + w.y * w.y, yz = -w.y * w.z;
    double cy = -w.x * w.y, cz = -w.x * w.z, two_wx = 2 * w.x;
    double dissipated = 0, stored = 0;
    const v4d *row_ct = v4d_lanes_of(self->rows[ct]), *row_c = v4d_lanes_of(self->rows[c]);
    const v4d *om2 = v4d_lanes_of(self->om2), *dmp = v4d_lanes_of(self->dmp);
    const v4d *qy = v4d_lanes_of(q->y), *qz = v4d_lanes_of(q->z);
    const v4d *qy_dot = v4d_lanes_of(q->y_dot), *qz_dot = v4d_lanes_of(q->z_dot);
    v4d *hy = v4d_lanes(h->y), *hz = v4d_lanes(h->z);
    v4d damped = v4d_all(0), elastic = v4d_all(0);
    for (int k = 0; k < lanes; k++) {
        v4d ky = om2[k] * qy[k], kz = om2[k] * qz[k];
        v4d dy = dmp[k] * qy_dot[k], dz = dmp[k] * qz_dot[k];
        hy[k] = v4d_all(yy) * qy[k] + v4d_all(yz) * qz[k] + v4d_all(cy) * row_c[k] +
                v4d_all(two_wx) * qz_dot[k] + v4d_all(g.y) * row_ct[k] - ky - dy;
        hz[k] = v4d_all(zz) * qz[k] + v4d_all(yz) * qy[k] + v4d_all(cz) * row_c[k] -
                v4d_all(two_wx) * qy_dot[k] + v4d_all(g.z) * row_ct[k] - kz - dz;
        damped += dy * qy_dot[k] + dz * qz_dot[k];
        elastic += ky * qy[k] + kz * qz[k];
    }
    for (int j = 0; j < data->nt; j++) {
        double kt = data->om2_t[j] * q->t[j], dt = data->dmp_t[j] * q->t_dot[j];
        h->t[j] = -kt - dt;
        dissipated += dt * q->t_dot[j];
        stored += kt * q->t[j];
    }
    out->power[POWER_MODAL_DAMPING] = -(v4d_sum(damped) + dissipated);
    out->elastic = 0.5 * (v4d_sum(elastic) + stored);
}

// Rotation vector of a quaternion of small or large angle.
LD_INLINE v3 rotation_vector_of(quat q)
{
    double sign = q.w < 0 ? -1 : 1;
    double n2 = q.x * q.x + q.y * q.y + q.z * q.z;
    double factor;
    if (n2 < 1e-4) { // 2 asin(n)/n; next term below 2e-22
        factor =
            2 * (1 + n2 * (1.0 / 6 + n2 * (3.0 / 40 + n2 * (15.0 / 336 + n2 * (105.0 / 3456)))));
        factor *= sign;
    } else {
        double n = sqrt(n2);
        factor = sign * 2 * atan2(n, fabs(q.w)) / n;
    }
    return v3_make(factor * q.x, factor * q.y, factor * q.z);
}

// Quaternion of a rotation vector.
LD_INLINE quat quaternion_of(v3 th)
{
    double h2 = 0.25 * v3_norm2(th), c, s; // s = sin(h)/(2 h)
    if (h2 < 1e-4) {
        c = 1 + h2 * (-1.0 / 2 + h2 * (1.0 / 24 + h2 * (-1.0 / 720 + h2 * (1.0 / 40320))));
        s = 0.5 + h2 * (-1.0 / 12 + h2 * (1.0 / 240 + h2 * (-1.0 / 10080 + h2 * (1.0 / 725760))));
    } else {
        double h = sqrt(h2);
        c = cos(h);
        s = 0.5 * sin(h) / h;
    }
    return (quat){c, s * th.x, s * th.y, s * th.z};
}

// Support springs and dampers (model.md, section 4).
LD_INLINE void support_forces(const int lanes, const launching_system *self, const base_frame *base,
                              const tube_state *tube, tube_force *h, launching_output *out)
{
    m3 A_TR = m3_mul(m3_transpose(base->A), tube->A_IR);
    v3 r = m3_apply_transposed(base->A, v3_sub(tube->r, base->r));
    v3 base_v = m3_apply_transposed(base->A, base->v),
       base_w = m3_apply_transposed(base->A, base->w);
    quat q_TI = {base->q.w, -base->q.x, -base->q.y, -base->q.z};
    quat q_TR = q_multiply(q_TI, tube->q_IR);
    double norm = 1 / sqrt(q_TR.w * q_TR.w + q_TR.x * q_TR.x + q_TR.y * q_TR.y + q_TR.z * q_TR.z);
    q_TR = (quat){norm * q_TR.w, norm * q_TR.x, norm * q_TR.y, norm * q_TR.z};
    double damping = 0, stored = 0, work = 0;
    out->base_force = out->base_moment = v3_zero();
    for (int k = 0; k < self->support_count; k++) {
        const launching_support *support = &self->support[k];
        double twist = 0, twist_dot = 0;
        for (int j = 0; j < self->tube.nt; j++) {
            twist += support->tau[j] * tube->modal.t[j];
            twist_dot += support->tau[j] * tube->modal.t_dot[j];
        }
        double stretch = 0, stretch_dot = 0;
        for (int j = 0; j < self->tube.na; j++) {
            stretch += support->a[j] * tube->modal.a[j];
            stretch_dot += support->a[j] * tube->modal.a_dot[j];
        }
        v3 P = v3_make(support->x + stretch, tube->row_y[2 * k], tube->row_z[2 * k]);
        v3 th = v3_make(twist, -tube->row_z[2 * k + 1], tube->row_y[2 * k + 1]);
        v3 u_dot = v3_make(stretch_dot, tube->row_y_dot[2 * k], tube->row_z_dot[2 * k]);
        v3 th_dot = v3_make(twist_dot, -tube->row_z_dot[2 * k + 1], tube->row_y_dot[2 * k + 1]);
        m3 Jl = rv_left_jacobian(th);
        // displacement and its rate, in base axes
        v3 place = v3_add(r, m3_apply(A_TR, P));
        v3 d = v3_make(place.x - support->x, place.y, place.z);
        v3 v_P = m3_apply(A_TR, v3_add(v3_add(tube->v, v3_cross(tube->w, P)), u_dot));
        v3 v_base = v3_add(base_v, v3_cross(base_w, place));
        v3 d_dot = v3_sub(v_P, v_base);
        // rotation vector and relative rate, in base axes
        v3 phi = rotation_vector_of(q_multiply(q_TR, quaternion_of(th)));
        v3 w_rel = v3_sub(m3_apply(A_TR, v3_add(tube->w, m3_apply(Jl, th_dot))), base_w);
        v3 spring = v3_mul(support->K, d), moment = v3_mul(support->Kr, phi);
        v3 damper = v3_mul(support->C, d_dot), twister = v3_mul(support->Cr, w_rel);
        stored += v3_dot(spring, d) + v3_dot(moment, phi);
        damping -= v3_dot(damper, d_dot) + v3_dot(twister, w_rel);
        if (!support->isotropic)
            moment = rv_left_jacobian_inverse_transposed(phi, moment);
        v3 f_T = v3_neg(v3_add(spring, damper)), m_T = v3_neg(v3_add(moment, twister));
        work += v3_dot(f_T, v_base) + v3_dot(m_T, base_w);
        out->base_force = v3_sub(out->base_force, f_T);
        out->base_moment = v3_sub(out->base_moment, v3_add(m_T, v3_cross(place, f_T)));
        // on the tube, in R
        v3 f = m3_apply_transposed(A_TR, f_T), m = m3_apply_transposed(A_TR, m_T);
        v3 mu = m3_apply_transposed(Jl, m);
        h->f = v3_add(h->f, f);
        h->m = v3_add(h->m, v3_add(m, v3_cross(P, f)));
        const v4d *b = v4d_lanes_of(self->rows[2 * k]), *b1 = v4d_lanes_of(self->rows[2 * k + 1]);
        v4d *hy = v4d_lanes(h->y), *hz = v4d_lanes(h->z);
        for (int i = 0; i < lanes; i++) {
            hy[i] += v4d_all(f.y) * b[i] + v4d_all(mu.z) * b1[i];
            hz[i] += v4d_all(f.z) * b[i] - v4d_all(mu.y) * b1[i];
        }
        for (int j = 0; j < self->tube.nt; j++)
            h->t[j] += mu.x * support->tau[j];
        for (int j = 0; j < self->tube.na; j++)
            h->a[j] += f.x * support->a[j];
    }
    out->elastic += 0.5 * stored;
    out->power[POWER_SUPPORT_DAMPING] = damping;
    out->power[POWER_BASE] = work;
}

// Adds force f at point W (in R) of the tube's section s.
LD_INLINE void apply_at_section(const int lanes, const launching_system *self, const section *s,
                                v3 W, v3 f, tube_force *h)
{
    const packed_element *element = &self->packed[s->index];
    v3 mu = m3_apply_transposed(s->Jl, v3_cross(v3_sub(W, s->root), f));
    h->f = v3_add(h->f, f);
    h->m = v3_add(h->m, v3_cross(W, f));
    double xi = s->xi, x2 = xi * xi, x3 = x2 * xi;
    // weights of the powers of xi: b and b' against force and moment
    double y[4] = {f.y, f.y * xi + mu.z, f.y * x2 + mu.z * 2 * xi, f.y * x3 + mu.z * 3 * x2};
    double z[4] = {f.z, f.z * xi - mu.y, f.z * x2 - mu.y * 2 * xi, f.z * x3 - mu.y * 3 * x2};
    const v4d *p0 = v4d_lanes_of(element->by_power[0]), *p1 = v4d_lanes_of(element->by_power[1]);
    const v4d *p2 = v4d_lanes_of(element->by_power[2]), *p3 = v4d_lanes_of(element->by_power[3]);
    v4d *hy = v4d_lanes(h->y), *hz = v4d_lanes(h->z);
    for (int i = 0; i < lanes; i++) {
        hy[i] += v4d_all(y[0]) * p0[i] + v4d_all(y[1]) * p1[i] + v4d_all(y[2]) * p2[i] +
                 v4d_all(y[3]) * p3[i];
        hz[i] += v4d_all(z[0]) * p0[i] + v4d_all(z[1]) * p1[i] + v4d_all(z[2]) * p2[i] +
                 v4d_all(z[3]) * p3[i];
    }
    for (int j = 0; j < self->tube.nt; j++)
        h->t[j] += mu.x * (element->tau[j][0] + xi * element->tau[j][1]);
    for (int j = 0; j < self->tube.na; j++)
        h->a[j] += f.x * (element->a[j][0] + xi * element->a[j][1]);
}

// The condensed 6 x 6 matrix (vx vy vz wx | wy wz): its first four rows are diagonal and the last
// two couple to them, so the factors are the six numbers l and the 2 x 2 rest.
LD_INLINE void factor(const launching_system *self, tube_state *tube)
{
    const flexible_tube *data = &self->tube;
    double my = self->m - data->ctct, off = data->ctc - self->Sx;
    tube->per_m = 1 / self->m;
    tube->per_my = 1 / my;
    tube->per_jx = 1 / self->jx;
    tube->l_yx = tube->ct_z * tube->per_m;  // (wy, vx)/m
    tube->l_yz = off * tube->per_my;        // (wy, vz)/my
    tube->l_zx = -tube->ct_y * tube->per_m; // (wz, vx)/m
    tube->l_zy = -off * tube->per_my;       // (wz, vy)/my
    double j = data->j0 - data->cc;
    double syy =
        j + self->tail_inertia.y + tube->qz_qz - tube->l_yx * tube->ct_z - tube->l_yz * off;
    double szz =
        j + self->tail_inertia.z + tube->qy_qy + tube->l_zx * tube->ct_y + tube->l_zy * off;
    double szy = -tube->qy_qz - tube->l_zx * tube->ct_z;
    tube->per_dy = 1 / syy;
    tube->l_zwy = szy * tube->per_dy;
    tube->per_dz = 1 / (szz - tube->l_zwy * szy);
}

// L^-1 of (force, moment); kept undivided by the diagonal.
LD_INLINE void forward(const tube_state *tube, v3 f, v3 m, double out[6])
{
    out[0] = f.x;
    out[1] = f.y;
    out[2] = f.z;
    out[3] = m.x;
    out[4] = m.y - tube->l_yx * f.x - tube->l_yz * f.z;
    out[5] = m.z - tube->l_zx * f.x - tube->l_zy * f.y - tube->l_zwy * out[4];
}

// x^T D^-1 y of two forward-substituted vectors.
LD_INLINE double product(const tube_state *tube, const double x[6], const double y[6])
{
    return x[0] * y[0] * tube->per_m + (x[1] * y[1] + x[2] * y[2]) * tube->per_my +
           x[3] * y[3] * tube->per_jx + x[4] * y[4] * tube->per_dy + x[5] * y[5] * tube->per_dz;
}

// L^-T D^-1 of a forward-substituted vector: translational and rotational acceleration.
LD_INLINE void backward(const tube_state *tube, const double x[6], v3 *a, v3 *w_dot)
{
    double wz = x[5] * tube->per_dz;
    double wy = x[4] * tube->per_dy - tube->l_zwy * wz;
    *a = v3_make(x[0] * tube->per_m - tube->l_yx * wy - tube->l_zx * wz,
                 x[1] * tube->per_my - tube->l_zy * wz, x[2] * tube->per_my - tube->l_yz * wy);
    *w_dot = v3_make(x[3] * tube->per_jx, wy, wz);
}

// C h_q: what the modal forces put on the rigid equations.
LD_INLINE void condense(const int lanes, const launching_system *self, const tube_state *tube,
                        const tube_force *h, v3 *f, v3 *m)
{
    int ct = 2 * self->support_count, c = ct + 1;
    const modal_state *q = &tube->modal;
    double twist = 0;
    for (int j = 0; j < self->tube.nt; j++)
        twist += self->tube.cp[j] * h->t[j];
    *f = v3_make(0, v4d_dot(lanes, self->rows[ct], h->y), v4d_dot(lanes, self->rows[ct], h->z));
    *m = v3_make(v4d_dot(lanes, q->y, h->z) - v4d_dot(lanes, q->z, h->y) + twist,
                 -v4d_dot(lanes, self->rows[c], h->z), v4d_dot(lanes, self->rows[c], h->y));
}

// ---- the rocket ----

// sin and cos, by their series while the angle is small.
LD_INLINE void sine_cosine(double x, double *s, double *c)
{
    double x2 = x * x;
    if (x2 < 1e-3) {
        *s =
            x * (1 + x2 * (-1.0 / 6 + x2 * (1.0 / 120 + x2 * (-1.0 / 5040 + x2 * (1.0 / 362880)))));
        *c = 1 + x2 * (-1.0 / 2 + x2 * (1.0 / 24 + x2 * (-1.0 / 720 + x2 * (1.0 / 40320))));
    } else {
        *s = sin(x);
        *c = cos(x);
    }
}

typedef struct rocket_state {
    double s, y, z;
    m3 A_SB, A_RB;
    double sin_psi, cos_psi, sin_theta, cos_theta;
    v3 d, p1;     // in S; in R
    v3 v_O1, w_B; // inertial, in R
    element_motion motion;
    section at; // section at s
    section_rates rates;
    v3 Ad;       // A d
    v3 v_P, w_P; // section's material velocity and rate, inertial, in R
    v3 Om;       // rate of S against R
    double s_dot, y_dot, z_dot;
    v3 w_SB; // in S
} rocket_state;

LD_INLINE void load_rocket(const launching_system *self, const double *state,
                           const tube_state *tube, rocket_state *rocket, launching_output *out)
{
    const double *x = state + self->layout.x, *V = state + self->layout.V;
    rocket->s = x[0];
    rocket->y = x[1];
    rocket->z = x[2];
    double sp, cp, st, ct, sg, cg;
    sine_cosine(x[3], &sp, &cp);
    sine_cosine(x[4], &st, &ct);
    sine_cosine(x[5], &sg, &cg);
    rocket->A_SB = (m3){{{cp * ct, cp * st * sg - sp * cg, cp * st * cg + sp * sg},
                         {sp * ct, sp * st * sg + cp * cg, sp * st * cg - cp * sg},
                         {-st, ct * sg, ct * cg}}};
    rocket->v_O1 = v3_from(V);
    rocket->w_B = v3_from(V + 3);
    section *at = &rocket->at;
    at->index = flexible_tube_find(&self->tube, rocket->s);
    element_load(self, &tube->modal, at->index, &rocket->motion);
    section_load(self, &rocket->motion, rocket->s, at);
    section_rates_load(&rocket->motion, at, &rocket->rates);
    const section_rates *rates = &rocket->rates;
    rocket->d = v3_make(0, rocket->y, rocket->z);
    rocket->Ad = m3_apply(at->A, rocket->d);
    rocket->p1 = v3_add(at->P, rocket->Ad);
    rocket->A_RB = m3_mul(at->A, rocket->A_SB);
    rocket->v_P = v3_add(v3_add(tube->v, v3_cross(tube->w, at->P)), rates->u_dot);
    rocket->w_P = v3_add(tube->w, rates->w);
    // y = Y^-1 (V - X eta)
    v3 twist = m3_apply(at->Jl, at->k0);
    v3 column = v3_add(at->t, v3_cross(twist, rocket->Ad));
    v3 slip = v3_sub(rocket->v_O1, v3_add(rocket->v_P, v3_cross(rocket->w_P, rocket->Ad)));
    rocket->s_dot = v3_dot(m3_column(at->A, 0), slip) / v3_dot(m3_column(at->A, 0), column);
    slip = v3_axpy(slip, -rocket->s_dot, column);
    rocket->y_dot = v3_dot(m3_column(at->A, 1), slip);
    rocket->z_dot = v3_dot(m3_column(at->A, 2), slip);
    rocket->Om = v3_axpy(rates->w, rocket->s_dot, twist);
    v3 w = m3_apply_transposed(at->A, v3_sub(rocket->w_B, v3_add(tube->w, rocket->Om)));
    rocket->w_SB = w;
    double gamma_dot = (cp * w.x + sp * w.y) / ct;
    out->x_dot[0] = out->y[0] = rocket->s_dot;
    out->x_dot[1] = out->y[1] = rocket->y_dot;
    out->x_dot[2] = out->y[2] = rocket->z_dot;
    out->x_dot[3] = w.z + st * gamma_dot;
    out->x_dot[4] = cp * w.y - sp * w.x;
    out->x_dot[5] = gamma_dot;
    v3_store(out->y + 3, w);
}

// One adaptor's foot and offset from the axis, in the section's frame.
typedef struct adaptor_state {
    element_motion own_motion;
    section
        own_section; // foot of the adaptors but the rear one, whose foot is the rocket's section
    section_rates own_rates;
    const section *foot;
    const section_rates *rates;
    v3 arm;    // from O1, in R
    v3 C;      // centre, in R
    v3 offset; // C - P(foot), in R
    double y, z, y_dot, z_dot;
} adaptor_state;

LD_INLINE void adaptor_load(const launching_system *self, const tube_state *tube,
                            const rocket_state *rocket, int i, adaptor_state *adaptor)
{
    adaptor->arm = v3_scale(self->adaptor_at[i], m3_column(rocket->A_RB, 0));
    adaptor->C = v3_add(rocket->p1, adaptor->arm);
    if (i == 0) {
        adaptor->foot = &rocket->at;
        adaptor->offset = rocket->Ad;
        adaptor->y = rocket->y;
        adaptor->z = rocket->z;
        return;
    }
    section *foot = &adaptor->own_section;
    section_foot(self, &tube->modal, adaptor->C, adaptor->C.x, &adaptor->own_motion, foot);
    adaptor->foot = foot;
    adaptor->offset = v3_sub(adaptor->C, foot->P);
    adaptor->y = v3_dot(m3_column(foot->A, 1), adaptor->offset);
    adaptor->z = v3_dot(m3_column(foot->A, 2), adaptor->offset);
}

// Rates of the offset, the foot's motion included; v_C: inertial velocity of the centre, in R.
LD_INLINE void adaptor_rates(const tube_state *tube, const rocket_state *rocket, int i, v3 v_C,
                             adaptor_state *adaptor)
{
    if (i == 0) {
        adaptor->rates = &rocket->rates;
        adaptor->y_dot = rocket->y_dot;
        adaptor->z_dot = rocket->z_dot;
        return;
    }
    const section *foot = adaptor->foot;
    section_rates *rates = &adaptor->own_rates;
    section_rates_load(&adaptor->own_motion, foot, rates);
    adaptor->rates = rates;
    v3 axis = m3_column(foot->A, 0);
    v3 column = v3_add(foot->t, v3_cross(m3_apply(foot->Jl, foot->k0), adaptor->offset));
    v3 slip = v3_sub(v_C, v3_add(tube->v, v3_cross(tube->w, adaptor->C)));
    slip = v3_sub(slip, v3_add(rates->u_dot, v3_cross(rates->w, adaptor->offset)));
    slip = v3_axpy(slip, -v3_dot(axis, slip) / v3_dot(axis, column), column);
    adaptor->y_dot = v3_dot(m3_column(foot->A, 1), slip);
    adaptor->z_dot = v3_dot(m3_column(foot->A, 2), slip);
}

// Velocity of the section's material at the point `from_axis` beyond its axis point, in R.
LD_INLINE v3 section_velocity(const tube_state *tube, const adaptor_state *adaptor, v3 W,
                              v3 from_axis)
{
    const section_rates *rates = adaptor->rates;
    return v3_add(v3_add(tube->v, v3_cross(tube->w, W)),
                  v3_add(rates->u_dot, v3_cross(rates->w, from_axis)));
}

// Spring and damper that hold the adaptor on the axis, at its centre.
LD_INLINE v3 bilateral_force(const launching_system *self, const tube_state *tube,
                             const adaptor_state *adaptor, v3 v_C, adaptor_report *report,
                             launching_output *out)
{
    const contact_law *law = &self->contact;
    double fy = -law->k * adaptor->y - law->c * adaptor->y_dot;
    double fz = -law->k * adaptor->z - law->c * adaptor->z_dot;
    v3 force = v3_add(v3_scale(fy, m3_column(adaptor->foot->A, 1)),
                      v3_scale(fz, m3_column(adaptor->foot->A, 2)));
    report->normal = report->force = sqrt(fy * fy + fz * fz);
    v3 v_rel = v3_sub(v_C, section_velocity(tube, adaptor, adaptor->C, adaptor->offset));
    out->power[POWER_CONTACT_NORMAL] += v3_dot(force, v_rel);
    return force;
}

// Normal force and friction at the wall point W.
LD_INLINE v3 wall_force(const launching_system *self, const launching_phase *phase,
                        const tube_state *tube, const rocket_state *rocket,
                        const adaptor_state *adaptor, int i, double e, v3 *W,
                        adaptor_report *report, launching_output *out)
{
    const contact_law *law = &self->contact;
    double y = adaptor->y, z = adaptor->z;
    double e_dot = (y * adaptor->y_dot + z * adaptor->z_dot) / e;
    double normal = contact_normal(law, report->penetration, e_dot, phase->touch_speed[i]);
    v3 outward = v3_scale(1 / e, v3_add(v3_scale(y, m3_column(adaptor->foot->A, 1)),
                                        v3_scale(z, m3_column(adaptor->foot->A, 2))));
    v3 to_wall = v3_scale(self->tube.bore_radius, outward);
    *W = v3_add(adaptor->foot->P, to_wall);
    v3 rocket_v = v3_add(rocket->v_O1, v3_cross(rocket->w_B, v3_sub(*W, rocket->p1)));
    v3 v_rel = v3_sub(rocket_v, section_velocity(tube, adaptor, *W, to_wall));
    double v_n = v3_dot(v_rel, outward);
    v3 v_t = v3_axpy(v_rel, -v_n, outward);
    double mu = phase->frictionless ? 0 : law->mu;
    double rub = mu * normal / sqrt(v3_norm2(v_t) + law->v_eps * law->v_eps);
    v3 force = v3_sub(v3_scale(-normal, outward), v3_scale(rub, v_t));
    report->normal = normal;
    report->force = v3_norm(force);
    out->power[POWER_CONTACT_NORMAL] -= normal * v_n;
    out->power[POWER_CONTACT_FRICTION] -= rub * v3_norm2(v_t);
    return force;
}

// One adaptor's contact: force on the rocket about O1 and, opposite at the same point, on the tube.
LD_INLINE void adaptor_contact(const int lanes, const launching_system *self,
                               const launching_phase *phase, const tube_state *tube,
                               const rocket_state *rocket, int i, tube_force *h, v3 *f_total,
                               v3 *m_total, launching_output *out)
{
    adaptor_report *report = &out->adaptor[i];
    adaptor_state adaptor;
    adaptor_load(self, tube, rocket, i, &adaptor);
    double e = sqrt(adaptor.y * adaptor.y + adaptor.z * adaptor.z);
    double penetration = e - self->clearance[i];
    *report = (adaptor_report){
        .s = adaptor.foot->x, .y = adaptor.y, .z = adaptor.z, .penetration = penetration};
    bool bilateral = self->contact.kind == LD_CONTACT_BILATERAL;
    if (penetration <= 0 && !bilateral)
        return;
    v3 v_C = v3_add(rocket->v_O1, v3_cross(rocket->w_B, adaptor.arm));
    adaptor_rates(tube, rocket, i, v_C, &adaptor);
    v3 W = adaptor.C, force;
    if (bilateral)
        force = bilateral_force(self, tube, &adaptor, v_C, report, out);
    else
        force = wall_force(self, phase, tube, rocket, &adaptor, i, e, &W, report, out);
    *f_total = v3_add(*f_total, force);
    *m_total = v3_add(*m_total, v3_cross(v3_sub(W, rocket->p1), force));
    apply_at_section(lanes, self, adaptor.foot, W, v3_neg(force), h);
}

// The breech: pushes O1 along e_x of S where s is behind its station, opposite on its section.
LD_INLINE void breech_contact(const int lanes, const launching_system *self,
                              const launching_phase *phase, const tube_state *tube,
                              const rocket_state *rocket, tube_force *h, v3 *f_total,
                              launching_output *out)
{
    double penetration = phase->breech - rocket->s;
    out->breech_force = 0;
    if (penetration <= 0 || phase->locked)
        return;
    element_motion motion;
    section wall;
    section_rates rates;
    wall.index = flexible_tube_find(&self->tube, phase->breech);
    element_load(self, &tube->modal, wall.index, &motion);
    section_load(self, &motion, phase->breech, &wall);
    section_rates_load(&motion, &wall, &rates);
    out->breech_force =
        contact_normal(&self->contact, penetration, -rocket->s_dot, phase->breech_speed);
    v3 force = v3_scale(out->breech_force, m3_column(rocket->at.A, 0));
    v3 turning = v3_cross(rates.w, v3_sub(rocket->p1, wall.P));
    v3 v_wall =
        v3_add(v3_add(tube->v, v3_cross(tube->w, rocket->p1)), v3_add(rates.u_dot, turning));
    out->power[POWER_CONTACT_NORMAL] += v3_dot(force, v3_sub(rocket->v_O1, v_wall));
    *f_total = v3_add(*f_total, force);
    apply_at_section(lanes, self, &wall, rocket->p1, v3_neg(force), h);
}

// Inverse of the rocket's 6 x 6 mass matrix, by its inertia about the mass centre.
typedef struct rocket_inertia {
    double m;
    v3 c;            // in R
    m3 J, J_inverse; // about the mass centre, in B
    m3 A_RB;
} rocket_inertia;

LD_INLINE m3 symmetric_inverse(m3 m)
{
    double a = m.a[0][0], b = m.a[1][1], c = m.a[2][2], d = m.a[0][1], e = m.a[0][2], f = m.a[1][2];
    double A = b * c - f * f, B = e * f - d * c, C = d * f - e * b;
    double s = 1 / (a * A + d * B + e * C);
    double D = a * c - e * e, E = d * e - a * f, F = a * b - d * d;
    return (m3){{{s * A, s * B, s * C}, {s * B, s * D, s * E}, {s * C, s * E, s * F}}};
}

LD_INLINE void rocket_inertia_load(const rocket_mass *mass, m3 A_RB, rocket_inertia *inertia)
{
    inertia->m = mass->m;
    inertia->c = m3_apply(A_RB, mass->c);
    inertia->J = mass->J;
    inertia->J_inverse = symmetric_inverse(mass->J);
    inertia->A_RB = A_RB;
}

// M3^-1 (f, m about O1).
LD_INLINE void rocket_solve(const rocket_inertia *inertia, v3 f, v3 m, v3 *a, v3 *alpha)
{
    v3 m_C = v3_sub(m, v3_cross(inertia->c, f));
    v3 local = m3_apply(inertia->J_inverse, m3_apply_transposed(inertia->A_RB, m_C));
    *alpha = m3_apply(inertia->A_RB, local);
    *a = v3_sub(v3_scale(1 / inertia->m, f), v3_cross(*alpha, inertia->c));
}

// Gravity, thrust and gyroscopic wrench about O1; their powers.
LD_INLINE void rocket_own_forces(const launching_system *self, const launching_input *input,
                                 const tube_state *tube, const rocket_state *rocket,
                                 const rocket_inertia *inertia, v3 *f, v3 *m, launching_output *out)
{
    const ld_motor *thruster = &self->model->rocket.motor;
    v3 w = rocket->w_B, c = inertia->c;
    v3 weight = v3_scale(inertia->m, tube->g);
    v3 v_C = v3_add(rocket->v_O1, v3_cross(w, c));
    // thrust along (1, eps_y, eps_z) at (x_T, e_y, e_z) of B
    double ey = thruster->misalignment[0], ez = thruster->misalignment[1];
    double along = input->thrust / sqrt(1 + ey * ey + ez * ez);
    v3 thrust = m3_apply(rocket->A_RB, v3_make(along, along * ey, along * ez));
    v3 at = m3_apply(rocket->A_RB, v3_from(thruster->at));
    *f = v3_add(weight, thrust);
    *m = v3_add(v3_cross(c, weight), v3_cross(at, thrust));
    out->power[POWER_GRAVITY_ROCKET] = v3_dot(weight, v_C);
    out->power[POWER_THRUST] = v3_dot(thrust, v3_add(rocket->v_O1, v3_cross(w, at)));
    // gyroscopic: -(m w x (w x c), c x the same + w x J w)
    v3 w_local = m3_apply_transposed(rocket->A_RB, w);
    v3 J_w = m3_apply(inertia->J, w_local);
    v3 gyro = v3_scale(inertia->m, v3_cross(w, v3_cross(w, c)));
    v3 turn = m3_apply(rocket->A_RB, v3_cross(w_local, J_w));
    *f = v3_sub(*f, gyro);
    *m = v3_sub(*m, v3_add(turn, v3_cross(c, gyro)));
    // burnt mass takes its kinetic energy along: 1/2 V^T (dM/dt) V
    const rocket_mass *mass = &input->mass;
    v3 c_dot = m3_apply(rocket->A_RB, mass->c_dot);
    out->power[POWER_MASS_CHANGE] = 0.5 * mass->m_dot * v3_norm2(v_C) +
                                    inertia->m * v3_dot(v_C, v3_cross(w, c_dot)) +
                                    0.5 * v3_dot(w_local, m3_apply(mass->J_dot, w_local));
}

// ---- slot and lock ----

LD_INLINE void load_shapes(const int lanes, const launching_system *self, const section *s,
                           section_shapes *shapes)
{
    LANES_NOT_EMPTY(lanes);
    const packed_element *element = &self->packed[s->index];
    v4d x = v4d_all(s->xi), x2 = v4d_all(2 * s->xi), x3 = v4d_all(3 * s->xi);
    const v4d *p0 = v4d_lanes_of(element->by_power[0]), *p1 = v4d_lanes_of(element->by_power[1]);
    const v4d *p2 = v4d_lanes_of(element->by_power[2]), *p3 = v4d_lanes_of(element->by_power[3]);
    v4d *b = v4d_lanes(shapes->b), *b1 = v4d_lanes(shapes->b1);
    for (int i = 0; i < lanes; i++) {
        b[i] = p0[i] + x * (p1[i] + x * (p2[i] + x * p3[i]));
        b1[i] = p1[i] + x2 * p2[i] + x3 * (x * p3[i]);
    }
    shapes->bb = v4d_dot(lanes, shapes->b, shapes->b);
    shapes->bb1 = v4d_dot(lanes, shapes->b, shapes->b1);
    shapes->b1b1 = v4d_dot(lanes, shapes->b1, shapes->b1);
    shapes->ct0 = poly0(element->ctb, s->xi);
    shapes->ct1 = poly1(element->ctb, s->xi);
    shapes->c0 = poly0(element->cb, s->xi);
    shapes->c1 = poly1(element->cb, s->xi);
    shapes->tt = shapes->cp_tau = 0;
    for (int j = 0; j < self->tube.nt; j++) {
        shapes->tau[j] = element->tau[j][0] + s->xi * element->tau[j][1];
        shapes->tt += shapes->tau[j] * shapes->tau[j];
        shapes->cp_tau += self->tube.cp[j] * shapes->tau[j];
    }
}

// Modal part of B_1^T M^-1 B_2 for forces at one section.
LD_INLINE double modal_product(const section_shapes *shapes, const direction *p, const direction *q)
{
    return shapes->bb * (p->force.y * q->force.y + p->force.z * q->force.z) +
           shapes->b1b1 * (p->mu.z * q->mu.z + p->mu.y * q->mu.y) +
           shapes->bb1 * (p->force.y * q->mu.z + p->mu.z * q->force.y - p->force.z * q->mu.y -
                          p->mu.y * q->force.z) +
           shapes->tt * p->mu.x * q->mu.x;
}

// Sets up a direction from its wrench at the section: force f at the section's point P + r_T and
// pure moment m on the rocket, opposite on the tube.
LD_INLINE void direction_load(const tube_state *tube, const rocket_state *rocket,
                              const rocket_inertia *inertia, const section_shapes *shapes, v3 f,
                              v3 m, v3 r_T, v3 rho, direction *e)
{
    const section *s = &rocket->at;
    e->G_f = f;
    e->G_m = v3_add(m, v3_cross(rho, f));
    rocket_solve(inertia, e->G_f, e->G_m, &e->r_a, &e->r_alpha);
    v3 W = v3_add(s->P, r_T);
    e->force = f;
    e->mu = m3_apply_transposed(s->Jl, v3_add(m, v3_cross(v3_sub(W, s->root), f)));
    // B_r - C B_q, with C B_q from the shapes' own products
    double uz = poly0(rocket->motion.z, s->xi), uz1 = poly1(rocket->motion.z, s->xi);
    double uy = poly0(rocket->motion.y, s->xi), uy1 = poly1(rocket->motion.y, s->xi);
    v3 B_f = f, B_m = v3_add(m, v3_cross(W, f));
    B_f.y -= shapes->ct0 * f.y + shapes->ct1 * e->mu.z;
    B_f.z -= shapes->ct0 * f.z - shapes->ct1 * e->mu.y;
    B_m.x -= uy * f.z - uy1 * e->mu.y - uz * f.y - uz1 * e->mu.z + shapes->cp_tau * e->mu.x;
    B_m.y += shapes->c0 * f.z - shapes->c1 * e->mu.y;
    B_m.z -= shapes->c0 * f.y + shapes->c1 * e->mu.z;
    forward(tube, B_f, B_m, e->rigid);
}

// G_p^T M3^-1 G_q + B_p^T M2^-1 B_q.
LD_INLINE double direction_product(const tube_state *tube, const section_shapes *shapes,
                                   const direction *p, const direction *q)
{
    return v3_dot(p->G_f, q->r_a) + v3_dot(p->G_m, q->r_alpha) + product(tube, p->rigid, q->rigid) +
           modal_product(shapes, p, q);
}

// G^T r_O - B^T e_0 for the accelerations without constraint forces.
LD_INLINE double free_acceleration(const int lanes, const launching_system *self,
                                   const tube_state *tube, const section_shapes *shapes,
                                   const direction *e, v3 r_a, v3 r_alpha, const double rigid[6],
                                   const tube_force *h)
{
    double modal =
        e->force.y * v4d_dot(lanes, shapes->b, h->y) + e->mu.z * v4d_dot(lanes, shapes->b1, h->y) +
        e->force.z * v4d_dot(lanes, shapes->b, h->z) - e->mu.y * v4d_dot(lanes, shapes->b1, h->z);
    for (int j = 0; j < self->tube.nt; j++)
        modal += e->mu.x * shapes->tau[j] * h->t[j];
    return v3_dot(e->G_f, r_a) + v3_dot(e->G_m, r_alpha) - product(tube, e->rigid, rigid) - modal;
}

// Velocity-dependent accelerations of the section at s (formulation.md, section 4: gv, gw).
typedef struct section_bias {
    v3 gv, gw;
} section_bias;

LD_INLINE section_bias bias_of(const tube_state *tube, const rocket_state *rocket)
{
    const section *s = &rocket->at;
    const section_rates *r = &rocket->rates;
    v3 w = tube->w;
    section_bias bias;
    v3 inner = v3_add(v3_cross(w, s->P), v3_scale(2, r->u_dot));
    bias.gv = v3_axpy(v3_cross(w, inner), rocket->s_dot, v3_add(v3_cross(w, s->t), r->u1_dot));
    // gamma_rot = Jl_dot Psi q_dot + w x (Jl Psi q_dot); then the convective part along s
    bias.gw = v3_add(rv_left_jacobian_derivative(s->th, r->th_dot, r->th_dot), v3_cross(w, r->w));
    v3 along =
        v3_add(m3_apply(s->Jl, r->k0_dot), rv_left_jacobian_derivative(s->th, s->k0, r->th_dot));
    bias.gw = v3_axpy(bias.gw, rocket->s_dot, along);
    return bias;
}

// beta and drift of a direction of force n at the knob (or O1): formulation.md, section 4.
LD_INLINE void force_bias(const tube_state *tube, const rocket_state *rocket,
                          const section_bias *bias, v3 n, v3 dn_dt, v3 r_T, v3 rho, direction *e)
{
    v3 v_E = v3_add(rocket->v_O1, v3_cross(rocket->w_B, rho));
    v3 v_rel = v3_sub(v_E, v3_add(rocket->v_P, v3_cross(rocket->w_P, r_T)));
    v3 n_dot = v3_add(dn_dt, v3_cross(v3_add(tube->w, rocket->Om), n));
    v3 sum = v3_cross(rocket->w_B, v3_cross(rocket->w_B, rho));
    sum = v3_sub(sum, v3_add(bias->gv, v3_cross(bias->gw, r_T)));
    v3 r_T_dot = v3_axpy(v3_sub(v_E, rocket->v_P), -rocket->s_dot, rocket->at.t);
    sum = v3_sub(sum, v3_cross(rocket->w_P, r_T_dot));
    e->beta = v3_dot(n, sum) + v3_dot(n_dot, v_rel);
    e->drift = v3_dot(n, v_rel);
}

// The slot's two directions at the knob, in S: normal and tangent, and the normal's derivative.
typedef struct slot_frame {
    v3 r_E;           // from P(s) to the knob, in S
    v3 n, tau, n_dot; // in S
} slot_frame;

// Slot angle at s and its derivative (linear between the table's points, constant outside).
LD_INLINE double slot_angle(const ld_table *table, double s, double *slope)
{
    *slope = 0;
    const double *row = table->data;
    size_t last = table->rows - 1, columns = table->columns;
    if (s <= row[0] || last == 0)
        return row[1];
    if (s >= row[last * columns])
        return row[last * columns + 1];
    size_t k = 1;
    while (s >= row[k * columns])
        k++;
    const double *p = row + (k - 1) * columns, *q = row + k * columns;
    *slope = (q[1] - p[1]) / (q[0] - p[0]);
    return p[1] + *slope * (s - p[0]);
}

LD_INLINE void slot_load(const launching_system *self, const rocket_state *rocket, slot_frame *slot)
{
    v3 arm = m3_apply(rocket->A_SB, v3_make(0, self->knob_y, self->knob_z));
    v3 r = v3_add(rocket->d, arm);
    slot->r_E = r;
    double radius = sqrt(r.y * r.y + r.z * r.z);
    v3 e_t = v3_make(0, -r.z / radius, r.y / radius);
    double slope, alpha = slot_angle(self->slot_angle, rocket->s, &slope), sa, ca;
    sine_cosine(alpha, &sa, &ca);
    slot->n = v3_make(-sa, ca * e_t.y, ca * e_t.z);
    slot->tau = v3_make(ca, sa * e_t.y, sa * e_t.z);
    // rates in S: of the knob, of e_t about x, of alpha
    v3 r_dot = v3_add(v3_make(0, rocket->y_dot, rocket->z_dot), v3_cross(rocket->w_SB, arm));
    double turn = (r.y * r_dot.z - r.z * r_dot.y) / (radius * radius);
    double alpha_dot = slope * rocket->s_dot;
    // n = (-sin a, cos a e_t): d/dt = -alpha_dot tau + cos a de_t, de_t = turn (e_x x e_t)
    slot->n_dot = v3_axpy(v3_make(0, -ca * turn * e_t.z, ca * turn * e_t.y), -alpha_dot, slot->tau);
}

// The slot's constraint and, where it slides, the tangent with the sliding speed.
LD_INLINE void slot_directions(const launching_system *self, const tube_state *tube,
                               const rocket_state *rocket, const rocket_inertia *inertia,
                               const section_shapes *shapes, const section_bias *bias,
                               direction *normal, direction *tangent, double *v_tau)
{
    slot_frame slot;
    slot_load(self, rocket, &slot);
    v3 n = m3_apply(rocket->at.A, slot.n), tau = m3_apply(rocket->at.A, slot.tau);
    v3 r_T = m3_apply(rocket->at.A, slot.r_E), rho = v3_sub(r_T, rocket->Ad);
    direction_load(tube, rocket, inertia, shapes, n, v3_zero(), r_T, rho, normal);
    force_bias(tube, rocket, bias, n, m3_apply(rocket->at.A, slot.n_dot), r_T, rho, normal);
    if (tangent) {
        direction_load(tube, rocket, inertia, shapes, tau, v3_zero(), r_T, rho, tangent);
        v3 v_E = v3_add(rocket->v_O1, v3_cross(rocket->w_B, rho));
        *v_tau = v3_dot(tau, v3_sub(v_E, v3_add(rocket->v_P, v3_cross(rocket->w_P, r_T))));
    }
}

// The lock's constraint: force along the section's axis at O1.
LD_INLINE void lock_direction(const tube_state *tube, const rocket_state *rocket,
                              const rocket_inertia *inertia, const section_shapes *shapes,
                              const section_bias *bias, direction *lock)
{
    v3 axis = m3_column(rocket->at.A, 0);
    direction_load(tube, rocket, inertia, shapes, axis, v3_zero(), rocket->Ad, v3_zero(), lock);
    force_bias(tube, rocket, bias, axis, v3_zero(), rocket->Ad, v3_zero(), lock);
}

// In a smooth bore the lock holds the roll too, by a moment about the section's axis.
LD_INLINE void roll_direction(const tube_state *tube, const rocket_state *rocket,
                              const rocket_inertia *inertia, const section_shapes *shapes,
                              const section_bias *bias, direction *roll)
{
    v3 axis = m3_column(rocket->at.A, 0);
    direction_load(tube, rocket, inertia, shapes, v3_zero(), axis, v3_zero(), v3_zero(), roll);
    v3 axis_dot = v3_cross(v3_add(tube->w, rocket->Om), axis);
    v3 w_rel = v3_sub(rocket->w_B, rocket->w_P);
    roll->beta = v3_dot(axis_dot, w_rel) - v3_dot(axis, bias->gw);
    roll->drift = v3_dot(axis, w_rel);
}

// Solution: accelerations with constraint forces x[0..n-1] along e[0..n-1] (tangent: friction).
LD_INLINE void add_constraint(const direction *e, double x, v3 *r_a, v3 *r_alpha, double rigid[6],
                              v3 *force, v3 *mu)
{
    *r_a = v3_axpy(*r_a, x, e->r_a);
    *r_alpha = v3_axpy(*r_alpha, x, e->r_alpha);
    for (int i = 0; i < 6; i++)
        rigid[i] -= x * e->rigid[i];
    *force = v3_axpy(*force, x, e->force);
    *mu = v3_axpy(*mu, x, e->mu);
}

// q_ddot = h_q - B_q - C^T (a, w_dot), with B_q of the constraint force and moment at the section.
LD_INLINE void modal_accelerations(const int lanes, const launching_system *self,
                                   const tube_state *tube, const section_shapes *shapes,
                                   const tube_force *h, v3 force, v3 mu, v3 a, v3 w_dot,
                                   double *q_ddot)
{
    int ct = 2 * self->support_count, c = ct + 1, nb = self->tube.nb;
    const modal_state *q = &tube->modal;
    v4d y[LD_NB / 4], z[LD_NB / 4];
    const v4d *hy = v4d_lanes_of(h->y), *hz = v4d_lanes_of(h->z);
    const v4d *qy = v4d_lanes_of(q->y), *qz = v4d_lanes_of(q->z);
    const v4d *row_ct = v4d_lanes_of(self->rows[ct]), *row_c = v4d_lanes_of(self->rows[c]);
    for (int i = 0; i < lanes; i++) {
        y[i] = hy[i] - v4d_all(a.y) * row_ct[i] + v4d_all(w_dot.x) * qz[i] -
               v4d_all(w_dot.z) * row_c[i];
        z[i] = hz[i] - v4d_all(a.z) * row_ct[i] - v4d_all(w_dot.x) * qy[i] +
               v4d_all(w_dot.y) * row_c[i];
        if (shapes) {
            const v4d *b = v4d_lanes_of(shapes->b), *b1 = v4d_lanes_of(shapes->b1);
            y[i] -= v4d_all(force.y) * b[i] + v4d_all(mu.z) * b1[i];
            z[i] -= v4d_all(force.z) * b[i] - v4d_all(mu.y) * b1[i];
        }
    }
    memcpy(q_ddot, y, (size_t)nb * sizeof(double));
    memcpy(q_ddot + nb, z, (size_t)nb * sizeof(double));
    for (int j = 0; j < self->tube.nt; j++)
        q_ddot[2 * nb + j] =
            h->t[j] - self->tube.cp[j] * w_dot.x - (shapes ? shapes->tau[j] * mu.x : 0);
}

// Constraint forces: slot with friction, or slot and lock, or lock and roll.
typedef struct constraint_forces {
    int count;
    direction e[2], tangent;
    bool sliding; // friction of the slot acts
    int lock_row; // of the lock, or -1
    double x[2];
    double rub; // friction force along tau
} constraint_forces;

// Products of the directions in force, D_ij = G_i^T M3^-1 G_j + B_i^T M2^-1 B_j; Dt: e[0] on
// tangent.
typedef struct constraint_products {
    double D00, D01, D11, Dt;
} constraint_products;

// Friction of the slot per |N|: mu sigma (formulation.md, section 3).
LD_INLINE double slot_rub(const launching_system *self, double v_tau)
{
    double v_eps = self->contact.v_eps;
    return self->slot_friction * v_tau / sqrt(v_tau * v_tau + v_eps * v_eps);
}

// Constraint forces for r = what the free accelerations miss. False where the knob jams: then no
// sign of N is consistent, or both are.
LD_INLINE bool solve_constraints(const launching_system *self, const constraint_products *D,
                                 const double r[], double v_tau, constraint_forces *c)
{
    if (c->count == 2) {
        double determinant = D->D00 * D->D11 - D->D01 * D->D01;
        c->x[0] = (D->D11 * r[0] - D->D01 * r[1]) / determinant;
        c->x[1] = (D->D00 * r[1] - D->D01 * r[0]) / determinant;
        return true;
    }
    double rub = 0;
    if (c->sliding) {
        if (!(self->slot_friction * fabs(D->Dt) < D->D00))
            return false;
        rub = r[0] < 0 ? -slot_rub(self, v_tau) : slot_rub(self, v_tau);
    }
    c->x[0] = r[0] / (D->D00 - rub * D->Dt);
    c->rub = -rub * c->x[0];
    return true;
}

// Directions of the constraints in force: slot, lock, roll.
LD_INLINE void load_constraints(const launching_system *self, const launching_phase *phase,
                                const tube_state *tube, const rocket_state *rocket,
                                const rocket_inertia *inertia, const section_shapes *shapes,
                                constraint_forces *c, double *v_tau)
{
    section_bias bias = bias_of(tube, rocket);
    c->count = 0;
    c->sliding = false;
    c->rub = *v_tau = 0;
    if (self->slot) {
        c->sliding = !phase->locked && !phase->frictionless && self->slot_friction > 0;
        slot_directions(self, tube, rocket, inertia, shapes, &bias, &c->e[c->count++],
                        c->sliding ? &c->tangent : NULL, v_tau);
    }
    c->lock_row = -1;
    if (phase->locked) {
        c->lock_row = c->count;
        lock_direction(tube, rocket, inertia, shapes, &bias, &c->e[c->count++]);
        if (!self->slot)
            roll_direction(tube, rocket, inertia, shapes, &bias, &c->e[c->count++]);
    }
}

LD_INLINE void report_constraints(const constraint_forces *c, bool slot, double v_tau,
                                  launching_output *out)
{
    int lock_row = c->lock_row;
    out->N = out->lock_force = out->slot_friction = out->drift = 0;
    if (slot) {
        out->N = c->x[0];
        out->drift = c->e[0].drift;
        out->slot_friction = c->rub;
        out->power[POWER_SLOT] = c->x[0] * c->e[0].drift;
        out->power[POWER_SLOT_FRICTION] = c->rub * v_tau;
    }
    if (lock_row >= 0) {
        out->lock_force = -c->x[lock_row];
        for (int i = lock_row; i < c->count; i++)
            out->power[POWER_LOCK] += c->x[i] * c->e[i].drift;
    }
}

#endif
