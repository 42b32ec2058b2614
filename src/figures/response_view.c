// Linear responses to look at: as tables, files and charts.
#include <stdlib.h>
#include <string.h>

#include "figures/chart.h"
#include "figures/density_file.h"
#include "launchdyn/response_view.h"
#include "math/functions.h"
#include "model/blocks/base.h"
#include "model/blocks/platform.h"
#include "model/blocks/road.h"
#include "model/parts.h"
#include "quantities/study_results.h"
#include "results/columns.h"
#include "run/measure_names.h"

enum { POINTS = 600, MOST_SPEEDS = 10000, CHARTS = 8, CURVES = 6, NAME = 128 };

static const double KMH = 3.6, PI = 3.141592653589793238462643383280;
static const double DEGREE = 57.295779513082320876798154814105;

// DRIVEN: the spectrum where an input is random; EXIT: the exit's scatter on the road.
typedef enum view_kind { FREQUENCY, SPECTRUM, DRIVEN, SPEEDS, LOOP, EXIT } view_kind;

struct ld_response_view {
    const ld_model *model;
    ld_response *response; // NULL: a loop alone
    ld_loop *loop;
    const char *hinge;
    view_kind kind;
    const ld_column *input; // of a frequency response, or what is random
    ld_table density;       // its
    const char *density_file;
    bool friction;
    int draws;         // of the exit
    ld_column *column; // [columns]
    size_t columns;
    double slowest, fastest; // [m/s]
    size_t count, speeds;
    double *x;             // [count] frequencies [Hz]
    double *value, *phase; // [columns][count] amplitude and phase, or density
    double *speed, *rms;   // [speeds] [m/s], [columns][speeds]
    double *top;           // [columns][speeds] where most comes from [Hz]; of the exit the mean
    char (*name)[QUANTITY_NAME]; // [columns] of the exit
};

// Whether it is amplitudes and phases.
static bool is_gain(const ld_response_view *view)
{
    return view->kind == FREQUENCY || view->kind == LOOP;
}

static bool is_spectrum(const ld_response_view *view)
{
    return view->kind == SPECTRUM || view->kind == DRIVEN;
}

static bool is_over_speeds(const ld_response_view *view)
{
    return view->kind == SPEEDS || view->kind == EXIT;
}

// ---- what is shown ----

static const char *const on_vehicle[] = {
    "chassis.vy",
    "chassis.pitch",
    "chassis.roll",
    "elevation.error",
    "azimuth.error",
    "elevation.torque",
    "azimuth.torque",
    "tip.inertial_vy",
    "tip.inertial_vz",
    "tip.inertial_pitch_rate",
    "tip.inertial_yaw_rate",
    "tip.y",
    "tip.z",
    "rocket.psi",
    "rocket.theta",
    "lock.force",
};
static const char *const on_others[] = {
    "tip.y",        "tip.z",        "tip.pitch_rate", "tip.yaw_rate", "rocket.psi",
    "rocket.theta", "rocket.pitch", "rocket.yaw",     "lock.force",
};

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the linear response");
}

static ld_status choose_all(ld_response_view *view, ld_error *error)
{
    const ld_column *columns;
    size_t count = ld_response_columns(view->response, &columns);
    const char **names = malloc(count * sizeof *names);
    if (!names)
        return no_memory(error);
    // all but the clock and the phase of the launch
    for (size_t i = 2; i < count; i++)
        names[i - 2] = columns[i].name;
    view->columns = count - 2;
    ld_status status = ld_response_choose(view->response, names, view->columns, error);
    view->column = malloc(view->columns * sizeof *view->column);
    for (size_t i = 0; i < view->columns && view->column; i++)
        view->column[i] = columns[i + 2];
    free(names);
    return status || view->column ? status : no_memory(error);
}

// What a column or result is called now.
static const char *present_name(const char *name, char now[QUANTITY_NAME])
{
    return ld_current_name(name, now, QUANTITY_NAME) ? now : name;
}

static ld_status choose(ld_response_view *view, const char *const *names, size_t count,
                        ld_error *error)
{
    const ld_column *columns;
    size_t all = ld_response_columns(view->response, &columns);
    ld_status status = ld_response_choose(view->response, names, count, error);
    if (status)
        return status;
    view->column = malloc((count + 1) * sizeof *view->column);
    if (!view->column)
        return no_memory(error);
    for (size_t i = 0; i < count; i++) {
        char now[QUANTITY_NAME];
        const char *name = present_name(names[i], now);
        for (size_t k = 0; k < all; k++)
            if (strcmp(columns[k].name, name) == 0)
                view->column[i] = columns[k];
    }
    view->columns = count;
    return LD_OK;
}

