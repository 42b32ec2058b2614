// Random test data: a small counter-free generator (splitmix64) with a seed that a test prints.
#ifndef LD_TESTS_SUPPORT_DRAW_H
#define LD_TESTS_SUPPORT_DRAW_H

#include <stdint.h>

#include "math/vectors/quaternion.h"

// Uniform in [-1, 1).
static inline double draw(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    z ^= z >> 31;
    return (double)(z >> 11) / 4503599627370496.0 - 1;
}

static inline v3 draw_v3(uint64_t *state, double size)
{
    double x = draw(state), y = draw(state), z = draw(state);
    return v3_make(size * x, size * y, size * z);
}

static inline m3 draw_rotation(uint64_t *state)
{
    double w = draw(state), x = draw(state), y = draw(state), z = draw(state);
    return q_matrix((quat){w, x, y, z + 1e-3});
}

// Inertia about the mass centre of a random body: a box turned at random, so that it is physical.
static inline m3 draw_inertia(uint64_t *state, double mass)
{
    double a = 0.3 + 0.2 * draw(state), b = 0.3 + 0.2 * draw(state), c = 0.3 + 0.2 * draw(state);
    m3 A = draw_rotation(state);
    m3 J = m3_diagonal(mass * (b * b + c * c) / 3, mass * (a * a + c * c) / 3,
                       mass * (a * a + b * b) / 3);
    return m3_mul(A, m3_mul(J, m3_transpose(A)));
}

#endif
