#include "state/carried.h"

#include "math/functions.h"

static double dot(const double *a, const double *b)
{
    double sum = 0;
    for (int j = 0; j < SHOE_FREEDOMS; j++)
        sum += a[j] * b[j];
    return sum;
}

static void remove_basis(const carried_directions *carried, double *row)
{
    for (int i = 0; i < carried->count; i++) {
        double part = dot(row, carried->basis[i]);
        for (int j = 0; j < SHOE_FREEDOMS; j++)
            row[j] -= part * carried->basis[i][j];
    }
}

// Adds what is new in a direction of unit size or so.
static void add_direction(carried_directions *carried, double *row)
{
    remove_basis(carried, row);
    remove_basis(carried, row); // the second time for what rounding has left
    double size = sqrt(dot(row, row));
    if (size < 1e-6)
        return;
    for (int j = 0; j < SHOE_FREEDOMS; j++)
        carried->basis[carried->count][j] = row[j] / size;
    carried->count++;
}

void carried_find(const launching_system *launching, const launching_phase *phase,
                  const launching_output *out, bool rolls, carried_directions *carried)
{
    const surface_set *set = &launching->surfaces;
    double length = 0, width = 1e-3;
    for (int i = 0; i < launching->adaptors.count; i++)
        length = fmax(length, launching->adaptors.at[i]);
    for (int k = 0; k < set->count; k++)
        width = fmax(width, hypot(set->surface[k].y, set->surface[k].z));
    *carried = (carried_directions){.scale = {1, 1, length, length, width}};
    for (int i = 0; i < launching->adaptors.count; i++)
        for (int k = 0; k < set->count && !phase->passed[i]; k++) {
            const guide_surface *s = &set->surface[k];
            double at = launching->adaptors.at[i] / length;
            double arm = rolls && s->flat ? (s->nz * s->y - s->ny * s->z) / width : 0;
            double row[SHOE_FREEDOMS] = {s->ny, s->nz, s->ny * at, -s->nz * at, arm};
            if (out->shoe[i].penetration[k] > 0)
                add_direction(carried, row);
        }
}

void carried_remove(const carried_directions *carried, double displacement[SHOE_FREEDOMS])
{
    for (int j = 0; j < SHOE_FREEDOMS; j++)
        displacement[j] *= carried->scale[j];
    remove_basis(carried, displacement);
    for (int j = 0; j < SHOE_FREEDOMS; j++)
        displacement[j] /= carried->scale[j];
}
