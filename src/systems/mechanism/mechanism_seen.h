// What an evaluation of a mechanism looks at, by its structure.
#ifndef LD_SYSTEMS_MECHANISM_SEEN_H
#define LD_SYSTEMS_MECHANISM_SEEN_H

#include "systems/mechanism/mechanism.h"

// Lists the elements whose motion forces and frames need, and the joints with one axis; the chain,
// points and holds are there.
void mechanism_find_seen(mechanism_system *self);

#endif
