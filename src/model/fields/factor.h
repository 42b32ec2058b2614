// Factors of a study: which numbers of a model they scatter, and whether they may.
#ifndef LD_MODEL_FACTOR_H
#define LD_MODEL_FACTOR_H

#include <stdbool.h>
#include <stddef.h>

#include "launchdyn/model.h"
#include "model/blocks/study.h"

// How many numbers a factor scatters, and the path of each.
int factor_numbers(const ld_factor *factor);
const char *factor_path(const ld_factor *factor, int number);
// Whether its numbers are there and the factor's distribution goes with them; false: `why` says why
// not.
bool factor_is_possible(const ld_model *model, const ld_factor *factor, char *why, size_t size);
// Whether the factors of a group can be correlated as it says; false: `why` says why not.
bool correlated_is_possible(const ld_scatter *scatter, const ld_correlated *group, char *why,
                            size_t size);
// Lower triangular factor L with L L' = matrix, both count x count by rows of LD_MAX_CORRELATED
// (Cholesky); false: the matrix is not positive definite.
bool correlated_factorise(const ld_correlated *group,
                          double lower[LD_MAX_CORRELATED][LD_MAX_CORRELATED]);
// Whether the rockets of one sample may differ in it.
bool factor_may_be_per_rocket(const ld_factor *factor);

#endif
