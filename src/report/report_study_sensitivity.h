// Sensitivities in the report of studies: how much of a result's variance each factor makes alone.
#ifndef LD_REPORT_REPORT_STUDY_SENSITIVITY_H
#define LD_REPORT_REPORT_STUDY_SENSITIVITY_H

#include <stdio.h>

#include "report/report_study_source.h"

// Writes the sensitivities of chosen results to all factors, as items of a list.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_sensitivities(FILE *json, study_source *source);

#endif
