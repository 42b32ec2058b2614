// Clouds of points: Mardia's test of normality against its definition and by how often it refuses;
// contours of density against the ellipse of a normal cloud and by the points that lie within them.
#include "support/check.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "studies/statistics/density.h"
#include "studies/statistics/normality.h"
#include "studies/statistics/statistics.h"

enum { MOST = 20000 };

static double x[MOST], y[MOST];
static int64_t group[MOST];

static double normal(uint64_t stream, uint64_t i, uint64_t j)
{
    return normal_quantile(random_uniform(11, stream, i, j, 0));
}

static double exponential(uint64_t stream, uint64_t i, uint64_t j)
{
    return -log(random_uniform(12, stream, i, j, 0));
}

// Points of cloud `which`, oblong, askew and far from 0; rockets of a group share half of their
// variance.
static void make_cloud(uint64_t which, size_t count, size_t rockets,
                       double (*draw)(uint64_t, uint64_t, uint64_t))
{
    double of_all = rockets > 1 ? sqrt(0.5) : 0, own = sqrt(1 - of_all * of_all);
    for (size_t i = 0; i < count; i++) {
        uint64_t g = i / rockets;
        double u = own * draw(1, which, i) + of_all * draw(2, which, g);
        double v = own * draw(3, which, i) + of_all * draw(4, which, g);
        x[i] = 8000 + 30 * u + 4 * v;
        y[i] = -20 + 9 * u - 3 * v;
        group[i] = (int64_t)g;
    }
}

// b1 = sum over all pairs of (d_i' S^-1 d_j)^3 / n^2, b2 = sum of (d_i' S^-1 d_i)^2 / n.
static void test_definition(void **state)
{
    (void)state;
    enum { COUNT = 60 };
    make_cloud(0, COUNT, 1, exponential);
    double mx = 0, my = 0, xx = 0, xy = 0, yy = 0, b1 = 0, b2 = 0;
    for (int i = 0; i < COUNT; i++) {
        mx += x[i] / COUNT;
        my += y[i] / COUNT;
    }
    for (int i = 0; i < COUNT; i++) {
        xx += (x[i] - mx) * (x[i] - mx) / COUNT;
        xy += (x[i] - mx) * (y[i] - my) / COUNT;
        yy += (y[i] - my) * (y[i] - my) / COUNT;
    }
    double determinant = xx * yy - xy * xy;
    for (int i = 0; i < COUNT; i++)
        for (int j = 0; j < COUNT; j++) {
            double ax = x[i] - mx, ay = y[i] - my, bx = x[j] - mx, by = y[j] - my;
            double product = (yy * ax * bx - xy * (ax * by + ay * bx) + xx * ay * by) / determinant;
            b1 += product * product * product / (COUNT * COUNT);
            b2 += i == j ? product * product / COUNT : 0;
        }
    normality found = normality_of(x, y, group, COUNT);
    CHECK_NEAR("skewness b1", found.skewness, b1, 1e-9 * b1);
    CHECK_NEAR("kurtosis b2", found.kurtosis, b2, 1e-9 * b2);

    // above n b1/6 of chi squared with four degrees of freedom, whose density is x/4 exp(-x/2)
    double from = found.effective * b1 / 6, sum = 0, step = 0.01;
    for (int i = 0; i < 20000; i++) {
        double at = from + (i + 0.5) * step;
        sum += step * at / 4 * exp(-at / 2);
    }
    CHECK_NEAR("p of the skewness", found.chance[0], sum, 1e-5 * sum);
    CHECK_NEAR("p of the kurtosis", found.chance[1],
               2 * normal_cumulative(-fabs(found.kurtosis - 8) / sqrt(64 / found.effective)),
               1e-12);
}

// Refused clouds in a hundred, of `clouds`.
static double refused(int clouds, size_t count, size_t rockets,
                      double (*draw)(uint64_t, uint64_t, uint64_t))
{
    int found = 0;
    for (int k = 0; k < clouds; k++) {
        make_cloud((uint64_t)k, count, rockets, draw);
        normality of = normality_of(x, y, group, count);
        assert_true(of.tested);
        found += !of.normal;
    }
    return 100.0 * found / clouds;
}

