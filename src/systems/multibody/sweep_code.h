// The reduced sweep (formulation.md, section 2): the Riccati form of the transfer equations. One
// sweep outwards gives the motion; from the tips inwards every cut gets F = Z [a; alpha] + zf; a
// last sweep outwards gives the accelerations. Gravity is the ground's acceleration -g.
//
// This is the text of sweep_default.c and, where the machine may have wider registers, of
// sweep_avx.c compiled for these; each defines SWEEP_NAME.
#include <float.h>
#include <string.h>

#include "math/sine_cosine.h"
#include "math/vectors/quaternion.h"
#include "systems/multibody/multibody.h"

// Hinge frame of a node in inertial axes, before its own turns.
LD_INLINE void hinge_axes(const ld_mstmm *system, const node *n, v4d H[3])
{
    const v4d *A = system->motion[n->parent].A;
    for (int j = 0; j < 3; j++)
        H[j] = v4d_combine(A, n->G.a[0][j], n->G.a[1][j], n->G.a[2][j]);
}

// ---- motion

// A section node follows its beam's deformed section, known in the beam's floating frame.
static void move_section(ld_mstmm *system, int i)
{
    const node *n = &system->node[i];
    const node_beam *b = &system->beam_of[i];
    node_motion *m = &system->motion[i];
    const tube_section_state *section = &b->body->output[b->output].section;
    m3 A_R = node_hinge_axes(system, i);
    v4d_store_m3(m->A, m3_mul(A_R, section->rotation));
    m->w = system->motion[n->parent].w + v4d_from_v3(m3_apply(A_R, section->spin));
    m->w2 = v4d_total(m->w * m->w);
    m->r = v4d_from_v3(m3_apply(A_R, section->position));
}

static void move_beam(ld_mstmm *system, int i, const double *q, const double *u)
{
    const node_beam *b = &system->beam_of[i];
    v3 w = v4d_v3(system->motion[i].w);
    v3 w_R = m3_apply_transposed(node_body_axes(system, i), w);
    beam_move(b->body, w_R, q + b->modes_q, u + b->modes_u);
}

// Balls and free hinges turn by a quaternion. H: the hinge frame.
static void move_several(ld_mstmm *system, int i, const v4d H[3], const double *q, const double *u)
{
    const node *n = &system->node[i];
    const node_motion *parent = &system->motion[n->parent];
    node_motion *m = &system->motion[i];
    int slides = n->hinge == NODE_FREE ? 3 : 0;
    const double *turn = u + n->u + slides;
    m3 A = q_matrix(q_from(q + n->q + slides));
    for (int j = 0; j < 3; j++)
        m->A[j] = v4d_combine(H, A.a[0][j], A.a[1][j], A.a[2][j]);
    v4d spin = v4d_combine(m->A, turn[0], turn[1], turn[2]), slide = v4d_all(0);
    if (slides) {
        const double *at = q + n->q, *rate = u + n->u;
        m->r += v4d_combine(H, at[0], at[1], at[2]);
        slide = v4d_combine(H, rate[0], rate[1], rate[2]);
    }
    m->w = parent->w + spin;
    m->w2 = v4d_total(m->w * m->w);
    m->bias_a = v4d_cross(parent->w, v4d_cross(parent->w, m->r) + 2 * slide);
    m->bias_alpha = v4d_cross(parent->w, spin);
}

// w x (w x r)
LD_INLINE v4d centripetal(const node_motion *motion, v4d r)
{
    return motion->w * v4d_total(motion->w * r) - motion->w2 * r;
}

