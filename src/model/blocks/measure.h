/// Results that a scenario defines: the block `measures`.
#ifndef LD_MODEL_BLOCKS_MEASURE_H
#define LD_MODEL_BLOCKS_MEASURE_H

#include "model/blocks/limits.h"
#include "model/blocks/table.h"

typedef enum ld_take {
    LD_TAKE_VALUE,
    LD_TAKE_PEAK,
    LD_TAKE_CHANGE,
    LD_TAKE_RMS,
    LD_TAKE_MEAN,
    LD_TAKE_LARGEST,
    LD_TAKE_LEAST,
    LD_TAKE_EXPRESSION // of other results and of windows
} ld_take;

/// A result that the scenario asks for: what a column of the launch is at an instant of a rocket,
/// or in a window between two. Instants: start, t_ignition, t_release, t_front, t_middle, t_rear,
/// t_exit.NAME, end. With one of t_burnout, t_apogee, t_impact it is a column of the rocket's
/// flight.
typedef struct ld_measure {
    char name[LD_MAX_NAME];   ///< the result is called measure.NAME
    char of[LD_MAX_QUANTITY]; ///< column
    ld_take take; ///< its value, largest magnitude, change since `from`, root mean square, mean,
                  ///< largest, least value, or an expression
    char from[LD_MAX_QUANTITY]; ///< instant of a value, or at which the window begins
    char to[LD_MAX_QUANTITY];   ///< instant at which it ends; of a value ""
    double within[2];           ///< [s] since `from`: of the window only what lies between these
    char *expression;           ///< owned by the model
    char unit[LD_MAX_UNIT];     ///< of the expression, SI; "": none
} ld_measure;

#endif
