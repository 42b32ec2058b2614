#include "base/sobol.h"

#include <stddef.h>

#include "base/random.h"

static int degree_of(unsigned polynomial)
{
    int degree = 0;
    while (polynomial >> (degree + 1))
        degree++;
    return degree;
}

// Direction numbers v_1, v_2, ... as far as `bits` of an index need them, each a fraction; of the
// first dimension those of van der Corput (P. Bratley and B. L. Fox, Algorithm 659, 1988).
static void make_directions(int dimension, int bits, uint32_t v[SOBOL_BITS])
{
    const sobol_number *number = dimension > 0 ? &sobol_numbers[dimension - 1] : NULL;
    const int degree = number ? degree_of(number->polynomial) : bits;
    for (int k = 0; k < bits && k < degree; k++)
        v[k] = (number ? (uint32_t)number->m[k] : 1u) << (SOBOL_BITS - 1 - k);
    for (int k = degree; k < bits; k++) {
        v[k] = v[k - degree] ^ v[k - degree] >> degree;
        for (int i = 1; i < degree; i++)
            if (number->polynomial >> (degree - i) & 1)
                v[k] ^= v[k - i];
    }
}

uint32_t sobol_point(int dimension, uint32_t index)
{
    uint32_t v[SOBOL_BITS], gray = index ^ index >> 1, point = 0;
    int bits = gray ? degree_of(gray) + 1 : 0;
    make_directions(dimension, bits, v);
    for (int k = 0; k < bits; k++)
        if (gray >> k & 1)
            point ^= v[k];
    return point;
}

uint32_t sobol_scrambled(uint32_t coordinate, int bits, const uint64_t key[2], uint64_t first,
                         uint64_t second)
{
    uint32_t scrambled = 0;
    for (int k = 0; k < bits; k++) {
        uint64_t words[4], before = k ? coordinate >> (SOBOL_BITS - k) : 0;
        random_block(key, (uint64_t[]){first, second, (uint64_t)k << 32 | before, 2}, words);
        uint32_t bit = coordinate >> (SOBOL_BITS - 1 - k) & 1;
        scrambled = scrambled << 1 | (bit ^ (uint32_t)(words[0] & 1));
    }
    return scrambled;
}
