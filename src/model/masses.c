#include "model/masses.h"

#include "model/motor_clock.h"

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

// p S(X)
static m3 of_point(double p, v3 X)
{
    return m3_scale(p, m3_sub(m3_scale(v3_norm2(X), m3_identity()), m3_outer(X, X)));
}

// Of motor k, 0 the first.
static const ld_table *part_table(const ld_rocket *rocket, int k)
{
    return k == 0 ? &rocket->motor.masses : &rocket->further_motor[k - 1].masses;
}

static double part_time(const ld_rocket *rocket, int k, const double *row)
{
    return k == 0 ? motor_clock(&rocket->motor, row[MASSES_TIME])
                  : further_motor_clock(&rocket->further_motor[k - 1], row[MASSES_TIME]);
}

// A part at time t after ignition; constant before its first row and after its last.
static void part_at(const ld_rocket *rocket, int k, double t, double row[MASSES_COLUMNS])
{
    const ld_table *table = part_table(rocket, k);
    size_t next = 0;
    while (next < table->rows && part_time(rocket, k, table->data + next * MASSES_COLUMNS) <= t)
        next++;
    const double *b = table->data + (next < table->rows ? next : table->rows - 1) * MASSES_COLUMNS;
    const double *a = next > 0 ? table->data + (next - 1) * MASSES_COLUMNS : b;
    double from = part_time(rocket, k, a), span = part_time(rocket, k, b) - from;
    for (int i = 0; i < MASSES_COLUMNS; i++)
        row[i] = span > 0 ? a[i] + (b[i] - a[i]) * (t - from) / span : a[i];
}

// Mass, first moment and inertia about B's origin.
typedef struct moments {
    double m;
    v3 first;
    m3 second;
} moments;

static void add_part(const ld_rocket *rocket, int k, const double row[MASSES_COLUMNS], double sign,
                     moments *sum)
{
    const double *line = k == 0 ? rocket->full.center : rocket->further_motor[k - 1].at;
    double from = k == 0 ? rocket->motor.masses_at : rocket->further_motor[k - 1].masses_at;
    v3 X = v3_make(from + row[MASSES_CENTER], line[1], line[2]);
    double p = sign * row[MASSES_MASS], axial = sign * row[MASSES_AXIAL],
           across = sign * row[MASSES_TRANSVERSE];
    sum->m += p;
    sum->first = v3_axpy(sum->first, p, X);
    sum->second = m3_add(sum->second, m3_add(m3_diagonal(axial, across, across), of_point(p, X)));
}

m3 masses_of_parts(const ld_rocket *rocket, double t, double *mass, v3 *center)
{
    const ld_mass_data *full = &rocket->full;
    v3 c = v3_from(full->center);
    moments sum = {full->mass, v3_scale(full->mass, c), of_point(full->mass, c)};
    for (int k = 0; k <= rocket->further_motor_count; k++) {
        double now[MASSES_COLUMNS];
        if (part_table(rocket, k)->rows == 0)
            continue;
        part_at(rocket, k, t, now);
        add_part(rocket, k, now, 1, &sum);
        add_part(rocket, k, part_table(rocket, k)->data, -1, &sum);
    }
    *mass = sum.m;
    *center = v3_scale(1 / sum.m, sum.first);
    return m3_sub(sum.second, of_point(sum.m, *center));
}