// Numbers of a launch: their names, units and what they are.
static const char *const at_exit[] = {
    "t_rear",
    "exit_speed",
    "since_ignition.pitch",
    "since_ignition.yaw",
    "since_ignition.pitch_rate",
    "since_ignition.yaw_rate",
    "tip_off.pitch",
    "tip_off.yaw",
    "tip_off.pitch_rate",
    "tip_off.yaw_rate",
    "tip_off.pitch_rate_relative",
    "tip_off.yaw_rate_relative",
    "tip_off.vy",
    "tip_off.vz",
    "pitch",
    "yaw",
    "pitch_rate",
    "yaw_rate",
};

static ld_status choose_exit(ld_response_view *view, const ld_response_wish *wish, ld_error *error)
{
    bool own = wish->what_count == 0;
    const char *const *names = own ? at_exit : wish->what;
    quantity_things things = quantity_things_of(view->model);
    view->columns = own ? sizeof at_exit / sizeof *at_exit : wish->what_count;
    view->column = calloc(view->columns, sizeof *view->column);
    view->name = calloc(view->columns, sizeof *view->name);
    if (!view->column || !view->name)
        return no_memory(error);
    for (size_t i = 0; i < view->columns; i++) {
        char now[QUANTITY_NAME];
        const char *name = present_name(names[i], now);
        quantity_walk at = study_result_find(&things, name);
        snprintf(view->name[i], QUANTITY_NAME, "%s", name);
        view->column[i] = (ld_column){.name = view->name[i],
                                      .unit = at.row ? quantity_unit(&at) : "",
                                      .description = at.row ? at.row->description : ""};
    }
    return LD_OK;
}

// Those of a vehicle's hinges that it has, and the others.
static ld_status choose_on_vehicle(ld_response_view *view, ld_error *error)
{
    const char *names[sizeof on_vehicle / sizeof *on_vehicle];
    bool azimuth = model_platform(view->model)->has_azimuth;
    size_t count = 0;
    for (size_t i = 0; i < sizeof on_vehicle / sizeof *on_vehicle; i++)
        if (azimuth || strncmp(on_vehicle[i], "azimuth.", strlen("azimuth.")) != 0)
            names[count++] = on_vehicle[i];
    return choose(view, names, count, error);
}

static ld_status choose_wished(ld_response_view *view, const ld_response_wish *wish,
                               ld_error *error)
{
    if (view->kind == EXIT)
        return choose_exit(view, wish, error);
    if (wish->what_count == 1 && strcmp(wish->what[0], "all") == 0)
        return choose_all(view, error);
    if (wish->what_count > 0)
        return choose(view, wish->what, wish->what_count, error);
    if (model_has_vehicle(view->model))
        return choose_on_vehicle(view, error);
    return choose(view, on_others, sizeof on_others / sizeof *on_others, error);
}

static ld_status find_input(ld_response_view *view, const char *name, ld_error *error)
{
    const ld_column *inputs;
    size_t count = ld_response_inputs(view->response, &inputs);
    for (size_t i = 0; i < count; i++)
        if (strcmp(inputs[i].name, name) == 0)
            view->input = &inputs[i];
    if (view->input)
        return LD_OK;
    // its sentence says which one may be meant
    return ld_response_gain(view->response, view->slowest, name, NULL, 0, NULL, error);
}

// What is shown of a loop.
static const ld_column of_loop[] = {
    {"open", "1", "loop, opened"},
    {"tracking", "1", "measured angle per commanded one"},
    {"sensitivity", "1", "share of an error that the loop leaves"},
    {"rejection", "1", "angle of the platform per angle of the chassis about the hinge"},
};
enum { OF_LOOP = sizeof of_loop / sizeof *of_loop };

static ld_status choose_loop(ld_response_view *view, ld_error *error)
{
    view->columns = ld_loop_has_rejection(view->loop) ? OF_LOOP : OF_LOOP - 1;
    view->column = malloc(sizeof of_loop);
    if (!view->column)
        return no_memory(error);
    memcpy(view->column, of_loop, sizeof of_loop);
    return LD_OK;
}

// ---- numbers ----

// Frequencies, equal in their logarithm.
static ld_status set_frequencies(ld_response_view *view, double from, double to, ld_error *error)
{
    from = isnan(from) ? 0.2 : from;
    to = isnan(to) ? 50 : to;
    if (!(from > 0 && to > from && isfinite(to)))
        return ld_fail(error, LD_ERR_INPUT,
                       "found %g Hz to %g Hz, expected a rising range of frequencies above 0", from,
                       to);
    view->count = POINTS;
    view->x = malloc((1 + 2 * view->columns) * POINTS * sizeof(double));
    if (!view->x)
        return no_memory(error);
    view->value = view->x + POINTS;
    view->phase = view->value + view->columns * POINTS;
    for (int i = 0; i < POINTS; i++)
        view->x[i] = from * pow(to / from, i / (POINTS - 1.0));
    return LD_OK;
}

