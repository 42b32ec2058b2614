// What came of one sample, as flat memory: it goes from who ran it to who keeps it. The values
// drawn are not in it, they follow from the number.
#ifndef LD_STUDIES_RECORD_H
#define LD_STUDIES_RECORD_H

#include <stdint.h>

#include "simulation/study_results.h"

typedef struct study_rocket {
    int64_t tube;
    double result[STUDY_RESULTS]; // NaN: did not happen
} study_rocket;

typedef struct study_record {
    int64_t number;  // of the sample, from 1
    int64_t outcome; // an ld_status
    int64_t rockets;
    char reason[LD_ERROR_TEXT]; // where the outcome is not LD_OK
    study_rocket rocket[];      // in the order of firing
} study_record;

static inline size_t record_size(int64_t rockets)
{
    return sizeof(study_record) + (size_t)rockets * sizeof(study_rocket);
}

#endif
