// Cost of free flight: one evaluation of its equations, the reference flight to the ground at the
// loosest of some tolerances whose impact is within 0.1 m of a converged run's, the rocket balanced
// and not. Process CPU time, medians of many.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "flight/flight_alone.h"
#include "flight/flight_lanes.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "state/simulation.h"

enum { REPEATS = 101, EVALUATIONS = 20000 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print(const char *what, double *sample, int count, double unit, const char *name)
{
    qsort(sample, (size_t)count, sizeof *sample, ascending);
    printf("%-58s median %8.3f  least %8.3f %s\n", what, sample[count / 2] / unit, sample[0] / unit,
           name);
}

static void bench_evaluation(const ld_model *model, double t, const char *what)
{
    flight_system system;
    double y[FLIGHT_STATES] = {0}, y_dot[FLIGHT_STATES], sample[REPEATS], sum = 0;
    if (flight_build(&system, model, 0, NULL))
        return;
    flight_phase phase = free_flight_phase(&system, model->flight.ignition, t);
    flight_start(&system, &phase, &model->flight, y);
    y[FLIGHT_R + 1] += 400;
    y[FLIGHT_V] += 400;
    for (int r = 0; r < REPEATS; r++) {
        double start = now();
        for (int i = 0; i < EVALUATIONS; i++) {
            y[FLIGHT_R + 1] += 1e-4; // a new state each time
            flight_rates(&system, &phase, t, y, y_dot);
            sum += y_dot[FLIGHT_V];
        }
        sample[r] = (now() - start) / EVALUATIONS;
    }
    if (sum != 0)
        print(what, sample, REPEATS, 1e-9, "ns");
    flight_free(&system);
}

static void fly(ld_model *model, double tolerance, ld_summary *summary, double *sample, int count)
{
    ld_simulation *simulation;
    model->run.flight_tolerance = tolerance;
    if (ld_simulation_create(model, &simulation, NULL))
        exit(1);
    for (int r = 0; r < count; r++) {
        double start = now();
        ld_simulation_run(simulation, NULL, summary, NULL);
        sample[r] = now() - start;
    }
    ld_simulation_free(simulation);
}

static void bench_flight(ld_model *model, const char *what)
{
    static ld_summary summary;
    double sample[REPEATS], tolerance = 1e-2, error;
    const ld_flight_summary *flight = &summary.rocket[0].flight;
    fly(model, 1e-12, &summary, sample, 1);
    ld_flight_summary converged = *flight;
    do {
        tolerance /= 2;
        fly(model, tolerance, &summary, sample, 1);
        error = hypot(flight->downrange - converged.downrange, flight->drift - converged.drift);
    } while (error > 0.1);
    fly(model, tolerance, &summary, sample, REPEATS);
    print(what, sample, REPEATS, 1e-6, "us");
    printf("    tolerance %.1e, impact off by %.3f m of %.0f m, %lld steps, %lld evaluations\n",
           tolerance, error, converged.range, (long long)summary.statistics.steps,
           (long long)summary.statistics.rhs_evaluations);
    fly(model, 1e-7, &summary, sample, REPEATS);
    error = hypot(flight->downrange - converged.downrange, flight->drift - converged.drift);
    print("    the same at the default tolerance", sample, REPEATS, 1e-6, "us");
    printf("    impact off by %.1e m, %lld evaluations\n", error,
           (long long)summary.statistics.rhs_evaluations);
}

// ---- side by side

enum { FLEET = 400, FLEETS = 15 };

typedef struct fleet {
    ld_simulation *simulation[FLEET];
    ld_summary *summary[FLIGHT_MOST_LANES];
    ld_error error;
    int given;
} fleet;

static bool next_flight(void *self, int lane, lane_flight *flight)
{
    fleet *all = self;
    if (all->given == FLEET)
        return false;
    ld_summary *summary = all->summary[lane];
    flight_alone_prepare(all->simulation[all->given++], NULL, &flight->job, flight->state, summary);
    flight->rocket = &summary->rocket[0];
    flight->summary = summary;
    flight->error = &all->error;
    return true;
}

static void flight_done(void *self, int lane, lane_flight *flight, ld_status status)
{
    (void)self, (void)lane, (void)flight;
    if (status)
        exit(1);
}

// Flights that differ in their first angle and rates, at the tolerance of 0.1 m.
static void bench_lanes(ld_model *model, double tolerance)
{
    fleet all = {.given = 0};
    ld_model *drawn = calloc(FLEET, sizeof *drawn);
    lane_use use;
    const lane_source source = {next_flight, flight_done, &all, &use};
    model->run.flight_tolerance = tolerance;
    for (int i = 0; drawn && i < FLEET; i++) {
        drawn[i] = *model;
        drawn[i].flight.pitch += 2e-4 * (i - 0.5 * FLEET);
        drawn[i].flight.rate[1] += 4e-4 * (i - 0.5 * FLEET);
        if (ld_simulation_create(&drawn[i], &all.simulation[i], NULL))
            exit(1);
    }
    for (int i = 0; i < FLIGHT_MOST_LANES; i++)
        all.summary[i] = calloc(1, sizeof *all.summary[i]);
    for (int lanes = 1; lanes <= flight_lanes_here(); lanes = lanes == 1 ? 4 : 2 * lanes) {
        double sample[FLEETS];
        char what[64];
        for (int r = 0; r < FLEETS; r++) {
            double start = now();
            all.given = 0;
            use = (lane_use){0};
            if (flight_lanes_fly(lanes, &source, NULL))
                exit(1);
            sample[r] = (now() - start) / FLEET;
        }
        snprintf(what, sizeof what, "    a flight of many in %d lane%s", lanes,
                 lanes > 1 ? "s" : "");
        print(what, sample, FLEETS, 1e-6, "us");
        if (use.lanes)
            printf("    of the steps tried in lanes %.1f %% are of flights\n",
                   100 * (double)use.flying / (double)use.lanes);
    }
    for (int i = 0; i < FLEET; i++)
        ld_simulation_free(all.simulation[i]);
    for (int i = 0; i < FLIGHT_MOST_LANES; i++)
        free(all.summary[i]);
    free(drawn);
}

// The reference flight with overrides: one evaluation, the flight, lanes.
static void bench_other(const char *const *set, size_t sets, const char *evaluation,
                        const char *flight)
{
    ld_model model;
    ld_messages messages = {0};
    if (scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", set, sets, &model, &messages))
        exit(1);
    bench_evaluation(&model, 10, evaluation);
    bench_flight(&model, flight);
    bench_lanes(&model, 6.3e-4);
    model_clear(&model);
}

// The reference rocket with its air by surface: nose, tail, fins.
static void bench_surfaces(void)
{
    static const char *const set[] = {
        "rocket.aerodynamics.table=", "rocket.aerodynamics.fin_cant=",
        "rocket.aerodynamics={model: surfaces, reference_diameter: 164 mm, axial: [[0, 0.35], "
        "[0.7, "
        "0.34], [1.1, 0.55], [3, 0.4]], beyond_table: hold, surfaces: [{name: nose, kind: nose, "
        "shape: ogive, at: 2.4 m, length: 0.5 m, radius: 82 mm}, {name: tail, kind: tail, at: 0.1 "
        "m, "
        "length: 0.1 m, front_radius: 82 mm, rear_radius: 70 mm}, {name: fins, kind: fins, at: 0.3 "
        "m, fin_count: 4, root_chord: 0.2 m, tip_chord: 0.1 m, span: 0.1 m, sweep_length: 0.1 m, "
        "radius: 82 mm, cant: 1 deg}]}"};
    bench_other(set, 3, "evaluation, flat Earth, burnt out, air by surface",
                "the same with the air by surface");
}

// The reference rocket in measured air, of 14 rows, in place of the standard's.
static void bench_measured_air(void)
{
    static const char *const set[] = {"environment.atmosphere={profile: " LD_SOURCE_DIR
                                      "/examples/student-rocket/air.csv}"};
    bench_other(set, 1, "evaluation, flat Earth, burnt out, measured air",
                "the same in measured air");
}

int main(void)
{
    ld_model model;
    ld_messages messages = {0};
    if (scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", NULL, 0, &model, &messages))
        return 1;
    bench_evaluation(&model, 1, "the same as the next, while the processor warms up");
    bench_evaluation(&model, 1, "evaluation, flat Earth, burning");
    bench_evaluation(&model, 10, "evaluation, flat Earth, burnt out");
    bench_flight(&model, "reference flight to the ground");
    bench_lanes(&model, 6.3e-4);
    bench_surfaces();
    model.rocket.eccentricity[0] = 0.5e-3;
    model.rocket.motor.misalignment[1] = 0.5e-3;
    bench_evaluation(&model, 10, "evaluation, flat Earth, burnt out, not balanced");
    bench_flight(&model, "the same, 0.5 mm eccentric, thrust 0.5 mrad off");
    bench_lanes(&model, 3.1e-4);
    model.rocket.products[0] = 0.02;
    bench_flight(&model, "the same, also J_xy = 0.02 kg m2");
    model.environment.earth.kind = LD_EARTH_WGS84;
    bench_evaluation(&model, 10, "evaluation, WGS 84, burnt out, not balanced");
    model_clear(&model);
    bench_measured_air();
    return 0;
}