static void put_gain(ld_response_view *view, size_t i, size_t k, ld_phasor gain)
{
    view->value[i * POINTS + k] = hypot(gain.real, gain.imaginary);
    view->phase[i * POINTS + k] = atan2(gain.imaginary, gain.real);
}

static ld_status fill_loop(ld_response_view *view, const ld_response_wish *wish, ld_error *error)
{
    ld_loop_point at;
    ld_phasor rejection = {0};
    ld_status status = choose_loop(view, error);
    if (!status)
        status = set_frequencies(view, wish->from, wish->to, error);
    for (size_t k = 0; k < POINTS && !status; k++) {
        status = ld_loop_points(view->loop, &view->x[k], 1, &at, error);
        if (!status && ld_loop_has_rejection(view->loop))
            status = ld_loop_rejection(view->loop, &view->x[k], 1, &rejection, error);
        const ld_phasor gain[OF_LOOP] = {at.open, at.tracking, at.sensitivity, rejection};
        for (size_t i = 0; i < view->columns && !status; i++)
            put_gain(view, i, k, gain[i]);
    }
    return status;
}

static ld_status fill_frequency(ld_response_view *view, ld_error *error)
{
    ld_phasor *gain = malloc((view->columns * POINTS + 1) * sizeof *gain);
    if (!gain)
        return no_memory(error);
    ld_status status = ld_response_gain(view->response, view->slowest, view->input->name, view->x,
                                        POINTS, gain, error);
    for (size_t i = 0; i < view->columns && !status; i++)
        for (size_t k = 0; k < POINTS; k++)
            put_gain(view, i, k, gain[k * view->columns + i]);
    free(gain);
    return status;
}

static ld_status fill_spectrum(ld_response_view *view, ld_error *error)
{
    double *density = malloc((view->columns * POINTS + 1) * sizeof *density);
    if (!density)
        return no_memory(error);
    ld_status status =
        ld_response_density(view->response, view->slowest, view->x, POINTS, density, error);
    for (size_t i = 0; i < view->columns && !status; i++)
        for (size_t k = 0; k < POINTS; k++)
            view->value[i * POINTS + k] = density[k * view->columns + i];
    free(density);
    return status;
}

// Between the density's points a straight line, nothing beyond.
static double density_at(const ld_table *density, double frequency)
{
    for (size_t i = 0; i + 1 < density->rows; i++) {
        const double *a = density->data + 2 * i, *b = a + 2;
        if (frequency >= a[0] && frequency <= b[0])
            return a[1] + (b[1] - a[1]) * (frequency - a[0]) / (b[0] - a[0]);
    }
    return 0;
}

// The gains' squares times the density of the input.
static ld_status fill_driven(ld_response_view *view, ld_error *error)
{
    ld_status status = fill_frequency(view, error);
    for (size_t k = 0; k < POINTS && !status; k++) {
        double density = density_at(&view->density, view->x[k]);
        for (size_t i = 0; i < view->columns; i++) {
            double *value = &view->value[i * POINTS + k];
            *value *= *value * density;
        }
    }
    return status;
}

static ld_status fill_random(ld_response_view *view, double *rms, double *top, ld_error *error)
{
    size_t points = view->density.rows;
    double *f = malloc((2 * points + 1) * sizeof *f), *density = f + points;
    if (!f)
        return no_memory(error);
    for (size_t i = 0; i < points; i++) {
        f[i] = view->density.data[2 * i];
        density[i] = view->density.data[2 * i + 1];
    }
    ld_status status = ld_response_random(view->response, view->slowest, view->input->name, f,
                                          density, points, rms, top, error);
    free(f);
    return status;
}

static ld_status fill_exit(ld_response_view *view, double speed, double *deviation, double *mean,
                           ld_error *error)
{
    const char **names = malloc(view->columns * sizeof *names);
    if (!names)
        return no_memory(error);
    for (size_t i = 0; i < view->columns; i++)
        names[i] = view->name[i];
    ld_status status = ld_response_exit(view->response, speed, view->draws, names, view->columns,
                                        mean, deviation, error);
    free(names);
    return status;
}

static ld_status set_speeds(ld_response_view *view, double step, ld_error *error)
{
    double count = floor((view->fastest - view->slowest) / step * (1 + 1e-12)) + 1;
    if (is_spectrum(view) || isnan(step))
        count = 1;
    if (!(count >= 1 && count <= MOST_SPEEDS))
        return ld_fail(error, LD_ERR_INPUT,
                       "speeds from %g km/h to %g km/h by %g km/h: expected 1 to %d speeds",
                       KMH * view->slowest, KMH * view->fastest, KMH * step, MOST_SPEEDS);
    view->speeds = (size_t)count;
    view->speed = malloc((1 + 2 * view->columns) * view->speeds * sizeof(double));
    if (!view->speed)
        return no_memory(error);
    view->rms = view->speed + view->speeds;
    view->top = view->rms + view->columns * view->speeds;
    for (size_t i = 0; i < view->speeds; i++)
        view->speed[i] =
            fmin(view->slowest + (double)i * (view->speeds > 1 ? step : 0), view->fastest);
    return LD_OK;
}

