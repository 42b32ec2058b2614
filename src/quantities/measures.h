// Measures: results that a scenario asks for besides those that every run has. Each takes one
// column of the launch, or of the flights, rocket by rocket: its value at an instant, or its
// largest magnitude, root mean square or mean in a window between two.
#ifndef LD_SIMULATION_MEASURES_H
#define LD_SIMULATION_MEASURES_H

#include "model/fields/field.h"
#include "quantities/quantity_table.h"

// An instant of a rocket. The start is that of the run, of a later rocket when its tube took the
// place of the one before; the end when the next one's does, of the last that of the launch; in a
// flight that of the flight.
typedef struct measure_instant {
    enum {
        INSTANT_START,
        INSTANT_IGNITION,
        INSTANT_RELEASE,
        INSTANT_EXIT,
        INSTANT_BURNOUT, // from here on of a flight
        INSTANT_APOGEE,
        INSTANT_IMPACT,
        INSTANT_END
    } kind;
    int adaptor; // of an exit
} measure_instant;

// A measure as a simulation takes it.
typedef struct measure_plan {
    bool flight; // of a column of the rocket's flight, not of the launch
    int column;
    ld_take take;
    measure_instant from, to; // of a value the same
    double within[2];         // [s] since `from`
} measure_plan;

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
