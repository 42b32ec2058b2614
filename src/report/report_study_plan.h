// What a study was asked to do: plan, factors with their distributions, sweep.
#ifndef LD_REPORT_REPORT_STUDY_PLAN_H
#define LD_REPORT_REPORT_STUDY_PLAN_H

#include <stdio.h>

#include "report/report_study_source.h"

// Writes what study number `index` was asked to do and where it comes from, an item of a list.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_plan(FILE *json, const study_source *source, int index);

#endif
