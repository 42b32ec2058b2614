// Measured launches in the report of studies.
#ifndef LD_REPORT_REPORT_STUDY_MEASURED_H
#define LD_REPORT_REPORT_STUDY_MEASURED_H

#include <stdio.h>

#include "report/report_study_source.h"

// Writes the measured launches and, of each result, how far each series is from them: an object, or
// null where there are none.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_measured(FILE *json, study_source *source);

#endif
