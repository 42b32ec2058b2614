// Studies: the same results whatever the number of threads and the interruptions; what is kept.
#include "model/model.h"
#include "support/study_run.h"

#include <signal.h>
#include <stdatomic.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "launchdyn/study_data.h"
#include "quantities/summary.h"
#include "studies/run/until.h"
#include "studies/store/store.h"

#define LAUNCH                                                                                     \
    "include: fixed.yaml\n"                                                                        \
    "scatter:\n"                                                                                   \
    "  seed: 3\n"                                                                                  \
    "  samples: 24\n"                                                                              \
    "  factors:\n"                                                                                 \
    "    rocket.mass_error: {normal: 0.2 kg}\n"                                                    \
    "    base.elevation: {normal: 1 deg}\n"
static const char launch[] = LAUNCH;

static void test_threads(void **state)
{
    (void)state;
    ld_study *study = study_of(launch);
    ld_study_counts counts = study_run(study, "one", 1);
    assert_true(counts.done == 24 && counts.now == 24 && counts.failed == 0);
    study_run(study, "three", 3);
    char *one = study_table("one"), *three = study_table("three");
    assert_string_equal(one, three);
    counts = study_run(study, "one", 2);
    assert_true(counts.done == 24 && counts.now == 0);
    free(one);
    free(three);
    ld_study_free(study);
}

// Ranges that run elsewhere, whose parts come twice.
static void test_parts_come_twice(void **state)
{
    (void)state;
    ld_study *study = study_of(launch);
    ld_study_options options = {.threads = 2};
    ld_study_keeper *keeper;
    ld_study_range range;
    ld_study_counts counts;
    ld_error error;
    assert_int_equal(ld_study_keeper_open(study, in("twice"), &keeper, &error), LD_OK);
    while (ld_study_keeper_next(keeper, &range)) {
        void *part;
        size_t size;
        assert_int_equal(ld_study_run_range(study, &range, &options, &part, &size, &error), LD_OK);
        for (int i = 0; i < 2; i++)
            assert_int_equal(ld_study_keeper_put(keeper, part, size, &error), LD_OK);
        ld_free(part);
    }
    ld_study_keeper_counts(keeper, &counts);
    assert_int_equal(counts.done, 24);
    assert_int_equal(ld_study_keeper_close(keeper, &error), LD_OK);
    study_run(study, "once", 1);
    char *once = study_table("once"), *twice = study_table("twice");
    assert_string_equal(once, twice);
    free(once);
    free(twice);
    ld_study_free(study);
}

static bool three_more(void *self)
{
    return atomic_load((atomic_int *)self) < 3;
}

static void count(void *self, const ld_study_counts *counts)
{
    (void)counts;
    atomic_fetch_add((atomic_int *)self, 1);
}

// Stopped on request again and again.
static void test_stopped(void **state)
{
    (void)state;
    ld_study *study = study_of(launch);
    ld_error error;
    ld_study_counts counts = {0};
    ld_status status = LD_ERR_INTERRUPTED;
    int runs = 0;
    for (; status == LD_ERR_INTERRUPTED && runs < 30; runs++) {
        atomic_int done = 0;
        ld_study_options options = {
            .threads = 2, .self = &done, .progress = count, .go_on = three_more};
        int64_t before = counts.done;
        status = ld_study_run(study, in("stopped"), &options, &counts, &error);
        assert_true(counts.done >= before + counts.now);
    }
    assert_int_equal(status, LD_OK);
    CHECK_WITHIN("runs that it took", runs, 6, 9);
    char *one = study_table("one"), *stopped = study_table("stopped");
    assert_string_equal(one, stopped);
    free(one);
    free(stopped);
    ld_study_free(study);
}

// Removes the folder as soon as a sample is kept.
static void remove_folder(void *self, const ld_study_counts *counts)
{
    char command[128];
    (void)self;
    snprintf(command, sizeof command, "rm -rf %s", in("removed"));
    if (counts->now == 1)
        assert_int_equal(system(command), 0);
}

