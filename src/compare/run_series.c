#include "compare/run_series.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "launchdyn/summary.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the series of a run");
}

static void free_part(series_part *part)
{
    free(part->name);
    free(part->unit);
    free(part->value);
    *part = (series_part){0};
}

void run_series_free(run_series *self)
{
    free_part(&self->launch);
    free_part(&self->flight);
}

static ld_status make_part(series_part *part, size_t columns, size_t rows, ld_error *error)
{
    *part = (series_part){.rows = rows,
                          .name = calloc(columns + 1, sizeof *part->name),
                          .unit = calloc(columns + 1, sizeof *part->unit),
                          .value = calloc(columns + 1, sizeof *part->value)};
    if (!part->name || !part->unit || !part->value)
        return no_memory(error);
    part->columns = columns;
    return LD_OK;
}

// ---- a history in a file

static ld_status part_of_file(series_part *part, const history_data *history, ld_error *error)
{
    ld_status status = make_part(part, history->columns, history->rows, error);
    for (size_t i = 0; !status && i < history->columns; i++) {
        part->name[i] = history->name[i];
        part->unit[i] = history->unit[i];
        part->value[i] = history->value + i * history->rows;
    }
    return status;
}

static const history_data *flight_of(const history_data *history, int rocket)
{
    for (size_t i = 0; i < history->flights; i++)
        if (history->flight[i].number == rocket)
            return &history->flight[i];
    return NULL;
}

static ld_status no_rocket(int rocket, int rockets, ld_error *error)
{
    return ld_fail(error, LD_ERR_INPUT, "there is no rocket %d; the run has %d", rocket, rockets);
}

ld_status run_series_of_file(run_series *self, const history_data *history, int rocket,
                             ld_error *error)
{
    const history_data *flight = flight_of(history, rocket);
    *self = (run_series){.t_first = -INFINITY, .t_last = INFINITY, .gravity = NAN};
    bool alone = history_column(history, "angle_of_attack") != NULL;
    if (rocket < 1 || (rocket > history->rockets && !flight))
        return no_rocket(rocket, history->rockets, error);
    const history_data *of = history->rockets ? &history->rocket[rocket - 1] : history;
    self->t_ignition = isnan(of->t_ignition) ? 0 : of->t_ignition;
    const double instants[] = {0,          of->t_release, of->t_front, of->t_middle,
                               of->t_rear, of->t_apogee,  of->t_impact};
    memcpy(self->instant, instants, sizeof instants);
    if (rocket > 1)
        self->t_first = of[-1].t_ignition + of[-1].t_rear;
    if (rocket < history->rockets)
        self->t_last = of->t_ignition + of->t_rear;
    ld_status status = alone ? LD_OK : part_of_file(&self->launch, history, error);
    if (!status && flight)
        status = part_of_file(&self->flight, flight, error);
    if (status)
        run_series_free(self);
    return status;
}

// ---- a history in memory

static ld_status part_of_run(series_part *part, const ld_history *history, ld_error *error)
{
    size_t columns;
    const ld_column *column = ld_history_columns(history, &columns);
    ld_status status = make_part(part, columns, ld_history_rows(history), error);
    for (size_t i = 0; !status && i < columns; i++) {
        part->name[i] = column[i].name;
        part->unit[i] = column[i].unit;
        part->value[i] = ld_history_column(history, column[i].name, NULL);
    }
    return status;
}

// A number of a rocket; NaN where there is none.
static double number_of(const ld_summary *summary, int rocket, const char *name)
{
    char path[LD_MAX_QUANTITY + 32];
    double value;
    snprintf(path, sizeof path, "rocket.%d.%s", rocket, name);
    return ld_summary_number(summary, path, &value, NULL) ? NAN : value;
}

