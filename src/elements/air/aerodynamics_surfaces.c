#include "elements/air/aerodynamics_surfaces.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "elements/air/barrowman.h"
#include "math/functions.h"

// What adds to a column of the table: a factor times a given table, the slope of a fin, or 1.
typedef struct part {
    int column;
    double factor;
    curves given;  // of no points: none
    double aspect; // of a fin; 0: none
} part;

enum {
    COLUMN_FORCING = 2,
    COLUMN_DAMPING = 3,
    MOST_PARTS = 2 + 3 * LD_MAX_AIR_SURFACES,
    FIN_POINTS = 122, // Mach numbers at which the slopes of fins are taken
    FIN_MOST = 10,    // the last of them
};

typedef struct part_list {
    air_surfaces *air;
    const ld_aerodynamics *model;
    ld_error *error;
    double area; // S [m2]
    part part[MOST_PARTS];
    int count;
} part_list;

// ---- the parts of each surface

static part *add(part_list *list, int column, double factor)
{
    part *added = &list->part[list->count++];
    *added = (part){.column = column, .factor = factor};
    return added;
}

// Records that the slopes of a surface (NULL: the axial coefficients) end at a Mach number; key:
// the table's, NULL: none.
static void take_end(air_surfaces *air, double last, const char *name, const char *key)
{
    if (last >= air->last_mach)
        return;
    air->last_mach = last;
    snprintf(air->last_of, sizeof air->last_of, "rocket.aerodynamics.%s%s%s%s",
             name ? "surfaces." : "", name ? name : "", name && key ? "." : "", key ? key : "");
}

// A table of the scenario: of two columns, or the column `from` of one of three. Where it ends
// counts for the surface `name` (NULL: the axial coefficients), as its key.
typedef struct given_table {
    const ld_table *table;
    size_t from;
    const char *name, *key;
} given_table;

static ld_status add_table(part_list *list, int column, double factor, given_table given)
{
    const ld_table *table = given.table;
    static const curve_kind kind[] = {
        [LD_PCHIP] = CURVE_PCHIP, [LD_SPLINE] = CURVE_SPLINE, [LD_LINEAR] = CURVE_LINEAR};
    if (table->rows == 0)
        return LD_OK;
    double *pairs = malloc(2 * table->rows * sizeof *pairs);
    if (!pairs)
        return ld_fail(list->error, LD_ERR_MEMORY, "no memory for the aerodynamic tables");
    for (size_t i = 0; i < table->rows; i++) {
        pairs[2 * i] = table->data[i * table->columns];
        pairs[2 * i + 1] = table->data[i * table->columns + given.from];
    }
    ld_status status = curves_build(&add(list, column, factor)->given, table->rows, 2, pairs,
                                    kind[list->model->interpolation], list->error);
    if (table->rows > 1)
        take_end(list->air, table->data[(table->rows - 1) * table->columns], given.name, given.key);
    free(pairs);
    return status;
}

// The column of the next slope, at x of B.
static int slope_column(part_list *list, double x)
{
    air_surfaces *air = list->air;
    air->slope_at[air->slopes] = x + list->model->x_cp_shift;
    return SURFACES_FIRST + air->slopes++;
}

static void add_across(part_list *list, double coefficient, double x)
{
    air_surfaces *air = list->air;
    if (coefficient == 0)
        return;
    air->across[air->acrosses] = coefficient;
    air->across_at[air->acrosses++] = x;
}

static void add_body(part_list *list, const ld_air_surface *surface, barrowman_body shape)
{
    if (shape.slope != 0)
        add(list, slope_column(list, surface->at - shape.center),
            list->model->cn_scale * surface->slope_scale * shape.slope);
    add_across(list, surface->body_lift * shape.side / list->area, surface->at - shape.side_center);
}

