// Steps in 8 lanes.
#define LANES 8
#include "simulation/dormand_prince_code.h"

void dormand_prince_try_avx512(double *block, int count, dormand_prince_slopes *f, void *self)
{
    take_stages(block, f, self);
    find_error(block, count);
}
