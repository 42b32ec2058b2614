// Soundings: measured air and wind over the height, as weather services and RocketPy write them.
#ifndef LD_SCENARIO_SOUNDING_FILE_H
#define LD_SCENARIO_SOUNDING_FILE_H

#include "model/fields/field.h"
#include "scenario/line_reader.h"

// Whether the line at hand is the header of a sounding, not that of a table with units in brackets
// or a row of numbers.
bool sounding_is_header(const line_reader *lines);

// The rest of a CSV file whose header is the line at hand: of RocketPy (height, pressure,
// temperature, wind_u, wind_v in SI units) or of the University of Wyoming (pressure_hPa, ...). Of
// the columns it takes those of `format`; what is wrong is reported, lines->failed then.
void sounding_read_csv(line_reader *lines, const table_format *format, ld_table *table);

// A text: the list of the University of Wyoming, or the format GSD of NOAA.
void sounding_read_text(line_reader *lines, const table_format *format, ld_table *table);

#endif
