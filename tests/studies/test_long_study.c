// Long studies: memory that does not grow with the number of samples, and the size of what is kept.
// LD_LONG_STUDY: samples (default 2000). Each runs in a child, whose memory is its own.
// ctest: slow
#include "support/study_run.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const char text[] = "include: flight.yaml\n"
                           "run: {flight_tolerance: 1e-4}\n"
                           "scatter:\n"
                           "  samples: 1\n"
                           "  factors:\n"
                           "    rocket.mass_error: {normal: 0.2 kg}\n"
                           "    rocket.motor.thrust_scale: {normal: 1 %}\n"
                           "    rocket.motor.misalignment.y: {normal: 0.5 mrad}\n"
                           "    rocket.aerodynamics.ca_scale: {normal: 2 %}\n"
                           "    environment.temperature_offset: {normal: 5 K}\n";

// Runs so many samples; returns the greatest memory of the process that ran them [MB], and its CPU
// time [s].
static double memory_of(int samples, double *cpu)
{
    char set[64];
    snprintf(set, sizeof set, "scatter.samples=%d", samples);
    ld_study *study = study_with(text, set);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        ld_error error;
        ld_study_counts counts;
        ld_study_options options = {.threads = 2};
        _exit(ld_study_run(study, in("long"), &options, &counts, &error) != LD_OK);
    }
    int status;
    struct rusage use;
    assert_int_equal(wait4(child, &status, 0, &use), child);
    assert_int_equal(status, 0);
    ld_study_free(study);
    *cpu = (double)use.ru_utime.tv_sec + 1e-6 * (double)use.ru_utime.tv_usec +
           (double)use.ru_stime.tv_sec + 1e-6 * (double)use.ru_stime.tv_usec;
    return (double)use.ru_maxrss / 1024;
}

static void test_long_study(void **state)
{
    (void)state;
    int samples = getenv("LD_LONG_STUDY") ? atoi(getenv("LD_LONG_STUDY")) : 2000;
    double cpu, few = memory_of(samples / 100, &cpu), many = memory_of(samples, &cpu);
    struct stat file;
    char path[160];
    snprintf(path, sizeof path, "%s/study.db", in("long"));
    assert_int_equal(stat(path, &file), 0);
    printf("    %d samples, %.1f s of CPU\n", samples, cpu);
    printf("    memory of a hundredth of the samples [MB]  %15.1f\n", few);
    CHECK_WITHIN("memory of all, more than that [MB]", many - few, -2, 4);
    CHECK_WITHIN("size of what is kept [bytes a sample]", (double)file.st_size / samples, 290, 354);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_long_study)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
