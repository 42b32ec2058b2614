// Vectors of three, by value. v3_ prefix; every function is one expression of the usual algebra.
#ifndef LD_MATH_VEC3_H
#define LD_MATH_VEC3_H

#include <math.h>

typedef struct v3 {
    double x, y, z;
} v3;

// Small functions are always inlined, so that a long computation is one piece of code; not in
// builds with sanitizers, which would take minutes to compile it.
#define LD_ALWAYS_INLINE static inline __attribute__((always_inline, unused))
// Of what is rarely needed: inlined, it would slow down what surrounds it.
#define LD_OUTLINE static __attribute__((noinline, unused))
#if defined(LD_SANITIZED)
#define LD_INLINE static inline __attribute__((unused))
#else
#define LD_INLINE LD_ALWAYS_INLINE
#endif

LD_INLINE v3 v3_make(double x, double y, double z)
{
    return (v3){x, y, z};
}
LD_INLINE v3 v3_from(const double a[3])
{
    return (v3){a[0], a[1], a[2]};
}
LD_INLINE void v3_store(double out[3], v3 a)
{
    out[0] = a.x;
    out[1] = a.y;
    out[2] = a.z;
}
LD_INLINE v3 v3_zero(void)
{
    return (v3){0, 0, 0};
}
LD_INLINE v3 v3_add(v3 a, v3 b)
{
    return (v3){a.x + b.x, a.y + b.y, a.z + b.z};
}
LD_INLINE v3 v3_sub(v3 a, v3 b)
{
    return (v3){a.x - b.x, a.y - b.y, a.z - b.z};
}
LD_INLINE v3 v3_neg(v3 a)
{
    return (v3){-a.x, -a.y, -a.z};
}
LD_INLINE v3 v3_scale(double s, v3 a)
{
    return (v3){s * a.x, s * a.y, s * a.z};
}
/// a + s b
LD_INLINE v3 v3_axpy(v3 a, double s, v3 b)
{
    return (v3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
/// component by component
LD_INLINE v3 v3_mul(v3 a, v3 b)
{
    return (v3){a.x * b.x, a.y * b.y, a.z * b.z};
}
LD_INLINE double v3_dot(v3 a, v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LD_INLINE v3 v3_cross(v3 a, v3 b)
{
    return (v3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
LD_INLINE double v3_norm2(v3 a)
{
    return v3_dot(a, a);
}
LD_INLINE double v3_norm(v3 a)
{
    return sqrt(v3_dot(a, a));
}

#endif
