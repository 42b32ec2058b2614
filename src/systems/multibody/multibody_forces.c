// Inverse dynamics, energy, momentum and places: what follows from the motion without solving.
#include <string.h>

#include "math/vectors/rotation_vector.h"
#include "systems/multibody/closing.h"
#include "systems/multibody/loop_rows.h"

// ---- inverse dynamics

// Acceleration of node i from its parent's, given u_dot.
static spatial accelerate(ld_mstmm *system, int i, spatial x, const double *u_dot)
{
    const node *n = &system->node[i];
    const node_motion *m = &system->motion[i];
    if (n->body == NODE_SECTION) {
        const node_beam *b = &system->beam_of[i];
        return spatial_turn(node_body_axes(system, n->parent),
                            beam_output_acceleration(b->body, b->output));
    }
    m3 A = node_axes(system, i);
    x = spatial_add(spatial_shift(v4d_v3(m->r), x),
                    (spatial){v4d_v3(m->bias_a), v4d_v3(m->bias_alpha)});
    switch (n->hinge) {
    case NODE_TURN:
        x.angular = v3_axpy(x.angular, u_dot[n->u], m3_column(A, 2));
        break;
    case NODE_SLIDE:
        x.linear = v3_axpy(x.linear, u_dot[n->u], m3_column(A, 2));
        break;
    case NODE_WELD:
        break;
    case NODE_BALL:
        x.angular = v3_add(x.angular, m3_apply(A, v3_from(u_dot + n->u)));
        break;
    case NODE_FREE:
        x.linear = v3_add(x.linear, m3_apply(node_hinge_axes(system, i), v3_from(u_dot + n->u)));
        x.angular = v3_add(x.angular, m3_apply(A, v3_from(u_dot + n->u + 3)));
        break;
    }
    return x;
}

// Wrench about the origin that a rigid body needs for the acceleration x.
static spatial needed_wrench(const node_inertia *body, m3 A, v3 w, spatial x)
{
    v3 mc = m3_apply(A, body->moment);
    sym3 J = sym3_turn(A, body->inertia);
    v3 centripetal = v3_cross(w, v3_cross(w, mc));
    return (spatial){
        v3_add(v3_axpy(centripetal, body->mass, x.linear), v3_cross(x.angular, mc)),
        v3_add(v3_add(v3_cross(mc, x.linear), sym3_apply(J, x.angular)),
               v3_cross(w, sym3_apply(J, w))),
    };
}

// The part of wrench F along a hinge's axes.
static void project(const ld_mstmm *system, int i, spatial F, double *tau)
{
    const node *n = &system->node[i];
    m3 A = node_axes(system, i);
    switch (n->hinge) {
    case NODE_TURN:
        tau[n->u] = v3_dot(m3_column(A, 2), F.angular);
        break;
    case NODE_SLIDE:
        tau[n->u] = v3_dot(m3_column(A, 2), F.linear);
        break;
    case NODE_WELD:
        break;
    case NODE_BALL:
        v3_store(tau + n->u, m3_apply_transposed(A, F.angular));
        break;
    case NODE_FREE:
        v3_store(tau + n->u, m3_apply_transposed(node_hinge_axes(system, i), F.linear));
        v3_store(tau + n->u + 3, m3_apply_transposed(A, F.angular));
        break;
    }
}

