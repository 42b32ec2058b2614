#define LANES 1
#include "elements/air/aerodynamics.h"

#include <stdlib.h>
#include <string.h>

#include "elements/air/aerodynamics_real.h"

static void build_body(aerodynamics *self, const ld_aerodynamics *model)
{
    double damping[3];
    for (int i = 0; i < 3; i++)
        damping[i] = 0.25 * model->area * model->lengths[i] * model->lengths[i] * model->damping[i];
    self->drag = 0.5 * model->area * model->drag;
    self->damping = v3_from(damping);
    self->axisymmetric = damping[1] == damping[2];
}

// The table with its scales and shift.
static ld_status build_table(aerodynamics *self, const ld_aerodynamics *model, ld_error *error)
{
    const double factor[] = {1, model->ca_scale, model->ca_scale, model->cn_scale, 1, 1, 1, 1};
    const curve_kind kind[] = {
        [LD_PCHIP] = CURVE_PCHIP, [LD_SPLINE] = CURVE_SPLINE, [LD_LINEAR] = CURVE_LINEAR};
    size_t columns = model->table.columns;
    ld_table scaled = model->table;
    scaled.data = malloc(scaled.rows * columns * sizeof(double));
    if (!scaled.data)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the aerodynamic table");
    for (size_t i = 0; i < scaled.rows; i++)
        for (size_t k = 0; k < columns; k++)
            scaled.data[i * columns + k] =
                model->table.data[i * columns + k] * factor[k] + (k == 4 ? model->x_cp_shift : 0);
    ld_status status = curves_build(&self->table, scaled.rows, columns, scaled.data,
                                    kind[model->interpolation], error);
    self->last_mach = scaled.data[(scaled.rows - 1) * columns];
    strcpy(self->last_of, "rocket.aerodynamics.table");
    free(scaled.data);
    return status;
}

static ld_status build_surfaces(aerodynamics *self, const ld_aerodynamics *model, ld_error *error)
{
    ld_status status = air_surfaces_build(&self->surfaces, model, &self->table, error);
    self->last_mach = self->surfaces.last_mach;
    memcpy(self->last_of, self->surfaces.last_of, sizeof self->last_of);
    return status;
}

ld_status aerodynamics_build(aerodynamics *self, const ld_aerodynamics *model, ld_error *error)
{
    const double pi = 3.14159265358979323846;
    *self = (aerodynamics){.present = model->present,
                           .model = model->model,
                           .axisymmetric = true,
                           .last_mach = INFINITY};
    if (!model->present)
        return LD_OK;
    if (model->model == LD_AERODYNAMICS_BODY) {
        build_body(self, model);
        return LD_OK;
    }
    self->diameter = model->reference_diameter;
    self->half_area = pi * self->diameter * self->diameter / 8;
    if (model->model == LD_AERODYNAMICS_SURFACES)
        return build_surfaces(self, model, error);
    self->cant = model->fin_cant;
    if (model->crossflow.present) {
        self->crossflow_drag = model->crossflow.drag;
        self->crossflow_at = model->crossflow.at;
    }
    return build_table(self, model, error);
}

void aerodynamics_free(aerodynamics *self)
{
    curves_free(&self->table);
}

LD_INLINE real3 real3_of(v3 a)
{
    return (real3){a.x, a.y, a.z};
}

static real_wrench wrench_of(const aerodynamics *self, const airflow *flow, bool power,
                             size_t *interval)
{
    const real_airflow of_reals = {real3_of(flow->v), flow->speed, real3_of(flow->w),
                                   real3_of(flow->c), flow->density};
    if (self->model == LD_AERODYNAMICS_BODY)
        return aerodynamics_of_body(self->drag, real3_of(self->damping), &of_reals);
    double k[SURFACES_COLUMNS], mach = flow->mach;
    double held = mach < self->last_mach ? mach : self->last_mach;
    *interval = curves_interval(&self->table, held, *interval);
    curves_values(&self->table, *interval, held, k);
    if (self->model == LD_AERODYNAMICS_SURFACES) {
        const air_surfaces *of = &self->surfaces;
        const real_surfaces all = {self->half_area, self->diameter, of->slopes, of->acrosses,
                                   of->slope_at,    of->across_at,  of->across};
        return aerodynamics_of_surfaces(&all, k, k[power], &of_reals, NULL);
    }
    const real_body body = {self->half_area, self->diameter, self->cant, self->crossflow_drag,
                            self->crossflow_at};
    return aerodynamics_of_coefficients(&body, k, k[power], &of_reals);
}

air_wrench aerodynamics_wrench(const aerodynamics *self, const airflow *flow, bool power,
                               size_t *interval)
{
    real_wrench out = wrench_of(self, flow, power, interval);
    return (air_wrench){{out.f.x, out.f.y, out.f.z}, {out.m.x, out.m.y, out.m.z}};
}

air_center aerodynamics_center(const aerodynamics *self, double mach)
{
    double k[SURFACES_COLUMNS], held = mach < self->last_mach ? mach : self->last_mach;
    if (!self->present || self->model == LD_AERODYNAMICS_BODY)
        return (air_center){0, NAN};
    curves_values(&self->table, curves_interval(&self->table, held, 0), held, k);
    if (self->model == LD_AERODYNAMICS_TABLE)
        return (air_center){k[2], k[2] != 0 ? k[3] : NAN};
    double slope = 0, first = 0;
    for (int i = 0; i < self->surfaces.slopes; i++) {
        slope += k[SURFACES_FIRST + i];
        first += k[SURFACES_FIRST + i] * self->surfaces.slope_at[i];
    }
    return (air_center){slope, slope != 0 ? first / slope : NAN};
}
