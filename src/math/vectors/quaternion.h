// Quaternions (w, x, y, z), Hamilton product, q_AB turning coordinates in B into coordinates in A.
#ifndef LD_MATH_QUATERNION_H
#define LD_MATH_QUATERNION_H

#include <stddef.h>

#include "math/vectors/mat3.h"

typedef struct quat {
    double w, x, y, z;
} quat;
// it is copied into four numbers of a state as it stands
_Static_assert(offsetof(quat, w) == 0 && offsetof(quat, x) == sizeof(double) &&
                   offsetof(quat, y) == 2 * sizeof(double) &&
                   offsetof(quat, z) == 3 * sizeof(double) && sizeof(quat) == 4 * sizeof(double),
               "a quaternion is four numbers, the scalar part first");

LD_INLINE quat q_from(const double a[4])
{
    return (quat){a[0], a[1], a[2], a[3]};
}
LD_INLINE quat q_multiply(quat p, quat q)
{
    return (quat){p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z,
                  p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
                  p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
                  p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w};
}
/// Rotation matrix of q/|q|: exact for a quaternion of any length but zero.
LD_INLINE m3 q_matrix(quat q)
{
    double n = 2.0 / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    double xx = n * q.x * q.x, yy = n * q.y * q.y, zz = n * q.z * q.z;
    double xy = n * q.x * q.y, xz = n * q.x * q.z, yz = n * q.y * q.z;
    double wx = n * q.w * q.x, wy = n * q.w * q.y, wz = n * q.w * q.z;
    return (m3){{{1 - (yy + zz), xy - wz, xz + wy},
                 {xy + wz, 1 - (xx + zz), yz - wx},
                 {xz - wy, yz + wx, 1 - (xx + yy)}}};
}
/// q_dot = 1/2 q (0, w) for the angular velocity w of B relative to A in B.
LD_INLINE quat q_rate(quat q, v3 w)
{
    return (quat){
        0.5 * (-q.x * w.x - q.y * w.y - q.z * w.z), 0.5 * (q.w * w.x + q.y * w.z - q.z * w.y),
        0.5 * (q.w * w.y - q.x * w.z + q.z * w.x), 0.5 * (q.w * w.z + q.x * w.y - q.y * w.x)};
}
/// Unit quaternion of a rotation matrix (largest of the four components first: never near zero).
LD_INLINE quat q_from_matrix(m3 A)
{
    double t[4] = {A.a[0][0] + A.a[1][1] + A.a[2][2], A.a[0][0] - A.a[1][1] - A.a[2][2],
                   A.a[1][1] - A.a[0][0] - A.a[2][2], A.a[2][2] - A.a[0][0] - A.a[1][1]};
    int i = 0;
    for (int k = 1; k < 4; k++)
        if (t[k] > t[i])
            i = k;
    double r = sqrt(1.0 + t[i]), h = 0.5 / r;
    double wx = h * (A.a[2][1] - A.a[1][2]), wy = h * (A.a[0][2] - A.a[2][0]),
           wz = h * (A.a[1][0] - A.a[0][1]);
    double xy = h * (A.a[0][1] + A.a[1][0]), xz = h * (A.a[0][2] + A.a[2][0]),
           yz = h * (A.a[1][2] + A.a[2][1]);
    switch (i) {
    case 0:
        return (quat){0.5 * r, wx, wy, wz};
    case 1:
        return (quat){wx, 0.5 * r, xy, xz};
    case 2:
        return (quat){wy, xy, 0.5 * r, yz};
    default:
        return (quat){wz, xz, yz, 0.5 * r};
    }
}

#endif
