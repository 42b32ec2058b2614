// Tables in files of their own: RASP .eng thrust curves, CSV; RockSim's and soundings elsewhere.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/fields/field.h"
#include "scenario/clock_text.h"
#include "scenario/foreign_tables.h"
#include "scenario/line_reader.h"

// ---- RASP .eng: comments, a header of seven fields, lines "time thrust" up to thrust 0

static void read_rasp_header(line_reader *lines)
{
    double propellant, total, value;
    if (!line_next(lines, ';', false)) {
        if (!lines->failed)
            line_refuse(lines, 0, "found no engine in this file");
        return;
    }
    if (lines->at.count < 7) {
        line_refuse(lines, 0,
                    "expected a header of seven fields: name, diameter, length, delays, propellant "
                    "mass, total mass, manufacturer");
        return;
    }
    if (line_number(lines, 1, &value) && line_number(lines, 2, &value) &&
        line_number(lines, 4, &propellant) && line_number(lines, 5, &total) && propellant > total)
        line_refuse(lines, 4, "the propellant mass exceeds the total mass of the engine");
}

// One point of the curve; the point 0, 0 is implied where the first is later.
static bool read_rasp_point(line_reader *lines, ld_table *table)
{
    const double origin[2] = {0, 0};
    double row[2];
    if (lines->at.count != 2) {
        line_refuse(lines, 0, "expected two numbers, time in s and thrust in N");
        return false;
    }
    if (!line_number(lines, 0, &row[0]) || !line_number(lines, 1, &row[1]))
        return false;
    double before = table->rows ? table->data[2 * (table->rows - 1)] : 0;
    if (row[0] < before)
        line_refuse(lines, 0,
                    table->rows ? "the time is less than that of the line above"
                                : "the time is before the ignition");
    else if (row[0] > 10000)
        line_refuse(lines, 0, "the time is larger than 10000 s");
    else if (table->rows >= 2 && row[0] == before && table->data[2 * (table->rows - 2)] == before)
        line_refuse(lines, 0, "the time is given three times");
    if (lines->failed)
        return false;
    if (table->rows == 0 && row[0] > 0 && !line_append(lines, table, 2, origin))
        return false;
    return line_append(lines, table, 2, row);
}

static void read_rasp(line_reader *lines, ld_table *table)
{
    read_rasp_header(lines);
    while (line_next(lines, ';', false)) {
        if (!read_rasp_point(lines, table))
            return;
        double thrust = table->data[2 * table->rows - 1];
        if (thrust == 0 && table->data[2 * table->rows - 2] > 0)
            break;
    }
    if (lines->failed)
        return;
    if (table->rows == 0)
        line_refuse(lines, 0, "the engine has no thrust curve");
    else if (line_next(lines, ';', false))
        line_refuse(lines, 0,
                    "the curve ends at thrust 0, but more lines follow (a second engine?)");
}

// ---- CSV: a header such as "t [s], x [m], .., roll [deg]", then rows of numbers

// Factor from the unit in brackets behind a column's name; NaN after a message.
static double header_factor(line_reader *lines, const field_row *column, int i)
{
    char name[32], unit[32], unknown[32], text[192];
    double factor;
    int end = 0;
    if (!column->unit[0] && i < lines->at.count && strcmp(lines->at.field[i], column->name) == 0)
        return 1;
    if (i < lines->at.count &&
        sscanf(lines->at.field[i], "%31[a-z_] [%31[^]]]%n", name, unit, &end) == 2 && end > 0 &&
        lines->at.field[i][end] == '\0' && strcmp(name, column->name) == 0 &&
        units_factor(unit, column->unit, &factor, unknown) == UNITS_OK)
        return factor;
    if (column->unit[0])
        snprintf(text, sizeof text,
                 "column %d of the header must be \"%s [unit]\" with a unit of %s in the brackets",
                 i + 1, column->name, column->unit);
    else
        snprintf(text, sizeof text, "column %d of the header must be \"%s\"", i + 1, column->name);
    line_refuse(lines, i, text);
    return NAN;
}

// Refuses names beyond the table's columns.
static void check_header_end(line_reader *lines, int columns)
{
    char text[128];
    if (lines->at.count <= columns)
        return;
    snprintf(text, sizeof text, "found %d columns in the header; expected %d", lines->at.count,
             columns);
    line_refuse(lines, columns, text);
}