static bool while_it_is_there(void *self)
{
    (void)self;
    return access(in("removed"), F_OK) == 0;
}

static bool until_kept(void *self)
{
    (void)self;
    return true;
}

// A study that has nothing to show for its samples says so: at its end, and where it is stopped,
// too.
static void test_removed(void **state)
{
    (void)state;
    ld_study *study = study_of(launch);
    for (int stopped = 0; stopped < 2; stopped++) {
        ld_error error = {.text = ""};
        ld_study_counts counts;
        ld_study_options options = {.threads = 1, .progress = remove_folder};
        options.go_on = stopped ? while_it_is_there : until_kept;
        assert_int_equal(mkdir(in("removed"), 0777), 0);
        assert_int_equal(ld_study_run(study, in("removed"), &options, &counts, &error),
                         LD_ERR_FILE);
        if (!strstr(error.text, "removed/study.db: another program has removed or moved it"))
            fail_msg("\"%s\"", error.text);
    }
    ld_study_free(study);
}

static void expect_refusal(const ld_study *study, const char *name, const char *part)
{
    ld_error error = {0};
    ld_study_counts counts;
    assert_int_equal(ld_study_run(study, in(name), NULL, &counts, &error), LD_ERR_INPUT);
    if (!strstr(error.text, part))
        fail_msg("\"%s\" is not about \"%s\"", error.text, part);
}

// After its first commit a study says so through a pipe.
static void say_ready(void *self, const ld_study_counts *counts)
{
    if (counts->now > 0 && write(*(const int *)self, "!", 1) != 1)
        _exit(3);
}

static void test_refusals(void **state)
{
    (void)state;
    ld_study *study = study_of(launch), *other = study_of(LAUNCH "rocket:\n  mass: 61 kg\n");
    ld_study *more = study_with(launch, "scatter.samples=26"),
             *plain = study_of("include: fixed.yaml\n");
    expect_refusal(other, "one", "mass: 61 kg");
    expect_refusal(plain, "plain", "neither scatter nor sweep");
    // the one in the folder says more
    ld_study *swept =
        study_with(LAUNCH "sweep: {rocket.mass: [60 kg, 61 kg]}\n", "scatter.samples=1");
    study_run(swept, "swept", 1);
    expect_refusal(study, "swept", "first difference is in \"sweep:\"");
    ld_study_free(swept);
    // more samples of the plan `random` are the same study
    ld_study_counts counts = study_run(more, "one", 2);
    assert_true(counts.done == 26 && counts.now == 2);
    study_run(more, "more", 1);
    char *one = study_table("one"), *again = study_table("more");
    assert_string_equal(one, again);
    free(one);
    free(again);
    // two at once
    int ready[2];
    char word;
    assert_int_equal(pipe(ready), 0);
    ld_study_free(more);
    more = study_with(launch, "scatter.samples=1000000");
    pid_t child = fork();
    if (child == 0) {
        ld_error error;
        ld_study_options options = {.threads = 1, .self = &ready[1], .progress = say_ready};
        ld_study_run(more, in("one"), &options, &counts, &error);
        _exit(0);
    }
    assert_int_equal(read(ready[0], &word, 1), 1);
    expect_refusal(study, "one", "another launchdyn");
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    // a folder that cannot be made
    ld_error error;
    assert_int_equal(ld_study_run(study, "/proc/study", NULL, &counts, &error), LD_ERR_FILE);
    assert_int_equal(ld_study_show(in("nothing"), NULL, stdout, &error), LD_ERR_INPUT);
    ld_study_free(study);
    ld_study_free(other);
    ld_study_free(more);
    ld_study_free(plain);
}

