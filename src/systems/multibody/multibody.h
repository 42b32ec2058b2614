// A multibody system as a list of nodes, parents before children (depth first), and its workspace.
//
// Every hinge becomes single axes: a universal hinge two turns, a cylindrical one a slide and a
// turn, a planar one two slides and a turn, with massless nodes between. A beam's child hangs on a
// section node of its own. A node's internal axes are the body's turned so that a single axis is
// its z axis.
#ifndef LD_SYSTEMS_MULTIBODY_H
#define LD_SYSTEMS_MULTIBODY_H

#include <stdatomic.h>
#include <stdbool.h>

#include "elements/tube/beam.h"
#include "launchdyn/mstmm.h"
#include "math/vectors/lanes_mat3.h"

typedef enum node_hinge { NODE_WELD, NODE_TURN, NODE_SLIDE, NODE_BALL, NODE_FREE } node_hinge;
// What the inward sweep does at a hinge: a prescribed one has PASS_GIVEN.
typedef enum node_pass { PASS_WELD, PASS_TURN, PASS_SLIDE, PASS_SEVERAL, PASS_GIVEN } node_pass;
typedef enum node_body { NODE_RIGID, NODE_BEAM, NODE_SECTION } node_body;

// Topology and hinge of a node; node 0 is the ground.
typedef struct node {
    int parent;
    node_hinge hinge;
    node_body body;
    int q, u;     // offsets of its hinge's coordinates and speeds
    int axis;     // first of its hinge's axis records
    int angle;    // turn: index among all turns
    int element;  // whose body it is; -1: a massless node between two axes
    int branch;   // where several children's shares are summed; -1: none but the next node
    bool leads;   // its parent is the node before: shares pass directly
    uint8_t pass; // a node_pass
    v3 at;        // [m] its hinge on the parent, parent's internal axes
    m3 G;         // its internal axes at zero coordinates to the parent's
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
    v4d w;                  // angular velocity
    v4d w2;                 // its square, in all lanes
    v4d A[3];               // columns: internal to inertial axes
    v4d r;                  // from the parent's origin to this one's
    v4d bias_a, bias_alpha; // [a; alpha] = T(r) [a; alpha]_parent + axes u_dot + bias
} node_motion;

// What a subtree exerts at a cut, F = Z x + zf, Z = [A, B; B^T, C].
typedef struct share {
    lanes_sym3 A, C;
    lanes_m3 B;
    v4d f, m; // zf
} share;

// A hinge after the reduced step. With one axis: u_dot = rate - V . x, x the parent's acceleration.
// A ball has three of these for the inertial components of its body's alpha, found from the last
// one on, x its body's a and the components found; a free hinge six (V = 0), of alpha and a.
typedef struct axis_record {
    v4d V_a, V_alpha; // of one axis: Z e/D
    double rate;
} axis_record;

typedef struct spatial_lanes {
    v4d a, alpha;
} spatial_lanes;

// So many bodies' own shares are made at a time, independent of each other.
enum { MULTIBODY_BLOCK = 8 };

// How many systems share what is constant.
typedef struct sharing {
    atomic_int systems;
} sharing;

struct ld_mstmm {
    sharing *sharing;
    int element_count, node_count; // the ground not counted
    int q_count, u_count, axis_count, angle_count, branch_count, beam_count;
    spatial base; // acceleration of the ground less gravity
    const struct sweep *sweep;
    v3 gravity;
    bool has_springs;

    // constant, shared by copies
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
    int *angle_q; // where each turn's angle stands in q

    // workspace of one evaluation
    node_beam *beam_of; // by node
    beam *beams;        // their tubes are constant
    double *angle, *sine, *cosine;
    node_motion *motion; // [node_count + 1]
    axis_record *axis;
    share *own;              // of a few bodies that come next, [MULTIBODY_BLOCK]
    share *passing;          // from a node to the one before
    share *branch;           // sums over children
    spatial_lanes *branch_x; // accelerations of nodes with several children
    double *tau;             // with springs and dampers
    spatial *wrench;         // inverse dynamics, by node
    spatial *place;          // origin's position and velocity, by node
};

// The hot functions, compiled for the instruction sets that the machine may have.
typedef struct sweep {
    // Motion of all nodes, beams included.
    void (*move)(ld_mstmm *system, const double *q, const double *u);
    // From the tips inwards; returns 0, or the node whose hinge is singular.
    int (*inwards)(ld_mstmm *system, const double *tau, const double *wrench);
    // From the ground outwards: the accelerations.
    void (*outwards)(ld_mstmm *system, double *u_dot);
} sweep;

extern const sweep sweep_default, sweep_avx;

// Motion of all nodes.
LD_INLINE void multibody_move(ld_mstmm *system, const double *q, const double *u)
{
    system->sweep->move(system, q, u);
}

// Positions and velocities of the nodes' origins into `place`; after multibody_move.
void multibody_place(ld_mstmm *system, const double *u);

// Forces of springs and dampers added to tau (NULL: none) in the workspace, but for the prescribed
// hinges' accelerations in it; returns them, or tau itself where there are none.
const double *multibody_hinge_forces(ld_mstmm *system, const double *q, const double *u,
                                     const double *tau);
// Forces of all springs and dampers, in the workspace.
const double *multibody_spring_forces(ld_mstmm *system, const double *q, const double *u);
double multibody_spring_energy(const ld_mstmm *system, const double *q);

// The error of a hinge that offers no resistance, at node i, or of a state that is not finite.
ld_status multibody_singular(const ld_mstmm *system, int i, ld_error *error);

// Speeds of a node's hinge.
LD_INLINE int node_speeds(const node *n)
{
    return n->hinge == NODE_FREE ? 6 : n->hinge == NODE_BALL ? 3 : n->hinge != NODE_WELD;
}

// Internal axes of node i in inertial axes.
LD_INLINE m3 node_axes(const ld_mstmm *system, int i)
{
    return v4d_m3(system->motion[i].A);
}
// Hinge frame of node i in inertial axes, before its own turns.
LD_INLINE m3 node_hinge_axes(const ld_mstmm *system, int i)
{
    return m3_mul(node_axes(system, system->node[i].parent), system->node[i].G);
}
// Body axes of node i's element in inertial axes: a beam's floating frame R.
LD_INLINE m3 node_body_axes(const ld_mstmm *system, int i)
{
    return m3_mul(node_axes(system, i), m3_transpose(system->body_axes[system->node[i].element]));
}

#endif