static ld_status fill_speeds(ld_response_view *view, ld_error *error)
{
    double *rms = malloc((2 * view->columns + 1) * sizeof *rms), *top = rms + view->columns;
    ld_status status = rms ? LD_OK : no_memory(error);
    for (size_t k = 0; k < view->speeds && !status; k++) {
        // the road does nothing to what stands
        bool stands = view->speed[k] == 0 && is_over_speeds(view) && view->speeds > 1;
        if (view->kind == DRIVEN)
            status = fill_random(view, rms, top, error);
        else if (view->kind == EXIT && !stands)
            status = fill_exit(view, view->speed[k], rms, top, error);
        else if (!stands)
            status = ld_response_on_road(view->response, view->speed[k], rms, top, error);
        for (size_t i = 0; i < view->columns && !status; i++) {
            view->rms[i * view->speeds + k] = stands ? 0 : rms[i];
            view->top[i * view->speeds + k] = stands ? NAN : top[i];
        }
    }
    free(rms);
    return status;
}

static ld_status fill(ld_response_view *view, const ld_response_wish *wish, ld_error *error)
{
    if (view->kind == LOOP)
        return fill_loop(view, wish, error);
    ld_status status = choose_wished(view, wish, error);
    if (!status && wish->input)
        status = find_input(view, wish->input, error);
    if (!status && !is_over_speeds(view))
        status = set_frequencies(view, wish->from, wish->to, error);
    if (!status && view->kind == FREQUENCY)
        return fill_frequency(view, error);
    if (!status && view->kind == SPECTRUM)
        status = fill_spectrum(view, error);
    if (!status && view->kind == DRIVEN)
        status = fill_driven(view, error);
    if (!status)
        status = set_speeds(view, wish->step, error);
    return status ? status : fill_speeds(view, error);
}

// What is wished together must go together.
static ld_status check_wish(const ld_model *model, const ld_response_wish *wish, ld_error *error)
{
    bool over_speeds = !isnan(wish->step);
    if (wish->loop && (wish->input || over_speeds || wish->what_count > 0))
        return ld_fail(
            error, LD_ERR_INPUT,
            "a loop is shown separately, at one speed: it excludes input, quantities, speeds");
    if (wish->input && over_speeds)
        return ld_fail(
            error, LD_ERR_INPUT,
            "a frequency response is at one speed: several speeds require the road as input");
    if (wish->exit && (wish->input || wish->loop))
        return ld_fail(error, LD_ERR_INPUT,
                       "the scatter of the exit is caused by the road: it excludes input and loop");
    if (wish->draws && !wish->exit)
        return ld_fail(error, LD_ERR_INPUT, "draws require the scatter of the exit: set --exit");
    if (wish->loop && wish->friction)
        return ld_fail(error, LD_ERR_INPUT, "a loop is shown without friction of the hinges");
    if (wish->density && !wish->input)
        return ld_fail(error, LD_ERR_INPUT,
                       "a spectral density is that of an input: it requires the name of one "
                       "(launchdyn response --list lists them)");
    if (!wish->loop && !wish->input && !wish->exit && model_has_launcher(model) &&
        !model_has_vehicle(model))
        return ld_fail(error, LD_ERR_INPUT,
                       "the base is not a vehicle on a road: a response requires the name of an "
                       "input (launchdyn response --list lists them)");
    return LD_OK;
}

ld_status ld_response_view_create(const ld_model *model, const ld_response_wish *wish,
                                  ld_response_view **view, ld_error *error)
{
    bool over_speeds = !isnan(wish->step);
    *view = NULL;
    ld_status status = check_wish(model, wish, error);
    if (status)
        return status;
    ld_response_view *self = calloc(1, sizeof *self);
    if (!self)
        return no_memory(error);
    double own = model_has_vehicle(model) ? model_base(model)->vehicle.speed : 0;
    self->model = model;
    self->kind = wish->loop      ? LOOP
                 : wish->exit    ? EXIT
                 : wish->density ? DRIVEN
                 : wish->input   ? FREQUENCY
                 : over_speeds   ? SPEEDS
                                 : SPECTRUM;
    self->density_file = wish->density;
    self->draws = wish->draws;
    self->friction = wish->friction || wish->exit;
    self->slowest = over_speeds ? wish->slowest : own;
    self->fastest = over_speeds ? wish->fastest : own;
    self->hinge = wish->loop;
    status = wish->loop
                 ? ld_loop_create(model, wish->loop, &self->loop, error)
                 : ld_response_create(model, self->slowest, self->fastest, &self->response, error);
    if (!status && wish->exit)
        ld_response_watch(self->response, wish->watch);
    if (!status && self->friction)
        status = ld_response_friction(self->response, true, error);
    if (!status && wish->density)
        status = density_file_read(wish->density, &self->density, error);
    if (!status)
        status = fill(self, wish, error);
    if (status)
        ld_response_view_free(self);
    else
        *view = self;
    return status;
}