// The text of column `name` of the line of sample `number`, rocket `rocket`.
static void cell(const char *csv, const char *name, int number, int rocket, char text[64])
{
    int column = 0;
    size_t length = strlen(name);
    const char *at = csv;
    while (strncmp(at, name, length) != 0 || (at[length] != ',' && at[length] != '\n')) {
        at += strcspn(at, ",\n");
        assert_true(*at++ == ',');
        column++;
    }
    char begin[32];
    snprintf(begin, sizeof begin, "\n%d,%d,", number, rocket);
    at = strstr(csv, begin);
    assert_non_null(at);
    for (at++; column > 0; column--)
        at += strcspn(at, ",") + 1;
    snprintf(text, 64, "%.*s", (int)strcspn(at, ",\n"), at);
}

static void test_one_sample_alone(void **state)
{
    (void)state;
    ld_study *study = study_of(launch);
    ld_sample *sample;
    ld_simulation *simulation;
    ld_error error;
    static ld_summary summary;
    char *csv = study_table("three"), kept[64], alone[64];
    assert_int_equal(ld_study_sample(study, 17, &sample, &error), LD_OK);
    assert_int_equal(ld_simulation_create(ld_sample_model(sample), &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, &summary, &error), LD_OK);
    cell(csv, "exit_speed", 17, 1, kept);
    snprintf(alone, sizeof alone, "%.17g", summary.rocket[0].exit_speed);
    assert_string_equal(alone, kept);
    cell(csv, "rocket.mass_error", 17, 1, kept);
    snprintf(alone, sizeof alone, "%.17g", ld_sample_model(sample)->rocket.mass_error);
    assert_string_equal(alone, kept);
    ld_sample *none;
    assert_int_equal(ld_study_sample(study, 25, &none, &error), LD_ERR_INPUT);
    free(csv);
    ld_simulation_free(simulation);
    ld_sample_free(sample);
    ld_study_free(study);
}

static char *merge(const char *name, ld_status expected)
{
    char *text = NULL;
    size_t length;
    ld_error error = {0};
    FILE *stream = open_memstream(&text, &length);
    assert_non_null(stream);
    ld_status status = ld_study_merge(in(name), stream, &error);
    fclose(stream);
    if (status != expected)
        fail_msg("%d %s", status, error.text);
    if (status) {
        free(text);
        return strdup(error.text);
    }
    return text;
}

static void expect_merge(const char *name, ld_status status, const char *part)
{
    char *text = merge(name, status);
    if (!strstr(text, part))
        fail_msg("\"%s\" is not in: %s", part, text);
    free(text);
}

static ld_status run_shard(const ld_study *study, int shard, int shards, ld_study_counts *counts,
                           bool (*go_on)(void *), void (*progress)(void *, const ld_study_counts *))
{
    atomic_int done = 0;
    ld_error error = {0};
    ld_study_options options = {.threads = 1,
                                .shard = shard,
                                .shards = shards,
                                .self = &done,
                                .go_on = go_on,
                                .progress = progress};
    return ld_study_run(study, in("shards"), &options, counts, &error);
}

// Who reads the study until somebody waits: SQLite's sleep.
static ld_study_data *read_meanwhile;

static int closes(sqlite3_vfs *system, int microseconds)
{
    (void)system;
    ld_study_data_close(read_meanwhile);
    read_meanwhile = NULL;
    return microseconds;
}

// A merge waits for who reads the study: it changes the kind of the journal, which no one else may
// have open then. What is reported where they continue for ever.
static void merge_beside_a_reader(void)
{
    ld_error error;
    if (ld_study_data_open(in("shards"), &read_meanwhile, &error))
        fail_msg("%s", error.text);
    sqlite3_vfs *system = sqlite3_vfs_find(NULL);
    int (*sleeps)(sqlite3_vfs *, int) = system->xSleep;
    system->xSleep = closes;
    expect_merge("shards", LD_OK, "24 of 24 samples");
    system->xSleep = sleeps;
    assert_null(read_meanwhile);
    const study_store none = {0};
    assert_int_equal(store_fail_by(&none, SQLITE_BUSY, "study.db", "write", &error), LD_ERR_FILE);
    assert_string_equal(error.text, "cannot write study.db: another program is reading or writing "
                                    "it; wait until it closes the study, then repeat");
}

