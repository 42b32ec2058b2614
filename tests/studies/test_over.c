// Points of a sweep taken together: pools of points that are alike against one of them, of other
// weights against closed forms; how often the truth lies inside the intervals of means, deviations,
// shares, differences and ratios; which points are pooled, and what is asked of them.
// link: -lsqlite3
#include "support/study_database.h"
#include "support/study_run.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "studies/points/over_statistic.h"

enum { REPEATS = 600, MOST_ROWS = 4096 };

static double normal(uint64_t key, uint64_t first, uint64_t second)
{
    return normal_quantile(random_uniform(31, key, first, second, 0));
}

// ---- pools of made rows

// Samples of rockets at points, the numbers of all points sampled in common.
typedef struct made_case {
    const char *name;
    int points, groups, rockets;
    double share, common; // of the variance that a sample's rockets share; correlation of points
    int missing;          // of the last point so many samples
    double low, high;     // [%] asked of deviations and ratios
} made_case;

enum { MEANS = 7, RATIO = 2 }; // from point to point; of value and reference

static pooled pool;

// The deviation of point p.
static double spread_at(int p)
{
    return 1 + 0.25 * p;
}

static double made_value(const made_case *made, uint64_t repeat, const pooled_row *row,
                         uint64_t side)
{
    const uint64_t rocket =
        repeat * MOST_ROWS + (uint64_t)(row->group * made->rockets + row->rocket);
    const uint64_t sample = repeat * MOST_ROWS + (uint64_t)row->group;
    const uint64_t own = (uint64_t)row->point * 2 + side + 1;
    const double c = made->common, rest = sqrt(1 - c * c);
    double shared = c * normal(1, sample, 0) + rest * normal(1, sample, own);
    double alone = c * normal(2, rocket, 0) + rest * normal(2, rocket, own);
    return sqrt(made->share) * shared + sqrt(1 - made->share) * alone;
}

static void make_pool(const made_case *made, uint64_t repeat)
{
    static pooled_row rows[MOST_ROWS];
    pooled_begin(&pool, 1);
    pool.row = rows;
    for (int p = 0; p < made->points; p++)
        for (int g = 0; g < made->groups - (p == made->points - 1 ? made->missing : 0); g++)
            for (int r = 0; r < made->rockets; r++) {
                pooled_row *row = &rows[pool.count++];
                *row = (pooled_row){g * made->points + p + 1, g, p, r + 1, {0}};
                row->value[0] = MEANS * p + RATIO * spread_at(p) * made_value(made, repeat, row, 0);
                row->value[POOLED_COLUMNS] = spread_at(p) * made_value(made, repeat, row, 1);
            }
    pool.points = made->points;
    assert_int_equal(pooled_end(&pool), LD_OK);
}

static void free_pool(void)
{
    pool.row = NULL; // those of make_pool()
    pooled_free(&pool);
}

static estimate mean_of_pool(void)
{
    uncertain mean;
    assert_int_equal(pooled_mean(&pool, &mean), LD_OK);
    return interval_of(&mean);
}

static estimate deviation_of_pool(void)
{
    estimate deviation;
    assert_int_equal(pooled_deviation(&pool, &deviation), LD_OK);
    return deviation;
}

static paired_statistics pairs_of_pool(void)
{
    paired_statistics of;
    assert_int_equal(pooled_pairs(&pool, &of), LD_OK);
    return of;
}

static double off(estimate found, estimate expected)
{
    return fmax(fabs(found.value / expected.value - 1),
                fmax(fabs(found.low / expected.low - 1), fabs(found.high / expected.high - 1)));
}

