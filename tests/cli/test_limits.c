// What runs out, and what ends a program from outside: one sentence, the code that belongs to it,
// nothing half-written under its own name.
#include "support/check.h"
#include "support/shell.h"

#include <stdbool.h>
#include <unistd.h>

enum { LAUNCH = 1, INPUT = 2, SYSTEM = 3 };

#define QUICK " --quiet --set run.end=tip"
#define STUDY                                                                                      \
    "{ echo 'include: examples/fixed.yaml'; echo 'scatter: {samples: 4, factors: "                 \
    "{rocket.mass_error: {normal: 0.2 kg}}}'; } >study.yaml; "

// Ends with the code, after one line on stderr that holds this text.
static void expect_sentence(const char *line, int code, const char *text)
{
    run(line);
    const char *end = strchr(shell.err, '\n');
    if (shell.code != code || !strstr(shell.err, text) || !end || end[1])
        fail_msg("%s: code %d, printed \"%s\" and \"%s\"", line, shell.code, shell.out, shell.err);
}

static void expect_files(const char *folder, const char *names)
{
    char line[128];
    snprintf(line, sizeof line, "ls %s", folder);
    run(line);
    assert_string_equal(shell.out, names);
}

// docs/command.md has the list: each code once, one meaning.
static void test_codes(void **state)
{
    (void)state;
    run("sed -n '/^## Exit codes/,/^## /s/^- \\([0-9, ]*\\): .*/\\1/p' " LD_SOURCE_DIR
        "/docs/command.md | tr '\\n' ';'");
    assert_string_equal(shell.out, "0;1;2;3;129, 130, 143;");
    assert_int_equal(run("launchdyn check examples/fixed.yaml"), 0);
    expect_sentence("launchdyn run examples/fixed.yaml --quiet --set run.stuck_time='50 ms' "
                    "--set rocket.lock.release_force='50 kN'",
                    LAUNCH, "the lock never released");

    // what was given: words, scenarios, folders of results, which may be damaged
    expect_sentence("launchdyn rum", INPUT, "unknown command");
    expect_sentence("launchdyn plot none -o x.svg", INPUT, "no results in none");
    expect_sentence("launchdyn report none", INPUT, "no results in none");
    expect_sentence("launchdyn study show none", INPUT, "none contains no study");
    run("mkdir bad; echo x >bad/history.h5; launchdyn run none.yaml");
    assert_int_equal(shell.code, INPUT);
    expect_sentence("launchdyn plot bad -o x.svg", INPUT, "cannot read bad/history.h5: ");
    expect_sentence("launchdyn run --again bad", INPUT, "cannot read bad/history.h5: ");
    run("echo x >bad/study.db");
    expect_sentence("launchdyn study show bad", INPUT,
                    "bad/study.db is damaged: file is not a database");
    expect_sentence("launchdyn study export bad --csv x.csv", INPUT, "file is not a database");
    expect_sentence("launchdyn study --again bad --out o", INPUT, "file is not a database");
    run(STUDY "launchdyn study study.yaml --out bad --quiet");
    assert_int_equal(shell.code, INPUT);

    // what is not available
    expect_sentence("launchdyn run examples/fixed.yaml --out /dev/null/x" QUICK, SYSTEM,
                    "cannot make the folder");
    expect_sentence("launchdyn version >/dev/full", SYSTEM, "cannot print: No space left");
    run("launchdyn run examples/fixed.yaml --out a" QUICK);
    expect_sentence("PATH= ./launchdyn plot a -o x.svg", SYSTEM, "gnuplot not found");
    // a launch that fails on a disk that is full: the disk counts
    run("ulimit -f 100; launchdyn run examples/fixed.yaml --out full --quiet "
        "--set run.stuck_time='50 ms' --set rocket.lock.release_force='50 kN'");
    assert_int_equal(shell.code, SYSTEM);
    expect_in(shell.err, "cannot write full/");
}

// A limit of this many bytes less than the file `whole` has.
#define LESS(bytes) "prlimit --fsize=$(($(stat -c %s whole) - " bytes ")) ./launchdyn "