// Parts of a study, run in any order and joined, are the study.
static void test_shards(void **state)
{
    (void)state;
    ld_study *study = study_of(launch), *other = study_of(LAUNCH "rocket:\n  mass: 61 kg\n");
    ld_study_counts counts;
    assert_int_equal(run_shard(study, 3, 3, &counts, NULL, NULL), LD_OK);
    assert_true(counts.samples == 8 && counts.done == 8);
    assert_int_equal(run_shard(study, 1, 3, &counts, three_more, count), LD_ERR_INTERRUPTED);
    expect_merge("shards", LD_OK, "11 of 24 samples");
    expect_merge("shards", LD_OK, "shard 1 of 3 lacks 5 of its 8 samples");
    expect_merge("shards", LD_OK, "missing: shard 2 of 3");
    assert_int_equal(run_shard(study, 1, 3, &counts, NULL, NULL), LD_OK);
    assert_true(counts.now == 5);
    expect_merge("shards", LD_OK, "16 of 24 samples");
    assert_int_equal(run_shard(study, 4, 3, &counts, NULL, NULL), LD_ERR_INPUT);
    assert_int_equal(run_shard(other, 1, 3, &counts, NULL, NULL), LD_ERR_INPUT);
    // the plain command runs the rest
    counts = study_run(study, "shards", 2);
    assert_true(counts.done == 24 && counts.now == 8);
    char *one = study_table("one"), *shards = study_table("shards");
    assert_string_equal(one, shards);
    free(shards);
    // and what it has run may come from its shard as well
    assert_int_equal(run_shard(study, 2, 3, &counts, NULL, NULL), LD_OK);
    merge_beside_a_reader();
    shards = study_table("shards");
    assert_string_equal(one, shards);
    free(one);
    free(shards);
    assert_int_equal(run_shard(other, 1, 4, &counts, NULL, NULL), LD_OK);
    expect_merge("shards", LD_ERR_INPUT, "of different studies: in their scenario");
    expect_merge("one", LD_ERR_INPUT, "no shards");
    // wildcards in the folder's name are letters; a shard killed as it began holds nothing
    char command[256];
    snprintf(command, sizeof command, "mkdir '%s' && touch '%s/shard-2-of-3.db'", in("new[1]*"),
             in("new[1]*"));
    assert_int_equal(system(command), 0);
    expect_merge("new[1]*", LD_ERR_INPUT, "has begun");
    snprintf(command, sizeof command, "echo text, not a database >'%s/shard-2-of-3.db'",
             in("new[1]*"));
    assert_int_equal(system(command), 0);
    expect_merge("new[1]*", LD_ERR_INPUT, "shard-2-of-3.db is damaged: file is not a database");
    ld_study_free(study);
    ld_study_free(other);
}

// Samples that cannot run are kept with what was the matter, and the study continues.
static void test_failures(void **state)
{
    (void)state;
    ld_study *study =
        study_of("include: fixed.yaml\nscatter:\n  samples: 20\n  factors:\n"
                 "    rocket.lock.release_force: {discrete: [5 kN, 500 kN], weights: [3, 1]}\n"
                 "    rocket.mass: {normal: 60 kg}\n");
    ld_study_counts counts = study_run(study, "failures", 2);
    char *csv = study_table("failures"), *shown = NULL, status[64], value[64];
    int launches = 0, inputs = 0;
    size_t length;
    for (int i = 1; i <= 20; i++) {
        cell(csv, "status", i, 1, status);
        cell(csv, "rocket.mass", i, 1, value);
        bool impossible = atof(value) < 40; // less than empty
        cell(csv, "rocket.lock.release_force", i, 1, value);
        bool held = atof(value) > 1e5;
        launches += strcmp(status, "launch") == 0;
        inputs += strcmp(status, "input") == 0;
        assert_string_equal(status, impossible ? "input" : held ? "launch" : "ok");
    }
    assert_true(launches > 0 && inputs > 0);
    assert_true(counts.done == 20 && counts.failed == launches + inputs);
    FILE *stream = open_memstream(&shown, &length);
    ld_error error;
    assert_int_equal(ld_study_show(in("failures"), NULL, stream, &error), LD_OK);
    fclose(stream);
    assert_non_null(strstr(shown, "the lock never released"));
    free(csv);
    free(shown);
    ld_study_free(study);
}

