// Numbers of a study as its tables print them.
#ifndef LD_STUDIES_SHOW_NUMBERS_H
#define LD_STUDIES_SHOW_NUMBERS_H

#include <stdio.h>

#include "studies/statistics/statistics.h"
#include "studies/store/study_data.h"

// Significant digits that show a value of this size to two digits of `spread`, at least `least`;
// 12 at most.
int show_digits(double value, double spread, int least);

// "t_front [s]", at least as wide as said; how wide the widest of several is, 26 or more.
enum { SHOW_NAME = 26 };
void show_name(FILE *stream, int width, const char *result, const char *unit);
int show_name_width(const study_column *const *column, int count);
// The same of a result of a study, in the unit in which people read it.
void show_result(FILE *stream, int width, const study_column *column);

// An estimate or what else is known of a result, in that unit.
estimate show_scaled(const estimate *e, double factor);
group_statistics show_in_unit(const group_statistics *of, const study_column *column);

// What was not found is printed as "-", a negative zero as 0.
void show_text(char text[32], double value, int digits);
void show_number(FILE *stream, int width, double value, int digits);

// "37.125 +- 0.02": so many digits, or as many as show half the interval and have room.
void show_half(FILE *stream, int width, const estimate *e, int least);

// "8.31 [8.24, 8.37]": four digits, or as many as show two of the spread and have room; width 0:
// what ends a line.
void show_estimate(FILE *stream, int width, const estimate *e, double spread);

#endif
