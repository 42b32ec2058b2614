// The command as a user meets it: what it prints, its exit codes, the files it leaves.
#include "support/check.h"
#include "support/shell.h"

#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

// No number of what was printed is a negative one rounded to nothing: " -0.000".
static void expect_no_negative_zero(void)
{
    for (const char *at = shell.out; (at = strstr(at, " -0")); at++) {
        const char *end = at + 2 + strspn(at + 2, "0.");
        if (strspn(end, "0123456789e") == 0)
            fail_msg("%.*s in:\n%s", (int)(end - at), at, shell.out);
    }
}

static void test_help_and_version(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn version"), 0);
    assert_memory_equal(shell.out, "launchdyn ", 10);
    assert_int_equal(run("launchdyn --version"), 0);
    assert_memory_equal(shell.out, "launchdyn ", 10);
    assert_int_equal(run("launchdyn help"), 0);
    expect_in(shell.out, "  modes        FILE       List natural frequencies");
    assert_string_equal(shell.err, "");
    assert_int_equal(run("launchdyn help >a; launchdyn --help >b; cmp a b"), 0);
    assert_int_equal(run("launchdyn help run"), 0);
    expect_in(shell.out, "Usage: launchdyn run");
    expect_in(shell.out, "--set PATH=VALUE");
    assert_int_equal(run("launchdyn plot -h"), 0);
    expect_in(shell.out, "tip-rate");
    // what takes no options has the help of all
    assert_int_equal(run("launchdyn help --help >b; launchdyn help -h >c; launchdyn version --help "
                         ">d; launchdyn help help >e; cmp a b && cmp a c && cmp a d && cmp a e"),
                     0);
    expect_complaint("launchdyn help --halp", 2, "unknown option --halp");
    // a space at least between a command's arguments and what it does
    assert_int_equal(run("launchdyn help | grep -E 'DIR[A-Z]|FILE[A-Z]|\\][A-Z]'"), 1);
    assert_int_equal(run("launchdyn help"), 0);
    expect_in(shell.out, "  study        FILE | show DIR | plot DIR | export DIR | merge DIR\n"
                         "                          Run a Monte Carlo study or a sweep");
}

static void test_wrong_words(void **state)
{
    (void)state;
    expect_complaint("launchdyn", 2, "Usage: launchdyn COMMAND");
    expect_complaint("launchdyn rum x", 2, "launchdyn: unknown command rum (did you mean run?)\n");
    expect_complaint("launchdyn abracadabra", 2,
                     "launchdyn: unknown command abracadabra; see launchdyn help\n");
    expect_complaint("launchdyn help rum", 2, "unknown command rum (did you mean run?)\n");
    expect_complaint("launchdyn run --cvs x", 2, "unknown option --cvs (did you mean --csv?)\n");
    expect_complaint("launchdyn run -z x", 2, "launchdyn: -z: unknown option\n");
    expect_complaint("launchdyn run x --out", 2, "launchdyn: --out: missing argument\n");
    expect_complaint("launchdyn run x -qo", 2, "launchdyn: -qo: missing argument\n");
    expect_complaint("launchdyn run x --csv=1", 2, "launchdyn: --csv takes no value\n");
    expect_complaint("launchdyn wind x --rocket 1.5", 2,
                     "launchdyn: --rocket: found 1.5, expected a whole number\n");
    expect_complaint("launchdyn wind x --rocket 9999999999", 2,
                     "--rocket: found 9999999999, expected a whole number");
    expect_complaint("launchdyn wind x --top ''", 2,
                     "launchdyn: --top: found \"\", expected a number in m\n");
    expect_complaint("launchdyn wind x --top '2 s'", 2,
                     "--top: found \"2 s\", expected a number in m\n");
    assert_int_equal(run("launchdyn wind examples/salvo.yaml --top 1500 >a; launchdyn wind "
                         "examples/salvo.yaml --top '1.5 km' >b; cmp a b && test -s a"),
                     0);
    expect_complaint("launchdyn run", 2,
                     "launchdyn: run requires FILE; see launchdyn run --help\n");
    expect_complaint("launchdyn run a b", 2, "launchdyn: run requires FILE");
    expect_complaint("launchdyn run examples/fixed.yaml --csv", 2, "--csv requires --out DIR\n");
    expect_complaint("launchdyn run examples/fixed.yaml --report", 2,
                     "--report requires --out DIR\n");
    expect_complaint("launchdyn report x", 2, "no results in x: There is no history.h5");
    expect_complaint("launchdyn report x y", 2, "report of several folders requires -o FILE\n");
    expect_complaint("launchdyn report x y -o z.html", 2, "no run to report: no results in x");
    expect_complaint("launchdyn plot x", 2, "plot requires -o FILE.svg");
    expect_complaint("launchdyn plot x --what tipp -o x.svg", 2, "did you mean tip?");
    expect_complaint("launchdyn plot x -o x.svg", 2, "no results in x");
}

// Before the words, after them and between; a value apart or not; no option after "--".
static void test_ways_to_write_options(void **state)
{
    (void)state;
    assert_int_equal(run("for words in '-qo a s.yaml' 's.yaml --out=a -q' '--quiet s.yaml --out a' "
                         "'-oa --qui -- s.yaml'; do rm -rf a; cp examples/fixed.yaml s.yaml; "
                         "launchdyn run --set run.end=tip $words && ls a; done"),
                     0);
    assert_string_equal(shell.out, "history.h5\nsummary.json\nhistory.h5\nsummary.json\n"
                                   "history.h5\nsummary.json\nhistory.h5\nsummary.json\n");
    expect_complaint("launchdyn run -- --csv", 2, "--csv: error: file \"--csv\" cannot be read");
    expect_complaint("launchdyn check - --set rocket.mas=1 --set=rocket.empt=2 <s.yaml", 2,
                     "--set:1:8: error: rocket.mas: unknown key");
    expect_in(shell.err, "--set:2:8: error: rocket.empt: unknown key");
}

