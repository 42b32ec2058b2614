// The least value of a function of a few keys in the unit cube under constraints, by the methods of
// NLopt: without derivatives, or with forward differences. The function is costly and its
// evaluations at several points may run side by side.
#ifndef LD_OPTIMISE_OPTIMUM_H
#define LD_OPTIMISE_OPTIMUM_H

#include <stdbool.h>
#include <stdint.h>

#include "launchdyn/status.h"
#include "model/blocks/optimise.h"

typedef struct optimum_problem {
    int keys, limits;
    ld_optimise_method method;
    int evaluations;  // of a start, at most
    double precision; // of the keys
    uint64_t seed;    // of methods that draw
    void *self;
    // Finds the value, then the constraints, which hold where they are not above 0, at points
    // [count][keys], into values [count][1 + limits]; there: false where the point has none. Points
    // are numbered in this order, from 0.
    ld_status (*evaluate)(void *self, int count, const double *points, double *values, bool *there,
                          ld_error *error);
    // Whether the best point now is too little better than that of a round before, by their
    // numbers; NULL: never.
    bool (*is_enough)(void *self, int before, int now);
} optimum_problem;

typedef enum optimum_end {
    OPTIMUM_PRECISE,     // the keys are known as precisely as asked
    OPTIMUM_NOISE,       // is_enough()
    OPTIMUM_EVALUATIONS, // as many as allowed
    OPTIMUM_NOWHERE      // the start has no value
} optimum_end;

// The best of the points looked at: the least value where all constraints hold; where they nowhere
// do, the point that breaks the worst one least.
typedef struct optimum_found {
    int number; // -1: none
    double x[LD_MAX_BOUNDS], value, limit[2 * LD_MAX_AIMS];
    double worst; // of the constraints, 0: all hold
} optimum_found;

typedef struct optimum {
    optimum_end end;
    int evaluations;
    optimum_found best;
} optimum;

// What a method can.
typedef struct optimum_method {
    const char *name; // as its authors call it
    bool limited;     // takes constraints
    bool local, derivatives;
} optimum_method;
const optimum_method *optimum_method_of(ld_optimise_method method);

// Whether a is better than b.
bool optimum_is_better(const optimum_found *a, const optimum_found *b);

// Searches from x [keys]; `number` is that of the first point.
// @return LD_OK, LD_ERR_NUMERIC (NLopt refuses), LD_ERR_MEMORY, or what evaluate() returned
ld_status optimum_search(const optimum_problem *problem, const double *x, int number,
                         optimum *result, ld_error *error);

#endif
