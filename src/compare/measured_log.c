#include "compare/measured_log.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/suggestion.h"
#include "base/text_file.h"
#include "base/text_lines.h"
#include "compare/sensor_file.h"
#include "model/units.h"

enum { MOST_BYTES = 256 << 20, PATH_SIZE = 4096, NO_FIELD = -1 };

typedef struct log_reader {
    measured_log *log;
    const char *file;
    const run_series *run;
    text_lines at;
    int columns;
    csv_column head[TEXT_LINES_FIELDS]; // "" where a field is none
    int time;                           // field of the clock
    double factor;                      // of its unit
    size_t room;                        // rows
    ld_error *error;
} log_reader;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the log");
}

// "FILE:LINE:COLUMN: NAME: ..."
static ld_status refuse(const log_reader *self, int field, const char *text)
{
    const char *name = field < self->columns ? self->head[field].name : "";
    return ld_fail(self->error, LD_ERR_INPUT, "%.300s:%d:%d: %s%s%s", self->file, self->at.number,
                   text_lines_column(&self->at, field), name, name[0] ? ": " : "", text);
}

static bool next_line(log_reader *self)
{
    return text_lines_next(&self->at, '#', true);
}

// ---- the header

static ld_status read_header(log_reader *self)
{
    if (!next_line(self))
        return refuse(self, 0, self->at.wrong ? self->at.wrong : "the file is empty");
    for (int i = 0; i < self->at.count; i++) {
        if (!csv_column_read(self->at.field[i], &self->head[i]))
            return refuse(self, i, "expected the name of a column and its unit, as in \"t [s]\"");
        self->columns = i + 1;
        for (int k = 0; k < i; k++)
            if (strcmp(self->head[k].name, self->head[i].name) == 0)
                return refuse(self, i, "is given in an earlier column, too");
    }
    return LD_OK;
}

// The field of that name; NO_FIELD: none, then *nearest is the one meant, or NULL.
static int field_of(const log_reader *self, const char *name, const char **nearest)
{
    name_suggestion best = suggestion_begin(name);
    for (int i = 0; i < self->columns; i++) {
        if (strcmp(self->head[i].name, name) == 0)
            return i;
        suggestion_offer(&best, self->head[i].name);
    }
    *nearest = best.name;
    return NO_FIELD;
}

static ld_status no_column(const log_reader *self, const char *name, const char *nearest)
{
    return ld_fail(self->error, LD_ERR_INPUT, "%.300s has no column \"%.95s\"%s%s%s", self->file,
                   name, nearest ? ", did you mean \"" : "", nearest ? nearest : "",
                   nearest ? "\"?" : "");
}

static ld_status find_clock(log_reader *self)
{
    const char *given = self->log->clock.column, *nearest;
    char why[256];
    self->time = field_of(self, given ? given : "t", &nearest);
    if (self->time == NO_FIELD && !given)
        self->time = field_of(self, "time", &nearest);
    if (self->time == NO_FIELD && given)
        return no_column(self, given, nearest);
    if (self->time == NO_FIELD)
        return ld_fail(self->error, LD_ERR_INPUT,
                       "%.300s has no column of times, \"t [s]\" or \"time [s]\"; clock.column "
                       "names another",
                       self->file);
    return csv_column_factor(&self->head[self->time], "s", &self->factor, why, sizeof why)
               ? LD_OK
               : refuse(self, self->time, why);
}

// The columns of the sensors, with their units.
static ld_status find_columns(log_reader *self)
{
    ld_status status = LD_OK;
    for (int i = 0; i < self->log->sensors && !status; i++) {
        sensor *of = &self->log->sensor[i];
        const char *nearest;
        char why[256];
        of->field = field_of(self, of->column, &nearest);
        if (of->field == NO_FIELD)
            status = no_column(self, of->column, nearest);
        else if (!csv_column_factor(&self->head[of->field], of->si, &of->factor, why, sizeof why))
            status = refuse(self, of->field, why);
        else
            of->head = self->head[of->field];
    }
    return status;
}

// Each column that has a name of the run's, as it is.
static ld_status take_names(log_reader *self)
{
    ld_status status = LD_OK;
    for (int i = 0; i < self->columns && !status; i++) {
        const char *nearest, *unit = run_series_unit(self->run, self->head[i].name, &nearest);
        if (unit && i != self->time && strcmp(self->head[i].name, "t") != 0)
            status = sensor_file_add_column(self->log, self->head[i].name, unit, self->error);
    }
    if (!status && self->log->sensors == 0)
        status = ld_fail(self->error, LD_ERR_INPUT,
                         "no column of %.200s has the name of one of the run's; say what its "
                         "sensors are in a file beside it, with the ending .yaml",
                         self->file);
    return status;
}

