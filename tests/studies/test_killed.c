// Studies killed at any instant: what was kept stays, and the rest comes out the same. LD_KILLS:
// how often while at work (default 6). The study runs in children only, so that none inherits
// threads.
// ctest: slow
#include "support/study_run.h"

#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/random.h"

enum { SAMPLES = 80, THREADS = 2 };

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

static bool no_more(void *self)
{
    (void)self;
    return false;
}

// Which samples folder "killed" holds: kept[number]. Opening it settles what was left, as soon as
// the last process has ended, however long that takes.
static void read_kept(const ld_study *study, bool kept[SAMPLES + 1])
{
    sqlite3 *database;
    sqlite3_stmt *select;
    char path[160];
    ld_error error;
    ld_study_counts counts;
    ld_study_options none = {.go_on = no_more};
    ld_status status;
    while ((status = ld_study_run(study, in("killed"), &none, &counts, &error)) == LD_ERR_INPUT)
        usleep(10000);
    assert_true(status == LD_OK || status == LD_ERR_INTERRUPTED);
    snprintf(path, sizeof path, "%s/study.db", in("killed"));
    memset(kept, 0, SAMPLES + 1);
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(database, "SELECT sample FROM sample", -1, &select, NULL),
                     SQLITE_OK);
    while (sqlite3_step(select) == SQLITE_ROW)
        kept[sqlite3_column_int64(select, 0)] = true;
    sqlite3_finalize(select);
    sqlite3_close(database);
}

// What the kills of a study have shown.
typedef struct kill_log {
    bool kept[SAMPLES + 1];
    int64_t lost, gaps, most_gaps;
    int hit;         // kills while it was at work
    int missed;      // those that came after its end
    double patience; // share of the time to wait before the next one
} kill_log;

static void remove_killed(void)
{
    char command[160];
    snprintf(command, sizeof command, "rm -r %s", in("killed"));
    assert_int_equal(system(command), 0);
}

// After a kill; `reported`: samples that were said to be kept. One that came too late says nothing:
// the study begins again, and the next kill comes earlier, down to at once.
static void look(kill_log *log, const ld_study *study, bool hit, int64_t reported)
{
    bool now[SAMPLES + 1];
    int64_t count = 0, last = 0;
    read_kept(study, now);
    for (int k = 1; k <= SAMPLES; k++) {
        log->lost += log->kept[k] && !now[k];
        count += now[k];
        last = now[k] ? k : last;
    }
    // of the numbers, handed out in rising order, only those that were running are missing
    log->lost += reported > count ? reported - count : 0;
    log->gaps += last - count;
    log->most_gaps = last - count > log->most_gaps ? last - count : log->most_gaps;
    memcpy(log->kept, now, sizeof now);
    log->hit += hit;
    log->missed += !hit;
    if (count == SAMPLES) {
        remove_killed();
        memset(log->kept, 0, sizeof log->kept);
    }
    log->patience *= hit ? 1 : 0.7;
}

static void check_log(const kill_log *log, int workers)
{
    printf("    killed %d times while at work, %d times after; %lld gaps in all\n", log->hit,
           log->missed, (long long)log->gaps);
    CHECK_BELOW("samples lost after they were kept", (double)log->lost, 0.5);
    CHECK_BELOW("gaps below the last one kept, the most", (double)log->most_gaps, workers - 0.5);
}

static int kills(void)
{
    return getenv("LD_KILLS") ? atoi(getenv("LD_KILLS")) : 6;
}

static void test_threads_killed(void **state)
{
    (void)state;
    ld_study *study = study_of(text);
    kill_log log = {.patience = 1};
    run_to_its_end(study, "whole", 1);
    for (uint64_t i = 0; log.hit < kills(); i++) {
        int reports, status;
        pid_t child = start(study, "killed", THREADS, &reports);
        // so that on the average all kills together leave a little to be done
        double u = log.patience * random_uniform(11, 0, i, 0, 0);
        int64_t wanted = (int64_t)(u * 2 * SAMPLES / kills()), done;
        while (wanted-- > 0 && read(reports, &done, sizeof done) == sizeof done)
            ;
        usleep((useconds_t)(1e4 * log.patience * random_uniform(12, 0, i, 0, 0)));
        kill(child, SIGKILL);
        int64_t reported = drain(reports);
        waitpid(child, &status, 0);
        look(&log, study, WIFSIGNALED(status), reported);
    }
    check_log(&log, THREADS);
    run_to_its_end(study, "killed", THREADS);
    expect_same_tables("whole", "killed");
    ld_study_free(study);
}

