// A signal that ends a command while it writes: its code, and no file under its temporary name
// left. What ends a study's process from within: a sentence, and the study goes on.
#include "support/check.h"
#include "support/shell.h"

// Starts a line that writes `file`, and sends it a signal while it does. Its temporary file is a
// pipe that is opened and not read: the line comes to that, and not further, at any speed.
static void expect_stopped(const char *line, const char *file, const char *signal, int code)
{
    char whole[512];
    snprintf(whole, sizeof whole,
             "mkfifo %s.part; env --default-signal=INT launchdyn %s & exec 9<%s.part; "
             "kill -%s $!; wait $!",
             file, line, file, signal);
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
}

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_writing, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(test_study_that_dies, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