static void move(ld_mstmm *system, const double *q, const double *u)
{
    // sines and cosines of all turns
    for (int k = 0; k < system->angle_count; k++)
        system->angle[k] = q[system->angle_q[k]];
    for (int k = 0; k < system->angle_count; k += 4)
        sine_cosine_four(system->angle + k, system->sine + k, system->cosine + k);

    for (int i = 1; i <= system->node_count; i++) {
        const node *n = &system->node[i];
        const node_motion *parent = &system->motion[n->parent];
        node_motion *m = &system->motion[i];
        if (n->body == NODE_SECTION) {
            move_section(system, i);
            continue;
        }
        v4d w = parent->w, H[3];
        hinge_axes(system, n, H);
        v4d r = v4d_combine(parent->A, n->at.x, n->at.y, n->at.z);
        switch (n->hinge) {
        case NODE_TURN: {
            v4d sine = v4d_all(system->sine[n->angle]);
            v4d cosine = v4d_all(system->cosine[n->angle]);
            v4d spin = H[2] * v4d_all(u[n->u]);
            m->A[0] = H[0] * cosine + H[1] * sine;
            m->A[1] = H[1] * cosine - H[0] * sine;
            m->A[2] = H[2];
            m->r = r;
            m->bias_a = centripetal(parent, r);
            m->bias_alpha = v4d_cross(w, spin);
            m->w = w + spin;
            m->w2 = v4d_total(m->w * m->w);
            break;
        }
        case NODE_SLIDE:
        case NODE_WELD: {
            m->A[0] = H[0];
            m->A[1] = H[1];
            m->A[2] = H[2];
            v4d drift = v4d_all(0);
            if (n->hinge == NODE_SLIDE) {
                r += H[2] * v4d_all(q[n->q]);
                drift = v4d_cross(w, H[2] * v4d_all(2 * u[n->u]));
            }
            m->r = r;
            m->bias_a = centripetal(parent, r) + drift;
            m->bias_alpha = v4d_all(0);
            m->w = w;
            m->w2 = parent->w2;
            break;
        }
        default:
            m->r = r;
            move_several(system, i, H, q, u);
        }
        if (n->body == NODE_BEAM)
            move_beam(system, i, q, u);
    }
}

// ---- inwards

// s += t
LD_INLINE void add_share(share *s, const share *t)
{
    s->A.d += t->A.d;
    s->A.o += t->A.o;
    s->C.d += t->C.d;
    s->C.o += t->C.o;
    s->B.d += t->B.d;
    s->B.o += t->B.o;
    s->B.p += t->B.p;
    s->f += t->f;
    s->m += t->m;
}

// A rigid body's own share: M x + (w x (w x m c), w x J w), M = [m E, -m ~c; m ~c, J].
LD_INLINE share rigid_share(const node_inertia *body, const node_motion *motion)
{
    const v4d *A = motion->A;
    const v3 *c = &body->moment;
    const sym3 *I = &body->inertia;
    v4d mc = v4d_combine(A, c->x, c->y, c->z);

    // J = (A I) A^T
    v4d H[3] = {v4d_combine(A, I->xx, I->xy, I->xz), v4d_combine(A, I->xy, I->yy, I->yz),
                v4d_combine(A, I->xz, I->yz, I->zz)};
    lanes_sym3 J = {(H[0] * A[0] + H[1] * A[1]) + H[2] * A[2],
                    (H[0] * v4d_zxy(A[0]) + H[1] * v4d_zxy(A[1])) + H[2] * v4d_zxy(A[2])};
    lanes_cycle w = lanes_cycle_of(motion->w);
    return (share){
        .A = {v4d_all(body->mass) * (v4d){1, 1, 1, 0}, v4d_all(0)},
        .B = {v4d_all(0), -v4d_yzx(mc), v4d_zxy(mc)},
        .C = J,
        .f = centripetal(motion, mc),
        .m = lanes_cross(&w, lanes_sym_apply(&J, &w)),
    };
}

// A single axis e of a hinge is eliminated: with U = Z e, D = e . U, its row e . F = tau gives
// u_dot = rate - V . (acceleration without it), V = U/D. What it leaves: Z - U V^T, zf + U rate.
LD_INLINE void release_axis(share *s, spatial_lanes U, spatial_lanes V, v4d rate)
{
    v4d turned = v4d_zxy(U.alpha);
    s->A.d -= V.a * U.a;
    s->A.o -= V.a * v4d_zxy(U.a);
    s->B.d -= V.a * U.alpha;
    s->B.o -= V.a * turned;
    s->B.p -= V.a * v4d_yzx(U.alpha);
    s->C.d -= V.alpha * U.alpha;
    s->C.o -= V.alpha * turned;
    s->f += U.a * rate;
    s->m += U.alpha * rate;
}

// Whether D vanishes against what Z resists along all axes of its kind.
LD_INLINE int is_singular(double D, double all)
{
    return !(D > 4 * DBL_EPSILON * all);
}

