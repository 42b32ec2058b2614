// Units of measurement: one table of units with the base units m, kg, s, rad and K, so that an
// angle is not a number and a frequency in Hz is not an angular rate.
#ifndef LD_MODEL_UNITS_H
#define LD_MODEL_UNITS_H

#include "model/blocks/limits.h"

typedef enum units_result {
    UNITS_OK,
    UNITS_SYNTAX,    // not of the form N.m/rad, m3, kg.m2/s
    UNITS_UNKNOWN,   // names a unit that there is not: see `unknown`
    UNITS_DIMENSION, // of another dimension, or beyond UNITS_MOST_POWER
} units_result;

// Powers of the base units m, kg, s, rad and K; each at most UNITS_MOST_POWER.
enum { UNITS_BASES = 5, UNITS_MOST_POWER = 9, UNITS_TEXT = LD_MAX_UNIT };
typedef struct units_dimension {
    int power[UNITS_BASES];
} units_dimension;

// The factor of unit `text` ("" or "1": none) to SI and its dimension; `unknown` as below.
units_result units_read(const char *text, double *factor, units_dimension *dimension,
                        char unknown[32]);
// The SI unit of a dimension, "" without: "N.m", "kg.m2/s3".
void units_write(const units_dimension *dimension, char text[UNITS_TEXT]);

// Factor from unit `text` to `target` (an SI unit; "" for a plain number, where "%" is allowed).
// `unknown` (32 characters) receives the name of an unknown unit.
units_result units_factor(const char *text, const char *target, double *factor, char unknown[32]);

// value * factor, dividing by 1/factor where that is a whole number, so that 82.5 mm is 0.0825.
double units_scale(double value, double factor);

// The unit that was probably meant by an unknown name, or NULL.
const char *units_suggestion(const char *unknown);

#endif
