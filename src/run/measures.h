// Measures: results that a scenario asks for besides those that every run has. Each takes one
// column of the launch, or of the flights, rocket by rocket: its value at an instant, or its
// largest magnitude, root mean square or mean in a window between two.
#ifndef LD_RUN_MEASURES_H
#define LD_RUN_MEASURES_H

#include "model/fields/field.h"
#include "quantities/measuring.h"
#include "quantities/quantity_table.h"

// Reports each measure that cannot be taken: of no column, at no instant, in a window that never
// comes.
void measures_check(const ld_model *model, rule_report *report, void *self);

// Unit of a quantity, SI; "" or "1": none. A measure has that of the column that it is of.
const char *quantity_unit(const quantity_walk *at);
// That of measure `item` of a model, from 0.
const char *measure_unit(const ld_model *model, int item);

// How the model's measures are taken from the rows of its launch and of its flights. LD_ERR_INPUT:
// one cannot be.
ld_status measures_build(const ld_model *model, measure_plan plan[LD_MAX_MEASURES],
                         ld_error *error);

#endif
