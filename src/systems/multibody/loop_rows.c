#include "systems/multibody/loop_rows.h"

#include <string.h>

#include "math/vectors/rotation_vector.h"
#include "systems/multibody/description.h"

// ---- the sides

void loop_sides(const ld_mstmm *system, const loop *l, loop_side side[2])
{
    for (int s = 0; s < 2; s++) {
        const loop_end *end = &l->end[s];
        const m3 A = node_axes(system, end->node);
        const spatial *place = &system->place[end->node];
        loop_side *out = &side[s];
        out->origin = place->linear;
        out->arm = m3_apply(A, end->at);
        out->position = v3_add(out->origin, out->arm);
        out->w = v4d_v3(system->motion[end->node].w);
        out->velocity = v3_add(place->angular, v3_cross(out->w, out->arm));
        out->frame = m3_mul(A, end->frame);
    }
}

void loops_place(ld_mstmm *system, const double *u)
{
    system->place[0] = (spatial){v3_zero(), v3_zero()};
    for (int k = 0; k < system->loop_node_count; k++)
        multibody_place_node(system, system->loop_node[k], u);
}

// ---- rows

// What a row is made from.
typedef struct row_input {
    const loop_side *side; // both
    const loop *l;
    const loop_row *row;
    v3 apart; // from the first point to the second
} row_input;

// Force along e at the second point: with d from the first point to the second, the row is e . d;
// e is fixed on the first side, on which the force acts at the second point likewise.
static void make_translation(const row_input *in, loop_purpose purpose, loop_work *w, int a)
{
    const loop_side *first = in->side, *second = in->side + 1;
    const v3 e = m3_column(first->frame, in->row->first), d = in->apart;
    const v3 arm = v3_add(first->arm, d), drift = v3_cross(first->w, e);
    const v3 relative = v3_sub(second->velocity, first->velocity);
    w->unit[0][a] = (spatial_lanes){v4d_from_v3(v3_neg(e)), v4d_from_v3(v3_neg(v3_cross(arm, e)))};
    w->unit[1][a] = (spatial_lanes){v4d_from_v3(e), v4d_from_v3(v3_cross(second->arm, e))};
    if (purpose == LOOPS_ACCELERATIONS) {
        v3 inward = v3_sub(v3_cross(second->w, v3_cross(second->w, second->arm)),
                           v3_cross(first->w, v3_cross(first->w, first->arm)));
        w->gap[a] =
            v3_dot(e, inward) + v3_dot(v3_cross(first->w, drift), d) + 2 * v3_dot(drift, relative);
    } else {
        w->gap[a] = purpose == LOOPS_SPEEDS ? v3_dot(drift, d) + v3_dot(e, relative) : v3_dot(e, d);
    }
}

// Moment along b x a: the row is a . b - cosine, a fixed on the first side, b on the second.
static void make_rotation(const row_input *in, loop_purpose purpose, loop_work *w, int k)
{
    const loop_side *first = in->side, *second = in->side + 1;
    const v3 a = m3_column(first->frame, in->row->first);
    const v3 b = m3_column(second->frame, in->row->second), n = v3_cross(b, a);
    const v4d none = v4d_all(0);
    w->unit[0][k] = (spatial_lanes){none, v4d_from_v3(v3_neg(n))};
    w->unit[1][k] = (spatial_lanes){none, v4d_from_v3(n)};
    const v3 a_dot = v3_cross(first->w, a), b_dot = v3_cross(second->w, b);
    if (purpose == LOOPS_ACCELERATIONS)
        w->gap[k] = v3_dot(v3_cross(first->w, a_dot), b) + 2 * v3_dot(a_dot, b_dot) +
                    v3_dot(a, v3_cross(second->w, b_dot));
    else if (purpose == LOOPS_SPEEDS)
        w->gap[k] = v3_dot(n, v3_sub(second->w, first->w));
    else
        w->gap[k] = v3_dot(a, b) - in->row->cosine;
}

// The rotation that takes what must coincide on the first side to what stands on the second, in the
// first frame's axes.
static v3 turned_by(const loop *l, const loop_side side[2])
{
    const m3 T = m3_mul(m3_transpose(side[0].frame), side[1].frame);
    if (l->given.joint == LD_HINGE_WELD || l->given.joint == LD_HINGE_PRISMATIC)
        return rv_log(T);
    // e_z x T e_z
    v3 z = m3_column(T, 2), axis = v3_make(-z.y, z.x, 0);
    double sine = v3_norm(axis), angle = atan2(sine, z.z);
    return sine > 0 ? v3_scale(angle / sine, axis) : v3_make(angle, 0, 0);
}