// The disk on which the picture is to be: full from the first byte, and after some.
static void test_pictures_on_a_full_disk(void **state)
{
    (void)state;
    static const char *const endings[] = {"svg", "png", "pdf"};
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out a" QUICK), 0);
    for (int i = 0; i < 3; i++) {
        char line[256], text[128];
        // what comes from gnuplot has more bytes than any script
        snprintf(line, sizeof line,
                 "echo before >x.%s; mkdir -p bin; printf '#!/bin/sh\nexec head -c 9000000 "
                 "/dev/zero\n' >bin/gnuplot; chmod +x bin/gnuplot; ulimit -f 4000; "
                 "PATH=bin:$PATH launchdyn plot a -o x.%s",
                 endings[i], endings[i]);
        snprintf(text, sizeof text, "cannot write x.%s: File too large", endings[i]);
        expect_sentence(line, SYSTEM, text);
        snprintf(line, sizeof line, "ulimit -f 8; launchdyn plot a --what all -o x.%s", endings[i]);
        snprintf(text, sizeof text, ": File too large");
        expect_sentence(line, SYSTEM, text);
        snprintf(line, sizeof line, "cat x.%s", endings[i]);
        assert_int_equal(run(line), 0);
        assert_string_equal(shell.out, "before\n");
    }
    expect_files("x.*", "x.pdf\nx.png\nx.svg\n");
    // the last byte alone has no room
    expect_sentence("launchdyn plot a -o y.svg && mv y.svg whole && " LESS("1") "plot a -o y.svg",
                    SYSTEM, "cannot write y.svg: File too large");
    expect_files("y.*", "");
    expect_sentence("launchdyn road examples/reference.yaml --plot whole.svg >/dev/null && "
                    "mv whole.svg whole && " LESS("1") "road examples/reference.yaml --plot r.svg",
                    SYSTEM, "cannot write r.svg: File too large");
    expect_sentence(
        "launchdyn wind examples/fixed.yaml --plot whole.svg "
        "--set environment.wind.speed='5 m/s' >/dev/null && mv whole.svg whole && " LESS(
            "1") "wind examples/fixed.yaml --plot w.svg "
                 "--set environment.wind.speed='5 m/s'",
        SYSTEM, "cannot write w.svg: File too large");
    expect_files("[rw].*", "");
}

// A limit of files ends no command by its signal, and leaves nothing.
static void test_files_beyond_their_limit(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out a" QUICK), 0);
    assert_int_equal(run(STUDY "launchdyn study study.yaml --out s --quiet"), 0);
    expect_sentence("ulimit -f 100; launchdyn run examples/fixed.yaml --out full --quiet", SYSTEM,
                    "cannot write full/history.h5.part: File too large");
    assert_int_not_equal(run("ls full"), 0);
    expect_sentence("ulimit -f 100; launchdyn report a", SYSTEM, "a/report.html: File too large");
    expect_files("a", "history.h5\nsummary.json\n");
    expect_sentence("ulimit -f 100; launchdyn report s", SYSTEM, "s/report.html: File too large");
    expect_sentence("ulimit -f 1; launchdyn study export s --csv x.csv", SYSTEM,
                    // its index in memory is a file
                    "cannot read s/study.db: disk I/O error (File too large)");
    // its last byte, of more than the index has
    expect_sentence(
        "launchdyn study study.yaml --out many --quiet --set scatter.samples=200; "
        "launchdyn study export many --csv whole; " LESS("1") "study export many --csv x.csv",
        SYSTEM, "cannot write x.csv: File too large");
    expect_sentence(
        "launchdyn study export many --hdf5 whole; " LESS("1") "study export many --hdf5 x.h5",
        SYSTEM, "cannot write x.h5: ");
    expect_sentence("ulimit -f 100; launchdyn road examples/reference.yaml --out r", SYSTEM,
                    "File too large");
    run("ulimit -f 20; launchdyn study study.yaml --out t --quiet");
    assert_int_equal(shell.code, SYSTEM);
    assert_int_not_equal(run("ls *.part */*.part x.* 2>/dev/null | grep ."), 0);
}

// Whoever reads what is printed, or follows the progress, may go.
static void test_cut_pipes(void **state)
{
    (void)state;
    // a pipe whose reader has come and gone
    assert_int_equal(
        run("mkfifo pipe; : <pipe & exec 3>pipe; wait; "
            "launchdyn check examples/fixed.yaml >&3; echo $? >code; "
            "{ launchdyn run examples/fixed.yaml --out cut --set run.end=tip; } >&3 2>&1; "
            "exec 3>&-; cat code"),
        0);
    assert_string_equal(shell.out, "3\n");
    assert_string_equal(shell.err, "launchdyn: cannot print: Broken pipe\n");
    expect_files("cut", "history.h5\nsummary.json\n");
}

