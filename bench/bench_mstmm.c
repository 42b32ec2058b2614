// Forward dynamics by the reduced sweep: nanoseconds an evaluation and a body, least and median of
// many short repeats, one thread. On a loaded machine the least is the figure that repeats.
#include <math.h>

#include "../tests/support/multibody_case.h"
#include "bench_sample.h"

enum { REPEATS = 201 };

// Prints the times of an evaluation and returns the least [s]; each evaluation starts from slightly
// changed coordinates.
static double measure(const char *what, ld_mstmm *system, double *q, const double *u,
                      const double *tau)
{
    int n = ld_mstmm_speed_count(system);
    double *u_dot = malloc((size_t)n * sizeof *u_dot), sample[REPEATS], sum = 0;
    int calls = 20000 / n + 1;
    for (int k = -REPEATS / 10; k < REPEATS; k++) { // the first ones warm up
        double start = now();
        for (int i = 0; i < calls; i++) {
            q[0] += 1e-9;
            ld_mstmm_accelerations(system, q, u, tau, NULL, u_dot, NULL);
            sum += u_dot[n - 1];
        }
        sample[k < 0 ? 0 : k] = (now() - start) / calls;
    }
    free(u_dot);
    print(what, sample, REPEATS, 1e-9, "ns");
    return isfinite(sum) ? sample[0] : NAN;
}

// A revolute chain of the reference file's kind with n bodies, every one different, axes in general
// directions.
static double chain(int n)
{
    char what[32];
    ld_mstmm_element *element = calloc((size_t)n, sizeof *element);
    char(*name)[16] = calloc((size_t)n, sizeof *name);
    double *q = calloc((size_t)n, 4 * sizeof *q), *u = q + n, *tau = u + n;
    double least = NAN;
    snprintf(what, sizeof what, "chain of %d bodies", n);
    srand(1);
    for (int i = 0; i < n; i++) {
        snprintf(name[i], sizeof *name, "%d", i);
        double r[16];
        for (int k = 0; k < 16; k++)
            r[k] = 2.0 * rand() / RAND_MAX - 1;
        element[i] = (ld_mstmm_element){
            .name = name[i],
            .parent = i ? name[i - 1] : NULL,
            .at = {i ? 0.2 + 0.02 * r[0] : 0, 0.01 * r[1], 0.02 * r[2]},
            .hinge = LD_HINGE_REVOLUTE,
            .axis = {0.3 * r[3], i % 2 ? 1 : 0.3 * r[4], i % 2 ? 0.3 * r[5] : 1},
            .mass = 1.3 + 0.3 * r[6],
            .center = {0.1 + 0.01 * r[7], 0.012 * r[8], 0.008 * r[9]},
            .inertia = {0.0021 + 0.0001 * r[10], 0.0058, 0.0062, 0.0002 * r[11], 0.0001 * r[12],
                        0.00015},
        };
        q[i] = r[13];
        u[i] = 0.5 * r[14];
        tau[i] = r[15];
    }
    ld_mstmm *system;
    ld_error error;
    const double gravity[3] = {0, 0, -9.81};
    if (ld_mstmm_create(element, n, gravity, &system, &error))
        fprintf(stderr, "%s\n", error.text);
    else {
        least = measure(what, system, q, u, tau);
        ld_mstmm_free(system);
    }
    free(element);
    free(name);
    free(q);
    return least;
}

static void reference(const char *name)
{
    static multibody_case c;
    ld_mstmm *system;
    if (read_multibody_case(name, &c) ||
        ld_mstmm_create(c.element, c.count, c.gravity, &system, NULL))
        exit(1);
    measure(name, system, c.q, c.u, c.tau);
    ld_mstmm_free(system);
}

int main(void)
{
    const int counts[] = {3, 10, 30, 100, 300, 1000, 3000, 10000};
    double previous = 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        double least = chain(counts[i]);
        printf("    a body: %.1f ns", 1e9 * least / counts[i]);
        if (i > 0)
            printf(", exponent of the least %.3f",
                   log(least / previous) / log((double)counts[i] / counts[i - 1]));
        printf("\n");
        previous = least;
    }
    const char *const cases[] = {"chain3", "chain10", "chain100", "vehicle"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        reference(cases[i]);
    return 0;
}