// One number of a row, in SI; checks its range. `first`: of the first row.
static void read_cell(line_reader *lines, const field_row *column, int i, double factor, bool first,
                      double *value)
{
    char text[192], expected[128];
    if (!line_number(lines, i, value))
        return;
    if (i == 0 && lines->clock)
        *value = clock_read(lines->at.field[i], *value, factor, first, lines->clock);
    else
        *value = units_scale(*value, factor);
    if (!isfinite(*value)) {
        line_refuse(lines, i, "the number is too large");
    } else if (!field_in_range(column->range, *value)) {
        field_range_text(column, expected, sizeof expected);
        snprintf(text, sizeof text, "found %.40s; expected %s", lines->at.field[i], expected);
        line_refuse(lines, i, text);
    }
}

static void read_csv_row(line_reader *lines, const table_format *format, const double *factor,
                         ld_table *table)
{
    double row[FIELD_MAX_COLUMNS];
    char text[128];
    if (lines->at.count != format->columns) {
        snprintf(text, sizeof text, "expected %d numbers, found %d", format->columns,
                 lines->at.count);
        line_refuse(lines, 0, text);
        return;
    }
    for (int i = 0; i < format->columns && !lines->failed; i++)
        read_cell(lines, &format->column[i], i, factor[i], table->rows == 0, &row[i]);
    int turned = format->columns - 4;
    if (!lines->failed && format->sources & TABLE_QUATERNION && !field_is_unit(row + turned))
        line_refuse(lines, turned, NO_UNIT_QUATERNION);
    double before = table->rows > 0 ? table->data[(table->rows - 1) * table->columns] : -INFINITY;
    bool groups = format->sources & TABLE_GROUPS;
    if (!lines->failed && (groups ? row[0] < before : row[0] <= before)) {
        snprintf(text, sizeof text, "%s is %s than that of the row before", format->column[0].name,
                 groups ? "smaller" : "not larger");
        line_refuse(lines, 0, text);
    }
    if (!lines->failed)
        line_append(lines, table, (size_t)format->columns, row);
}

static void read_csv(line_reader *lines, const table_format *format, ld_table *table)
{
    double factor[FIELD_MAX_COLUMNS];
    if (!line_next(lines, '#', true) && !lines->failed)
        line_refuse(lines, 0, "the file is empty");
    if (!lines->failed && format->sources & TABLE_SOUNDING && sounding_is_header(lines)) {
        sounding_read_csv(lines, format, table);
        return;
    }
    // the header says which form of the table it is
    const table_format *given = field_table_format(format, (size_t)lines->at.count);
    format = given ? given : format;
    // a table that may do without a header is in SI units then
    bool bare = format->sources & TABLE_BARE && lines->at.count > 0 &&
                strchr("0123456789+-.", lines->at.field[0][0]);
    for (int i = 0; i < format->columns && !lines->failed; i++)
        factor[i] = bare ? 1 : header_factor(lines, &format->column[i], i);
    if (!bare && !lines->failed)
        check_header_end(lines, format->columns);
    if (bare)
        read_csv_row(lines, format, factor, table);
    while (line_next(lines, '#', true) && !lines->failed)
        read_csv_row(lines, format, factor, table);
    if (!lines->failed && table->rows == 0)
        line_refuse(lines, 0, "found no row of numbers");
}

bool table_file_read(scenario_reader *reader, const written_value *given, ld_table *table,
                     double *clock, bool *sounding)
{
    const char *name = given->text;
    const table_format *format = given->field->table;
    text_source *opened = reader_open(reader, given->at, given->path, name);
    line_reader lines = {.reader = reader, .path = given->path, .source = opened, .clock = clock};
    if (!opened)
        return false;
    lines.at = text_lines_begin(opened->text, opened->length);
    size_t length = strlen(name);
    if (strcmp(name + length - 4, ".eng") == 0)
        read_rasp(&lines, table);
    else if (strcmp(name + length - 4, ".rse") == 0)
        rocksim_read(&lines, format, table);
    else if (strcmp(name + length - 4, ".glb") == 0)
        mesh_read(&lines, table);
    else if (strcmp(name + length - 4, ".txt") == 0)
        sounding_read_text(&lines, format, table);
    else
        read_csv(&lines, format, table);
    *sounding = lines.sounding;
    return !lines.failed;
}