// Of one point what is said of it; copies of it with other means say the same, none the surer.
static void test_alike(void **state)
{
    (void)state;
    const made_case one = {"one", 1, 20, 6, 0.5, 1, 0, 0, 0};
    group_statistics of;
    paired_statistics pairs;
    make_pool(&one, 1);
    double value[120], reference[120];
    for (size_t i = 0; i < pool.count; i++) {
        value[i] = pool.row[i].value[0];
        reference[i] = pool.row[i].value[POOLED_COLUMNS];
    }
    assert_int_equal(statistics_of(value, pool.group, pool.count, &of), LD_OK);
    const paired_values own = {1, {value}, {reference}, pool.sample, pool.group, pool.count};
    assert_int_equal(paired_statistics_of(&own, &pairs), LD_OK);
    estimate mean = mean_of_pool(), deviation = deviation_of_pool(), quantile;
    assert_memory_equal(&mean, &of.mean, sizeof mean);
    assert_memory_equal(&deviation, &of.deviation, sizeof deviation);
    assert_int_equal(pooled_quantile(&pool, 0.95, &quantile), LD_OK);
    assert_memory_equal(&quantile, &of.quantile[2], sizeof quantile);
    const paired_statistics same = pairs_of_pool();
    assert_memory_equal(&same, &pairs, sizeof same);
    pooled_row *row = pool.row;
    for (size_t i = 0, n = pool.count; i < 2 * n; i++) {
        pooled_row *copy = &row[pool.count++];
        *copy = row[i % n];
        copy->point = 1 + (int)(i / n);
        copy->value[0] += 100. * copy->point;
    }
    for (size_t i = 0; i < pool.count; i++)
        row[i].sample = row[i].group * 3 + row[i].point + 1;
    pool.points = 3;
    assert_int_equal(pooled_end(&pool), LD_OK);
    estimate shifted = mean_of_pool(), pooled_spread = deviation_of_pool();
    for (double *end = &shifted.value; end <= &shifted.high; end++)
        *end -= 100;
    CHECK_BELOW("mean of three alike", off(shifted, mean), 1e-12);
    CHECK_BELOW("deviation of three alike", fabs(pooled_spread.value / deviation.value - 1), 1e-12);
    CHECK_BELOW("  its interval", off(pooled_spread, deviation), 1e-12);
    const paired_statistics three = pairs_of_pool();
    CHECK_BELOW("difference of three alike",
                fabs(three.difference.value - 100 - same.difference.value), 1e-11);
    CHECK_BELOW("  half its interval",
                fabs((three.difference.high - three.difference.low) /
                         (same.difference.high - same.difference.low) -
                     1),
                1e-12);
    CHECK_BELOW("ratio of three alike", off(three.spread, same.spread), 1e-12);
    CHECK_BELOW("ratio within samples of three alike", off(three.within, same.within), 1e-12);
    free_pool();
}

// Points count alike, however many samples each has: means and variances by another route.
static void test_weights(void **state)
{
    (void)state;
    const made_case made = {"uneven", 3, 12, 4, 0.4, 0.8, 7, 0, 0};
    double sum[2][3] = {{0}}, square[2][3] = {{0}}, count[3] = {0}, mean[2] = {0},
           variance[2] = {0};
    make_pool(&made, 2);
    for (size_t i = 0; i < pool.count; i++)
        for (int k = 0; k < 2; k++) {
            const pooled_row *row = &pool.row[i];
            double v = row->value[k * POOLED_COLUMNS];
            sum[k][row->point] += v;
            square[k][row->point] += v * v;
            count[row->point] += 0.5;
        }
    for (int k = 0; k < 2; k++)
        for (int p = 0; p < 3; p++) {
            mean[k] += sum[k][p] / count[p] / 3;
            variance[k] += (square[k][p] - sum[k][p] * sum[k][p] / count[p]) / (count[p] - 1) / 3;
        }
    assert_true(count[2] == 20 && count[0] == 48);
    CHECK_BELOW("mean of the points' means", fabs(mean_of_pool().value - mean[0]), 1e-12);
    CHECK_BELOW("root of the mean of their variances",
                fabs(deviation_of_pool().value - sqrt(variance[0])), 1e-12);
    // what each group moves the mean by
    double moved[12] = {0}, squares = 0;
    for (size_t i = 0; i < pool.count; i++) {
        const int p = pool.row[i].point;
        moved[pool.row[i].group] += (pool.row[i].value[0] - sum[0][p] / count[p]) / count[p] / 3;
    }
    for (int g = 0; g < 12; g++)
        squares += moved[g] * moved[g];
    const estimate whole = mean_of_pool();
    CHECK_BELOW("half the interval of the mean [relative]",
                fabs((whole.high - whole.low) / 2 /
                         (student_quantile(0.975, 11) * sqrt(12. / 11 * squares)) -
                     1),
                1e-12);
    const paired_statistics of = pairs_of_pool();
    CHECK_BELOW("difference", fabs(of.difference.value - mean[0] + mean[1]), 1e-12);
    CHECK_BELOW("ratio", fabs(of.spread.value - sqrt(variance[0] / variance[1])), 1e-12);
    assert_int_equal(pooled_groups(&pool), 12);
    free_pool();
}

// ---- how often the truth lies inside

static double inside(estimate e, double truth)
{
    return (e.low <= truth && truth <= e.high) * 100. / REPEATS;
}