static void test_wrong_words_of_a_study(void **state)
{
    (void)state;
#define STUDY "launchdyn study examples/salvo.yaml --out x "
    expect_complaint(STUDY "--only 0", 2, "there is no sample 0: they go from 1 to 10\n");
    expect_complaint(STUDY "--only 11", 2, "there is no sample 11");
    expect_complaint(STUDY "--only 2 --shard 1/2", 2, "--only and --shard exclude each other");
    expect_complaint(STUDY "--join --shard 1/2", 2, "--join excludes --shard and --only\n");
    expect_complaint(STUDY "--join --only 1", 2, "--join excludes --shard and --only\n");
    expect_complaint(STUDY "--expiry 9", 2, "--expiry requires --join\n");
    expect_complaint(STUDY "--join --expiry -1", 2,
                     "--expiry: expected a number of seconds from 1 to 86400\n");
    expect_complaint(STUDY "--shard 4/3", 2, "--shard: expected I/N, from 1/N to N/N, found 4/3\n");
    expect_complaint(STUDY "-j 0", 2, "--jobs: expected a number from 1 to 1024\n");
    expect_complaint(STUDY "-j 1000000", 2, "--jobs: expected a number from 1 to 1024\n");
    expect_complaint(STUDY "--csv x.csv", 2, "require study export DIR\n");
    expect_complaint(STUDY "--sensitivity", 2,
                     "--sensitivity requires total, first or morris, or study show DIR\n");
    expect_complaint(STUDY "--sensitivity=all", 2,
                     "--sensitivity: found all, expected total|first|morris\n");
    expect_complaint("launchdyn study --again x --out y --sensitivity total", 2,
                     "--sensitivity excludes --again FOLDER, which repeats the plan stored in "
                     "FOLDER\n");
    expect_complaint("launchdyn study plot x --sensitivity first --over base.speed", 2,
                     "study plot --sensitivity takes --what and --out\n");
    expect_complaint(STUDY "--measured x.csv", 2, "require study show DIR\n");
    expect_complaint("launchdyn study show x --measured x.csv --over base.speed", 2,
                     "--measured excludes --sensitivity, --against, --over and --statistic\n");
    expect_complaint("launchdyn study show x --and base.speed", 2, "--and requires --over KEY\n");
    expect_complaint("launchdyn study show x --map", 2, "--map requires study plot DIR\n");
    expect_complaint("launchdyn study plot x --json", 2,
                     "study plot takes --what, --over, --and, --against, --statistic, --map, "
                     "--sensitivity and --out\n");
    expect_complaint(STUDY "--map", 2,
                     "--over, --and, --statistic and --map require study show DIR or study plot "
                     "DIR\n");
    expect_complaint(STUDY "--against 1", 2, "require study show DIR\n");
    expect_complaint("launchdyn study show x --against 1 --sensitivity", 2,
                     "--sensitivity excludes --against, --over and --statistic\n");
    expect_complaint("launchdyn study show x --csv y.csv", 2,
                     "--csv and --hdf5 require study export DIR, or --csv");
    expect_complaint("launchdyn report x --measured x.csv", 2,
                     "--measured requires at least one study\n");
    expect_complaint("launchdyn study show", 2, "study merge require DIR\n");
    expect_complaint("launchdyn study shwo x", 2,
                     "study: expected show DIR, plot DIR, export DIR or merge DIR, found shwo");
    expect_complaint("launchdyn study examples/salvo.yaml", 2, "study requires --out DIR");
    assert_int_equal(run("test -e x"), 1);
}

static void test_run_writes_results(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out a/b --csv"), 0);
    expect_in(shell.out, "\n  exit speed ");
    assert_string_equal(shell.err, "");
    assert_int_equal(run("ls a/b; jq -r '.complete, .rockets[0].tube' a/b/summary.json"), 0);
    assert_string_equal(shell.out, "history.csv\nhistory.h5\nsummary.json\ntrue\n8\n");
    // the exit of the summary is the last row with the rocket in it
    assert_int_equal(
        run("awk -F, 'NR==1 {for (i = 1; i <= NF; i++) if ($i == \"rocket.s_dot [m/s]\")"
            " c = i} $c != \"nan\" {v = $c} END {print v}' a/b/history.csv; "
            "jq '.rockets[0].exit_speed' a/b/summary.json"),
        0);
    double last = 0, speed = 1;
    assert_int_equal(sscanf(shell.out, "%lf %lf", &last, &speed), 2);
    CHECK_NEAR("last s_dot of the history [m/s]", last, speed, 1e-13);
    assert_int_equal(run("grep -c . a/b/history.csv"), 0);
    CHECK_WITHIN("lines of history.csv, 0.16 s at 0.1 ms", atof(shell.out), 1580, 1620);
    assert_int_equal(run("launchdyn plot a/b -o a/b/x.svg && rsvg-convert a/b/x.svg >/dev/null"),
                     0);
}

