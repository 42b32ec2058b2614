// What run, check, modes and study show print as JSON, against the numbers by other ways: the model
// by the paths of its keys, the tables of the text, the statistics of the exported table.
#include "support/check.h"
#include "support/shell.h"

#include <stdbool.h>
#include <stdlib.h>

#include "launchdyn/scenario.h"

static FILE *open_here(const char *name)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", shell.folder, name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    return file;
}

// Lines "path value table row column" of all numbers: components of vectors by letter (of two: y
// and z), members of lists from 1; what its path is if it stands in a table.
#define NUMBERS                                                                                    \
    "jq -r 'def path_of(p): p | map(if type == \"number\" then . + 1 else . end | tostring) | "    \
    "join(\".\"); .scenario as $s | $s | paths(type == \"number\") as $p | "                       \
    "select($p[0] != \"sweep\" and $p[0] != \"scatter\") | ($s | getpath($p[:-1])) as $from | "    \
    "(if $from | type == \"array\" then ([\"x\", \"y\", \"z\"] | .[-($from | length):])[$p[-1]] "  \
    "else $p[-1] end) as $last | \"\\(path_of($p[:-1] + [$last])) \\($s | getpath($p)) "           \
    "\\(if $p[-2:] | map(type) == [\"number\", \"number\"] then \"\\(path_of($p[:-2])) "           \
    "\\($p[-2]) "                                                                                  \
    "\\($p[-1])\" else \"- 0 0\" end)\"' a.json >numbers"

// The number at a row and a column of a table; NaN: there is no such table.
static double in_table(const ld_model *model, const char *path, size_t row, size_t column)
{
    const double *table;
    size_t rows, columns;
    if (ld_model_table(model, path, &table, &rows, &columns, NULL) || row >= rows ||
        column >= columns)
        return NAN;
    return table[row * columns + column];
}

static void compare_with_paths(const char *example, int least)
{
    char line[512], path[256], table[256];
    snprintf(line, sizeof line, "launchdyn check --json %s >a.json", example);
    assert_int_equal(run(line), 0);
    assert_int_equal(run("jq -c '[.format, .ok, .errors, .points]' a.json"), 0);
    assert_string_equal(shell.out, "[1,true,[],1]\n");
    assert_int_equal(run(NUMBERS), 0);
    snprintf(line, sizeof line, "%s/%s", LD_SOURCE_DIR, example);
    ld_model *model = NULL;
    ld_messages messages;
    assert_int_equal(ld_scenario_read(line, NULL, 0, &model, &messages), LD_OK);
    FILE *numbers = open_here("numbers");
    int equal = 0, other = 0;
    size_t row, column;
    double found, expected;
    while (fscanf(numbers, "%255s %lf %255s %zu %zu", path, &found, table, &row, &column) == 5) {
        if (ld_model_number(model, path, &expected, NULL))
            expected = in_table(model, table, row, column);
        if (isnan(expected)) // an integer, or one of a list of numbers
            other++;
        else if (found == expected)
            equal++;
        else
            fail_msg("%s is %.17g, not %.17g", path, expected, found);
    }
    fclose(numbers);
    ld_model_free(model);
    CHECK_WITHIN("numbers that are those by path", equal, least, 1000);
    CHECK_WITHIN("numbers without a path of their own", other, 0, 20);
}

static void test_check_has_the_numbers_of_the_model(void **state)
{
    (void)state;
    compare_with_paths("examples/fixed.yaml", 115);
    compare_with_paths("examples/reference.yaml", 420);
}

static void test_check_has_texts(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn check --json examples/fixed.yaml --set 'title=a \"b\"' | "
                         "jq -c '.scenario | [.title, .rocket.adaptors[0].name, .base.kind]'"),
                     0);
    assert_string_equal(shell.out, "[\"a \\\"b\\\"\",\"rear\",\"fixed\"]\n");
    // under scatter and sweep, whose values are texts of the scenario, nothing is taken apart
    assert_int_equal(
        run("launchdyn check --json examples/fixed.yaml --set 'sweep={rocket.mass: [60 kg, 61 kg]}'"
            " --set 'scatter={samples: 3, seed: 1, factors: {rocket.motor.thrust_scale: "
            "{normal: 1 %}, environment.temperature_offset: {normal: 2 K}}}' "
            "| jq -c '.points, .scenario.sweep, .scenario.scatter'"),
        0);
    assert_string_equal(shell.out, "2\n{\"rocket.mass\":[\"60 kg\",\"61 kg\"]}\n"
                                   "{\"seed\":1,\"samples\":3,\"plan\":\"random\",\"factors\":{"
                                   "\"rocket.motor.thrust_scale\":{\"normal\":0.01},"
                                   "\"environment.temperature_offset\":{\"normal\":\"2 K\"}}}\n");
}

