// Scenarios to begin with, as launchdyn new writes them: each passes the check without a warning,
// runs to its end without one, and makes a study; nothing is overwritten.
#include "support/check.h"
#include "support/shell.h"

static void one(const char *guide, const char *base, double least, double most)
{
    char line[512];
    snprintf(line, sizeof line, "launchdyn new --guide %s --base %s --out a.yaml", guide, base);
    assert_int_equal(run(line), 0);
    expect_in(shell.out, "Wrote a.yaml");
    assert_int_equal(run("launchdyn check --strict a.yaml"), 0);
    assert_string_equal(shell.err, "");
    expect_in(shell.out, strcmp(guide, "rail") == 0 ? "# guide: a rail" : "# guide: a bore");
    expect_in(shell.out, strcmp(base, "fixed") == 0     ? "# base: fixed; launcher 60 deg up"
                         : strcmp(base, "vehicle") == 0 ? "# base: vehicle on 4 wheels"
                         : strcmp(base, "ship") == 0    ? "# base: prescribed, a ship"
                                                        : " on cradle, 0 deg up");
    assert_int_equal(run("launchdyn run --strict a.yaml -q --out out"), 0);
    assert_string_equal(shell.err, "");
    assert_int_equal(run("jq -r '.complete, (.notes | length), .rockets[0].tip_off.pitch_rate, "
                         ".rockets[0].flight.apogee, .rockets[0].exit_speed' out/summary.json"),
                     0);
    int notes;
    double rate, apogee, speed;
    assert_int_equal(sscanf(shell.out, "true %d %lf %lf %lf", &notes, &rate, &apogee, &speed), 4);
    assert_int_equal(notes, 0);
    printf("    %s, %s:\n", guide, base);
    // v^2 = 2 a s: 8 kN on 60 kg along 60 deg; propellant burnt gains, friction and spin cost some
    double way = strcmp(guide, "rail") == 0 ? 4.6 : 2.9, pull = 8e3 / 60 - 9.81 * 0.866;
    CHECK_WITHIN("exit speed over that of a point mass", speed / sqrt(2 * pull * way), 0.99, 1.02);
    CHECK_WITHIN("tip-off pitch rate [rad/s]", rate, least, most);
    CHECK_WITHIN("highest point [m]", apogee, 2800, 3500);
    // the lines of the study at its end, without their marks
    assert_int_equal(
        run("sed -i '/^# scatter:/,$s/^# //' a.yaml && launchdyn study a.yaml -q --out "
            "study --only 2 --set run.end=tip --strict && ls study/sample-2; rm -r "
            "a.yaml out study"),
        0);
    expect_in(shell.out, "summary.json");
}

static void test_all_combinations(void **state)
{
    (void)state;
    one("tube", "fixed", -0.25, -0.2);
    one("tube", "vehicle", -0.26, -0.2);
    one("tube", "ship", -0.28, -0.2);
    one("tube", "trailer", -0.26, -0.22);
    one("tube", "suspended", -0.38, -0.3);
    one("rail", "trailer", -0.23, -0.19);
    one("rail", "suspended", -0.2, -0.1);
    one("rail", "fixed", -0.2, -0.15);
    one("rail", "vehicle", -0.21, -0.15);
    one("rail", "ship", -0.23, -0.15);
}

static void test_without_options(void **state)
{
    (void)state;
    // no terminal: the usual one, printed
    assert_int_equal(run("launchdyn new >a.yaml; launchdyn new -g tube -b fixed -o b.yaml -q; "
                         "cmp a.yaml b.yaml && launchdyn check -q a.yaml; rm a.yaml b.yaml"),
                     0);
    assert_string_equal(shell.out, "");
    // on a terminal three questions, of which an empty line takes what is usual
    assert_int_equal(run("printf 'rail\\n\\nc.yaml\\n' | script -qc 'launchdyn new' /dev/null; "
                         "grep title c.yaml"),
                     0);
    expect_in(shell.out, "What guides the rocket: tube or rail? [tube] ");
    expect_in(shell.out, "\ntitle: A rocket on a rail, on the ground\n");
    assert_int_equal(run("printf 'ship\\n\\n' | script -qc 'launchdyn new --guide tube' /dev/null; "
                         "grep title scenario.yaml"),
                     0);
    expect_in(shell.out, "\ntitle: A rocket in a tube, on a ship in a seaway\n");
}

static void test_refusals(void **state)
{
    (void)state;
    expect_complaint("launchdyn new --guide tub", 2,
                     "--guide: expected one of tube|rail, found \"tub\"; did you mean \"tube\"?\n");
    assert_int_equal(
        run("touch names && ls >names && printf 'rail\\n' | script -qec 'launchdyn new' "
            "/dev/null; [ $? = 2 ] && ls | cmp - names"),
        0);
    expect_in(shell.out, "the input ended before an answer; no file is written");
    expect_complaint(
        "launchdyn new --base boat", 2,
        "--base: expected one of fixed|vehicle|ship|trailer|suspended, found \"boat\"\n");
    assert_int_equal(run("echo mine >a.yaml"), 0);
    expect_complaint("launchdyn new --out a.yaml", 2,
                     "a.yaml exists already; choose another name, new never overwrites a file\n");
    assert_int_equal(run("cat a.yaml"), 0);
    assert_string_equal(shell.out, "mine\n");
    expect_complaint("launchdyn new --out none/a.yaml", 3,
                     "cannot write none/a.yaml: No such file or directory\n");
    // a file that may not grow: nothing is left
    expect_complaint("ulimit -f 1; launchdyn new --out b.yaml", 3, "cannot write b.yaml: File too");
    assert_int_equal(run("test -e b.yaml"), 1);
    expect_complaint("launchdyn new >/dev/full", 3, "cannot print: No space left on device");
    expect_complaint("launchdyn new a b", 2,
                     "launchdyn: new takes options only, found \"a\"; see launchdyn new --help\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_combinations),
        cmocka_unit_test(test_without_options),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, shell_make, shell_remove);
}