// To the parent's origin: T^T Z T with T = [E, -~r; 0, E], T^T zf: B' = B - A ~r,
// C' = C + W + W^T with W = ~r (B + B')/2.
LD_INLINE void shift_share(share *s, const lanes_cycle *r)
{
    const v4d half = v4d_all(0.5);
    const lanes_sym3 *A = &s->A;
    v4d A_p = v4d_yzx(A->o);
    lanes_m3 B = {s->B.d - (A_p * r->zxy - A->o * r->yzx), s->B.o - (A->d * r->yzx - A_p * r->v),
                  s->B.p - (A->o * r->v - A->d * r->zxy)};
    v4d d = s->B.d + B.d, o = v4d_yzx(s->B.o + B.o), p = s->B.p + B.p;
    s->C.d += r->yzx * v4d_zxy(p) - r->zxy * o;
    s->C.o += half * ((r->yzx * (v4d_zxy(d) - d) + r->v * o) - r->zxy * v4d_yzx(p));
    s->B = B;
    s->m += lanes_cross(r, s->f);
}

// zf counts from the parent's motion alone: + Z bias. Without bias_alpha: a slide's.
LD_INLINE void add_bias(share *s, v4d bias_a, v4d bias_alpha, bool turns)
{
    lanes_cycle a = lanes_cycle_of(bias_a), alpha = lanes_cycle_of(bias_alpha);
    s->f += lanes_sym_apply(&s->A, &a);
    s->m += lanes_apply_transposed(&s->B, a.v);
    if (turns) {
        s->f += lanes_apply(&s->B, &alpha);
        s->m += lanes_sym_apply(&s->C, &alpha);
    }
}

// A hinge with one axis, a turn or a slide: the share goes to the parent's origin first and the
// axis is eliminated there, so that the division waits for nothing; V then belongs to the parent's
// acceleration. The ground needs no share.
// NOLINTNEXTLINE(readability-function-size)
LD_INLINE int pass_axis(const share *own, share *passing, axis_record *record,
                        const node_motion *motion, double tau, bool turns, bool onward)
{
    lanes_cycle e = lanes_cycle_of(motion->A[2]), r = lanes_cycle_of(motion->r);
    share s = *own;
    add_share(&s, passing);
    spatial_lanes U;
    if (turns)
        U = (spatial_lanes){lanes_apply(&s.B, &e), lanes_sym_apply(&s.C, &e)};
    else
        U = (spatial_lanes){lanes_sym_apply(&s.A, &e), lanes_apply_transposed(&s.B, e.v)};
    v4d D = v4d_total(e.v * (turns ? U.alpha : U.a));
    v4d all = v4d_total(turns ? s.C.d : s.A.d), inverse = v4d_all(1) / D;
    v4d along = e.v * (turns ? s.m : s.f) + U.a * motion->bias_a;
    if (turns)
        along += U.alpha * motion->bias_alpha;
    v4d rate = (v4d_all(tau) - v4d_total(along)) * inverse;
    U.alpha += lanes_cross(&r, U.a);
    spatial_lanes V = {U.a * inverse, U.alpha * inverse};
    record->V_a = V.a;
    record->V_alpha = V.alpha;
    record->rate = rate[0];
    record->inverse = inverse[0];
    if (onward) {
        add_bias(&s, motion->bias_a, motion->bias_alpha, turns);
        shift_share(&s, &r);
        release_axis(&s, U, V, rate);
        *passing = s;
    }
    return is_singular(D[0], all[0]);
}

// The lower triangle of a symmetric matrix into rows.
LD_INLINE void store_rows(double *row, int width, sym3 M)
{
    row[0] = M.xx;
    row[width] = M.xy;
    row[width + 1] = M.yy;
    row[2 * width] = M.xz;
    row[2 * width + 1] = M.yz;
    row[2 * width + 2] = M.zz;
}

// The first `count` unknowns of the lower triangle Z and of F = Z x eliminated, alpha before a:
// Z = L D L^T; what is left of rows and F has to be found in the rest.
LD_INLINE int eliminate(double Z[6][6], double F[6], double inverse[6], int count)
{
    int singular = 0;
    double all[2] = {Z[0][0] + Z[1][1] + Z[2][2], Z[3][3] + Z[4][4] + Z[5][5]};
    for (int k = 0; k < count; k++) {
        singular |= is_singular(Z[k][k], all[k / 3]);
        inverse[k] = 1 / Z[k][k];
        double column[6];
        for (int i = k + 1; i < 6; i++) {
            column[i] = Z[i][k];
            Z[i][k] *= inverse[k];
            for (int j = k + 1; j <= i; j++)
                Z[i][j] -= Z[i][k] * column[j];
            F[i] -= Z[i][k] * F[k];
        }
    }
    return singular;
}

