#include "scenario/foreign_tables.h"

#include <stdio.h>
#include <string.h>

#include "math/functions.h"
#include "model/moist_air.h"

// What a column of a sounding may be, in SI units; winds by where they come from.
typedef enum quantity {
    HEIGHT,
    GEOPOTENTIAL, // height of that
    PRESSURE,
    TEMPERATURE,
    DEW_POINT,
    HUMIDITY,
    EAST,
    NORTH,
    DIRECTION,
    SPEED,
    QUANTITIES
} quantity;

#define DEGREE 0.017453292519943295
#define KNOT (1852.0 / 3600)
#define CELSIUS 273.15

typedef struct known_column {
    const char *name, *unit; // the unit as the list writes it
    quantity is;
    double factor, offset;
} known_column;

// By the header of a CSV file, in which names have their units; others are passed over.
static const known_column csv_columns[] = {{"height", NULL, HEIGHT, 1, 0},
                                           {"pressure", NULL, PRESSURE, 1, 0},
                                           {"temperature", NULL, TEMPERATURE, 1, 0},
                                           {"wind_u", NULL, EAST, 1, 0},
                                           {"wind_v", NULL, NORTH, 1, 0},
                                           {"pressure_hPa", NULL, PRESSURE, 100, 0},
                                           {"geopotential height_m", NULL, GEOPOTENTIAL, 1, 0},
                                           {"temperature_C", NULL, TEMPERATURE, 1, CELSIUS},
                                           {"relative humidity_%", NULL, HUMIDITY, 0.01, 0},
                                           {"wind direction_degree", NULL, DIRECTION, DEGREE, 0},
                                           {"wind speed_m/s", NULL, SPEED, 1, 0},
                                           {0}};

// By the two lines above the list of the University of Wyoming.
static const known_column list_columns[] = {
    {"PRES", "hPa", PRESSURE, 100, 0},      {"HGHT", "m", GEOPOTENTIAL, 1, 0},
    {"TEMP", "C", TEMPERATURE, 1, CELSIUS}, {"RELH", "%", HUMIDITY, 0.01, 0},
    {"DRCT", "deg", DIRECTION, DEGREE, 0},  {"SKNT", "knot", SPEED, KNOT, 0},
    {"SPED", "m/s", SPEED, 1, 0},           {0}};
enum { LIST_WIDTH = 7 }; // of a column, numbers at its right

// Of NOAA's format GSD, whose pressures and winds have units of their own in each file.
enum { GSD_COLUMNS = 7, GSD_MORE = 3, GSD_DATA = 4, GSD_LAST_DATA = 9 };
#define GSD_MISSING 32767.0

// A sounding as it is read.
typedef struct sounding {
    line_reader *lines;
    const table_format *format; // of the table
    ld_table *table;
    const known_column *known[QUANTITIES];
    int column[QUANTITIES]; // of the file, from 0
    int columns;            // of the file, GSD's aside
} sounding;

static bool has_quantity(const sounding *self, quantity is)
{
    return self->known[is] != NULL;
}

// ---- rows

// The quantities that follow from others.
static void complete(double value[QUANTITIES])
{
    const double radius = 6356766; // of us1976
    if (isnan(value[HEIGHT]))
        value[HEIGHT] = radius * value[GEOPOTENTIAL] / (radius - value[GEOPOTENTIAL]);
    if (isnan(value[HUMIDITY]))
        value[HUMIDITY] =
            vapour_pressure(value[DEW_POINT], 1) / vapour_pressure(value[TEMPERATURE], 1);
    value[HUMIDITY] = isnan(value[HUMIDITY]) ? 0 : fmin(value[HUMIDITY], 1);
    if (isnan(value[EAST])) {
        value[EAST] = -value[SPEED] * sin(value[DIRECTION]);
        value[NORTH] = -value[SPEED] * cos(value[DIRECTION]);
    }
}

static bool is_of_air(const table_format *format)
{
    return strcmp(format->column[1].name, "pressure") == 0;
}

