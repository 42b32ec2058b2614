// What is kept of a launch on an FMU (base.kind: fmu) finds that again from any folder and says
// where it is gone or another; the verbs of the command on such a base.
#include <math.h>

#include "support/made_fmu.h"
#include "support/shell.h"

// A line that ends well.
static void must(const char *line)
{
    if (run(line) != 0)
        fail_msg("%s: code %d: %s%s", line, shell.code, shell.out, shell.err);
}

// there/platform.yaml, the example on a fixed base put on there/platform2.fmu, and elsewhere/.
static int make_platforms(void **state)
{
    char path[128];
    if (shell_make(state))
        return -1;
    must("mkdir there elsewhere && sed 's/^  kind: fixed/  kind: fmu\\n  file: platform2.fmu\\n  "
         "step: 1 ms/' examples/fixed.yaml >there/platform.yaml && echo '  lead_in: 0.02 s' "
         ">>there/platform.yaml");
    snprintf(path, sizeof path, "%s/there/platform2.fmu", shell.folder);
    make_platform(path, 2, PLATFORM_KEEPS_2);
    snprintf(path, sizeof path, "%s/there/platform3.fmu", shell.folder);
    make_platform(path, 3, PLATFORM_SAVES_3);
    must("ln -s ../launchdyn elsewhere/launchdyn");
    return 0;
}

#define ELSEWHERE "cd elsewhere && "

// ---- found again

static void a_run_is_repeated_from_anywhere(void **state)
{
    (void)state;
    must("launchdyn run -q there/platform.yaml --out results");
    must("jq -r '.source.files[1] | .name, .text' results/summary.json | sed \"s|$(pwd -P)|HERE|; "
         "s/1a [0-9a-f]\\{16\\} of [0-9]*/1a DIGEST of SIZE/\"");
    assert_string_equal(shell.out, "platform2.fmu\nFNV-1a DIGEST of SIZE bytes: "
                                   "HERE/there/platform2.fmu\n");
    must("mv there/platform.yaml elsewhere/away.yaml && " ELSEWHERE
         "launchdyn run -q --again ../results --out again && cmp again/history.h5 "
         "../results/history.h5");
    assert_string_equal(shell.err, "");
    // what was understood is a scenario that stands anywhere, too
    must(
        "jq -r .scenario results/summary.json >elsewhere/understood.yaml && " ELSEWHERE
        "launchdyn run -q understood.yaml --out understood && jq -c '.rockets[0].exit' "
        "understood/summary.json >a && jq -c '.rockets[0].exit' ../results/summary.json | cmp a -");
}

#define STUDY "--set 'scatter={samples: 3, factors: {rocket.mass: {normal: 0.5 kg}}}' "

static void a_study_finds_it_from_anywhere(void **state)
{
    (void)state;
    must(ELSEWHERE "launchdyn study ../there/platform.yaml " STUDY "-j 2 --out study");
    expect_in(shell.out, "3 of 3 samples, 0 failed");
    must("mv there/platform.yaml away.yaml && launchdyn study --again elsewhere/study --out again");
    expect_in(shell.out, "3 of 3 samples, 0 failed");
    must("launchdyn study export elsewhere/study --csv 1.csv && launchdyn study export again --csv "
         "2.csv && cmp 1.csv 2.csv");
    // a sample on its own, from the study's texts, and again from its own
    must("launchdyn study -q --again elsewhere/study --only 2 --out one && " ELSEWHERE
         "launchdyn run -q --again ../one/sample-2 --out two && cmp two/history.h5 "
         "../one/sample-2/history.h5");
}

// ---- gone, or another

