// What a state of the launching subsystem means: loads in the tube, energies.
#ifndef LD_SYSTEMS_LAUNCHING_FIGURES_H
#define LD_SYSTEMS_LAUNCHING_FIGURES_H

#include "systems/launching/launching.h"

// What the tube carries at the stations asked for, and what each support puts on it.
typedef struct launching_loads {
    guide_load station[LD_MAX_STATIONS];
    guide_wrench support[LD_MAX_SUPPORTS]; // at the support's station, in base axes
} launching_loads;

// From the output of an evaluation and the record that it was given in `input`.
void launching_find_loads(const launching_system *self, const launching_input *input,
                          const double *state, const launching_output *output,
                          launching_loads *loads);

// Kinetic energy of tube, tail and (if in the tube) rocket [J].
double launching_kinetic_energy(const launching_system *self, const launching_input *input,
                                const launching_phase *phase, const double *state);
// Potential energy of tube and tail in gravity [J], from the origin of I.
double launching_potential_energy(const launching_system *self, const double *state);

#endif