void ld_response_view_free(ld_response_view *view)
{
    if (!view)
        return;
    ld_response_free(view->response);
    ld_loop_free(view->loop);
    free(view->column);
    free(view->name);
    free(view->density.data);
    free(view->x);
    free(view->speed);
    free(view);
}

// ---- as a table ----

// A unit as it is shown, and what values in SI are multiplied by.
static const char *shown_unit(const char *unit, double *factor)
{
    static const char *const units[][2] = {
        {"m", "mm"}, {"rad", "mrad"}, {"m/s", "mm/s"}, {"rad/s", "mrad/s"}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(unit, units[i][0]) == 0) {
            *factor = 1e3;
            return units[i][1];
        }
    *factor = 1;
    return unit;
}

// The unit of amplitudes or densities of what has this unit.
static void value_unit(const ld_response_view *view, const char *unit, char text[NAME])
{
    if (view->kind == LOOP)
        snprintf(text, NAME, "%s", unit);
    else if (view->kind == FREQUENCY)
        snprintf(text, NAME, "%s per %s", unit, view->input->unit);
    else if (strpbrk(unit, "./"))
        snprintf(text, NAME, "(%s)2/Hz", unit);
    else
        snprintf(text, NAME, "%s2/Hz", unit);
}

static int describe_road(const ld_response_view *view, const char *what, char *text, size_t size)
{
    static const char *const tracks[] = {"same", "independent", "coherent"};
    const ld_road *road = &model_base(view->model)->vehicle.road;
    return road->iso_class == LD_ROAD_SMOOTH
               ? snprintf(text, size, "%s the sines of the road", what)
               : snprintf(text, size, "%s a road of class %c, tracks %s", what,
                          'A' + road->iso_class, tracks[road->tracks]);
}

static void describe(const ld_response_view *view, char *text, size_t size)
{
    int at = view->kind == LOOP        ? snprintf(text, size, "Loop of the %s", view->hinge)
             : view->kind == FREQUENCY ? snprintf(text, size, "Response to %s", view->input->name)
             : view->kind == DRIVEN ? snprintf(text, size, "Response to %s, random as %.60s says",
                                               view->input->name, view->density_file)
             : view->kind == EXIT   ? describe_road(view, "Scatter of the exit on", text, size)
                                    : describe_road(view, "Response to", text, size);
    if (model_has_vehicle(view->model) && (!is_over_speeds(view) || view->speeds == 1))
        snprintf(text + at, size - (size_t)at, ", %g km/h", KMH * view->slowest);
}

static size_t greatest(const double *value, size_t count)
{
    size_t best = 0;
    for (size_t i = 1; i < count; i++)
        if (value[i] > value[best])
            best = i;
    return best;
}

// Whether a column is there before the launch.
static bool has_response(const ld_response_view *view, size_t i)
{
    double value =
        is_gain(view) ? view->value[i * view->count] : view->rms[(i + 1) * view->speeds - 1];
    return !isnan(value);
}

static void print_missing(const ld_response_view *view, FILE *stream)
{
    bool any = false;
    for (size_t i = 0; i < view->columns; i++)
        if (!has_response(view, i)) {
            fprintf(stream, "%s%s",
                    any                  ? ", "
                    : view->kind == EXIT ? "\nWithout a value at the exit: "
                                         : "\nWithout a value before the launch: ",
                    view->column[i].name);
            any = true;
        }
    fputs(any ? "\n" : "", stream);
}

static void print_frequency(const ld_response_view *view, FILE *stream)
{
    fprintf(stream, "\n%-28s %-16s %12s %10s %12s\n", "Greatest amplitude", "", "", "at [Hz]",
            "phase [deg]");
    for (size_t i = 0; i < view->columns; i++) {
        const double *value = view->value + i * view->count;
        size_t k = greatest(value, view->count);
        char unit[NAME];
        if (!has_response(view, i))
            continue;
        value_unit(view, view->column[i].unit, unit);
        fprintf(stream, "  %-26s %-16s %12.4g %10.4g %12.1f\n", view->column[i].name, unit,
                value[k], view->x[k], DEGREE * view->phase[i * view->count + k]);
    }
}

