#include "studies/statistics/density.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "studies/statistics/statistics.h"

const double density_share[DENSITY_LEVELS] = {0.5, 0.95};

enum { LAST = DENSITY_GRID - 1, MARGIN = 3 };

// Where the points lie in nodes: along the main axes from the least of them less MARGIN kernels.
typedef struct placed {
    double *at[2]; // [count]
    size_t count;
    double effective; // independent points that tell as much
    double kernel[2]; // width in nodes
} placed;

static void turn_to_axes(const double *x, const double *y, size_t count,
                         const covariance_ellipse *e, double *const at[2])
{
    double c = cos(e->angle), s = sin(e->angle);
    for (size_t i = 0; i < count; i++) {
        double dx = x[i] - e->mean[0], dy = y[i] - e->mean[1];
        at[0][i] = (dx * c + dy * s) / e->semi_axis[0];
        at[1][i] = (dy * c - dx * s) / e->semi_axis[1];
    }
}

// Puts the grid about the points, which become places in it.
static void lay_grid(density_map *map, const covariance_ellipse *e, placed *points)
{
    double kernel = pow(points->effective, -1.0 / 6), low[2], step[2];
    for (int k = 0; k < 2; k++) {
        double *at = points->at[k], high = at[0];
        low[k] = at[0];
        for (size_t i = 1; i < points->count; i++) {
            low[k] = fmin(low[k], at[i]);
            high = fmax(high, at[i]);
        }
        low[k] -= MARGIN * kernel;
        step[k] = (high + MARGIN * kernel - low[k]) / LAST;
        for (size_t i = 0; i < points->count; i++)
            at[i] = (at[i] - low[k]) / step[k];
        points->kernel[k] = kernel / step[k];
    }
    double c = cos(e->angle), s = sin(e->angle), a = e->semi_axis[0], b = e->semi_axis[1];
    map->step[0][0] = c * a * step[0];
    map->step[0][1] = s * a * step[0];
    map->step[1][0] = -s * b * step[1];
    map->step[1][1] = c * b * step[1];
    map->origin[0] = e->mean[0] + c * a * low[0] - s * b * low[1];
    map->origin[1] = e->mean[1] + s * a * low[0] + c * b * low[1];
}

// The node below a place, and how far the place is from it to the next.
static int node_below(double at, double *share)
{
    int i = (int)fmin(LAST - 1, fmax(0, floor(at)));
    *share = at - i;
    return i;
}

static void share_out(density_map *map, const placed *points)
{
    memset(map->value, 0, sizeof map->value);
    for (size_t n = 0; n < points->count; n++) {
        double u, v;
        int i = node_below(points->at[0][n], &u), j = node_below(points->at[1][n], &v);
        map->value[i][j] += (1 - u) * (1 - v);
        map->value[i + 1][j] += u * (1 - v);
        map->value[i][j + 1] += (1 - u) * v;
        map->value[i + 1][j + 1] += u * v;
    }
}

// Smooths a line of nodes, `stride` apart, by a kernel of so many nodes.
static void smooth(double *line, size_t stride, double kernel)
{
    double from[DENSITY_GRID], weight[DENSITY_GRID], sum = 0;
    for (int k = 0; k < DENSITY_GRID; k++) {
        from[k] = line[(size_t)k * stride];
        weight[k] = exp(-0.5 * (k / kernel) * (k / kernel));
        sum += k == 0 ? weight[k] : 2 * weight[k];
    }
    for (int i = 0; i < DENSITY_GRID; i++) {
        double smoothed = 0;
        for (int k = 0; k < DENSITY_GRID; k++)
            smoothed += from[k] * weight[abs(i - k)];
        line[(size_t)i * stride] = smoothed / sum;
    }
}

static double value_at(const density_map *map, double a, double b)
{
    double u, v;
    int i = node_below(a, &u), j = node_below(b, &v);
    return (1 - u) * ((1 - v) * map->value[i][j] + v * map->value[i][j + 1]) +
           u * ((1 - v) * map->value[i + 1][j] + v * map->value[i + 1][j + 1]);
}

