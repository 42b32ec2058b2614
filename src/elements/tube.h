// The flexible tube with its tail, in the fast layout of formulation.md, section 5: what it loads
// of the state, its own forces, and its condensed 6 x 6 mass matrix.
//
// M2 eta_dot = h2, eta = (v, w, q_dot): with modal mass E the modes are eliminated,
//   q_ddot = h_q - C^T (a, w_dot),   (M_rr - C C^T) (a, w_dot) = h_r - C h_q,   C = [Ct; Cr]
// Planes that share their shapes are the usual case, and G = E; what others need besides is apart.
#ifndef LD_ELEMENTS_TUBE_H
#define LD_ELEMENTS_TUBE_H

#include "elements/section.h"

// ---- set-up ----

LD_INLINE void tube_set_row(tube_system *self, int plane, int row, int j, double value)
{
    self->rows[plane][row][j] = value;
    self->rows_by_mode[plane][j][row] = value;
}

// Packs the shapes of one element by mode and by power.
LD_INLINE void tube_pack_element(const flexible_tube *tube, const tube_element *from,
                                 packed_element *to)
{
    memset(to, 0, sizeof *to);
    to->x0 = from->x0;
    to->x1 = from->x1;
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++)
        for (int j = 0; j < tube->nb; j++)
            for (int k = 0; k < 4; k++) {
                double shape = from->b[plane][k][j];
                packed_shapes *shapes = &to->plane[plane];
                shapes->by_mode[j][k] = shape;
                shapes->by_power[k][j] = shape;
                shapes->ctb[k] += tube->ct[plane][j] * shape;
                shapes->cb[k] += tube->c[plane][j] * shape;
            }
    for (int j = 0; j < tube->nt; j++)
        for (int k = 0; k < 2; k++)
            to->tau[j][k] = from->tau[k][j];
    for (int j = 0; j < tube->na; j++)
        for (int k = 0; k < 2; k++)
            to->a[j][k] = from->a[k][j];
}

// Rows that never change but for those of the supports, which come first; modal constants.
LD_INLINE void tube_build_rows(int support_count, tube_system *self)
{
    const flexible_tube *tube = &self->flexible;
    self->z = tube->overlap ? PLANE_Z : PLANE_Y;
    self->ct = 2 * support_count;
    self->c = self->ct + 1;
    self->row_lanes = (self->c + 1 + 3) / 4;
    for (int j = 0; j < tube->nb; j++) {
        for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
            tube_set_row(self, plane, self->ct, j, tube->ct[plane][j]);
            tube_set_row(self, plane, self->c, j, tube->c[plane][j]);
        }
        self->om2_y[j] = tube->om2_b[PLANE_Y][j];
        self->om2_z[j] = tube->om2_b[PLANE_Z][j];
        self->dmp_y[j] = tube->dmp_b[PLANE_Y][j];
        self->dmp_z[j] = tube->dmp_b[PLANE_Z][j];
    }
}

// ---- evaluation ----

LD_INLINE void modal_load(const int lanes, const tube_system *self, const launching_layout *at,
                          const double *state, modal_state *q)
{
    int nb = self->flexible.nb;
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
    q->a = q->t + self->flexible.nt;
    q->a_dot = q->t_dot + self->flexible.nt;
    q->planes_differ = self->z == PLANE_Z;
}

// The sums of the rows of a plane's G by q and by q_dot; two lanes at once, of which the last may
// be padding.
LD_INLINE void sum_rows(const flexible_tube *tube, int plane, const double *q, const double *q_dot,
                        double *to, double *to_dot)
{
    for (int k = 0; k < tube->nbp; k += 8) {
        v2d sum[8] = {{0}};
        for (int j = 0; j < tube->nb; j++) {
            const v2d *shape = v2d_lanes_of(&tube->overlap->G[plane][j][k]);
            v2d by = v2d_all(q[j]), by_dot = v2d_all(q_dot[j]);
            for (int i = 0; i < 4; i++) {
                sum[i] += shape[i] * by;
                sum[4 + i] += shape[i] * by_dot;
            }
        }
        memcpy(to + k, sum, 4 * sizeof *sum);
        memcpy(to_dot + k, sum + 4, 4 * sizeof *sum);
    }
}

LD_OUTLINE void modal_overlap(const flexible_tube *tube, modal_state *q)
{
    sum_rows(tube, PLANE_Z, q->z, q->z_dot, q->z_on_y, q->z_dot_on_y);
    sum_rows(tube, PLANE_Y, q->y, q->y_dot, q->y_on_z, q->y_dot_on_z);
}