// Field of the line at hand that holds a quantity, for messages.
static int field_of(const sounding *self, quantity is)
{
    static const quantity source[QUANTITIES][2] = {[HEIGHT] = {GEOPOTENTIAL, HEIGHT},
                                                   [PRESSURE] = {PRESSURE, PRESSURE},
                                                   [TEMPERATURE] = {TEMPERATURE, TEMPERATURE},
                                                   [HUMIDITY] = {HUMIDITY, DEW_POINT},
                                                   [EAST] = {SPEED, EAST},
                                                   [NORTH] = {SPEED, NORTH}};
    quantity given = source[is][has_quantity(self, source[is][0]) ? 0 : 1];
    return has_quantity(self, given) ? self->column[given] : 0;
}

// Whether a row's numbers are those of an atmosphere; false after a message.
static bool is_in_range(const sounding *self, const quantity *wanted, const double *row)
{
    for (int i = 0; i < self->format->columns; i++) {
        const field_row *column = &self->format->column[i];
        char text[192], expected[128];
        if (field_in_range(column->range, row[i]))
            continue;
        field_range_text(column, expected, sizeof expected);
        snprintf(text, sizeof text, "found a %s of %g%s%s; expected %s",
                 wanted[i] == EAST || wanted[i] == NORTH ? "wind" : column->name, row[i],
                 column->unit[0] ? " " : "", column->unit, expected);
        line_refuse(self->lines, field_of(self, wanted[i]), text);
        return false;
    }
    return true;
}

// Puts a row into the table; one that lacks a number, does not rise or whose pressure does not fall
// is passed over.
static void keep_row(sounding *self, double value[QUANTITIES])
{
    static const quantity of_air[] = {HEIGHT, PRESSURE, TEMPERATURE, HUMIDITY},
                          of_wind[] = {HEIGHT, NORTH, EAST};
    bool air = is_of_air(self->format);
    const quantity *wanted = air ? of_air : of_wind;
    double row[FIELD_MAX_COLUMNS] = {0};
    complete(value);
    for (int i = 0; i < self->format->columns; i++) {
        row[i] = value[wanted[i]];
        if (isnan(row[i]))
            return;
    }
    const ld_table *table = self->table;
    const double *before =
        table->rows > 0 ? table->data + (table->rows - 1) * table->columns : NULL;
    if (before && (row[0] <= before[0] || (air && row[1] >= before[1])))
        return;
    if (is_in_range(self, wanted, row))
        line_append(self->lines, self->table, (size_t)self->format->columns, row);
}

static void forget(double value[QUANTITIES])
{
    for (int i = 0; i < QUANTITIES; i++)
        value[i] = NAN;
}

// ---- columns

static sounding begin(line_reader *lines, const table_format *format, ld_table *table)
{
    const table_format *widest = is_of_air(format) && format->other ? format->other : format;
    lines->sounding = true;
    return (sounding){.lines = lines, .format = widest, .table = table};
}

// Refuses a header that lacks what the table needs.
static void check_columns(sounding *self)
{
    bool air = is_of_air(self->format);
    const char *missing = NULL;
    if (!has_quantity(self, HEIGHT) && !has_quantity(self, GEOPOTENTIAL))
        missing = "heights";
    else if (air && !has_quantity(self, PRESSURE))
        missing = "pressures";
    else if (air && !has_quantity(self, TEMPERATURE))
        missing = "temperatures";
    else if (!air && !(has_quantity(self, EAST) && has_quantity(self, NORTH)) &&
             !(has_quantity(self, SPEED) && has_quantity(self, DIRECTION)))
        missing = "winds";
    char text[160];
    if (!missing)
        return;
    snprintf(text, sizeof text,
             "found no known column of %s in this header; a table of other columns requires units "
             "in brackets",
             missing);
    line_refuse(self->lines, 0, text);
}

