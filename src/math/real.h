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
