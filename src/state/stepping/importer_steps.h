// Steps that an integrator outside takes, of which only the points are reported.
#ifndef LD_STATE_STEPPING_IMPORTER_STEPS_H
#define LD_STATE_STEPPING_IMPORTER_STEPS_H

#include "state/stepping/stepper.h"

extern const stepper importer_stepper;

// Of a propagator that has it. Where its integrator is; then its time and its state are these. What
// was found of another point is found again.
void propagator_place(propagator *object, double t, const double *y);
// A step ends there, once: whether an event lies on the way. LD_ERR_NUMERIC: the equations have no
// solution.
bool propagator_has_accepted(const propagator *object);
ld_status propagator_accept(propagator *object, bool *crossed, ld_error *error);
// What has happened at the step's end has happened; the next one begins.
ld_status propagator_continue(propagator *object, ld_error *error);
// Takes out of the state there what it has drifted from where constraints hold it; false where that
// is less than what the tolerances leave to it.
bool propagator_project(propagator *object, double *y);

#endif