static void test_level(void **state)
{
    (void)state;
    CHECK_WITHIN("normal, 100 rockets: refused [%]", refused(2000, 100, 1, normal), 3, 5.5);
    CHECK_WITHIN("normal, 1000 rockets", refused(500, 1000, 1, normal), 2.5, 6);
    CHECK_WITHIN("normal, 40 salvos of 6 that share half", refused(1000, 240, 6, normal), 1, 6);
    CHECK_WITHIN("exponential, 60 rockets", refused(500, 60, 1, exponential), 99, 100);
    CHECK_WITHIN("exponential, 40 salvos of 6", refused(200, 240, 6, exponential), 90, 100);
}

// One normal point each for six rockets that come down at one place: as many points as salvos.
static void test_design_effect(void **state)
{
    (void)state;
    make_cloud(3, 100, 1, normal);
    normality alone = normality_of(x, y, group, 100);
    for (size_t i = 600; i-- > 0;) {
        x[i] = x[i / 6];
        y[i] = y[i / 6];
        group[i] = (int64_t)i / 6;
    }
    normality together = normality_of(x, y, group, 600);
    CHECK_NEAR("the same moments", together.skewness, alone.skewness, 1e-9);
    CHECK_NEAR("points that tell as much", together.effective, 100, 1e-6);
    CHECK_NEAR("alone it is the same", alone.effective, 100, 1e-6);
    assert_false(normality_of(x, y, group, 6 * (NORMALITY_LEAST - 1)).tested);
    for (size_t i = 0; i < 100; i++)
        y[i] = 2 * x[i];
    assert_false(normality_of(x, y, group, 100).tested); // on a line
}

// ---- contours

typedef struct pieces {
    const density_map *map;
    int count, level;
    double least, most; // distance from the middle in deviations of the ellipse
    double piece[4 * DENSITY_GRID * DENSITY_GRID][4]; // in nodes
    covariance_ellipse e;
} pieces;

static void take_piece(pieces *all, const double from[2], const double to[2])
{
    const density_map *m = all->map;
    double dx = m->origin[0] + from[0] * m->step[0][0] + from[1] * m->step[1][0] - all->e.mean[0];
    double dy = m->origin[1] + from[0] * m->step[0][1] + from[1] * m->step[1][1] - all->e.mean[1];
    double c = cos(all->e.angle), s = sin(all->e.angle);
    double r =
        hypot((dx * c + dy * s) / all->e.semi_axis[0], (dy * c - dx * s) / all->e.semi_axis[1]);
    all->least = fmin(all->least, r);
    all->most = fmax(all->most, r);
    double *piece = all->piece[all->count++];
    piece[0] = from[0], piece[1] = from[1], piece[2] = to[0], piece[3] = to[1];
}

static void take(void *self, double (*corner)[2], size_t count)
{
    for (size_t i = 0; i < count; i++)
        take_piece(self, corner[i], corner[(i + 1) % count]);
}

// Points inside: a ray along the first axis meets an odd number of pieces.
static double share_inside(const pieces *all, size_t count)
{
    const density_map *m = all->map;
    double area = m->step[0][0] * m->step[1][1] - m->step[0][1] * m->step[1][0];
    size_t inside = 0;
    for (size_t n = 0; n < count; n++) {
        double dx = x[n] - m->origin[0], dy = y[n] - m->origin[1];
        double a = (dx * m->step[1][1] - dy * m->step[1][0]) / area,
               b = (dy * m->step[0][0] - dx * m->step[0][1]) / area;
        int met = 0;
        for (int k = 0; k < all->count; k++) {
            const double *p = all->piece[k];
            met +=
                (p[1] > b) != (p[3] > b) && p[0] + (b - p[1]) / (p[3] - p[1]) * (p[2] - p[0]) > a;
        }
        inside += (size_t)(met & 1);
    }
    return (double)inside / (double)count;
}

static void contour(pieces *all, const density_map *map, int level, size_t count)
{
    all->map = map;
    all->count = 0;
    all->least = INFINITY;
    all->most = 0;
    covariance_ellipse_of(x, y, count, &all->e);
    assert_int_equal(density_contour(map, map->level[level], take, all), LD_OK);
}

static density_map map;
static pieces found;

static void test_contours_of_a_normal_cloud(void **state)
{
    (void)state;
    make_cloud(5, MOST, 1, normal);
    assert_int_equal(density_of(x, y, MOST, MOST, &map), LD_OK);
    double sum = 0;
    for (int i = 0; i < DENSITY_GRID * DENSITY_GRID; i++)
        sum += map.value[i / DENSITY_GRID][i % DENSITY_GRID];
    CHECK_NEAR("points on the grid", sum, MOST, 0.01 * MOST);
    for (int k = 0; k < DENSITY_LEVELS; k++) {
        double radius = sqrt(-2 * log(1 - density_share[k]));
        contour(&found, &map, k, MOST);
        CHECK_WITHIN("least radius over that of the ellipse", found.least / radius, 0.93, 1);
        CHECK_WITHIN("greatest", found.most / radius, 1, 1.07);
        CHECK_NEAR("points inside", share_inside(&found, 2000), density_share[k], 0.02);
    }
}

