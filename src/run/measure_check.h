// What is wrong with a measure, or with a window in an expression.
#ifndef LD_RUN_MEASURE_CHECK_H
#define LD_RUN_MEASURE_CHECK_H

#include "model/fields/field.h"
#include "run/measure_names.h"

typedef struct measure_check {
    const ld_model *model;
    rule_report *report;
    void *self;
    int number; // of the measure, from 1
    char *why;  // [EXPRESSION_WHY] takes what is wrong in place of `report`; NULL: it does not
} measure_check;

// The column (of "" nothing is said), the instants, their order, that the window occurs.
void measure_check_window(const measure_check *check, const ld_measure *measure);
// That no measure before it has its name.
void measure_check_name(const measure_check *check, const ld_measure *measure);

#endif
