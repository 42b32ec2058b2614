// The expressions of measures: what their names are, how they are computed.
#ifndef LD_RUN_MEASURE_EXPRESSIONS_H
#define LD_RUN_MEASURE_EXPRESSIONS_H

#include "quantities/measuring.h"

// Plans the expression of measure i (from 0) and, behind what is planned, the windows in it; false:
// it is refused. Measures before it have their units.
bool measure_express(const ld_model *model, int i, measure_plans *plans, units_dimension *unit,
                     expression_refusal *refusal);

// Plans a measure of one column between good instants; false: it is not.
bool measure_plan_window(const ld_model *model, const ld_measure *measure, measure_plan *plan);

#endif
