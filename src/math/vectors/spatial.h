// Spatial algebra of the reduced sweep: accelerations x = [a; alpha] and wrenches F = [f; m] at a
// body's origin, and the symmetric 6 x 6 matrices between them, F = Z x, all along the same axes.
#ifndef LD_MATH_SPATIAL_H
#define LD_MATH_SPATIAL_H

#include "math/vectors/mat3.h"

// A pair of linear and angular part: [a; alpha] or [f; m].
typedef struct spatial {
    v3 linear, angular;
} spatial;

typedef struct sym3 {
    double xx, xy, xz, yy, yz, zz;
} sym3;

// Z = [A, B; B^T, C]: f = A a + B alpha, m = B^T a + C alpha.
typedef struct spatial_matrix {
    sym3 A;
    m3 B;
    sym3 C;
} spatial_matrix;

LD_INLINE spatial spatial_add(spatial x, spatial y)
{
    return (spatial){v3_add(x.linear, y.linear), v3_add(x.angular, y.angular)};
}
LD_INLINE spatial spatial_axpy(spatial x, double s, spatial y)
{
    return (spatial){v3_axpy(x.linear, s, y.linear), v3_axpy(x.angular, s, y.angular)};
}
LD_INLINE double spatial_dot(spatial x, spatial y)
{
    return v3_dot(x.linear, y.linear) + v3_dot(x.angular, y.angular);
}

