// Locks that keep a second program away: held, waited for, given up, removed under whoever waits.
#include "support/check.h"
#include "support/scratch.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/child.h"
#include "base/lock_file.h"

// The waits of this program take no time; the holder ends within one of them.
static struct {
    int count, at;  // of the waits so far; in which one the holder ends
    double seconds; // that were asked for
    int held;       // the holder's lock
    bool removes;   // the holder's way to end
} waits;

static void end_holder(void)
{
    if (waits.removes)
        lock_file_remove(in("x.lock"), waits.held);
    else
        lock_file_release(waits.held);
}

int nanosleep(const struct timespec *asked, struct timespec *left)
{
    (void)left;
    waits.seconds += (double)asked->tv_sec + 1e-9 * (double)asked->tv_nsec;
    if (++waits.count == waits.at)
        end_holder();
    return 0;
}

// What the file system answers where it is asked for a lock; 0: it knows locks.
static int no_locks;
static bool ends_before; // the holder ends after the file was opened

int flock(int file, int operation)
{
    bool ends = ends_before;
    ends_before = false;
    if (ends)
        end_holder();
    errno = no_locks;
    return no_locks ? -1 : (int)syscall(SYS_flock, file, operation);
}

static int take(void)
{
    int lock;
    ld_error error = {.text = ""};
    ld_status status = lock_file_take(in("x.lock"), "x", &lock, &error);
    if (status)
        fail_msg("%s", error.text);
    assert_true(lock >= 0);
    return lock;
}

static void expect_refused(ld_status expected, const char *text)
{
    int lock;
    ld_error error = {.text = ""};
    assert_int_equal(lock_file_take(in("x.lock"), "DIR/x", &lock, &error), expected);
    assert_int_equal(lock, -1);
    if (!strstr(error.text, text))
        fail_msg("\"%s\" does not say \"%s\"", error.text, text);
}

static void test_held(void **state)
{
    (void)state;
    int lock = take();
    waits.count = waits.at = 0;
    waits.seconds = 0;
    expect_refused(LD_ERR_INPUT, "another launchdyn process uses DIR/x: wait until it ends");
    CHECK_WITHIN("wait for a lock that stays held [s]", waits.seconds, 1.999, 2.001);
    int second;
    assert_int_equal(lock_file_try(in("x.lock"), "x", &second, NULL), LD_ERR_INPUT);
    lock_file_release(lock);
    lock_file_release(take());
}

static void test_given_up_meanwhile(void **state)
{
    (void)state;
    for (int removes = 0; removes < 2; removes++) {
        waits.held = take();
        waits.removes = removes;
        waits.count = 0;
        waits.at = 3;
        int lock = take();
        assert_int_equal(waits.count, 3);
        // it is the lock of the file that is there now
        int second;
        assert_int_equal(lock_file_try(in("x.lock"), "x", &second, NULL), LD_ERR_INPUT);
        lock_file_remove(in("x.lock"), lock);
        assert_int_not_equal(access(in("x.lock"), F_OK), 0);
    }
    // removed between opening and locking: what was opened is no one's any more
    waits.held = take();
    ends_before = true;
    int lock = take(), second;
    assert_int_equal(lock_file_try(in("x.lock"), "x", &second, NULL), LD_ERR_INPUT);
    lock_file_remove(in("x.lock"), lock);
}

// A process that its holder has forked does not hold it beyond the holder's end.
static void test_forked(void **state)
{
    (void)state;
    int status, ends[2], begins[2];
    char sign;
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(pipe(begins), 0);
    pid_t holder = fork();
    assert_true(holder >= 0);
    if (holder == 0) {
        take();
        if (fork() == 0) {
            close(ends[1]);
            _exit(write(begins[1], "", 1) != 1 ||
                  read(ends[0], &sign, 1) != 0); // until the test closes its end
        }
        _exit(0);
    }
    assert_int_equal(waitpid(holder, &status, 0), holder);
    assert_int_equal(read(begins[0], &sign, 1), 1);
    int lock;
    ld_error error;
    assert_int_equal(lock_file_try(in("x.lock"), "x", &lock, &error), LD_OK);
    lock_file_remove(in("x.lock"), lock);
    for (int i = 0; i < 2; i++) {
        close(ends[i]);
        close(begins[i]);
    }
}

static void test_no_lock_to_be_had(void **state)
{
    (void)state;
    static const int answers[] = {ENOSYS, ENOLCK, EOPNOTSUPP};
    waits.count = 0;
    for (int i = 0; i < 3; i++) {
        no_locks = answers[i];
        expect_refused(LD_ERR_MISSING, "cannot lock ");
        assert_int_not_equal(access(in("x.lock"), F_OK), 0);
    }
    no_locks = EIO;
    expect_refused(LD_ERR_FILE, "x.lock: Input/output error");
    no_locks = 0;
    assert_int_equal(waits.count, 0);
    int lock;
    ld_error error;
    assert_int_equal(lock_file_take(in("none/x.lock"), "x", &lock, &error), LD_ERR_FILE);
    lock_file_remove(in("none/x.lock"), lock); // nothing
}

// ---- what a child leaves that is killed at work

// Another process that takes the lock over: where it is asked to, where it answers.
typedef struct rival {
    int asked[2], answers[2];
} rival;

static void say(const int way[2])
{
    assert_int_equal(write(way[1], "", 1), 1);
}

static void hear(const int way[2])
{
    char word;
    assert_int_equal(read(way[0], &word, 1), 1);
}

static int die_at_work(void *data)
{
    const rival *other = data;
    int lock;
    if (lock_file_take(in("x.lock"), "x", &lock, NULL))
        return 1;
    child_locks(in("x.lock"));
    child_writes(in("x.part"));
    fclose(fopen(in("x.part"), "w"));
    if (other) { // it takes the lock over before the parent comes to it
        lock_file_release(lock);
        say(other->asked);
        hear(other->answers);
    }
    kill(getpid(), SIGKILL);
    return 0;
}

static void expect_left(rival *other, int found)
{
    int code;
    assert_int_equal(ld_child_run(die_at_work, other, &code, NULL), LD_ERR_FILE);
    assert_int_equal(access(in("x.part"), F_OK), found);
    assert_int_equal(access(in("x.lock"), F_OK), found);
}

static void test_left_by_a_child(void **state)
{
    (void)state;
    int status;
    rival other;
    expect_left(NULL, -1);
    // with a rival the files are the rival's
    assert_int_equal(pipe(other.asked), 0);
    assert_int_equal(pipe(other.answers), 0);
    pid_t process = fork();
    if (process == 0) {
        hear(other.asked);
        take();
        say(other.answers);
        hear(other.asked); // holds it
        _exit(0);
    }
    expect_left(&other, 0);
    say(other.asked);
    waitpid(process, &status, 0);
    assert_int_equal(status, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_held),
        cmocka_unit_test(test_given_up_meanwhile),
        cmocka_unit_test(test_forked),
        cmocka_unit_test(test_no_lock_to_be_had),
        cmocka_unit_test(test_left_by_a_child),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
