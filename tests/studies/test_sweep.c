// Sweeps: points and their samples. Stopping rules: the same end however the study is run.
// ctest: slow
#include "model/model.h"
#include "support/study_run.h"

#include <stdatomic.h>

#include "studies/run/until.h"
#include "studies/store/study_data.h"

#define SWEEP                                                                                      \
    "include: fixed.yaml\n"                                                                        \
    "sweep:\n  rocket.mass: [59 kg, 61 kg]\n  base.elevation: [10 deg, 20 deg, 30 deg]\n"
#define SCATTER                                                                                    \
    "scatter:\n  seed: 3\n  samples: 4\n  factors:\n    rocket.mass_error: {normal: 0.2 kg}\n"

static double number_of(const ld_study *study, int64_t sample, double *elevation)
{
    ld_sample *one;
    ld_error error;
    assert_int_equal(ld_study_sample(study, sample, &one, &error), LD_OK);
    const ld_model *model = ld_sample_model(one);
    double error_drawn = model->rocket.mass_error;
    *elevation = model->base.elevation * 57.295779513082321;
    ld_sample_free(one);
    return error_drawn;
}

// Samples go round the points, at all of which the same numbers are sampled.
static void test_points(void **state)
{
    (void)state;
    ld_study *study = study_of(SWEEP SCATTER), *alone;
    ld_study_counts counts = study_run(study, "sweep", 2);
    assert_true(counts.samples == 24 && counts.done == 24 && counts.failed == 0);
    double first, second, elevation;
    first = number_of(study, 7, &elevation);
    CHECK_NEAR("elevation of sample 7, point 1 [deg]", elevation, 10, 1e-12);
    second = number_of(study, 12, &elevation);
    CHECK_NEAR("elevation of sample 12, point 6 [deg]", elevation, 30, 1e-12);
    assert_true(first == second && first != number_of(study, 13, &elevation));

    // a point is the study of its values alone
    alone =
        study_with("include: fixed.yaml\nrocket: {mass: 61 kg}\n" SCATTER, "base.elevation=20 deg");
    study_run(alone, "alone", 1);
    study_data sweep, point;
    study_values one = {0}, other = {0};
    ld_error error;
    const char *nearest;
    assert_int_equal(study_data_open(in("sweep"), &sweep, &error), LD_OK);
    assert_int_equal(study_data_open(in("alone"), &point, &error), LD_OK);
    assert_int_equal(sweep.point_count, 6);
    assert_string_equal(sweep.point[4].text[0], "61 kg");
    assert_string_equal(sweep.point[4].text[1], "20 deg");
    const study_column *columns[] = {study_data_find(&sweep, "exit_speed", &nearest)};
    assert_int_equal(study_data_read(&sweep, &sweep.point[4], columns, 1, &one, &error), LD_OK);
    columns[0] = study_data_find(&point, "exit_speed", &nearest);
    assert_int_equal(study_data_read(&point, &point.point[0], columns, 1, &other, &error), LD_OK);
    assert_true(one.count == 4 && other.count == 4);
    assert_memory_equal(one.value[0], other.value[0], 4 * sizeof(double));
    study_values_free(&one);
    study_values_free(&other);
    study_data_close(&sweep);
    study_data_close(&point);
    ld_study_free(study);
    ld_study_free(alone);
}

// What a point has not got, such as the slot that others have, has no value there.
static void test_point_without_a_slot(void **state)
{
    (void)state;
    ld_study *study = study_of("include: fixed.yaml\nrun: {end: tip}\n"
                               "sweep: {tubes.slot: [none, {radius: 80 mm, angle: 4 deg}]}\n");
    study_run(study, "slots", 1);
    study_data data;
    ld_error error;
    const char *nearest;
    assert_int_equal(study_data_open(in("slots"), &data, &error), LD_OK);
    const study_column *columns[] = {study_data_find(&data, "max_slot_force", &nearest)};
    study_values found = {0};
    assert_int_equal(study_data_read(&data, &data.point[0], columns, 1, &found, &error), LD_OK);
    assert_int_equal(found.count, 0);
    assert_int_equal(study_data_read(&data, &data.point[1], columns, 1, &found, &error), LD_OK);
    assert_int_equal(found.count, 1);
    CHECK_WITHIN("largest slot force with a slot [N]", found.value[0][0], 1400, 1600);
    study_values_free(&found);
    study_data_close(&data);
    ld_study_free(study);
}

