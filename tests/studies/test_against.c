// Points of a study against others: statistics of pairs against closed forms, published numbers and
// by how often the truth lies inside their intervals; which rockets are pairs, and that they drew
// the same numbers; which point is meant; what is shown.
// link: -lsqlite3
#include "support/study_database.h"
#include "support/study_run.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "studies/plan/pairs.h"
#include "studies/points/against.h"

enum { MOST = 200, REPEATS = 1000 };

static double value[2][MOST], reference[2][MOST];
static int64_t number[MOST];

static paired_statistics statistics_of_pairs(int columns, const int64_t *sample,
                                             const int64_t *group, size_t count)
{
    paired_statistics of;
    const paired_values pairs = {.columns = columns,
                                 .value = {value[0], value[1]},
                                 .reference = {reference[0], reference[1]},
                                 .sample = sample,
                                 .group = group,
                                 .count = count};
    assert_int_equal(paired_statistics_of(&pairs, &of), LD_OK);
    return of;
}

static double normal(uint64_t key, uint64_t first, uint64_t second)
{
    return normal_quantile(random_uniform(23, key, first, second, 0));
}

// ---- numbers

// Hours of sleep gained under two drugs by the same ten (Student, Biometrika 6, 1908): R's
// t.test(paired = TRUE) says -1.58 with -2.4598858 to -0.7001142.
static void test_published(void **state)
{
    (void)state;
    static const double drug[2][10] = {{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0, 2},
                                       {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4}};
    memcpy(value[0], drug[0], sizeof drug[0]);
    memcpy(reference[0], drug[1], sizeof drug[1]);
    paired_statistics of = statistics_of_pairs(1, number, number, 10);
    assert_true(of.count == 10 && of.groups == 10);
    CHECK_NEAR("difference of the means", of.difference.value, -1.58, 1e-14);
    CHECK_NEAR("  from", of.difference.low, -2.4598858, 1e-7);
    CHECK_NEAR("  to", of.difference.high, -0.7001142, 1e-7);
    assert_true(isnan(of.within.value));
}

// Samples of three pairs: x, y and what a linear map makes of them.
static int64_t make_pairs(double scale, double shear, double turn)
{
    static int64_t sample[MOST];
    for (uint64_t i = 0; i < 24; i++) {
        double x = 1e3 + 3 * normal(1, i, 0) + 2 * normal(2, i / 3, 0), y = normal(3, i, 0);
        reference[0][i] = x;
        reference[1][i] = y;
        value[0][i] = 7 + scale * x;
        value[1][i] = turn * y + shear * x;
        sample[i] = (int64_t)(i / 3);
    }
    memcpy(number, sample, sizeof sample);
    return 24;
}

// Of a line the ratio is its slope, of a linear map its determinant, whatever is left out.
static void test_closed_forms(void **state)
{
    (void)state;
    int64_t each[MOST];
    for (int i = 0; i < MOST; i++)
        each[i] = i;
    size_t count = (size_t)make_pairs(2.5, 0.3, -0.8);
    paired_statistics of = statistics_of_pairs(1, number, number, count);
    assert_int_equal(of.groups, 8);
    CHECK_BELOW("ratio of the deviations", of.spread.value - 2.5, 1e-13);
    CHECK_BELOW("  its interval", of.spread.high - of.spread.low, 1e-12);
    CHECK_BELOW("ratio within samples", of.within.value - 2.5, 1e-13);
    CHECK_BELOW("  its interval", of.within.high - of.within.low, 1e-12);
    of = statistics_of_pairs(2, number, number, count);
    CHECK_BELOW("ratio of the areas", of.spread.value - 2.5 * 0.8, 1e-12);
    CHECK_BELOW("ratio of the areas within samples", of.within.value - 2.5 * 0.8, 1e-12);
    make_pairs(1, 0, 1);
    of = statistics_of_pairs(1, number, number, count);
    CHECK_BELOW("a shift alone", of.difference.value - 7, 1e-12);
    CHECK_BELOW("  its interval", of.difference.high - of.difference.low, 1e-12);
    // each sample moved for itself: only what is within samples stays
    for (size_t i = 0; i < count; i++)
        value[0][i] += 50 * normal(4, (uint64_t)number[i], 0);
    of = statistics_of_pairs(1, number, number, count);
    CHECK_BELOW("samples moved: ratio within samples", of.within.value - 1, 1e-12);
    CHECK_WITHIN("samples moved: ratio of the deviations", of.spread.value, 3, 100);
    of = statistics_of_pairs(1, each, each, count);
    assert_true(isnan(of.within.value) && of.groups == count);
}