static void test_little_stack(void **state)
{
    (void)state;
    expect_sentence("ulimit -s 256; launchdyn run examples/fixed.yaml", SYSTEM,
                    "the stack is limited to 256 kB, expected at least 512 kB (ulimit -s 512)");
#ifndef LD_SANITIZED // which take much of the stack for themselves
    assert_int_equal(
        run(STUDY "ulimit -s 512; launchdyn run examples/fixed.yaml --out a --report" QUICK " && "
                  "launchdyn run examples/reference.yaml --set run.formulation=overall --set "
                  "run.coupling.step='0.2 ms' --set run.lead_in='10 ms'" QUICK " && "
                  "launchdyn modes examples/fixed.yaml && launchdyn plot a -o x.svg && "
                  "launchdyn study study.yaml -j 4 --out s && launchdyn report s"),
        0);
#endif
}

#ifndef LD_SANITIZED // which take terabytes
// The result, or a sentence; 127: the program's own libraries could not be loaded.
static void expect_result_or_sentence(const char *line)
{
    bool told = run(line) == SYSTEM && strncmp(shell.err, "launchdyn: ", 11) == 0;
    if (shell.code != 0 && shell.code != 127 && !told)
        fail_msg("%s: code %d, printed \"%s\"", line, shell.code, shell.err);
}
#endif

// No library holds so much of the address space that others find none.
static void test_little_address_space(void **state)
{
    (void)state;
#ifndef LD_SANITIZED
    static const int sizes[] = {60000, 44000, 40000, 37000, 35000, 33000}; // [kB]
    assert_int_equal(run(STUDY "ulimit -v 100000; launchdyn check examples/fixed.yaml && "
                               "launchdyn run examples/fixed.yaml --out a" QUICK " && "
                               "launchdyn study study.yaml --out s --quiet"),
                     0);
    for (int i = 0; i < 6; i++) {
        char begin[64], line[256];
        snprintf(begin, sizeof begin, "ulimit -v %d; timeout 1000 ./launchdyn", sizes[i]);
        snprintf(line, sizeof line, "%s run examples/fixed.yaml --out a%d" QUICK, begin, i);
        expect_result_or_sentence(line);
        snprintf(line, sizeof line, "%s plot a -o x%d.svg", begin, i);
        expect_result_or_sentence(line);
        snprintf(line, sizeof line, "%s study study.yaml -j 2 --out s%d --quiet", begin, i);
        expect_result_or_sentence(line);
    }
    assert_int_not_equal(run("ls *.part */*.part 2>/dev/null | grep ."), 0);
#endif
}

static void test_few_open_files(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn run examples/fixed.yaml --out a" QUICK), 0);
    expect_sentence("ulimit -n 6; launchdyn plot a -o x.svg", SYSTEM, ": Too many open files");
    expect_sentence(STUDY "ulimit -n 5; launchdyn study study.yaml --out s --quiet", SYSTEM,
                    "/study.db: unable to open database file (Too many open files)");
    assert_int_equal(run("launchdyn study study.yaml --out s --quiet"), 0);
    expect_sentence("ulimit -n 5; launchdyn study show s", SYSTEM,
                    "cannot read s/study.db: unable to open database file");
}

// Threads and processes that cannot be had: as another user, for the limit does not hold for root.
static void test_few_threads(void **state)
{
    (void)state;
    if (run("command -v setpriv prlimit >/dev/null || [ $(id -u) != 0 ]"))
        skip();
    // what it reads is copied: another user may not look where the sources stand
    run(STUDY
        "cp -L launchdyn own; cp -L examples/fixed.yaml .; "
        "sed -i 's/examples.//' study.yaml; chmod -R a+rX .; chmod 777 .; "
        "if [ $(id -u) = 0 ]; then other=\"setpriv --reuid $((100000 + $$)) --clear-groups\"; fi; "
        "for n in 1 2; do echo \"ASAN_OPTIONS=detect_leaks=0 " // that requires a thread
        "prlimit --nproc=$n $other ./own study study.yaml -j 2 --out s --quiet\" >$n; done");
    expect_sentence("sh 1", SYSTEM, "cannot start a process: Resource temporarily unavailable");
    if (getuid() == 0) // whom the limit then counts has no other process
        expect_sentence("sh 2", SYSTEM,
                        "cannot start thread 2 of 2: Resource temporarily unavailable");
    assert_int_equal(run("launchdyn study study.yaml -j 2 --out s --quiet"), 0);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, shell_make, shell_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_codes),
        TEST(test_pictures_on_a_full_disk),
        TEST(test_files_beyond_their_limit),
        TEST(test_cut_pipes),
        TEST(test_little_stack),
        TEST(test_little_address_space),
        TEST(test_few_open_files),
        TEST(test_few_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
