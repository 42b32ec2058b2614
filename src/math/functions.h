// The elementary functions of <math.h> with the same bits on every processor: plain sums, products,
// quotients and roots of doubles, where the C library chooses its own variants (fused operations)
// at run time. Who calls one of them includes this; check.symbols finds calls of the library's.
// What is exact (sqrt, floor, remainder, ldexp, ...) stays the library's. Errors: the
// test math.functions.
#ifndef LD_MATH_FUNCTIONS_H
#define LD_MATH_FUNCTIONS_H

#include <math.h>

#define sin(x) portable_sin(x)
#define cos(x) portable_cos(x)
#define sincos(x, sine, cosine) portable_sincos(x, sine, cosine)
#define asin(x) portable_asin(x)
#define acos(x) portable_acos(x)
#define atan(x) portable_atan2(x, 1)
#define atan2(y, x) portable_atan2(y, x)
#define hypot(x, y) portable_hypot(x, y)
#define exp(x) portable_exp(x)
#define expm1(x) portable_expm1(x)
#define log(x) portable_log(x)
#define log10(x) portable_log10(x)
#define log1p(x) portable_log1p(x)
#define pow(x, y) portable_pow(x, y)

#define LD_OF_ITS_ARGUMENTS __attribute__((const))

LD_OF_ITS_ARGUMENTS double portable_sin(double x);
LD_OF_ITS_ARGUMENTS double portable_cos(double x);
LD_OF_ITS_ARGUMENTS double portable_asin(double x);
LD_OF_ITS_ARGUMENTS double portable_acos(double x);
LD_OF_ITS_ARGUMENTS double portable_atan2(double y, double x);
LD_OF_ITS_ARGUMENTS double portable_hypot(double x, double y);
LD_OF_ITS_ARGUMENTS double portable_exp(double x);
LD_OF_ITS_ARGUMENTS double portable_expm1(double x);
LD_OF_ITS_ARGUMENTS double portable_log(double x);
LD_OF_ITS_ARGUMENTS double portable_log10(double x);
LD_OF_ITS_ARGUMENTS double portable_log1p(double x);
LD_OF_ITS_ARGUMENTS double portable_pow(double x, double y);

// The two of one angle cost as much as one of them.
void portable_sincos(double x, double *sine, double *cosine);

#endif
