#include "elements/tube/initial_shape.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "math/functions.h"

static const double PI = 3.14159265358979323846;

enum { SURVEYED, BENDS, PARTS, ROWS_OF_A_HALF_WAVE = 32 };

// Standard normal number i of an axis.
static double normal_of(uint64_t seed, uint64_t stream, int axis, size_t i)
{
    return normal_quantile(random_uniform(seed, stream, (uint64_t)axis, i, 0));
}

// The surveyed rows with their errors, times the factors.
static ld_status survey(const ld_initial_shape *given, curves *self, ld_error *error)
{
    const ld_table *table = &given->offsets;
    const double scale[3] = {given->scale[0], given->scale[1], given->twist_scale};
    size_t size = table->rows * table->columns;
    uint64_t seed = (uint64_t)given->seed, stream = random_stream("initial_shape.accuracy");
    double *row = malloc(size * sizeof *row);
    if (!row)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the initial shape");
    memcpy(row, table->data, size * sizeof *row);
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; given->accuracy[k] > 0 && i < table->rows; i++)
            row[i * table->columns + 1 + (size_t)k] +=
                given->accuracy[k] * normal_of(seed, stream, k, i);
    ld_status status = curves_build(self, table->rows, table->columns, row, CURVE_SPLINE, error);
    free(row);
    if (status)
        return status;
    size_t count = (size_t)self->count, coefficients = 4 * (self->points - 1) * count;
    for (size_t i = 0; i < coefficients; i++)
        self->coefficient[i] *= scale[i % count];
    return LD_OK;
}

// Sum over n of g_n n^-decay sin(n pi x/L) along y and z, as large as the deviation.
static void sum_half_waves(const ld_initial_shape *given, size_t rows, double length, double *row)
{
    const ld_random_bends *random = &given->random;
    uint64_t seed = (uint64_t)given->seed, stream = random_stream("initial_shape.random");
    double most = 0;
    for (size_t i = 0; i < rows; i++) {
        double part = (double)i / (double)(rows - 1), sum[2] = {0, 0};
        for (int n = 1; n <= random->terms; n++)
            for (int k = 0; k < 2; k++)
                sum[k] += normal_of(seed, stream, k, (size_t)n) * pow(n, -random->decay) *
                          sin(n * PI * part);
        most = fmax(most, hypot(sum[0], sum[1]));
        memcpy(row + 3 * i, (double[]){length * part, sum[0], sum[1]}, 3 * sizeof *row);
    }
    for (size_t i = 0; i < rows; i++)
        for (size_t k = 1; k < 3; k++)
            row[3 * i + k] *= random->deviation / most;
}

static ld_status bend(const ld_tubes *tubes, curves *self, ld_error *error)
{
    size_t rows = (size_t)(ROWS_OF_A_HALF_WAVE * tubes->initial_shape.random.terms) + 1;
    double *row = malloc(3 * rows * sizeof *row);
    if (!row)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the initial shape");
    sum_half_waves(&tubes->initial_shape, rows, tubes->length, row);
    ld_status status = curves_build(self, rows, 3, row, CURVE_SPLINE, error);
    free(row);
    return status;
}

// ---- the sum

// Adds a part's polynomial about x, which it has at `inside`.
static void add_part(const curves *part, double inside, double x, size_t count, double *sum)
{
    size_t i = curves_find(part, inside), n = (size_t)part->count;
    double t = x - part->x[i];
    for (size_t k = 0; k < n; k++) {
        const double *c = part->coefficient + 4 * i * n + k;
        sum[k] += c[0] + t * (c[n] + t * (c[2 * n] + t * c[3 * n]));
        sum[count + k] += c[n] + t * (2 * c[2 * n] + t * 3 * c[3 * n]);
        sum[2 * count + k] += c[2 * n] + t * 3 * c[3 * n];
        sum[3 * count + k] += c[3 * n];
    }
}

