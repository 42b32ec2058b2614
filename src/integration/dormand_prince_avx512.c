// Steps in 8 lanes.
#define LANES 8
#include "integration/dormand_prince_code.h"

void dormand_prince_try_avx512(double *block, int count, dormand_prince_slopes *f, void *self)
{
    try_steps(block, count, DORMAND_PRINCE_FEW, f, self);
}