// All axes of a ball or of a free hinge: along them the wrench is the drive's, F = Z x + zf gives
// the body's alpha from its a (ball) or alpha and a. Nothing passes a free hinge but its drive.
static int eliminate_several(ld_mstmm *system, int i, share *s, const double *tau)
{
    const node *n = &system->node[i];
    const bool is_free = n->hinge == NODE_FREE;
    const double *drive = tau + n->u;
    axis_record *record = system->axis + n->axis;
    const v4d none = v4d_all(0);
    v4d f = none;
    if (is_free) {
        v4d H[3];
        hinge_axes(system, n, H);
        f = v4d_combine(H, drive[0], drive[1], drive[2]);
        drive += 3;
    }
    v4d m = v4d_combine(system->motion[i].A, drive[0], drive[1], drive[2]);

    // the equations, alpha first
    double Z[6][6], F[6], inverse[6];
    store_rows(&Z[0][0], 6, lanes_to_sym3(&s->C));
    store_rows(&Z[3][3], 6, lanes_to_sym3(&s->A));
    m3 B = lanes_to_m3(&s->B);
    v4d left_m = m - s->m, left_f = f - s->f;
    for (int k = 0; k < 3; k++) {
        memcpy(Z[3 + k], B.a[k], sizeof B.a[k]);
        F[k] = left_m[k];
        F[3 + k] = left_f[k];
    }
    int singular = is_free ? eliminate(Z, F, inverse, 6) : eliminate(Z, F, inverse, 3);

    // the factor's columns, for the back substitution when the body's a is known
    for (int k = 0; k < (is_free ? 6 : 3); k++) {
        record[k] = (axis_record){none, none, F[k] * inverse[k], inverse[k]};
        for (int j = k + 1; j < 3; j++)
            record[k].V_alpha[j] = Z[j][k];
        for (int j = k < 3 ? 3 : k + 1; j < 6; j++)
            record[k].V_a[j - 3] = Z[j][k];
    }
    // what is left for the parent
    *s = (share){.f = f, .m = m};
    if (!is_free) {
        sym3 A = {Z[3][3], Z[4][3], Z[5][3], Z[4][4], Z[5][4], Z[5][5]};
        s->A = lanes_from_sym3(&A);
        s->f = (v4d){-F[3], -F[4], -F[5], 0};
    }
    return singular;
}

// A prescribed hinge: its accelerations join what its motion gives without them.
static void give_motion(ld_mstmm *system, int i, const double *tau)
{
    const node *n = &system->node[i];
    node_motion *m = &system->motion[i];
    const double *given = tau + n->u;
    const v4d none = v4d_all(0);
    for (int k = 0; k < node_speeds(n); k++)
        system->axis[n->axis + k] = (axis_record){none, none, given[k], 0};
    if (n->hinge == NODE_FREE) {
        v4d H[3];
        hinge_axes(system, n, H);
        m->bias_a += v4d_combine(H, given[0], given[1], given[2]);
        given += 3;
    }
    if (n->hinge == NODE_TURN)
        m->bias_alpha += m->A[2] * v4d_all(given[0]);
    else if (n->hinge == NODE_SLIDE)
        m->bias_a += m->A[2] * v4d_all(given[0]);
    else
        m->bias_alpha += v4d_combine(m->A, given[0], given[1], given[2]);
}

static spatial_matrix share_matrix(const share *s)
{
    return (spatial_matrix){lanes_to_sym3(&s->A), lanes_to_m3(&s->B), lanes_to_sym3(&s->C)};
}

// What hangs on a section loads the beam.
static void load_beam(ld_mstmm *system, int i, const share *s)
{
    m3 back = m3_transpose(node_body_axes(system, system->node[i].parent));
    spatial_matrix Z = share_matrix(s), Z_R = spatial_matrix_turn(back, &Z);
    spatial zf = {v4d_v3(s->f), v4d_v3(s->m)};
    const node_beam *b = &system->beam_of[i];
    beam_load(b->body, b->output, &Z_R, spatial_turn(back, zf));
}

