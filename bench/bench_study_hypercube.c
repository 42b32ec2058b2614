// What share of the samples Latin hypercubes need for the same intervals of means and deviations as
// plain random samples: the rocket of examples/salvo.yaml alone, on a fixed base or, with the
// scenario marching/stationary.yaml, on the parked vehicle.
//   bench_study_hypercube [SAMPLES OF A HYPERCUBE [HYPERCUBES [SCENARIO]]]
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench_sample.h"
#include "bench_scratch.h"
#include "launchdyn/study.h"
#include "studies/statistics/statistics.h"
#include "studies/store/study_data.h"

static const char scenario[] = "include: %s\n"
                               "firing: [{tube: 8, at: 0 s}]\n"
                               "run: {end: tip, output_step: 1 ms}\n"
                               "scatter:\n"
                               "  seed: 2026\n"
                               "  samples: %d\n"
                               "  plan: %s\n"
                               "%s"
                               "  factors:\n"
                               "    rocket.mass_error: {normal: 0.2 kg, within: 3}\n"
                               "    rocket.eccentricity.y: {normal: 0.3 mm, within: 3}\n"
                               "    rocket.eccentricity.z: {normal: 0.3 mm, within: 3}\n"
                               "    rocket.propellant: {normal: 0.1 kg, within: 3}\n"
                               "    rocket.motor.thrust_scale: {normal: 1 %%, within: 3}\n"
                               "    rocket.motor.misalignment.y: {normal: 0.5 mrad, within: 3}\n"
                               "    rocket.motor.misalignment.z: {normal: 0.5 mrad, within: 3}\n"
                               "    rocket.adaptors.rear.clearance: {uniform: 0.2 0.4 mm}\n"
                               "    rocket.adaptors.middle.clearance: {uniform: 0.4 0.6 mm}\n"
                               "    rocket.adaptors.front.clearance: {uniform: 0.3 0.5 mm}\n"
                               "    rocket.lock.release_force: {normal: 100 N, within: 3}\n";

static const char *const results[] = {"t_front", "t_middle", "t_rear",     "exit_speed",
                                      "pitch",   "yaw",      "pitch_rate", "yaw_rate"};
enum { RESULTS = sizeof results / sizeof *results };

static void stop(const char *text)
{
    fprintf(stderr, "%s\n", text);
    exit(1);
}

static void run(const char *text, const char *folder)
{
    ld_study *study;
    ld_messages messages;
    ld_study_counts counts;
    ld_study_options options = {.threads = 1};
    ld_error error;
    if (ld_study_read_text(text, strlen(text), "bench", LD_SOURCE_DIR "/examples", NULL, 0, &study,
                           &messages)) {
        ld_messages_print(&messages, stderr);
        exit(1);
    }
    if (ld_study_run(study, folder, &options, &counts, &error))
        stop(error.text);
    ld_study_free(study);
}

static void read_statistics(const char *folder, group_statistics of[RESULTS])
{
    study_data data;
    study_values values = {0};
    ld_error error;
    if (study_data_open(folder, &data, &error))
        stop(error.text);
    for (int i = 0; i < RESULTS; i++) {
        const char *nearest;
        const study_column *column = study_data_find(&data, results[i], &nearest);
        if (study_data_read(&data, data.point, &column, 1, &values, &error))
            stop(error.text);
        if (statistics_of(values.value[0], values.group, values.count, &of[i]))
            stop("no memory");
    }
    study_values_free(&values);
    study_data_close(&data);
}

static void study(const char *folder, const char *base, int samples, int hypercubes,
                  group_statistics of[RESULTS])
{
    char text[4096], replicates[64] = "";
    if (hypercubes)
        snprintf(replicates, sizeof replicates, "  replicates: %d\n", hypercubes);
    snprintf(text, sizeof text, scenario, base, samples, hypercubes ? "lhs" : "random", replicates);
    run(text, folder);
    read_statistics(folder, of);
}

static double half(const estimate *e)
{
    return 0.5 * (e->high - e->low);
}

static void compare(const char *base, const char *scratch, int strata, int hypercubes)
{
    char folder[128];
    group_statistics lhs[RESULTS], plain[RESULTS];
    double begin = now();
    snprintf(folder, sizeof folder, "%s/lhs", scratch);
    study(folder, base, strata * hypercubes, hypercubes, lhs);
    snprintf(folder, sizeof folder, "%s/random", scratch);
    study(folder, base, strata * hypercubes, 0, plain);
    printf("%s, %d samples, %d hypercubes of %d (%.0f s of CPU)\n"
           "%-14s %24s %24s %20s %20s\n",
           base, strata * hypercubes, hypercubes, strata, now() - begin, "",
           "half width of mean: lhs", "random", "lhs needs, mean [%]", "deviation [%]");
    for (int i = 0; i < RESULTS; i++)
        printf("%-14s %24.3g %24.3g %20.1f %20.1f\n", results[i], half(&lhs[i].mean),
               half(&plain[i].mean), 100 * pow(half(&lhs[i].mean) / half(&plain[i].mean), 2),
               100 * pow(half(&lhs[i].deviation) / half(&plain[i].deviation), 2));
}

int main(int argc, char **argv)
{
    int strata = argc > 1 ? atoi(argv[1]) : 40, hypercubes = argc > 2 ? atoi(argv[2]) : 20;
    char scratch[32];
    if (strata < 2 || hypercubes < 3)
        stop("two samples and three hypercubes at least");
    make_folder(scratch);
    compare(argc > 3 ? argv[3] : "fixed.yaml", scratch, strata, hypercubes);
    remove_folder(scratch);
    return 0;
}
