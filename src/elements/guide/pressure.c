#include "elements/guide/pressure.h"

#include "math/functions.h"

ld_status pressure_build(const ld_tubes *tubes, pressure_system *self, ld_error *error)
{
    const ld_pressure *given = &tubes->pressure;
    const ld_table *table = &given->over_travel;
    const double pi = 3.14159265358979323846;
    double radius = tubes->section[0].bore_radius;
    *self = (pressure_system){.given = given->present ? given : NULL, .area = pi * radius * radius};
    if (!given->present || given->form != LD_PRESSURE_OVER_TRAVEL)
        return LD_OK;
    return curves_build(&self->over_travel, table->rows, 2, table->data, CURVE_PCHIP, error);
}

void pressure_free(pressure_system *self)
{
    curves_free(&self->over_travel);
    self->given = NULL;
}

double pressure_next_corner(const ld_pressure *given, int piece)
{
    if (given->form != LD_PRESSURE_OVER_TIME)
        return piece > 0 ? INFINITY : 0;
    return piece < (int)given->over_time.rows ? given->over_time.data[2 * piece] : INFINITY;
}

// After the last row there is nothing.
static double over_time(const ld_pressure *given, int piece, double since)
{
    if (piece >= (int)given->over_time.rows)
        return 0;
    const double *from = given->over_time.data + 2 * (piece - 1), *to = from + 2;
    double p = from[1] + (to[1] - from[1]) / (to[0] - from[0]) * (since - from[0]);
    return given->scale * p - given->ambient;
}

double pressure_at(const pressure_system *self, int piece, double since, double s)
{
    const ld_pressure *given = self->given;
    double travel = fmax(0, s - self->start), table;
    switch (given->form) {
    case LD_PRESSURE_OVER_TIME:
        return over_time(given, piece, since);
    case LD_PRESSURE_OVER_TRAVEL:
        curves_held(&self->over_travel, travel, &table);
        return given->scale * table - given->ambient;
    default: {
        double share = given->volume / (given->volume + self->area * travel);
        return given->scale * given->pressure * pow(share, given->exponent) - given->ambient;
    }
    }
}