// More samples continue with the numbers that follow; a sweep alone has one sample a point; a part
// of it is a shard; a point that cannot be is refused before anything runs.
static void test_other_sweeps(void **state)
{
    (void)state;
    ld_study *more = study_with(SWEEP SCATTER, "scatter.samples=5"), *plain = study_of(SWEEP);
    ld_study_counts counts = study_run(more, "sweep", 1);
    assert_true(counts.done == 30 && counts.now == 6);
    study_run(more, "again", 2);
    expect_same_tables("sweep", "again");
    counts = study_run(plain, "plain", 2);
    assert_true(counts.samples == 6 && counts.done == 6);
    ld_error error;
    for (int shard = 1; shard <= 4; shard++) {
        ld_study_options options = {.shard = shard, .shards = 4};
        assert_int_equal(ld_study_run(plain, in("shards"), &options, &counts, &error), LD_OK);
        assert_true(counts.samples == (shard <= 2 ? 2 : 1));
    }
    FILE *nowhere = fopen("/dev/null", "w");
    assert_int_equal(ld_study_merge(in("shards"), nowhere, &error), LD_OK);
    fclose(nowhere);
    expect_same_tables("plain", "shards");
    ld_study_free(more);
    ld_study_free(plain);

    static const char wrong[] = "include: fixed.yaml\nsweep: {rocket.mass: [60 kg, 30 kg]}\n";
    ld_messages messages;
    ld_study *none;
    assert_int_equal(ld_study_read_text(wrong, strlen(wrong), "text", LD_SOURCE_DIR "/examples",
                                        NULL, 0, &none, &messages),
                     LD_ERR_INPUT);
    assert_non_null(strstr(messages.item[0].text, "(point 2 of the sweep, rocket.mass: 30 kg)"));
    ld_messages_free(&messages);
}

// Of hypercubes whole ones only; never more than all samples.
static void test_looks(void **state)
{
    (void)state;
    ld_scatter plain = {.present = true, .samples = 100, .plan = LD_PLAN_RANDOM};
    static const int64_t looks[] = {20, 25, 32, 40, 50, 63, 79, 99, 100, 100};
    int64_t n = 0;
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        n = until_next_check(&plain, n);
        assert_int_equal(n, looks[i]);
    }
    ld_scatter lhs = {.present = true, .samples = 96, .plan = LD_PLAN_LHS, .replicates = 12};
    static const int64_t cubes[] = {40, 56, 72, 96, 96};
    n = 0;
    for (size_t i = 0; i < sizeof cubes / sizeof *cubes; i++) {
        n = until_next_check(&lhs, n);
        assert_int_equal(n, cubes[i]);
    }
}

static bool ten_more(void *self)
{
    return atomic_load((atomic_int *)self) < 10;
}

static void count(void *self, const ld_study_counts *counts)
{
    (void)counts;
    atomic_fetch_add((atomic_int *)self, 1);
}

#define UNTIL                                                                                      \
    "include: fixed.yaml\nsweep: {rocket.mass: [59 kg, 61 kg]}\n"                                  \
    "scatter:\n  samples: 100\n  factors:\n    base.elevation: {normal: 1 deg}\n"                  \
    "    rocket.mass_error: {normal: 0.2 kg}\n  until: "

static void test_until(void **state)
{
    (void)state;
    ld_study *study = study_of(UNTIL "{t_rear.mean: 6e-5 s}\n");
    ld_study_counts counts = study_run(study, "until", 1);
    printf("    %lld samples were enough\n", (long long)counts.samples);
    assert_true(counts.enough && counts.done == counts.samples && counts.look == counts.samples);
    // the rule holds there and did not before
    study_data data;
    ld_error error;
    const char *nearest;
    double half, before;
    assert_int_equal(study_data_open(in("until"), &data, &error), LD_OK);
    const study_column *t_rear = study_data_find(&data, "t_rear", &nearest);
    int64_t earlier = 0, last = counts.samples / 2;
    for (int64_t n = 0; (n = until_next_check(&ld_study_model(study)->scatter, n)) < last;)
        earlier = n;
    assert_true(earlier > 0);
    assert_int_equal(study_data_half_width(&data, t_rear,
                                           &(ld_until){.statistic = LD_STATISTIC_MEAN}, 2 * last,
                                           &half, &error),
                     LD_OK);
    assert_int_equal(study_data_half_width(&data, t_rear,
                                           &(ld_until){.statistic = LD_STATISTIC_MEAN}, 2 * earlier,
                                           &before, &error),
                     LD_OK);
    study_data_close(&data);
    CHECK_BELOW("half width where it stopped [s]", half, 6e-5);
    CHECK_WITHIN("half width at the look before [s]", before, 6e-5, 7.2e-5);
    // whatever the threads and interruptions
    study_run(study, "threads", 3);
    expect_same_tables("until", "threads");
    ld_status status = LD_ERR_INTERRUPTED;
    for (int runs = 0; status == LD_ERR_INTERRUPTED && runs < 30; runs++) {
        atomic_int done = 0;
        ld_study_options options = {
            .threads = 2, .self = &done, .progress = count, .go_on = ten_more};
        status = ld_study_run(study, in("stopped"), &options, &counts, &error);
    }
    assert_int_equal(status, LD_OK);
    expect_same_tables("until", "stopped");
    ld_study_free(study);
    // a rule that cannot hold, and shards, which cannot know
    study = study_with(UNTIL "{t_rear.mean: 6e-5 s}\n", "scatter.until={t_rear.mean: 1e-9 s}");
    counts = study_run(study, "threads", 2);
    assert_true(!counts.enough && counts.done == 200);
    ld_study_options options = {.shard = 1, .shards = 2};
    assert_int_equal(ld_study_run(study, in("shards"), &options, &counts, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "scatter.until"));
    ld_study_free(study);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points),       cmocka_unit_test(test_point_without_a_slot),
        cmocka_unit_test(test_other_sweeps), cmocka_unit_test(test_looks),
        cmocka_unit_test(test_until),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
