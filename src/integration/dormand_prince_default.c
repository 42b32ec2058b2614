// Steps of one integration.
#define LANES 1
#include "integration/dormand_prince_code.h"

void dormand_prince_try_default(double *block, int count, dormand_prince_slopes *f, void *self)
{
    if (count > DORMAND_PRINCE_FEW)
        try_steps(block, count, DORMAND_PRINCE_STATES, f, self);
    else
        try_steps(block, count, DORMAND_PRINCE_FEW, f, self);
}

void dormand_prince_stages(dormand_prince_numbers *step, int count, dormand_prince_slopes *f,
                           void *self)
{
    if (count > DORMAND_PRINCE_FEW)
        take_stages((double *)step, DORMAND_PRINCE_STATES, f, self);
    else
        take_stages((double *)step, DORMAND_PRINCE_FEW, f, self);
    step->evaluations += DORMAND_PRINCE_STAGES - 1;
}
