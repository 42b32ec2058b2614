// Elementary functions over reals, each lane with the bits of one alone; errors: the test
// math.real_functions.
#ifndef LD_MATH_REAL_FUNCTIONS_H
#define LD_MATH_REAL_FUNCTIONS_H

#include "math/real.h"

#define NAME real_sine_cosine_near
#define NAME_WITHIN real_sine_cosine_within
#define NUMBER real
#define BITS real_bits
#define TO_BITS(x) real_to_bits(x)
#define FROM_BITS(x) real_from_bits(x)
#include "math/sine_cosine_text.h"

// A number as the sum of two, the second below half a unit of the first one's last place.
typedef struct real_pair {
    real high, low;
} real_pair;

// a + b, where |a| is not below |b|.
LD_INLINE real_pair real_sum(real a, real b)
{
    real sum = a + b;
    return (real_pair){sum, (a - sum) + b};
}

// The first 26 bits of a (Veltkamp), so that products of such halves are exact.
LD_INLINE real real_half(real a)
{
    real spread = a * 134217729.0;
    return spread - (spread - a);
}

// a b (Dekker, Numer. Math. 18, 1971).
LD_INLINE real_pair real_product(real a, real b)
{
    real product = a * b, a1 = real_half(a), b1 = real_half(b), a2 = a - a1, b2 = b - b1;
    return (real_pair){product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2};
}

// exp(x.high + x.low) as the sum of two times 2^n, n the low bits of `shifted`; |n| <= 1024.
LD_INLINE real_pair real_exp_parts(real_pair x, real *shifted)
{
    // x = n ln 2 + r + low, n ln 2 in two pieces of which the first is exact
    const double shift = 6755399441055744.0;
    *shifted = x.high * 1.44269504088896340736 + shift;
    real n = *shifted - shift;
    real rest = x.high - n * 6.93147180369123816490e-01;
    real_pair r = real_sum(rest, x.low - n * 1.90821492927058770002e-10);
    // Taylor polynomial of degree 13, |r| < 0.35, without its first two terms
    real y = r.high, z = y * y, w = z * z;
    real a = (1.0 / 2 + y * (1.0 / 6)) + z * (1.0 / 24 + y * (1.0 / 120));
    real b = (1.0 / 720 + y * (1.0 / 5040)) + z * (1.0 / 40320 + y * (1.0 / 362880));
    real c =
        (1.0 / 3628800 + y * (1.0 / 39916800)) + z * (1.0 / 479001600 + y * (1.0 / 6227020800.0));
    real_pair line = real_sum(real_all(1.0), y);
    return (real_pair){line.high, line.low + (r.low + z * (a + w * (b + w * c)))};
}

// exp(x.high + x.low), between 1e-300 and the largest number.
LD_INLINE real real_exp(real_pair x)
{
    real shifted;
    real_pair parts = real_exp_parts(x, &shifted);
    return real_from_bits(real_to_bits(parts.high + parts.low) + (real_to_bits(shifted) << 52));
}

// The bits of sqrt(1/2).
#define REAL_LEAST_MANTISSA 0x3fe6a09e667f3bcd

// m of a = 2^n m, a positive normal number, sqrt(1/2) <= m < sqrt(2).
LD_INLINE real real_mantissa(real a, real *n)
{
    const uint64_t one = 0x3ff0000000000000, least = REAL_LEAST_MANTISSA;
    const double shift = 4503599627370496.0; // 2^52
    real_bits bits = real_to_bits(a) + (one - least);
    *n = real_from_bits((bits >> 52) | real_to_bits(real_all(shift))) - (shift + 1023);
    return real_from_bits((bits & 0x000fffffffffffff) + least);
}

// log(a) of a positive normal number (Sun's fdlibm, e_log.c).
LD_INLINE real real_log(real a)
{
    real n, f = real_mantissa(a, &n) - 1.0;
    // log(1 + f) = f - f^2/2 + s (f^2/2 + R), s = f/(2 + f)
    real s = f / (2.0 + f), z = s * s, w = z * z, half = 0.5 * f * f;
    real even = w * (3.999999999940941908e-01 +
                     w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
    real odd = z * (6.666666666666735130e-01 +
                    w * (2.857142874366239149e-01 +
                         w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
    real low = s * (half + (odd + even)) + n * 1.90821492927058770002e-10;
    return n * 6.93147180369123816490e-01 - ((half - low) - f);
}

// The logarithm of (a/b)^y for positive a and b; of a/b between 2/3 and 3/2 the relative error is
// below 2^-56, beyond it grows slowly.
LD_INLINE real_pair real_log_power(real a, real b, real y)
{
    // s = (a - b)/(a + b) as a pair, log(a/b) = 2 s + 2/3 s^3 + 2/5 s^5 ...
    real_condition falls = a < b;
    real_pair sum = real_sum(real_select(falls, b, a), real_select(falls, a, b));
    real difference = a - b, inverse = 1.0 / sum.high, s = difference * inverse;
    real_pair product = real_product(s, sum.high);
    real s_low = (((difference - product.high) - product.low) - s * sum.low) * inverse;
    real z = s * s, w = z * z, v = w * w;
    real p = (2.0 / 3 + z * (2.0 / 5)) + w * (2.0 / 7 + z * (2.0 / 9));
    real q = (2.0 / 11 + z * (2.0 / 13)) + w * (2.0 / 15 + z * (2.0 / 17));
    real r = (2.0 / 19 + z * (2.0 / 21)) + w * (2.0 / 23);
    real_pair log_ratio = real_sum(2.0 * s, 2.0 * s_low + s * z * (p + v * (q + v * r)));
    real_pair power = real_product(y, log_ratio.high);
    return real_sum(power.high, power.low + y * log_ratio.low);
}

#endif
