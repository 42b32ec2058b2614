#include "model/masses.h"

ld_mass_data masses_at(const ld_rocket *rocket, size_t row)
{
    const ld_table *table = &rocket->motor.masses;
    const double *first = table->data, *now = table->data + row * table->columns;
    ld_mass_data out = rocket->full;
    // from the mass centre at ignition
    double from = rocket->full.center[0] - rocket->motor.masses_at;
    double before = first[MASSES_CENTER] - from, after = now[MASSES_CENTER] - from;
    out.mass += now[MASSES_MASS] - first[MASSES_MASS];
    double moved = (now[MASSES_MASS] * after - first[MASSES_MASS] * before) / out.mass;
    out.center[0] += moved;
    out.inertia[0] += now[MASSES_AXIAL] - first[MASSES_AXIAL];
    for (int i = 1; i < 3; i++)
        out.inertia[i] += now[MASSES_TRANSVERSE] - first[MASSES_TRANSVERSE] +
                          now[MASSES_MASS] * after * after - first[MASSES_MASS] * before * before -
                          out.mass * moved * moved;
    return out;
}

double masses_left(const ld_rocket *rocket, const ld_mass_data *data, int axis, double *mass)
{
    double c[3], moment = data->inertia[axis];
    *mass = data->mass;
    for (int k = 0; k < 3; k++)
        c[k] = data->center[k];
    for (int i = 0; i < rocket->adaptor_count; i++) {
        const ld_falling *part = &rocket->adaptor[i].falls_off;
        const double at[3] = {rocket->adaptor[i].at, part->center[0], part->center[1]};
        double m = *mass, rest = m - part->mass, off = 0;
        if (!part->present)
            continue;
        for (int k = 0; k < 3; k++) {
            off += k == axis ? 0 : (at[k] - c[k]) * (at[k] - c[k]);
            c[k] -= part->mass / rest * (at[k] - c[k]);
        }
        moment -= part->inertia[axis] + m * part->mass / rest * off;
        *mass = rest;
    }
    return moment;
}
