// Vectors of three in four lanes, the last one zero: the same algebra as vec3.h for hot loops. The
// compiler makes one AVX instruction of an operation, or two of SSE2; the bits are the same.
#ifndef LD_MATH_LANES_VEC3_H
#define LD_MATH_LANES_VEC3_H

#include "math/lanes.h"
#include "math/vectors/mat3.h"

LD_INLINE v4d v4d_from_v3(v3 v)
{
    return (v4d){v.x, v.y, v.z, 0};
}
LD_INLINE v3 v4d_v3(v4d v)
{
    return (v3){v[0], v[1], v[2]};
}
// (y, z, x) and (z, x, y), the second one cheaper
LD_INLINE v4d v4d_yzx(v4d v)
{
    return (v4d){v[1], v[2], v[0], v[3]};
}
LD_INLINE v4d v4d_zxy(v4d v)
{
    return (v4d){v[2], v[0], v[1], v[3]};
}
LD_INLINE v4d v4d_cross(v4d a, v4d b)
{
    return v4d_zxy(v4d_zxy(a) * b - a * v4d_zxy(b));
}
// (x + z) + y in all lanes.
LD_INLINE v4d v4d_total(v4d v)
{
    v += (v4d){v[2], v[3], v[0], v[1]};
    return v + (v4d){v[1], v[0], v[3], v[2]};
}
// x column[0] + y column[1] + z column[2]
LD_INLINE v4d v4d_combine(const v4d column[3], double x, double y, double z)
{
    return (column[0] * v4d_all(x) + column[1] * v4d_all(y)) + column[2] * v4d_all(z);
}
// The matrix of these columns.
LD_INLINE m3 v4d_m3(const v4d column[3])
{
    return m3_columns(v4d_v3(column[0]), v4d_v3(column[1]), v4d_v3(column[2]));
}
LD_INLINE void v4d_store_m3(v4d column[3], m3 m)
{
    for (int j = 0; j < 3; j++)
        column[j] = v4d_from_v3(m3_column(m, j));
}

#endif
