// Two results of a study against each other: points, the ellipse, of a cloud that is not normal the
// contours of its density; of landing points their footprints.
#ifndef LD_REPORT_REPORT_STUDY_SCATTER_H
#define LD_REPORT_REPORT_STUDY_SCATTER_H

#include <stdio.h>

#include "report/report_study_source.h"

// Writes the pairs of results that are shown against each other, as items of a list.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_pairs(FILE *json, study_source *source);

#endif
