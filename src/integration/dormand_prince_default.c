// Steps of one integration.
#define LANES 1
#include "integration/dormand_prince_code.h"

void dormand_prince_try_default(double *block, int count, dormand_prince_slopes *f, void *self)
{
    try_steps(block, count, f, self);
}

void dormand_prince_stages(dormand_prince_numbers *step, dormand_prince_slopes *f, void *self)
{
    take_stages((double *)step, f, self);
    step->evaluations += DORMAND_PRINCE_STAGES - 1;
}
