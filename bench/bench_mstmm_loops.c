// Closed loops: nanoseconds an evaluation and a projection over bodies and loops, with the
// exponents between sizes, and milliseconds of IFToMM's benchmarks A01 to A05.
#include <math.h>

#include "../tests/support/loop_benchmarks.h"
#include "bench_sample.h"

enum { REPEATS = 61, RUNS = 7 };

// Prints the times of accelerations at the start, and of projecting a state off by a step's drift;
// returns the least [s] of the first.
static double measure(const char *what, benchmark *b)
{
    int n = ld_mstmm_speed_count(b->system), nq = ld_mstmm_coordinate_count(b->system);
    double *u_dot = malloc((size_t)(n + nq) * 2 * sizeof *u_dot), *q = u_dot + n, *u = q + nq;
    double sample[REPEATS], other[REPEATS], sum = 0;
    int calls = 4000 / n + 1;
    for (int k = -REPEATS / 10; k < REPEATS; k++) { // the first ones warm up
        double start = now();
        for (int i = 0; i < calls; i++) {
            ld_mstmm_accelerations(b->system, b->q, b->u, NULL, NULL, u_dot, NULL);
            sum += u_dot[n - 1];
        }
        sample[k < 0 ? 0 : k] = (now() - start) / calls;
        start = now();
        for (int i = 0; i < calls; i++) {
            memcpy(q, b->q, (size_t)nq * sizeof *q);
            memcpy(u, b->u, (size_t)n * sizeof *u);
            q[0] += 1e-9;
            sum += ld_mstmm_project(b->system, q, u, NULL);
        }
        other[k < 0 ? 0 : k] = (now() - start) / calls;
    }
    free(u_dot);
    char text[64];
    print(what, sample, REPEATS, 1e-9, "ns");
    snprintf(text, sizeof text, "%s, projected", what);
    print(text, other, REPEATS, 1e-9, "ns");
    return isfinite(sum) ? sample[0] : NAN;
}

static void exponent(double least, double previous, double size, double before, int bodies)
{
    printf("    a body: %.1f ns", 1e9 * least / bodies);
    if (previous > 0)
        printf(", exponent of the least %.3f", log(least / previous) / log(size / before));
    printf("\n");
}

// Windows side by side: each loop acts on its neighbours alone.
static void windows(void)
{
    const int counts[] = {1, 2, 5, 10, 20, 40, 100, 300};
    double previous = 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        char what[48];
        benchmark b = four_bars(counts[i]);
        snprintf(what, sizeof what, "four-bars of %d windows", counts[i]);
        double least = measure(what, &b);
        exponent(least, previous, counts[i], i ? counts[i - 1] : 1, 2 * counts[i] + 1);
        previous = least;
        benchmark_free(&b);
    }
}

// A floating chain of `links` rods, `loops` times bent to a square's side and closed on the body
// that floats: one loop of many bodies, or many that all act on each other.
static benchmark floating_rings(int rings, int links)
{
    const int count = 1 + rings * links;
    ld_mstmm_element *e = calloc((size_t)count, sizeof *e);
    ld_mstmm_loop *l = calloc((size_t)rings, sizeof *l);
    char(*name)[16] = calloc((size_t)(count + rings), sizeof *name);
    const size_t nq = 7 + (size_t)(rings * links);
    double *q = calloc(2 * nq, sizeof *q), *u = q + nq, angle = 2 * acos(-1) / (links + 1);
    snprintf(name[0], sizeof *name, "%s", "hub");
    e[0] = (ld_mstmm_element){
        .name = name[0], .hinge = LD_HINGE_FREE, .mass = 10, .inertia = {9, 9, 9}};
    q[3] = 1;
    for (int r = 0; r < rings; r++) {
        for (int k = 0; k < links; k++) {
            const int i = 1 + r * links + k;
            snprintf(name[i], sizeof *name, "%d", i);
            e[i] = planar_body(name[i], k ? name[i - 1] : name[0], (planar_point){k ? 1 : 0, 0}, 1,
                               (planar_point){0.5, 0}, 0.1);
            if (k == 0)
                e[i].at[2] = r;
            e[i].inertia[1] = 0.11;
            q[7 + i - 1] = k ? angle : 0.1;
            u[6 + i - 1] = 0.1;
        }
        snprintf(name[count + r], sizeof *name, "pin %d", r);
        // where the ring of equal angles ends: one link before its start
        double end = 0.1 + angle * links;
        l[r] = planar_pin(name[count + r], name[1 + r * links + links - 1], (planar_point){1, 0},
                          name[0], (planar_point){-cos(end), -sin(end)});
        l[r].second.at[2] = r;
    }
    const ld_mstmm_description d = {
        .elements = e, .element_count = count, .loops = l, .loop_count = rings};
    benchmark b = benchmark_build(&d, q, u, 1);
    free(e);
    free(l);
    free(name);
    free(q);
    return b;
}

