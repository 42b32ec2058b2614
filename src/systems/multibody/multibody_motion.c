// Places, velocities and the forces of springs from coordinates and speeds.
#include <string.h>

#include "math/vectors/rotation_vector.h"
#include "systems/multibody/multibody.h"

void multibody_place_node(ld_mstmm *system, int i, const double *u)
{
    const node *n = &system->node[i];
    v3 r = v4d_v3(system->motion[i].r), w = v4d_v3(system->motion[n->parent].w);
    v3 position = v3_add(system->place[n->parent].linear, r);
    v3 velocity = v3_add(system->place[n->parent].angular, v3_cross(w, r));
    if (n->body == NODE_SECTION) {
        const node_beam *b = &system->beam_of[i];
        velocity = v3_add(velocity, m3_apply(node_hinge_axes(system, i),
                                             b->body->output[b->output].section.velocity));
    } else if (n->hinge == NODE_SLIDE) {
        velocity = v3_axpy(velocity, u[n->u], v4d_v3(system->motion[i].A[2]));
    } else if (n->hinge == NODE_FREE) {
        velocity = v3_add(velocity, m3_apply(node_hinge_axes(system, i), v3_from(u + n->u)));
    }
    system->place[i] = (spatial){position, velocity};
}

void multibody_place(ld_mstmm *system, const double *u)
{
    system->place[0] = (spatial){v3_zero(), v3_zero()};
    for (int i = 1; i <= system->node_count; i++)
        multibody_place_node(system, i, u);
}

// Moment of a rotational spring on the body, in body axes: -Jl(-phi)^-T K phi, the gradient of
// phi^T K phi/2 along the body's angular velocity.
v3 multibody_ball_spring(quat attitude, const double *stiffness)
{
    v3 phi = rv_log(q_matrix(attitude));
    v3 pull = v3_mul(v3_from(stiffness), phi);
    return v3_neg(rv_left_jacobian_inverse_transposed(v3_neg(phi), pull));
}

// Where the spring of coordinate k of a hinge with single axes has no force.
static double rest_of(const ld_mstmm_element *given, int k)
{
    return k < 2 ? given->rest[k] : 0;
}

// Adds what springs and dampers of element e give.
static void add_springs(const ld_mstmm *system, int e, const double *q, const double *u,
                        double *force)
{
    const ld_mstmm_element *given = &system->element[e];
    int at_q = system->element_q[e], at_u = system->element_u[e];
    force += at_u;
    for (int k = 0; k < system->u_length[e]; k++)
        force[k] -= given->damping[k] * u[at_u + k];
    if (given->hinge == LD_HINGE_SPHERICAL || given->hinge == LD_HINGE_FREE) {
        int slides = given->hinge == LD_HINGE_FREE ? 3 : 0;
        for (int k = 0; k < slides; k++)
            force[k] -= given->stiffness[k] * q[at_q + k];
        v3 moment = multibody_ball_spring(q_from(q + at_q + slides), given->stiffness + slides);
        force[slides] += moment.x;
        force[slides + 1] += moment.y;
        force[slides + 2] += moment.z;
    } else {
        for (int k = 0; k < system->u_length[e]; k++)
            force[k] -= given->stiffness[k] * (q[at_q + k] - rest_of(given, k));
    }
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
    for (int e = 0; system->has_springs && e < system->element_count; e++)
        if (!system->prescribed[e])
            add_springs(system, e, q, u, system->tau);
    return system->tau;
}

const double *multibody_spring_forces(ld_mstmm *system, const double *q, const double *u)
{
    memset(system->tau, 0, (size_t)system->u_count * sizeof *system->tau);
    for (int e = 0; e < system->element_count; e++)
        add_springs(system, e, q, u, system->tau);
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
                sum += k[i] * (at[i] - rest_of(given, i)) * (at[i] - rest_of(given, i));
        }
    }
    return 0.5 * sum;
}