// The wrench that every hinge carries into system->wrench, and the forces along its axes (NULL: not
// asked for).
static void carry(ld_mstmm *system, const double *u_dot, const double *wrench, double *tau)
{
    // outwards: accelerations, and what every body needs for them
    spatial *x = system->place, *F = system->wrench;
    x[0] = system->base;
    for (int i = 1; i <= system->node_count; i++) {
        const node *n = &system->node[i];
        const node_beam *b = &system->beam_of[i];
        x[i] = accelerate(system, i, x[n->parent], u_dot);
        F[i] = (spatial){v3_zero(), v3_zero()};
        if (n->body == NODE_RIGID) {
            F[i] = needed_wrench(&system->inertia[i], node_axes(system, i),
                                 v4d_v3(system->motion[i].w), x[i]);
        } else if (n->body == NODE_BEAM) {
            m3 A_R = node_body_axes(system, i);
            F[i] = spatial_turn(
                A_R, beam_needed(b->body, spatial_turn_back(A_R, x[i]), u_dot + b->modes_u));
        }
        if (wrench && n->load >= 0) {
            const double *applied = wrench + 6 * n->load;
            F[i].linear = v3_sub(F[i].linear, v3_from(applied));
            F[i].angular = v3_sub(F[i].angular, v3_from(applied + 3));
        }
    }

    // inwards: every hinge carries all that lies beyond it
    for (int i = system->node_count; i >= 1; i--) {
        const node *n = &system->node[i];
        const node_beam *b = &system->beam_of[i];
        if (n->body == NODE_SECTION) {
            m3 A_R = node_body_axes(system, n->parent);
            spatial on_R = beam_carry(b->body, b->output, spatial_turn_back(A_R, F[i]));
            F[n->parent] = spatial_add(F[n->parent], spatial_turn(A_R, on_R));
            continue;
        }
        if (n->body == NODE_BEAM && tau)
            memcpy(tau + b->modes_u, b->body->h + 6, (size_t)b->body->modes * sizeof *tau);
        if (tau)
            project(system, i, F[i], tau);
        F[n->parent] = spatial_add(F[n->parent], wrench_shift(v4d_v3(system->motion[i].r), F[i]));
    }
}

// Less what springs and dampers of the hinges give.
static void leave_out_springs(ld_mstmm *system, const double *q, const double *u, double *tau)
{
    if (!system->has_springs)
        return;
    const double *given = multibody_spring_forces(system, q, u);
    for (int k = 0; k < system->u_count; k++)
        tau[k] -= given[k];
}

void ld_mstmm_forces(ld_mstmm *system, const double *q, const double *u, const double *u_dot,
                     const double *wrench, double *tau)
{
    multibody_move(system, q, u);
    if (system->loop_count > 0) {
        loops_place(system, u);
        wrench = loops_load(system, wrench);
    }
    carry(system, u_dot, wrench, tau);
    leave_out_springs(system, q, u, tau);
}

void multibody_needed_forces(ld_mstmm *system, const double *q, const double *u,
                             const double *u_dot, double *tau)
{
    multibody_move(system, q, u);
    loops_place(system, u);
    loops_load(system, NULL);
    loops_make_rows(system, LOOPS_PLACES);
    for (int i = 0; i < system->loop_count; i++)
        loop_sum_forces(&system->loop[i], &system->loop_work[i]);
    carry(system, u_dot, loops_load_all(system, NULL), tau);
    leave_out_springs(system, q, u, tau);
}

void ld_mstmm_reactions(ld_mstmm *system, const double *q, const double *u, const double *u_dot,
                        const double *wrench, double *reaction)
{
    multibody_move(system, q, u);
    if (system->loop_count > 0) {
        loops_place(system, u);
        wrench = loops_load_all(system, wrench);
    }
    carry(system, u_dot, wrench, NULL);
    for (int e = 0; e < system->element_count; e++) {
        spatial F = system->wrench[system->element_node[e]];
        v3_store(reaction + 6 * e, F.linear);
        v3_store(reaction + 6 * e + 3, F.angular);
    }
}

// ---- energy and momentum

