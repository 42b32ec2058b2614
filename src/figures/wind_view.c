// Winds to look at: profile, gusts and turbulence as tables, files and charts.
#include <stdlib.h>
#include <string.h>

#include "base/printed.h"
#include "environment/turbulence.h"
#include "environment/wind.h"
#include "figures/chart.h"
#include "launchdyn/environment.h"
#include "math/curves/spectrum.h"
#include "math/functions.h"
#include "model/parts.h"
#include "results/columns.h"

enum { LEVELS = 201, INSTANTS = 1001, MOST_PLACES = 1000000, MOST_BANDS = 100, AXES = 3 };

static const double TWO_PI = 6.283185307179586476925286766559;

// Velocities over one variable.
typedef struct wind_series {
    size_t count;
    double *s, *v[AXES]; // [count]
} wind_series;

struct ld_wind_view {
    const ld_wind *model;
    ld_wind_section section;
    wind_series profile, gusts, turbulence; // over height [m], time [s], distance [m]
    double *scales[4];                      // [LEVELS] L_u, L_w, sigma_u, sigma_w over height
    turbulence_scales at_height;
    size_t bands;
    double edge[MOST_BANDS + 1]; // [rad/m]
    double density[AXES][MOST_BANDS], line[AXES][MOST_BANDS];
};

static const char *axis_name(const ld_wind_view *view, int axis)
{
    static const char *const names[2][AXES] = {{"x", "y", "z"}, {"north", "up", "east"}};
    return names[view->model->axes == LD_WIND_GEOGRAPHIC][axis];
}

// ---- the view ----

static ld_status allocate(wind_series *series, size_t count, ld_error *error)
{
    series->count = count;
    series->s = malloc((AXES + 1) * count * sizeof(double));
    if (!series->s)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a wind at %zu points", count);
    for (int axis = 0; axis < AXES; axis++)
        series->v[axis] = series->s + (size_t)(axis + 1) * count;
    return LD_OK;
}

static void put(wind_series *series, size_t i, double s, v3 v)
{
    series->s[i] = s;
    series->v[0][i] = v.x;
    series->v[1][i] = v.y;
    series->v[2][i] = v.z;
}

// The wind before any gust, up to the top.
static ld_status fill_profile(ld_wind_view *view, const wind *air, const turbulence *rough,
                              ld_error *error)
{
    ld_status status = allocate(&view->profile, LEVELS, error);
    view->scales[0] = status ? NULL : malloc(4 * LEVELS * sizeof(double));
    if (status || !view->scales[0])
        return status ? status : ld_fail(error, LD_ERR_MEMORY, "no memory for a wind");
    for (size_t i = 0; i < LEVELS; i++) {
        double height = view->section.top * (double)i / (LEVELS - 1);
        turbulence_scales scales = turbulence_scales_at(rough, height);
        const double values[4] = {scales.L_u, scales.L_w, scales.sigma_u, scales.sigma_w};
        put(&view->profile, i, height, wind_at(air, -INFINITY, height));
        for (int k = 0; k < 4; k++) {
            view->scales[k] = view->scales[0] + k * LEVELS;
            view->scales[k][i] = values[k];
        }
    }
    return LD_OK;
}

// The wind at the height from a second before the first gust to a second after the last.
static ld_status fill_gusts(ld_wind_view *view, const wind *air, ld_error *error)
{
    double first = wind_next_corner(air, -INFINITY), last = first;
    if (!isfinite(first))
        return LD_OK;
    for (double corner = first; isfinite(corner); corner = wind_next_corner(air, corner))
        last = corner;
    ld_status status = allocate(&view->gusts, INSTANTS, error);
    for (size_t i = 0; i < INSTANTS && !status; i++) {
        double t = first - 1 + (last - first + 2) * (double)i / (INSTANTS - 1);
        put(&view->gusts, i, t, wind_at(air, t, view->section.height));
    }
    return status;
}

static ld_status set_line(ld_wind_view *view, ld_error *error)
{
    ld_wind_section *section = &view->section;
    if (isnan(section->length))
        section->length = 100 * view->at_height.L_u;
    if (isnan(section->step))
        section->step = 0.03 * fmin(view->at_height.L_u, view->at_height.L_w);
    double places = floor(section->length / section->step * (1 + 1e-12)) + 1;
    if (!(section->step > 0 && places >= 2 && places <= MOST_PLACES))
        return ld_fail(
            error, LD_ERR_INPUT,
            "a line through the air requires 2 to %d points; %g m by %g m has another number",
            MOST_PLACES, section->length, section->step);
    return allocate(&view->turbulence, (size_t)places, error);
}