// What `study show` prints of a study.
static char *shown_of(const char *name)
{
    char *shown = NULL;
    size_t length;
    ld_error error;
    FILE *stream = open_memstream(&shown, &length);
    assert_int_equal(ld_study_show(in(name), NULL, stream, &error), LD_OK);
    fclose(stream);
    return shown;
}

// What stabilisers did is shown unasked; the time at their limits where there was any.
static void test_stabilisers_are_shown(void **state)
{
    (void)state;
    static const char vehicle[] =
        "include: reference.yaml\nrun: {lead_in: 50 ms, end: tip}\nscatter:\n  samples: 2\n"
        "  factors:\n    rocket.mass_error: {normal: 0.2 kg}\n";
    ld_study *usual = study_of(vehicle);
    ld_study *weak = study_with(vehicle, "platform.elevation.stabiliser.torque_limit=16.2 kN.m");
    study_run(usual, "usual", 2);
    study_run(weak, "weak", 2);
    char *shown = shown_of("usual"), *limited = shown_of("weak");
    static const char *const result[] = {"azimuth.error_rms", "elevation.torque_peak",
                                         "elevation.power_mean"};
    for (int i = 0; i < 3; i++)
        assert_non_null(strstr(shown, result[i]));
    assert_null(strstr(shown, "saturated"));
    assert_non_null(strstr(limited, "elevation.saturated"));
    assert_null(strstr(limited, "azimuth.saturated"));
    free(shown);
    free(limited);
    ld_study_free(usual);
    ld_study_free(weak);
}

// On a base that stands still the second rocket leaves as it would alone, with its own numbers.
static void test_rockets_of_a_salvo(void **state)
{
    (void)state;
#define SALVO                                                                                      \
    "include: fixed.yaml\nfiring: [{tube: 8, at: 0 s}, {tube: 9, at: 1 s}]\nrun: {tolerance: "     \
    "1e-8}\nscatter:\n"                                                                            \
    "  samples: 1\n  factors:\n"                                                                   \
    "    rocket.mass_error: {normal: 1 kg}\n    rocket.motor.thrust_scale: {normal: 5 %}\n"        \
    "    rocket.adaptors.rear.clearance: {uniform: 0.2 0.4 mm}\n"                                  \
    "    rocket.motor.misalignment.z: {normal: 2 mrad}\n"
    ld_study *study = study_of(SALVO);
    ld_sample *sample;
    ld_simulation *simulation;
    ld_error error;
    static ld_summary salvo, alone;
    assert_int_equal(ld_study_sample(study, 1, &sample, &error), LD_OK);
    const ld_model *drawn = ld_sample_model(sample);
    assert_int_equal(ld_simulation_create(drawn, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, &salvo, &error), LD_OK);
    ld_simulation_free(simulation);

    ld_model second = *drawn;
    second.rocket = drawn->salvo[1];
    second.salvo = NULL;
    second.firing_count = 1;
    second.firing[0] = (ld_firing){.tube = 9, .at = 0};
    second.run.lead_in = 0.2;
    assert_int_equal(ld_simulation_create(&second, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, &alone, &error), LD_OK);
    ld_simulation_free(simulation);
    const ld_rocket_summary *a = &alone.rocket[0], *b = &salvo.rocket[1], *c = &salvo.rocket[0];
    CHECK_BELOW("t_rear in the salvo and alone [s]", a->t_rear - b->t_rear, 1e-9);
    CHECK_BELOW("exit speed [m/s]", a->exit_speed - b->exit_speed, 1e-6);
    CHECK_BELOW("yaw rate [rad/s]", a->yaw_rate - b->yaw_rate, 1e-6);
    CHECK_WITHIN("t_rear of the first rocket differs [s]", fabs(c->t_rear - b->t_rear), 1e-4, 0.1);
    ld_sample_free(sample);
    ld_study_free(study);
}

