// Steps in 4 lanes.
#define LANES 4
#include "integration/dormand_prince_code.h"

void dormand_prince_try_avx2(double *block, int count, dormand_prince_slopes *f, void *self)
{
    try_steps(block, count, DORMAND_PRINCE_FEW, f, self);
}
