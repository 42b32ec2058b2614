// 3 x 3 matrices, row by row, by value.
#ifndef LD_MATH_MAT3_H
#define LD_MATH_MAT3_H

#include <stdbool.h>

#include "math/functions.h"
#include "math/vec3.h"

typedef struct m3 {
    double a[3][3];
} m3;

LD_INLINE m3 m3_identity(void)
{
    return (m3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}
LD_INLINE bool m3_is_identity(const m3 *m)
{
    for (int i = 0; i < 9; i++)
        if (m->a[i / 3][i % 3] != (i % 4 == 0))
            return false;
    return true;
}
LD_INLINE m3 m3_diagonal(double x, double y, double z)
{
    return (m3){{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
}
/// from its columns
LD_INLINE m3 m3_columns(v3 x, v3 y, v3 z)
{
    return (m3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}
/// column j (0, 1, 2)
LD_INLINE v3 m3_column(m3 m, int j)
{
    return (v3){m.a[0][j], m.a[1][j], m.a[2][j]};
}
/// ~a: skew matrix with ~a b = a x b
LD_INLINE m3 m3_skew(v3 a)
{
    return (m3){{{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}}};
}
LD_INLINE m3 m3_outer(v3 a, v3 b)
{
    return (m3){{{a.x * b.x, a.x * b.y, a.x * b.z},
                 {a.y * b.x, a.y * b.y, a.y * b.z},
                 {a.z * b.x, a.z * b.y, a.z * b.z}}};
}
LD_INLINE m3 m3_add(m3 m, m3 n)
{
    m3 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.a[i][j] = m.a[i][j] + n.a[i][j];
    return r;
}
LD_INLINE m3 m3_sub(m3 m, m3 n)
{
    m3 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.a[i][j] = m.a[i][j] - n.a[i][j];
    return r;
}
LD_INLINE m3 m3_scale(double s, m3 m)
{
    m3 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.a[i][j] = s * m.a[i][j];
    return r;
}
LD_INLINE m3 m3_transpose(m3 m)
{
    m3 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.a[i][j] = m.a[j][i];
    return r;
}
LD_INLINE m3 m3_mul(m3 m, m3 n)
{
    m3 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.a[i][j] = m.a[i][0] * n.a[0][j] + m.a[i][1] * n.a[1][j] + m.a[i][2] * n.a[2][j];
    return r;
}
/// m v
LD_INLINE v3 m3_apply(m3 m, v3 v)
{
    return (v3){m.a[0][0] * v.x + m.a[0][1] * v.y + m.a[0][2] * v.z,
                m.a[1][0] * v.x + m.a[1][1] * v.y + m.a[1][2] * v.z,
                m.a[2][0] * v.x + m.a[2][1] * v.y + m.a[2][2] * v.z};
}
/// m^T v
LD_INLINE v3 m3_apply_transposed(m3 m, v3 v)
{
    return (v3){m.a[0][0] * v.x + m.a[1][0] * v.y + m.a[2][0] * v.z,
                m.a[0][1] * v.x + m.a[1][1] * v.y + m.a[2][1] * v.z,
                m.a[0][2] * v.x + m.a[1][2] * v.y + m.a[2][2] * v.z};
}
LD_INLINE m3 m3_rotation_x(double angle)
{
    double c, s;
    sincos(angle, &s, &c);
    return (m3){{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
}
LD_INLINE m3 m3_rotation_y(double angle)
{
    double c, s;
    sincos(angle, &s, &c);
    return (m3){{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
}
LD_INLINE m3 m3_rotation_z(double angle)
{
    double c, s;
    sincos(angle, &s, &c);
    return (m3){{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}
/// Yaw, pitch, roll of m = Ry(yaw) Rz(pitch) Rx(roll).
LD_INLINE void m3_yaw_pitch_roll(const m3 *m, double angles[3])
{
    angles[0] = atan2(-m->a[2][0], m->a[0][0]);
    angles[1] = asin(fmax(-1, fmin(1, m->a[1][0])));
    angles[2] = atan2(-m->a[1][2], m->a[1][1]);
}
/// Inverse of a symmetric matrix, by its cofactors.
LD_INLINE m3 m3_symmetric_inverse(m3 m)
{
    double a = m.a[0][0], b = m.a[1][1], c = m.a[2][2], d = m.a[0][1], e = m.a[0][2], f = m.a[1][2];
    double A = b * c - f * f, B = e * f - d * c, C = d * f - e * b;
    double s = 1 / (a * A + d * B + e * C);
    double D = a * c - e * e, E = d * e - a * f, F = a * b - d * d;
    return (m3){{{s * A, s * B, s * C}, {s * B, s * D, s * E}, {s * C, s * E, s * F}}};
}

#endif