ld_mstmm_energies ld_mstmm_energy(ld_mstmm *system, const double *q, const double *u)
{
    ld_mstmm_energies sum = {.elastic = multibody_spring_energy(system, q)};
    multibody_move(system, q, u);
    multibody_place(system, u);
    sum.elastic += loops_energy(system);
    for (int i = 1; i <= system->node_count; i++) {
        const node *n = &system->node[i];
        m3 A = node_axes(system, i);
        v3 w_I = v4d_v3(system->motion[i].w);
        v3 position = system->place[i].linear, velocity = system->place[i].angular;
        double mass = system->inertia[i].mass;
        v3 mc = m3_apply(A, system->inertia[i].moment);
        if (n->body == NODE_RIGID) {
            v3 w = m3_apply_transposed(A, w_I);
            sum.kinetic += 0.5 * mass * v3_norm2(velocity) + v3_dot(velocity, v3_cross(w_I, mc)) +
                           0.5 * v3_dot(w, sym3_apply(system->inertia[i].inertia, w));
        } else if (n->body == NODE_BEAM) {
            const node_beam *b = &system->beam_of[i];
            const flexible_tube *tube = &b->body->tube;
            m3 A_R = node_body_axes(system, i);
            mass = tube->m;
            mc = m3_apply(A_R, tube_first_moment(tube, q + b->modes_q));
            sum.kinetic +=
                tube_kinetic_energy(tube, m3_apply_transposed(A_R, velocity),
                                    m3_apply_transposed(A_R, w_I), q + b->modes_q, u + b->modes_u);
            sum.elastic += tube_elastic_energy(tube, q + b->modes_q);
        } else {
            continue;
        }
        sum.potential -= v3_dot(system->gravity, v3_axpy(mc, mass, position));
    }
    return sum;
}

void ld_mstmm_momentum(ld_mstmm *system, const double *q, const double *u, double linear[3],
                       double angular[3])
{
    v3 p = v3_zero(), l = v3_zero();
    multibody_move(system, q, u);
    multibody_place(system, u);
    for (int i = 1; i <= system->node_count; i++) {
        const node *n = &system->node[i];
        m3 A = node_axes(system, i);
        v3 w_I = v4d_v3(system->motion[i].w);
        v3 position = system->place[i].linear, velocity = system->place[i].angular, p_i, l_i;
        if (n->body == NODE_RIGID) {
            const node_inertia *body = &system->inertia[i];
            v3 mc = m3_apply(A, body->moment);
            v3 w = m3_apply_transposed(A, w_I);
            p_i = v3_axpy(v3_cross(w_I, mc), body->mass, velocity);
            l_i = v3_add(v3_cross(mc, velocity), m3_apply(A, sym3_apply(body->inertia, w)));
        } else if (n->body == NODE_BEAM) {
            m3 A_R = node_body_axes(system, i);
            const node_beam *b = &system->beam_of[i];
            spatial momentum =
                beam_momentum(b->body, m3_apply_transposed(A_R, velocity), u + b->modes_u);
            p_i = m3_apply(A_R, momentum.linear);
            l_i = m3_apply(A_R, momentum.angular);
        } else {
            continue;
        }
        p = v3_add(p, p_i);
        l = v3_add(l, v3_add(l_i, v3_cross(position, p_i)));
    }
    v3_store(linear, p);
    v3_store(angular, l);
}

// ---- positions and rates

ld_mstmm_point ld_mstmm_locate(ld_mstmm *system, const double *q, const double *u, int element,
                               const double at[3])
{
    int i = system->element_node[element];
    multibody_move(system, q, u);
    multibody_place(system, u);
    v3 position = system->place[i].linear, velocity = system->place[i].angular;
    v3 w = v4d_v3(system->motion[i].w), r = v3_from(at);
    m3 A = node_body_axes(system, i);
    if (system->node[i].body == NODE_BEAM) {
        // to the deformed section first
        const node_beam *b = &system->beam_of[i];
        tube_section_state section;
        tube_section(&b->body->tube, at[0], b->body->w, q + b->modes_q, u + b->modes_u, &section);
        v3 p = m3_apply(A, section.position);
        position = v3_add(position, p);
        velocity = v3_add(velocity, v3_add(v3_cross(w, p), m3_apply(A, section.velocity)));
        w = v3_add(w, m3_apply(A, section.spin));
        A = m3_mul(A, section.rotation);
        r.x = 0;
    }
    r = m3_apply(A, r);
    quat attitude = q_from_matrix(A);
    ld_mstmm_point point = {.attitude = {attitude.w, attitude.x, attitude.y, attitude.z}};
    v3_store(point.position, v3_add(position, r));
    v3_store(point.velocity, v3_add(velocity, v3_cross(w, r)));
    v3_store(point.rate, w);
    return point;
}

