// The reduced sweep (formulation.md, section 2): the Riccati form of the transfer equations. From
// the tips inwards every cut gets F = Z [a; alpha] + zf, then one sweep outwards gives the
// accelerations. Gravity is the ground's acceleration -g.
#include <float.h>
#include <string.h>

#include "systems/multibody.h"

// What a subtree exerts at a cut: F = Z x + zf.
typedef struct share {
    spatial_matrix Z;
    spatial zf;
} share;

// A single axis e = [0; turn] (or [slide; 0]) is eliminated: its row e . F = tau gives
// u_dot = rate - V . (acceleration without it), what is left passes on. Returns 0, or 1 where
// e . Z e vanishes against Z: nothing resists along the axis.
LD_INLINE int eliminate(share *s, axis_record *record, spatial U, double D, double scale,
                        double along, double tau)
{
    double inverse = 1 / D;
    double rate = (tau - along) * inverse;
    spatial V = {v3_scale(inverse, U.linear), v3_scale(inverse, U.angular)};
    record->V = V;
    record->rate = rate;
    spatial_matrix_less(&s->Z, U, V);
    s->zf = spatial_axpy(s->zf, rate, U);
    return !(D > 4 * DBL_EPSILON * scale);
}

LD_INLINE int eliminate_turn(share *s, axis_record *record, v3 e, double tau)
{
    spatial U = {m3_apply(s->Z.B, e), sym3_apply(s->Z.C, e)};
    return eliminate(s, record, U, v3_dot(e, U.angular), sym3_trace(s->Z.C),
                     v3_dot(e, s->zf.angular), tau);
}

LD_INLINE int eliminate_slide(share *s, axis_record *record, v3 e, double tau)
{
    spatial U = {sym3_apply(s->Z.A, e), m3_apply_transposed(s->Z.B, e)};
    return eliminate(s, record, U, v3_dot(e, U.linear), sym3_trace(s->Z.A), v3_dot(e, s->zf.linear),
                     tau);
}

// A rigid body's own share added: M x + (w x (w x m c), w x J w).
LD_INLINE void add_rigid_body(share *s, const node_inertia *body, const node_motion *motion)
{
    double m = body->mass;
    v3 w = motion->w, mc = m3_apply(motion->A, body->moment);
    sym3 J = sym3_turn(motion->A, body->inertia);
    s->Z.A.xx += m;
    s->Z.A.yy += m;
    s->Z.A.zz += m;
    s->Z.B.a[0][1] += mc.z;
    s->Z.B.a[0][2] -= mc.y;
    s->Z.B.a[1][0] -= mc.z;
    s->Z.B.a[1][2] += mc.x;
    s->Z.B.a[2][0] += mc.y;
    s->Z.B.a[2][1] -= mc.x;
    s->Z.C = sym3_add(s->Z.C, J);
    s->zf.linear = v3_add(s->zf.linear, v3_cross(w, v3_cross(w, mc)));
    s->zf.angular = v3_add(s->zf.angular, v3_cross(w, sym3_apply(J, w)));
}

// What hangs on a section loads the beam.
static void load_beam(ld_mstmm *system, int i, const share *s)
{
    m3 A_R = node_body_axes(system, system->node[i].parent), back = m3_transpose(A_R);
    spatial_matrix Z = spatial_matrix_turn(back, &s->Z);
    const node_beam *b = &system->beam_of[i];
    beam_load(b->body, b->output, &Z, spatial_turn(back, s->zf));
}

// The beam's share at its input end, its sections' loads included. Returns 0 or 1: singular.
static int reduce_beam(ld_mstmm *system, int i, const double *tau, share *s)
{
    m3 A_R = node_body_axes(system, i);
    const node_beam *b = &system->beam_of[i];
    spatial_matrix Z;
    spatial zf;
    if (beam_reduce(b->body, tau + b->modes_u, &Z, &zf))
        return 1;
    s->Z = spatial_matrix_turn(A_R, &Z);
    s->zf = spatial_turn(A_R, zf);
    return 0;
}

// All axes of a ball or of a free hinge, the last one first.
static int eliminate_several(ld_mstmm *system, int i, share *s, const double *tau)
{
    const node *n = &system->node[i];
    axis_record *record = system->axis + n->axis;
    m3 A = system->motion[i].A;
    int slides = n->hinge == NODE_FREE ? 3 : 0, singular = 0;
    for (int k = 2; k >= 0; k--)
        singular |= eliminate_turn(s, record + slides + k, m3_column(A, k), tau[n->u + slides + k]);
    if (slides) {
        m3 H = node_hinge_axes(system, n);
        for (int k = 2; k >= 0; k--)
            singular |= eliminate_slide(s, record + k, m3_column(H, k), tau[n->u + k]);
        memset(&s->Z, 0, sizeof s->Z);
    }
    return singular;
}

