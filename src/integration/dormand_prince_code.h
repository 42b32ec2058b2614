// A step's arithmetic for integrations side by side, one in each lane (math/real.h): the text of
// dormand_prince_default.c, which has one lane, and of dormand_prince_avx2.c and
// dormand_prince_avx512.c.
#ifndef LD_INTEGRATION_DORMAND_PRINCE_CODE_H
#define LD_INTEGRATION_DORMAND_PRINCE_CODE_H

#include "integration/dormand_prince.h"
#include "math/real_functions.h"

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

// Each number of states has an instance of its own: `states` is a constant where these are called.

typedef struct stage_weights {
    const double *a;
    int count;
} stage_weights;

// out = y + h sum of a_j k_j, j < count; unrolled for each count.
LD_ALWAYS_INLINE void combine(const real *y, real h, stage_weights of,
                              const real k[][DORMAND_PRINCE_STATES], int states, real *out)
{
    real b[DORMAND_PRINCE_STAGES];
    for (int j = 0; j < of.count; j++)
        b[j] = h * of.a[j];
    for (int i = 0; i < states; i++) {
        real sum = b[0] * k[0][i];
        for (int j = 1; j < of.count; j++)
            sum += b[j] * k[j][i];
        out[i] = y[i] + sum;
    }
}

#define OF_STEP(member) (*REALS(block, dormand_prince_numbers, member))

// Where the last step is done the next one begins at its end.
LD_ALWAYS_INLINE void begin_steps(double *block, int states)
{
    real_condition done = OF_STEP(outcome) == (double)DORMAND_PRINCE_DONE;
    real *y0 = REALS(block, dormand_prince_numbers, y0),
         *y = REALS(block, dormand_prince_numbers, y);
    real *first = REALS(block, dormand_prince_numbers, k[0]),
         *last = REALS(block, dormand_prince_numbers, k[DORMAND_PRINCE_STAGES - 1]);
    for (int i = 0; i < states; i++) {
        y0[i] = real_select(done, y[i], y0[i]);
        first[i] = real_select(done, last[i], first[i]);
    }
    OF_STEP(t0) = real_select(done, OF_STEP(t), OF_STEP(t0));
    OF_STEP(most) = real_select(done, real_all(10), OF_STEP(most));
}

// The step's size: what is left before a stop is taken in one step or in two. Says where it ends
// there.
LD_INLINE real_condition choose_size(double *block)
{
    real h = OF_STEP(h), left = OF_STEP(t_stop) - OF_STEP(t0);
    real_condition last = h >= left * (1 - 1e-12);
    real halved = real_select(2.0 * h > left, 0.5 * left, h);
    OF_STEP(size) = real_select(last, left, halved);
    return last;
}

// The stages of the step of size `size` from (t0, y0), where k[0] is known; y: its end.
LD_ALWAYS_INLINE void take_stages(double *block, int states, dormand_prince_slopes f, void *self)
{
    real h = OF_STEP(size), t0 = OF_STEP(t0);
    const real *y0 = REALS(block, dormand_prince_numbers, y0);
    real(*k)[DORMAND_PRINCE_STATES] =
        (real(*)[DORMAND_PRINCE_STATES])REALS(block, dormand_prince_numbers, k);
    real at[DORMAND_PRINCE_STATES], t;
#define STAGE(s, to)                                                                               \
    combine(y0, h, (stage_weights){weight[s], s}, (const real(*)[DORMAND_PRINCE_STATES])k, states, \
            to);                                                                                   \
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
LD_ALWAYS_INLINE void find_error(double *block, int count, int states)
{
    const real zero[DORMAND_PRINCE_STATES] = {0};
    const real *y0 = REALS(block, dormand_prince_numbers, y0),
               *y = REALS(block, dormand_prince_numbers, y),
               *absolute = REALS(block, dormand_prince_numbers, absolute),
               *relative = REALS(block, dormand_prince_numbers, relative);
    real e[DORMAND_PRINCE_STATES], sum = real_all(0);
    combine(zero, OF_STEP(size), (stage_weights){difference, DORMAND_PRINCE_STAGES},
            (const real(*)[DORMAND_PRINCE_STATES])REALS(block, dormand_prince_numbers, k), states,
            e);
    for (int i = 0; i < states; i++) {
        real size = real_max(real_abs(y0[i]), real_abs(y[i]));
        real share = e[i] / (absolute[i] + relative[i] * size);
        sum += share * share;
    }
    OF_STEP(error) = real_sqrt(sum / (double)count);
}

// Whether the step is good enough, and the next size. `last`: it ends at its stop.
LD_ALWAYS_INLINE void judge(double *block, real_condition last, int states)
{
    real size = OF_STEP(size), error = OF_STEP(error), h = OF_STEP(h);
    // two stops may be a rounding apart
    real_condition goes = ((size > 4e-16 * real_abs(OF_STEP(t0))) | last) & (size > 0.0);
    real_condition done = (error <= 1.0) & goes, refused = real_not(done) & goes;
    // 0.9 error^-0.17, of a step that is done times before^0.04
    real log_error = real_log(real_max(real_min(error, real_all(1e40)), real_all(1e-40)));
    real power = -0.17 * log_error + real_select(done, 0.04 * OF_STEP(log_before), real_all(0));
    real grow = 0.9 * real_exp((real_pair){power, real_all(0)});
    grow = real_select(error < (double)INFINITY, grow, real_all(0.3));
    real shrunk = size * real_max(real_all(0.2), real_min(real_all(1), grow));
    real next = size * real_min(OF_STEP(most), real_max(real_all(0.2), grow));
    // a step cut short by a stop says nothing against the size before it
    next = real_select(size < h, real_max(next, h), next);
    OF_STEP(h) = real_select(done, next, real_select(refused, shrunk, h));
    OF_STEP(most) = real_select(refused, real_all(1), OF_STEP(most));
    OF_STEP(log_before) = real_select(done, real_max(log_error, real_all(DORMAND_PRINCE_LOG_LEAST)),
                                      OF_STEP(log_before));
    real end = real_select(last, OF_STEP(t_stop), OF_STEP(t0) + size);
    OF_STEP(t) = real_select(done, end, OF_STEP(t));
    OF_STEP(steps) += real_select(done, real_all(1), real_all(0));
    OF_STEP(evaluations) += real_select(goes, real_all(DORMAND_PRINCE_STAGES - 1), real_all(0));
    real failed =
        real_select(goes, real_all(DORMAND_PRINCE_REFUSED), real_all(DORMAND_PRINCE_LOST));
    OF_STEP(outcome) = real_select(done, real_all(DORMAND_PRINCE_DONE), failed);
    real *y0 = REALS(block, dormand_prince_numbers, y0),
         *y = REALS(block, dormand_prince_numbers, y);
    for (int i = 0; i < states; i++)
        y[i] = real_select(goes, y[i], y0[i]);
}

LD_ALWAYS_INLINE void try_steps(double *block, int count, int states, dormand_prince_slopes f,
                                void *self)
{
    begin_steps(block, states);
    real_condition last = choose_size(block);
    take_stages(block, states, f, self);
    find_error(block, count, states);
    judge(block, last, states);
}

#endif
