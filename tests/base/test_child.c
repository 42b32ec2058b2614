// Work in a process of its own: what it gives back, how it ends, what it leaves.
#include "support/check.h"
#include "support/scratch.h"

#include <signal.h>
#include <stdbool.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/child.h"

static int count_up(void *data)
{
    int *number = data;
    return ++*number;
}

static void test_its_code_comes_back(void **state)
{
    (void)state;
    int number = 41, code = 0;
    ld_error error;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(ld_child_run(count_up, &number, &code, &error), LD_OK);
        assert_int_equal(code, 42);
        assert_int_equal(number, 41); // its memory is a copy
    }
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); // none is left
}

// What a child does before a signal ends it.
typedef struct end {
    const char *read, *first, *second; // NULL: no such file
    int signal;
    bool to_parent;
} end;

static void make(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fclose(file), 0);
}

static int come_to_an_end(void *data)
{
    const end *self = data;
    if (self->first) {
        child_writes(self->first);
        make(self->first);
    }
    if (self->second) {
        child_writes(self->second);
        make(self->second);
        child_wrote(self->second);
    }
    child_reads(self->read);
    signal(self->signal, SIG_DFL); // a sanitizer has its own
    kill(self->to_parent ? getppid() : getpid(), self->signal);
    pause();
    return 0;
}

static void expect_end(end how, ld_status status, int code, const char *text)
{
    int found = 0;
    ld_error error = {.text = ""};
    assert_int_equal(ld_child_run(come_to_an_end, &how, &found, &error), status);
    assert_string_equal(error.text, text);
    if (code)
        assert_int_equal(found, code);
    if (how.first)
        assert_int_not_equal(access(how.first, F_OK), 0);
    if (how.second)
        assert_int_equal(access(how.second, F_OK), 0);
}

static void test_ended_by_a_signal(void **state)
{
    (void)state;
    char text[256];
    expect_end((end){.signal = SIGSEGV}, LD_ERR_FILE, 0, "ended by signal 11 (Segmentation fault)");
    expect_end((end){.signal = SIGKILL, .read = "a/history.h5"}, LD_ERR_FILE, 0,
               "ended by signal 9 (Killed) while reading a/history.h5: the file is damaged, or "
               "memory ran out");
    const char *first = in("first.part"), *second = in("second");
    snprintf(text, sizeof text, "ended by signal 6 (Aborted) while writing %s", first);
    expect_end((end){.signal = SIGABRT, .first = first, .second = second}, LD_ERR_FILE, 0, text);
}

static void test_asked_to_end(void **state)
{
    (void)state;
    static const int numbers[] = {SIGHUP, SIGINT, SIGTERM};
    for (int i = 0; i < 3; i++)
        for (int to_parent = 0; to_parent < 2; to_parent++)
            expect_end((end){.signal = numbers[i], .to_parent = to_parent, .first = in("x.part")},
                       LD_OK, 128 + numbers[i], "");
}

// One that this process ignores is not a wish to end.
static int ask_parent(void *data)
{
    (void)data;
    kill(getppid(), SIGHUP);
    kill(getpid(), SIGHUP);
    return 7;
}

static void test_ignored(void **state)
{
    (void)state;
    int code = 0;
    signal(SIGHUP, SIG_IGN);
    signal(SIGCHLD, SIG_IGN); // as who started us may have left it
    assert_int_equal(ld_child_run(ask_parent, NULL, &code, NULL), LD_OK);
    assert_int_equal(code, 7);
    assert_ptr_equal(signal(SIGCHLD, SIG_DFL), SIG_IGN);
    signal(SIGHUP, SIG_DFL);
}

// One that this process ignores, as a shell's job in the background does, and the child does not.
static int wait_to_be_asked(void *data)
{
    sigset_t asked;
    (void)data;
    signal(SIGINT, SIG_DFL);
    sigemptyset(&asked);
    sigaddset(&asked, SIGINT);
    sigprocmask(SIG_BLOCK, &asked, NULL);
    kill(getppid(), SIGINT);
    return sigtimedwait(&asked, NULL, &(struct timespec){10, 0}) == SIGINT ? 7 : 8;
}

static void test_ignored_here_alone(void **state)
{
    (void)state;
    int code = 0;
    signal(SIGINT, SIG_IGN);
    assert_int_equal(ld_child_run(wait_to_be_asked, NULL, &code, NULL), LD_OK);
    assert_int_equal(code, 7);
    assert_ptr_equal(signal(SIGINT, SIG_DFL), SIG_IGN);
}

static void test_in_no_child(void **state)
{
    (void)state;
    child_writes("x");
    child_reads("y");
    child_wrote("x");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_its_code_comes_back), cmocka_unit_test(test_ended_by_a_signal),
        cmocka_unit_test(test_asked_to_end),        cmocka_unit_test(test_ignored),
        cmocka_unit_test(test_ignored_here_alone),  cmocka_unit_test(test_in_no_child),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
