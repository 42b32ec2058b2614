// Files of tables in notations of their own: rocksim_file.c, sounding_file.c, mesh_file.c.
#ifndef LD_SCENARIO_FOREIGN_TABLES_H
#define LD_SCENARIO_FOREIGN_TABLES_H

#include "model/fields/field.h"
#include "scenario/line_reader.h"

// Of all of them: what is wrong is reported, lines->failed then.

// RockSim .rse files: thrust, mass and centre of a motor over time, in XML. Reads the file of one
// engine, whose text the lines have not begun to read: of a format with two columns time and
// thrust, else what rocket.motor.masses holds, centres counted from the motor's front end.
void rocksim_read(line_reader *lines, const table_format *format, ld_table *table);

// Soundings: measured air and wind over the height, as weather services and RocketPy write them.
// Whether the line at hand is the header of a sounding, not that of a table with units in brackets
// or a row of numbers.
bool sounding_is_header(const line_reader *lines);
// The rest of a CSV file whose header is the line at hand: of RocketPy (height, pressure,
// temperature, wind_u, wind_v in SI units) or of the University of Wyoming (pressure_hPa, ...). Of
// the columns it takes those of `format`.
void sounding_read_csv(line_reader *lines, const table_format *format, ld_table *table);
// A text: the list of the University of Wyoming, or the format GSD of NOAA.
void sounding_read_text(line_reader *lines, const table_format *format, ld_table *table);

// Meshes in binary glTF 2 files (.glb, ISO/IEC 12113). Reads the triangles of the default scene,
// corners and colour, in the axes of the scene. Runs keep the file as base64, which begins so:
#define MESH_FILE_HEAD "glTF"
#define MESH_FILE_KEPT "Z2xURg"
void mesh_read(line_reader *lines, ld_table *table);

#endif
