// Process CPU time, and medians of many samples of it.
#ifndef LD_BENCH_SAMPLE_H
#define LD_BENCH_SAMPLE_H

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static inline double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Sorts the samples and prints their median and least; without `what` nothing is printed.
static inline void print(const char *what, double *sample, int count, double unit, const char *name)
{
    if (!what)
        return;
    qsort(sample, (size_t)count, sizeof *sample, ascending);
    printf("%-58s median %8.3f  least %8.3f %s\n", what, sample[count / 2] / unit, sample[0] / unit,
           name);
}

#endif