static void end_at_once(void *self, const ld_study_counts *counts)
{
    (void)self;
    if (counts->done == 2)
        raise(SIGKILL);
}

// What waits for its commit is not taken for another study's, whose database was taken away.
static void test_pending_of_another_study(void **state)
{
    (void)state;
    ld_study *study = study_of(text), *other = study_with(text, "scatter.seed=2");
    char command[160];
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        ld_error error;
        ld_study_counts counts;
        ld_study_options options = {.threads = 1, .progress = end_at_once};
        ld_study_run(study, in("left"), &options, &counts, &error);
        _exit(0);
    }
    int status;
    waitpid(child, &status, 0);
    assert_true(WIFSIGNALED(status));
    snprintf(command, sizeof command, "cd %s && test -s study.pending && rm study.db*", in("left"));
    assert_int_equal(system(command), 0);
    run_to_its_end(other, "left", THREADS);
    run_to_its_end(other, "other", THREADS);
    expect_same_tables("other", "left");
    ld_study_free(study);
    ld_study_free(other);
}

// ---- processes of MPI

static pid_t start_mpi(const char *file)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
        setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
        setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
        setenv("TMPDIR", folder, 1); // its own folders outlive it
        setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 1);
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
        if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr))
            _exit(1);
        execlp("mpirun", "mpirun", "-n", "3", LD_BINARY_DIR "/launchdyn-mpi", "study", file,
               "--quiet", "--out", in("killed"), (char *)NULL);
        _exit(1);
    }
    return child;
}

static int children_of(pid_t parent, int process[8])
{
    char command[64];
    int count = 0;
    snprintf(command, sizeof command, "pgrep -P %d", parent);
    FILE *list = popen(command, "r");
    assert_non_null(list);
    while (count < 8 && fscanf(list, "%d", &process[count]) == 1)
        count++;
    pclose(list);
    return count;
}

// Kills mpirun and what it has started, some microseconds after it has; returns whether it was at
// work.
static bool kill_mpi(pid_t launcher, useconds_t after)
{
    int process[8], status;
    while (children_of(launcher, process) == 0) {
        if (waitpid(launcher, &status, WNOHANG) == launcher)
            return false;
        usleep(10000);
    }
    usleep(after);
    int count = children_of(launcher, process);
    kill(launcher, SIGKILL);
    for (int i = 0; i < count; i++)
        kill(process[i], SIGKILL);
    waitpid(launcher, &status, 0);
    return WIFSIGNALED(status);
}

static void test_processes_killed(void **state)
{
    (void)state;
    if (access(LD_BINARY_DIR "/launchdyn-mpi", X_OK) != 0 ||
        system("command -v mpirun pgrep >/dev/null") != 0)
        skip();
    ld_study *study = study_of(text);
    kill_log log = {.patience = 1};
    char file[160];
    snprintf(file, sizeof file, "%s.yaml", in("killed"));
    FILE *stream = fopen(file, "w");
    assert_non_null(stream);
    fprintf(stream, "include: %s/examples/%s", LD_SOURCE_DIR, strchr(text, ' ') + 1);
    fclose(stream);
    remove_killed();
    for (uint64_t i = 0; log.hit < kills(); i++) {
        double after = 1e6 * log.patience * random_uniform(13, 0, i, 0, 0);
        bool hit = kill_mpi(start_mpi(file), (useconds_t)after);
        look(&log, study, hit, 0);
    }
    check_log(&log, 3);
    run_to_its_end(study, "killed", THREADS);
    expect_same_tables("whole", "killed");
    ld_study_free(study);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_threads_killed),
                                       cmocka_unit_test(test_pending_of_another_study),
                                       cmocka_unit_test(test_processes_killed)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
