// What a study keeps of each rocket: the quantities of a rocket that are marked so, in their order.
#ifndef LD_QUANTITIES_STUDY_RESULTS_H
#define LD_QUANTITIES_STUDY_RESULTS_H

#include "quantities/summary_quantities.h"

// A way through them, as quantity_first and quantity_next.
quantity_walk study_result_first(const quantity_things *things);
void study_result_next(quantity_walk *walk);
int study_result_count(const quantity_things *things);
void study_result_name(const quantity_walk *at, char name[QUANTITY_NAME]);

// That of this name; row NULL: there is none. `near`: the name that may be meant, or "".
quantity_walk study_result_find(const quantity_things *things, const char *name);
void study_result_near(const quantity_things *things, const char *name, char near[QUANTITY_NAME]);

// The row of a result with that name, whatever the adaptors are called; NULL: none.
const quantity *study_result_like(const char *name);

// Whether the scenario itself asks for the result of that name.
bool study_result_is_measure(const char *name);

// The unit in which people read a result in SI unit `si`, "mrad/s", and the factor to it.
typedef struct study_unit {
    const char *name;
    double factor;
} study_unit;
study_unit study_result_unit(const char *name, const char *si);

// Two results of one unit that scatter together.
typedef struct study_pair {
    const char *title;
    const char *name[2];
    const char *unit; // SI
} study_pair;

enum { STUDY_PAIRS = 5, STUDY_LANDING = 0 }; // that of the landing points
extern const study_pair study_pairs[STUDY_PAIRS];

#endif
