// What a study's folder holds, as JSON; the shape is in docs/command.md.
#ifndef LD_STUDIES_SHOW_JSON_H
#define LD_STUDIES_SHOW_JSON_H

#include "studies/shown.h"

// Prints counts, failures and statistics, or where the view asks for them sensitivities, of all
// points.
ld_status show_json(shown *self, ld_error *error);

#endif