static double log_variance(const double *x, size_t count, int64_t without)
{
    double sum = 0, squares = 0, n = 0;
    for (size_t i = 0; i < count; i++)
        if (number[i] != without) {
            sum += x[i];
            n++;
        }
    for (size_t i = 0; i < count; i++)
        if (number[i] != without)
            squares += pow(x[i] - sum / n, 2);
    return log(squares / (n - 1));
}

// The interval of the ratio, each group left out by recomputing from the values that stay.
static void test_jackknife(void **state)
{
    (void)state;
    enum { GROUPS = 8 };
    size_t count = (size_t)make_pairs(1, 0, 1);
    for (size_t i = 0; i < count; i++)
        value[0][i] += 2 * normal(5, i, 0);
    double of_ratio[GROUPS], mean = 0, squares = 0;
    for (int g = 0; g < GROUPS; g++) {
        of_ratio[g] =
            log_variance(value[0], count, g) / 2 - log_variance(reference[0], count, g) / 2;
        mean += of_ratio[g] / GROUPS;
    }
    for (int g = 0; g < GROUPS; g++)
        squares += pow(of_ratio[g] - mean, 2);
    double half = student_quantile(0.975, GROUPS - 1) * sqrt((GROUPS - 1.) / GROUPS * squares);
    double all = log_variance(value[0], count, -1) / 2 - log_variance(reference[0], count, -1) / 2;
    paired_statistics of = statistics_of_pairs(1, number, number, count);
    CHECK_BELOW("ratio of the deviations", of.spread.value / exp(all) - 1, 1e-12);
    CHECK_BELOW("  from", of.spread.low / exp(all - half) - 1, 1e-11);
    CHECK_BELOW("  to", of.spread.high / exp(all + half) - 1, 1e-11);
}

// No interval of one group, none of a ratio of two; nothing of one pair or of values all alike.
static void test_too_few(void **state)
{
    (void)state;
    static const int64_t one[MOST] = {0}, pair[4] = {0, 0, 1, 1};
    make_pairs(2, 0, 1);
    paired_statistics of = statistics_of_pairs(1, one, one, 4);
    assert_true(of.groups == 1 && !isnan(of.difference.value) && isnan(of.difference.low));
    assert_true(fabs(of.spread.value - 2) < 1e-12 && isnan(of.spread.low));
    of = statistics_of_pairs(1, pair, pair, 4);
    assert_true(of.groups == 2 && !isnan(of.difference.low) && isnan(of.spread.low));
    of = statistics_of_pairs(1, one, one, 1);
    assert_true(of.groups == 0 && isnan(of.spread.value));
    of = statistics_of_pairs(1, one, one, 0);
    assert_true(of.groups == 0 && isnan(of.difference.value));
    for (int i = 0; i < 4; i++)
        reference[0][i] = 5;
    of = statistics_of_pairs(1, pair, pair, 4);
    assert_true(isnan(of.spread.value) && isnan(of.within.value));
}

// ---- how often the truth lies inside

typedef struct made_case {
    const char *name;
    int groups, rockets;
    double share, correlated, ratio; // of the variance that a sample's rockets share; of value and
                                     // reference; of their deviations
    double low, high;                // [%] asked of the ratios
} made_case;

// Normal values; value and reference share `correlated` of what they are.
static double made_value(const made_case *made, uint64_t key, uint64_t repeat, uint64_t i, int side)
{
    uint64_t sample = i / (uint64_t)made->rockets,
             at[2] = {repeat * MOST + sample, repeat * MOST + i};
    double both[2], own[2];
    for (uint64_t k = 0; k < 2; k++) {
        both[k] = normal(key + k, at[k], 0);
        own[k] = side ? normal(key + k, at[k], 1) : both[k];
    }
    double c = made->correlated, rest = sqrt(1 - c * c);
    double shared = side ? c * both[0] + rest * own[0] : both[0];
    double alone = side ? c * both[1] + rest * own[1] : both[1];
    return sqrt(made->share) * shared + sqrt(1 - made->share) * alone;
}