static void test_check_tells_errors(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn check --json examples/fixed.yaml --set rocket.mas=1 --set "
                         "rocket.mass='1 m' >a.json"),
                     2);
    assert_string_equal(shell.err, "");
    assert_int_equal(run("jq -c '.ok, (.errors | length), .scenario, .errors[0]' a.json"), 0);
    assert_string_equal(shell.out, "false\n2\nnull\n{\"file\":\"--set\",\"line\":1,\"column\":8,"
                                   "\"path\":\"rocket.mas\",\"text\":\"unknown key, did you mean "
                                   "\\\"mass\\\"?\"}\n");
    // a file that is not there, a start that cannot be had, a warning with and without --strict
    assert_int_equal(run("launchdyn check --json none.yaml | jq -c '[.ok, .errors[0].file]'"), 0);
    assert_string_equal(shell.out, "[false,\"none.yaml\"]\n");
    assert_int_equal(run("launchdyn check --json examples/reference.yaml --set "
                         "platform.elevation.stabiliser.kp='0 N.m/rad' --set "
                         "platform.elevation.stabiliser.ki='4e6 N.m/rad/s' | "
                         "jq -c '[.ok, (.errors[] | .file, .path, (.text | .[:8]))]'"),
                     0);
    assert_string_equal(
        shell.out,
        "[false,\"examples/reference.yaml\",\"platform.elevation.stabiliser\",\"unstable\"]\n");
#define LOW "examples/fixed.yaml --set rocket.adaptors.rear.clearance='70 mm'"
    assert_int_equal(run("launchdyn check --json " LOW " | jq -c '[.ok, (.errors | length), "
                         ".notes[0].path, .scenario.rocket.adaptors[0].clearance]'"),
                     0);
    assert_string_equal(shell.out, "[true,0,\"rocket.adaptors.rear.clearance\",0.07]\n");
    assert_int_equal(run("launchdyn check --json --strict " LOW " >a.json"), 2);
    assert_int_equal(run("jq -c '[.ok, .notes, .errors[0].path]' a.json"), 0);
    assert_string_equal(shell.out, "[false,[],\"rocket.adaptors.rear.clearance\"]\n");
}

// run prints what summary.json keeps, but for CPU times and files, and nothing else; also of a
// launch that ends early.
static void test_run(void **state)
{
    (void)state;
#define SAME "jq -S 'del(.statistics, .files, .digest)' "
    assert_int_equal(run("launchdyn run --json examples/fixed.yaml --set run.end=tip -o j --report "
                         ">a.json; " SAME "a.json >printed; " SAME "j/summary.json >kept; "
                         "cmp printed kept && test -s j/report.html && launchdyn run -q --json "
                         "examples/fixed.yaml --set run.end=tip | " SAME "| cmp - kept"),
                     0);
    assert_string_equal(shell.out, "");
    assert_int_equal(run("jq -c '[.complete, (.rockets | length), .files]' a.json"), 0);
    assert_string_equal(shell.out, "[true,1,[]]\n");
    assert_int_equal(
        run("launchdyn run --json examples/fixed.yaml --set rocket.lock.release_force='1 MN' "
            ">a.json"),
        1);
    assert_int_equal(run("jq -c '[.complete, .stopped != null]' a.json"), 0);
    assert_string_equal(shell.out, "[false,true]\n");
    expect_complaint("launchdyn run --jsno x", 2, "unknown option --jsno (did you mean --json?)\n");
}

