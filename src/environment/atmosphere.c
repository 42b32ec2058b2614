#define LANES 1
#include "environment/atmosphere.h"

#include <stdlib.h>
#include <string.h>

#include "environment/atmosphere_real.h"
#include "math/functions.h"
#include "model/moist_air.h"

static const double layer_base[] = {0, 11000, 20000, 32000, 47000, 51000, 71000};
static const double layer_lapse[] = {-6.5e-3, 0, 1e-3, 2.8e-3, 0, -2.8e-3, -2e-3};

static double pressure_ratio(const atmosphere_layer *layer, double H, double T)
{
    const real_layer here = {layer->base, layer->lapse, layer->temperature, layer->density,
                             layer->exponent};
    return atmosphere_pressure_ratio(&here, H, T);
}

static void build_layers(atmosphere *self)
{
    double T = 288.15, p = 101325;
    for (int i = 0; i < ATMOSPHERE_LAYERS; i++) {
        atmosphere_layer *layer = &self->layer[i];
        double lapse = layer_lapse[i];
        *layer = (atmosphere_layer){
            .base = layer_base[i],
            .lapse = lapse,
            .temperature = T,
            .pressure = p,
            .density = p / (ATMOSPHERE_GAS_CONSTANT * T),
            .exponent = lapse == 0 ? 0 : -ATMOSPHERE_GRAVITY / (ATMOSPHERE_GAS_CONSTANT * lapse),
        };
        if (i + 1 < ATMOSPHERE_LAYERS) {
            T += layer->lapse * (layer_base[i + 1] - layer->base);
            p *= pressure_ratio(layer, layer_base[i + 1], T);
        }
    }
}

// ---- measured air

enum { LOG_P = 1, T_V, COLUMNS }; // behind the altitude

// Distance [m] of the rows by which us1976 continues beyond the measured ones; the nearest lies no
// nearer to these than half of it.
#define FARTHER_ROWS 250.0
#define LOWEST (-5000.0)

static double farther_height(int i)
{
    return LOWEST + FARTHER_ROWS * i;
}

// The row of us1976 at an altitude, scaled so that it continues from the row `end`.
static void farther_row(const atmosphere *self, double z, const double *end, double *row)
{
    double T, p, T_end, p_end;
    atmosphere_state(self, z, &T, &p);
    atmosphere_state(self, end[0], &T_end, &p_end);
    double scale = end[T_V] / T_end;
    row[0] = z;
    row[LOG_P] = end[LOG_P] + log(p / p_end) / scale;
    row[T_V] = scale * T;
}

static void measured_row(const double *given, size_t columns, double *row)
{
    row[0] = given[0];
    row[LOG_P] = log(given[1]);
    row[T_V] = columns == 4 ? virtual_temperature(given[1], given[2], given[3]) : given[2];
}

// All rows, from below the measured ones to above them; how many.
static size_t fill_rows(const atmosphere *self, const ld_table *given, double *rows)
{
    double first[COLUMNS], last[COLUMNS];
    size_t count = 0;
    measured_row(given->data, given->columns, first);
    measured_row(given->data + (given->rows - 1) * given->columns, given->columns, last);
    for (int i = 0; farther_height(i) < first[0] - 0.5 * FARTHER_ROWS; i++)
        farther_row(self, farther_height(i), first, rows + COLUMNS * count++);
    for (size_t i = 0; i < given->rows; i++)
        measured_row(given->data + i * given->columns, given->columns, rows + COLUMNS * count++);
    for (int i = 0; farther_height(i) <= ATMOSPHERE_TOP; i++)
        if (farther_height(i) > last[0] + 0.5 * FARTHER_ROWS)
            farther_row(self, farther_height(i), last, rows + COLUMNS * count++);
    return count;
}

// d(log p)/dz [1/m] of air at rest, gravity falling with the altitude.
static double hydrostatic_slope(double z, double T)
{
    double share = ATMOSPHERE_EARTH_RADIUS / (ATMOSPHERE_EARTH_RADIUS + z);
    return -ATMOSPHERE_GRAVITY * share * share / (ATMOSPHERE_GAS_CONSTANT * T);
}

