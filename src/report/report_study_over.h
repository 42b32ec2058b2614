// What a sweep does, for the first screen of its report: results over the values of each swept key,
// pooled over the others, and which key moves the rates at the exit most.
#ifndef LD_REPORT_REPORT_STUDY_OVER_H
#define LD_REPORT_REPORT_STUDY_OVER_H

#include <stdio.h>

#include "report/report_study_source.h"

// Writes {keys, results, lead} of the one study that sweeps keys; null of several studies, and of
// one without a sweep.
ld_status study_write_over(FILE *json, study_source *source);

#endif