// Products of the fixed rows of z, where these are its own.
LD_OUTLINE void load_rows_of_z(const tube_system *self, tube_state *tube)
{
    const modal_state *q = &tube->modal;
    for (int r = 0; r < 4 * self->row_lanes; r += 4) {
        v2d sum[4] = {{0}};
        for (int j = 0; j < self->flexible.nb; j++) {
            const v2d *row = v2d_lanes_of(&self->rows_by_mode[PLANE_Z][j][r]);
            for (int i = 0; i < 2; i++) {
                sum[i] += row[i] * v2d_all(q->z[j]);
                sum[2 + i] += row[i] * v2d_all(q->z_dot[j]);
            }
        }
        memcpy(tube->row_z + r, sum, 2 * sizeof *sum);
        memcpy(tube->row_z_dot + r, sum + 2, 2 * sizeof *sum);
    }
}

// State of the frame R and of the modes.
LD_INLINE void tube_load_motion(const int lanes, const tube_system *self,
                                const launching_layout *at, const double *state, tube_state *tube)
{
    tube->r = v3_from(state + at->r);
    tube->q_IR = q_from(state + at->quaternion);
    tube->A_IR = q_matrix(tube->q_IR);
    tube->v = v3_from(state + at->v);
    tube->w = v3_from(state + at->w);
    tube->g = m3_apply_transposed(tube->A_IR, v3_make(0, -self->gravity, 0));
    modal_load(lanes, self, at, state, &tube->modal);
}

