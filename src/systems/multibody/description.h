// The description of a multibody system, checked, and its tree of elements.
#ifndef LD_SYSTEMS_DESCRIPTION_H
#define LD_SYSTEMS_DESCRIPTION_H

#include <stdbool.h>

#include "launchdyn/mstmm.h"

typedef struct hinge_kind {
    const char *name;
    int coordinates, speeds, axes; // axes that the description must give
} hinge_kind;

// By ld_hinge.
extern const hinge_kind hinge_table[];

typedef struct tree {
    int count;
    int *parent;       // element index, -1: the ground
    int *first, *next; // children in the order given; first[count]: of the ground
    int *order;        // parents before children, depth first
} tree;

bool description_all_finite(const double *x, int n);

// Fails with a sentence that names the element.
ld_status tree_make(tree *t, const ld_mstmm_element *elements, int count, ld_error *error);
void tree_free(tree *t);

#endif
