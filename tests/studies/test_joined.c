// A study that processes share by its folder, of which many are killed at any instant: the bits of
// one process, and little work lost. LD_JOINED_FLIGHTS: how many (default 20,000), on 50 processes.
// The processes are children, so that none inherits threads.
// ctest: slow
#include "support/study_run.h"

#include <dirent.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/random.h"
#include "studies/run/ranges.h"

enum { MOST = 64 };

static const char text[] = "include: flight.yaml\n"
                           "scatter:\n"
                           "  samples: 20000\n"
                           "  factors:\n"
                           "    rocket.mass_error: {normal: 0.1 kg}\n"
                           "    flight.attitude.pitch: {normal: 0.5 deg}\n";

static const char launches[] = "include: fixed.yaml\n"
                               "sweep: {rocket.mass: [59 kg, 61 kg]}\n"
                               "scatter:\n"
                               "  samples: 120\n"
                               "  until: {exit_speed.mean: 0.04 %}\n"
                               "  factors:\n"
                               "    rocket.mass_error: {normal: 0.2 kg}\n"
                               "    base.elevation: {normal: 1 deg}\n";

// What a process has run, which outlives it.
typedef struct worker_log {
    ld_study_counts counts;
    ld_status status;
    char reason[LD_ERROR_TEXT];
} worker_log;

static worker_log *logs; // [MOST], shared
static pid_t worker[MOST];

// Where processes wait for a kill that is due: once `count` of them have run `samples`, each goes
// on slowly, so that none ends the study before it is killed, whatever the machine's load.
typedef struct due_kill {
    int count;
    int64_t samples;
} due_kill;

static due_kill *due; // shared

static int64_t run_by_all(int count)
{
    int64_t run = 0;
    for (int i = 0; i < count; i++)
        run += logs[i].counts.now;
    return run;
}

static bool until_told(void *self)
{
    if (due->count && run_by_all(due->count) >= due->samples)
        usleep(50000);
    return getppid() == *(pid_t *)self; // with the test its processes end
}

static void start(const ld_study *study, const char *name, int number, double expiry)
{
    pid_t parent = getpid();
    memset(&logs[number], 0, sizeof logs[number]);
    worker[number] = fork();
    assert_true(worker[number] >= 0);
    if (worker[number] > 0)
        return;
    ld_error error = {0};
    ld_study_options options = {.expiry = expiry, .self = &parent, .go_on = until_told};
    worker_log *log = &logs[number];
    log->status = ld_study_join(study, in(name), &options, &log->counts, &error);
    snprintf(log->reason, sizeof log->reason, "%s", error.text);
    _exit(log->status ? 1 : 0);
}

// Waits for the end of one; whether it was killed.
static bool wait_for(int number)
{
    int status;
    assert_int_equal(waitpid(worker[number], &status, 0), worker[number]);
    if (!WIFSIGNALED(status) && status != 0)
        fail_msg("process %d: %s", number, logs[number].reason);
    return WIFSIGNALED(status);
}

// How many samples a folder keeps, with the sum of their digests and that of what is said once.
static void read_kept(const char *name, char kept[128])
{
    sqlite3 *database;
    sqlite3_stmt *select;
    char path[160];
    snprintf(path, sizeof path, "%s/study.db", in(name));
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(database, "SELECT value FROM study WHERE name = 'kept'", -1,
                                        &select, NULL),
                     SQLITE_OK);
    assert_int_equal(sqlite3_step(select), SQLITE_ROW);
    snprintf(kept, 128, "%s", (const char *)sqlite3_column_text(select, 0));
    sqlite3_finalize(select);
    sqlite3_close(database);
}

static void expect_same_kept(const char *one, const char *other)
{
    char a[128], b[128];
    read_kept(one, a);
    read_kept(other, b);
    printf("    kept: %s\n", a);
    assert_string_equal(a, b);
}

static bool is_there(const char *name, const char *file)
{
    char path[200];
    snprintf(path, sizeof path, "%s/%s", in(name), file);
    return access(path, F_OK) == 0;
}

static ld_study *flights(int64_t samples)
{
    char set[64];
    snprintf(set, sizeof set, "scatter.samples=%lld", (long long)samples);
    return study_with(text, set);
}

// ---- 30 % of 50 processes killed

static int64_t flights_wanted(void)
{
    return getenv("LD_JOINED_FLIGHTS") ? atoll(getenv("LD_JOINED_FLIGHTS")) : 20000;
}

// The instant of kill `i`: each in its turn, by chance, all in the first 85 %.
static int64_t kill_instant(int i, int kills, int64_t samples)
{
    double share = (i + random_uniform(21, 0, (uint64_t)i, 0, 0)) * 0.85 / kills;
    return (int64_t)(share * (double)samples);
}

// Kills process `victim` when all have run the samples that are due.
static bool kill_when_due(int victim)
{
    while (run_by_all(due->count) < due->samples)
        usleep(1000);
    kill(worker[victim], SIGKILL);
    return wait_for(victim);
}

