// Sampled values of factors (model.md, section 10): functions of the study's seed, the factor's
// path, the number of the sample and that of the rocket, whatever else is sampled.
#ifndef LD_STUDIES_DRAW_H
#define LD_STUDIES_DRAW_H

#include <stdint.h>

#include "model/blocks/study.h"
#include "model/fields/field.h"

// The number in (0, 1) for run `sample` (from 1; of most plans a sample is one run) and rocket
// `rocket` (from 1; 0: of the sample), `factor` being one of scatter->factor. The first member of a
// correlated group has the number that it would have on its own.
double draw_uniform(const ld_scatter *scatter, const ld_factor *factor, int64_t sample, int rocket);

// What the factor's distribution makes of `u` in (0, 1); place and nominal value of the number.
double draw_value(const ld_factor *factor, const field_place *place, double nominal, double u);

// How many coordinates the plan's Sobol points have for so many rockets.
int draw_dimensions(const ld_scatter *scatter, int rockets);

// In which run of the trajectory `sample` (LD_PLAN_MORRIS) a factor, of so many, moves: from run 0
// to 1 or a later one. How far the factor with that path then goes, as a number in (0, 1).
int draw_turn(int seed, int factors, int64_t sample, int factor);
double draw_step(int seed, const char *path, int64_t sample);

// A permutation of 0 ... n - 1: where `i` goes, of the permutation with that key.
int64_t draw_permuted(const uint64_t key[2], uint64_t first, uint64_t second, int64_t n, int64_t i);

#endif
