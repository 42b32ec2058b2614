// The launcher linearised, with what may act on its base and with the columns of a history:
//   x' = A x + B u + B' u' + B" u",   y = C x + D u + D' u' + D" u"
// x: the unknowns of linear_system; u: the base_inputs that the base has; y: all columns.
#ifndef LD_LINEAR_PLANT_H
#define LD_LINEAR_PLANT_H

#include "state/simulation.h"

typedef struct plant {
    int states, inputs, outputs;
    // [states][states], [states][inputs] and [outputs][states], [outputs][inputs], by columns; a
    // column that has no value: not a number
    double *A, *B, *B_rate, *B_bend, *C, *D, *D_rate, *D_bend;
    bool bends;   // through clamps the base acts by its acceleration, too; else B" and D" are zero
    double *rest; // [outputs] columns in the equilibrium
} plant;

// Names of the inputs; in base_inputs stands where their cells say.
ld_status plant_inputs(const ld_simulation *simulation, quantity_columns *inputs, ld_error *error);

// With the adaptors' friction as it is where they hardly slide (`rubbing`), or none. Free with
// plant_free(), also after a failure.
ld_status plant_make(plant *self, const ld_simulation *simulation, bool rubbing,
                     const quantity_columns *inputs, ld_error *error);
void plant_free(plant *self);

// Room for a plant as large as another.
ld_status plant_make_room(plant *self, const plant *as, ld_error *error);
// to + factor what, number by number.
void plant_add(plant *to, double factor, const plant *what);
// a + share (b - a), number by number.
void plant_between(const plant *a, const plant *b, double share, plant *to);

#endif
