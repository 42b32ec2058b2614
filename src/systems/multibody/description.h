// The description of a multibody system, checked, and its tree of elements.
#ifndef LD_SYSTEMS_DESCRIPTION_H
#define LD_SYSTEMS_DESCRIPTION_H

#include <stdbool.h>

#include "launchdyn/mstmm.h"
#include "math/vectors/mat3.h"

typedef struct hinge_kind {
    const char *name;
    int coordinates, speeds, axes; // axes that the description must give
} hinge_kind;

// By ld_hinge.
extern const hinge_kind hinge_table[];

// What hinges and joints that close loops have in common.
typedef struct described_joint {
    const char *name;
    bool closes; // a loop's
    ld_hinge kind;
    const double *axis, *axis_2, *stiffness, *damping;
} described_joint;

typedef struct tree {
    int count;
    int *parent;       // element index, -1: the ground
    int *first, *next; // children in the order given; first[count]: of the ground
    int *order;        // parents before children, depth first
} tree;

// A rotation that takes e_z to the direction `axis`; its columns are the internal axes.
m3 description_axes_along(v3 axis);
// The directions of a planar joint: two in its plane, its normal.
m3 description_plane_axes(const double axis[3], const double axis_2[3]);
// Frames on both sides of a joint whose axis is z there, in the joint frames of the description;
// universal: axis_2 is the second one's.
void description_joint_axes(ld_hinge joint, const double axis[3], const double axis_2[3],
                            m3 axes[2]);

bool description_all_finite(const double *x, int n);

ld_status description_check_joint(const described_joint *j, ld_error *error);

// Fails with a sentence that names the element.
ld_status tree_make(tree *t, const ld_mstmm_element *elements, int count, ld_error *error);
void tree_free(tree *t);

#endif