// The beam's share at its input end, its sections' loads included. Returns 0, or 1: singular.
static int reduce_beam(ld_mstmm *system, int i, const double *tau, share *s)
{
    m3 A_R = node_body_axes(system, i);
    const node_beam *b = &system->beam_of[i];
    spatial_matrix Z_R, Z;
    spatial zf;
    if (system->beams_rigid)
        beam_hold(b->body);
    if (beam_reduce(b->body, tau + b->modes_u, &Z_R, &zf))
        return 1;
    Z = spatial_matrix_turn(A_R, &Z_R);
    zf = spatial_turn(A_R, zf);
    *s = (share){lanes_from_sym3(&Z.A), lanes_from_sym3(&Z.C), lanes_from_m3(&Z.B),
                 v4d_from_v3(zf.linear), v4d_from_v3(zf.angular)};
    return 0;
}

LD_INLINE void clear_share(share *s)
{
    const v4d zero = v4d_all(0);
    s->A.d = s->A.o = s->C.d = s->C.o = s->B.d = s->B.o = s->B.p = s->f = s->m = zero;
}

// The own shares of a few bodies up to node i; returns the first of them.
LD_INLINE int make_own_shares(ld_mstmm *system, int i)
{
    int first = i > MULTIBODY_BLOCK ? i - MULTIBODY_BLOCK + 1 : 1;
    for (int k = first; k <= i; k++)
        system->own[k % MULTIBODY_BLOCK] = rigid_share(&system->inertia[k], &system->motion[k]);
    return first;
}

// Hinges with several axes or none, prescribed ones, and sections.
LD_OUTLINE int pass_otherwise(ld_mstmm *system, int i, const share *own, const double *tau)
{
    const node *n = &system->node[i];
    const node_motion *motion = &system->motion[i];
    share *passing = system->passing;
    const bool given = system->pass[i] == PASS_GIVEN;
    int singular = 0;
    add_share(passing, own);
    if (n->body == NODE_SECTION) {
        load_beam(system, i, passing);
        return 0;
    }
    if (given)
        give_motion(system, i, tau);
    else if (system->pass[i] == PASS_SEVERAL)
        singular = eliminate_several(system, i, passing, tau);
    lanes_cycle r = lanes_cycle_of(motion->r);
    add_bias(passing, motion->bias_a, given ? motion->bias_alpha : v4d_all(0), given);
    shift_share(passing, &r);
    return singular;
}

static int sweep_inwards(ld_mstmm *system, const double *tau, const double *wrench)
{
    share *passing = system->passing;
    clear_share(passing);
    for (int k = 0; k < system->branch_count; k++)
        clear_share(&system->branch[k]);
    int ready = system->node_count + 1;
    for (int i = system->node_count; i >= 1; i--) {
        const node *n = &system->node[i];
        const node_motion *motion = &system->motion[i];
        int singular = 0;

        if (i < ready)
            ready = make_own_shares(system, i);

        // the body, and what hangs on it
        share *own = &system->own[i % MULTIBODY_BLOCK];
        if (n->body == NODE_BEAM)
            singular = reduce_beam(system, i, tau, own);
        if (wrench && n->load >= 0) {
            own->f -= v4d_from_v3(v3_from(wrench + 6 * n->load));
            own->m -= v4d_from_v3(v3_from(wrench + 6 * n->load + 3));
        }
        if (n->branch >= 0)
            add_share(own, &system->branch[n->branch]);

        // its hinge, and on to the parent
        axis_record *record = &system->axis[n->axis];
        const bool onward = n->parent > 0;
        if (system->pass[i] == PASS_TURN) {
            singular |= pass_axis(own, passing, record, motion, tau[n->u], true, onward);
        } else if (system->pass[i] == PASS_SLIDE) {
            singular |= pass_axis(own, passing, record, motion, tau[n->u], false, onward);
        } else {
            singular |= pass_otherwise(system, i, own, tau);
        }
        if (singular)
            return i;
        if (!n->leads) {
            int branch = system->node[n->parent].branch;
            if (branch >= 0)
                add_share(&system->branch[branch], passing);
            clear_share(passing);
        }
    }
    return 0;
}

// ---- outwards

// In all lanes.
LD_INLINE v4d solve_axis(const axis_record *record, spatial_lanes x)
{
    return v4d_all(record->rate) - v4d_total(record->V_a * x.a + record->V_alpha * x.alpha);
}

