// A number, or one of each lane: text that is written with `real` is compiled with LANES 1, 4 and 8
// and gives every lane the bits of LANES 1. Who includes this defines LANES; operators, and
// comparisons as conditions, work on all three (GCC and clang vector extensions).
#ifndef LD_MATH_REAL_H
#define LD_MATH_REAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "math/vec3.h"

#if LANES == 1
typedef double real;
typedef uint64_t real_bits; // the bits of a real, or a condition
typedef int64_t real_condition;
#define REAL_LANE(x, lane) (x)
#else
#include <immintrin.h>
typedef double real __attribute__((vector_size(8 * LANES), may_alias));
typedef uint64_t real_bits __attribute__((vector_size(8 * LANES)));
typedef int64_t real_condition __attribute__((vector_size(8 * LANES)));
#define REAL_LANE(x, lane) (x)[lane]
#endif

// A struct of nothing but doubles is also kept lane by lane, each member as many times as there are
// lanes: where `member` of that struct lies in such a block.
#define REALS(block, type, member) ((real *)(block) + offsetof(type, member) / sizeof(double))

LD_ALWAYS_INLINE real real_all(double a)
{
    return a - (real){0};
}

LD_ALWAYS_INLINE real_bits real_to_bits(real a)
{
#if LANES == 1
    real_bits bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
#else
    return (real_bits)a;
#endif
}
LD_ALWAYS_INLINE real real_from_bits(real_bits bits)
{
#if LANES == 1
    real a;
    memcpy(&a, &bits, sizeof a);
    return a;
#else
    return (real)bits;
#endif
}

// a where the condition holds, else b.
LD_ALWAYS_INLINE real real_select(real_condition holds, real a, real b)
{
#if LANES == 1
    return holds ? a : b;
#else
    return (real)(((real_condition)a & holds) | ((real_condition)b & ~holds));
#endif
}

LD_ALWAYS_INLINE real_condition real_not(real_condition a)
{
#if LANES == 1
    return !a;
#else
    return ~a;
#endif
}

// In which lanes a condition holds: bit i for lane i.
LD_ALWAYS_INLINE unsigned real_lanes(real_condition holds)
{
#if LANES == 1
    return holds != 0;
#elif LANES == 4
    return (unsigned)_mm256_movemask_pd((__m256d)holds);
#else
    return (unsigned)_mm512_movepi64_mask((__m512i)holds);
#endif
}

// Whether it holds in some lane.
LD_ALWAYS_INLINE bool real_any(real_condition holds)
{
    return real_lanes(holds) != 0;
}

LD_ALWAYS_INLINE real real_sqrt(real a)
{
#if LANES == 1
    return sqrt(a);
#elif LANES == 4
    return (real)_mm256_sqrt_pd((__m256d)a);
#else
    return (real)_mm512_sqrt_pd((__m512d)a);
#endif
}

LD_ALWAYS_INLINE real real_abs(real a)
{
    return real_from_bits(real_to_bits(a) & ~((real_bits){0} + ((uint64_t)1 << 63)));
}

// Turns a square of numbers: number j of a[i] becomes number i of a[j].
LD_ALWAYS_INLINE void real_turn(real a[LANES])
{
#if LANES == 4
    __m256d low0 = _mm256_unpacklo_pd((__m256d)a[0], (__m256d)a[1]);
    __m256d low2 = _mm256_unpacklo_pd((__m256d)a[2], (__m256d)a[3]);
    __m256d high0 = _mm256_unpackhi_pd((__m256d)a[0], (__m256d)a[1]);
    __m256d high2 = _mm256_unpackhi_pd((__m256d)a[2], (__m256d)a[3]);
    a[0] = (real)_mm256_permute2f128_pd(low0, low2, 0x20);
    a[1] = (real)_mm256_permute2f128_pd(high0, high2, 0x20);
    a[2] = (real)_mm256_permute2f128_pd(low0, low2, 0x31);
    a[3] = (real)_mm256_permute2f128_pd(high0, high2, 0x31);
#elif LANES == 8
    // squares of 2, then of 4, then of 8: those beside the diagonal change places
    for (int half = 1; half < LANES; half *= 2)
        for (int i = 0; i < LANES; i++) {
            if (i & half)
                continue;
            real_condition first, second;
            for (int lane = 0; lane < LANES; lane++) {
                first[lane] = lane & half ? lane - half + LANES : lane;
                second[lane] = lane & half ? lane + LANES : lane + half;
            }
            __m512d low = (__m512d)a[i], high = (__m512d)a[i + half];
            a[i] = (real)_mm512_permutex2var_pd(low, (__m512i)first, high);
            a[i + half] = (real)_mm512_permutex2var_pd(low, (__m512i)second, high);
        }
#else
    (void)a;
#endif
}

// The larger; b where a is not a number.
LD_ALWAYS_INLINE real real_max(real a, real b)
{
    return real_select(a > b, a, b);
}

// The smaller; b where a is not a number.
LD_ALWAYS_INLINE real real_min(real a, real b)
{
    return real_select(a < b, a, b);
}

#endif
