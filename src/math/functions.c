#include "math/functions.h"

#include <stdint.h>

#define LANES 1
#include "math/real_functions.h"

// ---- sine and cosine ----

__extension__ typedef unsigned __int128 wide;
__extension__ typedef __int128 signed_wide;

// The first 1216 bits of 2/pi, after 64 zeros.
static const uint64_t two_over_pi[] = {
    0,
    0xa2f9836e4e441529,
    0xfc2757d1f534ddc0,
    0xdb6295993c439041,
    0xfe5163abdebbc561,
    0xb7246e3a424dd2e0,
    0x06492eea09d1921c,
    0xfe1deb1cb129a73e,
    0xe88235f52ebb4484,
    0xe99c7026b45f7e41,
    0x3991d639835339f4,
    0x9c845f8bbdf9283b,
    0x1ff897ffde05980f,
    0xef2f118b5a0a6d1f,
    0x6d367ecf27cb09b7,
    0x4f463f669e5fea2d,
    0x7527bac7ebe5f17b,
    0x3d0739f78a5292ea,
    0x6bfb5fb11f8d5d08,
    0x56033046fc7b6bab,
};

// The 64 bits of the table from bit `at` on.
static uint64_t bits_from(int at)
{
    const uint64_t *word = two_over_pi + at / 64;
    return at % 64 ? word[0] << at % 64 | word[1] >> (64 - at % 64) : word[0];
}

// The angle in (-pi/4, pi/4) that a large one is, but for n pi/2 (Payne and Hanek, SIGNUM
// Newsletter 18, 1983). Bits of 2/pi that make multiples of four quarter turns are left out.
static real_pair reduce(double x, unsigned *n)
{
    int exponent;
    uint64_t m = (uint64_t)ldexp(frexp(fabs(x), &exponent), 53);
    int first = exponent - 53 + 62;
    wide low = (wide)m * bits_from(first + 128);
    wide middle = (wide)m * bits_from(first + 64) + (low >> 64);
    wide turns = ((wide)(m * bits_from(first)) << 64) + middle; // quarter turns times 2^126
    *n = (unsigned)((turns + ((wide)1 << 125)) >> 126);         // of 0 to 3
    signed_wide rest = (signed_wide)(turns << 2) >> 1; // the nearest multiple taken away; 2^-127
    double high = (double)rest, left = (double)(rest - (signed_wide)high);
    real_pair angle = real_product(high * 0x1p-127, 1.57079632679489661923);
    angle.low += high * 0x1p-127 * 6.12323399573676603587e-17;
    return real_sum(angle.high, angle.low + left * (0x1p-127 * 1.57079632679489661923));
}

void portable_sincos(double x, double *sine, double *cosine)
{
    if (fabs(x) < 0.78) { // the same bits sooner
        real_sine_cosine_within(x, 0, sine, cosine);
        return;
    }
    if (fabs(x) < 5e5) {
        real_sine_cosine_near(x, sine, cosine);
        return;
    }
    if (!isfinite(x)) {
        *sine = *cosine = x - x;
        return;
    }
    unsigned n;
    real_pair angle = reduce(x, &n);
    double s, c;
    real_sine_cosine_within(angle.high, angle.low, &s, &c);
    double turned = n & 1 ? c : s, across = n & 1 ? s : c;
    *sine = (n >= 2) == (x < 0) ? turned : -turned;
    *cosine = (n + 1) & 2 ? -across : across;
}

double portable_sin(double x)
{
    double sine, cosine;
    portable_sincos(x, &sine, &cosine);
    return sine;
}

double portable_cos(double x)
{
    double sine, cosine;
    portable_sincos(x, &sine, &cosine);
    return cosine;
}

// ---- angles ----