// A rattling rail at a coarse tolerance and a fine one: the warning of a run, and in a study the
// share of rockets whose rates are off by more than 1 %, against the exported column.
#define RATTLING                                                                                   \
    "examples/rail/pad.yaml --set run.end=tip --set rocket.contact.restitution=0.95 "              \
    "--set rocket.contact.stiffness='1e8 N/m' "
static void test_exit_errors(void **state)
{
    (void)state;
    double relative, noted, number[4];
    assert_int_equal(run("launchdyn run --json " RATTLING "--set run.tolerance=1e-3 | "
                         "jq -r '.rockets[0].exit_error.relative, .notes[0]'"),
                     0);
    assert_int_equal(sscanf(shell.out,
                            "%lf the exit rates of rail 1 may be off by %lf %%: integration "
                            "errors grow",
                            &relative, &noted),
                     2);
    CHECK_NEAR("error that the note tells [%]", noted, 100 * relative, 0.06 * noted);
    expect_in(shell.out, "; reduce run.tolerance\n");
    assert_int_equal(run("launchdyn run --json " RATTLING "--set run.tolerance=1e-7 | "
                         "jq -c '.notes'"),
                     0);
    assert_string_equal(shell.out, "[]\n");

    assert_int_equal(run("launchdyn study " RATTLING "-q -o e --set 'sweep={run.tolerance: [1e-3, "
                         "1e-7]}' --set 'scatter={samples: 4, seed: 1, factors: "
                         "{rocket.mass_error: {normal: 1 kg}}}'; launchdyn study show e --json | "
                         "jq -c '[.points[].exit_errors]' >shown; launchdyn study export e --csv "
                         "e.csv; cat shown"),
                     0);
    assert_int_equal(sscanf(shell.out,
                            "[{\"known\":%lf,\"above\":%lf},{\"known\":%lf,\"above\":%lf}]",
                            &number[0], &number[1], &number[2], &number[3]),
                     4);
    assert_int_equal(run("awk -F, 'NR == 1 {for (i = 1; i <= NF; i++) if ($i ~ "
                         "/exit_error.relative/) c = i; next} $c > 0.01 {n++} END {print n}' "
                         "e.csv"),
                     0);
    CHECK_NEAR("rockets off by more than 1 %", number[1], strtod(shell.out, NULL), 0);
    CHECK_WITHIN("of them", number[1], 1, 4);
    assert_true(number[0] == 4 && number[2] == 4 && number[3] == 0);
    char line[128];
    snprintf(line, sizeof line, "through integration errors: %.3g %% of 4 rockets\n",
             25 * number[1]);
    assert_int_equal(run("launchdyn study show e | grep 'exit rates off by more than 1 %'"), 0);
    expect_in(shell.out, line);
}

// More on standard error, or less; what is printed and the exit code are the same.
static void test_quiet_and_verbose(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn check -v examples/fixed.yaml >a; launchdyn check "
                         "examples/fixed.yaml | cmp - a; launchdyn modes -v examples/fixed.yaml; "
                         "launchdyn run -v examples/fixed.yaml -o r --report"),
                     0);
    static const char *const steps[] = {
        "launchdyn: read examples/fixed.yaml with 0 overrides: ",
        "launchdyn: found the initial state: ",
        "launchdyn: found the modes of the tube: ",
        "launchdyn: found the modes of the whole system about its equilibrium: ",
        "launchdyn: built the system: modes, coefficients, tables: ",
        "launchdyn: ran the launch from the equilibrium to its end: ",
        "launchdyn: wrote r: ",
        "launchdyn: wrote r/report.html: ",
    };
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
        expect_in(shell.err, steps[i]);
    assert_int_equal(run("launchdyn check -q " LOW "; launchdyn report -q r; "
                         "launchdyn road -q examples/reference.yaml"),
                     0);
    assert_string_equal(shell.out, "");
    assert_string_equal(shell.err, "");
    expect_complaint("launchdyn check -q examples/fixed.yaml --set rocket.mas=1", 2, "unknown key");
    expect_complaint("launchdyn check -qv examples/fixed.yaml", 2,
                     "--quiet and --verbose exclude each other");
}