// From any attitude: moments along the first frame's axes, or along b x a of a universal joint,
// gaps as angles.
static void make_far_rotation(const row_input *in, loop_work *w, int k)
{
    const loop_side *first = in->side, *second = in->side + 1;
    const int i = in->row->first, j = in->row->second;
    const v4d none = v4d_all(0);
    v3 n;
    if (i == j) {
        v3 a = m3_column(first->frame, i), b = m3_column(second->frame, j);
        n = v3_cross(b, a);
        double sine = v3_norm(n);
        w->gap[k] = in->l->psi - atan2(sine, v3_dot(a, b));
        n = sine > 0 ? v3_scale(1 / sine, n) : m3_column(first->frame, 0);
    } else {
        // b_j x a_i = +- the third axis where the frames coincide
        v3 turn = turned_by(in->l, in->side);
        const int third = 3 - i - j;
        const double sign = (j + 1) % 3 == i ? 1 : -1;
        const double part[3] = {turn.x, turn.y, turn.z};
        n = v3_scale(sign, m3_column(first->frame, third));
        w->gap[k] = sign * part[third];
    }
    w->unit[0][k] = (spatial_lanes){none, v4d_from_v3(v3_neg(n))};
    w->unit[1][k] = (spatial_lanes){none, v4d_from_v3(n)};
}

void loops_make_rows(ld_mstmm *system, loop_purpose purpose)
{
    for (int index = 0; index < system->loop_count; index++) {
        const loop *l = &system->loop[index];
        loop_work *w = &system->loop_work[index];
        loop_side side[2];
        loop_sides(system, l, side);
        row_input in = {side, l, NULL, v3_sub(side[1].position, side[0].position)};
        for (int a = 0; a < w->active; a++) {
            in.row = &l->row[w->active_row[a]];
            if (!in.row->turns)
                make_translation(&in, purpose, w, a);
            else if (purpose == LOOPS_FAR)
                make_far_rotation(&in, w, a);
            else
                make_rotation(&in, purpose, w, a);
        }
    }
}

void loop_opening(const ld_mstmm *system, const loop *l, double *distance, double *angle)
{
    loop_side side[2];
    loop_sides(system, l, side);
    v3 d = v3_sub(side[1].position, side[0].position);
    double sum = 0;
    bool turns = false;
    for (int r = 0; r < l->row_count; r++) {
        double along = v3_dot(d, m3_column(side[0].frame, l->row[r].first));
        sum += l->row[r].turns ? 0 : along * along;
        turns |= l->row[r].turns;
    }
    *distance = sqrt(sum);
    if (!turns) {
        *angle = 0;
    } else if (l->given.joint == LD_HINGE_UNIVERSAL) {
        v3 a = m3_column(side[0].frame, 2), b = m3_column(side[1].frame, 2);
        *angle = fabs(atan2(v3_norm(v3_cross(a, b)), v3_dot(a, b)) - l->psi);
    } else {
        *angle = v3_norm(turned_by(l, side));
    }
}

// ---- coordinates, speeds and forces of the joints

// Angle about z that turns the first frame to the second one.
static double angle_about_z(m3 T)
{
    return atan2(T.a[1][0] - T.a[0][1], T.a[0][0] + T.a[1][1]);
}

// Angle about the unit vector `axis` from one vector to another.
static double angle_about(v3 axis, v3 from, v3 to)
{
    double sine = v3_dot(axis, v3_cross(from, to));
    return atan2(sine, v3_dot(from, to) - v3_dot(axis, from) * v3_dot(axis, to));
}

