#include "elements/air/barrowman.h"

#include "math/functions.h"

#define PI 3.14159265358979323846

// ---- bodies of revolution

// Share of the volume of a nose in that of the cylinder around it, and of its area seen from the
// side in length times diameter, with the distance of that area's centre from the tip.
typedef struct nose_shares {
    double volume, side, side_center;
} nose_shares;

double barrowman_nose_radius(ld_nose_shape shape, double slenderness, double x)
{
    double angle = acos(1 - 2 * x), arc = 0.5 * (1 + slenderness * slenderness);
    double behind = slenderness * (1 - x);
    switch (shape) {
    case LD_NOSE_CONE:
        return x;
    case LD_NOSE_OGIVE: // a circle that is parallel to the axis at the base
        return sqrt(fmax(arc * arc - behind * behind, 0)) - arc + 1;
    case LD_NOSE_VON_KARMAN:
        return sqrt(fmax(angle - 0.5 * sin(2 * angle), 0) / PI);
    case LD_NOSE_HAACK:
        return sqrt(fmax(angle - 0.5 * sin(2 * angle) + pow(sin(angle), 3) / 3, 0) / PI);
    case LD_NOSE_ELLIPSOID:
        return sqrt(fmax(1 - (1 - x) * (1 - x), 0));
    default: // paraboloid
        return sqrt(x);
    }
}

// By Simpson's rule in x = sin^2(u), which takes the round ends of the shapes away.
static nose_shares nose_shares_of(ld_nose_shape shape, double slenderness)
{
    enum { STEPS = 200 };
    double sum[3] = {0};
    for (int i = 0; i <= STEPS; i++) {
        double u = 0.5 * PI * i / STEPS, x = pow(sin(u), 2);
        double weight = (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2) * sin(2 * u);
        double r = barrowman_nose_radius(shape, slenderness, x);
        sum[0] += weight * r * r;
        sum[1] += weight * r;
        sum[2] += weight * r * x;
    }
    double step = 0.5 * PI / STEPS / 3;
    return (nose_shares){step * sum[0], step * sum[1], sum[2] / sum[1]};
}

// The same; the last answer of each thread is kept, as the samples of a study share their noses.
static nose_shares last_nose_shares(ld_nose_shape shape, double slenderness)
{
    static _Thread_local struct {
        double slenderness; // 0: none is kept
        ld_nose_shape shape;
        nose_shares share;
    } last;
    if (slenderness != last.slenderness || shape != last.shape) {
        last.share = nose_shares_of(shape, slenderness);
        last.slenderness = slenderness;
        last.shape = shape;
    }
    return last.share;
}

// Slender-body theory: slope 2 (A_rear - A_front)/S at (l A_rear - V)/(A_rear - A_front) from the
// front end, V the volume (Barrowman 1966; 1967, chapter 3).
barrowman_body barrowman_nose(ld_nose_shape shape, double length, double radius, double area)
{
    nose_shares share = last_nose_shares(shape, length / radius);
    return (barrowman_body){.slope = 2 * PI * radius * radius / area,
                            .center = length * (1 - share.volume),
                            .side = 2 * radius * length * share.side,
                            .side_center = length * share.side_center};
}

// The same of a frustum, freed of the difference of its areas; a cylinder has slope 0.
barrowman_body barrowman_tail(double front_radius, double rear_radius, double length, double area)
{
    double sum = front_radius + rear_radius, difference = rear_radius - front_radius;
    double wide = sum > 0 ? (sum + rear_radius) / sum : 1.5;
    return (barrowman_body){.slope = 2 * PI * sum * difference / area,
                            .center = length * wide / 3,
                            .side = length * sum,
                            .side_center = length * wide / 3};
}

// ---- fins

// Share in which each of n fins counts: of more than four they disturb each other (S. Niskanen,
// Development of an open source model rocket simulation software, thesis, 2009, section 3.2.2).
static double fins_together(int n)
{
    static const double share[] = {0.948, 0.913, 0.854, 0.810}; // of 5 to 8
    return n < 5 ? 1 : share[n - 5];
}

// Of the roll moment of canted fins by the body between them (Barrowman 1967, appendix B), tau the
// radius at the tips over that of the body.
static double forcing_interference(double tau)
{
    double t2 = tau * tau, less = tau - 1, sum = t2 + 1;
    double arc = asin((t2 - 1) / sum), round = sum * sum / (t2 * less * less);
    double flat = (tau + 1) / (tau * less);
    return 0.25 * (tau + 1) * (tau + 1) / t2 +
           (round * arc * (PI + arc) - flat * (2 * PI + 4 * arc) +
            8 / (less * less) * log(sum / (2 * tau))) /
               (PI * PI);
}

// Likewise of the damping of fins with the taper lambda, tip chord over root chord.
static double damping_interference(double tau, double lambda)
{
    double above = (tau - lambda) / tau - (1 - lambda) / (tau - 1) * log(tau);
    double below =
        (tau + 1) * (tau - lambda) / 2 - (1 - lambda) * (tau * tau * tau - 1) / (3 * (tau - 1));
    return 1 + above / below;
}

barrowman_fins barrowman_fins_of(const ld_air_surface *fins, double area, double d)
{
    double a = fins->root_chord, b = fins->tip_chord, s = fins->span, r = fins->radius;
    double sweep = fins->sweep_length, fin_area = 0.5 * (a + b) * s, tau = (s + r) / r;
    // aspect ratio of the fin with its image, sweep of the line through the middles of the chords
    double ratio = 2 * s * s / fin_area, middle = sweep + 0.5 * (b - a);
    double aspect = ratio * hypot(s, middle) / s;
    // one fin: 2 pi AR (A_f/S)/(2 + sqrt(4 + (beta aspect)^2)), Barrowman 1967 after Diederich
    double one = 2 * PI * ratio * fin_area / area;
    // centre of a fin's area from the body, and integral of chord times square of the distance from
    // the axis: strips, each with the slope of the whole fin (Barrowman 1967, chapter 3)
    double across = s / 3 * (a + 2 * b) / (a + b);
    double strips = s / 12 * ((a + 3 * b) * s * s + 4 * (a + 2 * b) * s * r + 6 * (a + b) * r * r);
    return (barrowman_fins){
        .slope = (1 + r / (s + r)) * 0.5 * fins->count * fins_together(fins->count) * one,
        .forcing = forcing_interference(tau) * fins->count * one * (across + r) / d,
        .damping =
            -2 * damping_interference(tau, b / a) * fins->count * one / fin_area * strips / (d * d),
        .aspect = aspect,
        .center = sweep / 3 * (a + 2 * b) / (a + b) + (a + b - a * b / (a + b)) / 6,
    };
}

double barrowman_fin(double aspect, double mach, double towards, double *derivative)
{
    bool subsonic = 0.5 * (mach + towards) < BARROWMAN_SUBSONIC;
    bool supersonic = 0.5 * (mach + towards) > BARROWMAN_SUPERSONIC;
    double square = subsonic     ? 1 - mach * mach
                    : supersonic ? mach * mach - 1
                                 : 1 - BARROWMAN_SUBSONIC * BARROWMAN_SUBSONIC;
    double half_slope = subsonic ? -mach : supersonic ? mach : 0; // beta beta'
    double root = sqrt(4 + square * aspect * aspect), whole = 2 + root;
    *derivative = -aspect * aspect * half_slope / (root * whole * whole);
    return 1 / whole;
}
