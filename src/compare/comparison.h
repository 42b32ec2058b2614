// A comparison while it is made.
#ifndef LD_COMPARE_COMPARISON_H
#define LD_COMPARE_COMPARISON_H

#include "compare/sensor.h"
#include "launchdyn/compare.h"

enum { COMPARISON_NOTES = 16, COMPARISON_NOTE = 256 };

// What a run gives beside the log.
typedef struct run_values {
    double *reading; // [sensors][rows]
    double *result;  // [results] NaN: not known
} run_values;

struct ld_comparison {
    history_data history;
    run_series run;
    measured_log log;
    int rocket;
    double *t;      // [rows] s from ignition
    char *compared; // [sensors][rows] 1: counts in the comparison
    run_values nominal;
    run_values u_num, u_input; // standard uncertainties; without arrays where not found
    ld_compared_clock clock;
    ld_compared_series *series; // [log.sensors] arrays owned
    ld_compared_result *result; // [log.results]
    csv_column *result_head;    // [log.results] units of their numbers
    char note[COMPARISON_NOTES][COMPARISON_NOTE];
    int notes;
};

void comparison_note(ld_comparison *self, const char *format, ...) LD_PRINTF(2, 3);

// Room for the values of a run. @return LD_OK, LD_ERR_MEMORY
ld_status run_values_make(run_values *values, const measured_log *log, ld_error *error);
void run_values_free(run_values *values);

#endif