// Thirds of octaves (base 10) from two periods in the line to half the sampling rate, as far as
// there are harmonics.
static void set_bands(ld_wind_view *view)
{
    const turbulence_scales *at = &view->at_height;
    double low = fmax(2 * TWO_PI / view->section.length, 0.01 / fmin(at->L_u, at->L_w));
    double high = fmin(TWO_PI / 2 / view->section.step, 100 / fmax(at->L_u, at->L_w));
    view->bands = 0;
    view->edge[0] = low;
    int third = (int)floor(10 * log10(low) + 1);
    for (; view->bands < MOST_BANDS && view->edge[view->bands] < high; third++)
        view->edge[++view->bands] = fmin(pow(10, (third + 0.5) / 10), high);
    for (size_t i = 0; i < view->bands; i++) {
        double Omega = sqrt(view->edge[i] * view->edge[i + 1]);
        double u2L = at->sigma_u * at->sigma_u * at->L_u, w2L = at->sigma_w * at->sigma_w * at->L_w;
        view->line[0][i] = u2L * turbulence_longitudinal(at->L_u * Omega);
        view->line[1][i] = w2L * turbulence_transverse(at->L_w * Omega);
        view->line[2][i] = u2L * turbulence_transverse(at->L_u * Omega);
    }
}

// Turbulence along a line at the height, and its spectra.
static ld_status fill_turbulence(ld_wind_view *view, const turbulence *rough, ld_error *error)
{
    if (!rough->present)
        return LD_OK;
    view->at_height = turbulence_scales_at(rough, view->section.height);
    ld_status status = set_line(view, error);
    wind_series *line = &view->turbulence;
    for (size_t i = 0; i < line->count && !status; i++) {
        double s = (double)i * view->section.step;
        put(line, i, s,
            turbulence_velocity(rough, &view->at_height, s / view->at_height.L_u,
                                s / view->at_height.L_w));
    }
    if (status)
        return status;
    set_bands(view);
    double cycles[MOST_BANDS + 1];
    for (size_t i = 0; i <= view->bands; i++)
        cycles[i] = view->edge[i] / TWO_PI;
    for (int axis = 0; axis < AXES && !status; axis++) {
        const spectrum_series series = {line->count, view->section.step, line->v[axis],
                                        line->v[axis]};
        const spectrum_bands bands = {
            .count = view->bands, .edge = cycles, .aa = view->density[axis]};
        status = spectrum_in_bands(&series, &bands, error);
        for (size_t i = 0; i < view->bands; i++)
            view->density[axis][i] /= TWO_PI;
    }
    return status;
}

static ld_status fill(ld_wind_view *view, ld_error *error)
{
    wind air = {0};
    turbulence rough = {0};
    ld_status status = wind_build(&air, view->model, error);
    if (!status)
        status =
            turbulence_build(&rough, &view->model->turbulence, view->section.rocket - 1, error);
    if (!status)
        status = fill_profile(view, &air, &rough, error);
    if (!status)
        status = fill_gusts(view, &air, error);
    if (!status)
        status = fill_turbulence(view, &rough, error);
    wind_free(&air);
    turbulence_free(&rough);
    return status;
}

ld_status ld_wind_view_create(const ld_model *model, ld_wind_section section, ld_wind_view **view,
                              ld_error *error)
{
    if (!model_environment(model)->wind.present)
        return ld_fail(error, LD_ERR_INPUT, "there is no wind in the scenario");
    if (!(section.height >= 0 && section.top > 0 && section.rocket >= 1))
        return ld_fail(
            error, LD_ERR_INPUT,
            "expected a height of at least 0 m, a top above it and the number of a rocket from 1");
    ld_wind_view *created = calloc(1, sizeof *created);
    if (!created)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a wind");
    created->model = &model_environment(model)->wind;
    created->section = section;
    ld_status status = fill(created, error);
    if (status)
        ld_wind_view_free(created);
    else
        *view = created;
    return status;
}

void ld_wind_view_free(ld_wind_view *view)
{
    if (!view)
        return;
    free(view->profile.s);
    free(view->gusts.s);
    free(view->turbulence.s);
    free(view->scales[0]);
    free(view);
}

// ---- as a table ----