// Flights alone: the size of what is kept.
static void test_size(void **state)
{
    (void)state;
    ld_study *study = study_of("include: flight.yaml\nrun: {flight_tolerance: 1e-4}\nscatter:\n"
                               "  samples: 400\n  plan: lhs\n  replicates: 4\n  factors:\n"
                               "    rocket.mass_error: {normal: 0.2 kg}\n"
                               "    rocket.motor.thrust_scale: {normal: 1 %}\n"
                               "    rocket.motor.misalignment.y: {normal: 0.5 mrad}\n"
                               "    rocket.aerodynamics.ca_scale: {normal: 2 %}\n"
                               "    environment.temperature_offset: {normal: 5 K}\n");
    study_run(study, "flight", 2);
    struct stat file;
    assert_int_equal(stat(in("flight/study.db"), &file), 0);
    CHECK_WITHIN("bytes a sample", (double)file.st_size / 400, 100, 1000);
    ld_study_free(study);
}

// Somebody who may read the folder, not write it, sees the study; nothing is left beside it.
static void test_shown_to_others(void **state)
{
    (void)state;
    ld_study *study = study_of(launch);
    study_run(study, "others #1", 1);
    assert_int_equal(chmod(folder, 0755) | chmod(in("others #1"), 0555), 0);
    pid_t child = fork();
    if (child == 0) {
        ld_error error = {0};
        FILE *nowhere = fopen("/dev/null", "w");
        bool other = geteuid() != 0 || setuid(65534) == 0;
        _exit(!nowhere || !other || ld_study_show(in("others #1"), NULL, nowhere, &error) != LD_OK);
    }
    int result;
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_int_equal(result, 0);
    assert_int_equal(chmod(in("others #1"), 0755), 0);
    assert_int_not_equal(access(in("others #1/study.db-wal"), F_OK), 0);
    ld_study_free(study);
}

// A stopping rule is checked after 20 samples or five hypercubes, then after a quarter more each
// time, in whole hypercubes.
static void test_looks(void **state)
{
    (void)state;
    static const int64_t random[] = {20, 25, 32, 40, 50}, cubes[] = {80, 112, 144, 192, 240};
    const ld_scatter plain = {.samples = 1000, .replicates = 1};
    const ld_scatter lhs = {.samples = 320, .plan = LD_PLAN_LHS, .replicates = 20};
    int64_t at = 0, in_cubes = 0;
    for (int i = 0; i < 5; i++) {
        at = until_next_check(&plain, at);
        in_cubes = until_next_check(&lhs, in_cubes);
        assert_int_equal(at, random[i]);
        assert_int_equal(in_cubes, cubes[i]);
    }
    assert_int_equal(until_next_check(&plain, 900), 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_looks),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_parts_come_twice),
        cmocka_unit_test(test_stopped),
        cmocka_unit_test(test_removed),
        cmocka_unit_test(test_shards),
        cmocka_unit_test(test_one_sample_alone),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_stabilisers_are_shown),
        cmocka_unit_test(test_rockets_of_a_salvo),
        cmocka_unit_test(test_shown_to_others),
        cmocka_unit_test(test_size),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