static void test_report(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out a --report --quiet; ls a"), 0);
    assert_string_equal(shell.out, "history.h5\nreport.html\nsummary.json\n");
    assert_int_equal(run("launchdyn report a -o b.html && cmp a/report.html b.html"), 0);
    expect_in(shell.out, "b.html: ");
    assert_int_equal(run("rm a/summary.json; launchdyn report a"), 0);
    assert_string_equal(
        shell.err,
        "launchdyn: No summary: summary.json is missing: the files cannot be verified.\n");
    expect_complaint("launchdyn report a -o none/b.html", 3, "none/b.html: No such file");
}

static void test_table_alone_writes_nothing(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn run examples/flight.yaml --set flight.rate='0 0 0 rad/s' --set "
                         "rocket.aerodynamics.fin_cant='0 deg'"),
                     0);
    expect_no_negative_zero();
    assert_int_equal(run("launchdyn run examples/fixed.yaml && ls"), 0);
    expect_no_negative_zero();
    expect_in(shell.out, "examples\nlaunchdyn\n");
    assert_int_equal(run("launchdyn run examples/fixed.yaml --quiet"), 0);
    assert_string_equal(shell.out, "");
    assert_string_equal(shell.err, "");
}

static void test_set_overrides(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn check examples/fixed.yaml --set rocket.mass='61 kg' "
                         "--set 'title=other title'"),
                     0);
    expect_in(shell.out, "mass: 61");
    expect_in(shell.out, "other title");
    assert_int_equal(run("launchdyn run examples/fixed.yaml -q -o light; "
                         "launchdyn run examples/fixed.yaml -q -o heavy --set rocket.mass='61 kg'; "
                         "jq .rockets[0].exit_speed light/summary.json heavy/summary.json"),
                     0);
    double light = 0, heavy = 0;
    assert_int_equal(sscanf(shell.out, "%lf %lf", &light, &heavy), 2);
    // v^2 = 2 (F/m - g sin) s roughly: 1 kg of 60 costs about 0.8 % of the speed
    CHECK_WITHIN("speed lost to 1 kg, share", (light - heavy) / light, 0.006, 0.011);
    // check prints a scenario that reads back as itself
    assert_int_equal(run("launchdyn check examples/fixed.yaml >one.yaml && "
                         "launchdyn check one.yaml >two.yaml && cmp one.yaml two.yaml"),
                     0);
}

#define SWEEP(mass)                                                                                \
    "{ echo 'include: examples/fixed.yaml'; "                                                      \
    "echo 'sweep: {rocket.empty.mass: [30 kg, " mass " kg]}'; } >sweep.yaml; "

// A start that is refused leaves no number as if computed, and its reason stands once.
static void test_refused_start(void **state)
{
    (void)state;
    expect_complaint("launchdyn run examples/fixed.yaml --set rocket.start_at=2m --out refused", 1,
                     "rocket.start_at: no static equilibrium");
    assert_string_equal(shell.out, "");
    assert_int_equal(run("grep -q '\"slot_force\": null' refused/summary.json && "
                         "grep -q '\"max_slot_force\": null' refused/summary.json && "
                         "grep -q '\"thrust\": null' refused/summary.json"),
                     0);
    assert_int_equal(run("launchdyn run examples/fixed.yaml --set run.start=undeformed"), 0);
    assert_null(strstr(shell.out, "Equilibrium at the start"));
}

static void test_check_of_a_sweep(void **state)
{
    (void)state;
    // from standard input as from a file
    assert_int_equal(run(SWEEP("33") "launchdyn check sweep.yaml >one.yaml && "
                                     "launchdyn check - <sweep.yaml >two.yaml && "
                                     "cmp one.yaml two.yaml && grep -q 33 two.yaml"),
                     0);
    expect_complaint(SWEEP("70") "launchdyn check sweep.yaml", 2,
                     "sweep.yaml:2:36: error: rocket.");
    expect_in(shell.err, "the error is in point 2 of the sweep: rocket.empty.mass 70 kg\n");
    expect_complaint(SWEEP("70") "launchdyn check - <sweep.yaml", 2,
                     "<stdin>:2:36: error: rocket.");
    expect_in(shell.err, "the error is in point 2 of the sweep: rocket.empty.mass 70 kg\n");
    // whose run cannot start: the place is that of the value
    expect_complaint("{ echo 'include: examples/fixed.yaml'; "
                     "echo 'sweep: {rocket.start_at: [0.1 m, 2 m]}'; } >sweep.yaml; "
                     "launchdyn check sweep.yaml",
                     1, "sweep.yaml:2:34: error: rocket.start_at: no static equilibrium");
    expect_in(shell.err, "the error is in point 2 of the sweep: rocket.start_at 2 m\n");
}

static void test_bad_input_leaves_nothing(void **state)
{
    (void)state;
    expect_complaint("launchdyn run none.yaml --out o", 2, "none.yaml: error: ");
    expect_complaint("launchdyn run examples/fixed.yaml --out o --set rocket.mas='61 kg'", 2,
                     "rocket.mas: unknown key, did you mean \"mass\"?");
    expect_complaint("launchdyn check examples/fixed.yaml --set rocket.mass=61", 2, "rocket.mass");
    expect_complaint("launchdyn modes examples/fixed.yaml --set rocket.mass=-1kg", 2,
                     "rocket.mass");
    expect_complaint("launchdyn modes examples/flight.yaml", 2,
                     "launchdyn: a scenario of flight only has no launcher and no modes\n");
    assert_int_equal(run("ls"), 0);
    assert_string_equal(shell.out, "examples\nlaunchdyn\n");
}

