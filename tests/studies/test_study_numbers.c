// What a program gets of a study: points, columns, values, statistics as numbers. Samples run on
// their own, and sums written here, say the same.
#include "support/study_run.h"

#include "launchdyn/study_data.h"
#include "launchdyn/summary.h"

#define TEXT                                                                                       \
    "include: flight.yaml\nrun: {flight_tolerance: 1e-4}\n"                                        \
    "sweep:\n  rocket.mass: [59 kg, 61 kg]\n"                                                      \
    "scatter:\n  seed: 5\n  samples: 12\n"                                                         \
    "  factors:\n    rocket.motor.thrust_scale: {normal: 0.01}\n"                                  \
    "    rocket.motor.time_scale: {normal: 1e-9}\n"

static ld_study_data *open_study(void)
{
    ld_study_data *data;
    ld_error error;
    if (ld_study_data_open(in("study"), &data, &error))
        fail_msg("%s", error.text);
    return data;
}

static void test_points_and_columns(void **state)
{
    (void)state;
    ld_study_data *data = open_study();
    assert_string_equal(ld_study_data_swept(data, 0), "rocket.mass");
    assert_null(ld_study_data_swept(data, 1));
    const ld_study_point *point = ld_study_data_point(data, 2);
    assert_string_equal(point->text[0], "61 kg");
    assert_true(point->number == 2 && point->asked == 12 && point->done == 12 && !point->failed);
    assert_null(ld_study_data_point(data, 0));
    assert_null(ld_study_data_point(data, 3));
    int columns = 0, factors = 0, ranges = 0;
    for (const ld_study_column *c; (c = ld_study_data_column(data, columns)); columns++) {
        factors += c->factor;
        ranges += strcmp(c->name, "range") == 0 && strcmp(c->unit, "m") == 0 && c->per_rocket;
    }
    CHECK_WITHIN("factors among the columns", factors, 2, 2);
    CHECK_WITHIN("columns named range", ranges, 1, 1);
    assert_true(ld_study_data_column(data, columns - 1)->factor);
    assert_null(ld_study_data_column(data, -1));
    ld_study_data_close(data);
}

// Range [m] and thrust scale of a sample that runs on its own.
static double run_alone(const ld_study *study, int64_t number, double *scale)
{
    ld_sample *sample;
    ld_simulation *simulation;
    ld_error error;
    double range;
    ld_summary *summary = ld_summary_new();
    assert_int_equal(ld_study_sample(study, number, &sample, &error), LD_OK);
    const ld_model *model = ld_sample_model(sample);
    assert_int_equal(ld_model_number(model, "rocket.motor.thrust_scale", scale, &error), LD_OK);
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, summary, &error), LD_OK);
    assert_int_equal(ld_summary_number(summary, "rocket.1.range", &range, &error), LD_OK);
    ld_simulation_free(simulation);
    ld_summary_free(summary);
    ld_sample_free(sample);
    return range;
}

static void test_values_and_statistics(void **state)
{
    (void)state;
    static const char *const names[] = {"range", "rocket.motor.thrust_scale"};
    ld_study_data *data = open_study();
    ld_study *study = study_of(TEXT);
    const ld_study_values *values;
    const ld_study_statistics *statistics;
    ld_error error;
    assert_int_equal(ld_study_data_values(data, 2, names, 2, &values, &error), LD_OK);
    assert_int_equal(values->count, 12);
    double scale, mean = 0, square = 0, least = INFINITY;
    int differ = 0;
    for (size_t i = 0; i < 12; i++) {
        double range = values->value[0][i];
        assert_true(values->sample[i] == 2 * (int64_t)i + 2 && values->rocket[i] == 1);
        if (i % 4 == 0) {
            differ += run_alone(study, values->sample[i], &scale) != range;
            differ += values->value[1][i] != scale;
        }
        mean += range / 12;
        least = fmin(least, range);
    }
    for (size_t i = 0; i < 12; i++)
        square += pow(values->value[0][i] - mean, 2) / 11;
    CHECK_WITHIN("values that differ from samples by themselves", differ, 0, 0);

    assert_int_equal(ld_study_data_statistics(data, 2, "range", &statistics, &error), LD_OK);
    assert_true(statistics->count == 12 && statistics->groups == 12);
    CHECK_BELOW("mean of the ranges, relative", statistics->mean.value / mean - 1, 4e-16);
    CHECK_BELOW("their deviation, relative", statistics->deviation.value / sqrt(square) - 1, 1e-14);
    // Student's t at 97.5 % with 11 degrees of freedom
    CHECK_NEAR("half the mean's interval over its error",
               0.5 * (statistics->mean.high - statistics->mean.low) / sqrt(square / 12), 2.200985,
               1e-6);
    CHECK_BELOW("the least range [m]", statistics->least - least, 0);
    assert_true(statistics->quantile[0].value > least &&
                statistics->quantile[2].value < statistics->greatest);

    ld_estimate share, none;
    assert_int_equal(ld_study_data_sensitivity(data, 2, "range", names[1], &share, &error), LD_OK);
    assert_int_equal(
        ld_study_data_sensitivity(data, 2, "range", "rocket.motor.time_scale", &none, &error),
        LD_OK);
    CHECK_WITHIN("share of the thrust in the range's variance", share.value, 0.99, 1);
    CHECK_WITHIN("share of a time scale that hardly scatters", none.value, -1, 0.6);
    ld_study_free(study);
    ld_study_data_close(data);
}

static void test_what_is_not_there(void **state)
{
    (void)state;
    ld_study_data *data = open_study(), *other;
    const ld_study_statistics *statistics;
    const ld_study_values *values;
    const char *name = "rnage";
    ld_error error;
    assert_int_equal(ld_study_data_statistics(data, 1, name, &statistics, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "the study has no column \"rnage\"; did you mean \"range\"?");
    assert_null(statistics);
    assert_int_equal(ld_study_data_values(data, 3, &name, 1, &values, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "found point 3, expected 1 to 2");
    assert_null(values);
    assert_int_equal(ld_study_data_open(in("nothing"), &other, &error), LD_ERR_INPUT);
    assert_null(other);
    ld_study_data_close(data);
    ld_study_data_close(NULL);
}

static int setup(void **state)
{
    if (scratch_make(state))
        return -1;
    ld_study *study = study_of(TEXT);
    ld_study_counts counts = study_run(study, "study", 2);
    ld_study_free(study);
    return counts.done != 24 || counts.failed != 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points_and_columns),
        cmocka_unit_test(test_values_and_statistics),
        cmocka_unit_test(test_what_is_not_there),
    };
    return cmocka_run_group_tests(tests, setup, scratch_remove);
}
