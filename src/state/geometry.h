// What there is to draw of a launcher.
#ifndef LD_STATE_GEOMETRY_H
#define LD_STATE_GEOMETRY_H

#include "state/simulation.h"

// Hands places, sizes and mode shapes of the launcher to the sink, where it requires them.
ld_status simulation_geometry(const ld_simulation *self, const ld_sink *sink, ld_error *error);

#endif