// The same of the commands that print what they find, and of those that write a file: --quiet
// leaves JSON and files, a scenario on standard output, which is what new has been asked for.
static void test_every_command_is_quiet_or_verbose(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn new -v -o new.yaml >told; "
                         "launchdyn fmu -v export new.yaml -o a.fmu; "
                         "launchdyn study -q examples/fixed.yaml -o v --set run.end=tip --set "
                         "'scatter={samples: 2, seed: 1, factors: {rocket.mass: {normal: 1 kg}}}'; "
                         "launchdyn study show -v v >shown; "
                         "launchdyn study export -v v --csv v.csv"),
                     0);
    static const char *const steps[] = {"launchdyn: wrote new.yaml: ", "launchdyn: wrote a.fmu: ",
                                        "launchdyn: read v: ", "launchdyn: exported v: "};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
        expect_in(shell.err, steps[i]);
    assert_int_equal(run("launchdyn modes -q examples/fixed.yaml; launchdyn study show -q v; "
                         "launchdyn fmu -q export new.yaml -o b.fmu; cmp -s a.fmu b.fmu; "
                         "test -s b.fmu; launchdyn new -q -o q.yaml; "
                         "cmp new.yaml q.yaml"),
                     0);
    assert_string_equal(shell.out, "");
    assert_string_equal(shell.err, "");
    assert_int_equal(run("launchdyn modes -q --json examples/fixed.yaml | jq .format; "
                         "launchdyn study show -q --json v | jq .asked; "
                         "launchdyn new -q | cmp - new.yaml"),
                     0);
    assert_string_equal(shell.out, "1\n2\n");
}

// Each row of the text from the numbers of JSON.
static void compare_modes(const char *key)
{
    char line[256], text[1 << 14], row[256], shape[128];
    double frequency, damping;
    int count = 0;
    assert_int_equal(run("launchdyn modes examples/fixed.yaml"), 0);
    strcpy(text, shell.out);
    snprintf(line, sizeof line,
             "launchdyn modes --json examples/fixed.yaml | "
             "jq -r '.%s[] | \"\\(.frequency) \\(.damping) \\(.shape)\"' >modes",
             key);
    assert_int_equal(run(line), 0);
    FILE *file = open_here("modes");
    while (fscanf(file, "%lf %lf %127[^\n]", &frequency, &damping, shape) == 3) {
        snprintf(row, sizeof row, "\n%4d %16.4f %18.4f  %s\n", ++count, frequency, damping * 100,
                 shape);
        expect_in(text, row);
    }
    fclose(file);
    CHECK_WITHIN("modes that are those of the table", count, 10, 100);
}

static void test_modes(void **state)
{
    (void)state;
    compare_modes("tube");
    compare_modes("system");
    assert_int_equal(run("launchdyn modes examples/fixed.yaml | tail -1; launchdyn modes --json "
                         "examples/fixed.yaml | jq -r '.eigenvalues | length, .[-1].real, "
                         ".[-1].imaginary, .[-1].shape'"),
                     0);
    int count, listed;
    double real, imaginary, re, im;
    assert_int_equal(sscanf(shell.out, "%d %lf %lf %*[^\n] %d %lf %lf", &listed, &real, &imaginary,
                            &count, &re, &im),
                     6);
    assert_int_equal(count, listed);
    CHECK_NEAR("last eigenvalue, real [1/s]", re, real, 1e-5 * fabs(real));
    CHECK_NEAR("last eigenvalue, imaginary [rad/s]", im, imaginary, 1e-5 * fabs(imaginary) + 1e-9);
}

enum { SAMPLES = 8 };

static double column_of(const char *name, double value[SAMPLES])
{
    char line[256];
    snprintf(line, sizeof line,
             "awk -F, 'NR == 1 {for (i = 1; i <= NF; i++) if ($i ~ /^%s( |$)/) c = i; next} "
             "{print $c}' all.csv >values",
             name);
    assert_int_equal(run(line), 0);
    FILE *file = open_here("values");
    double sum = 0;
    for (int i = 0; i < SAMPLES; i++) {
        assert_int_equal(fscanf(file, "%lf", &value[i]), 1);
        sum += value[i] / SAMPLES;
    }
    fclose(file);
    return sum;
}