static double inside(estimate e, double truth)
{
    return e.low <= truth && truth <= e.high;
}

static void check_case(const made_case *made)
{
    size_t count = (size_t)(made->groups * made->rockets);
    double difference = 0, spread = 0, within = 0, area = 0, area_within = 0;
    for (uint64_t repeat = 0; repeat < REPEATS; repeat++) {
        for (uint64_t i = 0; i < count; i++) {
            for (uint64_t c = 0; c < 2; c++) {
                reference[c][i] = made_value(made, 10 + 2 * c, repeat, i, 0);
                value[c][i] = 0.3 + made->ratio * made_value(made, 10 + 2 * c, repeat, i, 1);
            }
            number[i] = (int64_t)i / made->rockets;
        }
        paired_statistics of = statistics_of_pairs(1, number, number, count);
        difference += inside(of.difference, 0.3) * 100. / REPEATS;
        spread += inside(of.spread, made->ratio) * 100. / REPEATS;
        within += inside(of.within, made->ratio) * 100. / REPEATS;
        of = statistics_of_pairs(2, number, number, count);
        area += inside(of.spread, made->ratio * made->ratio) * 100. / REPEATS;
        area_within += inside(of.within, made->ratio * made->ratio) * 100. / REPEATS;
    }
    printf("  %s\n", made->name);
    CHECK_WITHIN("difference inside [%]", difference, 93, 97);
    CHECK_WITHIN("ratio of the deviations inside [%]", spread, made->low, made->high);
    CHECK_WITHIN("ratio of the areas inside [%]", area, made->low, made->high);
    if (made->rockets > 1) {
        CHECK_WITHIN("ratio within samples inside [%]", within, made->low, made->high);
        CHECK_WITHIN("areas within samples inside [%]", area_within, made->low, made->high);
    }
}