// From the tips inwards. Returns 0, or the node whose hinge is singular.
static int sweep_inwards(ld_mstmm *system, const double *tau, const double *wrench)
{
    static const share nothing;
    share s = nothing;
    for (int k = 0; k < system->branch_count; k++) {
        system->branch_Z[k] = nothing.Z;
        system->branch_zf[k] = nothing.zf;
    }
    for (int i = system->node_count; i >= 1; i--) {
        const node *n = &system->node[i];
        const node_motion *motion = &system->motion[i];
        if (n->branch >= 0) {
            spatial_matrix_add(&s.Z, &system->branch_Z[n->branch]);
            s.zf = spatial_add(s.zf, system->branch_zf[n->branch]);
        }

        // the body
        int singular = 0;
        if (n->body == NODE_RIGID)
            add_rigid_body(&s, &system->inertia[i], motion);
        else if (n->body == NODE_BEAM)
            singular = reduce_beam(system, i, tau, &s);
        else {
            load_beam(system, i, &s);
            s = nothing;
            continue;
        }
        if (wrench && n->element >= 0) {
            const double *F = wrench + 6 * n->element;
            s.zf.linear = v3_sub(s.zf.linear, v3_from(F));
            s.zf.angular = v3_sub(s.zf.angular, v3_from(F + 3));
        }

        // its hinge; from here zf belongs to the acceleration T x of the parent's motion alone
        s.zf = spatial_add(s.zf, spatial_apply(&s.Z, motion->bias));
        switch (n->hinge) {
        case NODE_TURN:
            singular |=
                eliminate_turn(&s, &system->axis[n->axis], m3_column(motion->A, 2), tau[n->u]);
            break;
        case NODE_SLIDE:
            singular |=
                eliminate_slide(&s, &system->axis[n->axis], m3_column(motion->A, 2), tau[n->u]);
            break;
        case NODE_WELD:
            break;
        default:
            singular |= eliminate_several(system, i, &s, tau);
        }
        if (singular)
            return i;

        // to the parent
        spatial_matrix_shift(motion->r, &s.Z);
        s.zf = wrench_shift(motion->r, s.zf);
        if (!n->leads) {
            int branch = system->node[n->parent].branch;
            if (branch >= 0) {
                spatial_matrix_add(&system->branch_Z[branch], &s.Z);
                system->branch_zf[branch] = spatial_add(system->branch_zf[branch], s.zf);
            }
            s = nothing;
        }
    }
    return 0;
}

LD_INLINE double solve_axis(const axis_record *record, spatial x)
{
    return record->rate - spatial_dot(record->V, x);
}

static spatial accelerate_several(const ld_mstmm *system, int i, spatial x, double *u_dot)
{
    const node *n = &system->node[i];
    const axis_record *record = system->axis + n->axis;
    m3 A = system->motion[i].A;
    int slides = n->hinge == NODE_FREE ? 3 : 0;
    if (slides) {
        m3 H = node_hinge_axes(system, n);
        for (int k = 0; k < 3; k++) {
            u_dot[n->u + k] = solve_axis(record + k, x);
            x.linear = v3_axpy(x.linear, u_dot[n->u + k], m3_column(H, k));
        }
    }
    for (int k = 0; k < 3; k++) {
        u_dot[n->u + slides + k] = solve_axis(record + slides + k, x);
        x.angular = v3_axpy(x.angular, u_dot[n->u + slides + k], m3_column(A, k));
    }
    return x;
}

static spatial accelerate_section(const ld_mstmm *system, int i)
{
    const node_beam *b = &system->beam_of[i];
    m3 A_R = node_body_axes(system, system->node[i].parent);
    return spatial_turn(A_R, beam_output_acceleration(b->body, b->output));
}

// Outwards from the ground.
static void sweep_outwards(ld_mstmm *system, double *u_dot)
{
    spatial x = system->base;
    for (int i = 1; i <= system->node_count; i++) {
        const node *n = &system->node[i];
        const node_motion *motion = &system->motion[i];
        if (n->body == NODE_SECTION) {
            x = accelerate_section(system, i);
        } else {
            if (!n->leads)
                x = n->parent ? system->branch_x[system->node[n->parent].branch] : system->base;
            x = spatial_shift(motion->r, x);
            switch (n->hinge) {
            case NODE_TURN:
                u_dot[n->u] = solve_axis(&system->axis[n->axis], x);
                x.angular = v3_axpy(x.angular, u_dot[n->u], m3_column(motion->A, 2));
                break;
            case NODE_SLIDE:
                u_dot[n->u] = solve_axis(&system->axis[n->axis], x);
                x.linear = v3_axpy(x.linear, u_dot[n->u], m3_column(motion->A, 2));
                break;
            case NODE_WELD:
                break;
            default:
                x = accelerate_several(system, i, x, u_dot);
            }
            x = spatial_add(x, motion->bias);
            if (n->body == NODE_BEAM) {
                const node_beam *b = &system->beam_of[i];
                beam_accelerate(b->body, spatial_turn_back(node_body_axes(system, i), x),
                                u_dot + b->modes_u);
            }
        }
        if (n->branch >= 0)
            system->branch_x[n->branch] = x;
    }
}

ld_status ld_mstmm_accelerations(ld_mstmm *system, const double *q, const double *u,
                                 const double *tau, const double *wrench, double *u_dot,
                                 ld_error *error)
{
    tau = multibody_hinge_forces(system, q, u, tau);
    multibody_move(system, q, u);
    int singular = sweep_inwards(system, tau, wrench);
    if (singular)
        return multibody_singular(system, singular, error);
    sweep_outwards(system, u_dot);
    return LD_OK;
}