void ld_mstmm_places(ld_mstmm *system, const double *q, const double *u, ld_mstmm_point *places)
{
    memcpy(system->known, q, (size_t)system->q_count * sizeof *q);
    memcpy(system->known + system->q_count, u, (size_t)system->u_count * sizeof *u);
    multibody_move(system, q, u);
    multibody_place(system, u);
    for (int e = 0; e < system->element_count; e++) {
        const int i = system->element_node[e];
        const quat attitude = q_from_matrix(node_body_axes(system, i));
        ld_mstmm_point *p = &places[e];
        v3_store(p->position, system->place[i].linear);
        v3_store(p->velocity, system->place[i].angular);
        v3_store(p->rate, v4d_v3(system->motion[i].w));
        memcpy(p->attitude, &attitude, sizeof attitude);
    }
    system->known_at = system->moves;
}

// NOLINTNEXTLINE(readability-function-size): public
void ld_mstmm_point_acceleration(ld_mstmm *system, const double *q, const double *u,
                                 const double *u_dot, int element, const double at[3],
                                 double linear[3], double angular[3])
{
    const int i = system->element_node[element];
    const node *n = &system->node[i];
    spatial *x = system->place;
    multibody_move(system, q, u);
    x[0] = (spatial){v3_zero(), v3_zero()};
    for (int k = 1; k <= i; k++) {
        x[k] = accelerate(system, k, x[system->node[k].parent], u_dot);
        if (system->node[k].body == NODE_BEAM)
            beam_needed(system->beam_of[k].body, spatial_turn_back(node_body_axes(system, k), x[k]),
                        u_dot + system->beam_of[k].modes_u);
    }
    spatial of = x[i];
    m3 A = node_body_axes(system, i);
    v3 w = v4d_v3(system->motion[i].w), r = v3_from(at);
    if (n->body == NODE_BEAM) {
        const node_beam *b = &system->beam_of[i];
        tube_section_state section;
        tube_section(&b->body->tube, at[0], b->body->w, q + b->modes_q, u + b->modes_u, &section);
        of = spatial_turn(A, beam_section_acceleration(b->body, &section));
        w = v3_add(w, m3_apply(A, section.spin));
        A = m3_mul(A, section.rotation);
        r.x = 0;
    }
    r = m3_apply(A, r);
    v3_store(linear, v3_add(spatial_shift(r, of).linear, v3_cross(w, v3_cross(w, r))));
    v3_store(angular, of.angular);
}

void ld_mstmm_rates(const ld_mstmm *system, const double *q, const double *u, double *q_dot)
{
    for (int e = 0; e < system->element_count; e++) {
        const double *from = u + system->element_u[e];
        const double *at = q + system->element_q[e];
        double *to = q_dot + system->element_q[e];
        ld_hinge hinge = system->element[e].hinge;
        int slides = hinge == LD_HINGE_FREE ? 3 : 0;
        if (hinge == LD_HINGE_SPHERICAL || hinge == LD_HINGE_FREE) {
            quat rate = q_rate(q_from(at + slides), v3_from(from + slides));
            memcpy(to, from, (size_t)slides * sizeof *to);
            to[slides] = rate.w;
            to[slides + 1] = rate.x;
            to[slides + 2] = rate.y;
            to[slides + 3] = rate.z;
        } else {
            memcpy(to, from, (size_t)system->u_length[e] * sizeof *to);
        }
        if (system->element[e].beam) {
            const beam *body = &system->beams[system->element_beam[e]];
            memcpy(to + system->q_length[e], from + system->u_length[e],
                   (size_t)body->modes * sizeof *to);
        }
    }
}
