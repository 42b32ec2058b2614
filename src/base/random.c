#include "base/random.h"

#include <Random123/philox.h>

void random_block(const uint64_t key[2], const uint64_t counter[4], uint64_t words[4])
{
    philox4x64_ctr_t c = {{counter[0], counter[1], counter[2], counter[3]}};
    philox4x64_key_t k = {{key[0], key[1]}};
    c = philox4x64(c, k);
    for (int i = 0; i < 4; i++)
        words[i] = c.v[i];
}

uint64_t random_stream(const char *name)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 0x100000001b3u;
    return hash;
}

double random_uniform(uint64_t seed, uint64_t stream, uint64_t i, uint64_t j, uint64_t k)
{
    uint64_t words[4];
    random_block((uint64_t[]){seed, stream}, (uint64_t[]){i, j, k, 0}, words);
    return ((double)(words[0] >> 12) + 0.5) * 0x1p-52;
}