static void test_coverage(void **state)
{
    (void)state;
    static const made_case made[] = {
        {"8 samples of 8 that share little", 8, 8, 0.1, 0.9, 1, 92, 98},
        {"8 of 8 that share 80 %", 8, 8, 0.8, 0.9, 1, 92, 98},
        {"20 of 6 that share half, one twice the other", 20, 6, 0.5, 0.5, 2, 93, 97},
        {"20 of 1", 20, 1, 0, 0.9, 1, 93, 97},
        {"60 of 1, one 1.5 times the other", 60, 1, 0, 0.99, 1.5, 93, 97},
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        check_case(&made[i]);
}

// ---- pairs

// Four points of a sweep, two draws at each, two rockets; sample 3 failed, of sample 5 the second
// rocket did not leave.
#define SWEEP                                                                                      \
    STUDY("1")                                                                                     \
    "CREATE TABLE point (point INTEGER PRIMARY KEY, \"base.speed\" TEXT, \"firing.order\" TEXT);"  \
    "INSERT INTO point VALUES (1, '0 km/h', '[1, 2]'), (2, '0 km/h', '[2, 1]'),"                   \
    "  (3, '15 km/h', '[1, 2]'), (4, '15 km/h', '[2, 1]');"                                        \
    "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT, reason TEXT);"   \
    "CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER, downrange REAL, "          \
    "  drift REAL, PRIMARY KEY (sample, rocket)) WITHOUT ROWID;"                                   \
    "INSERT INTO sample VALUES (1, 1, 'ok', NULL), (2, 2, 'ok', NULL), (3, 3, 'launch', 'stuck')," \
    "  (4, 4, 'ok', NULL), (5, 1, 'ok', NULL), (6, 2, 'ok', NULL), (7, 3, 'ok', NULL),"            \
    "  (8, 4, 'ok', NULL);"                                                                        \
    "INSERT INTO rocket VALUES (1, 1, 1, 10, 1), (1, 2, 2, 20, 2), (2, 1, 2, 11, 1),"              \
    "  (2, 2, 1, 22, 4), (3, 1, 1, 50, 5), (3, 2, 2, 50, 5), (4, 1, 2, 13, 1), (4, 2, 1, 23, 2),"  \
    "  (5, 1, 1, 30, 3), (5, 2, 2, NULL, NULL), (6, 1, 2, 33, 3), (6, 2, 1, 44, 4),"               \
    "  (7, 1, 1, 31, 3), (7, 2, 2, 41, 5), (8, 1, 2, 35, 4), (8, 2, 1, 45, 6);"

static int make_database(void **state)
{
    if (scratch_make(state))
        return -1;
    write_database("made", SWEEP);
    return 0;
}

static study_data open_study(const char *name)
{
    study_data data;
    ld_error error;
    if (study_data_open(in(name), &data, &error))
        fail_msg("%s", error.text);
    return data;
}

// The same sample and rocket at both points, where both have the result.
static void test_pairs(void **state)
{
    (void)state;
    study_data data = open_study("made");
    study_values values[2] = {0};
    paired_values pairs;
    ld_error error;
    const char *nearest;
    const study_column *column = study_data_find(&data, "downrange", &nearest);
    assert_int_equal(against_read_pairs(&(paired_points){&data, &data.point[1], &data.point[0]},
                                        &column, 1, values, &pairs, &error),
                     LD_OK);
    assert_int_equal(pairs.count, 3);
    static const double expected[2][3] = {{11, 22, 33}, {10, 20, 30}};
    assert_memory_equal(pairs.value[0], expected[0], sizeof expected[0]);
    assert_memory_equal(pairs.reference[0], expected[1], sizeof expected[1]);
    assert_true(pairs.sample[0] == pairs.sample[1] && pairs.sample[1] != pairs.sample[2]);
    assert_int_equal(against_read_pairs(&(paired_points){&data, &data.point[2], &data.point[1]},
                                        &column, 1, values, &pairs, &error),
                     LD_OK);
    assert_true(pairs.count == 2 && pairs.value[0][1] == 41 && pairs.reference[0][1] == 44);
    for (int k = 0; k < 2; k++)
        study_values_free(&values[k]);
    study_data_close(&data);
}

// The same random numbers at both points for each pair, also where one fires more rockets and in
// another order, and of a factor whose nominal value is swept; results are none the less others.
static void test_common_numbers(void **state)
{
    (void)state;
    static const char text[] =
        "include: fixed.yaml\nfiring: {order: [1, 2], interval: 0.3 s}\n"
        "sweep:\n  rocket.mass: [60 kg, 61 kg]\n  firing.order: [[1, 2], [9, 2, 1]]\n"
        "scatter:\n  samples: 3\n  factors:\n    rocket.mass_error: {normal: 0.2 kg}\n"
        "    rocket.motor.thrust_scale: {normal: 1 %}\n    base.elevation: {normal: 1 deg}\n";
    ld_study *study = study_of(text);
    study_run(study, "common", 1);
    ld_study_free(study);
    study_data data = open_study("common");
    study_values values[2] = {0};
    paired_values pairs;
    ld_error error;
    const char *nearest;
    for (int i = data.result_count; i < data.column_count; i++) {
        const study_column *column = &data.column[i];
        for (int p = 1; p < 4; p++) {
            against_read_pairs(&(paired_points){&data, &data.point[p], &data.point[0]}, &column, 1,
                               values, &pairs, &error);
            assert_int_equal(pairs.count, 6);
            assert_memory_equal(pairs.value[0], pairs.reference[0], 6 * sizeof(double));
            assert_true(pairs.value[0][0] != pairs.value[0][5]);
        }
    }
    const study_column *speed = study_data_find(&data, "exit_speed", &nearest);
    against_read_pairs(&(paired_points){&data, &data.point[2], &data.point[0]}, &speed, 1, values,
                       &pairs, &error);
    for (int i = 0; i < 6; i++)
        assert_true(pairs.value[0][i] < pairs.reference[0][i]); // the heavier ones
    for (int k = 0; k < 2; k++)
        study_values_free(&values[k]);
    study_data_close(&data);
}

// ---- which point is meant

static void expect_references(const study_data *data, const char *text, const int expected[4])
{
    against of;
    ld_error error;
    if (against_read(text, data, &of, &error))
        fail_msg("%s", error.text);
    for (int i = 0; i < 4; i++)
        assert_int_equal(against_reference(&of, &data->point[i])->number, expected[i]);
    against_free(&of);
}

static void refuse(const study_data *data, const char *text, const char *why)
{
    against of;
    ld_error error;
    assert_int_equal(against_read(text, data, &of, &error), LD_ERR_INPUT);
    if (strcmp(error.text, why) != 0)
        fail_msg("\"%s\"\n    expected \"%s\"", error.text, why);
    assert_true(!of.value && !of.data);
}

static void test_points(void **state)
{
    (void)state;
    study_data data = open_study("made");
    expect_references(&data, "3", (int[]){3, 3, 3, 3});
    expect_references(&data, "base.speed=0 km/h", (int[]){1, 2, 1, 2});
    expect_references(&data, " firing.order = [2,1] ", (int[]){2, 2, 4, 4});
    expect_references(&data, "firing.order=[2, 1],base.speed=15km/h", (int[]){4, 4, 4, 4});
    refuse(&data, "5", "--against: the study has no point 5; they go from 1 to 4");
    refuse(&data, "99999999999999999999",
           "--against: the study has no point 99999999999999999999; they go from 1 to 4");
    refuse(&data, "base.sped=0 km/h",
           "--against base.sped: the study does not sweep it; did you mean \"base.speed\"?");
    refuse(&data, "base.speed=16 km/h",
           "--against base.speed: no point of the study has \"16 km/h\" there; did you mean \"15 "
           "km/h\"?");
    refuse(&data, "base.speed=0 km/h,base.speed=15 km/h", "--against base.speed: given twice");
    refuse(&data, "base.speed=0 km/h, fast",
           "--against: found \"fast\"; expected the number of a point, from 1 to 4, or KEY=VALUE "
           "of a swept key, such as \"base.speed=0 km/h\"");
    study_data_close(&data);
    write_database(
        "single", STUDY("1") ONE_POINT
        "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT, "
        "reason TEXT); CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER,"
        " t_rear REAL, PRIMARY KEY (sample, rocket)) WITHOUT ROWID;");
    data = open_study("single");
    refuse(&data, "1", "--against compares points of a sweep; this study has one point only");
    study_data_close(&data);
}

// ---- what is shown

static char *read_whole(const char *path)
{
    char *text = calloc(1, 1 << 16);
    FILE *stream = fopen(path, "r");
    assert_true(text && stream);
    assert_true(fread(text, 1, (1 << 16) - 1, stream) > 0);
    fclose(stream);
    return text;
}

static char *shown(const char *name, const ld_study_view *view, ld_status expected, ld_error *error)
{
    static char *text;
    static size_t length;
    FILE *stream = open_memstream(&text, &length);
    assert_int_equal(ld_study_show(in(name), view, stream, error), expected);
    fclose(stream);
    return text;
}

// By hand: downranges of 13, 23, 35, 45 m against 11, 22, 33, 44 m, two rockets a sample; as shown
// and in the table, each behind what leads to it.
static void check_ratios(const char *text, const char *before, const char *format, double bound)
{
    const double expected[2] = {sqrt(584. / 605), 10. / 11};
    double ratio[2];
    size_t at = strcspn(text, "\n");
    while (text[at] && strncmp(text + at, before, strlen(before)) != 0)
        at++;
    assert_int_equal(sscanf(text + at, format, &ratio[0], &ratio[1]), 2);
    CHECK_BELOW("ratio", fabs(ratio[0] - expected[0]), bound);
    CHECK_BELOW("  within samples", fabs(ratio[1] - expected[1]), bound);
}

// Over the key that is named, the other one pooled: each point counts alike, however many pairs it
// has; deviations are those of the points that have two.
static void check_pooled_text(const char *text)
{
    double difference = 0, ratio = 0;
    printf("%s", text);
    assert_non_null(strstr(text, "pooled over firing.order (2 values);"));
    assert_non_null(strstr(text, "differences from base.speed 0 km/h;"));
    const char *row = strstr(text, "\n15 km/h ");
    assert_true(row && sscanf(row, " 15 km/h %lf [%*f, %*f] %lf", &difference, &ratio) == 2);
    CHECK_BELOW("pooled difference", fabs(difference - (1 + 1.5) / 2), 5e-4);
    CHECK_BELOW("pooled ratio", fabs(ratio - sqrt(584. / 605)), 5e-5);
}

static void check_pooled(void)
{
    ld_error error;
    ld_study_view view = {.against = "base.speed=0 km/h", .what = "downrange"};
    char *text = shown("made", &view, LD_OK, &error);
    check_pooled_text(text);
    free(text);
}

static void test_shown(void **state)
{
    (void)state;
    ld_error error;
    ld_study_view view = {
        .against = "base.speed=0 km/h", .over = "base.speed,firing.order", .csv = in("rows.csv")};
    char *text = shown("made", &view, LD_OK, &error);
    printf("%s", text);
    assert_non_null(strstr(text, "8 samples at 4 points, 1 failed; 95 % intervals"));
    assert_non_null(strstr(text, "differences from base.speed 0 km/h;"));
    // of point 3 only a rocket of sample 7 has its pair
    assert_non_null(strstr(text, "\n15 km/h     [1, 2]         less than two pairs of rockets\n"));
    assert_non_null(strstr(text, "\n15 km/h     [2, 1]         1.5 [1.5, 1.5] "));
    assert_non_null(strstr(text, "\ndownrange and drift: areas of their ellipses\n"));
    check_ratios(text, "\n15 km/h     [2, 1] ", " 15 km/h [2, 1] %*f [%*f, %*f] %lf %lf", 5e-5);
    free(text);
    text = read_whole(in("rows.csv"));
    check_ratios(text, "\n15 km/h,\"[2, 1]\",downrange,",
                 " 15 km/h,\"[2, 1]\",downrange,m,1,4,2,%*f,%*f,%*f,%lf,,,%lf,,", 1e-15);
    assert_non_null(strstr(text, "\n15 km/h,\"[1, 2]\",downrange,m,1,1,1,,,,,,,,,\n"));
    assert_non_null(strstr(text, "\n15 km/h,\"[2, 1]\",downrange and drift,m,1,4,2,,,,"));
    free(text);
    view = (ld_study_view){.against = "base.speed=0 km/h", .csv = in("made.csv")};
    free(shown("made", &view, LD_OK, &error));
    text = read_whole(in("made.csv"));
    check_ratios(text, "\n4,15 km/h,\"[2, 1]\",2,downrange,",
                 " 4,15 km/h,\"[2, 1]\",2,downrange,m,4,2,%*f,%*f,%*f,%lf,,,%lf,,", 1e-15);
    static const char header[] =
        "point,base.speed,firing.order,reference,result,unit,pairs,groups,difference,"
        "difference_low,difference_high,ratio,ratio_low,ratio_high,ratio_within,ratio_within_low,"
        "ratio_within_high\n4,15 km/h,\"[2, 1]\",2,downrange,m,4,2,1.5,";
    assert_memory_equal(text, header, sizeof header - 1);
    double mean = 0, low = 0, high = 0; // drifts of 1, 2, 4, 6 m against 1, 4, 3, 4 m
    const char *drift = strstr(text, "\n4,15 km/h,\"[2, 1]\",2,drift,m,4,2,");
    assert_true(drift && sscanf(drift, " 4,15 km/h,\"[2, 1]\",2,drift,m,4,2,%lf,%lf,%lf,", &mean,
                                &low, &high) == 3);
    assert_true(mean == 0.25 && low < mean && mean < high);
    assert_non_null(strstr(text, "\n4,15 km/h,\"[2, 1]\",2,downrange and drift,m,4,2,,,,"));
    free(text);
    check_pooled();
    view = (ld_study_view){.against = "3", .what = "drift"};
    free(shown("made", &view, LD_OK, &error));
    run_sql(in("made/study.db"), "UPDATE sample SET status = 'launch' WHERE sample > 2;");
    seal_study(in("made/study.db"));
    free(shown("made", &view, LD_ERR_INPUT, &error));
    assert_string_equal(error.text,
                        "--against: no point has two pairs of rockets with the one that "
                        "it is compared with");
}

int main(void)
{
    for (int i = 0; i < MOST; i++)
        number[i] = i;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_published),      cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_jackknife),      cmocka_unit_test(test_too_few),
        cmocka_unit_test(test_coverage),       cmocka_unit_test(test_pairs),
        cmocka_unit_test(test_common_numbers), cmocka_unit_test(test_points),
        cmocka_unit_test(test_shown),
    };
    return cmocka_run_group_tests(tests, make_database, scratch_remove);
}
