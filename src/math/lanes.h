// Lanes of four doubles (GCC and clang vector extensions): the same bits with and without AVX,
// since every sum's order is written down and nothing is contracted.
#ifndef LD_MATH_LANES_H
#define LD_MATH_LANES_H

#include <stdbool.h>
#include <stdlib.h>

#include "math/vec3.h"

typedef double v4d __attribute__((vector_size(32), may_alias));
/// Half of that, which stays in registers without AVX: for sums in functions of their own, which a
/// caller's wider instructions do not reach.
typedef double v2d __attribute__((vector_size(16), may_alias));

/// An array of doubles that is also read as lanes: `count` a multiple of 4.
#define LANE_ARRAY(name, count) _Alignas(32) double name[count]

LD_ALWAYS_INLINE v4d *v4d_lanes(double *array)
{
    return (v4d *)array;
}
LD_ALWAYS_INLINE const v4d *v4d_lanes_of(const double *array)
{
    return (const v4d *)array;
}

LD_ALWAYS_INLINE const v2d *v2d_lanes_of(const double *array)
{
    return (const v2d *)array;
}

LD_ALWAYS_INLINE v4d v4d_all(double a)
{
    return (v4d){a, a, a, a};
}
LD_ALWAYS_INLINE v2d v2d_all(double a)
{
    return (v2d){a, a};
}
/// Sum of the four, (0 + 2) + (1 + 3).
LD_ALWAYS_INLINE double v4d_sum(v4d a)
{
    return (a[0] + a[2]) + (a[1] + a[3]);
}
/// Of a function that is compiled a second time for AVX2, with the same bits.
#if defined(__x86_64__)
#define LANES_AVX2 __attribute__((target("avx2")))
#else
#define LANES_AVX2
#endif
/// True where code compiled for AVX2 runs. LAUNCHDYN_PLAIN=1 does without (valgrind does not know
/// all of it).
LD_INLINE bool lanes_have_avx2(void)
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2") && !getenv("LAUNCHDYN_PLAIN");
#else
    return false;
#endif
}

/// Promises the compiler that there is at least one lane.
#define LANES_NOT_EMPTY(count)                                                                     \
    do {                                                                                           \
        if ((count) < 1)                                                                           \
            __builtin_unreachable();                                                               \
    } while (0)

/// Dot product of two arrays of `count` lanes.
LD_INLINE double v4d_dot(int count, const double *p, const double *q)
{
    const v4d *a = v4d_lanes_of(p), *b = v4d_lanes_of(q);
    v4d sum = a[0] * b[0];
    for (int i = 1; i < count; i++)
        sum += a[i] * b[i];
    return v4d_sum(sum);
}

#endif
