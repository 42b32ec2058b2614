// Matrices of 3 x 3 in lanes by their three cyclic diagonals, for hot loops: products need no lane
// spread over a register, and a symmetric matrix is exactly symmetric because each of its elements
// is kept once. Indices count modulo 3.
#ifndef LD_MATH_LANES_MAT3_H
#define LD_MATH_LANES_MAT3_H

#include "math/vectors/lanes_vec3.h"
#include "math/vectors/spatial.h"

typedef struct lanes_m3 {
    v4d d; // M[i][i]
    v4d o; // M[i][i - 1]
    v4d p; // M[i][i + 1]
} lanes_m3;

// M[i][i + 1] = M[i + 1][i], the other cyclic diagonal is v4d_yzx(o).
typedef struct lanes_sym3 {
    v4d d, o;
} lanes_sym3;

// A vector with its rotations.
typedef struct lanes_cycle {
    v4d v, zxy, yzx;
} lanes_cycle;

LD_INLINE lanes_cycle lanes_cycle_of(v4d v)
{
    return (lanes_cycle){v, v4d_zxy(v), v4d_yzx(v)};
}
// a x b
LD_INLINE v4d lanes_cross(const lanes_cycle *a, v4d b)
{
    return v4d_zxy(a->zxy * b - a->v * v4d_zxy(b));
}
LD_INLINE v4d lanes_apply(const lanes_m3 *M, const lanes_cycle *a)
{
    return (M->d * a->v + M->o * a->zxy) + M->p * a->yzx;
}
// M^T a
LD_INLINE v4d lanes_apply_transposed(const lanes_m3 *M, v4d a)
{
    return (M->d * a + v4d_zxy(M->p * a)) + v4d_yzx(M->o * a);
}
LD_INLINE v4d lanes_sym_apply(const lanes_sym3 *M, const lanes_cycle *a)
{
    return (M->d * a->v + M->o * a->zxy) + v4d_yzx(M->o * a->v);
}
LD_INLINE lanes_m3 lanes_from_m3(const m3 *M)
{
    const double(*a)[3] = M->a;
    return (lanes_m3){{a[0][0], a[1][1], a[2][2], 0},
                      {a[0][2], a[1][0], a[2][1], 0},
                      {a[0][1], a[1][2], a[2][0], 0}};
}
LD_INLINE m3 lanes_to_m3(const lanes_m3 *M)
{
    return (m3){
        {{M->d[0], M->p[0], M->o[0]}, {M->o[1], M->d[1], M->p[1]}, {M->p[2], M->o[2], M->d[2]}}};
}
LD_INLINE lanes_sym3 lanes_from_sym3(const sym3 *M)
{
    return (lanes_sym3){{M->xx, M->yy, M->zz, 0}, {M->xz, M->xy, M->yz, 0}};
}
LD_INLINE sym3 lanes_to_sym3(const lanes_sym3 *M)
{
    return (sym3){M->d[0], M->o[1], M->o[0], M->d[1], M->o[2], M->d[2]};
}

#endif
