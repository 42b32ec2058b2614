// What the report of studies shows, as JSON. All statistics are computed here, none in the page.
#ifndef LD_REPORT_REPORT_STUDY_PAGE_H
#define LD_REPORT_REPORT_STUDY_PAGE_H

#include <stdio.h>

#include "report/report_study_source.h"

// Writes all that the page shows as JSON; records what cannot be read.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_data(FILE *json, study_source *source);

#endif
