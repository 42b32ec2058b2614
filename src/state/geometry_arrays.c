#include "state/geometry_arrays.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

double *geometry_add(geometry *all, const char *name, const char *unit, size_t rows, size_t columns,
                     const char *description)
{
    double *value = all->value + all->used;
    assert(all->count < GEOMETRY_MOST_ARRAYS);
    if (rows * columns > 0)
        all->array[all->count++] = (ld_array){name, unit, description, rows, columns, value};
    all->used += rows * columns;
    return value;
}

void geometry_add_row(geometry *all, const char *name, const char *unit, int count,
                      const double *values, const char *description)
{
    double *to = geometry_add(all, name, unit, 1, (size_t)count, description);
    memcpy(to, values, (size_t)count * sizeof *to);
}

// Name OF.WHAT of the array that is added next.
static const char *name_of(geometry *all, const char *of, const char *what)
{
    char *name = all->name[all->count];
    snprintf(name, GEOMETRY_NAME, "%s.%s", of, what);
    return name;
}

// ---- shapes

size_t geometry_shapes_room(const flexible_tube *tube)
{
    return (size_t)(tube->element_count + 1) * (size_t)(1 + 4 * tube->nb + tube->nt + tube->na);
}

// Value or slope of a plane's shapes at node `node`: coefficients of the element that begins there,
// or at the end of the last one.
static void bending_at(const flexible_tube *tube, int plane, int node, int derivative, double *to)
{
    bool last = node == tube->element_count;
    const tube_element *element = &tube->element[last ? node - 1 : node];
    double xi = last ? element->x1 - element->x0 : 0;
    const double(*b)[LD_NB] = element->b[plane];
    for (int i = 0; i < tube->nb; i++)
        to[i] = derivative ? b[1][i] + xi * (2 * b[2][i] + xi * 3 * b[3][i])
                           : b[0][i] + xi * (b[1][i] + xi * (b[2][i] + xi * b[3][i]));
}

void geometry_add_shapes(geometry *all, const char *of, const flexible_tube *tube)
{
    int nodes = tube->element_count + 1;
    size_t rows = (size_t)nodes, nb = (size_t)tube->nb;
    double *station = geometry_add(all, name_of(all, of, "station"), "m", rows, 1,
                                   "nodes of the finite elements");
    double *b[] = {
        geometry_add(all, name_of(all, of, "bending"), "kg-0.5", rows, nb,
                     "bending modes at the stations: y of the axis over q; cubic between"),
        geometry_add(all, name_of(all, of, "bending_z"), "kg-0.5", rows, nb, "the same for z")};
    double *slope[] = {geometry_add(all, name_of(all, of, "bending_slope"), "kg-0.5.m-1", rows, nb,
                                    "slopes for y"),
                       geometry_add(all, name_of(all, of, "bending_z_slope"), "kg-0.5.m-1", rows,
                                    nb, "slopes for z")};
    double *torsion =
        geometry_add(all, name_of(all, of, "torsion"), "kg-0.5.m-1", rows, (size_t)tube->nt,
                     "torsion modes: rotation about x over q; linear between");
    double *axial = geometry_add(all, name_of(all, of, "axial"), "kg-0.5", rows, (size_t)tube->na,
                                 "axial modes: x over q; linear between");
    for (int k = 0; k < nodes; k++) {
        bool last = k == tube->element_count;
        const tube_element *element = &tube->element[last ? k - 1 : k];
        double xi = last ? element->x1 - element->x0 : 0;
        station[k] = element->x0 + xi;
        for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
            bending_at(tube, plane, k, 0, b[plane] + k * tube->nb);
            bending_at(tube, plane, k, 1, slope[plane] + k * tube->nb);
        }
        for (int i = 0; i < tube->nt; i++)
            torsion[k * tube->nt + i] = element->tau[0][i] + xi * element->tau[1][i];
        for (int i = 0; i < tube->na; i++)
            axial[k * tube->na + i] = element->a[0][i] + xi * element->a[1][i];
    }
}

enum { SHAPE_COLUMNS = 7 };

size_t geometry_initial_shape_room(const initial_shape *shape)
{
    return shape ? SHAPE_COLUMNS * shape->of.points : 0;
}

void geometry_add_initial_shape(geometry *all, const initial_shape *shape)
{
    if (!shape)
        return;
    double *to = geometry_add(all, "tube.initial_shape", "m", shape->of.points, SHAPE_COLUMNS,
                              "initial shape of the guide: station, y, z [m], twist [rad], their "
                              "derivatives by the station; cubic between");
    for (size_t i = 0; i < shape->of.points; i++, to += SHAPE_COLUMNS) {
        initial_section at;
        to[0] = shape->of.x[i];
        initial_shape_at(shape, to[0], &at);
        to[1] = at.P.y;
        to[2] = at.P.z;
        to[3] = at.th.x;
        to[4] = at.P1.y;
        to[5] = at.P1.z;
        to[6] = at.th1.x;
    }
}

void geometry_add_sections(geometry *all, const char *of, const ld_section *section, int count)
{
    static const double PI = 3.14159265358979323846;
    double *to = geometry_add(all, name_of(all, of, "section"), "m", (size_t)count, 3,
                              "sections: station where each begins, inner and outer radius");
    for (int i = 0; i < count; i++, to += 3) {
        double bore = section[i].bore_radius;
        to[0] = section[i].from;
        to[1] = bore;
        to[2] = section[i].form == LD_SECTION_ANNULUS ? section[i].outer_radius
                : section[i].form == LD_SECTION_AREA  ? sqrt(bore * bore + section[i].area / PI)
                                                      : NAN;
    }
}
