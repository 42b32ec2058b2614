// Measures: results that a scenario asks for besides those that every run has. Each takes one
// column of the launch, or of the flights, rocket by rocket: its value at an instant, or its
// largest magnitude, root mean square or mean in a window between two; or it is an expression of
// other results and of such figures.
#ifndef LD_RUN_MEASURES_H
#define LD_RUN_MEASURES_H

#include "model/fields/field.h"
#include "quantities/measuring.h"
#include "quantities/quantity_table.h"

// Reports each measure that cannot be taken: of no column, at no instant, in a window that never
// comes.
void measures_check(const ld_model *model, rule_report *report, void *self);

// Finds the units of expressions, which their results keep; those that are wrong have none.
void measures_complete(ld_model *model);

// How the model's measures are taken from the rows of its launch and of its flights. LD_ERR_INPUT:
// one cannot be.
ld_status measures_build(const ld_model *model, measure_plans *plans, ld_error *error);

#endif