LD_INLINE v3 sym3_apply(sym3 s, v3 v)
{
    return (v3){s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
                s.xz * v.x + s.yz * v.y + s.zz * v.z};
}
LD_INLINE sym3 sym3_add(sym3 s, sym3 t)
{
    return (sym3){s.xx + t.xx, s.xy + t.xy, s.xz + t.xz, s.yy + t.yy, s.yz + t.yz, s.zz + t.zz};
}
LD_INLINE double sym3_trace(sym3 s)
{
    return s.xx + s.yy + s.zz;
}
// The symmetric part's lower triangle of a matrix known to be symmetric.
LD_INLINE sym3 sym3_of(m3 m)
{
    return (sym3){m.a[0][0], m.a[1][0], m.a[2][0], m.a[1][1], m.a[2][1], m.a[2][2]};
}
LD_INLINE m3 sym3_full(sym3 s)
{
    return (m3){{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
}
// A s A^T
LD_INLINE sym3 sym3_turn(m3 A, sym3 s)
{
    m3 h;
    for (int i = 0; i < 3; i++) {
        const double *a = A.a[i];
        h.a[i][0] = a[0] * s.xx + a[1] * s.xy + a[2] * s.xz;
        h.a[i][1] = a[0] * s.xy + a[1] * s.yy + a[2] * s.yz;
        h.a[i][2] = a[0] * s.xz + a[1] * s.yz + a[2] * s.zz;
    }
#define LD_ROW(i, j) (h.a[i][0] * A.a[j][0] + h.a[i][1] * A.a[j][1] + h.a[i][2] * A.a[j][2])
    return (sym3){LD_ROW(0, 0), LD_ROW(1, 0), LD_ROW(2, 0),
                  LD_ROW(1, 1), LD_ROW(2, 1), LD_ROW(2, 2)};
#undef LD_ROW
}
// s - u v^T for parallel u, v (so that it stays symmetric)
LD_INLINE sym3 sym3_less(sym3 s, v3 u, v3 v)
{
    return (sym3){s.xx - u.x * v.x, s.xy - u.x * v.y, s.xz - u.x * v.z,
                  s.yy - u.y * v.y, s.yz - u.y * v.z, s.zz - u.z * v.z};
}

LD_INLINE spatial spatial_apply(const spatial_matrix *Z, spatial x)
{
    return (spatial){
        v3_add(sym3_apply(Z->A, x.linear), m3_apply(Z->B, x.angular)),
        v3_add(m3_apply_transposed(Z->B, x.linear), sym3_apply(Z->C, x.angular)),
    };
}
LD_INLINE void spatial_matrix_add(spatial_matrix *Z, const spatial_matrix *other)
{
    Z->A = sym3_add(Z->A, other->A);
    Z->B = m3_add(Z->B, other->B);
    Z->C = sym3_add(Z->C, other->C);
}
// Z -= U V^T for V parallel to U
LD_INLINE void spatial_matrix_less(spatial_matrix *Z, spatial U, spatial V)
{
    Z->A = sym3_less(Z->A, U.linear, V.linear);
    Z->C = sym3_less(Z->C, U.angular, V.angular);
    double u[3] = {U.linear.x, U.linear.y, U.linear.z};
    for (int i = 0; i < 3; i++) {
        Z->B.a[i][0] -= u[i] * V.angular.x;
        Z->B.a[i][1] -= u[i] * V.angular.y;
        Z->B.a[i][2] -= u[i] * V.angular.z;
    }
}

// Into other axes: A x, A^T x, A Z A^T.
LD_INLINE spatial spatial_turn(m3 A, spatial x)
{
    return (spatial){m3_apply(A, x.linear), m3_apply(A, x.angular)};
}
LD_INLINE spatial spatial_turn_back(m3 A, spatial x)
{
    return (spatial){m3_apply_transposed(A, x.linear), m3_apply_transposed(A, x.angular)};
}
LD_INLINE spatial_matrix spatial_matrix_turn(m3 A, const spatial_matrix *Z)
{
    return (spatial_matrix){sym3_turn(A, Z->A), m3_mul(A, m3_mul(Z->B, m3_transpose(A))),
                            sym3_turn(A, Z->C)};
}

// Acceleration of a point at r of the same rigid body: T x, T = [E, -~r; 0, E].
LD_INLINE spatial spatial_shift(v3 r, spatial x)
{
    return (spatial){v3_add(x.linear, v3_cross(x.angular, r)), x.angular};
}
// The wrench at the origin that is the same as F at r: T^T F.
LD_INLINE spatial wrench_shift(v3 r, spatial F)
{
    return (spatial){F.linear, v3_add(F.angular, v3_cross(r, F.linear))};
}
// T^T Z T
LD_INLINE void spatial_matrix_shift(v3 r, spatial_matrix *Z)
{
    sym3 A = Z->A;
    m3 B = Z->B;
    // B - A ~r
    m3 S = {{{B.a[0][0] + (A.xz * r.y - A.xy * r.z), B.a[0][1] + (A.xx * r.z - A.xz * r.x),
              B.a[0][2] + (A.xy * r.x - A.xx * r.y)},
             {B.a[1][0] + (A.yz * r.y - A.yy * r.z), B.a[1][1] + (A.xy * r.z - A.yz * r.x),
              B.a[1][2] + (A.yy * r.x - A.xy * r.y)},
             {B.a[2][0] + (A.zz * r.y - A.yz * r.z), B.a[2][1] + (A.xz * r.z - A.zz * r.x),
              B.a[2][2] + (A.yz * r.x - A.xz * r.y)}}};
    // C + ~r B + (~r S)^T
    Z->C.xx += (r.y * B.a[2][0] - r.z * B.a[1][0]) + (r.y * S.a[2][0] - r.z * S.a[1][0]);
    Z->C.xy += (r.y * B.a[2][1] - r.z * B.a[1][1]) + (r.z * S.a[0][0] - r.x * S.a[2][0]);
    Z->C.xz += (r.y * B.a[2][2] - r.z * B.a[1][2]) + (r.x * S.a[1][0] - r.y * S.a[0][0]);
    Z->C.yy += (r.z * B.a[0][1] - r.x * B.a[2][1]) + (r.z * S.a[0][1] - r.x * S.a[2][1]);
    Z->C.yz += (r.z * B.a[0][2] - r.x * B.a[2][2]) + (r.x * S.a[1][1] - r.y * S.a[0][1]);
    Z->C.zz += (r.x * B.a[1][2] - r.y * B.a[0][2]) + (r.x * S.a[1][2] - r.y * S.a[0][2]);
    Z->B = S;
}

#endif
