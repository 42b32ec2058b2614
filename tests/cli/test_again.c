// A run repeated to the bit from its folder of results alone: launchdyn run --again.
#include "model/fields/source.h"
#include "model/model.h"
#include "support/check.h"
#include "support/shell.h"

#include <hdf5.h>

#include "launchdyn/origin.h"
#include "launchdyn/output.h"
#include "quantities/summary.h"
#include "scenario/scenario.h"

static void write_text(const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", shell.folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

// A line of shell that must succeed.
static void must(const char *line)
{
    if (run(line) != 0)
        fail_msg("%s: code %d: %s%s", line, shell.code, shell.out, shell.err);
}

// Runs the folder `again`, from which all else is gone, and compares everything but CPU times.
static void expect_same(const char *before, const char *options)
{
    char line[1024];
    snprintf(line, sizeof line, "rm -rf away && mkdir away && mv %s away/results && rm -rf b made",
             before);
    must(line);
    snprintf(line, sizeof line, "launchdyn run --again away/results %s --out b >b.txt", options);
    must(line);
    // the same program on the same processor: nothing to be said
    assert_string_equal(shell.err, "");
    must("cmp away/results/history.h5 b/history.h5 && "
         "for i in away/results b; do jq 'del(.statistics.cpu_seconds, "
         ".statistics.cpu_seconds_setup, .digest)' $i/summary.json >$i.json; done && "
         "cmp away/results.json b.json && cd away/results && "
         "for i in *.csv; do [ $i = '*.csv' ] || cmp $i ../../b/$i; done");
}

// Makes a scenario that is read from many files: made/under/launch.yaml.
static void make_files(void)
{
    must("rm -rf made && mkdir -p made/under made/tables && "
         "sed 's/^title:.*//' examples/reference.yaml >made/base.yaml && "
         "cp examples/reference-aero.csv made && "
         "cp examples/reference-motor.eng made/tables/motor.eng");
    write_text("made/tables/road.csv", "# \xe9 is no UTF-8\nx [m], left [mm], right [mm]\n"
                                       "-40, 0, 0\n-3, 12, -4\n0, 3, 5\n2.5, -7, 9\n60, 0, 0\n");
    write_text("made/tables/command.csv", "t [s], angle [deg]\n0, 19.8\n1, 20.3\n");
    write_text("made/under/launch.yaml",
               "include: ../base.yaml\n"
               "title: From many files\n"
               "base:\n  road: {class: none, table: ../tables/road.csv}\n  speed: 10 km/h\n"
               "platform: {elevation: {stabiliser: {command: ../tables/command.csv}}}\n"
               "rocket: {motor: {thrust: nowhere.eng}}\n"
               "run: {lead_in: 0.5 s, end: tip}\n");
}

static const char *const sets =
    "--set rocket.motor.thrust=../tables/motor.eng --set rocket.mass='61.5 kg'";

static void test_a_run_of_many_files(void **state)
{
    (void)state;
    char line[512];
    make_files();
    snprintf(line, sizeof line, "launchdyn run made/under/launch.yaml %s --out a --csv >a.txt",
             sets);
    must(line);
    must("jq -r '[.source.files[].name] | join(\" \")' a/summary.json");
    assert_string_equal(shell.out, "launch.yaml ../base.yaml ../tables/road.csv "
                                   "../tables/command.csv ../tables/motor.eng "
                                   "../reference-aero.csv\n");
    snprintf(line, sizeof line,
             "launchdyn check made/under/launch.yaml %s >words && sed '/^# /d' words >checked && "
             "jq -rj .scenario a/summary.json | cmp - checked",
             sets);
    must(line);
    must("jq -rj '.source.files[1].text' a/summary.json | cmp - made/base.yaml; "
         "jq -r '.source.set[1]' a/summary.json");
    assert_string_equal(shell.out, "rocket.mass=61.5 kg\n");
    expect_same("a", "--csv");
    // what came out can be run again too
    expect_same("b", "--csv");
}

// From another folder, and by another name of the same.
static void test_names_do_not_tell_where(void **state)
{
    (void)state;
    make_files();
    char line[1024];
    snprintf(
        line, sizeof line,
        "launchdyn run made/under/launch.yaml %s -q --out a; (cd made/under && ../../launchdyn "
        "run launch.yaml %s -q --out ../../c); launchdyn run $PWD/made/under/launch.yaml %s -q "
        "--out d; cmp a/history.h5 c/history.h5 && cmp a/history.h5 d/history.h5 && "
        "! grep -q $PWD a/summary.json d/summary.json",
        sets, sets, sets);
    must(line);
}

// The longest step, whether it follows from the tolerance or is given.
static void test_longest_step(void **state)
{
    (void)state;
    must("launchdyn run examples/fixed.yaml --set run.tolerance=1e-3 --out a -q; "
         "jq -r .scenario a/summary.json | grep -c '^  max_step: 0.000502377286301'");
    expect_same("a", "-q");
    must("launchdyn run examples/fixed.yaml --set run.tolerance=1e-3 --set run.max_step='1 ms' "
         "--out c -q; ! cmp -s c/history.h5 b/history.h5");
    expect_same("c", "-q");
}

static void test_standard_input(void **state)
{
    (void)state;
    must("launchdyn run - <examples/fixed.yaml --out a -q");
    expect_same("a", "-q");
}

// A sample, of a point of a sweep: its numbers are drawn again.
static void test_a_sample(void **state)
{
    (void)state;
    must("mkdir -p made && cp examples/fixed.yaml made");
    write_text(
        "made/study.yaml",
        "include: fixed.yaml\n"
        "sweep: {rocket.mass: [59 kg, 61 kg, 62 kg]}\n"
        "scatter:\n  samples: 4\n"
        "  factors: {rocket.mass_error: {normal: 0.2 kg}, base.elevation: {normal: 1 deg}}\n");
    must("launchdyn study made/study.yaml --only 8 --out s -q && "
         "jq -c '.source | [.point, .sample]' s/sample-8/summary.json");
    assert_string_equal(shell.out, "[2,3]\n");
    expect_same("s/sample-8", "-q");
}

// A study from its folder alone, with texts that are gone: the same table, whoever runs it.
static void test_a_study(void **state)
{
    (void)state;
    must("mkdir -p made && cp examples/fixed.yaml made");
    write_text("made/fall.eng", "; \xe9\nM 1 1 0 20 32 x\n0.01 15000\n2.5 15000\n2.6 0\n");
    write_text("made/study.yaml",
               "include: fixed.yaml\n"
               "rocket: {motor: {thrust: fall.eng}}\n"
               "sweep: {rocket.mass: [59 kg, 61 kg]}\n"
               "scatter: {samples: 4, factors: {base.elevation: {normal: 1 deg}}}\n");
    must("launchdyn study made/study.yaml --out s -q --set base.azimuth='2 deg' && "
         "launchdyn study export s --csv s.csv >/dev/null && rm -r made && mkdir away && "
         "mv s away/s && rm -f away/s/study.lock");
    must("launchdyn study --again away/s --out t -q && launchdyn study export t --csv t.csv "
         ">/dev/null && cmp s.csv t.csv && [ $(wc -l <t.csv) = 9 ]");
    assert_string_equal(shell.err, "");
    must(
        "launchdyn study --again away/s --out u --shard 1/2 -q; launchdyn study --again t --out u "
        "--shard 2/2 -q; launchdyn study merge u >/dev/null; launchdyn study --again u --out v -q; "
        "launchdyn study export v --csv v.csv >/dev/null && cmp s.csv v.csv");
    must("launchdyn study --again away/s --only 3 --out w -q && launchdyn run --again w/sample-3 "
         "--out x -q && cmp w/sample-3/history.h5 x/history.h5");
    expect_complaint("launchdyn study --again none --out y", 2, "none contains no study");
    must("mkdir bad && echo text >bad/study.db");
    expect_complaint("launchdyn study --again bad --out y", 2,
                     "bad/study.db is damaged: file is not a database\n");
    expect_complaint("launchdyn study --again t --out y --set gravity=1", 2,
                     "it excludes other arguments and --set");
    expect_complaint("launchdyn study show --again t", 2, "it excludes other arguments and --set");
    expect_complaint("launchdyn study", 2, "study requires ");
}

// Results of another program are run all the same; one line says what is another.
static void test_another_program(void **state)
{
    (void)state;
    char path[128];
    must("launchdyn run examples/fixed.yaml --out a -q");
    snprintf(path, sizeof path, "%s/a/history.h5", shell.folder);
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    hid_t program = H5Gopen2(file, "program", H5P_DEFAULT);
    hid_t version = H5Aopen(program, "version", H5P_DEFAULT), type = H5Aget_type(version);
    assert_true(H5Awrite(version, type, "9.9.9") >= 0);
    H5Tclose(type);
    H5Aclose(version);
    H5Gclose(program);
    H5Fclose(file);
    expect_complaint("launchdyn run --again a --out b -q", 2,
                     "launchdyn: a/history.h5 is damaged, or of another run: its digest is not "
                     "that in summary.json\n");
    must("mv a/summary.json . && launchdyn run --again a --out b -q && mv summary.json a");
    assert_string_equal(shell.err,
                        "launchdyn: warning: a was computed by another program or machine; the "
                        "last digits may differ: version 9.9.9, here 0.1.0\n");
    must("cmp a/history.h5 b/history.h5 | grep -q differ; jq -S 'del(.program, .statistics, "
         ".files, .digest)' "
         "a/summary.json >a.json; jq -S 'del(.program, .statistics, .files, .digest)' "
         "b/summary.json | cmp - a.json");
}

// Takes a member out of a history.
static void take_away(const char *member)
{
    char path[128];
    snprintf(path, sizeof path, "%s/a/history.h5", shell.folder);
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(file >= 0 && H5Ldelete(file, member, H5P_DEFAULT) >= 0);
    H5Fclose(file);
}

static void test_damaged_and_foreign_folders(void **state)
{
    (void)state;
#define AGAIN "launchdyn run --again "
    expect_complaint(AGAIN "none", 2, "launchdyn: no results in none: there is no history.h5\n");
    must("rm -rf a && mkdir -p a && echo text >a/history.h5");
    expect_complaint(AGAIN "a", 2, "cannot read a/history.h5: ");
    must("launchdyn run examples/fixed.yaml --out good -q && "
         "head -c 3000 good/history.h5 >a/history.h5");
    expect_complaint(AGAIN "a", 2, "cannot read a/history.h5: ");
    static const char *const members[] = {"scenario", "source/files/1", "source/set"};
    for (int i = 0; i < 3; i++) {
        must("cp good/history.h5 a/history.h5");
        take_away(members[i]);
        expect_complaint(AGAIN "a", 2,
                         "a/history.h5 is damaged: the record of its scenario cannot be read");
    }
    must("cp good/history.h5 a/history.h5");
    take_away("program");
    expect_complaint(AGAIN "a", 2, "has no record of its scenario: it is of an earlier version\n");
    must("cp good/history.h5 a/history.h5");
    take_away("source");
    expect_complaint(AGAIN "a", 2,
                     "a cannot be repeated: its model was not read from a scenario\n");
    // a scenario whose second file is not there
    must("launchdyn run examples/engine.yaml --out good -q && cp good/history.h5 a/history.h5");
    take_away("source/files/3");
    expect_complaint(
        AGAIN "a", 2,
        "rocket.motor.thrust: file \"reference-motor.eng\" is not among the stored texts\n");
    expect_complaint(AGAIN "a examples/fixed.yaml", 2, "it excludes FILE and --set\n");
    expect_complaint(AGAIN "a --set title=x", 2, "it excludes FILE and --set\n");
    expect_complaint(AGAIN "good --csv", 2, "--csv requires --out DIR\n");
}

// What is kept is what was read, to the byte, and what check prints after the launcher in words.
static void test_origin_reads_back(void **state)
{
    (void)state;
    ld_model model;
    ld_messages messages;
    ld_origin before, after;
    ld_output *output;
    ld_summary summary = {0};
    ld_error error;
    char path[128];
    make_files();
    snprintf(path, sizeof path, "%s/made/under/launch.yaml", shell.folder);
    const char *const set[] = {"rocket.motor.thrust=../tables/motor.eng"};
    assert_int_equal(scenario_read(path, set, 1, &model, &messages), LD_OK);
    assert_int_equal(ld_origin_of(&model, &before, &error), LD_OK);
    snprintf(path, sizeof path, "%s/kept", shell.folder);
    assert_int_equal(ld_output_open(path, &model, false, &output, &error), LD_OK);
    assert_int_equal(ld_output_finish(output, &summary, &error), LD_OK);
    assert_int_equal(ld_origin_read(path, &after, &error), LD_OK);
    assert_int_equal(after.fact_count, before.fact_count);
    for (size_t i = 0; i < after.fact_count; i++) {
        assert_string_equal(after.fact[i].name, before.fact[i].name);
        assert_string_equal(after.fact[i].text, before.fact[i].text);
    }
    assert_string_equal(after.scenario, before.scenario);
    assert_int_equal(after.source->file_count, 6);
    for (size_t i = 0; i < 6; i++) {
        const ld_source_file *one = before.source->file[i], *other = after.source->file[i];
        assert_string_equal(one->name, other->name);
        assert_int_equal(one->length, other->length);
        assert_memory_equal(one->text, other->text, one->length + 1);
    }
    char text[64];
    assert_false(ld_origin_differs(&after, text, sizeof text));
    assert_string_equal(text, "");
    ld_origin_free(&after);
    ld_origin_free(&before);
    model_clear(&model);
}

// What a page holds under a name, as JSON in the file page.json.
#define DATA_OF(page, name)                                                                        \
    "tr -d '\\n' <" page " | sed 's/.*id=\"" name "\">//; s/<\\/script>.*//' >page.json; "

static void test_reports(void **state)
{
    (void)state;
    must("launchdyn run examples/engine.yaml --set rocket.mass='61 kg' --out a --report -q && "
         "launchdyn check examples/engine.yaml --set rocket.mass='61 kg' >words && sed '/^# /d' "
         "words >checked");
    must(
        DATA_OF("a/report.html",
                "origin") "jq -rj .scenario page.json | cmp - checked && "
                          "jq -rj '.files[2][1]' page.json | cmp - examples/reference-motor.eng && "
                          "jq -r '[.set[0], .files[][0], .program[0][1]] | join(\" \")' page.json");
    assert_string_equal(shell.out, "rocket.mass=61 kg engine.yaml fixed.yaml reference-motor.eng "
                                   "0.1.0\n");
    // the summary in the page goes without the texts
    must(
        DATA_OF("a/report.html", "summary") "jq -r '[.title, .program.version, .scenario, .source] "
                                            "| tostring' page.json");
    assert_string_equal(shell.out, "[\"Reference launcher with a thrust curve from a file\","
                                   "\"0.1.0\",null,null]\n");
    // warnings on the scenario are those of `check`
    must("launchdyn run examples/engine.yaml --set rocket.mass_error='-30 kg' --set "
         "rocket.dynamic_imbalance='2 0 deg' --out n --report -q; "
         "launchdyn check examples/engine.yaml --set rocket.mass_error='-30 kg' --set "
         "rocket.dynamic_imbalance='2 0 deg' --json | "
         "jq -c '[.notes[] | .path + \": \" + .text]' >notes; [ $(jq length notes) = 2 ]");
    must(DATA_OF("n/report.html", "data") "jq -c .notes page.json | cmp - notes");
    // long texts are left out, and the report stays small
    must("{ cat examples/fixed.yaml; yes '# much to be said of nothing at all' | head -n 50000; } "
         ">long.yaml; launchdyn run long.yaml --out b --report -q && launchdyn report b");
    must(DATA_OF("b/report.html",
                 "origin") "jq -c '[.files[0], (.scenario | length > 500)]' "
                           "page.json; wc -c <b/report.html >size; [ $(cat size) -lt 2000000 ]");
    assert_string_equal(shell.out, "[[\"long.yaml\",null],true]\n");
    must("launchdyn run --again b --out c -q && cmp b/history.h5 c/history.h5");
}

static void test_reports_of_studies(void **state)
{
    (void)state;
    write_text("study.yaml", "include: examples/fixed.yaml\n"
                             "sweep: {base.azimuth: [0 deg, 1 deg]}\n"
                             "scatter:\n  samples: 6\n  seed: 4\n  plan: lhs\n  replicates: 2\n"
                             "  factors:\n    rocket.mass_error: {normal: 0.2 kg, within: 3}\n"
                             "    base.elevation: {uniform: +-1 deg}\n");
    must("launchdyn study study.yaml --out s -q && launchdyn report s >/dev/null && "
         "launchdyn check study.yaml >words && sed '/^# /d' words >checked");
    must(DATA_OF("s/report.html", "data") "jq -rj '.studies[0].origin.scenario' page.json | "
                                          "cmp - checked && jq -c '.studies[0] | .plan, .factors, "
                                          ".origin.files[1][0]' page.json");
    assert_string_equal(
        shell.out, "[[\"plan\",\"2 Latin hypercubes of 3 samples\"],[\"seed\",\"4\"],"
                   "[\"swept\",\"base.azimuth, 2 values\"]]\n"
                   "[[\"rocket.mass_error\",\"normal: 0.2 kg, within: 3\",\"each rocket\"],"
                   "[\"base.elevation\",\"uniform: +-0.017453292519943295 rad\",\"each sample\"]]\n"
                   "\"examples/fixed.yaml\"\n");
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, shell_make, shell_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_run_of_many_files),
        TEST(test_names_do_not_tell_where),
        TEST(test_longest_step),
        TEST(test_standard_input),
        TEST(test_a_sample),
        TEST(test_a_study),
        TEST(test_another_program),
        TEST(test_damaged_and_foreign_folders),
        TEST(test_origin_reads_back),
        TEST(test_reports),
        TEST(test_reports_of_studies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
