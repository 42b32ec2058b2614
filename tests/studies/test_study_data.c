// Reading a study's folder: databases written here by hand, with and without points of a sweep.
// link: -lsqlite3
#include "support/study_database.h"

#include "base/random.h"
#include "studies/plan/draw.h"
#include "studies/statistics/statistics.h"
#include "studies/store/study_data.h"

static study_data open_data(const char *name)
{
    study_data data;
    ld_error error;
    if (study_data_open(in(name), &data, &error))
        fail_msg("%s", error.text);
    return data;
}

static const study_column *column(const study_data *data, const char *name)
{
    const char *nearest;
    const study_column *found = study_data_find(data, name, &nearest);
    assert_non_null(found);
    return found;
}

// Hypercubes of two samples with two rockets; sample 3 failed, one value is not there.
static void test_values(void **state)
{
    (void)state;
    write_database("values", STUDY("2") ONE_POINT
                   "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT,"
                   "  reason TEXT, \"base.elevation\" REAL);"
                   "CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER,"
                   "  \"rocket.mass_error\" REAL, t_rear REAL, exit_speed REAL,"
                   "  PRIMARY KEY (sample, rocket)) WITHOUT ROWID;"
                   "INSERT INTO sample VALUES (4, 1, 'ok', NULL, 0.4), (1, 1, 'ok', NULL, 0.1),"
                   "  (3, 1, 'launch', 'the lock held', 0.3), (2, 1, 'ok', NULL, 0.2);"
                   "INSERT INTO rocket VALUES (4, 2, 8, 42, 1.42, 36), (4, 1, 7, 41, 1.41, 37),"
                   "  (1, 1, 7, 11, 1.11, 38), (1, 2, 8, 12, 1.12, 39),"
                   "  (2, 1, 7, 21, NULL, 40), (2, 2, 8, 22, 1.22, 41),"
                   "  (3, 1, 7, 31, NULL, NULL), (3, 2, 8, 32, NULL, NULL);");
    study_data data = open_data("values");
    assert_true(data.column_count == 4 && data.result_count == 2 && data.swept_count == 0);
    assert_true(data.point_count == 1 && data.strata == 2);
    assert_true(data.point[0].asked == 6 && data.point[0].done == 4 && data.point[0].failed == 1);
    const study_column *speed = column(&data, "exit_speed"), *mass, *elevation;
    assert_true(!speed->factor && speed->per_rocket && strcmp(speed->unit, "m/s") == 0);
    mass = column(&data, "rocket.mass_error");
    elevation = column(&data, "base.elevation");
    assert_true(mass->factor && mass->per_rocket && elevation->factor && !elevation->per_rocket);
    const char *nearest;
    assert_null(study_data_find(&data, "exit_sped", &nearest));
    assert_string_equal(nearest, "exit_speed");

    const study_column *three[] = {mass, column(&data, "t_rear"), elevation};
    study_values values = {0};
    ld_error error;
    assert_int_equal(study_data_read(&data, data.point, &speed, 1, &values, &error), LD_OK);
    assert_int_equal(values.count, 6);
    assert_int_equal(study_data_read(&data, data.point, three, 3, &values, &error), LD_OK);
    assert_int_equal(values.count, 5);
    const int64_t sample[] = {1, 1, 2, 4, 4}, group[] = {0, 0, 0, 1, 1};
    const double of_rocket[] = {11, 12, 22, 41, 42};
    for (int i = 0; i < 5; i++) {
        assert_true(values.sample[i] == sample[i] && values.group[i] == group[i]);
        assert_true(values.rocket[i] == (int)of_rocket[i] % 10);
        assert_true(values.value[0][i] == of_rocket[i]);
        assert_true(fabs(values.value[1][i] - 1 - of_rocket[i] / 100) < 1e-15);
        assert_true(fabs(values.value[2][i] - (double)sample[i] / 10) < 1e-15);
    }
    study_values_free(&values);

    study_failure failure[2];
    int count;
    assert_int_equal(study_data_failures(&data, data.point, failure, 2, &count, &error), LD_OK);
    assert_true(count == 1 && failure[0].count == 1 && failure[0].first == 3);
    assert_string_equal(failure[0].status, "launch");
    assert_string_equal(failure[0].reason, "the lock held");
    study_failed failed[2];
    assert_int_equal(study_data_failed(&data, data.point, failed, 2, &count, &error), LD_OK);
    assert_true(count == 1 && failed[0].sample == 3);
    assert_string_equal(failed[0].status, "launch");
    assert_string_equal(failed[0].reason, "the lock held");
    study_data_close(&data);
}

