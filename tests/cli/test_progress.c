// How far a run is, on stderr that is no terminal: when a line is due, and what it says.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

// A clock that stands, however long a busy machine takes.
static int stopped_clock(clockid_t clock, struct timespec *time)
{
    (void)clock;
    *time = (struct timespec){.tv_sec = 1000};
    return 0;
}

#define clock_gettime stopped_clock
#include "cli/progress.c"
#undef clock_gettime
#include "support/scratch.h"

// What is printed to stderr from here on, to be read and freed.
static char *printed(void (*print)(run_progress *progress), run_progress *progress)
{
    char *text = calloc(1, 1000);
    int before = dup(STDERR_FILENO);
    assert_non_null(freopen(in("stderr"), "w", stderr));
    print(progress);
    fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    FILE *stream = fopen(in("stderr"), "r");
    assert_non_null(stream);
    fread(text, 1, 999, stream);
    fclose(stream);
    return text;
}

static void print_share(run_progress *progress)
{
    assert_true(progress_share(progress, 0.31));
    progress_share(progress, 0.9);
    progress_end(progress);
}

static void print_samples(run_progress *progress)
{
    const ld_study_counts counts = {.samples = 5000, .done = 1234, .now = 1000, .failed = 3};
    progress_samples(progress, &counts);
    progress_samples(progress, &counts);
    progress_end(progress);
}

// Begun a while ago, the last line at the beginning.
static run_progress begun(double ago)
{
    double start = now() - ago;
    return (run_progress){.shown = true, .start = start, .latest = start};
}

static void test_lines(void **state)
{
    (void)state;
    run_progress progress = begun(100);
    char *text = printed(print_share, &progress);
    assert_string_equal(text, "launchdyn: 31 %, 0.31 %/s, 223 s left\n");
    free(text);
    progress = begun(100);
    text = printed(print_samples, &progress);
    assert_string_equal(text, "launchdyn: 1234 of 5000 samples, 3 failed, 10 /s, 377 s left\n");
    free(text);
    progress = begun(100);
    progress.share = 0.25; // said then
    text = printed(print_share, &progress);
    assert_string_equal(text, "launchdyn: 90 %, 0.9 %/s, 11 s left\n");
    free(text);
    progress = begun(20);
    text = printed(print_share, &progress);
    assert_string_equal(text, "");
    free(text);
}

// After half a minute a tenth more is due; after ten minutes anything.
static void test_due(void **state)
{
    (void)state;
    static const struct {
        double since, share;
        bool terminal, due;
    } cases[] = {{29, 0.9, false, false},   {31, 0.09, false, false}, {31, 0.11, false, true},
                 {599, 0.09, false, false}, {601, 0, false, true},    {599, NAN, false, false},
                 {601, NAN, false, true},   {0.1, 0.9, true, false},  {0.3, 0, true, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        run_progress progress = {.shown = true, .terminal = cases[i].terminal};
        assert_int_equal(is_due(&progress, cases[i].share, cases[i].since), cases[i].due);
        progress = (run_progress){.terminal = cases[i].terminal};
        assert_false(is_due(&progress, cases[i].share, cases[i].since));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lines), cmocka_unit_test(test_due)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
