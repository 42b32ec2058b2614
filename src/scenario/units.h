// Units of measurement: a unit system of our own (base units m, kg, s, rad), so that an angle is
// not a number and a frequency in Hz is not an angular rate.
#ifndef LD_SCENARIO_UNITS_H
#define LD_SCENARIO_UNITS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct unit_system unit_system;

typedef enum units_result {
    UNITS_OK,
    UNITS_SYNTAX,    // not of the form N.m/rad, m3, kg.m2/s
    UNITS_UNKNOWN,   // names a unit that there is not: see `unknown`
    UNITS_DIMENSION, // of another dimension
    UNITS_MEMORY,
} units_result;

// The system of the whole program, built at first use (NULL without memory) and kept: udunits2
// never frees the prefixes of a system. Not for use by two threads at once.
unit_system *units_open(void);

// Factor from unit `text` to `target` (an SI unit; "" for a plain number, where "%" is allowed).
// `unknown` (32 characters) receives the name of an unknown unit.
units_result units_factor(unit_system *units, const char *text, const char *target, double *factor,
                          char unknown[32]);

// value * factor, dividing by 1/factor where that is a whole number, so that 82.5 mm is 0.0825.
double units_scale(double value, double factor);

// The unit that was probably meant by an unknown name, or NULL.
const char *units_suggestion(const char *unknown);

#endif