// Two points of a sweep over a speed and an order of firing.
static void test_points(void **state)
{
    (void)state;
    write_database("points",
                   STUDY("1") //
                   "CREATE TABLE point (point INTEGER PRIMARY KEY, \"base.speed\" TEXT,"
                   "  \"firing.order\" TEXT);"
                   "INSERT INTO point VALUES (2, '15 km/h', '[1, 2]'), (1, '0 km/h', '[2, 1]');"
                   "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT,"
                   "  reason TEXT);"
                   "CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER,"
                   "  t_rear REAL, PRIMARY KEY (sample, rocket)) WITHOUT ROWID;"
                   "INSERT INTO sample VALUES (1, 1, 'ok', NULL), (4, 2, 'ok', NULL),"
                   "  (3, 1, 'input', 'too light'), (6, 2, 'ok', NULL);"
                   "INSERT INTO rocket VALUES (1, 1, 1, 0.1), (4, 1, 1, 0.4), (6, 1, 1, 0.6);");
    study_data data = open_data("points");
    assert_true(data.point_count == 2 && data.swept_count == 2 && data.column_count == 1);
    assert_string_equal(data.swept[1], "firing.order");
    assert_string_equal(data.point[0].text[0], "0 km/h");
    assert_string_equal(data.point[1].text[1], "[1, 2]");
    assert_true(data.point[0].asked == 3 && data.point[0].done == 2 && data.point[0].failed == 1);
    assert_true(data.point[1].done == 2 && data.point[1].failed == 0);
    const study_column *rear = column(&data, "t_rear");
    study_values values = {0};
    ld_error error;
    assert_int_equal(study_data_read(&data, &data.point[1], &rear, 1, &values, &error), LD_OK);
    assert_true(values.count == 2 && values.sample[0] == 4 && values.value[0][1] == 0.6);
    assert_true(values.group[0] == 1 && values.group[1] == 2);
    study_values_free(&values);
    study_failure failure[2];
    int count;
    assert_int_equal(study_data_failures(&data, &data.point[1], failure, 2, &count, &error), LD_OK);
    assert_int_equal(count, 0);
    study_data_close(&data);
}

// Rows of 40 samples with 3 rockets, put in in the order of a permutation.
static void write_permuted(const char *name, uint64_t permutation)
{
    enum { SAMPLES = 40, ROCKETS = 3 };
    char *text = NULL;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    assert_non_null(stream);
    fputs(
        STUDY("1") ONE_POINT
        "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT, reason TEXT);"
        "CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER,"
        "  t_rear REAL, PRIMARY KEY (sample, rocket)) WITHOUT ROWID;",
        stream);
    for (int64_t i = 0; i < SAMPLES * ROCKETS; i++) {
        uint64_t key[] = {permutation, 1};
        int64_t j = draw_permuted(key, 0, 0, SAMPLES * ROCKETS, i), sample = j / ROCKETS + 1;
        double value =
            random_uniform(7, 1, (uint64_t)j, 0, 0) + random_uniform(7, 2, (uint64_t)sample, 0, 0);
        fprintf(stream, "INSERT OR IGNORE INTO sample VALUES (%d, 1, 'ok', NULL);", (int)sample);
        fprintf(stream, "INSERT INTO rocket VALUES (%d, %d, 1, %.17g);", (int)sample,
                (int)(j % ROCKETS) + 1, value);
    }
    assert_int_equal(fclose(stream), 0);
    write_database(name, text);
    free(text);
}

static group_statistics statistics_in(const char *name)
{
    study_data data = open_data(name);
    const study_column *rear = column(&data, "t_rear");
    study_values values = {0};
    group_statistics result;
    ld_error error;
    assert_int_equal(study_data_read(&data, data.point, &rear, 1, &values, &error), LD_OK);
    assert_int_equal(statistics_of(values.value[0], values.group, values.count, &result), LD_OK);
    study_values_free(&values);
    study_data_close(&data);
    return result;
}

// The order in which samples came does not show, to the bit.
static void test_order(void **state)
{
    (void)state;
    write_permuted("first", 1);
    group_statistics first = statistics_in("first");
    assert_true(first.count == 120 && first.groups == 40 && !isnan(first.quantile[1].low));
    for (uint64_t i = 2; i < 5; i++) {
        char name[16];
        snprintf(name, sizeof name, "order-%d", (int)i);
        write_permuted(name, i);
        group_statistics again = statistics_in(name);
        assert_memory_equal(&first, &again, sizeof first);
    }
}

static double half_width(const study_data *data, ld_statistic statistic, bool relative,
                         int64_t last)
{
    double half;
    ld_error error;
    const ld_until rule = {.statistic = statistic, .relative = relative};
    assert_int_equal(
        study_data_half_width(data, column(data, "t_rear"), &rule, last, &half, &error), LD_OK);
    return half;
}

// What stopping rules ask for, against the statistics themselves.
static void test_half_width(void **state)
{
    (void)state;
    group_statistics s = statistics_in("first");
    study_data data = open_data("first");
    double mean = half_width(&data, LD_STATISTIC_MEAN, false, 0);
    CHECK_BELOW("of the mean", mean - 0.5 * (s.mean.high - s.mean.low), 1e-15);
    CHECK_BELOW("relative", half_width(&data, LD_STATISTIC_MEAN, true, 0) - mean / s.mean.value,
                1e-15);
    CHECK_BELOW("of the deviation",
                half_width(&data, LD_STATISTIC_DEVIATION, false, 0) -
                    0.5 * (s.deviation.high - s.deviation.low),
                1e-15);
    // twice the width with some quarter of the samples; none with one
    CHECK_WITHIN("of the first ten samples", half_width(&data, LD_STATISTIC_MEAN, false, 10) / mean,
                 1.5, 3);
    assert_true(isinf(half_width(&data, LD_STATISTIC_MEAN, false, 1)));
    study_data_close(&data);
    // the widest of the points: one has but one sample that went well
    data = open_data("points");
    assert_true(isinf(half_width(&data, LD_STATISTIC_MEAN, false, 0)));
    study_data_close(&data);
}

static void test_refusals(void **state)
{
    (void)state;
    study_data data;
    ld_error error;
    assert_int_equal(study_data_open(in("nothing"), &data, &error), LD_ERR_INPUT);
    study_data_close(&data);
    mkdir(in("empty"), 0777);
    run_sql(in("empty/study.db"), "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT);");
    assert_int_equal(study_data_open(in("empty"), &data, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "contains no study"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),   cmocka_unit_test(test_points),
        cmocka_unit_test(test_order),    cmocka_unit_test(test_half_width),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