static ld_status build_profile(atmosphere *self, const ld_table *given, ld_error *error)
{
    const size_t farther = (size_t)((ATMOSPHERE_TOP - LOWEST) / FARTHER_ROWS) + 2;
    double *rows = malloc((COLUMNS + 1) * (given->rows + farther) * sizeof *rows);
    if (!rows)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %zu rows of air", given->rows);
    size_t count = fill_rows(self, given, rows);
    double *slope = rows + COLUMNS * count;
    for (size_t i = 0; i < count; i++)
        slope[i] = hydrostatic_slope(rows[COLUMNS * i], rows[COLUMNS * i + T_V]);
    ld_status status = curves_build(&self->profile, count, COLUMNS, rows, CURVE_PCHIP, error);
    if (!status)
        curves_set_slopes(&self->profile, LOG_P - 1, slope);
    free(rows);
    return status;
}

static ld_status keep_given(atmosphere *self, const ld_table *given, ld_error *error)
{
    size_t size = given->rows * given->columns * sizeof *given->data;
    double *data = malloc(size);
    if (!data)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %zu rows of air", given->rows);
    memcpy(data, given->data, size);
    self->given = (ld_table){.rows = given->rows, .columns = given->columns, .data = data};
    return LD_OK;
}

static bool is_given(const atmosphere *self, const ld_table *table)
{
    const ld_table *given = &self->given;
    return given->data && given->rows == table->rows && given->columns == table->columns &&
           memcmp(given->data, table->data, table->rows * table->columns * sizeof(double)) == 0;
}

ld_status atmosphere_build(atmosphere *self, const ld_atmosphere *model, ld_error *error)
{
    *self = (atmosphere){0};
    return atmosphere_renew(self, model, error);
}

ld_status atmosphere_renew(atmosphere *self, const ld_atmosphere *model, ld_error *error)
{
    bool keeps = model->kind == LD_ATMOSPHERE_PROFILE && is_given(self, &model->profile);
    if (!keeps)
        atmosphere_free(self);
    *self = (atmosphere){.kind = model->kind,
                         .density = model->density,
                         .speed_of_sound = model->speed_of_sound,
                         .density_scale = model->density_scale,
                         .temperature_offset = model->temperature_offset,
                         .profile = self->profile,
                         .given = self->given};
    build_layers(self);
    if (keeps || self->kind != LD_ATMOSPHERE_PROFILE)
        return LD_OK;
    ld_status status = build_profile(self, &model->profile, error);
    return status ? status : keep_given(self, &model->profile, error);
}

void atmosphere_free(atmosphere *self)
{
    curves_free(&self->profile);
    free(self->given.data);
    self->given = (ld_table){0};
}

void atmosphere_state(const atmosphere *self, double altitude, double *temperature,
                      double *pressure)
{
    double H = atmosphere_geopotential(altitude);
    const atmosphere_layer *layer = self->layer + atmosphere_layer_number(self->layer, H);
    *temperature = layer->temperature + layer->lapse * (H - layer->base);
    *pressure = layer->pressure * pressure_ratio(layer, H, *temperature);
}

static air air_of(real_air found)
{
    return (air){found.density, found.speed_of_sound};
}

static air measured_at(const atmosphere *self, double altitude)
{
    CURVES_KEPT(ATMOSPHERE_FUNCTIONS) kept;
    double *block = (double *)&kept;
    curves_keep(block, 0, &self->profile, altitude, ATMOSPHERE_FUNCTIONS);
    return air_of(
        atmosphere_measured(block, altitude, self->density_scale, self->temperature_offset));
}

air atmosphere_at(const atmosphere *self, double altitude)
{
    air out = {0, 1};
    if (self->kind == LD_ATMOSPHERE_US1976)
        out = air_of(atmosphere_standard(self->layer, altitude, self->density_scale,
                                         self->temperature_offset));
    else if (self->kind == LD_ATMOSPHERE_PROFILE)
        out = measured_at(self, altitude);
    else if (self->kind == LD_ATMOSPHERE_UNIFORM)
        out = (air){self->density_scale * self->density, self->speed_of_sound};
    return out;
}
