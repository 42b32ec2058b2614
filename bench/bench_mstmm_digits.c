// How the forms of the transfer equation lose digits with the length of a chain: the data of
// docs/figures/mstmm-digits.svg. Columns: bodies, then the median over eleven random states of the
// largest difference from the reduced sweep over the largest acceleration: paper's form, all hinge
// accelerations kept; chains with hinge axes all about one direction first, then alternating.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "launchdyn/mstmm.h"

enum { MOST = 128, SAMPLES = 11 };

static double uniform(void)
{
    return 2.0 * rand() / RAND_MAX - 1;
}

// A chain of n links; `alternating`: axes about y and z in turn, else all near y.
static ld_mstmm *chain(int n, int alternating)
{
    static ld_mstmm_element element[MOST];
    static char name[MOST][16];
    const double gravity[3] = {0, 0, -9.81};
    ld_mstmm *system = NULL;
    for (int i = 0; i < n; i++) {
        int about_z = alternating && i % 2;
        snprintf(name[i], sizeof name[i], "%d", i);
        element[i] = (ld_mstmm_element){
            .name = name[i],
            .parent = i ? name[i - 1] : NULL,
            .at = {i ? 0.2 : 0, 0.01, -0.02},
            .hinge = LD_HINGE_REVOLUTE,
            .axis = {0.3 * uniform(), about_z ? 0.3 * uniform() : 1, about_z ? 1 : 0.3 * uniform()},
            .mass = 1.3,
            .center = {0.1, 0.012, -0.008},
            .inertia = {0.0021, 0.0058, 0.0062, 0.0002, -0.0001, 0.00015}};
    }
    ld_mstmm_create(element, n, gravity, &system, NULL);
    return system;
}

static double loss(int n, int alternating, ld_mstmm_form form)
{
    double q[MOST], u[MOST], tau[MOST], u_dot[MOST];
    ld_mstmm *system = chain(n, alternating);
    ld_mstmm_overall report = {.loss = 1};
    for (int i = 0; i < n; i++) {
        q[i] = uniform();
        u[i] = 0.5 * uniform();
        tau[i] = uniform();
    }
    if (!system ||
        ld_mstmm_accelerations_overall(system, form, q, u, tau, NULL, u_dot, &report, NULL))
        report.loss = fmin(fmax(report.loss, 0.1), 1);
    ld_mstmm_free(system);
    return report.loss;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(void)
{
    static const int lengths[] = {2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 60, 80, 100};
    srand(1);
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
        printf("%4d", lengths[k]);
        for (int alternating = 0; alternating < 2; alternating++)
            for (int form = 0; form < 2; form++) {
                double sample[SAMPLES];
                for (int i = 0; i < SAMPLES; i++)
                    sample[i] = loss(lengths[k], alternating, (ld_mstmm_form)form);
                qsort(sample, SAMPLES, sizeof *sample, compare);
                printf(" %10.2e", sample[SAMPLES / 2]);
            }
        printf("\n");
    }
    return 0;
}