static void add_fins(part_list *list, const ld_air_surface *surface)
{
    barrowman_fins fins = barrowman_fins_of(surface, list->area, list->model->reference_diameter);
    double scale = list->model->cn_scale * surface->slope_scale;
    int column = slope_column(list, surface->at - fins.center);
    add(list, column, scale * fins.slope)->aspect = fins.aspect;
    add(list, COLUMN_FORCING, surface->slope_scale * surface->cant * fins.forcing)->aspect =
        fins.aspect;
    add(list, COLUMN_DAMPING, surface->slope_scale * fins.damping)->aspect = fins.aspect;
    take_end(list->air, FIN_MOST, surface->name, NULL);
}

static ld_status add_coefficients(part_list *list, const ld_air_surface *surface)
{
    double area = isnan(surface->area) ? 1 : surface->area / list->area;
    double scale = area * list->model->cn_scale * surface->slope_scale;
    const given_table slope = {&surface->slope, 1, surface->name, "slope"};
    const given_table forcing = {&surface->roll_forcing, 1, surface->name, "roll_forcing"};
    const given_table damping = {&surface->roll_damping, 1, surface->name, "roll_damping"};
    ld_status status = add_table(list, slope_column(list, surface->at), scale, slope);
    if (!status)
        status = add_table(list, COLUMN_FORCING, area * surface->cant, forcing);
    if (!status)
        status = add_table(list, COLUMN_DAMPING, area, damping);
    return status;
}

static ld_status add_surface(part_list *list, const ld_air_surface *surface)
{
    double area = list->area;
    switch (surface->kind) {
    case LD_AIR_COEFFICIENTS:
        return add_coefficients(list, surface);
    case LD_AIR_NOSE:
        add_body(list, surface,
                 barrowman_nose(surface->shape, surface->length, surface->radius, area));
        return LD_OK;
    case LD_AIR_BODY:
        add_body(list, surface,
                 barrowman_tail(surface->radius, surface->radius, surface->length, area));
        return LD_OK;
    case LD_AIR_TAIL:
        add_body(
            list, surface,
            barrowman_tail(surface->front_radius, surface->rear_radius, surface->length, area));
        return LD_OK;
    case LD_AIR_FINS:
        add_fins(list, surface);
        return LD_OK;
    }
    return LD_OK;
}

static ld_status add_all(part_list *list)
{
    const ld_aerodynamics *model = list->model;
    const ld_table *axial = &model->axial;
    ld_status status = LD_OK;
    for (size_t k = 0; k < 2 && !status; k++) {
        const given_table one = {axial, axial->columns == 3 ? k + 1 : 1, NULL, "axial"};
        status = add_table(list, (int)k, model->ca_scale, one);
    }
    for (int i = 0; i < model->surface_count && !status; i++)
        status = add_surface(list, &model->surface[i]);
    if (model->crossflow.present)
        add_across(list, model->crossflow.drag, model->crossflow.at);
    return status;
}

// ---- one table of all

// Cubic of the part from a to b in powers of x - a, or with b = a its value there; a table is
// constant past its last row.
static void cubic_of(const part *self, double a, double b, double c[4])
{
    const curves *given = &self->given;
    memset(c, 0, 4 * sizeof *c);
    if (given->points > 0 && a >= given->x[given->points - 1]) {
        curves_held(given, a, c);
    } else if (given->points > 0) {
        size_t i = curves_interval(given, a, 0);
        const double *p = given->coefficient + 4 * i;
        double d = a - given->x[i];
        c[0] = p[0] + d * (p[1] + d * (p[2] + d * p[3]));
        c[1] = p[1] + d * (2 * p[2] + d * 3 * p[3]);
        c[2] = p[2] + d * 3 * p[3];
        c[3] = p[3];
    } else if (self->aspect > 0) {
        double h = b - a, d0, d1, y1 = barrowman_fin(self->aspect, b, a, &d1);
        c[0] = barrowman_fin(self->aspect, a, b, &d0);
        if (h == 0)
            return;
        double s = (y1 - c[0]) / h;
        c[1] = d0;
        c[2] = (3 * s - 2 * d0 - d1) / h;
        c[3] = (d0 + d1 - 2 * s) / (h * h);
    } else {
        c[0] = 1;
    }
}