static void print_spectrum(const ld_response_view *view, FILE *stream)
{
    fprintf(stream, "\n%-28s %-8s %12s %18s\n", "Root mean square", "", "", "strongest at [Hz]");
    for (size_t i = 0; i < view->columns; i++) {
        double factor;
        const char *unit = shown_unit(view->column[i].unit, &factor);
        if (has_response(view, i))
            fprintf(stream, "  %-26s %-8s %12.4g %18.4g\n", view->column[i].name, unit,
                    factor * view->rms[i], view->top[i]);
    }
}

static void print_speeds(const ld_response_view *view, FILE *stream)
{
    size_t last = view->speeds - 1;
    fprintf(stream, "\n%-28s %-8s %9.4g km/h %7.4g km/h %12s %10s\n",
            view->kind == EXIT ? "Standard deviation" : "Root mean square", "at",
            KMH * view->speed[0], KMH * view->speed[last], "greatest", "at [km/h]");
    for (size_t i = 0; i < view->columns; i++) {
        double factor;
        const char *unit = shown_unit(view->column[i].unit, &factor);
        const double *rms = view->rms + i * view->speeds;
        size_t k = greatest(rms, view->speeds);
        if (has_response(view, i))
            fprintf(stream, "  %-26s %-8s %14.4g %12.4g %12.4g %10.4g\n", view->column[i].name,
                    unit, factor * rms[0], factor * rms[last], factor * rms[k],
                    KMH * view->speed[k]);
    }
}

// How the exit's figures are found.
static void print_exit_method(const ld_response_view *view, FILE *stream)
{
    if (view->draws)
        fprintf(stream, "%d launches with sampled phases of the road\n", view->draws);
    else
        fputs("First order in the road: contacts that open and close make some deviations too "
              "large, pitch and yaw by up to one half; --draws N has no such error\n",
              stream);
}

static void print_exit(const ld_response_view *view, FILE *stream)
{
    fprintf(stream, "\n%-28s %-8s %14s %20s\n", "", "", view->draws ? "mean" : "from rest",
            "standard deviation");
    for (size_t i = 0; i < view->columns; i++) {
        double factor;
        const char *unit = shown_unit(view->column[i].unit, &factor);
        if (has_response(view, i))
            fprintf(stream, "  %-26s %-8s %14.6g %20.4g\n", view->column[i].name, unit,
                    factor * view->top[i], factor * view->rms[i]);
    }
}

// A margin of the gains and where; or that there is none.
static void print_gain(FILE *stream, const char *what, double factor, double at)
{
    if (isnan(at))
        fprintf(stream, "  %-34s %10s\n", what, "any");
    else
        fprintf(stream, "  %-34s %10.4g %7.2f dB, at %.4g Hz\n", what, factor, 20 * log10(factor),
                at);
}

static void print_loop(const ld_response_view *view, FILE *stream)
{
    ld_loop_margins margins;
    ld_loop_margins_of(view->loop, &margins);
    fputs("\nMargins\n", stream);
    print_gain(stream, "gain margin upwards, factor", margins.raise, margins.raise_at);
    print_gain(stream, "gain margin downwards, factor", margins.lower, margins.lower_at);
    if (isnan(margins.crossover)) {
        fputs("  the loop's gain is nowhere 1\n", stream);
    } else {
        fprintf(stream, "  %-34s %10.4g degrees\n", "phase", DEGREE * margins.phase);
        fprintf(stream, "  %-34s %10.4g ms\n", "delay margin", 1e3 * margins.delay);
        fprintf(stream, "  %-34s %10.4g Hz\n", "crossover", margins.crossover);
    }
    fputs("\nClosed\n", stream);
    if (isnan(margins.bandwidth))
        fprintf(stream, "  %-34s %10s\n", "bandwidth of tracking, -3 dB", "none");
    else
        fprintf(stream, "  %-34s %10.4g Hz\n", "bandwidth of tracking, -3 dB", margins.bandwidth);
    if (isnan(margins.peak_at))
        fprintf(stream, "  %-34s %10s\n", "sensitivity above one", "nowhere");
    else
        fprintf(stream, "  %-34s %10.4g at %.4g Hz\n", "peak of the sensitivity", margins.peak,
                margins.peak_at);
    if (!ld_loop_has_rejection(view->loop))
        return;
    const double *rejection = view->value + (OF_LOOP - 1) * view->count;
    size_t k = greatest(rejection, view->count);
    fprintf(stream, "  %-34s %10.4g at %.4g Hz\n", "largest share of the chassis' rotation",
            rejection[k], view->x[k]);
}