// The share of values above 0 at point 0, where every point has that share.
static estimate share_of_pool(void)
{
    uncertain mean;
    for (size_t i = 0; i < pool.count; i++)
        pool.row[i].value[0] = pool.row[i].value[0] - MEANS * pool.row[i].point >
                               RATIO * spread_at(pool.row[i].point) * 1.2815515655446004;
    assert_int_equal(pooled_mean(&pool, &mean), LD_OK);
    return share_interval(&mean, pool.count);
}

static void check_case(const made_case *made)
{
    double mean = 0, deviation = 0, difference = 0, ratio = 0, share = 0, variance = 0, middle = 0;
    for (int p = 0; p < made->points; p++) {
        variance += spread_at(p) * spread_at(p) / made->points;
        middle += 1. * MEANS * p / made->points;
    }
    for (uint64_t repeat = 0; repeat < REPEATS; repeat++) {
        make_pool(made, repeat);
        const paired_statistics of = pairs_of_pool();
        mean += inside(mean_of_pool(), middle);
        deviation += inside(deviation_of_pool(), RATIO * sqrt(variance));
        difference += inside(of.difference, middle);
        ratio += inside(of.spread, RATIO);
        share += inside(share_of_pool(), 0.1);
    }
    printf("  %s\n", made->name);
    CHECK_WITHIN("mean inside [%]", mean, 93, 97);
    CHECK_WITHIN("deviation inside [%]", deviation, made->low, made->high);
    CHECK_WITHIN("difference inside [%]", difference, 93, 97);
    CHECK_WITHIN("ratio of the deviations inside [%]", ratio, made->low, made->high);
    CHECK_WITHIN("share inside [%]", share, 93, 99.5);
}

static void test_coverage(void **state)
{
    (void)state;
    static const made_case made[] = {
        {"4 points of 12 samples of 4, as good as the same numbers", 4, 12, 4, 0.5, 0.99, 0, 92,
         98},
        {"3 of 20 of 3, half in common", 3, 20, 3, 0.3, 0.7, 0, 92.5, 97.5},
        {"5 of 30 of 1, nothing in common", 5, 30, 1, 0, 0, 0, 93, 97.5},
        {"2 of 40 of 2, the second has half of them", 2, 40, 2, 0.5, 0.9, 20, 93, 97.5},
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        check_case(&made[i]);
    free_pool();
}

// Differences of quantiles of pairs, whose values have twice the deviation of their references.
static void test_quantile_differences(void **state)
{
    (void)state;
    static const struct {
        made_case made;
        double level, quantile; // of a normal distribution
    } cases[] = {
        {{"60 of 1, half in common", 1, 60, 1, 0, 0.5, 0, 0, 0}, 0.5, 0},
        {{"100 of 1, as good as the same numbers", 1, 100, 1, 0, 0.99, 0, 0, 0}, 0.5, 0},
        {{"40 of 6, which share half", 1, 40, 6, 0.5, 0.9, 0, 0, 0}, 0.9, 1.2815515655446004},
        {{"120 of 1", 1, 120, 1, 0, 0.9, 0, 0, 0}, 0.95, 1.6448536269514722},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double covered = 0, mean = 0;
        const double truth = (RATIO - 1) * cases[i].quantile;
        for (uint64_t repeat = 0; repeat < REPEATS; repeat++) {
            estimate found;
            make_pool(&cases[i].made, repeat);
            assert_int_equal(pooled_quantile_difference(&pool, cases[i].level, &found), LD_OK);
            covered += inside(found, truth);
            mean += found.value / REPEATS;
        }
        printf("  %s, %g %%\n", cases[i].made.name, 100 * cases[i].level);
        CHECK_BELOW("mean of the differences of quantiles", mean - truth, 0.05);
        CHECK_WITHIN("difference of quantiles inside [%]", covered, 93, 97);
    }
    free_pool();
}

// Against the definition: weights that are differences of the incomplete beta function, here summed
// by the trapezoid rule, over all values in their order; too few have no interval.
static void test_quantile_weights(void **state)
{
    (void)state;
    enum { N = 24, STEPS = 240000 };
    const made_case made = {"made", 1, N, 1, 0, 0.3, 0, 0, 0};
    const double q = 0.7, a = (N + 1) * q, b = (N + 1) * (1 - q);
    double sorted[2][N], sum = 0, expected = 0;
    estimate found, single;
    make_pool(&made, 5);
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < N; i++)
            sorted[side][i] = pool.row[i].value[side * POOLED_COLUMNS];
        sort_values(sorted[side], N);
    }
    for (int k = 0; k < STEPS; k++) {
        double x = (k + 0.5) / STEPS, density = pow(x, a - 1) * pow(1 - x, b - 1);
        int i = (int)(x * N);
        sum += density;
        expected += density * (sorted[0][i] - sorted[1][i]);
    }
    assert_int_equal(pooled_quantile_difference(&pool, q, &found), LD_OK);
    CHECK_BELOW("difference by the density of its weights", found.value - expected / sum, 1e-8);
    assert_true(found.low < found.value && found.value < found.high);
    assert_int_equal(pooled_quantile_difference(&pool, 0.99, &single), LD_OK);
    assert_true(isfinite(single.value) && isnan(single.low) && isnan(single.high));
    // with itself there is none
    for (size_t i = 0; i < pool.count; i++)
        pool.row[i].value[POOLED_COLUMNS] = pool.row[i].value[0] - 3;
    assert_int_equal(pooled_quantile_difference(&pool, q, &found), LD_OK);
    CHECK_BELOW("moved by 3", fmax(fabs(found.low - 3), fabs(found.high - 3)), 1e-12);
    free_pool();
}

