// A mechanism in words: its bodies as a tree, its loops, its degrees of freedom.
#ifndef LD_SYSTEMS_MECHANISM_DESCRIPTION_H
#define LD_SYSTEMS_MECHANISM_DESCRIPTION_H

#include <stdio.h>

#include "systems/mechanism/mechanism.h"

// Lines that begin with "# ", of a mechanism whose freedoms are found (mechanism_loops.h).
void mechanism_describe(const mechanism_system *self, FILE *stream);

#endif
