// The algebra of vec3.h, mat3.h and quaternion.h, operation by operation, over reals.
#ifndef LD_MATH_REAL_VEC3_H
#define LD_MATH_REAL_VEC3_H

#include "math/real.h"

typedef struct real3 {
    real x, y, z;
} real3;

typedef struct real33 {
    real a[3][3];
} real33;

LD_INLINE real3 real3_from(const real a[3])
{
    return (real3){a[0], a[1], a[2]};
}
LD_INLINE void real3_store(real out[3], real3 a)
{
    out[0] = a.x;
    out[1] = a.y;
    out[2] = a.z;
}
LD_INLINE real3 real3_add(real3 a, real3 b)
{
    return (real3){a.x + b.x, a.y + b.y, a.z + b.z};
}
LD_INLINE real3 real3_sub(real3 a, real3 b)
{
    return (real3){a.x - b.x, a.y - b.y, a.z - b.z};
}
LD_INLINE real3 real3_scale(real s, real3 a)
{
    return (real3){s * a.x, s * a.y, s * a.z};
}
/// a + s b
LD_INLINE real3 real3_axpy(real3 a, real s, real3 b)
{
    return (real3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
LD_INLINE real real3_norm2(real3 a)
{
    return a.x * a.x + a.y * a.y + a.z * a.z;
}
LD_INLINE real real3_norm(real3 a)
{
    return real_sqrt(real3_norm2(a));
}
LD_INLINE real3 real3_cross(real3 a, real3 b)
{
    return (real3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
LD_INLINE real3 real33_apply(const real33 *m, real3 a)
{
    const real(*e)[3] = m->a;
    return (real3){e[0][0] * a.x + e[0][1] * a.y + e[0][2] * a.z,
                   e[1][0] * a.x + e[1][1] * a.y + e[1][2] * a.z,
                   e[2][0] * a.x + e[2][1] * a.y + e[2][2] * a.z};
}
LD_INLINE real3 real33_apply_transposed(const real33 *m, real3 a)
{
    const real(*e)[3] = m->a;
    return (real3){e[0][0] * a.x + e[1][0] * a.y + e[2][0] * a.z,
                   e[0][1] * a.x + e[1][1] * a.y + e[2][1] * a.z,
                   e[0][2] * a.x + e[1][2] * a.y + e[2][2] * a.z};
}
// Rotation matrix of the quaternion q/|q|, q = (w, x, y, z).
LD_INLINE real33 real33_of_quaternion(const real q[4])
{
    real n = 2.0 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    real xx = n * q[1] * q[1], yy = n * q[2] * q[2], zz = n * q[3] * q[3];
    real xy = n * q[1] * q[2], xz = n * q[1] * q[3], yz = n * q[2] * q[3];
    real wx = n * q[0] * q[1], wy = n * q[0] * q[2], wz = n * q[0] * q[3];
    return (real33){{{1.0 - (yy + zz), xy - wz, xz + wy},
                     {xy + wz, 1.0 - (xx + zz), yz - wx},
                     {xz - wy, yz + wx, 1.0 - (xx + yy)}}};
}
// Inverse of a symmetric matrix by its adjugate.
LD_INLINE real33 real33_symmetric_inverse(const real33 *J)
{
    const real(*a)[3] = J->a;
    real c00 = a[1][1] * a[2][2] - a[1][2] * a[1][2], c01 = a[0][2] * a[1][2] - a[0][1] * a[2][2];
    real c02 = a[0][1] * a[1][2] - a[0][2] * a[1][1];
    real s = 1.0 / (a[0][0] * c00 + a[0][1] * c01 + a[0][2] * c02);
    real d01 = s * c01, d02 = s * c02, d12 = s * (a[0][1] * a[0][2] - a[0][0] * a[1][2]);
    return (real33){{{s * c00, d01, d02},
                     {d01, s * (a[0][0] * a[2][2] - a[0][2] * a[0][2]), d12},
                     {d02, d12, s * (a[0][0] * a[1][1] - a[0][1] * a[0][1])}}};
}

#endif
