// Energies and balance of a launch.
#ifndef LD_STATE_ENERGY_H
#define LD_STATE_ENERGY_H

#include "state/launch_state.h"

// At state y, with what the equations gave there.
void simulation_energy(const launch_state *self, const launcher_input *input,
                       const launcher_output *out, const double *y, double energy_start,
                       ld_energy *energy);

#endif
