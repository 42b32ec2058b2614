#include "math/distributions.h"

#include <math.h>

double normal_cumulative(double z)
{
    return 0.5 * erfc(-z * 0.70710678118654752440);
}

// Ratio of two polynomials of degree 7, coefficients by ascending power; bottom[0] is 1.
static double ratio(const double top[8], const double bottom[8], double x)
{
    double p = top[7], q = bottom[7];
    for (int k = 6; k >= 0; k--) {
        p = p * x + top[k];
        q = q * x + bottom[k];
    }
    return p / q;
}

double normal_quantile(double p)
{
    static const double a[8] = {3.3871328727963666080, 133.14166789178437745, 1971.5909503065514427,
                                13731.693765509461125, 45921.953931549871457, 67265.770927008700853,
                                33430.575583588128105, 2509.0809287301226727};
    static const double b[8] = {1,
                                42.313330701600911252,
                                687.18700749205790830,
                                5394.1960214247511077,
                                21213.794301586595867,
                                39307.895800092710610,
                                28729.085735721942674,
                                5226.4952788528545610};
    static const double c[8] = {1.42343711074968357734,    4.63033784615654529590,
                                5.76949722146069140550,    3.64784832476320460504,
                                1.27045825245236838258,    0.241780725177450611770,
                                2.27238449892691845833e-2, 7.74545014278341407640e-4};
    static const double d[8] = {1,
                                2.05319162663775882187,
                                1.67638483018380384940,
                                0.689767334985100004550,
                                0.148103976427480074590,
                                1.51986665636164571966e-2,
                                5.47593808499534494600e-4,
                                1.05075007164441684324e-9};
    static const double e[8] = {6.65790464350110377720,    5.46378491116411436990,
                                1.78482653991729133580,    0.296560571828504891230,
                                2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                2.71155556874348757815e-5, 2.01033439929228813265e-7};
    static const double f[8] = {1,
                                0.599832206555887937690,
                                0.136929880922735805310,
                                1.48753612908506148525e-2,
                                7.86869131145613259100e-4,
                                1.84631831751005468180e-5,
                                1.42151175831644588870e-7,
                                2.04426310338993978564e-15};
    double q = p - 0.5;
    if (fabs(q) <= 0.425)
        return q * ratio(a, b, 0.180625 - q * q);
    double r = sqrt(-log(q < 0 ? p : 1 - p));
    double z = r <= 5 ? ratio(c, d, r - 1.6) : ratio(e, f, r - 5);
    return q < 0 ? -z : z;
}

// The continued fraction of I_x(a, b), which converges fast for x < (a + 1)/(a + b + 2).
static double beta_fraction(double a, double b, double x)
{
    const double tiny = 1e-300;
    double c = 1, d = 1 - (a + b) * x / (a + 1);
    d = 1 / (fabs(d) < tiny ? tiny : d);
    double h = d;
    for (int m = 1; m <= 10000; m++) {
        double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        double both[2] = {even, odd}, before = h;
        for (int k = 0; k < 2; k++) {
            d = 1 + both[k] * d;
            c = 1 + both[k] / c;
            d = 1 / (fabs(d) < tiny ? tiny : d);
            c = fabs(c) < tiny ? tiny : c;
            h *= c * d;
        }
        if (fabs(h - before) < 1e-16 * fabs(h))
            break;
    }
    return h;
}

double beta_cumulative(double a, double b, double x)
{
    if (!isfinite(a) || !isfinite(b) || isnan(x)) // on which the fraction would go to its last term
        return NAN;
    if (x <= 0 || x >= 1)
        return x > 0;
    int sign;
    double scale = lgamma_r(a + b, &sign) - lgamma_r(a, &sign) - lgamma_r(b, &sign);
    double front = exp(scale + a * log(x) + b * log1p(-x));
    if (x < (a + 1) / (a + b + 2))
        return front * beta_fraction(a, b, x) / a;
    return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

double student_beyond(double t, double freedom)
{
    return beta_cumulative(freedom / 2, 0.5, freedom / (freedom + t * t));
}

// P(T > t) for t >= 0.
static double student_tail(double t, double freedom)
{
    return 0.5 * student_beyond(t, freedom);
}

double student_quantile(double p, double freedom)
{
    double tail = p < 0.5 ? p : 1 - p, low = 0, high = 1;
    while (student_tail(high, freedom) > tail && high < 1e300)
        high *= 2;
    // by halving: needed a few times in a study, and safe
    for (int i = 0; i < 200 && high - low > 1e-15 * high; i++) {
        double middle = 0.5 * (low + high);
        if (student_tail(middle, freedom) > tail)
            low = middle;
        else
            high = middle;
    }
    return p < 0.5 ? -high : high;
}

double binomial_cumulative(long k, long n, double p)
{
    if (k < 0)
        return 0;
    return k >= n ? 1 : beta_cumulative((double)(n - k), (double)k + 1, 1 - p);
}