// The part of a along three columns into u_dot, and what has been stored.
LD_INLINE v4d store_along(const v4d column[3], v4d a, double *u_dot)
{
    for (int k = 0; k < 3; k++)
        u_dot[k] = v4d_total(column[k] * a)[0];
    return v4d_combine(column, u_dot[0], u_dot[1], u_dot[2]);
}

// x: the parent's acceleration at this node's origin, with the bias. What continues outwards is
// what u_dot gives, to the last bit.
static spatial_lanes accelerate_several(const ld_mstmm *system, int i, spatial_lanes x,
                                        double *u_dot)
{
    const node *n = &system->node[i];
    const axis_record *record = system->axis + n->axis;
    double *to = u_dot + n->u;
    spatial_lanes own = {x.a, v4d_all(0)};
    if (n->hinge == NODE_FREE) {
        v4d H[3];
        hinge_axes(system, n, H);
        double rate[6];
        for (int k = 5; k >= 0; k--) {
            rate[k] = record[k].rate;
            for (int j = k + 1; j < 6; j++)
                rate[k] -= (j < 3 ? record[k].V_alpha[j] : record[k].V_a[j - 3]) * rate[j];
        }
        own.a = (v4d){rate[3], rate[4], rate[5], 0};
        own.alpha = (v4d){rate[0], rate[1], rate[2], 0};
        x.a += store_along(H, own.a - x.a, to);
        to += 3;
    } else {
        for (int k = 2; k >= 0; k--)
            own.alpha[k] = solve_axis(&record[k], own)[0];
    }
    x.alpha += store_along(system->motion[i].A, own.alpha - x.alpha, to);
    return x;
}

LD_OUTLINE void report_given(const ld_mstmm *system, const node *n, double *u_dot)
{
    for (int k = 0; k < node_speeds(n); k++)
        u_dot[n->u + k] = system->axis[n->axis + k].rate;
}

static spatial_lanes accelerate_section(const ld_mstmm *system, int i)
{
    const node_beam *b = &system->beam_of[i];
    m3 A_R = node_body_axes(system, system->node[i].parent);
    spatial x = spatial_turn(A_R, beam_output_acceleration(b->body, b->output));
    return (spatial_lanes){v4d_from_v3(x.linear), v4d_from_v3(x.angular)};
}

static void accelerate_beam(const ld_mstmm *system, int i, spatial_lanes x, double *u_dot)
{
    const node_beam *b = &system->beam_of[i];
    spatial x_I = {v4d_v3(x.a), v4d_v3(x.alpha)};
    beam_accelerate(b->body, spatial_turn_back(node_body_axes(system, i), x_I), u_dot + b->modes_u);
}

static void sweep_outwards(ld_mstmm *system, double *u_dot)
{
    const spatial_lanes base = {v4d_from_v3(system->base.linear),
                                v4d_from_v3(system->base.angular)};
    spatial_lanes x = base;
    for (int i = 1; i <= system->node_count; i++) {
        const node *n = &system->node[i];
        const node_motion *motion = &system->motion[i];
        if (n->body == NODE_SECTION) {
            x = accelerate_section(system, i);
        } else {
            if (!n->leads)
                x = n->parent ? system->branch_x[system->node[n->parent].branch] : base;
            v4d a = (x.a + v4d_cross(x.alpha, motion->r)) + motion->bias_a;
            v4d alpha = x.alpha + motion->bias_alpha;
            if (system->pass[i] == PASS_TURN) {
                v4d rate = solve_axis(&system->axis[n->axis], x);
                x = (spatial_lanes){a, alpha + motion->A[2] * rate};
                u_dot[n->u] = rate[0];
            } else if (system->pass[i] == PASS_SLIDE) {
                v4d rate = solve_axis(&system->axis[n->axis], x);
                x = (spatial_lanes){a + motion->A[2] * rate, alpha};
                u_dot[n->u] = rate[0];
            } else {
                x = (spatial_lanes){a, alpha};
                if (system->pass[i] == PASS_SEVERAL)
                    x = accelerate_several(system, i, x, u_dot);
                else if (system->pass[i] == PASS_GIVEN)
                    report_given(system, n, u_dot);
            }
            if (n->body == NODE_BEAM)
                accelerate_beam(system, i, x, u_dot);
        }
        if (n->branch >= 0)
            system->branch_x[n->branch] = x;
    }
}

#include "systems/multibody/loop_code.h"

const sweep SWEEP_NAME = {move, sweep_inwards, sweep_outwards, propagate, apply};