static void test_study(void **state)
{
    (void)state;
    double value[SAMPLES], mean = 0, deviation, least = INFINITY, square = 0, found[5];
    assert_int_equal(run("launchdyn study examples/fixed.yaml -q -o s --set run.end=tip --set "
                         "'scatter={samples: 8, seed: 1, factors: {rocket.mass: {normal: 1 kg}}}'; "
                         "launchdyn study export s --csv all.csv; "
                         "launchdyn study show s --json --what exit_speed,pitch_rate >a.json"),
                     0);
    mean = column_of("exit_speed", value);
    for (int i = 0; i < SAMPLES; i++) {
        square += (value[i] - mean) * (value[i] - mean);
        least = fmin(least, value[i]);
    }
    deviation = sqrt(square / (SAMPLES - 1));
    assert_int_equal(run("jq -r '.points[0] | .done, (.results[0] | .mean.value, .deviation.value, "
                         ".least, .mean.high)' a.json"),
                     0);
    assert_int_equal(sscanf(shell.out, "%lf %lf %lf %lf %lf", &found[0], &found[1], &found[2],
                            &found[3], &found[4]),
                     5);
    CHECK_NEAR("samples", found[0], SAMPLES, 0);
    CHECK_NEAR("mean exit speed [m/s]", found[1], mean, 1e-12);
    CHECK_NEAR("its deviation [m/s]", found[2], deviation, 1e-12);
    CHECK_NEAR("the least [m/s]", found[3], least, 0);
    // Student's t of 7 degrees of freedom, 97.5 %
    CHECK_NEAR("end of the interval [m/s]", found[4], mean + 2.364624 * deviation / sqrt(SAMPLES),
               1e-6);
    assert_int_equal(run("jq -c '[.format, .asked, (.points | length), .points[0].swept, "
                         "[.points[0].results[].name], .points[0].results[0].unit]' a.json"),
                     0);
    assert_string_equal(shell.out, "[1,8,1,{},[\"exit_speed\",\"pitch_rate\"],\"m/s\"]\n");
}

// Of rockets that leave near the vertical the study says so, and those that do not count none; a
// result is reported by its name of now.
static void test_study_near_the_vertical(void **state)
{
    (void)state;
    static const char said[] = "\n100 % of 2 rockets leave near the vertical";
    assert_int_equal(run("for e in 79 81; do launchdyn study examples/fixed.yaml -q -o u$e --set "
                         "run.end=tip --set base.elevation=$e' deg' --set 'scatter={samples: 2, "
                         "factors: {rocket.mass: {normal: 1 kg}}}'; done; "
                         "launchdyn study show u81"),
                     0);
    assert_non_null(strstr(shell.out, said));
    assert_true(strstr(shell.out, "\nsince_ignition.yaw ") < strstr(shell.out, "\nyaw "));
    assert_int_equal(run("launchdyn study show u79"), 0);
    assert_null(strstr(shell.out, "near the vertical"));
    assert_int_equal(run("for e in 79 81; do launchdyn study show u$e --json | jq -c "
                         "'.points[0].near_vertical'; done"),
                     0);
    assert_string_equal(shell.out, "{\"known\":2,\"above\":0}\n{\"known\":2,\"above\":2}\n");
}

// Former names of results and columns are accepted, and what they are called now is reported.
static void test_former_names(void **state)
{
    (void)state;
    char now[sizeof shell.out];
    assert_int_equal(run("launchdyn study show s --what since_ignition.yaw,exit_speed"), 0);
    snprintf(now, sizeof now, "%s", shell.out);
    assert_string_equal(shell.err, "");
    assert_int_equal(run("launchdyn study show s --what aim.yaw,muzzle_speed"), 0);
    assert_string_equal(shell.out, now);
    assert_string_equal(shell.err, "launchdyn: aim.yaw is called since_ignition.yaw now\n"
                                   "launchdyn: muzzle_speed is called exit_speed now\n");
    // in a file of measured launches, too
    assert_int_equal(run("printf 'muzzle_speed [m/s]\n38\n37.9\n38.1\n' >former.csv && "
                         "launchdyn study show s --measured former.csv"),
                     0);
    expect_in(shell.out, "measured in former.csv: 3 launches\nmuzzle_speed is called exit_speed "
                         "now\n");
    expect_in(shell.out, "\nexit_speed [m/s]");
    expect_complaint("printf 'muzzle_speed [m/s],exit_speed [m/s]\n38,38\n' >twice.csv; "
                     "launchdyn study show s --measured twice.csv",
                     2, "exit_speed: is given in an earlier column, too");
    // a linear response and its scatter of the exit
    static const char *const what[] = {"-w %s.vz", "--exit -w %s.yaw_rate"};
    for (int i = 0; i < 2; i++) {
        char line[128], part[64];
        for (int former = 0; former < 2; former++) {
            snprintf(part, sizeof part, what[i], former ? "aim" : "since_ignition");
            snprintf(line, sizeof line, "launchdyn response examples/reference.yaml --from 1 %s",
                     part);
            assert_int_equal(run(line), 0);
            if (!former)
                snprintf(now, sizeof now, "%s", shell.out);
        }
        assert_string_equal(shell.out, now);
        expect_in(shell.err, "is called since_ignition.");
    }
    // scenarios are refused, with the name of now
    expect_complaint("launchdyn check examples/salvo.yaml --set "
                     "'scatter.until={muzzle_speed.mean: 1 %}'",
                     2, "did you mean \"exit_speed.mean\"?");
}