static void test_places_that_cannot_be_written(void **state)
{
    (void)state;
    expect_complaint("launchdyn run examples/fixed.yaml --out /dev/null/x", 3,
                     "launchdyn: cannot make the folder /dev/null/x: Not a directory\n");
    expect_complaint("launchdyn version >/dev/full", 3,
                     "launchdyn: cannot print: No space left on device\n");
}

static void test_a_launch_that_cannot_happen(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out o "
                         "--set rocket.lock.release_force='50 kN' --set run.stuck_time='50 ms'"),
                     1);
    expect_in(shell.err, "launchdyn: the lock never released");
    expect_in(shell.out, "\nStopped at ");
    assert_int_equal(run("jq -r '.complete, .stopped, .rockets[0].t_release' o/summary.json"), 0);
    expect_in(shell.out, "false\nthe lock never released");
    expect_in(shell.out, "\nnull\n");
    assert_int_equal(run("h5dump -a /stopped o/history.h5 && h5dump -H -d /history/t o/history.h5"),
                     0);
    expect_in(shell.out, "the lock never released");
    assert_int_equal(run("launchdyn plot o -o o/x.svg"), 0);
    // milliseconds, of which the run has 50
    assert_int_equal(run("launchdyn plot o --from 20 --to 30 -o o/part.svg"), 0);
}

// Whether the process has a handler for the signal yet.
static bool catches(pid_t process, int number)
{
    char path[64], line[128];
    unsigned long long caught = 0;
    snprintf(path, sizeof path, "/proc/%d/status", process);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file))
        sscanf(line, "SigCgt: %llx", &caught);
    fclose(file);
    return caught >> (number - 1) & 1;
}

// The process in which a run does its work, once it listens to the signal.
static pid_t worker_of(pid_t process, int number)
{
    char path[64];
    int worker = 0;
    snprintf(path, sizeof path, "/proc/%d/task/%d/children", process, process);
    while (worker == 0 || !catches(worker, number)) {
        FILE *file = fopen(path, "r");
        assert_non_null(file);
        if (fscanf(file, "%d", &worker) != 1)
            worker = 0;
        fclose(file);
        usleep(10000);
    }
    return worker;
}

// Starts a run of a thousand seconds.
static pid_t start_endless(bool nohup)
{
    char command[512];
    snprintf(command, sizeof command,
             "cd %s && exec ./launchdyn run examples/fixed.yaml -q --out stopped "
             "--set run.stuck_time='1000 s' --set rocket.lock.release_force='50 kN' "
             ">.out 2>.err",
             shell.folder);
    pid_t child = fork();
    if (child == 0) {
        if (nohup)
            signal(SIGHUP, SIG_IGN);
        execl("/bin/sh", "sh", "-c", command, (char *)NULL);
        _exit(127);
    }
    return child;
}

// It is asked to stop by the signal: it does not go to its end, which would be another exit code.
static void stop_by(int number)
{
    pid_t child = start_endless(false), worker = worker_of(child, number);
    int status = 0;
    kill(child, number);
    kill(worker, number); // as by who asks all processes of a group: it counts once
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 128 + number);
    assert_int_equal(run("jq -r .complete stopped/summary.json; ls stopped"), 0);
    assert_string_equal(shell.out, "false\nhistory.h5\nsummary.json\n");
}

static void test_interrupted(void **state)
{
    (void)state;
    stop_by(SIGINT);
    stop_by(SIGTERM);
    stop_by(SIGHUP);
    // nohup stays what it is
    pid_t child = start_endless(true);
    bool caught = catches(worker_of(child, SIGTERM), SIGHUP);
    kill(child, SIGTERM);
    waitpid(child, NULL, 0);
    assert_false(caught);
}

// Its work is ended by what it cannot catch: one sentence, and no half a file.
static void test_killed_at_work(void **state)
{
    (void)state;
    int status = 0;
    char part[128];
    snprintf(part, sizeof part, "%s/stopped/history.h5.part", shell.folder);
    pid_t child = start_endless(false);
    while (access(part, F_OK) != 0)
        usleep(10000);
    kill(worker_of(child, SIGTERM), SIGKILL);
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 3);
    read_back(".err", shell.err, sizeof shell.err);
    assert_string_equal(shell.err, "launchdyn: ended by signal 9 (Killed) while writing "
                                   "stopped/history.h5.part\n");
    assert_int_equal(run("ls stopped"), 0);
    assert_string_equal(shell.out, "");
    // with the one that waits it ends, too; until then a second one keeps away from its folder
    child = start_endless(false);
    pid_t worker = worker_of(child, SIGTERM);
    while (access(part, F_OK) != 0)
        usleep(10000);
    expect_complaint("launchdyn run examples/fixed.yaml -q --out stopped", 2,
                     "another launchdyn process uses stopped: wait until it ends");
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    while (kill(worker, 0) == 0)
        usleep(10000);
    assert_int_equal(run("launchdyn run examples/fixed.yaml -q --out stopped && ls -A stopped"), 0);
    assert_string_equal(shell.out, "history.h5\nsummary.json\n");
}

static void test_modes_table(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn modes examples/fixed.yaml"), 0);
    expect_in(shell.out, "Undamped frequencies of tube and tail on their supports, base fixed\n");
    expect_in(shell.out, "rocket");
    expect_in(shell.out, "Eigenvalues of the damped system\n");
    double frequency = 0;
    const char *row = strstr(shell.out, "\n   1 ");
    assert_non_null(row);
    frequency = strtod(row + 5, NULL);
    CHECK_WITHIN("first frequency on the supports [Hz]", frequency, 67.20, 67.22);
    CHECK_WITHIN("its damping [%], more than that of the modes alone", strtod(row + 22, NULL), 1,
                 50);
}

