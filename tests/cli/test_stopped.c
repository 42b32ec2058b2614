// A signal that ends a command while it writes: its code, and no file under its temporary name
// left. What ends a study's process from within: a sentence, and the study continues.
#include "support/check.h"
#include "support/shell.h"

#include <errno.h>

#ifndef LD_SANITIZED // which bring an allocator of their own
// Starts a line that writes `file`, and sends it a signal while it does. It does not come further
// than to giving the file its name, at any speed.
static void expect_stopped(const char *line, const char *file, const char *signal, int code)
{
    char whole[512];
    snprintf(whole, sizeof whole,
             "env --default-signal=INT LD_PRELOAD=" LD_BINARY_DIR "/tests/libfailing_calls.so "
             "FAIL_KIND=rename FAIL_AT=1 FAIL_ERROR=wait launchdyn %s & "
             "until [ -e %s.part ]; do sleep 0.01; done; kill -%s $!; wait $!",
             line, file, signal);
    if (run(whole) != code)
        fail_msg("%s: code %d in place of %d, \"%s\"", whole, shell.code, code, shell.err);
    snprintf(whole, sizeof whole, "ls %s %s.part 2>/dev/null", file, file);
    run(whole);
    assert_string_equal(shell.out, "");
}

static void test_writing(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out a --quiet"), 0);
    assert_int_equal(
        run("{ echo 'include: examples/flight.yaml'; echo 'run: {end: 1 ms}'; echo 'scatter: "
            "{samples: 1000, factors: {rocket.mass_error: {normal: 0.2 kg}}}'; } "
            ">study.yaml; launchdyn study study.yaml --out s --quiet"),
        0);
    static const struct {
        const char *signal;
        int code;
    } ends[] = {{"TERM", 143}, {"INT", 130}, {"HUP", 129}};
    for (int i = 0; i < 3; i++) {
        const char *signal = ends[i].signal;
        expect_stopped("plot a --what all -o x.svg", "x.svg", signal, ends[i].code);
        expect_stopped("report a", "a/report.html", signal, ends[i].code);
        expect_stopped("study export s --csv x.csv", "x.csv", signal, ends[i].code);
    }
    // a lock that is held at first, as by a process that was killed and has not ended yet
    static const char *const waiting[] = {"study study.yaml --out s",
                                          "run examples/fixed.yaml --out a"};
    for (int i = 0; i < 2; i++) {
        char line[512];
        snprintf(line, sizeof line,
                 "LD_PRELOAD=" LD_BINARY_DIR "/tests/libfailing_calls.so FAIL_KIND=lock FAIL_AT=1 "
                 "FAIL_ERROR=%d launchdyn %s --quiet",
                 EWOULDBLOCK, waiting[i]);
        if (run(line) != 0)
            fail_msg("%s: code %d, \"%s\"", line, shell.code, shell.err);
    }
}
#endif

#define STUDY                                                                                      \
    "{ echo 'include: examples/flight.yaml'; echo 'run: {end: 1 ms}'; echo 'scatter: {samples: "   \
    "20000, factors: {rocket.mass_error: {normal: 0.2 kg}}}'; } >study.yaml; "

// While the study is at work its process is killed: a crash would go to a sanitizer first.
#define AND_ITS_PROCESS_DIES                                                                       \
    " & until [ -s s/study.pending ]; do sleep 0.01; done; pkill -KILL -P $!; wait $!"

static void test_study_that_dies(void **state)
{
    (void)state;
    if (run("command -v pkill") != 0)
        skip();
    run(STUDY "launchdyn study study.yaml -j 2 --out s" AND_ITS_PROCESS_DIES);
    assert_int_equal(shell.code, 3);
    assert_string_equal(shell.out, "");
    assert_string_equal(shell.err, "launchdyn: ended by signal 9 (Killed)\n");
    // some are kept, by how fast it was; some more are asked for
    run("kept=$(launchdyn study show s | sed -n 's/ of 20000 samples.*//p'); more=$((kept + 500)); "
        "launchdyn study study.yaml --out s --set scatter.samples=$more --quiet; "
        "launchdyn study show s | grep -c \"^$more of $more samples, 0 failed\"");
    assert_int_equal(shell.code, 0);
    assert_string_equal(shell.out, "1\n");
}

// The folder in which a study keeps its samples goes while it is at work, or gets another name: it
// is given, and what has another name continues there.
static void test_study_whose_folder_goes(void **state)
{
    (void)state;
    static const char *const ways[] = {"rm -r s", "mv s t"};
    for (int i = 0; i < 2; i++) {
        char line[512];
        snprintf(line, sizeof line,
                 STUDY "launchdyn study study.yaml --quiet --out s --set scatter.samples=1000000 & "
                       "until [ -s s/study.pending ]; do sleep 0.01; done; %s; wait $!",
                 ways[i]);
        run(line);
        assert_int_equal(shell.code, 3);
        assert_string_equal(shell.out, "");
        assert_string_equal(shell.err, "launchdyn: cannot write s/study.db: another program has "
                                       "removed or moved it\n");
    }
    assert_int_equal(run("[ ! -e s ] && launchdyn study study.yaml --out t --quiet "
                         "--set scatter.samples=100 && launchdyn study show t >/dev/null"),
                     0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifndef LD_SANITIZED
        cmocka_unit_test_setup_teardown(test_writing, shell_make, shell_remove),
#endif
        cmocka_unit_test_setup_teardown(test_study_that_dies, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(test_study_whose_folder_goes, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
