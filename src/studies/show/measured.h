// Measured launches, read from a CSV file: results of a study with units, a line a launch.
#ifndef LD_STUDIES_MEASURED_H
#define LD_STUDIES_MEASURED_H

#include "studies/statistics/agreement.h"
#include "studies/store/study_data.h"

enum { MEASURED_NAME = 96, MEASURED_UNIT = 32 };

// A result as measured.
typedef struct measured_result {
    char name[MEASURED_NAME];   // of the study's result
    char former[MEASURED_NAME]; // its former name, if the file has that, or ""
    char unit[MEASURED_UNIT];   // as the file has it
    double factor;              // from that to SI
    size_t count;               // launches that have a value
    double *value;              // [count] SI
    int64_t *group;             // [count] rises: the launch's salvo, or the launch
} measured_result;

typedef struct measured {
    size_t count, salvos; // salvos 0: every launch stands for itself
    int results;
    measured_result *result; // [results] in the order of the file's columns
} measured;

// Reads a file whose header names results of the study, "t_front [ms], exit_speed [m/s]", and may
// name a column `salvo`; an empty field is a missing value (docs/study.md).
// @param launches to be freed; empty on failure
// @return LD_OK, LD_ERR_INPUT (with file, line and column), LD_ERR_FILE, LD_ERR_MEMORY
ld_status measured_read(const char *file, const study_data *data, measured *launches,
                        ld_error *error);
void measured_free(measured *launches);

// Keeps the results that the text names, with commas between, in its order.
// @return LD_OK, LD_ERR_INPUT (the file, or the study, has no such result), LD_ERR_MEMORY
ld_status measured_choose(measured *launches, const char *names, const study_data *data,
                          ld_error *error);

// A measured result beside that of a study.
typedef struct measured_comparison {
    group_statistics measured, simulated; // without least, greatest and quantiles
    agreement by;                         // measured less, or over, simulated
} measured_comparison;

// `values`: the study's, of this result.
// @return LD_OK, LD_ERR_MEMORY
ld_status measured_compare(const measured_result *result, const study_values *values,
                           measured_comparison *found);

#endif