// The table speaks of the scenario's own guide, shapes too.
static void test_words_of_the_guide(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn run examples/rail/pad.yaml --set run.end=tip | tee pad; "
                         "launchdyn modes examples/rail/pad.yaml >>pad"),
                     0);
    expect_in(shell.out, "\nNatural frequencies of the rail on its supports [Hz]\n");
    expect_in(shell.out, "\n  rail, vertical plane   ");
    expect_in(shell.out, "\nRocket of rail 1, instants");
    expect_in(shell.out, "\n  front shoe leaves   ");
    assert_int_equal(run("grep -icE 'tube|adaptor|slot' pad"), 1);
    assert_int_equal(run("launchdyn run examples/rail/tower.yaml --set run.end=tip | "
                         "grep -E 'tower on its|tower, twist|^Rocket of tower 1' | wc -l"),
                     0);
    assert_string_equal(shell.out, "3\n");
    assert_int_equal(
        run("launchdyn run examples/student-rocket/student-rocket.yaml --set run.end=tip"), 0);
    expect_in(shell.out, "note: the rocket of rail 1 leaves near the vertical (pitch 89.8");
    // adaptors keep the names that the scenario gives them
    assert_int_equal(run("launchdyn run examples/rail/pad.yaml --set run.end=tip --set "
                         "'rocket.adaptors=[{name: tube, at: 0 m}, {name: "
                         "front, at: 1.6 m}]' | grep -c 'tube shoe leaves'"),
                     0);
}

// Without a slot nothing has forces of one: table, summary, columns, figures.
static void test_no_slot(void **state)
{
    (void)state;
#define SMOOTH "launchdyn run examples/fixed.yaml --set tubes.slot=none --set run.end=tip "
    assert_int_equal(run(SMOOTH "-o smooth --csv >table; launchdyn plot smooth --what slot "
                                "-o slot.svg; ! grep -i slot table && ! head -1 smooth/history.csv "
                                "| tr , '\\n' | grep slot"),
                     0);
    assert_int_equal(run("jq -c 'del(.scenario, .source) | paths | map(tostring) | join(\".\")' "
                         "smooth/summary.json | grep -c slot"),
                     1);
    assert_int_equal(run("jq '.energy.work | keys_unsorted | join(\",\")' smooth/summary.json"), 0);
    assert_string_equal(shell.out, "\"thrust,gravity_rocket,contact_normal,contact_friction,lock,"
                                   "support_damping,modal_damping,base,mass_change\"\n");
}

// The number that stands in the line of a quantity after its unit.
static double number_of(const char *name)
{
    const char *row = strstr(shell.out, name);
    assert_non_null(row);
    row += strcspn(row, " ");
    row += strspn(row, " ");
    return strtod(row + strcspn(row, " "), NULL);
}

static void test_response(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn response examples/reference.yaml --out a/c --plot a/c/s.svg "
                         "--what chassis.vy,elevation.torque"),
                     0);
    expect_in(shell.out, "Response to a road of class A, tracks same, 30 km/h; linear about the "
                         "equilibrium, no Coulomb friction in the hinges\n");
    CHECK_WITHIN("rms of chassis.vy [mm/s]", number_of("chassis.vy"), 12.2, 12.3);
    CHECK_WITHIN("of elevation.torque [N m]", number_of("elevation.torque"), 274, 276);
    assert_int_equal(run("launchdyn response examples/reference.yaml --speeds '0:60:20 km/h' "
                         "--what chassis.vy --out a/d"),
                     0);
    expect_in(shell.out, "at               0 km/h      60 km/h     greatest  at [km/h]\n");
    assert_int_equal(run("launchdyn response examples/fixed.yaml -i base.y -w tip.inertial_y "
                         "--from 0.01 --to 10 -o a/d -p a/d/g.svg"),
                     0);
    expect_in(shell.out, "Response to base.y; linear");
    assert_int_equal(run("ls a/c a/d; for f in a/c/*.csv a/d/*.csv; do head -n 1 $f; done; "
                         "wc -l <a/d/response-rms.csv; sed -n 2p a/d/response-rms.csv"),
                     0);
    assert_string_equal(shell.out,
                        "a/c:\nresponse-rms.csv\nresponse-spectrum.csv\ns.svg\n\n"
                        "a/d:\ng.svg\nresponse-frequency.csv\nresponse-rms.csv\n"
                        "speed [m/s],chassis.vy [m/s],elevation.torque [N.m]\n"
                        "frequency [Hz],chassis.vy [(m/s)2/Hz],elevation.torque [(N.m)2/Hz]\n"
                        "frequency [Hz],tip.inertial_y.amplitude [m per m],"
                        "tip.inertial_y.phase [rad]\n"
                        "speed [m/s],chassis.vy [m/s]\n5\n0,0\n");
    assert_int_equal(run("launchdyn response examples/reference.yaml -w "
                         "since_ignition.pitch,thrust,chassis.vy,since_ignition.vz "
                         "-p a/d/h.svg"),
                     0);
    expect_in(shell.out,
              "\n\nWithout a value before the launch: since_ignition.pitch, since_ignition.vz\n");
    assert_int_equal(run("launchdyn response examples/reference.yaml --list"), 0);
    expect_in(shell.out, "Inputs\n  road ");
    expect_in(shell.out, "  elevation.command                rad        elevation: commanded");
    expect_in(shell.out, "\n\nQuantities\n  t ");
}