ld_status run_series_of_run(run_series *self, const ld_history *history, const ld_summary *summary,
                            int rocket, ld_error *error)
{
    static const char *const names[SERIES_INSTANTS] = {"",       "t_release", "t_front", "t_middle",
                                                       "t_rear", "t_apogee",  "t_impact"};
    *self = (run_series){.t_first = -INFINITY, .t_last = INFINITY, .gravity = NAN};
    if (rocket < 1 || rocket > ld_summary_rockets(summary))
        return no_rocket(rocket, ld_summary_rockets(summary), error);
    double ignition = number_of(summary, rocket, "t_ignition");
    self->t_ignition = isnan(ignition) ? 0 : ignition;
    for (int i = 1; i < SERIES_INSTANTS; i++)
        self->instant[i] = number_of(summary, rocket, names[i]);
    if (rocket > 1)
        self->t_first =
            number_of(summary, rocket - 1, "t_ignition") + number_of(summary, rocket - 1, "t_rear");
    if (rocket < ld_summary_rockets(summary))
        self->t_last = self->t_ignition + self->instant[SERIES_REAR];
    const ld_history *flight = ld_history_flight(history, rocket);
    ld_status status = part_of_run(&self->launch, history, error);
    if (!status && flight)
        status = part_of_run(&self->flight, flight, error);
    if (status)
        run_series_free(self);
    return status;
}

double window_time(const run_series *run, window_end end, double open)
{
    if (end.kind == WINDOW_TIME)
        return end.t;
    return end.kind < SERIES_INSTANTS && !isnan(run->instant[end.kind]) ? run->instant[end.kind]
                                                                        : open;
}

// ---- columns

static size_t place_of(const series_part *part, const char *name)
{
    size_t i = 0;
    while (i < part->columns && strcmp(part->name[i], name) != 0)
        i++;
    return i;
}

const char *run_series_unit(const run_series *self, const char *name, const char **nearest)
{
    const series_part *const parts[] = {&self->launch, &self->flight};
    name_suggestion best = suggestion_begin(name);
    for (int k = 0; k < 2; k++) {
        size_t i = place_of(parts[k], name);
        if (i < parts[k]->columns)
            return strcmp(parts[k]->unit[i], "1") == 0 ? "" : parts[k]->unit[i];
        for (size_t j = 0; j < parts[k]->columns; j++)
            suggestion_offer(&best, parts[k]->name[j]);
    }
    *nearest = best.name;
    return NULL;
}

// The rows of a part that are the rocket's, appended.
static void append(const run_series *self, const series_part *part, const size_t *at, size_t width,
                   run_signal *signal)
{
    size_t time = place_of(part, "t");
    bool flight = part == &self->flight;
    for (size_t i = 0; i < part->rows && time < part->columns; i++) {
        double t = part->value[time][i];
        double *row = signal->value + signal->count * width;
        bool numbers = flight || (!(t <= self->t_first) && !(t > self->t_last));
        for (size_t k = 0; k < width; k++) {
            row[k] = part->value[at[k]][i];
            numbers = numbers && isfinite(row[k]);
        }
        if (numbers)
            signal->t[signal->count++] = t - self->t_ignition;
    }
}

enum { MOST_WIDTH = 16 };

// Where the columns are in a part; false: one is not there.
static bool find_columns(const series_part *part, const char *const *names, size_t width,
                         size_t at[MOST_WIDTH])
{
    for (size_t k = 0; k < width; k++) {
        at[k] = place_of(part, names[k]);
        if (at[k] == part->columns)
            return false;
    }
    return true;
}

ld_status run_series_take(const run_series *self, const char *const *names, size_t width,
                          run_signal *signal, ld_error *error)
{
    size_t at[MOST_WIDTH] = {0}, room = self->launch.rows + self->flight.rows + 1;
    *signal = (run_signal){.t = calloc(room, sizeof(double)),
                           .value = calloc(room * width, sizeof(double))};
    if (!signal->t || !signal->value) {
        run_signal_free(signal);
        return no_memory(error);
    }
    bool launched = find_columns(&self->launch, names, width, at);
    if (launched)
        append(self, &self->launch, at, width, signal);
    bool flew = find_columns(&self->flight, names, width, at);
    if (flew)
        append(self, &self->flight, at, width, signal);
    if (launched || flew)
        return LD_OK;
    run_signal_free(signal);
    return ld_fail(error, LD_ERR_INPUT, "the run has no column %s", names[0]);
}

void run_signal_free(run_signal *self)
{
    free(self->t);
    free(self->value);
    *self = (run_signal){0};
}
