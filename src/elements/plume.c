#include "elements/plume.h"

#include <math.h>

#include "math/functions.h"

static const double pi = 3.14159265358979323846;

// The jet across its axis at one distance: Gaussian of the radius b, or linear between two
// distances of the table, each with its rows.
typedef struct plume_cut {
    double b;             // [m]; 0: by the table
    const double *row[2]; // the first of each distance: distance, radius, pressure
    size_t rows[2];
    double share; // of the second distance
} plume_cut;

// What is within a radius: its force over the radius squared; and what is outside, but for a
// constant.
typedef struct plume_part {
    double over_square, outside; // [N/m2], [N]; of a round jet [1/m2], [-]
} plume_part;

static size_t rows_at_distance(const ld_table *table, size_t first)
{
    size_t end = first;
    while (end < table->rows && table->data[3 * end] == table->data[3 * first])
        end++;
    return end - first;
}

static plume_cut cut_at(const ld_plume *plume, double distance)
{
    const ld_table *table = &plume->pressure;
    if (plume->form == LD_PLUME_ROUND)
        return (plume_cut){.b = plume->radius + plume->spread * distance};
    size_t a = 0, of_a = rows_at_distance(table, a), b = of_a;
    while (b < table->rows && table->data[3 * b] < distance) {
        a = b;
        of_a = rows_at_distance(table, a);
        b += of_a;
    }
    const double *first = table->data + 3 * a;
    if (b == table->rows)
        return (plume_cut){.row = {first, first}, .rows = {of_a, of_a}};
    const double *next = table->data + 3 * b;
    double share = (distance - first[0]) / (next[0] - first[0]);
    return (plume_cut){.row = {first, next},
                       .rows = {of_a, rows_at_distance(table, b)},
                       .share = share > 0 ? share : 0};
}

// Of the pressure p = A + B s between two rows, over the area from r0 to r1.
static double force_between(const double *row, double r0, double r1)
{
    double B = (row[5] - row[2]) / (row[4] - row[1]), A = row[2] - B * row[1];
    return pi * A * (r1 * r1 - r0 * r0) + 2 * pi / 3 * B * (r1 * r1 * r1 - r0 * r0 * r0);
}

static plume_part part_by_rows(const double *row, size_t rows, double rho)
{
    plume_part part = {0};
    double within = 0, first = row[4], B = (row[5] - row[2]) / first;
    // on the axis, too
    double near = pi * row[2] + 2 * pi / 3 * B * rho;
    for (size_t k = 1; k < rows; k++, row += 3) {
        double end = fmin(fmax(rho, row[1]), row[4]);
        within += force_between(row, row[1], end);
        part.outside += force_between(row, end, row[4]);
    }
    part.over_square = rho < first ? near : within / (rho * rho);
    return part;
}

static plume_part part_within(const plume_cut *cut, double rho2)
{
    if (cut->b > 0) {
        double x = rho2 / (cut->b * cut->b);
        double mean = x > 0 ? -expm1(-x) / x : 1;
        return (plume_part){mean / (cut->b * cut->b), exp(-x)};
    }
    double rho = rho2 > 0 ? sqrt(rho2) : 0;
    plume_part a = part_by_rows(cut->row[0], cut->rows[0], rho);
    plume_part b = part_by_rows(cut->row[1], cut->rows[1], rho);
    return (plume_part){a.over_square + cut->share * (b.over_square - a.over_square),
                        a.outside + cut->share * (b.outside - a.outside)};
}

// What a circle bears of a jet, and the moment of that about the circle's centre [m], towards the
// jet's axis.
typedef struct borne {
    double force, moment;
} borne;

// Of radius a, the jet's axis `off` its centre. Gauss's theorem makes both integrals over the rim
// (model.md, section 5); for a round jet of radius b the trapezoidal rule is exact there to
// rounding for a up to 8 b.
static borne borne_by_circle(const plume_cut *cut, double a, double off)
{
    enum { STEPS = 48 }; // of half the rim
    borne sum = {0};
    for (int k = 0; k <= STEPS; k++) {
        double c = cos(pi * k / STEPS), weight = (k % STEPS ? 1.0 : 0.5) / STEPS;
        plume_part part = part_within(cut, a * a + off * off - 2 * a * off * c);
        sum.force += weight * part.over_square * a * (a - off * c);
        sum.moment -= weight * part.outside * a * c;
    }
    sum.moment += off * sum.force;
    return sum;
}

plume_load plume_on_ring(const ld_plume *plume, plume_ring ring, plume_thrust thrust, v3 r, v3 axis)
{
    if (axis.x < 0.1 || !(thrust.now > 0)) // the jet blows past
        return (plume_load){0};
    double distance = r.x / axis.x;
    v3 hit = v3_axpy(r, -distance, axis);
    distance = fmax(distance, 0);
    double off = hypot(hit.y, hit.z);
    plume_cut cut = cut_at(plume, distance);
    borne outer = borne_by_circle(&cut, ring.outer, off);
    borne inner = borne_by_circle(&cut, ring.inner, off);
    double scale = cut.b > 0 ? thrust.now : thrust.now / thrust.greatest;
    double force = scale * (outer.force - inner.force), moment = outer.moment - inner.moment;
    if (force < 1e-12 * thrust.now || distance >= plume->reach)
        return (plume_load){0};
    double fades = fmin(10 * (1 - distance / plume->reach), 1);
    double arm = off > 0 ? scale * moment / (force * off) : 0;
    return (plume_load){fades * force, {arm * hit.y, arm * hit.z}};
}