static void rings(void)
{
    const int links[] = {4, 10, 30, 100, 300, 1000}, counts[] = {1, 2, 4, 8, 16, 32};
    double previous = 0;
    for (size_t i = 0; i < sizeof links / sizeof *links; i++) {
        char what[48];
        benchmark b = floating_rings(1, links[i]);
        snprintf(what, sizeof what, "one ring of %d links", links[i]);
        double least = measure(what, &b);
        exponent(least, previous, links[i], i ? links[i - 1] : 1, links[i] + 1);
        previous = least;
        benchmark_free(&b);
    }
    previous = 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        char what[48];
        benchmark b = floating_rings(counts[i], 4);
        snprintf(what, sizeof what, "%d rings of 4 links on one body", counts[i]);
        double least = measure(what, &b);
        exponent(least, previous, counts[i], i ? counts[i - 1] : 1, 1 + 4 * counts[i]);
        previous = least;
        benchmark_free(&b);
    }
}

// A whole run at a tolerance, and how far its energy or its last coordinates go off.
static void whole_run(const char *what, benchmark b, double tolerance)
{
    double sample[RUNS], *q, *u;
    size_t nq = (size_t)ld_mstmm_coordinate_count(b.system);
    size_t nu = (size_t)ld_mstmm_speed_count(b.system);
    ld_mstmm_statistics statistics = {0};
    ld_error error;
    q = malloc((nq + nu) * sizeof *q);
    u = q + nq;
    for (int k = 0; k < RUNS; k++) {
        memcpy(q, b.q, nq * sizeof *q);
        memcpy(u, b.u, nu * sizeof *u);
        ld_mstmm_settings settings = b.drives;
        settings.rtol = settings.atol = tolerance;
        double start = now();
        if (ld_mstmm_integrate(b.system, &settings, 0, b.end, q, u, &statistics, &error))
            benchmark_fail(error.text);
        sample[k] = now() - start;
    }
    print(what, sample, RUNS, 1e-3, "ms");
    printf("    tolerance %.0e, %lld steps, %lld evaluations", tolerance,
           (long long)statistics.steps, (long long)statistics.evaluations);
    if (!b.drives.drive)
        printf(", energy off by %.1e J",
               benchmark_energy(&b, q, u) - benchmark_energy(&b, b.q, b.u));
    printf("\n");
    free(q);
    benchmark_free(&b);
}

int main(void)
{
    windows();
    rings();
    whole_run("A01 simple pendulum", simple_pendulum(), 1e-6);
    whole_run("A02 four-bars, N = 2", four_bars(2), 1e-6);
    whole_run("A02 four-bars, N = 10", four_bars(10), 1e-6);
    whole_run("A02 four-bars, N = 40", four_bars(40), 1e-6);
    whole_run("A03 Andrews' squeezer", andrews_squeezer(-0.0620), 1e-6);
    whole_run("A04 Bricard's mechanism", bricard(), 1e-6);
    whole_run("A05 flyball governor", flyball_governor(), 1e-4);
    return 0;
}
