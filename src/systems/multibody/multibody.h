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
#include "math/vectors/quaternion.h"
#include "model/blocks/limits.h"

typedef enum node_hinge { NODE_WELD, NODE_TURN, NODE_SLIDE, NODE_BALL, NODE_FREE } node_hinge;
// What the inward sweep does at a hinge: a prescribed one has PASS_GIVEN.
typedef enum node_pass { PASS_WELD, PASS_TURN, PASS_SLIDE, PASS_SEVERAL, PASS_GIVEN } node_pass;
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
    int load;    // where its body's applied wrench stands; -1: nothing is applied to it
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

// What a node that is not a plain rigid body has besides.
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
// one on, x its body's a and the components found; a free hinge six, of alpha and a.
typedef struct axis_record {
    v4d V_a, V_alpha; // of one axis: Z e/D
    double rate;
    double inverse; // 1/D, 0 of a prescribed axis
} axis_record;

typedef struct spatial_lanes {
    v4d a, alpha;
} spatial_lanes;

// One side of a joint that closes a loop.
typedef struct loop_end {
    int node;    // 0: the ground
    int element; // -1: the ground
    v3 at;       // [m] the joint's point, node's internal axes
    m3 frame;    // joint frame, the axis along z, to the node's internal axes
} loop_end;

// One direction that a joint holds. Translation: the distance of the points along an axis of the
// first frame. Rotation: the product of an axis of the first frame and one of the second is cosine.
typedef struct loop_row {
    bool turns;
    int first, second; // axes of the frames
    double cosine;
} loop_row;

// Slots that two loops have in common: runs of equal length in both.
typedef struct loop_run {
    int here, there, length;
} loop_run;

// Loop j acts on loop i (j <= i) through the slots that they share.
typedef struct loop_pair {
    int other, run_count;
    loop_run *run;
} loop_pair;

// A joint that closes a loop, constant. Its path are the nodes whose hinges feel its wrenches:
// those of the first side down to where the sides meet, those of the second side, those of both
// from there to the ground. A slot is a speed on the path, in the order of the walk.
typedef struct loop {
    ld_mstmm_loop given; // names NULL
    loop_end end[2];
    int row_count;
    loop_row row[6];
    m3 axes[2];  // joint frames with the axis along z to those of the description
    double psi;  // [rad] universal: angle between its axes
    int part[3]; // nodes of each part
    int *path;
    int *path_slot; // first slot of each node on the path
    int slot_count;
    int *slot; // speed of each slot
    int first; // the first loop that acts on it
    int pair_count;
    loop_pair *pair;
    bool meets_in_beam; // both sides stand on the same beam
    bool has_springs;
} loop;

// What an evaluation finds of a loop.
typedef struct loop_work {
    // by active row
    spatial_lanes unit[2][6]; // unit wrenches on the sides, about the nodes' origins
    double gap[6];            // what is to be closed: position, velocity or acceleration
    // by row
    double force[6];
    double *Y, *Z;      // [row][slot]: a unit force's share along a slot, and over D
    double *S, *X;      // [loop from first on to this][6][6]: response, and its factor
    double L[6][6];     // factor of the own block in the order of the pivots
    double found[6];    // forces in that order
    int order[6], rank; // rows with pivots first
    // force and moment about the second point: of its springs, of all in the latest evaluation
    spatial spring, reaction;
    // found by ld_mstmm_assemble
    int active, active_row[6]; // rows that some motion of the tree opens; Y, Z, S, X, L go by these
    double scale[6];           // their response in general poses
    int limit;                 // independent ones of this loop, those before counted first
} loop_work;

// All rows of the loops at a time, for poses near singular ones; V NULL: too many.
typedef struct dense_rows {
    double *V, *R; // [rows][u_count], [rows][rows]
    double *scale, *gap, *found;
    int *order;
} dense_rows;

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
    int loop_count, load_count; // loads: elements, then ends of loops on beams
    bool loop_loads;            // springs in loops

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
    loop *loop;
    char (*loop_name)[LD_MAX_NAME];
    int *loop_node; // the nodes on their paths, ascending
    int loop_node_count;

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
    uint8_t *pass;           // a node_pass of each node
    bool *prescribed;        // hinge of each element
    loop_work *loop_work;
    double *loop_numbers; // their Y, Z, S, X
    dense_rows dense;
    double *applied;         // wrenches with those of loops' springs
    uint64_t moves;          // counts the motions; one that an evaluation has used up is gone
    double *known;           // q and u of the latest ld_mstmm_places
    uint64_t known_at;       // their motion
    double *zero, *response; // [u_count]; the least motion that closes loops
    double *trial;           // coordinates tried
    bool assembled;
    bool beams_rigid;   // the modes hold while loops are being closed
    double singularity; // of the latest pose
    int singular_loop;
    spatial *wrench; // inverse dynamics, by node
    spatial *place;  // origin's position and velocity, by node
};

// The hot functions, compiled for the instruction sets that the machine may have.
typedef struct sweep {
    // Motion of all nodes, beams included.
    void (*move)(ld_mstmm *system, const double *q, const double *u);
    // From the tips inwards; returns 0, or the node whose hinge is singular.
    int (*inwards)(ld_mstmm *system, const double *tau, const double *wrench);
    // From the ground outwards: the accelerations.
    void (*outwards)(ld_mstmm *system, double *u_dot);
    // The loops' unit wrenches towards the ground: Y, Z, S; and what acceleration the rows have
    // without forces, added to their gaps.
    void (*propagate)(ld_mstmm *system);
    // Adds the loops' forces to the rates of the axes.
    void (*apply)(ld_mstmm *system);
} sweep;

extern const sweep sweep_default, sweep_avx;

// Motion of all nodes.
LD_INLINE void multibody_move(ld_mstmm *system, const double *q, const double *u)
{
    system->moves++;
    system->sweep->move(system, q, u);
}

// Positions and velocities of the nodes' origins into `place`; after multibody_move.
void multibody_place(ld_mstmm *system, const double *u);
// The same of one node, its parent's known.
void multibody_place_node(ld_mstmm *system, int i, const double *u);

// Forces of hinges and wrenches on elements, as ld_mstmm_accelerations has them.
typedef struct multibody_load {
    const double *tau, *wrench;
} multibody_load;

// Accelerations from the motion in the workspace, that of these q and u; the sweep overwrites it.
ld_status multibody_accelerate(ld_mstmm *system, const double *q, const double *u,
                               const multibody_load *load, double *u_dot, ld_error *error);

// Forces of springs and dampers added to tau (NULL: none) in the workspace, but for the prescribed
// hinges' accelerations in it; returns them, or tau itself where there are none.
const double *multibody_hinge_forces(ld_mstmm *system, const double *q, const double *u,
                                     const double *tau);
// Forces of all springs and dampers, in the workspace.
const double *multibody_spring_forces(ld_mstmm *system, const double *q, const double *u);
// Moment of a rotational spring on the body, in body axes.
v3 multibody_ball_spring(quat attitude, const double *stiffness);
double multibody_spring_energy(const ld_mstmm *system, const double *q);

// The node_pass of a node's hinge.
uint8_t multibody_pass(const node *n, int prescribed);

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
