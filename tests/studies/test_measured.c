// Measured launches beside a study: the test of agreement against published and independent numbers
// and by how often it is wrong, the file with what may be wrong in it, and the table.
#include "support/study_run.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "studies/show/measured.h"
#include "studies/statistics/agreement.h"

// ---- the test of agreement

// Hours of sleep gained under two drugs (Student, Biometrika 6, 1908). Of single values Welch's
// test is R's t.test(extra ~ group, data = sleep): df = 17.776, p = 0.07939, -3.3654832 to
// 0.2054832. The other numbers, to all their digits, are SciPy's distributions over sums by NumPy.
static const double drug[2][10] = {{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0, 2},
                                   {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4}};

static agreement agreement_in(const int64_t *first, const int64_t *second)
{
    agreement by;
    assert_int_equal(agreement_of((grouped_values){drug[0], first, 10},
                                  (grouped_values){drug[1], second, 10}, &by),
                     LD_OK);
    return by;
}

static void check_estimate(const char *what, estimate e, double value, double low, double high)
{
    printf("%s\n", what);
    CHECK_NEAR("  value", e.value, value, 1e-13);
    CHECK_NEAR("  low", e.low, low, 1e-12);
    CHECK_NEAR("  high", e.high, high, 1e-12);
}

static void test_published(void **state)
{
    (void)state;
    static const int64_t each[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    static const int64_t four[] = {1, 1, 1, 2, 2, 2, 2, 3, 3, 4},
                         three[] = {1, 1, 2, 2, 2, 3, 3, 3, 3, 3};
    agreement by = agreement_in(each, each);
    check_estimate("single values, means", by.mean, -1.58, -3.365483230711636, 0.2054832307116363);
    CHECK_NEAR("  p", by.mean_chance, 0.0793941401873582, 1e-13);
    check_estimate("single values, deviations", by.deviation, 0.8404907975460123,
                   0.4022911600954896, 1.756003737670626);
    CHECK_NEAR("  p", by.deviation_chance, 0.6259750229730541, 1e-13);
    by = agreement_in(four, three);
    check_estimate("groups, means", by.mean, -1.58, -6.052264851188617, 2.892264851188618);
    CHECK_NEAR("  p", by.mean_chance, 0.3287780341204825, 1e-13);
    check_estimate("groups, deviations", by.deviation, 0.8404907975460123, 0.2853053614897718,
                   2.476030513660211);
    CHECK_NEAR("  p", by.deviation_chance, 0.6960300559458137, 1e-13);
}

// One group reports no interval, two none of the deviation, equal values neither; nor do no values.
static void test_too_few(void **state)
{
    (void)state;
    static const int64_t one[10] = {0}, two[] = {1, 1, 1, 1, 1, 2, 2, 2, 2, 2},
                         each[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    static const double same[10] = {0};
    agreement by = agreement_in(one, each);
    assert_true(fabs(by.mean.value + 1.58) < 1e-12 && isnan(by.mean.low) && isnan(by.mean_chance));
    assert_true(isnan(by.deviation.value) && isnan(by.deviation_chance));
    by = agreement_in(each, two);
    assert_true(!isnan(by.mean.low) && !isnan(by.mean_chance) && isnan(by.deviation_chance));
    agreement_of((grouped_values){same, each, 10}, (grouped_values){same, each, 10}, &by);
    assert_true(by.mean.value == 0 && isnan(by.mean_chance) && isnan(by.deviation_chance));
    agreement_of((grouped_values){NULL, NULL, 0}, (grouped_values){drug[0], each, 10}, &by);
    assert_true(isnan(by.mean.value) && isnan(by.mean_chance) && isnan(by.deviation_chance));
}

// ---- how often it is wrong

enum { REPEATS = 1000, MOST = 200 };

typedef struct made_case {
    const char *name;
    int groups[2], of[2];         // of the two sides, and values in each
    double share;                 // of the variance, which a group shares
    double apart, ratio;          // what the first differs by: of the mean, of the deviation
    double mean[2], deviation[2]; // p < 0.05 in so many % of the repeats
} made_case;

static double made_normal(int repeat, int side, int group, int value)
{
    uint64_t key = 2 * (uint64_t)repeat + (uint64_t)side;
    return normal_quantile(random_uniform(5, key, (uint64_t)group, (uint64_t)value, 0));
}

static grouped_values made_values(const made_case *made, int repeat, int side, double *value,
                                  int64_t *group)
{
    size_t count = 0;
    double own = sqrt(1 - made->share), shared = sqrt(made->share);
    for (int g = 0; g < made->groups[side]; g++)
        for (int i = 1; i <= made->of[side]; i++) {
            double x =
                shared * made_normal(repeat, side, g, 0) + own * made_normal(repeat, side, g, i);
            group[count] = g;
            value[count++] = side ? x : made->apart + made->ratio * x;
        }
    return (grouped_values){value, group, count};
}

static void test_how_often(void **state)
{
    (void)state;
    static const made_case made[] = {
        {"20 launches, 60 rockets, alike", {20, 60}, {1, 1}, 0, 0, 1, {3, 7}, {3, 7}},
        {"54 launches, 10 of 18, alike", {54, 10}, {1, 18}, 0, 0, 1, {3, 7}, {3, 7}},
        {"5 of 18, 10 of 18 that share a third, alike",
         {5, 10},
         {18, 18},
         0.3,
         0,
         1,
         {3, 7},
         {3, 9}},
        {"54 launches, 10 of 18, half a deviation apart",
         {54, 10},
         {1, 18},
         0,
         0.5,
         1,
         {83, 95},
         {3, 7}},
        {"54 launches, 10 of 18, half as much again",
         {54, 10},
         {1, 18},
         0,
         0,
         1.5,
         {3, 7},
         {83, 95}},
    };
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) {
        static double value[2][MOST];
        static int64_t group[2][MOST];
        int mean = 0, deviation = 0;
        for (int repeat = 0; repeat < REPEATS; repeat++) {
            agreement by;
            assert_int_equal(agreement_of(made_values(&made[k], repeat, 0, value[0], group[0]),
                                          made_values(&made[k], repeat, 1, value[1], group[1]),
                                          &by),
                             LD_OK);
            mean += by.mean_chance < 0.05;
            deviation += by.deviation_chance < 0.05;
            assert_true((by.mean_chance < 0.05) == (by.mean.low > 0 || by.mean.high < 0));
            assert_true((by.deviation_chance < 0.05) ==
                        (by.deviation.low > 1 || by.deviation.high < 1));
        }
        printf("%s\n", made[k].name);
        CHECK_WITHIN("  means said to differ [%]", mean * 100. / REPEATS, made[k].mean[0],
                     made[k].mean[1]);
        CHECK_WITHIN("  deviations said to differ [%]", deviation * 100. / REPEATS,
                     made[k].deviation[0], made[k].deviation[1]);
    }
}

// ---- the file

static const char study_text[] =
    "include: fixed.yaml\nscatter:\n  seed: 3\n  samples: 12\n  factors:\n"
    "    rocket.mass_error: {normal: 0.2 kg}\n    rocket.motor.thrust_scale: {normal: 1 %}\n";

static study_data data;

static int make_study(void **state)
{
    ld_error error;
    if (scratch_make(state))
        return -1;
    ld_study *study = study_of(study_text);
    study_run(study, "study", 1);
    ld_study_free(study);
    return study_data_open(in("study"), &data, &error) != LD_OK;
}

static int end_study(void **state)
{
    study_data_close(&data);
    return scratch_remove(state);
}

static const char *shots_file(const char *text, size_t length)
{
    static char name[200];
    snprintf(name, sizeof name, "%s", in("launches.csv"));
    FILE *stream = fopen(name, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(text, 1, length, stream), length);
    fclose(stream);
    return name;
}

static void test_file(void **state)
{
    (void)state;
    static const char text[] = "\xef\xbb\xbf# measured by hand\r\n"
                               "t_rear [ms] , salvo,exit_speed [km/h],pitch [deg]\r\n"
                               "160.5,2,137,\r\n\r\n"
                               "161,1,,\r\n"
                               "# the third was not timed\n"
                               ",1,136.8,19.5\n"
                               "1.625e2,2,137.16,19";
    measured launches;
    ld_error error;
    ld_status status = measured_read(shots_file(text, sizeof text - 1), &data, &launches, &error);
    if (status)
        fail_msg("%s", error.text);
    assert_true(launches.count == 4 && launches.salvos == 2 && launches.results == 3);
    const measured_result *time = &launches.result[0], *speed = &launches.result[1];
    assert_string_equal(time->name, "t_rear");
    assert_string_equal(time->unit, "ms");
    assert_true(time->count == 3 && time->value[0] == 0.161 && time->value[1] == 0.1605 &&
                time->value[2] == 0.1625);
    assert_true(time->group[0] == 1 && time->group[1] == 2 && time->group[2] == 2);
    assert_true(speed->count == 3 && fabs(speed->value[0] - 38) < 1e-14);
    assert_true(launches.result[2].count == 2);
    measured_free(&launches);
    // without salvos every launch stands for itself
    static const char plain[] = "exit_speed [m/s]\n38\n37.9\n";
    assert_int_equal(measured_read(shots_file(plain, sizeof plain - 1), &data, &launches, &error),
                     LD_OK);
    assert_true(launches.salvos == 0 && launches.result[0].group[0] != launches.result[0].group[1]);
    measured_free(&launches);
}

static void refuse(const char *text, const char *where, const char *why)
{
    measured launches;
    ld_error error;
    const char *file = shots_file(text, strlen(text));
    char expected[512];
    snprintf(expected, sizeof expected, "%s:%s: %s", file, where, why);
    assert_int_equal(measured_read(file, &data, &launches, &error), LD_ERR_INPUT);
    if (!strstr(error.text, why) || strncmp(error.text, expected, strlen(expected)) != 0)
        fail_msg("\"%s\"\n    for \"%s\"\n    expected \"%s\"", error.text, text, expected);
    assert_true(launches.results == 0 && !launches.result);
}

static void test_wrong_files(void **state)
{
    (void)state;
    refuse("", "0:1", "the file is empty");
    refuse("# nothing\n\n", "2:1", "the file is empty");
    refuse("salvo\n1\n", "1:1", "names no result, such as \"t_front [ms]\"");
    refuse("t_front [ms]\n", "1:1", "no launch follows the header");
    refuse("t_rear [ms],t_fornt [ms]\n", "1:13",
           "the study has no result \"t_fornt\", did you mean \"t_front\"?");
    refuse("rocket.mass_error [kg]\n1\n", "1:1", "the study has no result \"rocket.mass_error\"");
    refuse("t_front\n96\n", "1:1",
           "t_front: no unit; expected one of s in brackets, such as \"t_front [s]\"");
    refuse("t_front [mss]\n96\n", "1:1",
           "t_front: found the unit \"mss\"; expected one of s, did you mean \"ms\"?");
    refuse("t_front [m/s]\n96\n", "1:1", "t_front: found the unit \"m/s\"; expected one of s");
    refuse("t_front [ms\n96\n", "1:1", "expected a result with its unit");
    refuse("t_front [ms];t_rear [ms]\n1;2\n", "1:1", "semicolons between fields");
    refuse("t_front [ms], \n96,\n", "1:14", "expected a result with its unit");
    refuse("t_front [ms],t_front [s]\n", "1:14", "t_front: is given in an earlier column");
    refuse("salvo,salvo\n", "1:7", "the study has no result \"salvo\"");
    refuse("t_front [ms],t_rear [ms]\n1,2\n3\n", "3:1",
           "found 1 fields; expected 2, as in the header");
    refuse("t_front [ms]\n96\n95,5\n", "3:1", "found 2 fields; expected 1");
    refuse("salvo,t_front [ms]\n1, 96 ms\n", "2:4", "t_front: found \"96 ms\"; expected a number");
    refuse("t_front [ms]\nnan\n", "2:1", "t_front: found \"nan\", not a number; expected a number");
    refuse("t_front [ms]\n0x60\n", "2:1", "t_front: found \"0x60\", a hexadecimal number");
    refuse("t_front [yr]\n1e305\n", "1:1", "t_front: found the unit \"yr\"");
    refuse("pitch [deg],salvo\n19,1.5\n", "2:4", "salvo: expected a whole number, below 1e9");
    refuse("pitch [deg],salvo\n19,\n", "2:4", "salvo: found \"\"; expected a number");
    measured launches;
    ld_error error;
    assert_int_equal(
        measured_read(shots_file("pitch [deg]\n1\0002\n", 16), &data, &launches, &error),
        LD_ERR_INPUT);
    assert_non_null(strstr(error.text, ":2:1: this line is not text, or is too long"));
    static const char empty[] = "salvo,pitch [deg],yaw [deg]\n1,,2\n2,,2\n";
    assert_int_equal(measured_read(shots_file(empty, sizeof empty - 1), &data, &launches, &error),
                     LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "launches.csv: pitch: no launch has a value"));
    assert_int_equal(measured_read(in("none.csv"), &data, &launches, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "none.csv cannot be read: No such file"));
}