// Two clusters: two closed lines each, and the shares inside are kept.
static void test_contours_of_two_clusters(void **state)
{
    (void)state;
    enum { COUNT = 2000 };
    make_cloud(6, COUNT, 1, normal);
    for (int i = 0; i < COUNT; i += 2)
        y[i] += 120;
    assert_false(normality_of(x, y, group, COUNT).normal);
    assert_int_equal(density_of(x, y, COUNT, COUNT, &map), LD_OK);
    for (int k = 0; k < DENSITY_LEVELS; k++) {
        contour(&found, &map, k, COUNT);
        CHECK_NEAR("points inside", share_inside(&found, COUNT), density_share[k], 0.01);
        CHECK_WITHIN("between the clusters nothing is inside", found.least, 0.3, 1);
    }
}

// The kernels by their sum over the points, in the axes in which the cloud has the covariance 1; of
// a cluster at one place beside a band that lies across its axes, too.
static void test_sum_of_kernels(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    for (size_t i = 0; i < COUNT; i++) {
        bool lone = i % 6 == 0;
        double a = normal(31, 0, i), b = normal(32, 0, i);
        x[i] = lone ? -1 : 3 + 2 * a + b;
        y[i] = lone ? 4 : 9 * a - 2 * b;
    }
    covariance_ellipse e;
    covariance_ellipse_of(x, y, COUNT, &e);
    assert_int_equal(density_of(x, y, COUNT, COUNT, &map), LD_OK);
    const double h = pow(COUNT, -1.0 / 6), c = cos(e.angle), s = sin(e.angle);
    const double(*step)[2] = (const double(*)[2])map.step;
    const double cell = fabs(step[0][0] * step[1][1] - step[0][1] * step[1][0]);
    double off = 0, most = 0;
    for (int i = 1; i < DENSITY_GRID - 1; i++)
        for (int j = 1; j < DENSITY_GRID - 1; j++) {
            double at[2], sum = 0;
            for (int k = 0; k < 2; k++)
                at[k] = map.origin[k] + i * step[0][k] + j * step[1][k];
            for (size_t n = 0; n < COUNT; n++) {
                double dx = at[0] - x[n], dy = at[1] - y[n];
                double u = (dx * c + dy * s) / e.semi_axis[0],
                       v = (dy * c - dx * s) / e.semi_axis[1];
                sum += exp(-0.5 * (u * u + v * v) / (h * h));
            }
            sum *= cell / (2 * acos(-1) * h * h * e.semi_axis[0] * e.semi_axis[1]);
            off = fmax(off, fabs(map.value[i][j] - sum));
            most = fmax(most, sum);
        }
    CHECK_BELOW("density on the grid less the sum of kernels, of the largest", off / most, 0.02);
}

// Six rockets that come down where one does alone: the contours of the one.
static void test_contours_of_a_salvo_at_one_place(void **state)
{
    (void)state;
    enum { COUNT = 300, ROCKETS = 6 };
    static density_map alone;
    make_cloud(7, COUNT, 1, normal);
    assert_int_equal(density_of(x, y, COUNT, normality_of(x, y, group, COUNT).effective, &alone),
                     LD_OK);
    for (size_t i = ROCKETS * COUNT; i-- > 0;) {
        x[i] = x[i / ROCKETS];
        y[i] = y[i / ROCKETS];
        group[i] = (int64_t)i / ROCKETS;
    }
    double effective = normality_of(x, y, group, ROCKETS * COUNT).effective, off = 0, most = 0;
    assert_int_equal(density_of(x, y, ROCKETS * COUNT, effective, &map), LD_OK);
    // the deviations of 300 points and of 1800 have other denominators: 0.14 % of the width
    for (int i = 0; i < DENSITY_GRID * DENSITY_GRID; i++) {
        double one = alone.value[i / DENSITY_GRID][i % DENSITY_GRID];
        most = fmax(most, one);
        off = fmax(off, fabs(map.value[i / DENSITY_GRID][i % DENSITY_GRID] / ROCKETS - one));
    }
    CHECK_NEAR("density of a salvo, rocket by rocket, less that of one", off / most, 0, 2e-3);
    for (int k = 0; k < DENSITY_LEVELS; k++)
        CHECK_NEAR("level", map.level[k] / ROCKETS / alone.level[k], 1, 5e-3);
}

