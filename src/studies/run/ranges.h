// The samples of a study in ranges, each of which is run at one place. None crosses a number after
// which the stopping rule is checked: all programs that run the study cut it alike.
#ifndef LD_STUDIES_RANGES_H
#define LD_STUDIES_RANGES_H

#include "studies/plan/study.h"

typedef struct sample_range {
    int64_t first, last;
} sample_range;

typedef struct study_ranges {
    sample_range *item;
    int count;
} study_ranges;

// At most 4000 of a study without a stopping rule: a lost one is 0.025 % of it.
// @return LD_OK, LD_ERR_MEMORY
ld_status ranges_create(study_ranges *self, const ld_study *study, ld_error *error);
void ranges_free(study_ranges *self);

// The range of a sample, from 0; `count`: there is none.
int ranges_find(const study_ranges *self, int64_t number);

#endif
