// Values that are allowed but implausible, as a user of the command meets them.
#include "support/check.h"
#include "support/shell.h"

#define LOW " --set rocket.adaptors.rear.clearance='70 mm' --set run.end='1 ms'"
#define NOTE(kind)                                                                                 \
    "--set:1:32: " kind ": rocket.adaptors.rear.clearance: found \"70 mm\", but the bore's "       \
    "radius is 0.0825 m: a clearance is a small part of the bore; did you mean \"70 um\"?\n"

// They change neither what is printed nor the exit code.
static void test_notes_change_nothing(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn check examples/fixed.yaml" LOW), 0);
    expect_in(shell.err, NOTE("warning"));
    expect_in(shell.out, "clearance: 0.07");
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out a" LOW), 0);
    expect_in(shell.err, NOTE("warning"));
    assert_null(strstr(strstr(shell.err, "warning") + 1, "warning"));
    assert_int_equal(run("launchdyn run examples/fixed.yaml --quiet --out b" LOW), 0);
    assert_string_equal(shell.err, "");
    assert_int_equal(run("launchdyn run --again a --out c"), 0);
    expect_in(shell.err, NOTE("warning"));
    assert_int_equal(run("launchdyn modes examples/fixed.yaml" LOW), 0);
    assert_string_equal(shell.err, "");
}

static void test_strict_refuses(void **state)
{
    (void)state;
    expect_complaint("launchdyn check examples/fixed.yaml --strict" LOW, 2, NOTE("error"));
    expect_complaint("launchdyn run examples/fixed.yaml --strict --out a" LOW, 2, NOTE("error"));
    expect_complaint("launchdyn run examples/fixed.yaml --strict -q --out a" LOW, 2, NOTE("error"));
    assert_int_equal(run("test -e a"), 1);
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out a -q" LOW), 0);
    expect_complaint("launchdyn run --again a --strict --out b", 2, NOTE("error"));
    assert_int_equal(run("test -e b"), 1);
    assert_int_equal(run("launchdyn run examples/fixed.yaml --strict --set run.end='1 ms'"), 0);
    assert_string_equal(shell.err, "");
}

#define STUDY                                                                                      \
    "launchdyn study examples/fixed.yaml --set run.end='1 ms' --set 'sweep={rocket.mass: "         \
    "[60 kg, 60 t]}' --out a "

// Of a study all points count, of a run the nominal values.
static void test_points(void **state)
{
    (void)state;
    expect_complaint(STUDY "--strict", 2, "error: rocket.motor.thrust: the greatest thrust is");
    assert_int_equal(run("test -e a"), 1);
    assert_int_equal(run(STUDY), 0);
    expect_in(shell.err, "warning: rocket.motor.thrust: the greatest thrust is");
    assert_int_equal(run(STUDY "--quiet"), 0);
    assert_string_equal(shell.err, "");
    assert_int_equal(run("launchdyn run examples/fixed.yaml --set run.end='1 ms' --strict "
                         "--set 'sweep={rocket.mass: [60 kg, 60 t]}'"),
                     0);
    expect_complaint("launchdyn check examples/fixed.yaml --set 'sweep={rocket.mass: [60 kg, "
                     "60 t]}' --strict",
                     2, "error: rocket.motor.thrust: the greatest thrust is");
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, shell_make, shell_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_notes_change_nothing),
        TEST(test_strict_refuses),
        TEST(test_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