static double rms(const double *values, size_t count)
{
    double square = 0;
    for (size_t i = 0; i < count; i++)
        square += values[i] * values[i] / (double)count;
    return sqrt(square);
}

static void print_profile(const ld_wind_view *view, FILE *stream)
{
    fprintf(stream, "Wind before any gust [m/s], where the air goes to\n  %s [m]",
            view->model->axes == LD_WIND_GEOGRAPHIC ? "altitude" : "height");
    for (int axis = 0; axis < AXES; axis++)
        fprintf(stream, "%12s", axis_name(view, axis));
    for (size_t i = 0; i < LEVELS; i += (LEVELS - 1) / 10) {
        fprintf(stream, "\n  %8.4g  ", view->profile.s[i]);
        for (int axis = 0; axis < AXES; axis++)
            fprintf(stream, "%12.3f", printed_fixed(view->profile.v[axis][i], 3));
    }
    fputc('\n', stream);
}

static void print_gusts(const ld_wind_view *view, FILE *stream)
{
    if (view->model->gust_count)
        fprintf(stream, "\nGusts\n  start [s]   rise [s]   hold [s]   fall [s] speed [m/s] heading "
                        "[deg]\n");
    for (int i = 0; i < view->model->gust_count; i++) {
        const ld_gust *gust = &view->model->gust[i];
        fprintf(stream, "  %9.4g%11.4g%11.4g%11.4g%12.4g%14.4g\n", gust->start, gust->rise,
                gust->hold, isnan(gust->fall) ? gust->rise : gust->fall, gust->speed,
                gust->heading * 360 / TWO_PI);
    }
}

static void print_turbulence(const ld_wind_view *view, FILE *stream)
{
    const ld_wind_section *section = &view->section;
    const turbulence_scales *at = &view->at_height;
    if (!view->turbulence.count)
        return;
    fprintf(stream,
            "\nTurbulence of rocket %d, seed %d, along %.4g m at %.4g m, every %.4g m\n"
            "                  x           y           z\n"
            "  length [m]%7.1f%12.1f%12.1f\n  sigma [m/s]%6.3f%12.3f%12.3f\n"
            "  rms here   ",
            section->rocket, view->model->turbulence.seed, section->length, section->height,
            section->step, at->L_u, at->L_w, at->L_u, at->sigma_u, at->sigma_w, at->sigma_u);
    for (int axis = 0; axis < AXES; axis++)
        fprintf(stream, axis ? "%12.3f" : "%6.3f",
                rms(view->turbulence.v[axis], view->turbulence.count));
    fprintf(stream, "\n\nPower spectral density [m3/s2/rad]\n  Omega [rad/m]%21s%10s%10s%30s\n",
            "x", "y", "z", "  Dryden x         y         z");
    for (size_t i = 0; i < view->bands; i++) {
        fprintf(stream, "  %9.5f to %9.5f", view->edge[i], view->edge[i + 1]);
        for (int axis = 0; axis < AXES; axis++)
            fprintf(stream, axis ? "%10.3g" : "%12.3g", view->density[axis][i]);
        for (int axis = 0; axis < AXES; axis++)
            fprintf(stream, axis ? "%10.3g" : "%12.3g", view->line[axis][i]);
        fputc('\n', stream);
    }
}

void ld_wind_view_print(const ld_wind_view *view, FILE *stream)
{
    print_profile(view, stream);
    print_gusts(view, stream);
    print_turbulence(view, stream);
}

// ---- as files ----

// A file of a series: what it runs over, names of the wind's components.
typedef struct series_file {
    const char *name, *over, *unit;
    const char *const *axis; // [AXES]
} series_file;

static ld_status write_series(const ld_wind_view *view, const wind_series *series,
                              const series_file *file, const char *folder, ld_error *error)
{
    const char *const *axis = file->axis;
    const ld_column columns[] = {{.name = file->over, .unit = file->unit},
                                 {.name = axis[0], .unit = "m/s"},
                                 {.name = axis[1], .unit = "m/s"},
                                 {.name = axis[2], .unit = "m/s"},
                                 {.name = "L_u", .unit = "m"},
                                 {.name = "L_w", .unit = "m"},
                                 {.name = "sigma_u", .unit = "m/s"},
                                 {.name = "sigma_w", .unit = "m/s"}};
    const double *values[] = {series->s,       series->v[0],    series->v[1],    series->v[2],
                              view->scales[0], view->scales[1], view->scales[2], view->scales[3]};
    if (!series->count)
        return LD_OK;
    size_t width = series == &view->profile && view->turbulence.count ? 8 : 4;
    const number_columns all = {width, series->count, columns, values};
    return columns_write(folder, file->name, &all, error);
}