static void check_rows(const sounding *self)
{
    if (!self->lines->failed && self->table->rows == 0)
        line_refuse(self->lines, 0,
                    is_of_air(self->format) ? "found no row with height, pressure and temperature"
                                            : "found no row with height and wind");
}

bool sounding_is_header(const line_reader *lines)
{
    for (int i = 0; i < lines->at.count; i++)
        if (strchr(lines->at.field[i], '[') || strchr("0123456789+-.", lines->at.field[i][0]))
            return false;
    return true;
}

void sounding_read_csv(line_reader *lines, const table_format *format, ld_table *table)
{
    sounding self = begin(lines, format, table);
    for (int i = 0; i < lines->at.count; i++)
        for (const known_column *known = csv_columns; known->name; known++)
            if (strcmp(lines->at.field[i], known->name) == 0) {
                self.known[known->is] = known;
                self.column[known->is] = i;
            }
    self.columns = lines->at.count;
    check_columns(&self);
    while (line_next(lines, '#', true)) {
        double value[QUANTITIES];
        if (!line_is_as_long(lines, self.columns))
            return;
        forget(value);
        for (int i = 0; i < QUANTITIES; i++) {
            int field = self.column[i];
            const known_column *known = self.known[i];
            if (!known || !lines->at.field[field][0])
                continue;
            if (!line_number(lines, field, &value[i]))
                return;
            value[i] = known->factor * value[i] + known->offset;
        }
        keep_row(&self, value);
    }
    check_rows(&self);
}

// ---- the list of the University of Wyoming

// Number of the column of a field of the line at hand: where columns are blank the one at whose
// right it ends.
static int list_column(const sounding *self, int field)
{
    const text_lines *at = &self->lines->at;
    if (at->count == self->columns)
        return field;
    return (at->column[field] + (int)strlen(at->field[field]) - 2) / LIST_WIDTH;
}

// The units below the names; false after a message.
static bool take_units(sounding *self)
{
    line_reader *lines = self->lines;
    if (!line_next(lines, '-', false)) {
        if (!lines->failed)
            line_refuse(lines, 0, "the list ends before the line of units");
        return false;
    }
    for (int i = 0; i < QUANTITIES; i++) {
        char text[160];
        int field = 0;
        while (self->known[i] && field < lines->at.count &&
               list_column(self, field) != self->column[i])
            field++;
        if (self->known[i] && (field == lines->at.count ||
                               strcmp(lines->at.field[field], self->known[i]->unit) != 0)) {
            snprintf(text, sizeof text, "below %s the unit must be %s", self->known[i]->name,
                     self->known[i]->unit);
            line_refuse(lines, field, text);
            return false;
        }
    }
    return true;
}

// Whether each number of a line stands in a column of its own; false after a message.
static bool is_in_columns(const sounding *self)
{
    const text_lines *at = &self->lines->at;
    for (int field = 0, before = -1; field < at->count; field++) {
        int column = list_column(self, field);
        if (column <= before || column >= self->columns) {
            line_refuse(
                self->lines, field,
                "found a number outside the columns; it must end below the end of a column's name");
            return false;
        }
        before = column;
    }
    return true;
}

static void read_list(sounding *self)
{
    line_reader *lines = self->lines;
    self->columns = lines->at.count;
    for (int i = 0; i < lines->at.count; i++)
        for (const known_column *known = list_columns; known->name; known++)
            if (strcmp(lines->at.field[i], known->name) == 0) {
                self->known[known->is] = known;
                self->column[known->is] = i;
            }
    check_columns(self);
    if (lines->failed || !take_units(self))
        return;
    // the list ends where a line begins with a word
    while (line_next(lines, '-', false) && strchr("0123456789.", lines->at.field[0][0])) {
        double value[QUANTITIES];
        if (!is_in_columns(self))
            return;
        forget(value);
        for (int field = 0; field < lines->at.count; field++)
            for (int i = 0; i < QUANTITIES; i++) {
                const known_column *known = self->known[i];
                if (!known || list_column(self, field) != self->column[i])
                    continue;
                if (!line_number(lines, field, &value[i]))
                    return;
                value[i] = known->factor * value[i] + known->offset;
            }
        keep_row(self, value);
        if (lines->failed)
            return;
    }
}

