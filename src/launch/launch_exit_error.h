// How far the errors of the steps leave the rates of a rocket at its exit off, found beside the
// run, whose bits stay as they are (formulation.md, section 6).
#ifndef LD_LAUNCH_LAUNCH_EXIT_ERROR_H
#define LD_LAUNCH_LAUNCH_EXIT_ERROR_H

#include "launch/launch_run.h"

// Nothing is made (NULL) where the tube cannot be linearised. LD_ERR_MEMORY.
ld_status exit_error_create(const ld_simulation *simulation, exit_error **out, ld_error *error);
void exit_error_free(exit_error *self);
// Around each step of the run: where it begins, and where it ends before anything has happened.
void exit_error_begin_step(exit_error *self, ld_run *run);
void exit_error_end_step(exit_error *self, ld_run *run);
// At the exit, in the state y: fills the rocket's exit_error.
void exit_error_record(const exit_error *self, ld_run *run, double t, const double *y);
// Says which rates at an exit may be off by more than EXIT_ERROR_NOTED.
void exit_error_note(ld_run *run);

#endif
