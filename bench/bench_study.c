// Speed of studies: samples a second and core for a launch from a fixed base, a salvo on a vehicle
// that stands, a launch at 30 km/h and a flight alone; what set-up costs with and without the
// sample before; how much of a study's CPU is in its samples; two threads against one; impact error
// of the flight over its tolerance. CPU time, each sample's least of several passes.
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "bench_sample.h"
#include "bench_scratch.h"
#include "flight/flight_lanes.h"
#include "launchdyn/study.h"
#include "model/model.h"
#include "run/simulation_build.h"
#include "state/simulation.h"
#include "studies/run/ledger.h"
#include "studies/run/worker.h"

enum { PASSES = 3, MOST_SAMPLES = 2000 };

#define ROCKETS                                                                                    \
    "    rocket.mass_error: {normal: 0.2 kg, within: 3}\n"                                         \
    "    rocket.motor.thrust_scale: {normal: 1 %, within: 3}\n"                                    \
    "    rocket.motor.misalignment.y: {normal: 0.5 mrad, within: 3}\n"                             \
    "    rocket.motor.misalignment.z: {normal: 0.5 mrad, within: 3}\n"

static const char fixed[] = "include: fixed.yaml\n"
                            "scatter:\n  seed: 1\n  samples: 200\n  factors:\n" ROCKETS;
static const char salvo[] = "include: salvo.yaml\nscatter: {samples: 1}\n";
static const char marching[] = "include: marching/30-kmh.yaml\nrun: {end: tip}\n"
                               "scatter:\n  seed: 1\n  samples: 4\n  factors:\n" ROCKETS;
static const char flight[] = "include: flight.yaml\n"
                             "scatter:\n  seed: 1\n  samples: 2000\n  factors:\n" ROCKETS
                             "    rocket.eccentricity.y: {normal: 0.3 mm, within: 3}\n"
                             "    rocket.eccentricity.z: {normal: 0.3 mm, within: 3}\n"
                             "    flight.attitude.pitch: {normal: 5 mrad}\n"
                             "    flight.rate.y: {normal: 50 mrad/s}\n"
                             "    flight.rate.z: {normal: 50 mrad/s}\n";

#define STUDENT                                                                                    \
    "include: ../bench/student.yaml\n"                                                             \
    "scatter:\n  seed: 1\n  samples: 2000\n  factors:\n"                                           \
    "    rocket.mass_error: {normal: 0.1 kg, within: 3}\n"                                         \
    "    rocket.motor.thrust_scale: {normal: 2 %, within: 3}\n"                                    \
    "    rocket.aerodynamics.ca_scale: {normal: 5 %, within: 3}\n"                                 \
    "    environment.wind.scale: {normal: 10 %, within: 3}\n"                                      \
    "    flight.attitude.pitch: {normal: 10 mrad}\n"                                               \
    "    flight.attitude.yaw: {normal: 10 mrad}\n"

static const char student[] = STUDENT;
static const char student_flat[] = STUDENT
    "environment: {earth: flat, site: {latitude: , longitude: }}\nflight: {rate_against: }\n";

static bool always(void *self)
{
    (void)self;
    return true;
}

static ld_study *read_study(const char *text)
{
    ld_study *study;
    ld_messages messages = {0};
    if (ld_study_read_text(text, strlen(text), "bench", LD_SOURCE_DIR "/examples", NULL, 0, &study,
                           &messages)) {
        ld_messages_print(&messages, stderr);
        exit(1);
    }
    return study;
}

static study_worker start_worker(const ld_study *study)
{
    study_worker worker;
    if (worker_create(&worker, study, NULL))
        exit(1);
    return worker;
}

// CPU seconds of all samples, each at its least.
static double samples_cpu(const ld_study *study)
{
    static double least[MOST_SAMPLES];
    study_worker worker = start_worker(study);
    double sum = 0;
    for (int pass = 0; pass < PASSES; pass++)
        for (int i = 0; i < study->samples; i++) {
            double start = now();
            worker_run(&worker, i + 1, always, NULL);
            double spent = now() - start;
            least[i] = pass ? fmin(least[i], spent) : spent;
            if (worker.record->outcome)
                exit(1);
        }
    worker_free(&worker);
    for (int i = 0; i < study->samples; i++)
        sum += least[i];
    return sum;
}

static double wall_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Wall seconds of a whole study.
static double study_wall(const ld_study *study, int threads)
{
    char folder[32];
    ld_study_counts counts;
    ld_study_options options = {.threads = threads};
    ld_error error;
    make_folder(folder);
    double start = wall_now();
    if (ld_study_run(study, folder, &options, &counts, &error)) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    double wall = wall_now() - start;
    remove_folder(folder);
    return wall;
}

// Share of a study's CPU that is in its samples: the work of one thread, as worker_run_all does it.
static double share_in_samples(const ld_study *study)
{
    char folder[32];
    ld_study_counts counts = {0};
    ld_study_options options = {0};
    ld_error error = {0};
    study_ledger ledger;
    make_folder(folder);
    double start = now(), inside = 0;
    const store_place place = {.folder = folder, .journal = STORE_AHEAD};
    ledger_open(&ledger, study, &place, &options, &counts, &error);
    study_worker worker = start_worker(study);
    for (int64_t number; (number = ledger_next(&ledger)) != 0;) {
        double before = now();
        worker_run(&worker, number, ledger_continues, &ledger);
        inside += now() - before;
        ledger_keep(&ledger, worker.record);
    }
    worker_free(&worker);
    if (ledger_close(&ledger))
        exit(1);
    double all = now() - start;
    remove_folder(folder);
    return inside / all;
}