static void one_that_has_changed_is_refused(void **state)
{
    (void)state;
    must("launchdyn run -q there/platform.yaml --out results && launchdyn study -q "
         "there/platform.yaml " STUDY "--out study && jq -r .scenario results/summary.json "
         ">understood.yaml && cp there/platform2.fmu kept.fmu && printf x >>there/platform2.fmu");
    expect_complaint("launchdyn run --again results --out again", 2,
                     "/there/platform2.fmu\" has changed: expected FNV-1a ");
    expect_in(shell.err, "platform.yaml:11:9: error: base.file: ");
    expect_complaint("launchdyn run understood.yaml --out again", 2,
                     "/there/platform2.fmu\" has changed: expected FNV-1a ");
    expect_complaint(
        "launchdyn study there/platform.yaml --set 'scatter={samples: 4, factors: "
        "{rocket.mass: {normal: 0.5 kg}}}' --out study",
        2,
        "study.db contains the study of another scenario, whose first difference is in "
        "\"digest: \"FNV-1a ");
    expect_complaint("launchdyn run there/platform.yaml --set base.digest=none", 2,
                     "/there/platform2.fmu\" has changed: expected none, found FNV-1a ");
    // whichever digest is the greater one
    expect_complaint("launchdyn run there/platform.yaml --set 'base.digest=FNV-1a 0'", 2,
                     "/there/platform2.fmu\" has changed: expected FNV-1a 0, found FNV-1a ");
    must("rm there/platform2.fmu");
    expect_complaint("launchdyn run --again results --out again", 2,
                     "/there/platform2.fmu\" cannot be read: No such file or directory");
    expect_complaint("launchdyn run there/platform.yaml --out again", 2,
                     "there/platform.yaml:11:9: error: base.file: file \"there/platform2.fmu\" "
                     "cannot be read: No such file or directory");
    expect_complaint("launchdyn run there/platform.yaml --set base.file=. --out again", 2,
                     "file \"there/.\" is not a regular file");
    assert_int_equal(run("test -e again"), 1);
    must("mv kept.fmu there/platform2.fmu && launchdyn run -q --again results --out again");
}

// A name that is not there is reported where the file is named, or where the name is.
static void a_missing_variable_is_told_where_it_is_wanted(void **state)
{
    (void)state;
    char path[128];
    snprintf(path, sizeof path, "%s/there/nameless.fmu", shell.folder);
    make_nameless_platform(path);
    must("sed -i 's/platform2/platform3/' there/platform.yaml && printf 'include: "
         "platform.yaml\nbase:\n  file: nameless.fmu\n' >there/nameless.yaml && printf 'include: "
         "platform.yaml\nbase:\n  connect: {position: a b c}\n' >there/abc.yaml");
    expect_complaint("launchdyn check there/nameless.yaml", 2,
                     "there/nameless.yaml:3:9: error: base.file: ");
    expect_in(shell.err, "has no variable \"base.position.x\", the default of "
                         "base.connect.position; did you mean \"bass.position.x\"?");
    expect_complaint("launchdyn check there/abc.yaml", 2,
                     "there/abc.yaml:3:23: error: base.connect.position: ");
    expect_in(shell.err, "has no variable \"a\"");
}

// ---- the command's verbs

static void verbs_work_on_it(void **state)
{
    (void)state;
    must("launchdyn check there/platform.yaml >understood.yaml && launchdyn check understood.yaml "
         ">twice.yaml && cmp understood.yaml twice.yaml && "
         "grep -c '^  digest: \"FNV-1a' understood.yaml");
    must("launchdyn run -q there/platform.yaml --csv --out 2 && launchdyn run -q "
         "there/platform.yaml --set base.file=platform3.fmu --out 3 && launchdyn plot 2 3 --out "
         "both.svg && launchdyn report 2 && launchdyn report 2 3 -o both.html && test -s both.svg "
         "&& test -s both.html && grep -c 'One rocket\\|Reference launcher' 2/report.html && head "
         "-1 2/history.csv");
    expect_in(shell.out, "base.fmu_work [J]");
}

// The launcher's modes are those at the pitch that the platform has under it, 19.738 deg.
static void modes_are_those_where_it_stands(void **state)
{
    (void)state;
    must("launchdyn run -q there/platform.yaml --out run --csv && awk -F, 'NR == 1 {for (i = 1; i "
         "<= NF; i++) if ($i ~ /base.pitch/) k = i} NR == 2 {print $k}' run/history.csv >pitch && "
         "sed '/^  file: /d; /^  step: /d; s/kind: fmu/kind: fixed/' there/platform.yaml "
         ">fixed.yaml && launchdyn modes there/platform.yaml >its && launchdyn modes fixed.yaml "
         "--set \"base.elevation=$(cat pitch) rad\" >those && cmp its those && launchdyn modes "
         "fixed.yaml >others && ! cmp -s its others && cat pitch");
    CHECK_NEAR("pitch [deg]", atof(shell.out) * 180 / acos(-1), 19.738, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_run_is_repeated_from_anywhere, make_platforms,
                                        shell_remove),
        cmocka_unit_test_setup_teardown(a_study_finds_it_from_anywhere, make_platforms,
                                        shell_remove),
        cmocka_unit_test_setup_teardown(one_that_has_changed_is_refused, make_platforms,
                                        shell_remove),
        cmocka_unit_test_setup_teardown(a_missing_variable_is_told_where_it_is_wanted,
                                        make_platforms, shell_remove),
        cmocka_unit_test_setup_teardown(verbs_work_on_it, make_platforms, shell_remove),
        cmocka_unit_test_setup_teardown(modes_are_those_where_it_stands, make_platforms,
                                        shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
