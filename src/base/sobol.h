// Points of Sobol's sequence and their scrambling.
#ifndef LD_BASE_SOBOL_H
#define LD_BASE_SOBOL_H

#include <stdint.h>

enum { SOBOL_DIMENSIONS = 256, SOBOL_DEGREE = 11, SOBOL_BITS = 32 };

// The numbers that make the sequence of one dimension.
typedef struct sobol_number {
    uint16_t polynomial;
    uint16_t m[SOBOL_DEGREE]; // as many as its degree
} sobol_number;

extern const sobol_number sobol_numbers[SOBOL_DIMENSIONS - 1]; // from the second dimension on

// Coordinate `dimension` (from 0) of point `index` (from 0) in the order of I. A. Antonov and V. M.
// Saleev (Gray codes): 32 bits behind the binary point. The first 2^m points are a net in base 2.
uint32_t sobol_point(int dimension, uint32_t index);

// The first `bits` of a coordinate, scrambled as by A. B. Owen (Randomly permuted (t, m, s)-nets,
// 1995): each bit is turned over or not by a random number that belongs to the bits before it, to
// the key and to the two numbers.
uint32_t sobol_scrambled(uint32_t coordinate, int bits, const uint64_t key[2], uint64_t first,
                         uint64_t second);

#endif
