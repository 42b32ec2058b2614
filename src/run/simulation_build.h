// The system of a simulation: computed from a model.
#ifndef LD_RUN_SIMULATION_BUILD_H
#define LD_RUN_SIMULATION_BUILD_H

#include "state/simulation.h"

// Makes *simulation (NULL: a new one) that of `model`, as ld_simulation_create does but without the
// modes for the summary. What was found once of an equal tube is used again: the results are the
// same to the bit. After a failure it is empty, to be renewed or freed.
ld_status simulation_renew(ld_simulation **simulation, const ld_model *model, ld_error *error);

#endif
