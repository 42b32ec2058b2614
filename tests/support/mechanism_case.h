// Random bases of bodies, joints, loops and force elements, and random states of them.
#ifndef LD_TESTS_SUPPORT_MECHANISM_CASE_H
#define LD_TESTS_SUPPORT_MECHANISM_CASE_H

#include "support/dense_mechanism.h"

typedef struct mechanism_options {
    int bodies, loops;
    bool carrier; // on a frame that moves
    bool wheels;
    bool elements; // force elements of all kinds
    bool whole;    // all 18 tubes
    bool flat;     // every joint in one plane: loops have constraints that others imply
    bool isolated; // in space: nothing acts on it from outside
    bool smooth;   // no stops, clearances, Coulomb friction, ground, limits that are reached
} mechanism_options;

// Number `kind`, from 0: joints of the tree and of loops go through all their kinds. The loops
// close where the scenario places the bodies. Free with reference_model_free().
void draw_mechanism(uint64_t *seed, int kind, const mechanism_options *options, ld_model *model);

typedef struct mechanism_case {
    double t;
    double state[BASE_MOST_STATES];
    v3 tube_force, tube_moment;
    base_rest rest;
    bool linear;
} mechanism_case;

// A state near the start with speeds, drives, feet, wheels; commands, stops, locks and the heights
// of the ground go with it in the model. False: the loops do not close so far from the start.
bool draw_mechanism_state(uint64_t *seed, const dense_mechanism *dense, ld_model *model,
                          const base_system *base, mechanism_case *c);

#endif