static void test_study_sensitivity_and_ellipses(void **state)
{
    (void)state;
    // one factor explains all that is linear in it
    assert_int_equal(run("launchdyn study show s --json --sensitivity --what exit_speed | jq -r "
                         "'.points[0].results[0].factors[] | .path, .share.value'"),
                     0);
    char path[64];
    double share;
    assert_int_equal(sscanf(shell.out, "%63s %lf", path, &share), 2);
    assert_string_equal(path, "rocket.mass");
    CHECK_NEAR("share of the only factor", share, 1, 1e-4);
    // the centre of an ellipse is the mean of its two results
    assert_int_equal(run("launchdyn study show s --json --what pitch_rate,yaw_rate >a.json; jq -c "
                         "'.points[0] | .ellipses[0].of, (.ellipses[0].centre == "
                         "[.results[].mean.value]), .ellipses[0].count' a.json"),
                     0);
    assert_string_equal(shell.out, "[\"pitch_rate\",\"yaw_rate\"]\ntrue\n8\n");
    expect_complaint("launchdyn study examples/salvo.yaml --json --out x", 2,
                     "require study show DIR");
}

// The same numbers as text and as JSON; a study without landings has none.
static void test_study_footprints(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn study examples/range-safety.yaml --set scatter.samples=200 -q "
                         "--out safe && launchdyn study show safe --json | jq -r "
                         "'.points[0].footprints | length, .[0].share, .[0].stated, .[0].needed, "
                         ".[0].independent, .[0].content.low, .[0].area.value, .[0].distance.high, "
                         ".[1].stated, .[1].needed, .[1].area.value'"),
                     0);
    double low, area, farthest, found[3];
    assert_int_equal(
        sscanf(shell.out, "3 0.95 true 180 200 %lf %lf %lf false 900 null", &low, &area, &farthest),
        3);
    assert_int_equal(run("launchdyn study show safe | grep -A 4 '^footprints, for range safety: "
                         "where landings lie; 200 rockets'"),
                     0);
    assert_non_null(strstr(
        shell.out, "\n99 %     too few landings: 900 independent ones are needed, found 200\n"));
    const char *line = strstr(shell.out, "\n95 %     95 [");
    assert_non_null(line);
    assert_int_equal(sscanf(line, "\n95 %%     95 [%lf, %*f] %lf [%*f, %*f] %*f [%*f, %lf]",
                            &found[0], &found[1], &found[2]),
                     3);
    CHECK_NEAR("content, low [%]", found[0], 100 * low, 0.005);
    CHECK_NEAR("area", found[1] / area, 1, 1e-3);
    CHECK_NEAR("farthest point, high", found[2] / farthest, 1, 1e-3);
    assert_int_equal(run("launchdyn study show safe --json --what pitch_rate,apogee | jq -c "
                         "'.points[0].footprints'"),
                     0);
    assert_string_equal(shell.out, "[]\n");
    assert_int_equal(
        run("launchdyn study examples/line-thrower.yaml --set "
            "'environment.wind={speed: 5 m/s, heading: 90 deg}' --set "
            "'scatter={samples: 4, factors: {tubes.pressure.scale: {normal: 2 %}}}' -q --out "
            "thrown && launchdyn study show thrown --json | jq -c '.points[0] | "
            "(.footprints, .line_footprints) | length, .[0].needed' && launchdyn study show thrown "
            "| grep -A 2 'where the line lies; 48 places of lines' | tail -n 1"),
        0);
    assert_non_null(strstr(shell.out, "3\n180\n3\n180\n95 %     too few places of lines: 180 "));
    expect_complaint("launchdyn study show safe --footprint a.kml", 2,
                     "--footprint requires study export DIR");
    expect_complaint("launchdyn study examples/range-safety.yaml --footprint a.kml --out y", 2,
                     "--footprint require study export DIR");
    expect_complaint("launchdyn study export safe --footprint a.csv --csv a.csv", 2,
                     "different files for");
    expect_complaint("launchdyn study export safe --footprint a.json", 2,
                     "a file of footprints ends in .csv, .kml or .geojson");
    assert_int_equal(run("launchdyn study export safe --footprint b.geojson --csv b.csv; jq -c "
                         "'.type, [.features[].geometry.type]' b.geojson; wc -l <b.csv"),
                     0);
    assert_string_equal(shell.out,
                        "\"FeatureCollection\"\n[\"Point\",\"MultiPolygon\",null,null]\n201\n");
}

