// Wind over reals (math/real.h), as environment/wind.h has it.
#ifndef LD_ENVIRONMENT_WIND_REAL_H
#define LD_ENVIRONMENT_WIND_REAL_H

#include "environment/wind.h"
#include "math/curves/curves_real.h"
#include "math/vectors/real_vec3.h"

// What a profile, its interval kept, adds to the steady wind at heights held within its rows.
LD_INLINE real3 wind_by_profile(real3 steady, real scale, const real *kept, real held)
{
    real level[WIND_FUNCTIONS];
    curves_kept_values(kept, held, WIND_FUNCTIONS, level);
    return real3_axpy(steady, scale, (real3){level[0], real_all(0), level[1]});
}

#endif
