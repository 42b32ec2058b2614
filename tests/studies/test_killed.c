// Studies killed at any instant: what was kept stays, and the rest comes out the same. LD_KILLS:
// how often (default 6). The study runs in children only, so that none inherits threads.
#include "support/study_run.h"

#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/random.h"

enum { SAMPLES = 80, THREADS = 2 };

static int set_up(void **state)
{
    (void)state;
    return scratch_make();
}

static int tear_down(void **state)
{
    (void)state;
    return scratch_remove();
}

static const char text[] = "include: fixed.yaml\n"
                           "scatter:\n"
                           "  samples: 80\n"
                           "  factors:\n"
                           "    rocket.mass_error: {normal: 0.2 kg}\n"
                           "    base.elevation: {normal: 1 deg}\n";

static int report_to; // descriptor

// After each commit.
static void report(void *self, const ld_study_counts *counts)
{
    (void)self;
    if (write(report_to, &counts->done, sizeof counts->done) != sizeof counts->done)
        _exit(3);
}

// Runs the study in a child, which reports how many samples are kept.
static pid_t start(const ld_study *study, const char *name, int threads, int *reports)
{
    int pipe_ends[2];
    assert_int_equal(pipe(pipe_ends), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        ld_error error;
        ld_study_counts counts;
        ld_study_options options = {.threads = threads, .progress = report};
        report_to = pipe_ends[1];
        _exit(ld_study_run(study, in(name), &options, &counts, &error) != LD_OK);
    }
    close(pipe_ends[1]);
    *reports = pipe_ends[0];
    return child;
}

static int64_t drain(int reports)
{
    int64_t done, last = 0;
    while (read(reports, &done, sizeof done) == sizeof done)
        last = done;
    close(reports);
    return last;
}

static void run_to_its_end(const ld_study *study, const char *name, int threads)
{
    int reports, status;
    pid_t child = start(study, name, threads, &reports);
    drain(reports);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
}

// Which samples the database holds: kept[number].
static void read_kept(const char *name, bool kept[SAMPLES + 1])
{
    sqlite3 *database;
    sqlite3_stmt *select;
    char path[160];
    snprintf(path, sizeof path, "%s/study.db", in(name));
    memset(kept, 0, SAMPLES + 1);
    if (access(path, R_OK) != 0)
        return;
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    if (sqlite3_prepare_v2(database, "SELECT sample FROM sample", -1, &select, NULL) == SQLITE_OK)
        while (sqlite3_step(select) == SQLITE_ROW)
            kept[sqlite3_column_int64(select, 0)] = true;
    sqlite3_finalize(select);
    sqlite3_close(database);
}

static void test_killed(void **state)
{
    (void)state;
    ld_study *study = study_of(text);
    bool before[SAMPLES + 1] = {0}, after[SAMPLES + 1];
    int kills = getenv("LD_KILLS") ? atoi(getenv("LD_KILLS")) : 6, hit = 0;
    int64_t lost = 0, repeated = 0, most = 0;
    run_to_its_end(study, "whole", 1);
    for (int i = 0; i < kills; i++) {
        int reports;
        pid_t child = start(study, "killed", THREADS, &reports);
        // so that on the average all kills together leave a little to be done
        double u = random_uniform(11, 0, (uint64_t)i, 0, 0);
        int64_t wanted = (int64_t)(u * 2 * SAMPLES / kills), done;
        while (wanted-- > 0 && read(reports, &done, sizeof done) == sizeof done)
            ;
        usleep((useconds_t)(1e4 * random_uniform(12, 0, (uint64_t)i, 0, 0)));
        kill(child, SIGKILL);
        int64_t reported = drain(reports), count = 0, last = 0;
        int status;
        waitpid(child, &status, 0);
        hit += WIFSIGNALED(status);
        read_kept("killed", after);
        for (int k = 1; k <= SAMPLES; k++) {
            lost += before[k] && !after[k];
            count += after[k];
            last = after[k] ? k : last;
        }
        // what was said to be kept is there; of the numbers handed out in rising order only those
        // that were running are missing
        lost += reported > count ? reported - count : 0;
        repeated += last - count;
        most = last - count > most ? last - count : most;
        memcpy(before, after, sizeof after);
    }
    printf("    killed %d times while at work, of %d\n", hit, kills);
    CHECK_BELOW("samples lost after they were kept", (double)lost, 0.5);
    CHECK_BELOW("gaps below the last one kept, the most", (double)most, THREADS - 0.5);
    printf("    %lld such gaps in all\n", (long long)repeated);
    assert_true(hit >= kills / 2);
    run_to_its_end(study, "killed", THREADS);
    expect_same_tables("whole", "killed");
    ld_study_free(study);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_killed)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
