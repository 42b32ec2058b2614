// A history in memory: of a run without a file, and what one that was read has.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/history.h"
#include "model/blocks/rocket.h"
#include "model/parts.h"
#include "results/history.h"

struct history_memory {
    ld_history *kept; // what it keeps goes on to `sink`, for the arrays
    ld_sink sink;
    history_array *geometry; // [arrays]
    size_t arrays;
};

// ---- a run on its way ----

static void free_arrays(history_array *array, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        free(array[i].name);
        free(array[i].value);
    }
    free(array);
}

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for a history");
}

static bool copy_array(history_array *to, const char *name, const double *value)
{
    size_t size = to->rows * to->columns * sizeof *value;
    to->name = strdup(name);
    to->value = malloc(size + sizeof *value);
    if (to->value && size)
        memcpy(to->value, value, size);
    return to->name && to->value;
}

static ld_status geometry(void *self, const ld_array *arrays, size_t count, ld_error *error)
{
    history_memory *memory = self;
    free_arrays(memory->geometry, memory->arrays);
    memory->arrays = 0;
    memory->geometry = calloc(count + 1, sizeof *memory->geometry);
    if (!memory->geometry)
        return no_memory(error);
    for (size_t i = 0; i < count; i++) {
        history_array *to = &memory->geometry[memory->arrays++];
        *to = (history_array){.rows = arrays[i].rows, .columns = arrays[i].columns};
        if (!copy_array(to, arrays[i].name, arrays[i].value))
            return no_memory(error);
    }
    return LD_OK;
}

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)self, (void)columns, (void)count, (void)error;
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)self, (void)values, (void)count, (void)error;
    return LD_OK;
}

history_memory *history_memory_new(void)
{
    history_memory *memory = calloc(1, sizeof *memory);
    if (!memory)
        return NULL;
    memory->sink = (ld_sink){.self = memory, .begin = begin, .row = row, .geometry = geometry};
    memory->kept = ld_history_new(&memory->sink);
    if (memory->kept)
        return memory;
    free(memory);
    return NULL;
}

void history_memory_free(history_memory *memory)
{
    if (!memory)
        return;
    ld_history_free(memory->kept);
    free_arrays(memory->geometry, memory->arrays);
    free(memory);
}

const ld_sink *history_memory_sink(history_memory *memory)
{
    return ld_history_sink(memory->kept);
}

// ---- what the run came to ----

static bool copy_table(const ld_history *kept, history_data *to)
{
    const ld_column *column = ld_history_columns(kept, &to->columns);
    size_t columns = to->columns;
    to->rows = ld_history_rows(kept);
    to->name = calloc(columns + 1, sizeof *to->name);
    to->unit = calloc(columns + 1, sizeof *to->unit);
    to->value = malloc((columns * to->rows + 1) * sizeof *to->value);
    bool fine = to->name && to->unit && to->value;
    for (size_t i = 0; fine && i < columns; i++) {
        const double *value = ld_history_column(kept, column[i].name, NULL);
        to->name[i] = strdup(column[i].name);
        to->unit[i] = strdup(column[i].unit);
        if (value)
            memcpy(to->value + i * to->rows, value, to->rows * sizeof *value);
        fine = to->name[i] && to->unit[i];
    }
    return fine;
}

// Parachutes that have opened, by their names.
static void take_openings(const ld_model *model, const ld_rocket_summary *rocket, history_data *to)
{
    int count = model && rocket->flown ? model_rocket(model)->parachute_count : 0;
    for (int i = 0; i < count; i++) {
        const char *name = model_rocket(model)->parachute[i].name;
        if (!isfinite(rocket->parachute[i].t_open))
            continue;
        int place = to->openings++;
        for (; place > 0 && strcmp(to->opening[place - 1].name, name) > 0; place--)
            to->opening[place] = to->opening[place - 1];
        snprintf(to->opening[place].name, sizeof to->opening[place].name, "%s", name);
        to->opening[place].t = rocket->parachute[i].t_open;
    }
}

static void take_instants(const ld_model *model, const ld_rocket_summary *rocket, history_data *to)
{
    to->t_ignition = rocket->t_ignition;
    to->t_release = rocket->t_release;
    to->t_front = rocket->t_front;
    to->t_middle = rocket->t_middle;
    to->t_rear = rocket->t_rear;
    to->t_apogee = rocket->flown ? rocket->flight.t_apogee : NAN;
    to->t_impact = rocket->flown ? rocket->flight.t_impact : NAN;
    take_openings(model, rocket, to);
}