// ---- keys and cells

// Six points, two samples each of one rocket; the last point's second sample failed.
#define SWEEP                                                                                      \
    STUDY("1")                                                                                     \
    "CREATE TABLE point (point INTEGER PRIMARY KEY, \"base.speed\" TEXT, \"rocket.lock\" TEXT);"   \
    "INSERT INTO point VALUES (1, '3.6 km/h', 'none'), (2, '3.6 km/h', 'firm'),"                   \
    "  (3, '5 m/s', 'none'), (4, '5 m/s', 'firm'), (5, '0 m/s', 'none'), (6, '0 m/s', 'firm');"    \
    "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT, reason TEXT);"   \
    "CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER, pitch_rate REAL, "         \
    "  PRIMARY KEY (sample, rocket)) WITHOUT ROWID;"                                               \
    "WITH RECURSIVE n(i) AS (SELECT 1 UNION SELECT i + 1 FROM n WHERE i < 12)"                     \
    "  INSERT INTO sample SELECT i, (i - 1) % 6 + 1, CASE i WHEN 12 THEN 'launch' ELSE 'ok' END, " \
    "  NULL FROM n;"                                                                               \
    "INSERT INTO rocket SELECT sample, 1, 1, sample * sample FROM sample WHERE status = 'ok';"

static study_data open_study(const char *name)
{
    study_data data;
    ld_error error;
    if (study_data_open(in(name), &data, &error))
        fail_msg("%s", error.text);
    return data;
}

static over_found find(over *of, int cell, const char *text)
{
    over_found found;
    over_statistic statistic;
    ld_error error;
    const char *nearest;
    assert_int_equal(over_statistic_read(text, &statistic, &error), LD_OK);
    if (over_find(of, cell, &statistic, study_data_find(of->data, "pitch_rate", &nearest), &found,
                  &error))
        fail_msg("%s", error.text);
    return found;
}