static void test_random_input(void **state)
{
    (void)state;
    assert_int_equal(
        run("mkdir -p a; printf 'frequency [Hz],density [m2/Hz]\\n2,0\\n5,4e-6\\n8,0\\n' >a/d.csv; "
            "launchdyn response examples/fixed.yaml -i base.y --density a/d.csv "
            "-w base.y,tip.y -o a/e -p a/e/d.svg"),
        0);
    expect_in(shell.out, "Response to base.y, random as a/d.csv says; linear");
    expect_in(shell.out,
              "\n  base.y                     mm              3.464                  5\n");
    assert_int_equal(run("ls a/e; head -n 1 a/e/response-spectrum.csv"), 0);
    assert_string_equal(shell.out, "d.svg\nresponse-rms.csv\nresponse-spectrum.csv\n"
                                   "frequency [Hz],base.y [m2/Hz],tip.y [m2/Hz]\n");
    static const struct {
        const char *text, *said;
    } wrong[] = {
        {"1,2,3", "1:1: expected two numbers, a frequency in Hz and a density\n"},
        {"1,2\\n2,-1", "2:3: expected a number >= 0\n"},
        {"1,2\\n1,1", "2:1: the frequencies must rise\n"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char line[256], said[128];
        snprintf(line, sizeof line,
                 "printf '%s\\n' >a/w.csv; launchdyn response examples/fixed.yaml -i base.y "
                 "--density a/w.csv",
                 wrong[i].text);
        snprintf(said, sizeof said, "launchdyn: a/w.csv:%s", wrong[i].said);
        assert_int_equal(run(line), 2);
        assert_string_equal(shell.err, said);
    }
    assert_int_equal(run("launchdyn response examples/fixed.yaml -i base.y --density a/none.csv"),
                     2);
    assert_string_equal(shell.err, "launchdyn: a/none.csv: cannot be read: No such file or "
                                   "directory\n");
}

static void test_exit_scatter(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn response examples/reference.yaml --exit --draws 4 -o a/x "
                         "--what pitch_rate,t_release"),
                     0);
    expect_in(shell.out, "Scatter of the exit on a road of class A, tracks same, 30 km/h; linear "
                         "about the equilibrium, friction of the hinges linearised for the motion "
                         "on the road\n4 launches with sampled phases of the road\n");
    CHECK_WITHIN("mean of pitch_rate [mrad/s]", number_of("pitch_rate"), -260, -230);
    assert_int_equal(run("head -n 1 a/x/response-exit.csv"), 0);
    assert_string_equal(shell.out,
                        "speed [m/s],pitch_rate.mean [rad/s],pitch_rate.deviation [rad/s],"
                        "t_release.mean [s],t_release.deviation [s]\n");
    assert_int_equal(run("launchdyn response examples/reference.yaml --exit --what pitch_rate "
                         "--set base.road.harmonics=2"),
                     0);
    expect_in(shell.out, "\nFirst order in the road: contacts that open and close make some "
                         "deviations too large, pitch and yaw by up to one half; --draws N has no "
                         "such error\n");
}

static void test_loop(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn response examples/reference.yaml --loop elevation -o a/l -p "
                         "a/l/l.svg --set platform.elevation.stabiliser.sample='5 ms' "
                         "--set platform.elevation.stabiliser.delay='5 ms'"),
                     0);
    expect_in(shell.out, "Loop of the elevation, 30 km/h; linear about the equilibrium");
    expect_in(shell.out,
              "\n  gain margin upwards, factor             1.569    3.91 dB, at 31.89 Hz\n");
    expect_in(shell.out, "\n  phase                                   28.39 degrees\n");
    expect_in(shell.out, "\n  peak of the sensitivity                 3.252 at 27.39 Hz\n");
    expect_in(shell.out, "\n  largest share of the chassis' rotation   0.004128 at 23.92 Hz\n");
    // phases are drawn in degrees, with ticks of 90
    assert_int_equal(run("sed 's/<[^>]*>//g' a/l/l.svg | tr -d ' \\t' | "
                         "grep -xe '-180' -e '-90' -e 90 -e 180"),
                     0);
    assert_string_equal(shell.out, "-180\n-90\n90\n180\n");
    assert_int_equal(run("launchdyn response examples/multibody/ship-turntable.yaml --loop lift"),
                     0);
    expect_in(shell.out, "Loop of the lift; linear about the equilibrium");
    expect_in(shell.out, "\n  phase                                   82.07 degrees\n");
    assert_null(strstr(shell.out, "chassis"));
    assert_int_equal(run("launchdyn response examples/reference.yaml --loop azimuth"), 0);
    expect_in(shell.out, "\n  gain margin upwards, factor               any\n");
    expect_in(shell.out, "\n  sensitivity above one                 nowhere\n");
    assert_int_equal(run("ls a/l; head -n 1 a/l/response-loop.csv"), 0);
    assert_string_equal(shell.out, "l.svg\nresponse-loop.csv\n"
                                   "frequency [Hz],open.amplitude [1],open.phase [rad],"
                                   "tracking.amplitude [1],tracking.phase [rad],"
                                   "sensitivity.amplitude [1],sensitivity.phase [rad],"
                                   "rejection.amplitude [1],rejection.phase [rad]\n");
}