static void test_killed(void **state)
{
    (void)state;
    enum { PROCESSES = 50, KILLS = 15 };
    const int64_t samples = flights_wanted();
    const double expiry = 20; // [s] longer than a machine under load keeps a process waiting
    ld_study *study = flights(samples);
    int killed = 0;
    *due = (due_kill){PROCESSES, kill_instant(0, KILLS, samples)};
    for (int i = 0; i < PROCESSES; i++)
        start(study, "joined", i, expiry);
    for (int i = 0; i < KILLS; i++) { // each third one
        killed += kill_when_due(3 * i + 1);
        due->samples = i + 1 < KILLS ? kill_instant(i + 1, KILLS, samples) : INT64_MAX;
    }
    for (int i = 0; i < PROCESSES; i++)
        if (i % 3 != 1 || i / 3 >= KILLS)
            wait_for(i);
    study_run(study, "one", 2);
    expect_same_kept("one", "joined");
    assert_false(is_there("joined", "ranges"));
    int64_t run = run_by_all(PROCESSES), lost = run - samples;
    printf("    %lld flights on %d processes, %d of them killed: %lld run in vain\n",
           (long long)samples, PROCESSES, killed, (long long)lost);
    assert_int_equal(killed, KILLS);
    CHECK_BELOW("share of the work lost with the processes", (double)lost / (double)samples, 0.01);
    ld_study_free(study);
}

// ---- its keeper killed, again and again; a process stopped for longer than the expiry

// Whether a process has the study's database open.
static bool is_keeper(pid_t process, const char *name)
{
    char path[64], entry[512], file[200], target[200];
    bool found = false;
    snprintf(path, sizeof path, "/proc/%d/fd", (int)process);
    snprintf(file, sizeof file, "%s/study.db", in(name));
    DIR *list = opendir(path);
    for (struct dirent *at; list && !found && (at = readdir(list));) {
        snprintf(entry, sizeof entry, "%s/%s", path, at->d_name);
        ssize_t length = readlink(entry, target, sizeof target - 1);
        target[length > 0 ? length : 0] = '\0';
        found = strcmp(target, file) == 0;
    }
    if (list)
        closedir(list);
    return found;
}

static void test_keepers_killed(void **state)
{
    (void)state;
    enum { PROCESSES = 5, KILLS = 3 };
    const int64_t samples = 20000;
    ld_study *study = flights(samples);
    bool gone[PROCESSES] = {false};
    int kills = 0;
    *due = (due_kill){PROCESSES, 2000};
    for (int i = 0; i < PROCESSES; i++)
        start(study, "keepers", i, 2);
    for (; kills < KILLS && run_by_all(PROCESSES) < samples; usleep(1000)) {
        for (int i = 0; i < PROCESSES && run_by_all(PROCESSES) >= due->samples; i++)
            if (!gone[i] && is_keeper(worker[i], "keepers")) {
                kill(worker[i], SIGKILL);
                gone[i] = wait_for(i);
                kills += gone[i];
                due->samples = kills < KILLS ? run_by_all(PROCESSES) + 2000 : INT64_MAX;
            }
    }
    for (int i = 0; i < PROCESSES; i++)
        if (!gone[i])
            wait_for(i);
    printf("    %d keepers killed\n", kills);
    assert_int_equal(kills, KILLS);
    study_run(study, "one", 2);
    if (samples == flights_wanted())
        expect_same_kept("one", "keepers");
    ld_study_free(study);
}

static void test_stopped(void **state)
{
    (void)state;
    const int64_t samples = 6000;
    ld_study *study = flights(samples);
    for (int i = 0; i < 3; i++)
        start(study, "stopped", i, 1);
    while (run_by_all(3) < samples / 4)
        usleep(1000);
    kill(worker[0], SIGSTOP);
    usleep(2000000);
    kill(worker[0], SIGCONT);
    for (int i = 0; i < 3; i++)
        assert_false(wait_for(i));
    study_run(study, "few", 2);
    expect_same_kept("few", "stopped");
    ld_study_free(study);
}

// ---- a stopping rule over a sweep of launches, two of whose processes are killed

static void test_rule(void **state)
{
    (void)state;
    ld_study *study = study_of(launches);
    ld_study_counts alone = study_run(study, "rule-one", 2);
    for (int i = 0; i < 4; i++)
        start(study, "rule", i, 1);
    for (int i = 0; i < 2; i++) {
        while (run_by_all(4) < 15 * (i + 1))
            usleep(1000);
        kill(worker[i], SIGKILL);
        wait_for(i);
    }
    wait_for(2);
    wait_for(3);
    assert_true(alone.enough);
    assert_true(alone.samples > 50 && alone.samples < 240);
    assert_true(logs[3].counts.enough);
    assert_int_equal(logs[2].counts.samples, alone.samples);
    assert_int_equal(logs[3].counts.done, alone.samples);
    expect_same_tables("rule-one", "rule");
    expect_same_kept("rule-one", "rule");
    ld_study_free(study);
}

// ---- stopped, continued, refused

static bool never(void *self)
{
    const int64_t *now = self;
    return *now < 300;
}

