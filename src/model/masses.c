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