// The same and the products of the modes with the fixed rows.
LD_INLINE void tube_load(const int lanes, const tube_system *self, const launching_layout *at,
                         const double *state, tube_state *tube)
{
    int nb = self->flexible.nb;
    modal_state *q = &tube->modal;
    tube_load_motion(lanes, self, at, state, tube);
    if (__builtin_expect(q->planes_differ, 0))
        modal_overlap(&self->flexible, q);
    // the fixed rows (supports, ct, c) times the four vectors of modal coordinates and speeds
    for (int r = 0; r < self->row_lanes; r++) {
        v4d y = v4d_all(0), z = y, y_dot = y, z_dot = y;
        for (int j = 0; j < nb; j++) {
            v4d row = v4d_lanes_of(self->rows_by_mode[PLANE_Y][j])[r];
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
    if (__builtin_expect(q->planes_differ, 0))
        load_rows_of_z(self, tube);
    int ct = self->ct, c = self->c;
    tube->ct_y = tube->row_y[ct];
    tube->ct_z = tube->row_z[ct];
    tube->c_y = tube->row_y[c];
    tube->c_z = tube->row_z[c];
    tube->qy_qy = v4d_dot(lanes, q->y, q->y);
    tube->qz_qz = v4d_dot(lanes, q->z, q->z);
    tube->qy_qz = v4d_dot(lanes, q->y, z_on_y(q));
}

// Gyroscopic forces, gravity, stiffness and damping of tube and tail: h of formulation.md section 1
// with the arrays of section 5 (no axial modes here).
LD_INLINE void tube_forces(const int lanes, const tube_system *self, tube_state *tube,
                           tube_force *h, launching_output *out)
{
    const flexible_tube *data = &self->flexible;
    const modal_state *q = &tube->modal;
    v3 w = tube->w, g = tube->g;
    int ct = self->ct, c = self->c;
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
    double W_yy = v4d_dot(lanes, q->y, q->y_dot), W_yz = v4d_dot(lanes, q->y, z_dot_on_y(q));
    double W_zy = v4d_dot(lanes, q->z, y_dot_on_z(q)), W_zz = v4d_dot(lanes, q->z, q->z_dot);
    double trace = W_yy + W_zz;
    v3 coriolis =
        v3_make(2 * trace * w.x, 2 * (trace * w.y - (W_xy * w.x + W_yy * w.y + W_zy * w.z)),
                2 * (trace * w.z - (W_xz * w.x + W_yz * w.y + W_zz * w.z)));
    double spin = data->j * w.x + cp_td;
    h->m = v3_sub(v3_cross(S, g), v3_add(v3_cross(w, Jw), coriolis));
    h->m = v3_sub(h->m, v3_cross(w, v3_make(spin, 0, 0)));
    // modes: part y: (w^2 - w_y^2) q_y - w_x w_y c - w_y w_z G q_z + 2 w_x G q_z_dot, part z alike
    double yy = w.x * w.x + w.z * w.z, zz = w.x * w.x + w.y * w.y, yz = -w.y * w.z;
    double cy = -w.x * w.y, cz = -w.x * w.z, two_wx = 2 * w.x;
    double dissipated = 0, stored = 0;
    const v4d *ct_y = v4d_lanes_of(self->rows[PLANE_Y][ct]);
    const v4d *c_y = v4d_lanes_of(self->rows[PLANE_Y][c]);
    const v4d *ct_z = v4d_lanes_of(self->rows[self->z][ct]);
    const v4d *c_z = v4d_lanes_of(self->rows[self->z][c]);
    const v4d *om2_y = v4d_lanes_of(self->om2_y), *om2_z = v4d_lanes_of(self->om2_z);
    const v4d *dmp_y = v4d_lanes_of(self->dmp_y), *dmp_z = v4d_lanes_of(self->dmp_z);
    const v4d *qy = v4d_lanes_of(q->y), *qz = v4d_lanes_of(q->z);
    const v4d *qy_dot = v4d_lanes_of(q->y_dot), *qz_dot = v4d_lanes_of(q->z_dot);
    const v4d *z_y = v4d_lanes_of(z_on_y(q)), *z_dot_y = v4d_lanes_of(z_dot_on_y(q));
    const v4d *y_z = v4d_lanes_of(y_on_z(q)), *y_dot_z = v4d_lanes_of(y_dot_on_z(q));
    v4d *hy = v4d_lanes(h->y), *hz = v4d_lanes(h->z);
    v4d damped = v4d_all(0), elastic = v4d_all(0);
    for (int k = 0; k < lanes; k++) {
        v4d ky = om2_y[k] * qy[k], kz = om2_z[k] * qz[k];
        v4d dy = dmp_y[k] * qy_dot[k], dz = dmp_z[k] * qz_dot[k];
        hy[k] = v4d_all(yy) * qy[k] + v4d_all(yz) * z_y[k] + v4d_all(cy) * c_y[k] +
                v4d_all(two_wx) * z_dot_y[k] + v4d_all(g.y) * ct_y[k] - ky - dy;
        hz[k] = v4d_all(zz) * qz[k] + v4d_all(yz) * y_z[k] + v4d_all(cz) * c_z[k] -
                v4d_all(two_wx) * y_dot_z[k] + v4d_all(g.z) * ct_z[k] - kz - dz;
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

// What shapes of their own change of the factors, G q_z = z_y and G^T q_y = y_z in place of q_z and
// q_y: wx couples with vy, vz and with wy, wz.
LD_OUTLINE void tube_factor_two_planes(const int lanes, const tube_system *self, tube_state *tube)
{
    const flexible_tube *data = &self->flexible;
    const modal_state *q = &tube->modal;
    const double *z_y = q->z_on_y, *y_z = q->y_on_z;
    const double *ct_y = self->rows[PLANE_Y][self->ct], *c_y = self->rows[PLANE_Y][self->c];
    const double *ct_z = self->rows[PLANE_Z][self->ct], *c_z = self->rows[PLANE_Z][self->c];
    double m_z = self->m - data->ctct[PLANE_Z], off_z = data->ctc[PLANE_Z] - self->Sx;
    double x_y = v4d_dot(lanes, z_y, ct_y) - tube->ct_z,
           x_z = tube->ct_y - v4d_dot(lanes, y_z, ct_z);
    tube->per_mz = 1 / m_z;
    tube->l_yz = off_z * tube->per_mz;
    tube->l_xy = x_y * tube->per_my; // (wx, vy)/my
    tube->l_xz = x_z * tube->per_mz; // (wx, vz)/mz
    double sxx = self->jx + tube->qy_qy + tube->qz_qz - v4d_dot(lanes, z_y, z_y) -
                 v4d_dot(lanes, y_z, y_z) - tube->l_xy * x_y - tube->l_xz * x_z;
    double syx = v4d_dot(lanes, y_z, c_z) - tube->c_y - tube->l_yz * x_z;
    double szx = v4d_dot(lanes, z_y, c_y) - tube->c_z - tube->l_zy * x_y;
    tube->per_jx = 1 / sxx;
    tube->l_ywx = syx * tube->per_jx;
    tube->l_zwx = szx * tube->per_jx;
    double syy = data->j0 - data->cc[PLANE_Z] + self->tail_inertia.y + tube->qz_qz -
                 tube->l_yx * tube->ct_z - tube->l_yz * off_z - tube->l_ywx * syx;
    double szz = data->j0 - data->cc[PLANE_Y] + self->tail_inertia.z + tube->qy_qy +
                 tube->l_zx * tube->ct_y + tube->l_zy * (data->ctc[PLANE_Y] - self->Sx) -
                 tube->l_zwx * szx;
    double szy = -tube->qy_qz - tube->l_zx * tube->ct_z - tube->l_zwx * syx;
    tube->per_dy = 1 / syy;
    tube->l_zwy = szy * tube->per_dy;
    tube->per_dz = 1 / (szz - tube->l_zwy * szy);
}

// The condensed 6 x 6 matrix (vx vy vz wx | wy wz): its first four rows are diagonal and the last
// two couple to them, so the factors are the six numbers l and the 2 x 2 rest.
LD_INLINE void tube_factor(const int lanes, const tube_system *self, tube_state *tube)
{
    const flexible_tube *data = &self->flexible;
    double my = self->m - data->ctct[PLANE_Y], off = data->ctc[PLANE_Y] - self->Sx;
    tube->per_m = 1 / self->m;
    tube->per_my = 1 / my;
    tube->per_jx = 1 / self->jx;
    tube->l_yx = tube->ct_z * tube->per_m;  // (wy, vx)/m
    tube->l_yz = off * tube->per_my;        // (wy, vz)/my
    tube->l_zx = -tube->ct_y * tube->per_m; // (wz, vx)/m
    tube->l_zy = -off * tube->per_my;       // (wz, vy)/my
    double j = data->j0 - data->cc[PLANE_Y];
    double syy =
        j + self->tail_inertia.y + tube->qz_qz - tube->l_yx * tube->ct_z - tube->l_yz * off;
    double szz =
        j + self->tail_inertia.z + tube->qy_qy + tube->l_zx * tube->ct_y + tube->l_zy * off;
    double szy = -tube->qy_qz - tube->l_zx * tube->ct_z;
    tube->per_dy = 1 / syy;
    tube->l_zwy = szy * tube->per_dy;
    tube->per_dz = 1 / (szz - tube->l_zwy * szy);
    if (__builtin_expect(tube->modal.planes_differ, 0))
        tube_factor_two_planes(lanes, self, tube);
}

// L^-1 of (force, moment); kept undivided by the diagonal.
LD_INLINE void tube_forward(const tube_state *tube, v3 f, v3 m, double out[6])
{
    out[0] = f.x;
    out[1] = f.y;
    out[2] = f.z;
    out[3] = m.x;
    out[4] = m.y - tube->l_yx * f.x - tube->l_yz * f.z;
    out[5] = m.z - tube->l_zx * f.x - tube->l_zy * f.y;
    if (__builtin_expect(tube->modal.planes_differ, 0)) {
        out[3] -= tube->l_xy * f.y + tube->l_xz * f.z;
        out[4] -= tube->l_ywx * out[3];
        out[5] -= tube->l_zwx * out[3];
    }
    out[5] -= tube->l_zwy * out[4];
}

// x^T D^-1 y of two forward-substituted vectors.
LD_INLINE double tube_product(const tube_state *tube, const double x[6], const double y[6])
{
    double across = __builtin_expect(tube->modal.planes_differ, 0)
                        ? x[1] * y[1] * tube->per_my + x[2] * y[2] * tube->per_mz
                        : (x[1] * y[1] + x[2] * y[2]) * tube->per_my;
    return x[0] * y[0] * tube->per_m + across + x[3] * y[3] * tube->per_jx +
           x[4] * y[4] * tube->per_dy + x[5] * y[5] * tube->per_dz;
}

// Acceleration of the tube's frame: inertial of R's origin, derivative of w, in R.
typedef struct frame_acceleration {
    v3 a, w_dot;
} frame_acceleration;

// L^-T D^-1 of a forward-substituted vector.
LD_INLINE frame_acceleration tube_backward(const tube_state *tube, const double x[6])
{
    frame_acceleration frame;
    double wz = x[5] * tube->per_dz;
    double wy = x[4] * tube->per_dy - tube->l_zwy * wz;
    frame.a = v3_make(x[0] * tube->per_m - tube->l_yx * wy - tube->l_zx * wz,
                      x[1] * tube->per_my - tube->l_zy * wz, x[2] * tube->per_my - tube->l_yz * wy);
    frame.w_dot = v3_make(x[3] * tube->per_jx, wy, wz);
    if (__builtin_expect(tube->modal.planes_differ, 0)) {
        frame.w_dot.x -= tube->l_ywx * wy + tube->l_zwx * wz;
        frame.a.y -= tube->l_xy * frame.w_dot.x;
        frame.a.z = x[2] * tube->per_mz - tube->l_yz * wy - tube->l_xz * frame.w_dot.x;
    }
    return frame;
}

// C h_q: what the modal forces put on the rigid equations.
LD_INLINE void tube_condense(const int lanes, const tube_system *self, const tube_state *tube,
                             const tube_force *h, v3 *f, v3 *m)
{
    int ct = self->ct, c = self->c;
    const modal_state *q = &tube->modal;
    double twist = 0;
    for (int j = 0; j < self->flexible.nt; j++)
        twist += self->flexible.cp[j] * h->t[j];
    const double(*of_y)[LD_NB] = self->rows[PLANE_Y], (*of_z)[LD_NB] = self->rows[self->z];
    *f = v3_make(0, v4d_dot(lanes, of_y[ct], h->y), v4d_dot(lanes, of_z[ct], h->z));
    *m = v3_make(v4d_dot(lanes, y_on_z(q), h->z) - v4d_dot(lanes, z_on_y(q), h->y) + twist,
                 -v4d_dot(lanes, of_z[c], h->z), v4d_dot(lanes, of_y[c], h->y));
}

// What acts on the modes through a section: the opposite of a force and of a moment, Jl^T m.
typedef struct section_reaction {
    const section_shapes *shapes;
    v3 force, mu;
} section_reaction;

// q_ddot = h_q - B_q - C^T (a, w_dot), with B_q of the reaction at a section; NULL: none.
LD_INLINE void tube_modal_accelerations(const int lanes, const tube_system *self,
                                        const launching_instant *now,
                                        const section_reaction *reaction, frame_acceleration frame,
                                        double *q_ddot)
{
    int ct = self->ct, c = self->c, nb = self->flexible.nb;
    const modal_state *q = &now->tube.modal;
    const tube_force *h = &now->on_tube;
    v3 a = frame.a, w_dot = frame.w_dot;
    v4d y[LD_NB / 4], z[LD_NB / 4];
    const v4d *hy = v4d_lanes_of(h->y), *hz = v4d_lanes_of(h->z);
    const v4d *z_y = v4d_lanes_of(z_on_y(q)), *y_z = v4d_lanes_of(y_on_z(q));
    const v4d *ct_y = v4d_lanes_of(self->rows[PLANE_Y][ct]);
    const v4d *c_y = v4d_lanes_of(self->rows[PLANE_Y][c]);
    const v4d *ct_z = v4d_lanes_of(self->rows[self->z][ct]);
    const v4d *c_z = v4d_lanes_of(self->rows[self->z][c]);
    for (int i = 0; i < lanes; i++) {
        y[i] =
            hy[i] - v4d_all(a.y) * ct_y[i] + v4d_all(w_dot.x) * z_y[i] - v4d_all(w_dot.z) * c_y[i];
        z[i] =
            hz[i] - v4d_all(a.z) * ct_z[i] - v4d_all(w_dot.x) * y_z[i] + v4d_all(w_dot.y) * c_z[i];
        if (reaction) {
            const section_shapes *shapes = reaction->shapes;
            const plane_shapes *of_y = &shapes->plane[PLANE_Y], *of_z = &shapes->plane[shapes->z];
            y[i] -= v4d_all(reaction->force.y) * v4d_lanes_of(of_y->b)[i] +
                    v4d_all(reaction->mu.z) * v4d_lanes_of(of_y->b1)[i];
            z[i] -= v4d_all(reaction->force.z) * v4d_lanes_of(of_z->b)[i] -
                    v4d_all(reaction->mu.y) * v4d_lanes_of(of_z->b1)[i];
        }
    }
    memcpy(q_ddot, y, (size_t)nb * sizeof(double));
    memcpy(q_ddot + nb, z, (size_t)nb * sizeof(double));
    for (int j = 0; j < self->flexible.nt; j++)
        q_ddot[2 * nb + j] = h->t[j] - self->flexible.cp[j] * w_dot.x -
                             (reaction ? reaction->shapes->tau[j] * reaction->mu.x : 0);
}

// Adds what the reaction at one more section does to the modes.
LD_INLINE void react_on_modes(const tube_system *self, const section_reaction *reaction,
                              double *q_ddot)
{
    int nb = self->flexible.nb;
    const section_shapes *shapes = reaction->shapes;
    v3 force = reaction->force, mu = reaction->mu;
    const plane_shapes *of_y = &shapes->plane[PLANE_Y], *of_z = &shapes->plane[shapes->z];
    for (int j = 0; j < nb; j++) {
        q_ddot[j] -= force.y * of_y->b[j] + mu.z * of_y->b1[j];
        q_ddot[nb + j] -= force.z * of_z->b[j] - mu.y * of_z->b1[j];
    }
    for (int j = 0; j < self->flexible.nt; j++)
        q_ddot[2 * nb + j] -= shapes->tau[j] * mu.x;
}

#endif