void ld_response_view_print(const ld_response_view *view, FILE *stream)
{
    char text[NAME];
    const ld_road *road = &model_base(view->model)->vehicle.road;
    describe(view, text, sizeof text);
    fprintf(stream, "%s; linear about the equilibrium, %s\n", text,
            view->friction ? "friction of the hinges linearised for the motion on the road"
                           : "no Coulomb friction in the hinges");
    bool on_road = view->kind == SPECTRUM || is_over_speeds(view);
    if (on_road && (road->bump_count > 0 || road->profile.rows > 0))
        fputs("Bumps and profile of the road are left out: they occur once\n", stream);
    if (view->kind == EXIT)
        print_exit_method(view, stream);
    if (view->kind == LOOP)
        print_loop(view, stream);
    else if (view->kind == FREQUENCY)
        print_frequency(view, stream);
    else if (is_spectrum(view))
        print_spectrum(view, stream);
    else if (view->kind == EXIT && view->speeds == 1)
        print_exit(view, stream);
    else
        print_speeds(view, stream);
    print_missing(view, stream);
}

// ---- as files ----

// Names and values of a file's columns: `per` of them for each quantity, behind one of x.
typedef struct table {
    size_t width;
    ld_column *column;
    const double **value;
    char (*text)[2][NAME]; // [width] names and units
} table;

static ld_status table_make(table *self, size_t width, ld_error *error)
{
    *self = (table){.column = calloc(width, sizeof *self->column),
                    .value = calloc(width, sizeof *self->value),
                    .text = calloc(width, sizeof *self->text)};
    return self->column && self->value && self->text ? LD_OK : no_memory(error);
}

static void table_free(table *self)
{
    free(self->column);
    free(self->value);
    free(self->text);
}

static void table_add(table *self, const char *name, const char *of, const char *unit,
                      const double *value)
{
    char(*text)[NAME] = self->text[self->width];
    snprintf(text[0], NAME, "%s%s", name, of);
    snprintf(text[1], NAME, "%s", unit);
    self->column[self->width] = (ld_column){.name = text[0], .unit = text[1]};
    self->value[self->width++] = value;
}

static ld_status table_write(const table *self, const char *folder, const char *file, size_t rows,
                             ld_error *error)
{
    const number_columns columns = {self->width, rows, self->column, self->value};
    return columns_write(folder, file, &columns, error);
}

static ld_status write_frequencies(const ld_response_view *view, const char *folder,
                                   ld_error *error)
{
    table all;
    static const char *const files[] = {[FREQUENCY] = "response-frequency.csv",
                                        [SPECTRUM] = "response-spectrum.csv",
                                        [DRIVEN] = "response-spectrum.csv",
                                        [LOOP] = "response-loop.csv"};
    bool gain = is_gain(view);
    ld_status status = table_make(&all, 1 + 2 * view->columns, error);
    if (!status)
        table_add(&all, "frequency", "", "Hz", view->x);
    for (size_t i = 0; i < view->columns && !status; i++) {
        const char *name = view->column[i].name;
        char unit[NAME];
        value_unit(view, view->column[i].unit, unit);
        table_add(&all, name, gain ? ".amplitude" : "", unit, view->value + i * view->count);
        if (gain)
            table_add(&all, name, ".phase", "rad", view->phase + i * view->count);
    }
    if (!status)
        status = table_write(&all, folder, files[view->kind], view->count, error);
    table_free(&all);
    return status;
}

static ld_status write_speeds(const ld_response_view *view, const char *folder, ld_error *error)
{
    table all;
    bool exit = view->kind == EXIT;
    ld_status status = table_make(&all, 1 + 2 * view->columns, error);
    if (!status)
        table_add(&all, "speed", "", "m/s", view->speed);
    for (size_t i = 0; i < view->columns && !status; i++) {
        const ld_column *column = &view->column[i];
        if (exit)
            table_add(&all, column->name, view->draws ? ".mean" : ".rest", column->unit,
                      view->top + i * view->speeds);
        table_add(&all, column->name, exit ? ".deviation" : "", column->unit,
                  view->rms + i * view->speeds);
    }
    if (!status)
        status = table_write(&all, folder, exit ? "response-exit.csv" : "response-rms.csv",
                             view->speeds, error);
    table_free(&all);
    return status;
}

ld_status ld_response_view_write(const ld_response_view *view, const char *folder, ld_error *error)
{
    ld_status status = is_over_speeds(view) ? LD_OK : write_frequencies(view, folder, error);
    return status || is_gain(view) ? status : write_speeds(view, folder, error);
}

// ---- as charts ----

// Charts of quantities of one unit each; the unit's name and that of the axis.
typedef struct chart_page {
    size_t count;
    chart charts[CHARTS];
    const char *unit[CHARTS];
    char label[CHARTS][NAME];
    double *phase; // as drawn
} chart_page;

static ld_status too_many(ld_error *error)
{
    return ld_fail(error, LD_ERR_INPUT,
                   "a page has room for %d charts of %d quantities of one unit each: name fewer "
                   "quantities",
                   CHARTS, CURVES);
}

