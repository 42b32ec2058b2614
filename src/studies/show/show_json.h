// What a study's folder holds, as JSON; the shape is in docs/command.md.
#ifndef LD_STUDIES_SHOW_JSON_H
#define LD_STUDIES_SHOW_JSON_H

#include "studies/show/shown.h"

// Prints counts, failures and what the view asks for, statistics, sensitivities, differences from a
// point or from measured launches, of all points.
ld_status show_json(shown *self, ld_error *error);

#endif