// Mean integrated squared error of a density of n points of the standard normal cloud in salvos of
// m that share r of their variance, by Gaussian kernels of width h; all its terms are normal
// densities at their middle, 1 / (2 pi variance).
static double expected_error(double h, double n, double m, double r)
{
    double own = 1 / (2 * h * h), mates = 1 / (2 * h * h + 2 * (1 - r));
    double others = 1 / (2 * h * h + 2), truth = 1 / (2 + h * h);
    return (own / n + (m - 1) / n * mates + (1 - m / n) * others - 2 * truth + 0.5) /
           (2 * acos(-1));
}

// The same of a map, whose axes are those of the cloud.
static double error_of(const density_map *of, size_t count)
{
    double cell = fabs(of->step[0][0] * of->step[1][1] - of->step[0][1] * of->step[1][0]), sum = 0;
    double inside = 0;
    for (int i = 0; i < DENSITY_GRID; i++)
        for (int j = 0; j < DENSITY_GRID; j++) {
            double a = of->origin[0] + i * of->step[0][0] + j * of->step[1][0];
            double b = of->origin[1] + i * of->step[0][1] + j * of->step[1][1];
            double truth = exp(-0.5 * (a * a + b * b)) / (2 * acos(-1));
            double off = of->value[i][j] / ((double)count * cell) - truth;
            sum += off * off * cell;
            inside += truth * truth * cell;
        }
    return sum + 1 / (4 * acos(-1)) - inside; // of what lies beside the grid
}

// Salvos of 12 that share 95 %: with as many points as tell as much the error is near the least
// that any width has; as of independent ones it is half as large again.
static void test_width_for_salvos(void **state)
{
    (void)state;
    enum { CLOUDS = 120, COUNT = 1200, SALVO = 12 };
    const double shared = 0.95;
    double sum[2] = {0}, squares[2] = {0}, width[2] = {0}, least = INFINITY;
    for (int k = 0; k < CLOUDS; k++) {
        for (size_t i = 0; i < COUNT; i++) {
            uint64_t g = i / SALVO, c = (uint64_t)k;
            x[i] = sqrt(1 - shared) * normal(21, c, i) + sqrt(shared) * normal(22, c, g);
            y[i] = sqrt(1 - shared) * normal(23, c, i) + sqrt(shared) * normal(24, c, g);
            group[i] = (int64_t)g;
        }
        const double points[] = {normality_of(x, y, group, COUNT).effective, COUNT};
        for (int way = 0; way < 2; way++) {
            assert_int_equal(density_of(x, y, COUNT, points[way], &map), LD_OK);
            double error = error_of(&map, COUNT);
            sum[way] += error / CLOUDS;
            squares[way] += error * error / CLOUDS;
            width[way] += pow(points[way], -1.0 / 6) / CLOUDS;
        }
    }
    for (double h = 0.2; h < 1.2; h += 0.01)
        least = fmin(least, expected_error(h, COUNT, SALVO, shared));
    double good = expected_error(width[0], COUNT, SALVO, shared);
    double narrow = expected_error(width[1], COUNT, SALVO, shared);
    CHECK_WITHIN("error over the least of any width", good / least, 1, 1.01);
    CHECK_WITHIN("as of independent rockets", narrow / least, 1.4, 1.45);
    double known[2];
    for (int way = 0; way < 2; way++)
        known[way] = sqrt((squares[way] - sum[way] * sum[way]) / (CLOUDS - 1));
    CHECK_NEAR("error found less that expected, over its uncertainty", (sum[0] - good) / known[0],
               0, 2);
    CHECK_NEAR("as of independent rockets", (sum[1] - narrow) / known[1], 0, 2);
    CHECK_BELOW("the uncertainty over the error", known[0] / good, 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definition),
        cmocka_unit_test(test_level),
        cmocka_unit_test(test_design_effect),
        cmocka_unit_test(test_contours_of_a_normal_cloud),
        cmocka_unit_test(test_contours_of_two_clusters),
        cmocka_unit_test(test_sum_of_kernels),
        cmocka_unit_test(test_contours_of_a_salvo_at_one_place),
        cmocka_unit_test(test_width_for_salvos),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