static ld_status write_spectrum(const ld_wind_view *view, const char *folder, ld_error *error)
{
    static const char density[] = "m3/s2/rad";
    static const ld_column columns[] = {
        {.name = "from", .unit = "rad/m"},     {.name = "to", .unit = "rad/m"},
        {.name = "x", .unit = density},        {.name = "y", .unit = density},
        {.name = "z", .unit = density},        {.name = "dryden.x", .unit = density},
        {.name = "dryden.y", .unit = density}, {.name = "dryden.z", .unit = density}};
    const double *values[] = {view->edge,       view->edge + 1, view->density[0], view->density[1],
                              view->density[2], view->line[0],  view->line[1],    view->line[2]};
    if (!view->turbulence.count)
        return LD_OK;
    const number_columns all = {8, view->bands, columns, values};
    return columns_write(folder, "wind-spectrum.csv", &all, error);
}

ld_status ld_wind_view_write(const ld_wind_view *view, const char *folder, ld_error *error)
{
    static const char *const inertial[AXES] = {"x", "y", "z"};
    const char *axis[AXES] = {axis_name(view, 0), axis_name(view, 1), axis_name(view, 2)};
    const char *over = view->model->axes == LD_WIND_GEOGRAPHIC ? "altitude" : "height";
    const wind_series *const series[] = {&view->profile, &view->gusts, &view->turbulence};
    const series_file file[] = {{"wind-profile.csv", over, "m", axis},
                                {"wind-gusts.csv", "t", "s", axis},
                                {"wind-turbulence.csv", "distance", "m", inertial}};
    ld_status status = LD_OK;
    for (size_t i = 0; i < sizeof file / sizeof *file && !status; i++)
        status = write_series(view, series[i], &file[i], folder, error);
    return status ? status : write_spectrum(view, folder, error);
}

// ---- as charts ----

static chart new_chart(const char *title, const char *x_label, const char *y_label)
{
    return (chart){
        .title = title, .x_label = x_label, .y_label = y_label, .x_factor = 1, .y_factor = 1};
}

static void add_series(chart *to, const wind_series *series, const char *const axis[AXES],
                       bool upright)
{
    for (int k = 0; k < AXES; k++)
        to->curve[to->count++] =
            upright
                ? (chart_curve){.label = axis[k],
                                .count = series->count,
                                .x = series->v[k],
                                .y = series->s}
                : (chart_curve){
                      .label = axis[k], .count = series->count, .x = series->s, .y = series->v[k]};
}

ld_status ld_wind_view_draw(const ld_wind_view *view, const char *file, ld_error *error)
{
    static const char *const inertial[AXES] = {"x", "y", "z"};
    const char *axis[AXES] = {axis_name(view, 0), axis_name(view, 1), axis_name(view, 2)};
    double middle[MOST_BANDS];
    chart charts[4];
    size_t count = 0;
    charts[count] = new_chart("Before any gust", "wind [m/s]", "height [m]");
    add_series(&charts[count++], &view->profile, axis, true);
    if (view->gusts.count) {
        charts[count] = new_chart("With the gusts", "t [s]", "wind [m/s]");
        add_series(&charts[count++], &view->gusts, axis, false);
    }
    if (view->turbulence.count) {
        charts[count] = new_chart("Turbulence along the line", "distance [m]", "wind [m/s]");
        add_series(&charts[count++], &view->turbulence, inertial, false);
        for (size_t i = 0; i < view->bands; i++)
            middle[i] = sqrt(view->edge[i] * view->edge[i + 1]);
        charts[count] = new_chart("Power spectral density, grey: Dryden's",
                                  "spatial frequency Ω [rad/m]", "density [m³/s²/rad]");
        charts[count].log_x = charts[count].log_y = true;
        for (int k = 0; k < AXES; k++)
            charts[count].curve[charts[count].count++] = (chart_curve){
                .label = "", .count = view->bands, .x = middle, .y = view->line[k], .faint = true};
        for (int k = 0; k < AXES; k++)
            charts[count].curve[charts[count].count++] = (chart_curve){
                .label = inertial[k], .count = view->bands, .x = middle, .y = view->density[k]};
        count++;
    }
    return charts_draw(file, "Wind", charts, count, error);
}