double density_at(const density_map *map, double x, double y)
{
    const double *a = map->step[0], *b = map->step[1];
    double dx = x - map->origin[0], dy = y - map->origin[1], cell = a[0] * b[1] - a[1] * b[0];
    double i = (dx * b[1] - dy * b[0]) / cell, j = (dy * a[0] - dx * a[1]) / cell;
    bool there = i >= 0 && i <= LAST && j >= 0 && j <= LAST;
    return there ? value_at(map, i, j) : 0;
}

ld_status density_of(const double *x, const double *y, size_t count, double effective,
                     density_map *map)
{
    covariance_ellipse e;
    covariance_ellipse_of(x, y, count, &e);
    double *room = malloc(2 * count * sizeof *room);
    if (!room)
        return LD_ERR_MEMORY;
    placed points = {.at = {room, room + count}, .count = count, .effective = effective};
    turn_to_axes(x, y, count, &e, points.at);
    lay_grid(map, &e, &points);
    share_out(map, &points);
    for (size_t k = 0; k < DENSITY_GRID; k++)
        smooth(map->value[k], 1, points.kernel[1]);
    for (size_t k = 0; k < DENSITY_GRID; k++) // after all rows: columns mix them
        smooth(&map->value[0][k], DENSITY_GRID, points.kernel[0]);
    for (int k = 0; k < DENSITY_GRID; k++)
        map->value[0][k] = map->value[LAST][k] = map->value[k][0] = map->value[k][LAST] = 0;
    for (size_t n = 0; n < count; n++)
        room[n] = value_at(map, points.at[0][n], points.at[1][n]);
    sort_values(room, count);
    for (int k = 0; k < DENSITY_LEVELS; k++)
        map->level[k] = sorted_quantile(room, count, 1 - density_share[k]);
    free(room);
    return LD_OK;
}

// ---- contours

// Of a cell, corner k and side k from there to the next corner, gone round from the first axis of
// the map to the second. A piece of the contour leads from a side that leaves what is denser to the
// next one that comes back to it, and continues in the cell beyond.
static const int corner_at[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
static const int beyond_side[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};

typedef struct contour_walk {
    const density_map *map;
    double level;
    unsigned char gone[DENSITY_GRID][DENSITY_GRID];        // bit k: a line has left by side k
    double corner[2 * DENSITY_GRID * DENSITY_GRID + 1][2]; // of a line, in nodes
} contour_walk;

static double excess_density(const contour_walk *walk, int i, int j, int k)
{
    return walk->map->value[i + corner_at[k][0]][j + corner_at[k][1]] - walk->level;
}

static bool line_leaves(const contour_walk *walk, int i, int j, int k)
{
    return excess_density(walk, i, j, k) > 0 && !(excess_density(walk, i, j, k + 1) > 0);
}

static bool line_returns(const contour_walk *walk, int i, int j, int k)
{
    return !(excess_density(walk, i, j, k) > 0) && excess_density(walk, i, j, k + 1) > 0;
}

// Goes along the line that leaves cell i, j by side k; the number of its corners.
static size_t follow_line(contour_walk *walk, int i, int j, int k)
{
    size_t count = 0;
    for (; !(walk->gone[i][j] & 1 << k); count++) {
        double from = excess_density(walk, i, j, k), to = excess_density(walk, i, j, k + 1);
        const int *a = corner_at[k], *b = corner_at[k + 1];
        walk->gone[i][j] |= (unsigned char)(1 << k);
        walk->corner[count][0] = i + a[0] + from / (from - to) * (b[0] - a[0]);
        walk->corner[count][1] = j + a[1] + from / (from - to) * (b[1] - a[1]);
        do
            k = (k + 1) % 4;
        while (!line_returns(walk, i, j, k));
        i += beyond_side[k][0];
        j += beyond_side[k][1];
        k = (k + 2) % 4;
    }
    return count;
}

ld_status density_contour(const density_map *map, double level, density_sink *take, void *self)
{
    contour_walk *walk = calloc(1, sizeof *walk);
    if (!walk)
        return LD_ERR_MEMORY;
    walk->map = map;
    walk->level = level;
    for (int i = 0; i < LAST; i++)
        for (int j = 0; j < LAST; j++)
            for (int k = 0; k < 4; k++)
                if (line_leaves(walk, i, j, k) && !(walk->gone[i][j] & 1 << k))
                    take(self, walk->corner, follow_line(walk, i, j, k));
    free(walk);
    return LD_OK;
}