// ---- the table

static char *shown(const char *text)
{
    char *table = NULL;
    size_t length;
    ld_error error;
    FILE *stream = open_memstream(&table, &length);
    ld_study_view view = {.measured = shots_file(text, strlen(text))};
    assert_int_equal(ld_study_show(in("study"), &view, stream, &error), LD_OK);
    fclose(stream);
    return table;
}

// The study's own numbers as if measured, the speed of one side 2 % higher.
static void test_table(void **state)
{
    (void)state;
    char *text = NULL;
    size_t length;
    ld_error error;
    const char *nearest;
    study_values values = {0};
    const study_column *column[] = {study_data_find(&data, "t_rear", &nearest),
                                    study_data_find(&data, "exit_speed", &nearest)};
    assert_int_equal(study_data_read(&data, data.point, column, 2, &values, &error), LD_OK);
    FILE *stream = open_memstream(&text, &length);
    fputs("t_rear [ms],exit_speed [m/s],apogee [m]\n", stream);
    for (size_t i = 0; i < values.count; i++)
        fprintf(stream, "%.17g,%.17g,1\n", 1e3 * values.value[0][i], 1.02 * values.value[1][i]);
    fclose(stream);
    char *table = shown(text);
    printf("%s", table);
    assert_non_null(strstr(table, "launches.csv: 12 launches\n"));
    char expected[64];
    group_statistics s;
    assert_int_equal(statistics_of(values.value[0], values.group, values.count, &s), LD_OK);
    snprintf(expected, sizeof expected, "t_rear [ms]%*s12 %.5g", 19, "", 1e3 * s.mean.value);
    assert_non_null(strstr(table, expected));
    assert_non_null(strstr(table, "* different at the 5 % level: 1 of 4 tests (where"));
    free(table);
    free(text);
    study_values_free(&values);
    table = shown("t_rear [ms]\n162\n");
    assert_non_null(strstr(table, "nothing can be tested"));
    free(table);
}

