// What factors do to results, printed: of the plans of Saltelli and Morris.
#ifndef LD_STUDIES_SHOW_INFLUENCE_H
#define LD_STUDIES_SHOW_INFLUENCE_H

#include "results/json.h"
#include "studies/points/influence.h"
#include "studies/show/shown.h"

// A table of each result shown, factors in rows, and what it says in a sentence.
ld_status show_influences(shown *self, const study_point *point, ld_error *error);

// The same of one of the results shown, as members of the open object.
ld_status show_influences_json(json_writer *json, shown *self, const study_point *point, int result,
                               ld_error *error);

#endif
