// A step's arithmetic for integrations side by side, one in each lane (math/real.h): the text of
// dormand_prince.c, which has one lane, and of dormand_prince_avx2.c and dormand_prince_avx512.c.
#ifndef LD_SIMULATION_DORMAND_PRINCE_CODE_H
#define LD_SIMULATION_DORMAND_PRINCE_CODE_H

#include "math/real.h"
#include "simulation/dormand_prince.h"

static const double node[DORMAND_PRINCE_STAGES] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
static const double weight[DORMAND_PRINCE_STAGES][DORMAND_PRINCE_STAGES - 1] = {
    {0},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};
// weights of the fifth order less those of the fourth
static const double difference[DORMAND_PRINCE_STAGES] = {
    71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

// out = y + h sum of a_j k_j, j < count; unrolled for each count.
LD_ALWAYS_INLINE void combine(const real *y, real h, const double *a, int count,
                              const real k[][DORMAND_PRINCE_STATES], real *out)
{
    real b[DORMAND_PRINCE_STAGES];
    for (int j = 0; j < count; j++)
        b[j] = h * a[j];
    for (int i = 0; i < DORMAND_PRINCE_STATES; i++) {
        real sum = b[0] * k[0][i];
        for (int j = 1; j < count; j++)
            sum += b[j] * k[j][i];
        out[i] = y[i] + sum;
    }
}

// The stages of the step of size `size` from (t0, y0), where k[0] is known; y: its end.
LD_INLINE void take_stages(double *block, dormand_prince_slopes f, void *self)
{
    real h = *REALS(block, dormand_prince_numbers, size);
    real t0 = *REALS(block, dormand_prince_numbers, t0);
    const real *y0 = REALS(block, dormand_prince_numbers, y0);
    real(*k)[DORMAND_PRINCE_STATES] =
        (real(*)[DORMAND_PRINCE_STATES])REALS(block, dormand_prince_numbers, k);
    real at[DORMAND_PRINCE_STATES], t;
#define STAGE(s, to)                                                                               \
    combine(y0, h, weight[s], s, (const real(*)[DORMAND_PRINCE_STATES])k, to);                     \
    t = t0 + node[s] * h;                                                                          \
    f((const double *)&t, (const double *)(to), (double *)k[s], self)
    STAGE(1, at);
    STAGE(2, at);
    STAGE(3, at);
    STAGE(4, at);
    STAGE(5, at);
    STAGE(6, REALS(block, dormand_prince_numbers, y));
#undef STAGE
}

// Mean over the states of the square of the step's error against what is allowed: 1 is just
// allowed. Not finite where the slopes are not.
LD_INLINE void find_error(double *block, int count)
{
    const real zero[DORMAND_PRINCE_STATES] = {0};
    const real *y0 = REALS(block, dormand_prince_numbers, y0),
               *y = REALS(block, dormand_prince_numbers, y),
               *absolute = REALS(block, dormand_prince_numbers, absolute),
               *relative = REALS(block, dormand_prince_numbers, relative);
    real e[DORMAND_PRINCE_STATES], sum = real_all(0);
    combine(zero, *REALS(block, dormand_prince_numbers, size), difference, DORMAND_PRINCE_STAGES,
            (const real(*)[DORMAND_PRINCE_STATES])REALS(block, dormand_prince_numbers, k), e);
    for (int i = 0; i < DORMAND_PRINCE_STATES; i++) {
        real size = real_max(real_abs(y0[i]), real_abs(y[i]));
        real share = e[i] / (absolute[i] + relative[i] * size);
        sum += share * share;
    }
    *REALS(block, dormand_prince_numbers, error) = real_sqrt(sum / (double)count);
}

#endif