// Those that are named, by any name that the study knows, in that order; others are refused.
static void test_chosen(void **state)
{
    (void)state;
    static const char text[] = "t_rear [ms],exit_speed [m/s],pitch [deg]\n162,38,1\n163,,2\n";
    measured launches;
    ld_error error;
    const char *file = shots_file(text, sizeof text - 1);
    assert_int_equal(measured_read(file, &data, &launches, &error), LD_OK);
    assert_int_equal(measured_choose(&launches, "pitch, t_rear,pitch", &data, &error), LD_OK);
    assert_int_equal(launches.results, 2);
    assert_string_equal(launches.result[0].name, "pitch");
    assert_string_equal(launches.result[1].name, "t_rear");
    assert_int_equal(launches.result[1].count, 2);
    assert_int_equal(measured_choose(&launches, "t_rer", &data, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "--what: no launch was measured for \"t_rer\"; did you mean "
                                    "\"t_rear\"?");
    assert_int_equal(measured_choose(&launches, "apogee", &data, &error), LD_ERR_INPUT);
    assert_int_equal(measured_choose(&launches, ",", &data, &error), LD_ERR_INPUT);
    assert_int_equal(launches.results, 2);
    measured_free(&launches);
    const ld_study_view view = {.measured = file, .what = "exit_speed"};
    char *table = NULL;
    size_t length;
    FILE *stream = open_memstream(&table, &length);
    assert_int_equal(ld_study_show(in("study"), &view, stream, &error), LD_OK);
    fclose(stream);
    assert_true(strstr(table, "exit_speed [m/s]") && !strstr(table, "t_rear"));
    free(table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_published),   cmocka_unit_test(test_too_few),
        cmocka_unit_test(test_how_often),   cmocka_unit_test(test_file),
        cmocka_unit_test(test_wrong_files), cmocka_unit_test(test_table),
        cmocka_unit_test(test_chosen),
    };
    return cmocka_run_group_tests(tests, make_study, end_study);
}