// Adds a joint's: a step rounded as 3 u^2 - 2 u^3, a kink by an arc, both C1.
static void add_joint(const ld_rail_joint *joint, double inside, double x, size_t count,
                      double *sum)
{
    double l = joint->length, begin = joint->at - l / 2, u = (x - begin) / l;
    for (size_t k = 0; k < 2; k++) {
        double step = joint->step[k], kink = joint->kink[k];
        if (inside > begin + l) {
            sum[k] += step + kink * (x - joint->at);
            sum[count + k] += kink;
        } else if (inside > begin) {
            sum[k] += step * u * u * (3 - 2 * u) + kink * l * u * u / 2;
            sum[count + k] += step * 6 * u * (1 - u) / l + kink * u;
            sum[2 * count + k] += step * (3 - 6 * u) / (l * l) + kink / (2 * l);
            sum[3 * count + k] -= step * 2 / (l * l * l);
        }
    }
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Where any of the polynomials changes, rising, without those closer than some roundings.
static size_t breaks_of(const ld_tubes *tubes, const curves *part, double *x)
{
    const ld_initial_shape *given = &tubes->initial_shape;
    size_t points = 0, kept = 1;
    for (int i = 0; i < PARTS; i++) {
        if (part[i].points > 0)
            memcpy(x + points, part[i].x, part[i].points * sizeof *x);
        points += part[i].points;
    }
    x[points++] = 0;
    x[points++] = tubes->length;
    for (int i = 0; i < given->joint_count; i++) {
        x[points++] = given->joint[i].at - given->joint[i].length / 2;
        x[points++] = given->joint[i].at + given->joint[i].length / 2;
    }
    qsort(x, points, sizeof *x, compare_numbers);
    for (size_t i = 1; i < points; i++)
        if (x[i] - x[kept - 1] > 1e-12 * tubes->length)
            x[kept++] = x[i];
    return kept;
}

// The polynomials of all parts together.
static ld_status add_up(const ld_tubes *tubes, const curves *part, curves *sum, ld_error *error)
{
    const ld_initial_shape *given = &tubes->initial_shape;
    size_t room = part[SURVEYED].points + part[BENDS].points + 2 + 2 * (size_t)given->joint_count;
    size_t count = part[SURVEYED].count > 2 ? 3 : 2;
    *sum = (curves){.count = (int)count};
    sum->x = malloc(room * sizeof *sum->x);
    sum->coefficient = calloc(4 * room * count, sizeof *sum->coefficient);
    if (!sum->x || !sum->coefficient) {
        curves_free(sum);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the initial shape");
    }
    sum->points = breaks_of(tubes, part, sum->x);
    for (size_t i = 0; i + 1 < sum->points; i++) {
        double x = sum->x[i], inside = (x + sum->x[i + 1]) / 2;
        double *c = sum->coefficient + 4 * i * count;
        for (int k = 0; k < PARTS; k++)
            if (part[k].points > 0)
                add_part(&part[k], inside, x, count, c);
        for (int k = 0; k < given->joint_count; k++)
            add_joint(&given->joint[k], inside, x, count, c);
    }
    return LD_OK;
}

ld_status initial_shape_build(const ld_tubes *tubes, initial_shape **self, ld_error *error)
{
    const ld_initial_shape *given = &tubes->initial_shape;
    curves part[PARTS] = {{0}};
    *self = NULL;
    if (!given->present)
        return LD_OK;
    initial_shape *shape = calloc(1, sizeof *shape);
    ld_status status =
        shape ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the initial shape");
    if (!status && given->offsets.rows > 0)
        status = survey(given, &part[SURVEYED], error);
    if (!status && given->random.present)
        status = bend(tubes, &part[BENDS], error);
    if (!status)
        status = add_up(tubes, part, &shape->of, error);
    for (int i = 0; i < PARTS; i++)
        curves_free(&part[i]);
    if (status)
        free(shape);
    else
        *self = shape;
    return status;
}

void initial_shape_free(initial_shape *self)
{
    if (self)
        curves_free(&self->of);
    free(self);
}

void initial_shape_at(const initial_shape *self, double x, initial_section *at)
{
    const curves *of = &self->of;
    size_t i = curves_find(of, x), count = (size_t)of->count;
    double t = x - of->x[i], d[3][4] = {{0}}; // y_0, z_0, tau_0 with their derivatives
    for (size_t k = 0; k < count; k++) {
        const double *c = of->coefficient + 4 * i * count + k;
        double c1 = c[count], c2 = c[2 * count], c3 = c[3 * count];
        d[k][0] = c[0] + t * (c1 + t * (c2 + t * c3));
        d[k][1] = c1 + t * (2 * c2 + t * 3 * c3);
        d[k][2] = 2 * c2 + t * 6 * c3;
        d[k][3] = 6 * c3;
    }
    at->P = v3_make(0, d[0][0], d[1][0]);
    at->P1 = v3_make(0, d[0][1], d[1][1]);
    at->P2 = v3_make(0, d[0][2], d[1][2]);
    at->th = v3_make(d[2][0], -d[1][1], d[0][1]);
    at->th1 = v3_make(d[2][1], -d[1][2], d[0][2]);
    at->th2 = v3_make(d[2][2], -d[1][3], d[0][3]);
}
