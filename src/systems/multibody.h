// A multibody system as a list of nodes, parents before children (depth first), and its workspace.
//
// Every hinge becomes single axes: a universal hinge two turns, a cylindrical one a slide and a
// turn, with massless nodes between. A beam's child hangs on a section node of its own. A node's
// internal axes are the body's turned so that a single axis is its z axis.
#ifndef LD_SYSTEMS_MULTIBODY_H
#define LD_SYSTEMS_MULTIBODY_H

#include <stdbool.h>

#include "elements/beam.h"
#include "launchdyn/mstmm.h"
#include "math/spatial.h"

typedef enum node_hinge { NODE_WELD, NODE_TURN, NODE_SLIDE, NODE_BALL, NODE_FREE } node_hinge;
typedef enum node_body { NODE_RIGID, NODE_BEAM, NODE_SECTION } node_body;

// Topology and hinge of a node; node 0 is the ground.
typedef struct node {
    int parent;
    node_hinge hinge;
    node_body body;
    int q, u;    // offsets of its hinge's coordinates and speeds
    int axis;    // first of its hinge's axis records
    int angle;   // turn: index among all turns
    int element; // whose body it is; -1: a massless node between two axes
    int branch;  // where several children's shares are summed; -1: none but the next node
    bool leads;  // its parent is the node before: shares pass directly
    v3 at;       // [m] its hinge on the parent, parent's internal axes
    m3 G;        // its internal axes at zero coordinates to the parent's
} node;

// Inertia about the node's origin, internal axes.
typedef struct node_inertia {
    double mass;
    v3 moment; // [kg m] mass times mass centre
    sym3 inertia;
} node_inertia;

// What a node that is no plain rigid body has besides.
typedef struct node_beam {
    beam *body;
    int output;           // section: which
    int modes_q, modes_u; // beam: offsets of its modal coordinates and rates
} node_beam;

// Motion of a node in inertial axes, from q and u alone.
typedef struct node_motion {
    m3 A;         // internal to inertial axes
    v3 w;         // angular velocity
    v3 r;         // from the parent's origin to this one's
    spatial bias; // [a; alpha] = T(r) [a; alpha]_parent + axes u_dot + bias
} node_motion;

// One axis of a hinge after the reduced step: u_dot = rate - V . (T x_parent + the axes before).
typedef struct axis_record {
    spatial V; // Z e/D
    double rate;
} axis_record;

struct ld_mstmm {
    int element_count, node_count; // the ground not counted
    int q_count, u_count, axis_count, angle_count, branch_count, beam_count;
    spatial base; // acceleration of the ground less gravity
    v3 gravity;
    bool has_springs;

    // constant
    char (*name)[LD_MAX_NAME];
    ld_mstmm_element *element; // as given (names and parents replaced by NULL)
    int *element_beam;         // beam of each element that is one
    int *element_node;         // node of each element's body
    int *element_q, *element_u;
    int *q_length; // coordinates of each element's hinge
    int *u_length;
    m3 *body_axes; // internal axes to body axes, of each element
    node *node;    // [node_count + 1], 0 is the ground
    node_inertia *inertia;
    node_beam *beam_of; // by node
    beam *beams;
    int *angle_q; // where each turn's angle stands in q

    // workspace of one evaluation
    double *angle, *sine, *cosine;
    node_motion *motion; // [node_count + 1]
    axis_record *axis;
    spatial_matrix *branch_Z;
    spatial *branch_zf;
    spatial *branch_x;
    double *tau;     // with springs and dampers
    spatial *wrench; // inverse dynamics, by node
    spatial *place;  // origin's position and velocity, by node
};

// Motion of all nodes, beams included.
void multibody_move(ld_mstmm *system, const double *q, const double *u);

// Positions and velocities of the nodes' origins into `place`; after multibody_move.
void multibody_place(ld_mstmm *system, const double *q, const double *u);

// Forces of springs and dampers added to tau (NULL: none) in the workspace; returns them, or tau
// itself where there are none.
const double *multibody_hinge_forces(ld_mstmm *system, const double *q, const double *u,
                                     const double *tau);
double multibody_spring_energy(const ld_mstmm *system, const double *q);

// The error of a hinge that offers no resistance, at node i, or of a state that is not finite.
ld_status multibody_singular(const ld_mstmm *system, int i, ld_error *error);

// Hinge frame of a node in inertial axes, before its own turns.
LD_INLINE m3 node_hinge_axes(const ld_mstmm *system, const node *n)
{
    return m3_mul(system->motion[n->parent].A, n->G);
}
// Body axes of node i's element in inertial axes: a beam's floating frame R.
LD_INLINE m3 node_body_axes(const ld_mstmm *system, int i)
{
    return m3_mul(system->motion[i].A, m3_transpose(system->body_axes[system->node[i].element]));
}

#endif
