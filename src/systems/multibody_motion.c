// Motion of all nodes from coordinates and speeds, outwards from the ground.
#include <string.h>

#include "math/rotation_vector.h"
#include "math/sine_cosine.h"
#include "systems/multibody.h"

// Internal axes of a turned node: H Rz(angle).
LD_INLINE m3 turned(m3 H, double sine, double cosine)
{
    m3 A;
    for (int i = 0; i < 3; i++) {
        A.a[i][0] = cosine * H.a[i][0] + sine * H.a[i][1];
        A.a[i][1] = cosine * H.a[i][1] - sine * H.a[i][0];
        A.a[i][2] = H.a[i][2];
    }
    return A;
}

// A section node follows its beam's deformed section, known in the beam's floating frame.
static void move_section(ld_mstmm *system, int i)
{
    const node *n = &system->node[i];
    const node_beam *b = &system->beam_of[i];
    const node_motion *parent = &system->motion[n->parent];
    node_motion *m = &system->motion[i];
    const tube_section_state *section = &b->body->output[b->output].section;
    m3 A_R = m3_mul(parent->A, n->G);
    m->A = m3_mul(A_R, section->rotation);
    m->w = v3_add(parent->w, m3_apply(A_R, section->spin));
    m->r = m3_apply(A_R, section->position);
}

static void move_beam(ld_mstmm *system, int i, const double *q, const double *u)
{
    const node_beam *b = &system->beam_of[i];
    const node_motion *m = &system->motion[i];
    m3 Q = system->body_axes[system->node[i].element];
    v3 w_R = m3_apply(Q, m3_apply_transposed(m->A, m->w));
    beam_move(b->body, w_R, q + b->modes_q, u + b->modes_u);
}

void multibody_move(ld_mstmm *system, const double *q, const double *u)
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
        v3 w = parent->w;
        v3 r = m3_apply(parent->A, n->at);
        m3 H = m3_mul(parent->A, n->G);
        switch (n->hinge) {
        case NODE_TURN: {
            v3 spin = v3_scale(u[n->u], m3_column(H, 2));
            m->A = turned(H, system->sine[n->angle], system->cosine[n->angle]);
            m->w = v3_add(w, spin);
            m->r = r;
            m->bias = (spatial){v3_cross(w, v3_cross(w, r)), v3_cross(w, spin)};
            break;
        }
        case NODE_SLIDE: {
            v3 e = m3_column(H, 2);
            r = v3_axpy(r, q[n->q], e);
            m->A = H;
            m->w = w;
            m->r = r;
            m->bias = (spatial){v3_cross(w, v3_axpy(v3_cross(w, r), 2 * u[n->u], e)), v3_zero()};
            break;
        }
        case NODE_WELD:
            m->A = H;
            m->w = w;
            m->r = r;
            m->bias = (spatial){v3_cross(w, v3_cross(w, r)), v3_zero()};
            break;
        case NODE_BALL: {
            m->A = m3_mul(H, q_matrix(q_from(q + n->q)));
            v3 spin = m3_apply(m->A, v3_from(u + n->u));
            m->w = v3_add(w, spin);
            m->r = r;
            m->bias = (spatial){v3_cross(w, v3_cross(w, r)), v3_cross(w, spin)};
            break;
        }
        case NODE_FREE: {
            m->A = m3_mul(H, q_matrix(q_from(q + n->q + 3)));
            v3 spin = m3_apply(m->A, v3_from(u + n->u + 3));
            v3 slide = m3_apply(H, v3_from(u + n->u));
            r = v3_add(r, m3_apply(H, v3_from(q + n->q)));
            m->w = v3_add(w, spin);
            m->r = r;
            m->bias = (spatial){v3_cross(w, v3_axpy(v3_cross(w, r), 2, slide)), v3_cross(w, spin)};
            break;
        }
        }
        if (n->body == NODE_BEAM)
            move_beam(system, i, q, u);
    }
}