// Mardia's b1 and b2 of two columns by their definition, over all pairs.
static void mardia(const double x[SAMPLES], double mx, const double y[SAMPLES], double my,
                   double b[2])
{
    double xx = 0, xy = 0, yy = 0;
    for (int i = 0; i < SAMPLES; i++) {
        xx += (x[i] - mx) * (x[i] - mx) / SAMPLES;
        xy += (x[i] - mx) * (y[i] - my) / SAMPLES;
        yy += (y[i] - my) * (y[i] - my) / SAMPLES;
    }
    b[0] = b[1] = 0;
    for (int i = 0; i < SAMPLES; i++)
        for (int j = 0; j < SAMPLES; j++) {
            double ax = x[i] - mx, ay = y[i] - my, bx = x[j] - mx, by = y[j] - my;
            double g =
                (yy * ax * bx - xy * (ax * by + ay * bx) + xx * ay * by) / (xx * yy - xy * xy);
            b[0] += g * g * g / (SAMPLES * SAMPLES);
            b[1] += i == j ? g * g / SAMPLES : 0;
        }
}

static void test_study_normality(void **state)
{
    (void)state;
    double x[SAMPLES], y[SAMPLES], b[2], found[4];
    double mx = column_of("pitch_rate", x), my = column_of("yaw_rate", y);
    mardia(x, mx, y, my, b);
    assert_int_equal(run("launchdyn study show s --json --what pitch_rate,yaw_rate | jq -r "
                         "'.points[0].ellipses[0].normality | .tested, .normal, .skewness, "
                         ".kurtosis, .chance[], .effective'"),
                     0);
    double effective;
    assert_int_equal(sscanf(shell.out, "false false %lf %lf %lf %lf %lf", &found[0], &found[1],
                            &found[2], &found[3], &effective),
                     5);
    CHECK_NEAR("Mardia's b1", found[0], b[0], 1e-6 * b[0]);
    CHECK_NEAR("his b2", found[1], b[1], 1e-6 * b[1]);
    CHECK_NEAR("p of b1", found[2], exp(-b[0] * 8 / 12) * (1 + b[0] * 8 / 12), 1e-6);
    CHECK_NEAR("p of b2", found[3], erfc(fabs(b[1] - 8) / sqrt(64. / SAMPLES) / sqrt(2)), 1e-6);
    CHECK_NEAR("independent rockets", effective, SAMPLES, 1e-9);
    assert_int_equal(run("launchdyn study show s --what pitch_rate,yaw_rate"), 0);
    expect_in(shell.out, "Mardia's test of a normal distribution: too few independent rockets, "
                         "8 of 20\n");
}