// Squares of the samples' numbers, of both locks at each speed.
static void test_cells(void **state)
{
    (void)state;
    static const double mean[] = {(25 + 34) / 2., (45 + 58) / 2., (73 + 36) / 2.};
    study_data data = open_study("six");
    over of;
    ld_error error;
    char text[256];
    assert_int_equal(over_open("base.speed", NULL, &data, &of, &error), LD_OK);
    assert_true(of.key[0].numeric && over_cell_count(&of) == 3);
    assert_string_equal(of.key[0].unit, "km/h");
    CHECK_BELOW("5 m/s [km/h]", fabs(of.key[0].number[1] - 18), 1e-12);
    over_pooled_text(&of, text, sizeof text);
    assert_string_equal(text, "pooled over rocket.lock (2 values)");
    for (int cell = 0; cell < 3; cell++) {
        over_found found = find(&of, cell, "mean");
        assert_true(found.points == 2 && found.groups == 2 && !found.reference);
        CHECK_BELOW("mean of two points", fabs(found.of.value - mean[cell]), 1e-12);
    }
    CHECK_BELOW("deviation of one of them, the other has one value",
                fabs(find(&of, 2, "deviation").of.value - 96 / sqrt(2)), 1e-12);
    CHECK_BELOW("share of two of four", fabs(find(&of, 0, "share:>48000 mrad/s").of.value - 0.5),
                1e-12);
    CHECK_BELOW("share below", fabs(find(&of, 0, "share:<50").of.value - 0.75), 1e-12);
    CHECK_BELOW("median", fabs(find(&of, 0, "quantile:50 %").of.value - (4 + 49) / 2.), 1e-12);
    over_close(&of);
    // by number POINT is its speed, each lock with itself
    assert_int_equal(over_open("base.speed", "6", &data, &of, &error), LD_OK);
    assert_true(find(&of, 2, NULL).reference);
    CHECK_BELOW("difference from point 6's speed, pairs of both locks",
                fabs(find(&of, 0, NULL).of.value - ((25 - 73) + (4 - 36)) / 2.), 1e-12);
    over_reference_text(&of, text, sizeof text);
    assert_string_equal(text, "base.speed 0 m/s");
    over_close(&of);
    assert_int_equal(over_open("rocket.lock,base.speed", NULL, &data, &of, &error), LD_OK);
    assert_true(!of.key[0].numeric && over_cell_count(&of) == 6);
    assert_string_equal(over_text(&of, 4, 0), "firm");
    assert_string_equal(over_text(&of, 4, 1), "5 m/s");
    CHECK_BELOW("one point", fabs(find(&of, 4, "mean").of.value - 58), 1e-12);
    over_pooled_text(&of, text, sizeof text);
    assert_string_equal(text, "");
    over_close(&of);
    study_data_close(&data);
}

static void refuse_keys(const study_data *data, const char *keys, const char *why)
{
    over of;
    ld_error error;
    assert_int_equal(over_open(keys, NULL, data, &of, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, why);
    over_close(&of);
}

static void refuse_statistic(const char *text)
{
    over_statistic statistic;
    ld_error error;
    assert_int_equal(over_statistic_read(text, &statistic, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "expected mean, deviation, quantile:P with P from 0 to 1"));
}

static void refuse_picture(const ld_study_question *question, const char *why)
{
    ld_error error;
    assert_int_equal(ld_study_plot(in("six"), question, in("x.svg"), &error), LD_ERR_INPUT);
    assert_string_equal(error.text, why);
}

static void test_refused(void **state)
{
    (void)state;
    study_data data = open_study("six");
    refuse_keys(&data, "base.sped",
                "--over base.sped: expected a swept key, did you mean "
                "base.speed?; swept are base.speed, rocket.lock");
    refuse_keys(&data, "run.end",
                "--over run.end: expected a swept key; swept are base.speed, rocket.lock");
    refuse_keys(&data, "base.speed,base.speed", "--over base.speed: given twice");
    refuse_keys(&data, "base.speed,rocket.lock,run.end",
                "--over: at most two keys, found \"base.speed,rocket.lock,run.end\"");
    refuse_keys(&data, ",", "--over ,: expected a swept key; swept are base.speed, rocket.lock");
    study_data_close(&data);
    static const char *const wrong[] = {
        "median",  "quantile", "quantile:1",    "quantile:",  "share",
        "share:5", "share:>",  "footprint:0.5", "footprint:", "means"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        refuse_statistic(wrong[i]);
    refuse_picture(&(ld_study_question){.what = "pitch_rat"},
                   "the study has no result \"pitch_rat\"; did you mean \"pitch_rate\"?");
    refuse_picture(&(ld_study_question){.against = "7"},
                   "--against: the study has no point 7; they go from 1 to 6");
    refuse_picture(&(ld_study_question){.statistic = "footprint"},
                   "--statistic footprint: the study has no landing points");
    refuse_picture(&(ld_study_question){.what = "pitch_rate", .statistic = "share:>5 m"},
                   "--statistic share of pitch_rate: found \"5 m\", expected a number in rad/s");
    write_database(
        "single", STUDY("1") ONE_POINT
        "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT, "
        "reason TEXT); CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER,"
        " t_rear REAL, PRIMARY KEY (sample, rocket)) WITHOUT ROWID;");
    data = open_study("single");
    refuse_keys(&data, "base.speed",
                "the study sweeps no key (scenario: sweep): it has one point only");
    study_data_close(&data);
}

static int make_database(void **state)
{
    if (scratch_make(state))
        return -1;
    write_database("six", SWEEP);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_alike),
        cmocka_unit_test(test_weights),
        cmocka_unit_test(test_quantile_differences),
        cmocka_unit_test(test_quantile_weights),
        cmocka_unit_test(test_coverage),
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, make_database, scratch_remove);
}