// The joint's coordinates and speeds in the order of a hinge's.
static void joint_state(const loop *l, const loop_side side[2], double *x, double *x_dot)
{
    const m3 E = side[0].frame, T = m3_mul(m3_transpose(E), side[1].frame);
    const v3 apart = v3_sub(side[1].position, side[0].position);
    const v3 d = m3_apply_transposed(E, apart);
    const v3 spin = v3_sub(side[1].w, side[0].w), w = m3_apply_transposed(E, spin);
    const v3 v = m3_apply_transposed(
        E, v3_sub(v3_sub(side[1].velocity, side[0].velocity), v3_cross(side[0].w, apart)));
    // the second joint frame in the first one, as the description has them
    const m3 R = m3_mul(l->axes[0], m3_mul(T, m3_transpose(l->axes[1])));
    const v3 a = m3_column(l->axes[0], 2), b = m3_column(l->axes[1], 2), b_now = m3_column(T, 2);
    switch (l->given.joint) {
    case LD_HINGE_REVOLUTE:
        x[0] = angle_about_z(T);
        x_dot[0] = w.z;
        break;
    case LD_HINGE_CYLINDRICAL:
        x[1] = angle_about_z(T);
        x_dot[1] = w.z;
        x[0] = d.z;
        x_dot[0] = v.z;
        break;
    case LD_HINGE_PRISMATIC:
        x[0] = d.z;
        x_dot[0] = v.z;
        break;
    case LD_HINGE_PLANAR:
        x[0] = d.x;
        x[1] = d.y;
        x[2] = angle_about_z(T);
        x_dot[0] = v.x;
        x_dot[1] = v.y;
        x_dot[2] = w.z;
        break;
    case LD_HINGE_UNIVERSAL: {
        double c = v3_dot(a, b), along = v3_dot(w, b_now);
        x[0] = angle_about(a, b, m3_apply(R, b));
        x[1] = -angle_about(b, a, m3_apply_transposed(R, a));
        x_dot[0] = (w.z - c * along) / (1 - c * c);
        x_dot[1] = (along - c * w.z) / (1 - c * c);
        break;
    }
    case LD_HINGE_SPHERICAL: {
        quat q = q_from_matrix(R);
        x[0] = q.w;
        x[1] = q.x;
        x[2] = q.y;
        x[3] = q.z;
        v3_store(x_dot, m3_apply(l->axes[1], m3_apply_transposed(side[1].frame, spin)));
        break;
    }
    case LD_HINGE_WELD:
    case LD_HINGE_FREE:
        break;
    }
}

// Force and moment about the second point, on the second side, of forces along the joint's speeds.
static spatial joint_wrench(const loop *l, const loop_side side[2], const double *tau)
{
    const v3 x = m3_column(side[0].frame, 0), y = m3_column(side[0].frame, 1);
    const v3 z = m3_column(side[0].frame, 2), b = m3_column(side[1].frame, 2);
    spatial F = {v3_zero(), v3_zero()};
    switch (l->given.joint) {
    case LD_HINGE_REVOLUTE:
        F.angular = v3_scale(tau[0], z);
        break;
    case LD_HINGE_CYLINDRICAL:
        F.linear = v3_scale(tau[0], z);
        F.angular = v3_scale(tau[1], z);
        break;
    case LD_HINGE_PRISMATIC:
        F.linear = v3_scale(tau[0], z);
        break;
    case LD_HINGE_PLANAR:
        F.linear = v3_axpy(v3_scale(tau[0], x), tau[1], y);
        F.angular = v3_scale(tau[2], z);
        break;
    case LD_HINGE_UNIVERSAL: {
        // m . z = tau_0, m . b = tau_1
        double c = v3_dot(z, b), n = 1 / (1 - c * c);
        F.angular = v3_axpy(v3_scale(n * (tau[0] - c * tau[1]), z), n * (tau[1] - c * tau[0]), b);
        break;
    }
    case LD_HINGE_SPHERICAL:
        F.angular = m3_apply(side[1].frame, m3_apply_transposed(l->axes[1], v3_from(tau)));
        break;
    case LD_HINGE_WELD:
    case LD_HINGE_FREE:
        break;
    }
    return F;
}

// The joint's wrench on both sides' loads.
static void add_pair(const ld_mstmm *system, const loop *l, const loop_side side[2], spatial F,
                     double *wrench)
{
    for (int s = 0; s < 2; s++) {
        const int load = system->node[l->end[s].node].load;
        if (load < 0)
            continue;
        const double sign = s == 0 ? -1 : 1;
        v3 arm = v3_sub(side[1].position, side[s].origin);
        v3 m = v3_add(F.angular, v3_cross(arm, F.linear));
        double *to = wrench + 6 * load;
        v3_store(to, v3_axpy(v3_from(to), sign, F.linear));
        v3_store(to + 3, v3_axpy(v3_from(to + 3), sign, m));
    }
}

