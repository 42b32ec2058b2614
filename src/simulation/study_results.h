// What a study keeps of each rocket.
#ifndef LD_SIMULATION_STUDY_RESULTS_H
#define LD_SIMULATION_STUDY_RESULTS_H

#include <stddef.h>

#include "simulation/summary.h"

typedef struct study_result {
    const char *name; // of its column
    const char *unit; // SI
    size_t offset;    // of the double in ld_rocket_summary
} study_result;

extern const study_result study_results[]; // ends with a NULL name
enum { STUDY_RESULTS = 52 };

// The result with that name, or NULL.
const study_result *study_result_named(const char *name);

// Two results of one unit that scatter together.
typedef struct study_pair {
    const char *title;
    const char *name[2];
    const char *unit; // SI
} study_pair;

enum { STUDY_PAIRS = 5 };
extern const study_pair study_pairs[STUDY_PAIRS];

double study_result_of(const ld_rocket_summary *rocket, const study_result *result);

#endif