// "LOG.yaml" of "LOG.csv"; false: the name is too long.
static bool name_beside(const char *log, char name[PATH_SIZE])
{
    const char *slash = strrchr(log, '/'), *dot = strrchr(log, '.');
    size_t length = dot && (!slash || dot > slash) ? (size_t)(dot - log) : strlen(log);
    return snprintf(name, PATH_SIZE, "%.*s.yaml", (int)length, log) < PATH_SIZE;
}

static ld_status read_sensors(log_reader *self, const char *sensors)
{
    char beside[PATH_SIZE];
    sensor_file_defaults(self->log);
    if (!sensors && name_beside(self->file, beside) && access(beside, F_OK) == 0)
        sensors = beside;
    ld_status status =
        sensors ? sensor_file_read(self->log, sensors, self->run, self->error) : LD_OK;
    if (!status)
        status = find_clock(self);
    if (!status && !sensors)
        status = take_names(self);
    if (!status && self->log->sensors + self->log->results == 0)
        status =
            ld_fail(self->error, LD_ERR_INPUT, "%.300s names no sensor and no result", sensors);
    return status ? status : find_columns(self);
}

// ---- the rows

static ld_status make_room(log_reader *self)
{
    measured_log *log = self->log;
    size_t room = self->room ? 2 * self->room : 1024;
    double *t = realloc(log->t, room * sizeof *t);
    if (!t)
        return no_memory(self->error);
    log->t = t;
    for (int i = 0; i < log->sensors; i++) {
        double *value = realloc(log->sensor[i].value, room * sizeof *value);
        if (!value)
            return no_memory(self->error);
        log->sensor[i].value = value;
    }
    self->room = room;
    return LD_OK;
}

static ld_status read_cell(const log_reader *self, int field, double factor, double *value)
{
    char why[256];
    const char *text = self->at.field[field];
    *value = NAN;
    if (!text[0] || strcasecmp(text, "nan") == 0)
        return LD_OK;
    if (!csv_number(text, value, why, sizeof why))
        return refuse(self, field, why);
    *value = units_scale(*value, factor);
    return isfinite(*value) ? LD_OK : refuse(self, field, "the number is too large");
}

static ld_status read_row(log_reader *self)
{
    measured_log *log = self->log;
    char text[96];
    double t;
    if (self->at.count != self->columns) {
        snprintf(text, sizeof text, "found %d fields; expected %d, as in the header",
                 self->at.count, self->columns);
        return refuse(self, 0, text);
    }
    ld_status status = log->rows == self->room ? make_room(self) : LD_OK;
    if (!status)
        status = read_cell(self, self->time, self->factor, &t);
    if (!status && isnan(t))
        status = refuse(self, self->time, "no time; expected a number");
    if (!status && log->rows > 0 && t < log->t[log->rows - 1])
        status = refuse(self, self->time, "the clock runs backwards here");
    for (int i = 0; i < log->sensors && !status; i++) {
        sensor *of = &log->sensor[i];
        status = read_cell(self, of->field, of->factor, &of->value[log->rows]);
    }
    if (!status)
        log->t[log->rows++] = t;
    return status;
}

static ld_status read_file(log_reader *self, const char *sensors)
{
    ld_status status = read_header(self);
    if (!status)
        status = read_sensors(self, sensors);
    while (!status && next_line(self))
        status = read_row(self);
    if (!status && self->at.wrong)
        status = refuse(self, 0, self->at.wrong);
    if (!status && self->log->rows == 0)
        status = refuse(self, 0, "no row follows the header");
    return status;
}

ld_status measured_log_read(measured_log *self, const char *log, const char *sensors,
                            const run_series *run, ld_error *error)
{
    char *text;
    size_t length;
    ld_error why;
    *self = (measured_log){0};
    ld_status status = text_file_read(log, MOST_BYTES, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.300s %s", log, why.text);
    log_reader *reader = calloc(1, sizeof *reader);
    if (reader) {
        *reader = (log_reader){.log = self,
                               .file = log,
                               .run = run,
                               .at = text_lines_begin(text, length),
                               .error = error};
        status = read_file(reader, sensors);
    } else {
        status = no_memory(error);
    }
    free(reader);
    free(text);
    if (status)
        measured_log_free(self);
    return status;
}

void measured_log_free(measured_log *self)
{
    sensor_file_free(self);
    free(self->t);
    *self = (measured_log){0};
}