static int ascending(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// Mach numbers at which cubics meet the slopes of fins within 1.3e-6 of themselves, whatever their
// aspect ratio, and within 2.4e-7 up to one of 5. Above Mach 1 they lie as Mach - 1 grows, by which
// the slopes of wide fins fall. Computed once by each thread.
static const double *fin_points(void)
{
    enum { SUBSONIC = 40 };
    static _Thread_local double mach[FIN_POINTS];
    if (mach[SUBSONIC] > 0)
        return mach;
    const double first = BARROWMAN_SUPERSONIC - 1, most = FIN_MOST - 1;
    for (int i = 0; i < SUBSONIC; i++)
        mach[i] = BARROWMAN_SUBSONIC * i / SUBSONIC;
    mach[SUBSONIC] = BARROWMAN_SUBSONIC;
    int steps = FIN_POINTS - SUBSONIC - 2;
    for (int i = 0; i <= steps; i++)
        mach[SUBSONIC + 1 + i] = 1 + first * pow(most / first, (double)i / steps);
    return mach;
}

// The corners of all parts up to `last`, each once; at least two. Returns how many there are.
static size_t corners_of(const part_list *list, double last, double *x)
{
    size_t count = 0, kept = 1;
    bool fins = false;
    x[count++] = 0;
    for (int i = 0; i < list->count; i++) {
        const curves *given = &list->part[i].given;
        for (size_t k = 0; k < given->points; k++)
            x[count++] = given->x[k];
        fins |= list->part[i].aspect > 0;
    }
    if (fins) {
        memcpy(x + count, fin_points(), FIN_POINTS * sizeof *x);
        count += FIN_POINTS;
    }
    qsort(x, count, sizeof *x, ascending);
    for (size_t i = 1; i < count; i++)
        if (x[i] > x[kept - 1] && x[i] <= last)
            x[kept++] = x[i];
    return kept;
}

static ld_status merge(const part_list *list, curves *all)
{
    const air_surfaces *air = list->air;
    size_t most = 2 + FIN_POINTS; // with 0, and the end of the last
    for (int i = 0; i < list->count; i++)
        most += list->part[i].given.points;
    *all = (curves){.count = SURFACES_FIRST + air->slopes};
    size_t width = (size_t)all->count;
    all->x = malloc(most * sizeof(double));
    all->coefficient = calloc(4 * width * most, sizeof(double));
    if (!all->x || !all->coefficient)
        return ld_fail(list->error, LD_ERR_MEMORY, "no memory for the aerodynamic tables");
    size_t corners = corners_of(list, air->last_mach, all->x);
    for (size_t i = 0; i < corners; i++)
        for (int k = 0; k < list->count; k++) {
            const part *one = &list->part[k];
            double c[4], *at = all->coefficient + 4 * i * width + one->column;
            // past the last corner all is constant
            bool past = i + 1 == corners;
            cubic_of(one, all->x[i], all->x[past ? i : i + 1], c);
            for (size_t power = 0; power < (past ? 1 : 4); power++)
                at[power * width] += one->factor * c[power];
        }
    all->x[corners] = all->x[corners - 1] + 1;
    all->points = corners + 1;
    return LD_OK;
}

ld_status air_surfaces_build(air_surfaces *self, const ld_aerodynamics *model, curves *table,
                             ld_error *error)
{
    const double pi = 3.14159265358979323846, d = model->reference_diameter;
    part_list list = {.air = self, .model = model, .error = error, .area = pi * d * d / 4};
    *self = (air_surfaces){.last_mach = INFINITY};
    *table = (curves){0};
    ld_status status = add_all(&list);
    if (!status)
        status = merge(&list, table);
    for (int i = 0; i < list.count; i++)
        curves_free(&list.part[i].given);
    return status;
}
