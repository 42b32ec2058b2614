// Times of clocks that count from long ago: a double of 1.7e9 s knows no tenth of a microsecond,
// and a spline through rows 10 ms apart would feel that. So a table keeps the whole seconds of its
// first row apart, and they are taken off, or put back, in the digits of the text.
#ifndef LD_SCENARIO_CLOCK_TEXT_H
#define LD_SCENARIO_CLOCK_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CLOCK_TEXT = 64 };

// The time [s] that stands in a text, which begins with a number, `value`, in units of `factor` s,
// less *origin [s]. `first`: *origin is found, whole seconds, 0 of a time that is below 1e5 s.
double clock_read(const char *text, double value, double factor, bool first, double *origin);

// The digits of a time [s] with its origin.
void clock_print(double time, double origin, char text[CLOCK_TEXT]);

#endif
