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
    size_t *launch;             // [count] from 0, as the file has them
} measured_result;

typedef struct measured {
    size_t count, salvos; // salvos 0: every launch stands for itself
    int results;
    measured_result *result; // [results] in the order of the file's columns
} measured;

// What names of columns stand for.
typedef struct measured_names {
    const char *none; // what is said of another name: "the study has no result"
    // The SI unit of what is called `name`, and the name that it has now; NULL: there is none, but
    // `near`, or "", may be meant.
    const char *(*unit_of)(const void *self, const char *name, char now[MEASURED_NAME],
                           char near[MEASURED_NAME]);
    const void *self;
} measured_names;

// Reads a file whose header names such columns, with units; the rest as measured_read().
ld_status measured_read_named(const char *file, const measured_names *names, measured *launches,
                              ld_error *error);

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
