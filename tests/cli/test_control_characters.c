// Control characters, and those that turn others around or are not seen, never reach a terminal as
// such: each way on which a text of a scenario, a file's name, an argument or a database comes to
// be printed.
// link: -lsqlite3
#include "support/sealed_study.h"
#include "support/shell.h"

#include <stdbool.h>

// ESC, CSI (U+009B), a change of direction (U+202E) and a space without width (U+200B) as the shell
// writes them, and as they are to be seen.
#define EVIL "\\033[31m\\302\\2332J\\342\\200\\256\\342\\200\\213"
#define SEEN "\\x1b[31m\\xc2\\x9b2J\\xe2\\x80\\xae\\xe2\\x80\\x8b"
// the same as YAML writes them
#define YAML_EVIL "\\e[31m\\u009b2J\\u202e\\u200b"

// A new line is what the program's own lines end with, a tab what a source line may have.
static bool is_clean(const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        if ((*c < 0x20 && *c != '\n' && *c != '\t') || *c == 0x7f ||
            (*c == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0) ||
            (*c == 0xe2 && c[1] == 0x80 && (c[2] == 0x8b || c[2] == 0xae)))
            return false;
    return true;
}

static int ways; // tried

// Runs a line, of which one stream shows `seen` and none a control character.
static void expect_seen(const char *line, int code, const char *seen)
{
    run(line);
    ways++;
    if (!is_clean(shell.out) || !is_clean(shell.err))
        fail_msg("%s: a control character in \"%s\" or \"%s\"", line, shell.out, shell.err);
    if (shell.code != code || (!strstr(shell.out, seen) && !strstr(shell.err, seen)))
        fail_msg("%s: code %d, without \"%s\": \"%s\" and \"%s\"", line, shell.code, seen,
                 shell.out, shell.err);
}

static void write_scenario(const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", shell.folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "include: examples/fixed.yaml\n%s", text);
    assert_int_equal(fclose(file), 0);
}

// `evil` in the shell: a variable with the characters.
#define WITH_EVIL "evil=$(printf '" EVIL "'); "

static void test_texts_of_a_scenario(void **state)
{
    (void)state;
    write_scenario("title.yaml", "title: \"" YAML_EVIL "\"\n");
    expect_seen("launchdyn run title.yaml", 0, SEEN "\n");
    expect_seen("launchdyn check title.yaml", 0, "title: \"\\x1B[31m\\u009B2J\\u202E\\u200B\"\n");
    static const struct {
        const char *text, *seen;
    } wrong[] = {
        {"\"" YAML_EVIL "\": 1\n", ": error: " SEEN ": unknown key"},
        {"rocket: {\"" YAML_EVIL "\": 1}\n", ": error: rocket." SEEN ": unknown key"},
        {"rocket: {contact: {law: \"" YAML_EVIL "\"}}\n", "found \"" SEEN "\"; expected"},
        {"rocket: {mass: \"60 " YAML_EVIL "\"}\n", "found \"60 " SEEN "\""},
        {"rocket: {adaptors: {\"" YAML_EVIL "\": {at: 1 m}}}\n", "no entry \"" SEEN "\""},
        {"rocket: {adaptors: [{name: \"" YAML_EVIL "\", at: 0 m}, {name: front, at: 1 m}]}\n",
         "rocket.adaptors." SEEN ".name: found \"" SEEN "\""},
        {"rocket: {motor: {thrust: \"" YAML_EVIL ".eng\"}}\n", "file \"" SEEN ".eng\" cannot"},
        {"base: {kind: prescribed, motion: {table: \"" YAML_EVIL ".csv\"}}\n",
         "file \"" SEEN ".csv\" cannot"},
        {"sweep: {\"" YAML_EVIL "\": {paths: [a, b], values: [1]}}\n", "sweep." SEEN},
        {"sweep: {rocket.mass: [\"" YAML_EVIL "\"]}\n", "found \"" SEEN "\""},
        {"scatter: {samples: 8, factors: {\"rocket." YAML_EVIL "\": {normal: 1 kg}}}\n",
         "no key \"" SEEN "\" in rocket"},
        {"scatter: {samples: 8, factors: {\"" YAML_EVIL "\": {paths: [a, b]}}}\n",
         "scatter.factors." SEEN},
        {"scatter: {samples: 8, factors: {rocket.mass: {normal: 1 kg, \"" YAML_EVIL "\": 1}}}\n",
         "rocket.mass." SEEN ": unknown key"},
        {"scatter: {samples: 8, factors: {rocket.mass: {normal: 1 kg}}, until: {\"" YAML_EVIL
         "\": 1 %}}\n",
         "scatter.until." SEEN},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        write_scenario("wrong.yaml", wrong[i].text);
        expect_complaint("launchdyn check wrong.yaml", 2, wrong[i].seen);
        assert_true(is_clean(shell.err));
        ways++;
    }
    // characters as they are: YAML has none such, and the line is shown with a caret below its
    // place
    expect_seen(WITH_EVIL "echo \"include: examples/fixed.yaml # $evil\" >raw.yaml; launchdyn "
                          "check raw.yaml",
                2, SEEN "\n");
    expect_seen(WITH_EVIL "echo \"{launchdyn: 1, '$evil\" | tr -d '\\302\\233' >raw.yaml; "
                          "launchdyn check raw.yaml",
                2, "raw.yaml:1");
    // the caret stands below its place behind a character that is shown as several
    expect_seen(
        "printf '{include: examples/fixed.yaml, title: \"a\\342\\200\\256b\", x: 1}' >caret.yaml; "
        "launchdyn check caret.yaml",
        2,
        "    {include: examples/fixed.yaml, title: \"a\\xe2\\x80\\xaeb\", x: 1}\n"
        "                                                            ^\n");
    // tables have none such either
    expect_seen(WITH_EVIL "echo \"t,$evil\" >bad.csv; launchdyn check examples/fixed.yaml --set "
                          "base.kind=prescribed --set base.motion.table=$PWD/bad.csv",
                2, SEEN);
}

