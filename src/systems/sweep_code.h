// The reduced sweep (formulation.md, section 2): the Riccati form of the transfer equations. One
// sweep outwards gives the motion; from the tips inwards every cut gets F = Z [a; alpha] + zf; a
// last sweep outwards gives the accelerations. Gravity is the ground's acceleration -g.
//
// This is the text of sweep_default.c and, where the machine may have wider registers, of
// sweep_avx2.c compiled for these; each defines SWEEP_NAME.
#include <float.h>

#include "math/quaternion.h"
#include "math/sine_cosine.h"
#include "systems/multibody.h"

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
    m->bias_a = v4d_cross(parent->w, v4d_cross(parent->w, m->r) + 2 * slide);
    m->bias_alpha = v4d_cross(parent->w, spin);
}

static void move(ld_mstmm *system, const double *q, const double *u)
{
    // sines and cosines of all turns
    for (int k = 0; k < system->angle_count; k++)
        system->angle[k] = q[system->angle_q[k]];
    sine_cosine(system->angle_count, system->angle, system->sine, system->cosine);

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
        m->r = v4d_combine(parent->A, n->at.x, n->at.y, n->at.z);
        switch (n->hinge) {
        case NODE_TURN: {
            v4d sine = v4d_all(system->sine[n->angle]);
            v4d cosine = v4d_all(system->cosine[n->angle]);
            v4d spin = H[2] * v4d_all(u[n->u]);
            m->A[0] = H[0] * cosine + H[1] * sine;
            m->A[1] = H[1] * cosine - H[0] * sine;
            m->A[2] = H[2];
            m->w = w + spin;
            m->bias_a = v4d_cross(w, v4d_cross(w, m->r));
            m->bias_alpha = v4d_cross(w, spin);
            break;
        }
        case NODE_SLIDE:
        case NODE_WELD: {
            m->A[0] = H[0];
            m->A[1] = H[1];
            m->A[2] = H[2];
            m->w = w;
            v4d drift = v4d_all(0);
            if (n->hinge == NODE_SLIDE) {
                m->r += H[2] * v4d_all(q[n->q]);
                drift = H[2] * v4d_all(2 * u[n->u]);
            }
            m->bias_a = v4d_cross(w, v4d_cross(w, m->r) + drift);
            m->bias_alpha = v4d_all(0);
            break;
        }
        default:
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
    for (int j = 0; j < 3; j++) {
        s->A[j] += t->A[j];
        s->T[j] += t->T[j];
        s->B[j] += t->B[j];
        s->C[j] += t->C[j];
    }
    s->f += t->f;
    s->m += t->m;
}

// A rigid body's own share added: M x + (w x (w x m c), w x J w), M = [m E, -m ~c; m ~c, J].
LD_INLINE void add_rigid_body(share *s, const node_inertia *body, const node_motion *motion)
{
    const v4d *A = motion->A;
    const v3 *c = &body->moment;
    const sym3 *I = &body->inertia;
    v4d w = motion->w, mc = v4d_combine(A, c->x, c->y, c->z);

    // J = A I A^T by columns
    v4d H[3] = {v4d_combine(A, I->xx, I->xy, I->xz), v4d_combine(A, I->xy, I->yy, I->yz),
                v4d_combine(A, I->xz, I->yz, I->zz)};
    v4d J[3];
    for (int i = 0; i < 3; i++)
        J[i] = v4d_combine(H, A[0][i], A[1][i], A[2][i]);

    // -m ~c by columns
    v4d skew[3] = {__builtin_shufflevector(mc, mc, 3, 2, 1, 3) * (v4d){0, -1, 1, 0},
                   __builtin_shufflevector(mc, mc, 2, 3, 0, 3) * (v4d){1, 0, -1, 0},
                   __builtin_shufflevector(mc, mc, 1, 0, 3, 3) * (v4d){-1, 1, 0, 0}};
    double m = body->mass;
    s->A[0] += (v4d){m, 0, 0, 0};
    s->A[1] += (v4d){0, m, 0, 0};
    s->A[2] += (v4d){0, 0, m, 0};
    for (int j = 0; j < 3; j++) {
        s->B[j] += skew[j];
        s->T[j] -= skew[j];
        s->C[j] += J[j];
    }
    s->f += v4d_cross(w, v4d_cross(w, mc));
    s->m += v4d_cross(w, v4d_combine(J, w[0], w[1], w[2]));
}

// U = Z e of a turn or a slide along e.
LD_INLINE spatial_lanes along_turn(const share *s, v4d e)
{
    return (spatial_lanes){v4d_combine(s->B, e[0], e[1], e[2]),
                           v4d_combine(s->C, e[0], e[1], e[2])};
}

LD_INLINE spatial_lanes along_slide(const share *s, v4d e)
{
    return (spatial_lanes){v4d_combine(s->A, e[0], e[1], e[2]),
                           v4d_combine(s->T, e[0], e[1], e[2])};
}

// A single axis e of a hinge is eliminated: with U = Z e, D = e . U, its row e . F = tau gives
// u_dot = rate - V . (acceleration without it).
LD_INLINE void record_axis(axis_record *record, spatial_lanes U, double inverse, double rate)
{
    record->V_a = U.a * v4d_all(inverse);
    record->V_alpha = U.alpha * v4d_all(inverse);
    record->rate = rate;
}

// What the eliminated axis leaves: Z - U U^T/D, zf + U rate. Both triangles get the same bits.
LD_INLINE void release_axis(share *s, spatial_lanes U, double inverse, double rate)
{
    v4d scale = v4d_all(inverse);
    for (int j = 0; j < 3; j++) {
        v4d a = v4d_all(U.a[j]), alpha = v4d_all(U.alpha[j]);
        s->A[j] -= U.a * a * scale;
        s->T[j] -= U.alpha * a * scale;
        s->B[j] -= U.a * alpha * scale;
        s->C[j] -= U.alpha * alpha * scale;
    }
    s->f += U.a * v4d_all(rate);
    s->m += U.alpha * v4d_all(rate);
}

LD_INLINE double trace(const v4d column[3])
{
    return column[0][0] + column[1][1] + column[2][2];
}

// Whether D vanishes against what Z resists along all axes of its kind.
LD_INLINE int is_singular(double D, double all)
{
    return !(D > 4 * DBL_EPSILON * all);
}

// All axes of a ball or of a free hinge, the last one first. Nothing passes a free hinge but its
// drive.
static int eliminate_several(ld_mstmm *system, int i, share *s, const double *tau)
{
    const node *n = &system->node[i];
    v4d H[3];
    int slides = n->hinge == NODE_FREE ? 3 : 0, singular = 0;
    if (slides)
        hinge_axes(system, n, H);
    double all_turns = trace(s->C), all_slides = trace(s->A);
    for (int k = slides + 2; k >= 0; k--) {
        bool turn = k >= slides;
        v4d e = turn ? system->motion[i].A[k - slides] : H[k];
        spatial_lanes U = turn ? along_turn(s, e) : along_slide(s, e);
        double D = v4d_dot3(e, turn ? U.alpha : U.a);
        singular |= is_singular(D, turn ? all_turns : all_slides);
        double force = tau[n->u + k] - v4d_dot3(e, turn ? s->m : s->f);
        record_axis(system->axis + n->axis + k, U, 1 / D, force / D);
        release_axis(s, U, 1 / D, force / D);
    }
    for (int j = 0; slides && j < 3; j++)
        s->A[j] = s->T[j] = s->B[j] = s->C[j] = v4d_all(0);
    return singular;
}

// The upper triangle from the lower one.
LD_INLINE void mirror(v4d C[3])
{
    C[1] = __builtin_shufflevector(C[0], C[1], 1, 5, 6, 7);
    v4d last = __builtin_shufflevector(C[0], C[1], 2, 6, 2, 6);
    C[2] = __builtin_shufflevector(last, C[2], 0, 1, 6, 7);
}

// To the parent's origin: T^T Z T with T = [E, -~r; 0, E], T^T zf.
LD_INLINE void shift(share *s, v4d r)
{
    v4d x = v4d_all(r[0]), y = v4d_all(r[1]), z = v4d_all(r[2]);
    s->B[0] += s->A[2] * y - s->A[1] * z;
    s->B[1] += s->A[0] * z - s->A[2] * x;
    s->B[2] += s->A[1] * x - s->A[0] * y;
    s->C[0] += s->T[2] * y - s->T[1] * z;
    s->C[1] += s->T[0] * z - s->T[2] * x;
    s->C[2] += s->T[1] * x - s->T[0] * y;
    for (int j = 0; j < 3; j++) {
        s->T[j] += v4d_cross(r, s->A[j]);
        s->C[j] += v4d_cross(r, s->B[j]);
    }
    s->m += v4d_cross(r, s->f);
    mirror(s->C);
}

// zf counts from the parent's motion alone: + Z bias.
LD_INLINE void add_bias(share *s, v4d a, v4d alpha)
{
    s->f += v4d_combine(s->A, a[0], a[1], a[2]) + v4d_combine(s->B, alpha[0], alpha[1], alpha[2]);
    s->m += v4d_combine(s->T, a[0], a[1], a[2]) + v4d_combine(s->C, alpha[0], alpha[1], alpha[2]);
}

// A hinge with one axis: the share goes to the parent's origin first and the axis is eliminated
// there, so that the division waits for nothing; V then belongs to the parent's acceleration. The
// ground needs no share. U = Z e; D, all: Z's resistance along e and along all axes of its kind;
// force: along e, without that of the bias.
LD_INLINE int pass_axis(share *s, axis_record *record, const node_motion *motion, spatial_lanes U,
                        double D, double all, double force, bool onward)
{
    double inverse = 1 / D;
    force -= v4d_sum3(U.a * motion->bias_a + U.alpha * motion->bias_alpha);
    if (onward) {
        add_bias(s, motion->bias_a, motion->bias_alpha);
        shift(s, motion->r);
    }
    U.alpha += v4d_cross(motion->r, U.a);
    record_axis(record, U, inverse, force * inverse);
    if (onward)
        release_axis(s, U, inverse, force * inverse);
    return is_singular(D, all);
}

LD_INLINE int pass_turn(share *s, axis_record *record, const node_motion *motion, double tau,
                        bool onward)
{
    v4d e = motion->A[2];
    spatial_lanes U = along_turn(s, e);
    return pass_axis(s, record, motion, U, v4d_dot3(e, U.alpha), trace(s->C),
                     tau - v4d_dot3(e, s->m), onward);
}

LD_INLINE int pass_slide(share *s, axis_record *record, const node_motion *motion, double tau,
                         bool onward)
{
    v4d e = motion->A[2];
    spatial_lanes U = along_slide(s, e);
    return pass_axis(s, record, motion, U, v4d_dot3(e, U.a), trace(s->A), tau - v4d_dot3(e, s->f),
                     onward);
}

static spatial_matrix share_matrix(const share *s)
{
    return (spatial_matrix){sym3_of(v4d_m3(s->A)), v4d_m3(s->B), sym3_of(v4d_m3(s->C))};
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
    if (beam_reduce(b->body, tau + b->modes_u, &Z_R, &zf))
        return 1;
    Z = spatial_matrix_turn(A_R, &Z_R);
    zf = spatial_turn(A_R, zf);
    v4d_store_m3(s->A, sym3_full(Z.A));
    v4d_store_m3(s->T, m3_transpose(Z.B));
    v4d_store_m3(s->B, Z.B);
    v4d_store_m3(s->C, sym3_full(Z.C));
    s->f = v4d_from_v3(zf.linear);
    s->m = v4d_from_v3(zf.angular);
    return 0;
}

static int inwards(ld_mstmm *system, const double *tau, const double *wrench)
{
    static const share nothing;
    share s = nothing;
    for (int k = 0; k < system->branch_count; k++)
        system->branch[k] = nothing;
    for (int i = system->node_count; i >= 1; i--) {
        const node *n = &system->node[i];
        const node_motion *motion = &system->motion[i];
        int singular = 0;
        if (n->branch >= 0)
            add_share(&s, &system->branch[n->branch]);

        // the body
        if (n->body == NODE_RIGID) {
            add_rigid_body(&s, &system->inertia[i], motion);
        } else if (n->body == NODE_BEAM) {
            singular = reduce_beam(system, i, tau, &s);
        } else {
            load_beam(system, i, &s);
            s = nothing;
            continue;
        }
        if (wrench && n->element >= 0) {
            s.f -= v4d_from_v3(v3_from(wrench + 6 * n->element));
            s.m -= v4d_from_v3(v3_from(wrench + 6 * n->element + 3));
        }

        // its hinge, and on to the parent
        if (n->hinge == NODE_TURN) {
            singular |= pass_turn(&s, &system->axis[n->axis], motion, tau[n->u], n->parent > 0);
        } else if (n->hinge == NODE_SLIDE) {
            singular |= pass_slide(&s, &system->axis[n->axis], motion, tau[n->u], n->parent > 0);
        } else {
            add_bias(&s, motion->bias_a, motion->bias_alpha);
            if (n->hinge != NODE_WELD)
                singular |= eliminate_several(system, i, &s, tau);
            shift(&s, motion->r);
        }
        if (singular)
            return i;
        if (!n->leads) {
            int branch = system->node[n->parent].branch;
            if (branch >= 0)
                add_share(&system->branch[branch], &s);
            s = nothing;
        }
    }
    return 0;
}

// ---- outwards

LD_INLINE double solve_axis(const axis_record *record, spatial_lanes x)
{
    return record->rate - v4d_sum3(record->V_a * x.a + record->V_alpha * x.alpha);
}

static spatial_lanes accelerate_several(const ld_mstmm *system, int i, spatial_lanes x,
                                        double *u_dot)
{
    const node *n = &system->node[i];
    const axis_record *record = system->axis + n->axis;
    int slides = n->hinge == NODE_FREE ? 3 : 0;
    if (slides) {
        v4d H[3];
        hinge_axes(system, n, H);
        for (int k = 0; k < 3; k++) {
            u_dot[n->u + k] = solve_axis(record + k, x);
            x.a += H[k] * v4d_all(u_dot[n->u + k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        u_dot[n->u + slides + k] = solve_axis(record + slides + k, x);
        x.alpha += system->motion[i].A[k] * v4d_all(u_dot[n->u + slides + k]);
    }
    return x;
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

static void outwards(ld_mstmm *system, double *u_dot)
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
            v4d carried = v4d_cross(x.alpha, motion->r);
            if (n->hinge == NODE_TURN) {
                double rate = solve_axis(&system->axis[n->axis], x);
                x.alpha += motion->A[2] * v4d_all(rate);
                x.a += carried;
                u_dot[n->u] = rate;
            } else if (n->hinge == NODE_SLIDE) {
                double rate = solve_axis(&system->axis[n->axis], x);
                x.a += carried + motion->A[2] * v4d_all(rate);
                u_dot[n->u] = rate;
            } else {
                x.a += carried;
                if (n->hinge != NODE_WELD)
                    x = accelerate_several(system, i, x, u_dot);
            }
            x.a += motion->bias_a;
            x.alpha += motion->bias_alpha;
            if (n->body == NODE_BEAM)
                accelerate_beam(system, i, x, u_dot);
        }
        if (n->branch >= 0)
            system->branch_x[n->branch] = x;
    }
}

const sweep SWEEP_NAME = {move, inwards, outwards};