// The wrench of the springs in a joint.
static spatial spring_wrench(const loop *l, const loop_side side[2])
{
    double x[7] = {0}, x_dot[6] = {0}, tau[6] = {0};
    joint_state(l, side, x, x_dot);
    for (int k = 0; k < hinge_table[l->given.joint].speeds; k++) {
        tau[k] = -l->given.damping[k] * x_dot[k];
        if (l->given.joint != LD_HINGE_SPHERICAL)
            tau[k] -= l->given.stiffness[k] * (x[k] - (k < 2 ? l->given.rest[k] : 0));
    }
    if (l->given.joint == LD_HINGE_SPHERICAL)
        v3_store(tau, v3_add(v3_from(tau), multibody_ball_spring(q_from(x), l->given.stiffness)));
    return joint_wrench(l, side, tau);
}

static void copy_wrenches(ld_mstmm *system, const double *wrench)
{
    memset(system->applied, 0, 6 * (size_t)system->load_count * sizeof *system->applied);
    if (wrench)
        memcpy(system->applied, wrench, 6 * (size_t)system->element_count * sizeof *wrench);
}

const double *loops_load(ld_mstmm *system, const double *wrench)
{
    if (!system->loop_loads && (!wrench || system->load_count == system->element_count))
        return wrench;
    copy_wrenches(system, wrench);
    for (int i = 0; i < system->loop_count; i++) {
        const loop *l = &system->loop[i];
        loop_side side[2];
        if (!l->has_springs)
            continue;
        loop_sides(system, l, side);
        system->loop_work[i].spring = spring_wrench(l, side);
        add_pair(system, l, side, system->loop_work[i].spring, system->applied);
    }
    return system->applied;
}

const double *loops_load_all(ld_mstmm *system, const double *wrench)
{
    copy_wrenches(system, wrench);
    for (int i = 0; i < system->loop_count; i++) {
        loop_side side[2];
        loop_sides(system, &system->loop[i], side);
        add_pair(system, &system->loop[i], side, system->loop_work[i].reaction, system->applied);
    }
    return system->applied;
}

double loops_energy(const ld_mstmm *system)
{
    double sum = 0;
    for (int i = 0; i < system->loop_count; i++) {
        const loop *l = &system->loop[i];
        const double *k = l->given.stiffness;
        if (!l->has_springs)
            continue;
        loop_side side[2];
        double x[7] = {0}, x_dot[6] = {0};
        loop_sides(system, l, side);
        joint_state(l, side, x, x_dot);
        if (l->given.joint == LD_HINGE_SPHERICAL) {
            v3 phi = rv_log(q_matrix(q_from(x)));
            sum += v3_dot(phi, v3_mul(v3_from(k), phi));
            continue;
        }
        for (int s = 0; s < hinge_table[l->given.joint].speeds; s++) {
            double off = x[s] - (s < 2 ? l->given.rest[s] : 0);
            sum += k[s] * off * off;
        }
    }
    return 0.5 * sum;
}

void loop_sum_forces(const loop *l, loop_work *w)
{
    spatial sum = l->has_springs ? w->spring : (spatial){v3_zero(), v3_zero()};
    for (int a = 0; a < w->active; a++) {
        const int r = w->active_row[a];
        if (l->row[r].turns)
            sum.angular = v3_axpy(sum.angular, w->force[r], v4d_v3(w->unit[1][a].alpha));
        else
            sum.linear = v3_axpy(sum.linear, w->force[r], v4d_v3(w->unit[1][a].a));
    }
    w->reaction = sum;
}

// ---- questions

void ld_mstmm_loop_state(ld_mstmm *system, const double *q, const double *u, int index,
                         double *coordinates, double *speeds)
{
    loop_side side[2];
    multibody_move(system, q, u);
    loops_place(system, u);
    loop_sides(system, &system->loop[index], side);
    joint_state(&system->loop[index], side, coordinates, speeds);
}

ld_status ld_mstmm_loop_wrench(ld_mstmm *system, const double *q, int index, const double *tau,
                               double *wrench, ld_error *error)
{
    const loop *l = &system->loop[index];
    loop_side side[2];
    for (int s = 0; s < 2; s++)
        if (system->node[l->end[s].node].load >= system->element_count)
            return ld_fail(error, LD_ERR_INPUT,
                           "loop '%s': one side stands on a beam, whose wrenches act at its input "
                           "end; weld a frame to the station and join that",
                           system->loop_name[index]);
    multibody_move(system, q, system->zero);
    loops_place(system, system->zero);
    loop_sides(system, l, side);
    add_pair(system, l, side, joint_wrench(l, side, tau), wrench);
    return LD_OK;
}

void ld_mstmm_loop_force(const ld_mstmm *system, int index, double force[6])
{
    v3_store(force, system->loop_work[index].reaction.linear);
    v3_store(force + 3, system->loop_work[index].reaction.angular);
}
