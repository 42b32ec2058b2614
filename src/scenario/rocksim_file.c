#include "scenario/foreign_tables.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include <expat.h>

#include "model/masses.h"

enum { THRUST_COLUMNS = 2, MOST_ROWS = 100000 };

typedef struct rocksim_reader {
    line_reader *lines;
    ld_table *table;
    size_t columns;
    XML_Parser parser;
    int engines;
    bool in_engine;
    double diameter, length;  // [m] of the motor
    double whole, propellant; // [kg] at ignition
} rocksim_reader;

static void refuse(rocksim_reader *self, const char *format, ...) LD_PRINTF(2, 3);
static void refuse(rocksim_reader *self, const char *format, ...)
{
    char text[256];
    va_list arguments;
    if (self->lines->failed)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    line_refuse_at(self->lines, (int)XML_GetCurrentLineNumber(self->parser),
                   (int)XML_GetCurrentColumnNumber(self->parser) + 1, text);
    XML_StopParser(self->parser, XML_FALSE);
}

// The number of an attribute; 0 after a message.
static double number(rocksim_reader *self, const char *element, const XML_Char **attributes,
                     const char *name, double least)
{
    double value;
    char quoted[64];
    const char *reason = NULL, *text = NULL;
    for (; attributes[0] && !text; attributes += 2)
        if (strcmp(attributes[0], name) == 0)
            text = attributes[1] + strspn(attributes[1], " ");
    const char *end = text ? number_parse(text, &value, &reason) : NULL;
    if (!text)
        refuse(self, "this %s has no attribute \"%s\"", element, name);
    else if (!end || end[strspn(end, " ")] != '\0')
        refuse(self, "%s: found %s%s%s; expected a number", name, reader_quote(text, quoted),
               reason ? ", " : "", reason ? reason : "");
    else if (value < least)
        refuse(self, "%s: found %s; expected a number >= 0", name, reader_quote(text, quoted));
    return self->lines->failed ? 0 : value;
}

static void read_engine(rocksim_reader *self, const XML_Char **attributes)
{
    if (++self->engines > 1) {
        refuse(self, "found a second engine; expected one per file");
        return;
    }
    self->in_engine = true;
    if (self->columns == THRUST_COLUMNS)
        return;
    self->diameter = 1e-3 * number(self, "engine", attributes, "dia", 0);
    self->length = 1e-3 * number(self, "engine", attributes, "len", 0);
    self->whole = 1e-3 * number(self, "engine", attributes, "initWt", 0);
    self->propellant = 1e-3 * number(self, "engine", attributes, "propWt", 0);
    if (self->propellant > self->whole)
        refuse(self,
               "propWt exceeds initWt: the propellant mass exceeds the total mass of the engine");
}

// A point of the curve; the point 0, 0 is implied where the first thrust is later.
static void read_point(rocksim_reader *self, const XML_Char **attributes)
{
    const char *element = "eng-data";
    const double origin[THRUST_COLUMNS] = {0, 0};
    double row[MASSES_COLUMNS] = {number(self, element, attributes, "t", 0)};
    ld_table *table = self->table;
    if (self->columns == THRUST_COLUMNS) {
        row[1] = number(self, element, attributes, "f", -INFINITY);
    } else {
        row[MASSES_MASS] = 1e-3 * number(self, element, attributes, "m", 0);
        row[MASSES_CENTER] = -1e-3 * number(self, element, attributes, "cg", -INFINITY);
    }
    double before = table->rows ? table->data[(table->rows - 1) * self->columns] : 0;
    if (!self->in_engine)
        refuse(self, "found eng-data outside of an engine");
    else if (row[0] < before)
        refuse(self, "the time is less than that of the point before");
    else if (row[0] > 10000)
        refuse(self, "the time is larger than 10000 s");
    else if (table->rows == MOST_ROWS)
        refuse(self, "more than %d points", MOST_ROWS);
    if (self->lines->failed)
        return;
    if (table->rows == 0 && row[0] > 0 && self->columns == THRUST_COLUMNS)
        line_append(self->lines, table, self->columns, origin);
    line_append(self->lines, table, self->columns, row);
}

static void begin_element(void *user, const XML_Char *element, const XML_Char **attributes)
{
    rocksim_reader *self = user;
    if (self->lines->failed)
        return;
    if (strcmp(element, "engine") == 0)
        read_engine(self, attributes);
    else if (strcmp(element, "eng-data") == 0)
        read_point(self, attributes);
}

static void end_element(void *user, const XML_Char *element)
{
    rocksim_reader *self = user;
    self->in_engine &= strcmp(element, "engine") != 0;
}

// No such file has one; with it come entities.
static void begin_doctype(void *user, const XML_Char *name, const XML_Char *system,
                          const XML_Char *public, int internal)
{
    (void)name, (void)system, (void)public, (void)internal;
    refuse(user, "found a DOCTYPE, which an engine file must not have");
}

// Masses are those of the whole motor: where the file has those of the propellant alone, the rest
// is added. Moments of inertia are those of a cylinder of its size.
static void complete(rocksim_reader *self)
{
    double least = 0.5 * (self->whole + self->propellant);
    double rest = self->table->data[MASSES_MASS] > least ? 0 : self->whole - self->propellant;
    for (size_t k = 0; k < self->table->rows; k++) {
        double *row = &self->table->data[k * self->columns], d2 = self->diameter * self->diameter;
        row[MASSES_MASS] += rest;
        row[MASSES_AXIAL] = row[MASSES_MASS] * d2 / 8;
        row[MASSES_TRANSVERSE] = row[MASSES_MASS] * (d2 / 16 + self->length * self->length / 12);
    }
}

static void parse(rocksim_reader *self)
{
    const text_source *source = self->lines->source;
    XML_SetUserData(self->parser, self);
    XML_SetElementHandler(self->parser, begin_element, end_element);
    XML_SetStartDoctypeDeclHandler(self->parser, begin_doctype);
    if (source->length > INT_MAX)
        refuse(self, "the file is larger than 2 GiB");
    else if (XML_Parse(self->parser, source->text, (int)source->length, 1) != XML_STATUS_OK)
        refuse(self, "no XML: %s", XML_ErrorString(XML_GetErrorCode(self->parser)));
    if (self->lines->failed)
        return;
    if (self->engines == 0)
        refuse(self, "found no engine in this file");
    else if (self->table->rows == 0)
        refuse(self, "the engine has no eng-data");
    else if (self->columns > THRUST_COLUMNS)
        complete(self);
}

void rocksim_read(line_reader *lines, const table_format *format, ld_table *table)
{
    rocksim_reader self = {.lines = lines,
                           .table = table,
                           .columns = (size_t)format->columns,
                           .parser = XML_ParserCreate(NULL)};
    if (!self.parser) {
        lines->reader->no_memory = lines->failed = true;
        return;
    }
    parse(&self);
    XML_ParserFree(self.parser);
}