void multibody_place(ld_mstmm *system, const double *q, const double *u)
{
    system->place[0] = (spatial){v3_zero(), v3_zero()};
    for (int i = 1; i <= system->node_count; i++) {
        const node *n = &system->node[i];
        const node_motion *parent = &system->motion[n->parent];
        const node_motion *m = &system->motion[i];
        v3 position = v3_add(system->place[n->parent].linear, m->r);
        v3 velocity = v3_add(system->place[n->parent].angular, v3_cross(parent->w, m->r));
        if (n->body == NODE_SECTION) {
            const node_beam *b = &system->beam_of[i];
            velocity = v3_add(velocity, m3_apply(node_hinge_axes(system, n),
                                                 b->body->output[b->output].section.velocity));
        } else if (n->hinge == NODE_SLIDE) {
            velocity = v3_axpy(velocity, u[n->u], m3_column(m->A, 2));
        } else if (n->hinge == NODE_FREE) {
            velocity = v3_add(velocity, m3_apply(node_hinge_axes(system, n), v3_from(u + n->u)));
        }
        system->place[i] = (spatial){position, velocity};
    }
    (void)q;
}

// Moment of a rotational spring on the body, in body axes: -Jl(-phi)^-T K phi, the gradient of
// phi^T K phi/2 along the body's angular velocity.
static v3 ball_spring(quat attitude, const double *stiffness)
{
    v3 phi = rv_log(q_matrix(attitude));
    v3 pull = v3_mul(v3_from(stiffness), phi);
    return v3_neg(rv_left_jacobian_inverse_transposed(v3_neg(phi), pull));
}

const double *multibody_hinge_forces(ld_mstmm *system, const double *q, const double *u,
                                     const double *tau)
{
    if (!system->has_springs && tau)
        return tau;
    if (tau)
        memcpy(system->tau, tau, (size_t)system->u_count * sizeof *tau);
    else
        memset(system->tau, 0, (size_t)system->u_count * sizeof *tau);
    for (int e = 0; system->has_springs && e < system->element_count; e++) {
        const ld_mstmm_element *given = &system->element[e];
        int at_q = system->element_q[e], at_u = system->element_u[e];
        double *force = system->tau + at_u;
        for (int k = 0; k < system->u_length[e]; k++)
            force[k] -= given->damping[k] * u[at_u + k];
        if (given->hinge == LD_HINGE_SPHERICAL || given->hinge == LD_HINGE_FREE) {
            int slides = given->hinge == LD_HINGE_FREE ? 3 : 0;
            for (int k = 0; k < slides; k++)
                force[k] -= given->stiffness[k] * q[at_q + k];
            v3 moment = ball_spring(q_from(q + at_q + slides), given->stiffness + slides);
            force[slides] += moment.x;
            force[slides + 1] += moment.y;
            force[slides + 2] += moment.z;
        } else {
            for (int k = 0; k < system->u_length[e]; k++)
                force[k] -= given->stiffness[k] * (q[at_q + k] - given->rest[k]);
        }
    }
    return system->tau;
}

double multibody_spring_energy(const ld_mstmm *system, const double *q)
{
    double sum = 0;
    for (int e = 0; e < system->element_count; e++) {
        const ld_mstmm_element *given = &system->element[e];
        const double *at = q + system->element_q[e], *k = given->stiffness;
        if (given->hinge == LD_HINGE_SPHERICAL || given->hinge == LD_HINGE_FREE) {
            int slides = given->hinge == LD_HINGE_FREE ? 3 : 0;
            v3 phi = rv_log(q_matrix(q_from(at + slides)));
            sum += v3_dot(phi, v3_mul(v3_from(k + slides), phi));
            for (int i = 0; i < slides; i++)
                sum += k[i] * at[i] * at[i];
        } else {
            for (int i = 0; i < system->u_length[e]; i++)
                sum += k[i] * (at[i] - given->rest[i]) * (at[i] - given->rest[i]);
        }
    }
    return 0.5 * sum;
}