static void test_interrupted(void **state)
{
    (void)state;
    ld_study *study = flights(2000), *other = study_with(text, "scatter.seed=2");
    ld_error error;
    ld_study_counts counts;
    ld_study_options options = {.self = &counts.now, .go_on = never};
    assert_int_equal(ld_study_join(study, in("begun"), &options, &counts, &error),
                     LD_ERR_INTERRUPTED);
    printf("    %s\n", error.text);
    // what was run is kept, also of ranges that were not finished
    assert_int_equal(counts.done, counts.now);
    assert_true(counts.now >= 300);
    const int64_t begun = counts.now;
    assert_int_equal(ld_study_join(other, in("begun"), NULL, &counts, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "another scenario"));
    assert_false(is_there("begun", "ranges/state"));
    assert_int_equal(ld_study_join(study, in("begun"), NULL, &counts, &error), LD_OK);
    assert_int_equal(counts.done, 2000);
    assert_int_equal(counts.now, 2000 - begun);
    assert_int_equal(ld_study_join(study, in("begun"), NULL, &counts, &error), LD_OK);
    assert_int_equal(counts.now, 0);
    assert_false(is_there("begun", "ranges"));
    study_run(study, "begun-one", 1);
    expect_same_kept("begun-one", "begun");
    ld_study_free(study);
    ld_study_free(other);
}

// Another study is refused while one is at work.
static void test_another_at_work(void **state)
{
    (void)state;
    ld_study *study = flights(200000), *other = flights(100000);
    ld_error error;
    ld_study_counts counts;
    start(study, "busy", 0, 2);
    while (logs[0].counts.now < 100)
        usleep(1000);
    assert_int_equal(ld_study_join(other, in("busy"), NULL, &counts, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "another study"));
    assert_int_equal(ld_study_run(study, in("busy"), NULL, &counts, &error), LD_ERR_INPUT);
    kill(worker[0], SIGKILL);
    assert_true(wait_for(0));
    ld_study_free(study);
    ld_study_free(other);
}

// A part that is not whole, and one of another study, are as if they were not there.
static void test_foreign_parts(void **state)
{
    (void)state;
    ld_study *study = flights(50);
    ld_error error;
    ld_study_counts counts;
    char path[200];
    snprintf(path, sizeof path, "mkdir -p %s/ranges", in("foreign"));
    assert_int_equal(system(path), 0);
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/ranges/%06d.part", in("foreign"), 7 + i);
        FILE *stream = fopen(path, "w");
        assert_non_null(stream);
        fputs(i ? "" : "ldpart1, but no more than that: too short a text", stream);
        fclose(stream);
    }
    assert_int_equal(ld_study_join(study, in("foreign"), NULL, &counts, &error), LD_OK);
    assert_int_equal(counts.now, 50);
    assert_false(is_there("foreign", "ranges"));
    ld_study_free(study);
}

// ---- the ranges

static void test_ranges(void **state)
{
    (void)state;
    ld_study *study = flights(20001), *ruled = study_of(launches);
    study_ranges ranges;
    ld_error error;
    assert_int_equal(ranges_create(&ranges, study, &error), LD_OK);
    int64_t next = 1, longest = 0;
    for (int i = 0; i < ranges.count; i++) {
        const sample_range *range = &ranges.item[i];
        assert_int_equal(range->first, next);
        assert_int_equal(ranges_find(&ranges, range->first), i);
        assert_int_equal(ranges_find(&ranges, range->last), i);
        next = range->last + 1;
        longest = next - range->first > longest ? next - range->first : longest;
    }
    assert_int_equal(next, 20002);
    assert_int_equal(longest, 6);
    assert_int_equal(ranges_find(&ranges, next), ranges.count);
    assert_int_equal(ranges_find(&ranges, 0), ranges.count);
    CHECK_BELOW("ranges of a study", ranges.count, 4000.5);
    ranges_free(&ranges);
    // of 2 points the rule is checked after 40 samples first, then after 50
    assert_int_equal(ranges_create(&ranges, ruled, &error), LD_OK);
    int at = ranges_find(&ranges, 40);
    assert_int_equal(ranges.item[at].last, 40);
    assert_int_equal(ranges.item[at + 1].first, 41);
    assert_int_equal(ranges.item[ranges.count - 1].last, 240);
    ranges_free(&ranges);
    ld_study_free(study);
    ld_study_free(ruled);
}

static void *shared_memory(size_t size)
{
    void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(memory != MAP_FAILED);
    return memory;
}

static int make_logs(void **state)
{
    logs = shared_memory(MOST * sizeof *logs);
    due = shared_memory(sizeof *due);
    return scratch_make(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ranges),
                                       cmocka_unit_test(test_killed),
                                       cmocka_unit_test(test_keepers_killed),
                                       cmocka_unit_test(test_stopped),
                                       cmocka_unit_test(test_rule),
                                       cmocka_unit_test(test_interrupted),
                                       cmocka_unit_test(test_another_at_work),
                                       cmocka_unit_test(test_foreign_parts)};
    return cmocka_run_group_tests(tests, make_logs, scratch_remove);
}
