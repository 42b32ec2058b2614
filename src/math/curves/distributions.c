#include "math/curves/distributions.h"

#include "math/functions.h"

// exp(x^2) erfc(x), x >= 0: (1 + 2 x) times it by Chebyshev polynomials of (x - 3.5)/(x + 3.5),
// which miss it by 6e-18 of itself.
static double scaled_complementary_error(double x)
{
    static const double of[] = {
        1.177632731636124,       -0.001630177283414629,   -0.08733682573463146,
        0.05800974837029327,     -0.024340115396182225,   0.007529483715635749,
        -0.0017438817577112521,  0.00028269829816555584,  -2.3184911611263497e-05,
        -2.1117666981330388e-06, 8.765760156892854e-07,   -6.105702635085708e-08,
        -1.7116664716337122e-08, 3.3913602686165085e-09,  2.5466161937149624e-10,
        -1.248278407897757e-10,  -2.2122757702794086e-12, 4.42726036831932e-12,
        -3.3672657568436285e-14, -1.6519255726035125e-13, 1.902411958563131e-15,
        6.6011884178594e-15,     2.880211002013317e-17,   -2.7791896981140616e-16,
        -1.0767405876487464e-17, 1.1881281278755198e-17,  1.0887688040238229e-18};
    double t = (x - 3.5) / (x + 3.5), sum = 0, after = 0;
    for (int k = sizeof of / sizeof *of - 1; k > 0; k--) {
        double before = of[k] + 2 * t * sum - after;
        after = sum;
        sum = before;
    }
    return (of[0] + t * sum - after) / (1 + 2 * x);
}

double normal_cumulative(double z)
{
    double x = fabs(z) * 0.70710678118654752440;
    if (x > 30)
        return z > 0;
    double z1 = (float)z; // whose square is exact
    double tail = exp(-0.5 * z1 * z1) * exp(-0.5 * (z - z1) * (z + z1));
    double beyond = 0.5 * scaled_complementary_error(x) * tail;
    return z > 0 ? 1 - beyond : beyond;
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

// log Gamma(x), x > 0, to some 1e-15 or as much of itself: Stirling's series from 10 on, before it
// by Gamma(x + 1) = x Gamma(x).
static double log_gamma(double x)
{
    double product = 1;
    while (x < 10)
        product *= x++;
    double y = 1 / (x * x);
    double series =
        1.0 / 12 +
        y * (-1.0 / 360 +
             y * (1.0 / 1260 +
                  y * (-1.0 / 1680 + y * (1.0 / 1188 + y * (-691.0 / 360360 + y * (1.0 / 156))))));
    return (x - 0.5) * log(x) - x + 0.91893853320467274178 + series / x - log(product);
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
    double scale = log_gamma(a + b) - log_gamma(a) - log_gamma(b);
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

// The series of the lower incomplete gamma function, over x^a e^-x/Gamma(a + 1).
static double gamma_series(double a, double x)
{
    double term = 1, sum = 1;
    for (int k = 1; k <= 10000 && term > 1e-17 * sum; k++) {
        term *= x / (a + k);
        sum += term;
    }
    return sum;
}

// The continued fraction of the upper one, over x^a e^-x/Gamma(a) (Lentz).
static double gamma_fraction(double a, double x)
{
    const double tiny = 1e-300;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, h = d;
    for (int k = 1; k <= 10000; k++) {
        double step = -k * (k - a);
        b += 2;
        d = 1 / (fabs(step * d + b) < tiny ? tiny : step * d + b);
        c = b + step / c;
        c = fabs(c) < tiny ? tiny : c;
        h *= c * d;
        if (fabs(c * d - 1) < 1e-16)
            break;
    }
    return h;
}

double chi_square_beyond(double x, double freedom)
{
    if (isnan(x) || !isfinite(freedom))
        return NAN;
    if (x <= 0 || isinf(x))
        return x <= 0;
    double a = freedom / 2, half = x / 2;
    double front = exp(a * log(half) - half - log_gamma(a));
    return half < a + 1 ? 1 - front * gamma_series(a, half) / a : front * gamma_fraction(a, half);
}

double fisher_beyond(double x, double numerator_freedom, double denominator_freedom)
{
    double part = denominator_freedom / (denominator_freedom + numerator_freedom * fmax(x, 0));
    return beta_cumulative(denominator_freedom / 2, numerator_freedom / 2, part);
}

double binomial_cumulative(long k, long n, double p)
{
    if (k < 0)
        return 0;
    return k >= n ? 1 : beta_cumulative((double)(n - k), (double)k + 1, 1 - p);
}