static bool take_rockets(const ld_summary *summary, history_data *history)
{
    history->t_ignition = history->t_release = history->t_front = history->t_middle = NAN;
    history->t_rear = history->t_apogee = history->t_impact = NAN;
    history->rocket = calloc(LD_MAX_FIRINGS, sizeof *history->rocket);
    if (!history->rocket)
        return false;
    for (int i = 0; i < summary->rocket_count; i++) {
        history_data *rocket = &history->rocket[history->rockets++];
        take_instants(summary->model, &summary->rocket[i], rocket);
        rocket->tube = summary->rocket[i].tube;
        rocket->number = i + 1;
    }
    if (summary->rocket_count > 0)
        take_instants(summary->model, &summary->rocket[0], history);
    return true;
}

static bool take_flights(const ld_history *kept, history_data *history)
{
    history->flight = calloc(LD_MAX_FIRINGS, sizeof *history->flight);
    if (!history->flight)
        return false;
    for (int i = 0; i < history->rockets; i++) {
        const ld_history *flown = ld_history_flight(kept, i + 1);
        if (flown && ld_history_rows(flown) > 0 &&
            !copy_table(flown, history_begin_flight(history, &history->rocket[i])))
            return false;
    }
    if (history->flights > 0 || !history_column(history, "angle_of_attack"))
        return true;
    history->number = 1;
    return copy_table(kept, history_begin_flight(history, history));
}

static bool take_geometry(const history_memory *memory, history_data *history)
{
    bool fine = (history->geometry = calloc(memory->arrays + 1, sizeof *history->geometry)) != NULL;
    for (size_t i = 0; fine && i < memory->arrays; i++) {
        const history_array *from = &memory->geometry[i];
        history_array *to = &history->geometry[history->arrays++];
        *to = (history_array){.rows = from->rows, .columns = from->columns};
        fine = copy_array(to, from->name, from->value);
    }
    return fine;
}

ld_status history_memory_take(const history_memory *memory, const ld_summary *summary,
                              history_data *history, ld_error *error)
{
    const char *title = summary->model ? model_title(summary->model) : NULL;
    *history = (history_data){.complete = summary->complete};
    history->title = strdup(title ? title : "");
    history->stopped = strdup(summary->stopped);
    bool fine = history->title && history->stopped && copy_table(memory->kept, history) &&
                take_rockets(summary, history) && take_flights(memory->kept, history) &&
                take_geometry(memory, history);
    ld_status status = LD_OK;
    if (!fine)
        status = no_memory(error);
    else if (history->columns == 0 && history->flights == 0)
        status = ld_fail(error, LD_ERR_INPUT, "the run has no history");
    if (status)
        history_free(history);
    return status;
}

// ---- any history ----

history_data *history_begin_flight(history_data *history, const history_data *rocket)
{
    history_data *flight = &history->flight[history->flights++];
    *flight = (history_data){.t_ignition = rocket->t_ignition,
                             .t_release = rocket->t_release,
                             .t_front = rocket->t_front,
                             .t_middle = rocket->t_middle,
                             .t_rear = rocket->t_rear,
                             .t_apogee = rocket->t_apogee,
                             .t_impact = rocket->t_impact,
                             .openings = rocket->openings,
                             .tube = rocket->tube,
                             .number = rocket->number};
    memcpy(flight->opening, rocket->opening, sizeof flight->opening);
    return flight;
}

void history_free(history_data *history)
{
    for (size_t i = 0; history->name && i < history->columns; i++)
        free(history->name[i]);
    for (size_t i = 0; i < history->flights; i++)
        history_free(&history->flight[i]);
    free(history->flight);
    free(history->rocket);
    free_arrays(history->geometry, history->arrays);
    for (size_t i = 0; history->unit && i < history->columns; i++)
        free(history->unit[i]);
    free(history->name);
    free(history->unit);
    free(history->value);
    free(history->title);
    free(history->stopped);
    memset(history, 0, sizeof *history);
}

const history_array *history_array_named(const history_data *history, const char *name)
{
    for (size_t i = 0; i < history->arrays; i++)
        if (strcmp(history->geometry[i].name, name) == 0)
            return &history->geometry[i];
    return NULL;
}

const double *history_column(const history_data *history, const char *name)
{
    for (size_t i = 0; i < history->columns; i++)
        if (strcmp(history->name[i], name) == 0)
            return history->value + i * history->rows;
    return NULL;
}
