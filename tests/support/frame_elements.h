// Frames of beams in space by finite elements: cubic beams with shear deformation and rotary
// inertia, their geometric stiffness under axial forces, springs between points, rigid bodies.
// Nothing of the program is used.
//
// A node has three displacements and three small turns. A node may follow another one rigidly, or
// be held. Everything stands in the axes of the ground.
#ifndef LD_TESTS_SUPPORT_FRAME_ELEMENTS_H
#define LD_TESTS_SUPPORT_FRAME_ELEMENTS_H

#include <stdbool.h>

enum { FRAME_MOST_ELEMENTS = 150, FRAME_MOST_NODES = 160, FRAME_MOST_FOLLOWERS = 32 };

// A beam's section, its axes those of the beam: deflections along y meet E I_z.
typedef struct frame_section {
    double EA, EI_y, EI_z, GJ; // [N], [N m2]
    double mass, polar;        // [kg/m], [kg m]
    double kGA_y, kGA_z;       // [N] of shear along y and z; 0: rigid
    double rotary_y, rotary_z; // [kg m] rho I about y and z
} frame_section;

typedef struct frame_element {
    int node; // and the next one
    double h;
    double A[3][3]; // columns: the beam's axes
    frame_section section;
    double N; // [N] tension
} frame_element;

typedef struct frame_follower {
    int node, leader; // -1: held
    bool held[6];     // of a node without a leader: which of its six
} frame_follower;

typedef struct frame {
    int nodes, elements, followers;
    double place[FRAME_MOST_NODES][3];
    frame_element element[FRAME_MOST_ELEMENTS];
    frame_follower follower[FRAME_MOST_FOLLOWERS];
    double *K, *M, *f; // of all nodes [6 nodes x 6 nodes], [6 nodes]
} frame;

void frame_create(frame *self);
void frame_free(frame *self);

// A node at a place; its number.
int frame_node(frame *self, const double place[3]);

// A straight beam of `count` elements from a place along the first column of A; returns its first
// node, from which the others follow. Where `section` has several they change at the fractions
// `from` of the length (at nodes).
int frame_beam(frame *self, const double place[3], const double A[3][3], double length, int count,
               const frame_section *section);
// A beam between places given along it: count + 1 stations [m], ascending, a section for each
// element.
int frame_line(frame *self, const double place[3], const double A[3][3], const double *station,
               int count, const frame_section *section);

// Holds some of a node's freedoms (displacements along x, y, z, turns about them).
void frame_hold(frame *self, int node, const bool held[6]);
void frame_clamp(frame *self, int node);
// A node moves with another one as with a rigid body.
void frame_follow(frame *self, int node, int leader);

// Springs along and about the columns of A between the point that moves with node a (-1: the
// ground) and the one that moves with b, both at `place`.
typedef struct frame_springs {
    double place[3], A[3][3];
    double stiffness[3], rotational[3];
} frame_springs;

void frame_spring(frame *self, int a, int b, const frame_springs *spring);
// A rigid body that moves with a node: mass, mass centre, inertia about it along the ground's axes.
void frame_body(frame *self, int node, double mass, const double center[3],
                const double inertia[3]);
// A force on a node.
void frame_force(frame *self, int node, const double force[3]);
// Gravity on all beams and on the bodies so far.
void frame_weigh(frame *self, const double gravity[3]);

// Displacements u [6 nodes] under the forces; with geometric stiffness under the elements' axial
// forces as they then are (found twice: without and with it).
void frame_solve(frame *self, bool geometric, double *u);
// The `count` lowest natural frequencies [rad/s], ascending, with that geometric stiffness of the
// latest frame_solve or without; negative squares as negative numbers.
void frame_frequencies(frame *self, bool geometric, int count, double *omega);
// The factor of the axial forces as they are at which the frame buckles: lowest positive one.
double frame_buckling(frame *self);
// Sets an element's axial force, tension positive.
void frame_set_tension(frame *self, int element, double N);

#endif
