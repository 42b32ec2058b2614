// Rows of a run kept column by column.
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/history.h"
#include "model/blocks/limits.h"

struct ld_history {
    ld_sink sink;
    const ld_sink *next; // or NULL
    ld_column *column;   // [columns], with texts of its own
    size_t columns, rows, room;
    double *value;       // [columns][room]
    int rocket;          // of a flight; 0: the launch
    ld_history *flights; // the latest flight, which leads to the ones before it
    ld_history *filling; // where rows go: itself or a flight
};

static void clear(ld_history *self)
{
    for (size_t i = 0; i < self->columns; i++) {
        free((char *)self->column[i].name);
        free((char *)self->column[i].unit);
        free((char *)self->column[i].description);
    }
    free(self->column);
    free(self->value);
    ld_history_free(self->flights);
    self->column = NULL;
    self->value = NULL;
    self->flights = NULL;
    self->columns = self->rows = self->room = 0;
}

void ld_history_free(ld_history *self)
{
    if (self)
        clear(self);
    free(self);
}

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for a history");
}

static ld_status take_columns(ld_history *self, const ld_column *columns, size_t count,
                              ld_error *error)
{
    self->column = calloc(count ? count : 1, sizeof *self->column);
    if (!self->column)
        return no_memory(error);
    for (; self->columns < count; self->columns++) {
        const ld_column *from = &columns[self->columns];
        ld_column own = {strdup(from->name), strdup(from->unit), strdup(from->description)};
        self->column[self->columns] = own;
        if (!own.name || !own.unit || !own.description) {
            self->columns++;
            return no_memory(error);
        }
    }
    return LD_OK;
}

// Twice as many rows, each column moved to its new place.
static ld_status make_room(ld_history *self, ld_error *error)
{
    size_t room = self->room ? 2 * self->room : 256;
    double *value = malloc(room * self->columns * sizeof *value);
    if (!value)
        return no_memory(error);
    for (size_t i = 0; i < self->columns && self->rows > 0; i++)
        memcpy(value + i * room, self->value + i * self->room, self->rows * sizeof *value);
    free(self->value);
    self->value = value;
    self->room = room;
    return LD_OK;
}

static ld_status begin(void *data, const ld_column *columns, size_t count, ld_error *error)
{
    ld_history *self = data;
    clear(self);
    self->filling = self;
    ld_status status = take_columns(self, columns, count, error);
    return status || !self->next ? status
                                 : self->next->begin(self->next->self, columns, count, error);
}

static ld_status row(void *data, const double *values, size_t count, ld_error *error)
{
    ld_history *self = data, *to = self->filling;
    ld_status status = to->rows == to->room ? make_room(to, error) : LD_OK;
    if (status)
        return status;
    for (size_t i = 0; i < to->columns; i++)
        to->value[i * to->room + to->rows] = values[i];
    to->rows++;
    bool wanted = self->next && (to == self || self->next->flight);
    return wanted ? self->next->row(self->next->self, values, count, error) : LD_OK;
}

static ld_status flight(void *data, int rocket, const ld_column *columns, size_t count,
                        ld_error *error)
{
    ld_history *self = data, *flown = calloc(1, sizeof *flown);
    if (!flown)
        return no_memory(error);
    flown->rocket = rocket;
    flown->flights = self->flights;
    self->flights = self->filling = flown;
    ld_status status = take_columns(flown, columns, count, error);
    return status || !self->next || !self->next->flight
               ? status
               : self->next->flight(self->next->self, rocket, columns, count, error);
}

static ld_status geometry(void *data, const ld_array *arrays, size_t count, ld_error *error)
{
    const ld_history *self = data;
    return self->next->geometry(self->next->self, arrays, count, error);
}

ld_history *ld_history_new(const ld_sink *next)
{
    ld_history *self = calloc(1, sizeof *self);
    if (!self)
        return NULL;
    self->next = next;
    self->sink = (ld_sink){.self = self,
                           .begin = begin,
                           .row = row,
                           .flight = flight,
                           .geometry = next && next->geometry ? geometry : NULL};
    return self;
}

const ld_sink *ld_history_sink(ld_history *self)
{
    return &self->sink;
}

size_t ld_history_rows(const ld_history *self)
{
    return self->rows;
}

const ld_column *ld_history_columns(const ld_history *self, size_t *count)
{
    *count = self->columns;
    return self->column;
}

static size_t column_named(const ld_history *self, const char *name)
{
    size_t i = 0;
    while (i < self->columns && strcmp(self->column[i].name, name) != 0)
        i++;
    return i;
}

const double *ld_history_column(const ld_history *self, const char *name, size_t *count)
{
    char now[LD_MAX_QUANTITY];
    if (count)
        *count = self->rows;
    size_t i = column_named(self, name);
    if (i == self->columns && ld_current_name(name, now, sizeof now))
        i = column_named(self, now);
    return i < self->columns && self->value ? self->value + i * self->room : NULL;
}

const ld_history *ld_history_flight(const ld_history *self, int rocket)
{
    const ld_history *flown = self->flights;
    while (flown && flown->rocket != rocket)
        flown = flown->flights;
    return flown;
}
