// A study beside measured launches, printed.
#ifndef LD_STUDIES_SHOW_MEASURED_H
#define LD_STUDIES_SHOW_MEASURED_H

#include <stdio.h>

#include "studies/show/measured.h"

// What was measured: the file, and how much it holds.
void show_launches(FILE *stream, const char *file, const measured *launches);

// A measured result beside that of a point of the study. `values` is used again from call to call.
ld_status show_measured_result(const measured_result *result, const study_data *data,
                               const study_point *point, study_values *values,
                               measured_comparison *of, ld_error *error);

// A table in the file's units: mean and deviation of each result, as measured and at a point of the
// study, how far they are apart, p; then which of them differ. `values` as above.
ld_status show_measured(FILE *stream, const measured *launches, const study_data *data,
                        const study_point *point, study_values *values, ld_error *error);

#endif