// The chart of a unit that has room for one more, begun where there is none; NULL: no room.
static chart *chart_of(chart_page *page, const char *unit)
{
    for (size_t i = 0; i < page->count; i++)
        if (strcmp(page->unit[i], unit) == 0 && page->charts[i].count < CURVES)
            return &page->charts[i];
    if (page->count == CHARTS)
        return NULL;
    page->unit[page->count] = unit;
    page->charts[page->count] = (chart){.x_factor = 1, .y_factor = 1};
    return &page->charts[page->count++];
}

static void name_chart(const ld_response_view *view, chart_page *page, size_t i)
{
    chart *it = &page->charts[i];
    double factor;
    const char *unit = shown_unit(page->unit[i], &factor);
    it->y_label = page->label[i];
    it->log_x = it->log_y = !is_over_speeds(view);
    it->decades = is_spectrum(view) || view->kind == LOOP ? 8 : 5;
    if (is_gain(view)) {
        it->title = "Amplitude";
        char per[NAME];
        value_unit(view, page->unit[i], per);
        snprintf(page->label[i], NAME, "amplitude [%.*s]", NAME - 16, per);
    } else if (is_spectrum(view)) {
        it->title = "Power spectral density";
        it->y_factor = factor * factor;
        snprintf(page->label[i], NAME, "density [(%s)²/Hz]", unit);
    } else {
        it->title = view->kind == EXIT ? "Standard deviation" : "Root mean square";
        it->y_factor = factor;
        it->x_factor = KMH;
        snprintf(page->label[i], NAME, "%s [%s]", view->kind == EXIT ? "deviation" : "rms", unit);
    }
    it->x_label = is_over_speeds(view) ? "speed [km/h]" : "frequency [Hz]";
}

// Whether there is anything to see: a value, where the axis is logarithmic one above 0.
static bool is_drawn(const ld_response_view *view, const double *value, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (is_over_speeds(view) ? !isnan(value[i]) : value[i] > 0)
            return true;
    return false;
}

// Amplitudes, densities or root mean squares.
static ld_status add_values(const ld_response_view *view, chart_page *page, ld_error *error)
{
    bool speeds = is_over_speeds(view);
    size_t count = speeds ? view->speeds : view->count;
    const double *x = speeds ? view->speed : view->x, *all = speeds ? view->rms : view->value;
    for (size_t i = 0; i < view->columns; i++) {
        if (!is_drawn(view, all + i * count, count))
            continue;
        chart *it = chart_of(page, view->column[i].unit);
        if (!it)
            return too_many(error);
        it->curve[it->count++] = (chart_curve){
            .label = view->column[i].name, .count = count, .x = x, .y = all + i * count};
    }
    if (page->count == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "none of these quantities responds before the launch, nothing is drawn");
    for (size_t i = 0; i < page->count; i++)
        name_chart(view, page, i);
    return LD_OK;
}

// Phases with gaps where they continue from the other end of the circle.
static ld_status part_phases(const ld_response_view *view, chart_page *page, ld_error *error)
{
    size_t count = view->columns * view->count;
    page->phase = malloc((count + 1) * sizeof *page->phase);
    if (!page->phase)
        return no_memory(error);
    for (size_t i = 0; i < count; i++) {
        bool jumps = i % view->count > 0 && fabs(view->phase[i] - view->phase[i - 1]) > PI;
        page->phase[i] = jumps ? NAN : view->phase[i];
    }
    return LD_OK;
}

// A chart of phases below each chart of amplitudes.
static ld_status add_phases(const ld_response_view *view, chart_page *page, ld_error *error)
{
    const double *phase = page->phase;
    size_t count = page->count;
    if (2 * count > CHARTS)
        return too_many(error);
    for (size_t i = count; i-- > 0;) {
        chart *above = &page->charts[2 * i], *below = above + 1;
        *above = page->charts[i];
        *below = *above;
        below->title = "Phase";
        below->y_label = "phase [deg]";
        below->y_factor = DEGREE;
        below->y_step = 90;
        below->log_y = false;
        for (int k = 0; k < below->count; k++)
            below->curve[k].y = phase + (above->curve[k].y - view->value);
    }
    page->count = 2 * count;
    return LD_OK;
}

ld_status ld_response_view_draw(const ld_response_view *view, const char *file, ld_error *error)
{
    char heading[NAME];
    if (view->kind == EXIT && view->speeds == 1)
        return ld_fail(error, LD_ERR_INPUT,
                       "the scatter of the exit is drawn over speeds: set --speeds");
    chart_page *page = calloc(1, sizeof *page);
    if (!page)
        return no_memory(error);
    ld_status status = add_values(view, page, error);
    if (!status && is_gain(view))
        status = part_phases(view, page, error);
    if (!status && is_gain(view))
        status = add_phases(view, page, error);
    describe(view, heading, sizeof heading);
    if (!status)
        status = charts_draw(file, heading, page->charts, page->count, error);
    free(page->phase);
    free(page);
    return status;
}