// Launches that were measured in other units than SI: what JSON has of them, from the two means.
static void test_study_measured(void **state)
{
    (void)state;
    double value[SAMPLES], mean = column_of("t_rear", value), found[6];
    assert_int_equal(run("printf 't_rear [ms]\\n150\\n152\\n154\\n160\\n' >launches.csv; "
                         "launchdyn study show s --measured launches.csv --json >a.json; "
                         "jq -r '.launches, .salvos, (.points[0].comparisons[0] | "
                         ".measured.mean.value, .simulated.mean.value, .difference.value, "
                         ".difference.chance)' a.json"),
                     0);
    assert_int_equal(sscanf(shell.out, "%lf %lf %lf %lf %lf %lf", &found[0], &found[1], &found[2],
                            &found[3], &found[4], &found[5]),
                     6);
    CHECK_NEAR("launches", found[0], 4, 0);
    CHECK_NEAR("salvos", found[1], 0, 0);
    CHECK_NEAR("their mean [s]", found[2], 0.154, 1e-15);
    CHECK_NEAR("that of the study [s]", found[3], mean, 1e-15);
    CHECK_NEAR("difference [s]", found[4], 0.154 - mean, 1e-15);
    // the table has the same p, and the ratio of the deviations
    char chance[32], table[64];
    snprintf(chance, sizeof chance, " %.*g", found[5] < 0.1 ? 2 : 3, found[5]);
    assert_int_equal(run("launchdyn study show s --measured launches.csv | grep '^t_rear'"), 0);
    expect_in(shell.out, chance);
    assert_int_equal(run("jq -r '.points[0].comparisons[0] | .name, .unit, .ratio.value' a.json; "
                         "launchdyn study show s --measured launches.csv | grep '^    deviation'"),
                     0);
    assert_int_equal(sscanf(shell.out, "t_rear s %lf", &found[0]), 1);
    snprintf(table, sizeof table, " x %.4g [", found[0]);
    expect_in(shell.out, table);
}

// What is compared with a point, as the table in CSV has it.
static void test_study_against(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn study examples/fixed.yaml -q -o w --set run.end=tip --set "
                         "'scatter={samples: 3, seed: 1, factors: {rocket.mass: {normal: 1 kg}}}' "
                         "--set 'sweep={rocket.motor.thrust_scale: [1, 1.02]}'; launchdyn study "
                         "show w --against 1 --json --what pitch,yaw --csv w.csv >a.json; "
                         "jq -c '[.points[] | .reference, (.differences | length)]' a.json"),
                     0);
    assert_string_equal(shell.out, "[1,0,1,3]\n");
    assert_int_equal(run("jq -r '.points[] | .number as $n | .reference as $r | .differences[] | "
                         "[$n, $r, (.of | join(\" and \")), .unit, .pairs, .groups, "
                         "(.difference, .ratio, .ratio_within | .value, .low, .high)] | "
                         "map(. // \"\") | @tsv' a.json >json; "
                         "sed 1d w.csv | cut -d, -f1,3- | tr , '\\t' >csv; wc -l <csv; "
                         "paste -d '\\n' json csv | awk -F'\\t' '{for (i = 1; i <= NF; i++) "
                         "{if (NR % 2) kept[i] = $i; else if (kept[i] != $i && "
                         "kept[i] - $i != 0) print kept[i], $i}}'"),
                     0);
    assert_string_equal(shell.out, "3\n");
    expect_complaint("launchdyn study show w --against 3 --json", 2, "the study has no point 3");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_check_has_the_numbers_of_the_model),
        cmocka_unit_test(test_check_has_texts),
        cmocka_unit_test(test_check_tells_errors),
        cmocka_unit_test(test_run),
        cmocka_unit_test(test_exit_errors),
        cmocka_unit_test(test_quiet_and_verbose),
        cmocka_unit_test(test_every_command_is_quiet_or_verbose),
        cmocka_unit_test(test_modes),
        cmocka_unit_test(test_study),
        cmocka_unit_test(test_study_near_the_vertical),
        cmocka_unit_test(test_former_names),
        cmocka_unit_test(test_study_sensitivity_and_ellipses),
        cmocka_unit_test(test_study_footprints),
        cmocka_unit_test(test_study_normality),
        cmocka_unit_test(test_study_measured),
        cmocka_unit_test(test_study_against),
    };
    return cmocka_run_group_tests(tests, shell_make, shell_remove);
}
