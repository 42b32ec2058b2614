// Random numbers without a state: each is a function of its key alone, so drawing others, or in
// another order or thread, moves none (Salmon et al., Parallel random numbers: as easy as 1, 2, 3).
#ifndef LD_BASE_RANDOM_H
#define LD_BASE_RANDOM_H

#include <stdint.h>

// Four words of Philox4x64-10.
void random_block(const uint64_t key[2], const uint64_t counter[4], uint64_t words[4]);

// Number of a stream from its name: FNV-1a of its bytes.
uint64_t random_stream(const char *name);

// Uniform in (0, 1), an odd multiple of 2^-53, of the numbers i, j, k in a stream of a seed.
double random_uniform(uint64_t seed, uint64_t stream, uint64_t i, uint64_t j, uint64_t k);

#endif