static void test_names_of_files_and_arguments(void **state)
{
    (void)state;
    expect_seen(WITH_EVIL "launchdyn check \"$evil.yaml\"", 2, "file \"" SEEN ".yaml\" cannot");
    expect_seen(WITH_EVIL "echo 'launchdyn: 2' >\"$evil.yaml\"; launchdyn check \"$evil.yaml\"", 2,
                SEEN ".yaml:1:12: error: launchdyn: found \"2\"; must be 1");
    expect_seen(WITH_EVIL "echo \"include: '$evil.yaml'\" | launchdyn check -", 2, SEEN);
    expect_seen(WITH_EVIL "launchdyn check examples/fixed.yaml --set \"rocket.$evil=1\"", 2,
                "    rocket." SEEN "=1\n           ^\n");
    expect_seen(WITH_EVIL "launchdyn check examples/fixed.yaml --set \"rocket.mass=$evil\"", 2,
                SEEN);
    expect_seen(WITH_EVIL "launchdyn \"$evil\"", 2, "unknown command " SEEN);
    expect_seen(WITH_EVIL "launchdyn help \"$evil\"", 2, "unknown command " SEEN);
    expect_seen(WITH_EVIL "launchdyn run \"--$evil\" x", 2, "--" SEEN);
    expect_seen(WITH_EVIL "launchdyn study \"$evil\" x", 2, "found " SEEN);
    expect_seen(WITH_EVIL "launchdyn study x --shard \"$evil\"", 2, "found " SEEN);
    expect_seen(WITH_EVIL "launchdyn study show \"$evil\"", 2, SEEN);
    expect_seen(WITH_EVIL "launchdyn plot \"$evil\" -o x.svg", 2, SEEN);
    expect_seen(WITH_EVIL "launchdyn report \"$evil\"", 2, SEEN);
    expect_seen(WITH_EVIL "launchdyn run --again \"$evil\"", 2, SEEN);
    expect_seen(WITH_EVIL "launchdyn run title.yaml -q -o run && launchdyn plot run -o x.svg -w "
                          "\"$evil\"",
                2, SEEN);
    expect_seen(WITH_EVIL "launchdyn plot run -o \"none/$evil.svg\"", 3, SEEN);
    expect_seen(WITH_EVIL "launchdyn report run -o \"$evil.html\"", 0, SEEN ".html: ");
    expect_seen(WITH_EVIL "launchdyn run title.yaml -q -o \"title.yaml/$evil\"", 3, SEEN);
}

// Writes into the study's database what another could have written.
static void change_study(const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/study/study.db", shell.folder);
    run_sql(path, text);
    seal_study(path);
}

static void test_texts_of_a_study(void **state)
{
    (void)state;
    write_scenario("study.yaml", "scatter: {samples: 4, factors: {rocket.mass: {normal: 1 kg}}}\n"
                                 "sweep: {rocket.motor.thrust_scale: [0.9, 1]}\n");
    expect_seen(WITH_EVIL "launchdyn study study.yaml -o \"$evil\" --shard 1/2", 0, "merge " SEEN);
    expect_seen(WITH_EVIL "launchdyn study merge \"$evil\"", 0, SEEN);
    assert_int_equal(run("launchdyn study study.yaml -q -o study"), 0);
    change_study("UPDATE sample SET status = CAST(x'1b5b33316d' AS TEXT), "
                 "reason = CAST(x'1b5b33316d' AS TEXT) WHERE sample < 3");
    expect_seen("launchdyn study show study", 0,
                "failed (\\x1b[31m), the first of them 1: \\x1b[31m");
    expect_seen(WITH_EVIL "launchdyn study show study -w \"$evil\"", 2, SEEN);
    CHECK_WITHIN("ways to the terminal, all without control characters", ways, 42, 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_texts_of_a_scenario),
        cmocka_unit_test(test_names_of_files_and_arguments),
        cmocka_unit_test(test_texts_of_a_study),
    };
    return cmocka_run_group_tests(tests, shell_make, shell_remove);
}