// ---- NOAA's format GSD

// The line's type, 0 to 9; -1 where it has none.
static int gsd_type(const text_lines *at)
{
    const char *first = at->field[0];
    return strlen(first) == 1 && first[0] >= '0' && first[0] <= '9' ? first[0] - '0' : -1;
}

// A line of data: type, pressure, height, temperature, dew point, direction and speed of the wind.
// Old files have pressures in hPa, newer ones in tenths of them.
static void read_gsd_row(sounding *self, double speed, double *pressure)
{
    static const known_column columns[GSD_COLUMNS] = {{0},
                                                      {"", NULL, PRESSURE, 1, 0},
                                                      {"", NULL, GEOPOTENTIAL, 1, 0},
                                                      {"", NULL, TEMPERATURE, 0.1, CELSIUS},
                                                      {"", NULL, DEW_POINT, 0.1, CELSIUS},
                                                      {"", NULL, DIRECTION, DEGREE, 0},
                                                      {"", NULL, SPEED, 1, 0}};
    line_reader *lines = self->lines;
    double value[QUANTITIES];
    forget(value);
    if (lines->at.count != GSD_COLUMNS && lines->at.count != GSD_COLUMNS + GSD_MORE) {
        line_refuse(lines, 0,
                    "expected a level of seven numbers (type, pressure, height, temperature, dew "
                    "point, wind direction, wind speed) or of ten (also time, bearing, range)");
        return;
    }
    for (int i = 1; i < GSD_COLUMNS; i++) {
        double number;
        if (!line_number(lines, i, &number))
            return;
        quantity is = columns[i].is;
        self->known[is] = &columns[i];
        self->column[is] = i;
        if (fabs(number) < GSD_MISSING)
            value[is] = columns[i].factor * number + columns[i].offset;
    }
    if (*pressure == 0 && !isnan(value[PRESSURE]))
        *pressure = value[PRESSURE] > 1100 ? 10 : 100;
    value[PRESSURE] *= *pressure;
    value[SPEED] *= speed;
    keep_row(self, value);
}

// From the line at hand, the first of data, on.
static void read_gsd(sounding *self, const char *wind_unit)
{
    line_reader *lines = self->lines;
    double pressure = 0, speed = strcmp(wind_unit, "ms") == 0 ? 0.1 : KNOT;
    do
        read_gsd_row(self, speed, &pressure);
    while (!lines->failed && line_next(lines, '#', false) && gsd_type(&lines->at) >= GSD_DATA);
}

// ---- a text

void sounding_read_text(line_reader *lines, const table_format *format, ld_table *table)
{
    sounding self = begin(lines, format, table);
    char wind_unit[8] = "";
    int type = -1, before;
    while (line_next(lines, '#', false)) {
        if (strcmp(lines->at.field[0], "PRES") == 0) {
            read_list(&self);
            check_rows(&self);
            return;
        }
        before = type;
        type = gsd_type(&lines->at);
        if (type == 3)
            snprintf(wind_unit, sizeof wind_unit, "%s", lines->at.field[lines->at.count - 1]);
        if (before == 3 && type >= GSD_DATA && type <= GSD_LAST_DATA) {
            if (strcmp(wind_unit, "kt") != 0 && strcmp(wind_unit, "ms") != 0) {
                line_refuse(lines, 0,
                            "expected the line above to end with the wind's unit, kt or ms");
                return;
            }
            read_gsd(&self, wind_unit);
            check_rows(&self);
            return;
        }
    }
    if (!lines->failed)
        line_refuse(lines, 0,
                    "not a sounding; expected a list of the University of Wyoming (columns PRES, "
                    "HGHT, TEMP, ...) or NOAA's GSD format");
}