// Set-up of a sample: afresh, and with what the sample before left.
static void bench_setup(const ld_model *model)
{
    double afresh[PASSES], renewed[PASSES];
    ld_simulation *kept = NULL, *simulation;
    simulation_renew(&kept, model, NULL);
    for (int pass = 0; pass < PASSES; pass++) {
        double start = now();
        ld_simulation_create(model, &simulation, NULL);
        afresh[pass] = now() - start;
        ld_simulation_free(simulation);
        start = now();
        simulation_renew(&kept, model, NULL);
        renewed[pass] = now() - start;
    }
    ld_simulation_free(kept);
    print("    set-up afresh", afresh, PASSES, 1e-3, "ms");
    print("    set-up from the sample before", renewed, PASSES, 1e-3, "ms");
}

static void bench_kind(const char *what, const char *text)
{
    ld_study *study = read_study(text);
    int64_t rockets = study->samples * study->shape.rockets;
    double cpu = samples_cpu(study), wall[2] = {INFINITY, INFINITY};
    printf("%-24s %8.1f %s a second and core, %.3f ms each\n", what, (double)rockets / cpu,
           study->shape.rockets > 1 ? "rockets" : "samples", 1e3 * cpu / (double)rockets);
    bench_setup(study->nominal);
    if (study->samples > 1) {
        for (int pass = 0; pass < PASSES; pass++)
            for (int threads = 1; threads <= 2; threads++)
                wall[threads - 1] = fmin(wall[threads - 1], study_wall(study, threads));
        printf("    in samples %.1f %% of the study's CPU; two threads take %.2f of the time of "
               "one: efficiency %.0f %%\n",
               100 * share_in_samples(study), wall[1] / wall[0], 50 * wall[0] / wall[1]);
    }
    ld_study_free(study);
}

// A study's flights in as many lanes as the environment allows: CPU of all of it, records included.
static void bench_lanes(const char *what, const char *text)
{
    double alone = 0;

    ld_study *study = read_study(text);
    study->nominal->run.flight_tolerance = 2.5e-4; // 0.1 m rms
    printf("%s\n", what);
    for (int lanes = 1; lanes <= 8; lanes = lanes == 1 ? 4 : 2 * lanes) {
        char most[16];
        double cpu = INFINITY;
        snprintf(most, sizeof most, "%d", lanes);
        setenv("LAUNCHDYN_LANES", most, 1);
        if (flight_lanes_here() < lanes)
            break;
        for (int pass = 0; pass < PASSES; pass++) {
            double start = now();
            study_wall(study, 1);
            cpu = fmin(cpu, now() - start);
        }
        alone = lanes == 1 ? cpu : alone;
        printf("    in %d lane%s %.0f flights a second and core, records included, %.2f times one "
               "lane's\n",
               lanes, lanes > 1 ? "s" : "", (double)study->samples / cpu, alone / cpu);
    }
    unsetenv("LAUNCHDYN_LANES");
    ld_study_free(study);
}

// ---- flight over its tolerance

enum { FLIGHTS = 200 };

typedef struct impacts {
    double downrange[FLIGHTS], drift[FLIGHTS], cpu[FLIGHTS]; // [m], [m], least [s]
} impacts;

static void fly(ld_study *study, double tolerance, int passes, impacts *all)
{
    study->nominal->run.flight_tolerance = tolerance;
    study_worker worker = start_worker(study);
    for (int pass = 0; pass < passes; pass++)
        for (int i = 0; i < FLIGHTS; i++) {
            double start = now();
            worker_run(&worker, i + 1, always, NULL);
            double spent = now() - start;
            const ld_flight_summary *landed = &worker.summary->rocket[0].flight;
            all->cpu[i] = pass ? fmin(all->cpu[i], spent) : spent;
            all->downrange[i] = landed->downrange;
            all->drift[i] = landed->drift;
        }
    worker_free(&worker);
}

static void bench_tolerance(const char *text)
{
    static const double tolerance[] = {1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7};
    static impacts converged, these;
    ld_study *study = read_study(text);
    fly(study, 1e-11, 1, &converged);
    printf("flight alone: impact error over its tolerance, %d scattered flights\n", FLIGHTS);
    for (size_t k = 0; k < sizeof tolerance / sizeof *tolerance; k++) {
        double sum = 0, worst = 0, cpu = 0;
        fly(study, tolerance[k], 5, &these);
        for (int i = 0; i < FLIGHTS; i++) {
            double miss = hypot(these.downrange[i] - converged.downrange[i],
                                these.drift[i] - converged.drift[i]);
            sum += miss * miss;
            worst = fmax(worst, miss);
            cpu += these.cpu[i];
        }
        printf("    tolerance %.0e: rms %9.2e m, worst %9.2e m, %6.0f samples a second\n",
               tolerance[k], sqrt(sum / FLIGHTS), worst, FLIGHTS / cpu);
    }
    ld_study_free(study);
}

int main(void)
{
    double load[3];
    if (getloadavg(load, 3) == 3)
        printf("load of the machine at the start: %.1f\n", load[0]);
    bench_kind("launch, fixed base", fixed);
    bench_kind("salvo at 0 km/h", salvo);
    bench_kind("launch at 30 km/h", marching);
    bench_kind("flight alone", flight);
    bench_lanes("reference flight", flight);
    bench_lanes("student rocket, flat Earth", student_flat);
    bench_lanes("student rocket, WGS 84", student);
    bench_tolerance(flight);
    return 0;
}
