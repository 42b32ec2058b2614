// What came of one sample, as flat memory: it goes from who ran it to who keeps it.
#ifndef LD_STUDIES_RECORD_H
#define LD_STUDIES_RECORD_H

#include <stddef.h>
#include <stdint.h>

#include "launchdyn/status.h"

// How many numbers a record holds; of a study, the most that one may hold.
typedef struct study_shape {
    int64_t rockets;
    int64_t of_sample, of_rocket; // values sampled once a sample, and for every rocket
    int64_t results;              // of every rocket
} study_shape;

// `value`: those sampled for the sample, then of each rocket in the order of firing its tube, the
// values sampled for it, its results (NaN: did not happen).
typedef struct study_record {
    int64_t number;  // of the sample, from 1
    int64_t outcome; // an ld_status
    study_shape shape;
    char reason[LD_ERROR_TEXT]; // where the outcome is not LD_OK
    double value[];
} study_record;

// Numbers of one rocket.
static inline int64_t record_width(const study_shape *shape)
{
    return 1 + shape->of_rocket + shape->results;
}

// Where the numbers of rocket `rocket` begin, from 0.
static inline int64_t record_rocket(const study_shape *shape, int64_t rocket)
{
    return shape->of_sample + rocket * record_width(shape);
}

// Bytes.
static inline size_t record_size(const study_shape *shape)
{
    return sizeof(study_record) + (size_t)record_rocket(shape, shape->rockets) * sizeof(double);
}

#endif