// 1 - atan(t)/t for |t| <= 7/16, of z = t^2 (Sun's fdlibm, s_atan.c).
static double arc_tangent_rest(double z)
{
    double w = z * z;
    double odd =
        z * (3.33333333333329318027e-01 +
             w * (1.42857142725034663711e-01 +
                  w * (9.09088713343650656196e-02 +
                       w * (6.66107313738753120669e-02 +
                            w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
    double even =
        w * (-1.99999999998764832476e-01 +
             w * (-1.11111104054623557880e-01 +
                  w * (-7.69187620504482999495e-02 +
                       w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
    return odd + even;
}

double portable_atan2(double y, double x)
{
    // from 0, 1/2 or 1 the tangent of the smaller angle beside an axis continues: t; the angles
    // from which it continues as sums of two, for |y| <= |x| and |y| > |x|, each to the right and
    // the left
    static const double start[2][2][3][2] = {
        {{{0, 0},
          {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
          {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}},
         {{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53},
          {0x1.56c6e7397f5aep+1, 0x1.660b64ece6f4bp-53},
          {0x1.2d97c7f3321d2p+1, 0x1.a79394c9e8a0ap-54}}},
        {{{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54},
          {0x1.1b6e192ebbe44p+0, 0x1.b1b466a88828ep-54},
          {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}},
         {{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54},
          {0x1.0468a8ace4df6p+1, 0x1.0620bf7406affp-55},
          {0x1.2d97c7f3321d2p+1, 0x1.a79394c9e8a0ap-54}}},
    };
    double a = fabs(x), b = fabs(y);
    bool steep = b > a, left = signbit(x);
    double far = steep ? b : a, near = steep ? a : b;
    if (!(far >= 0x1p-900 && far <= 0x1p1000)) { // which products would leave; 0, infinite, none
        if (isnan(x) || isnan(y))
            return x + y;
        if (isinf(far))
            near = isinf(near) ? 1 : 0, far = 1;
        else if (far == 0)
            far = 1;
        double scale = far > 1 ? 0x1p-200 : 0x1p200;
        far *= scale;
        near *= scale;
    }
    int step = near < 0.4375 * far ? 0 : near < 0.6875 * far ? 1 : 2;
    double tangent = 0.5 * step;
    double t = (near - tangent * far) / (far + tangent * near);
    double angle = t - t * arc_tangent_rest(t * t);
    const double *from = start[steep][left][step];
    angle = from[0] + (from[1] + (steep == left ? angle : -angle));
    return copysign(angle, y);
}

// (asin(s) - s)/s, of z = s^2 <= 1/4 (Sun's fdlibm, e_asin.c).
static double arc_sine_rest(double z)
{
    double p = 1.66666666666666657415e-01 +
               z * (-3.25565818622400915405e-01 +
                    z * (2.01212532134862925881e-01 +
                         z * (-4.00555345006794114027e-02 +
                              z * (7.91534994289814532176e-04 + z * 3.47933107596021167570e-05))));
    double q = 1 + z * (-2.40339491173441421878e+00 +
                        z * (2.02094576023350569471e+00 +
                             z * (-6.88283971605453293030e-01 + z * 7.70381505559019352791e-02)));
    return z * p / q;
}

static const double HALF_PI = 1.57079632679489661923, HALF_PI_REST = 6.12323399573676603587e-17;

// acos(x) for 1/2 <= x <= 1: 2 asin(s), s = sqrt((1 - x)/2).
static real_pair arc_cosine(double x)
{
    double z = 0.5 * (1 - x), s = sqrt(z);
    real_pair square = real_product(s, s);
    double rest = s > 0 ? ((z - square.high) - square.low) / (2 * s) : 0; // of the root
    return real_sum(2 * s, 2 * (rest + s * arc_sine_rest(z)));
}

double portable_asin(double x)
{
    double size = fabs(x);
    if (!(size >= 0.5))
        return x + x * arc_sine_rest(x * x);
    real_pair across = arc_cosine(size), rest = real_sum(HALF_PI, -across.high);
    return copysign(rest.high + (rest.low + (HALF_PI_REST - across.low)), x);
}

double portable_acos(double x)
{
    if (!(fabs(x) >= 0.5))
        return HALF_PI - (x - (HALF_PI_REST - x * arc_sine_rest(x * x)));
    real_pair across = arc_cosine(fabs(x));
    if (x > 0)
        return across.high + across.low;
    return 2 * HALF_PI - (across.high - (2 * HALF_PI_REST - across.low));
}

double portable_hypot(double x, double y)
{
    double a = fabs(x), b = fabs(y), most = a > b ? a : b;
    if (isinf(a) || isinf(b))
        return INFINITY;
    if (most > 0x1p510)
        return 0x1p600 * sqrt((a * 0x1p-600) * (a * 0x1p-600) + (b * 0x1p-600) * (b * 0x1p-600));
    if (most < 0x1p-450)
        return 0x1p-600 * sqrt((a * 0x1p600) * (a * 0x1p600) + (b * 0x1p600) * (b * 0x1p600));
    return sqrt(a * a + b * b);
}

// ---- exponentials ----

static const double LN2_HIGH = 6.93147180369123816490e-01, LN2_LOW = 1.90821492927058770002e-10;

// exp(x.high + x.low), whatever they are.
static double exp_of_pair(real_pair x)
{
    if (fabs(x.high) < 700)
        return real_exp(x);
    if (!(x.high > -746))
        return isnan(x.high) ? x.high : 0;
    if (x.high > 710)
        return INFINITY;
    // of what is smaller by 64 ln 2, which the last product rounds to what is infinite or not
    // normal
    double n = x.high > 0 ? 64 : -64;
    real_pair less = real_sum(x.high, -n * LN2_HIGH);
    return (n > 0 ? 0x1p64 : 0x1p-64) *
           real_exp((real_pair){less.high, less.low + (x.low - n * LN2_LOW)});
}

double portable_exp(double x)
{
    return exp_of_pair((real_pair){x, 0});
}

double portable_expm1(double x)
{
    if (fabs(x) < 0x1p-54)
        return x;
    if (x < -40)
        return -1;
    if (!(x <= 40))
        return portable_exp(x);
    double shifted;
    real_pair part = real_exp_parts((real_pair){x, 0}, &shifted);
    double scale = real_from_bits(real_to_bits(1) + (real_to_bits(shifted) << 52));
    double high = part.high * scale;
    real_pair sum = high > 1 ? real_sum(high, -1) : real_sum(-1, high);
    return sum.high + (sum.low + part.low * scale);
}

// ---- logarithms ----

// Of 32 pieces of [sqrt(1/2), sqrt(2)): 1/c in 9 bits, c near the middle, and log(c) as a sum, the
// first a multiple of 2^-42. In the piece with 1, c is 1.
static const struct {
    double inverse, high, low;
} pieces[32] = {
    {0x1.66p+0, -0x1.5767717456p-2, 0x1.64ead9524d7cap-44},
    {0x1.5ep+0, -0x1.404308686ap-2, -0x1.f8ef43049f7d3p-44},
    {0x1.57p+0, -0x1.2b9303ab8ap-2, 0x1.6db12d6bfb0a5p-45},
    {0x1.5p+0, -0x1.1675cababap-2, -0x1.8380e731f55c4p-44},
    {0x1.49p+0, -0x1.00e6c45ad5p-2, -0x1.cc68d52e01203p-50},
    {0x1.43p+0, -0x1.dc1bca0abep-3, -0x1.8fac1a628ccc6p-44},
    {0x1.3dp+0, -0x1.b5b519e8fcp-3, 0x1.4b722ec011f31p-44},
    {0x1.37p+0, -0x1.8e928de886p-3, -0x1.a8154b13d72d5p-44},
    {0x1.31p+0, -0x1.66acd4272ap-3, -0x1.aa1bdbfc6c785p-44},
    {0x1.2bp+0, -0x1.3dfc2b0eccp-3, -0x1.8a72a62b8c13fp-45},
    {0x1.26p+0, -0x1.1b72ad52f6p-3, -0x1.e80a41811a396p-45},
    {0x1.21p+0, -0x1.f0a30c0118p-4, 0x1.d599e83368e91p-44},
    {0x1.1cp+0, -0x1.a926d3a4acp-4, -0x1.563650bd22a9cp-44},
    {0x1.17p+0, -0x1.60658a9374p-4, -0x1.0c3b1dee9c4f8p-44},
    {0x1.12p+0, -0x1.16536eea38p-4, 0x1.47c5e768fa309p-46},
    {0x1.0ep+0, -0x1.b42dd71198p-5, 0x1.c827ae5d6704cp-46},
    {0x1.09p+0, -0x1.1b0d98924p-5, 0x1.3401e9ae889bbp-44},
    {0x1.05p+0, -0x1.3cea44347p-6, 0x1.6a2c432d6a40bp-44},
    {0x1p+0, 0, 0},
    {0x1.f4p-1, 0x1.8492528c9p-6, -0x1.aa0ba325a0c34p-45},
    {0x1.e5p-1, 0x1.bbcebfc69p-5, -0x1.7bf868c317c2ap-46},
    {0x1.d7p-1, 0x1.55e10050ep-4, 0x1.c1d740c53c72ep-47},
    {0x1.cap-1, 0x1.c885801bc4p-4, 0x1.646d1c65aacd3p-45},
    {0x1.bep-1, 0x1.1aa2b7e24p-3, -0x1.1ac38dde3b366p-44},
    {0x1.b2p-1, 0x1.527e5e4a1cp-3, -0x1.4e60b8d4b411dp-44},
    {0x1.a7p-1, 0x1.871213750ep-3, 0x1.328eb42f9af75p-44},
    {0x1.9cp-1, 0x1.bd087383bep-3, -0x1.d4bc4595412b6p-45},
    {0x1.92p-1, 0x1.ef5ade4ddp-3, -0x1.a211565bb8e11p-51},
    {0x1.88p-1, 0x1.1178e8227ep-2, 0x1.1ef78ce2d07f2p-44},
    {0x1.7fp-1, 0x1.2941afb187p-2, -0x1.210c2b730e28bp-44},
    {0x1.76p-1, 0x1.419b423d5fp-2, -0x1.ce379226de3ecp-44},
    {0x1.6ep-1, 0x1.57bf753c8dp-2, 0x1.fadedee5d40efp-46},
};

// log(a), 0 < a < infinity, with a relative error below 2^-62.
static real_pair log_as_pair(double a)
{
    bool normal = a >= 0x1p-1022;
    double n, m = real_mantissa(normal ? a : a * 0x1p54, &n);
    n -= normal ? 0 : 54;
    unsigned piece = (unsigned)((real_to_bits(m) - REAL_LEAST_MANTISSA) >> 47);
    double c = pieces[piece].inverse;
    // log(a) = n log(2) + log(c) + log(1 + x), x = m/c - 1 from exact products, |x| < 0.016
    double m1 = real_from_bits(real_to_bits(m) & ~(uint64_t)0x7ffffff);
    real_pair x = real_sum(m1 * c - 1, (m - m1) * c), square = real_product(x.high, x.high);
    double y = x.high, z = square.high;
    double p = (1.0 / 3 - y * (1.0 / 4)) + z * (1.0 / 5 - y * (1.0 / 6));
    double q = (1.0 / 7 - y * (1.0 / 8)) + z * (1.0 / 9 - y * (1.0 / 10));
    double r = 1.0 / 11 - y * (1.0 / 12);
    double third = y * z * (p + z * z * (q + z * z * r));
    real_pair line = real_sum(n * LN2_HIGH + pieces[piece].high, y);
    real_pair parabola = real_sum(line.high, -0.5 * z);
    double low = (x.low * (1 - y) - 0.5 * square.low) + (n * LN2_LOW + pieces[piece].low);
    return real_sum(parabola.high, (line.low + parabola.low) + (low + third));
}

static const double LARGEST = 0x1.fffffffffffffp1023;

// The logarithm of what is not positive, or not finite.
static double log_of_special(double x)
{
    if (x == 0)
        return -INFINITY;
    return x < 0 ? (double)NAN : x + x; // infinite, or not a number
}

double portable_log(double x)
{
    return x > 0 && x <= LARGEST ? log_as_pair(x).high : log_of_special(x);
}

double portable_log10(double x)
{
    if (!(x > 0 && x <= LARGEST))
        return log_of_special(x);
    const real_pair inverse = {4.34294481903251816668e-01, 1.09831965021676497e-17}; // 1/log(10)
    real_pair log = log_as_pair(x), product = real_product(log.high, inverse.high);
    return product.high + (product.low + (log.low * inverse.high + log.high * inverse.low));
}

double portable_log1p(double x)
{
    if (fabs(x) < 0x1p-54)
        return x;
    if (!(x > -1 && x <= LARGEST))
        return log_of_special(x == -1 ? 0 : x);
    real_pair sum = x < 1 ? real_sum(1, x) : real_sum(x, 1), log = log_as_pair(sum.high);
    return log.high + (log.low + sum.low / sum.high);
}

// ---- powers ----

double portable_pow(double x, double y)
{
    if (y == 0 || x == 1)
        return 1;
    if (isnan(x) || isnan(y))
        return x + y;
    double size = fabs(x), sign = 1;
    if (signbit(x)) {
        bool large = fabs(y) >= 0x1p53; // and even
        if (x < 0 && isfinite(x) && !large && (double)(int64_t)y != y)
            return NAN;
        sign = !large && (double)(int64_t)y == y && (int64_t)y % 2 != 0 ? -1 : 1;
    }
    if (size == 1)
        return sign;
    if (size == 0 || isinf(size) || isinf(y))
        return (size > 1) == (y > 0) ? sign * (double)INFINITY : sign * 0;
    real_pair log = log_as_pair(size);
    if (fabs(y * log.high) > 800)
        return (log.high > 0) == (y > 0) ? sign * (double)INFINITY : sign * 0;
    real_pair power = real_product(y, log.high);
    return sign * exp_of_pair(real_sum(power.high, power.low + y * log.low));
}
