// RockSim .rse files: thrust, mass and centre of a motor over time, in XML.
#ifndef LD_SCENARIO_ROCKSIM_FILE_H
#define LD_SCENARIO_ROCKSIM_FILE_H

#include "model/fields/field.h"
#include "scenario/line_reader.h"

// Reads the file of one engine, whose text the lines have not begun to read: of a format with two
// columns time and thrust, else what rocket.motor.masses holds, centres counted from the motor's
// front end. What is wrong is reported, lines->failed then.
void rocksim_read(line_reader *lines, const table_format *format, ld_table *table);

#endif