static void test_response_of_what_is_not_there(void **state)
{
    (void)state;
    static const struct {
        const char *line, *said;
    } wrong[] = {
        {"examples/reference.yaml --speeds 0:60",
         "launchdyn: --speeds: found \"0:60\", expected FROM:TO:STEP in km/h, such as 0:60:1\n"},
        {"examples/reference.yaml --speeds 10:60:0",
         "launchdyn: speeds from 10 km/h to 60 km/h by 0 km/h: expected 1 to 10000 speeds\n"},
        {"examples/reference.yaml --speeds 10:60:5 -i road",
         "launchdyn: a frequency response is at one speed: several speeds require the road as "
         "input\n"},
        {"examples/reference.yaml -w tip.pich",
         "launchdyn: unknown quantity \"tip.pich\", did you mean \"tip.pitch\"?\n"},
        {"examples/reference.yaml -i elevation.comand",
         "launchdyn: unknown input \"elevation.comand\", did you mean \"elevation.command\"?\n"},
        {"examples/reference.yaml -i road --from 5 --to 2",
         "launchdyn: found 5 Hz to 2 Hz, expected a rising range of frequencies above 0\n"},
        {"examples/reference.yaml --loop elevatio",
         "launchdyn: unknown hinge \"elevatio\", did you mean \"elevation\"?\n"},
        {"examples/reference.yaml --loop elevation -i road",
         "launchdyn: a loop is shown separately, at one speed: it excludes input, quantities, "
         "speeds\n"},
        {"examples/reference.yaml --density a.csv",
         "launchdyn: a spectral density is that of an input: it requires the name of one "
         "(launchdyn response --list lists them)\n"},
        {"examples/reference.yaml --exit -i road",
         "launchdyn: the scatter of the exit is caused by the road: it excludes input and loop\n"},
        {"examples/reference.yaml --draws 5",
         "launchdyn: draws require the scatter of the exit: set --exit\n"},
        {"examples/reference.yaml --exit --draws 1",
         "launchdyn: found 1 draws, expected 0 (none) or at least 2\n"},
        {"examples/reference.yaml -x -w pich",
         "launchdyn: unknown result of a launch \"pich\", did you mean \"pitch\"?\n"},
        {"examples/fixed.yaml -x", "launchdyn: there is no road: the base is not a vehicle\n"},
        {"examples/reference.yaml -x --draws 2 -w pitch -p a.svg",
         "launchdyn: the scatter of the exit is drawn over speeds: set --speeds\n"},
        {"examples/reference.yaml --friction --loop azimuth",
         "launchdyn: a loop is shown without friction of the hinges\n"},
        {"examples/fixed.yaml --loop azimuth",
         "launchdyn: there is no loop: the base is neither a vehicle nor multibody\n"},
        {"examples/multibody/ship-turntable.yaml --loop lit",
         "launchdyn: unknown drive \"lit\", did you mean \"lift\"?\n"},
        {"examples/multibody/gondola.yaml --loop lift",
         "launchdyn: there is no loop: the base has no drives\n"},
        {"examples/fixed.yaml",
         "launchdyn: the base is not a vehicle on a road: a response requires the name of an input "
         "(launchdyn response --list lists them)\n"},
        {"examples/flight.yaml",
         "launchdyn: a scenario of flight only has no launcher and no response\n"},
        {"examples/reference.yaml --set base.speed='0 km/h'",
         "launchdyn: the response to the road requires a speed above 0\n"},
        {"examples/reference.yaml -w all -p a.svg",
         "launchdyn: a page has room for 8 charts of 6 quantities of one unit each: name fewer "
         "quantities\n"},
        {"examples/reference.yaml -w since_ignition.pitch,thrust -p a.svg",
         "launchdyn: none of these quantities responds before the launch, nothing is drawn\n"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char line[256];
        snprintf(line, sizeof line, "launchdyn response %s", wrong[i].line);
        assert_int_equal(run(line), 2);
        assert_string_equal(shell.err, wrong[i].said);
    }
}

static void test_road(void **state)
{
    (void)state;
    assert_int_equal(
        run("launchdyn road examples/reference.yaml --set base.road.tracks=independent "
            "--from -20 --to 80 --step 0.1 --out a/b --plot road.svg"),
        0);
    expect_in(shell.out,
              "Road: class A, seed 1, tracks independent, x = -20 m to 80 m every 0.1 m");
    expect_in(shell.out, "\n  n [1/m]                        left       right     class A\n");
    expect_in(shell.out, "\nClass of ISO 8608: not determined; it requires waves of 5 m to 10 m, "
                         "the section has those of 0.4 m to 6.4 m\n");
    assert_int_equal(run("ls a/b; head -n 2 road.svg | grep -c svg; wc -l <a/b/road.csv; "
                         "head -n 1 a/b/road.csv a/b/road-spectrum.csv; tail -n 1 a/b/road.csv | "
                         "cut -d , -f 1"),
                     0);
    assert_string_equal(shell.out,
                        "road-spectrum.csv\nroad.csv\n1\n1002\n"
                        "==> a/b/road.csv <==\nx [m],left [m],right [m]\n\n"
                        "==> a/b/road-spectrum.csv <==\nfrom [1/m],to [1/m],left [m3],right [m3],"
                        "class [m3]\n80\n");

    // a road of bumps alone: heights, and no class to compare with
    assert_int_equal(
        run("sed 's/road: {class.*/road: {bumps: [{at: 2 m, length: 1 m, height: 30 mm, "
            "tracks: left}]}/' examples/reference.yaml >bumps.yaml; "
            "cp examples/reference-aero.csv .; "
            "launchdyn road bumps.yaml --from 0 --to 10 --step 0.5 --out c; "
            "sed -n 7p c/road.csv; head -n 1 c/road-spectrum.csv"),
        0);
    expect_in(shell.out, "Road without a random part");
    expect_in(shell.out, "  highest              30.000       0.000\n");
    expect_in(shell.out,
              "\n2.5,0.029999999999999999,0\nfrom [1/m],to [1/m],left [m3],right [m3]\n");

    assert_null(strstr(shell.out, "Class of ISO 8608"));

    // random walks as a measured road, by the closed form of test_road_class of G_d(n0) 1.0e-3 (D)
    // and 65e-3 m3 (G), whatever awk draws; half of the stretch lies beside it
    assert_int_equal(
        run("awk 'BEGIN {print \"x [m],left [mm],right [mm]\"; for (x = -100; x <= 1500; "
            "x += 0.5) {print x \",\" a + 0 \",\" b + 0; a += rand() < 0.5 ? 10 : -10; "
            "b += rand() < 0.5 ? 80 : -80}}' >walk.csv; "
            "sed 's/road: {class.*/road: {table: walk.csv}/' examples/reference.yaml >walk.yaml; "
            "launchdyn road walk.yaml --from -1700 --to 1500 --step 0.1"),
        0);
    expect_in(shell.out, "\nClass of ISO 8608 by waves of 2 m to 91 m, G_d(0.1/m) [1e-6 m3]\n"
                         "  left   D ");
    expect_in(shell.out, "\n  right  G ");

    expect_complaint("launchdyn road examples/fixed.yaml", 2,
                     "launchdyn: there is no road: the base is not a vehicle\n");
    expect_complaint("launchdyn road examples/reference.yaml --step 0", 2,
                     "from -100 m to 100 m by 0 m has another number");
    expect_complaint("launchdyn road examples/reference.yaml --to x", 2,
                     "launchdyn: --to: found \"x\", expected a number in m\n");
    expect_complaint("launchdyn road examples/reference.yaml --plot x.bmp", 2,
                     "expected a picture's name that ends in .svg, .pdf or .png");
}

static void test_wind(void **state)
{
    (void)state;
    assert_int_equal(
        run("launchdyn wind examples/fixed.yaml --set 'environment.wind={profile: [[0 m, 0 m/s, 0 "
            "m/s], [10 m, 2 m/s, 1 m/s], [500 m, 8 m/s, 4 m/s]], gust: [{start: 1 s, rise: 0.2 s, "
            "speed: 3 m/s, heading: 90 deg}], turbulence: {wind_at_6m: 5 m/s}}' --height 10 --top "
            "500 --length 1000 --step 1 --out a --plot wind.svg"),
        0);
    expect_in(shell.out, "\n       500         8.000       0.000       4.000\n");
    expect_in(shell.out,
              "\n          1        0.2          0        0.2           3            90\n");
    expect_in(shell.out, "\n  sigma [m/s] 0.944       0.500       0.944\n");
    assert_int_equal(run("ls a; wc -l <a/wind-turbulence.csv; grep -c '^<svg' wind.svg; sort -t , "
                         "-g -k 4 a/wind-gusts.csv | tail -n 1 | cut -d , -f 4; head -n 1 "
                         "a/wind-spectrum.csv | cut -c 1-40"),
                     0);
    expect_in(shell.out, "wind-gusts.csv\nwind-profile.csv\nwind-spectrum.csv\n"
                         "wind-turbulence.csv\n1002\n1\n4\n"
                         "from [rad/m],to [rad/m],x [m3/s2/rad],");

    // a steady wind by north and east: nothing but its profile
    assert_int_equal(run("launchdyn wind examples/fixed.yaml --set 'environment.wind={axes: "
                         "geographic, speed: 5 m/s, heading: 90 deg}' --out b; ls b; head -n 2 "
                         "b/wind-profile.csv | tail -n 1 | cut -d , -f 1,3,4"),
                     0);
    expect_in(shell.out, "  altitude [m]       north          up        east\n");
    expect_in(shell.out, "\nwind-profile.csv\n0,0,5\n");

    expect_complaint("launchdyn wind examples/fixed.yaml", 2,
                     "launchdyn: there is no wind in the scenario\n");
    expect_complaint("launchdyn wind examples/fixed.yaml --set 'environment.wind={turbulence: "
                     "{wind_at_6m: 5 m/s}}' --step 0",
                     2, "a line through the air requires 2 to 1000000 points");
    expect_complaint("launchdyn wind examples/fixed.yaml --set 'environment.wind={speed: 1 m/s}' "
                     "--height -1",
                     2, "expected a height of at least 0 m");
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, shell_make, shell_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_help_and_version),
        TEST(test_wrong_words),
        TEST(test_ways_to_write_options),
        TEST(test_wrong_words_of_a_study),
        TEST(test_run_writes_results),
        TEST(test_report),
        TEST(test_table_alone_writes_nothing),
        TEST(test_set_overrides),
        TEST(test_refused_start),
        TEST(test_check_of_a_sweep),
        TEST(test_bad_input_leaves_nothing),
        TEST(test_places_that_cannot_be_written),
        TEST(test_a_launch_that_cannot_happen),
        TEST(test_interrupted),
        TEST(test_killed_at_work),
        TEST(test_modes_table),
        TEST(test_words_of_the_guide),
        TEST(test_no_slot),
        TEST(test_response),
        TEST(test_random_input),
        TEST(test_exit_scatter),
        TEST(test_loop),
        TEST(test_response_of_what_is_not_there),
        TEST(test_road),
        TEST(test_wind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
