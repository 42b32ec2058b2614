// Uncertainties and verdicts after ASME V&V 20-2009: E = S - D is compared with
//   u_val^2 = u_num^2 + u_input^2 + u_D^2.
#ifndef LD_COMPARE_UNCERTAINTY_H
#define LD_COMPARE_UNCERTAINTY_H

#include "compare/comparison.h"

// Makes the further runs that the options ask for, and reads the study: u_num, u_input, and of the
// nominal run the results that its history does not hold.
ld_status uncertainty_find(ld_comparison *self, const char *folder,
                           const ld_compare_options *options, ld_error *error);

// Of sample i of sensor k; its verdict is not set.
ld_validation uncertainty_of_sample(const ld_comparison *self, int k, size_t i);

// Statistics of a series whose arrays are filled.
void uncertainty_of_series(const ld_comparison *self, int k, ld_compared_series *series);

// A result whole.
ld_status uncertainty_of_result(ld_comparison *self, int k, ld_compared_result *result,
                                ld_error *error);

#endif
