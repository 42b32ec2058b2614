// Barrowman's formulas against closed volumes, slender-body theory, strips summed, limits, and the
// figures that RocketPy prints of rockets in its documentation.
#include "support/check.h"

#include "elements/air/barrowman.h"

static const double pi = 3.14159265358979323846;

// Slope, place, area from the side and its centre of noses on their base's area.
static void test_noses(void **state)
{
    (void)state;
    const double L = 0.7, R = 0.1, A = pi * R * R;
    double rho = (R * R + L * L) / (2 * R);
    double ogive =
        pi * (L * rho * rho - L * L * L / 3 - (rho - R) * rho * rho * asin(L / rho)) / (A * L);
    // of the circle's segment under the chord, less the strip under it
    double half = L, sagitta = rho - R;
    double ogive_side =
        rho * rho * asin(half / rho) + half * sqrt(rho * rho - half * half) - 2 * half * sagitta;
    const struct {
        ld_nose_shape shape;
        double volume, side, side_center;
    } known[] = {
        {LD_NOSE_CONE, 1.0 / 3, L * R, 2 * L / 3},
        {LD_NOSE_OGIVE, ogive, ogive_side, NAN},
        {LD_NOSE_VON_KARMAN, 0.5, NAN, NAN},
        {LD_NOSE_HAACK, 9.0 / 16, NAN, NAN},
        {LD_NOSE_ELLIPSOID, 2.0 / 3, pi * L * R / 2, L - 4 * L / (3 * pi)},
        {LD_NOSE_PARABOLOID, 0.5, 4 * L * R / 3, 3 * L / 5},
    };
    double slope = 0, center = 0, side = 0, side_center = 0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        barrowman_body nose = barrowman_nose(known[i].shape, L, R, A);
        slope = fmax(slope, fabs(nose.slope - 2));
        center = fmax(center, fabs(nose.center / L - (1 - known[i].volume)));
        if (!isnan(known[i].side))
            side = fmax(side, fabs(nose.side / known[i].side - 1));
        if (!isnan(known[i].side_center))
            side_center = fmax(side_center, fabs(nose.side_center / known[i].side_center - 1));
    }
    CHECK_BELOW("slope", slope, 1e-14);
    CHECK_BELOW("place over length", center, 3e-9);
    CHECK_BELOW("area from the side, relative", side, 3e-9);
    CHECK_BELOW("its centre, relative", side_center, 3e-9);
    // on half the area twice the slope
    CHECK_NEAR("slope on another area", barrowman_nose(LD_NOSE_CONE, L, R, A / 2).slope, 4, 1e-14);
}

// Slender-body theory by the volume of the frustum; Barrowman's form of the place; a cone, a
// cylinder.
static void test_tails(void **state)
{
    (void)state;
    const double S = 0.02, L = 0.3;
    const double radius[][2] = {{0.08, 0.05}, {0.05, 0.08}, {0.07, 0.01}, {0, 0.06}};
    double slope = 0, center = 0, printed = 0, side_center = 0;
    for (size_t i = 0; i < sizeof radius / sizeof *radius; i++) {
        double a = radius[i][0], b = radius[i][1];
        barrowman_body tail = barrowman_tail(a, b, L, S);
        double volume = pi * L * (a * a + a * b + b * b) / 3, rear = pi * b * b;
        double change = rear - pi * a * a, ratio = a / b;
        slope = fmax(slope, fabs(tail.slope - 2 * change / S));
        center = fmax(center, fabs(tail.center - (L * rear - volume) / change));
        printed =
            fmax(printed, fabs(tail.center - L / 3 * (1 + (1 - ratio) / (1 - ratio * ratio))));
        // of the trapezium
        side_center = fmax(side_center, fabs(tail.side_center - L / 3 * (a + 2 * b) / (a + b)));
        CHECK_NEAR("area from the side [m2]", tail.side, L * (a + b), 1e-16);
    }
    CHECK_BELOW("slope", slope, 3e-15);
    CHECK_BELOW("place by slender-body theory [m]", center, 3e-16);
    CHECK_BELOW("place as Barrowman writes it [m]", printed, 3e-16);
    CHECK_BELOW("centre of the area from the side [m]", side_center, 1e-16);
    barrowman_body cylinder = barrowman_tail(0.05, 0.05, L, S);
    CHECK_NEAR("slope of a cylinder", cylinder.slope, 0, 0);
    CHECK_NEAR("its middle [m]", cylinder.side_center, L / 2, 3e-17);
}

static const ld_air_surface swept = {.count = 4,
                                     .root_chord = 0.3,
                                     .tip_chord = 0.1,
                                     .span = 0.15,
                                     .sweep_length = 0.25,
                                     .radius = 0.06,
                                     .cant = 0.01};

// As Barrowman wrote the slope in 1966 for Mach 0, with the line through the middles of the chords;
// places and moments by strips.
static void test_fins(void **state)
{
    (void)state;
    const ld_air_surface *f = &swept;
    const double d = 0.12, S = pi * d * d / 4, s = f->span, r = f->radius;
    barrowman_fins fins = barrowman_fins_of(f, S, d);
    double slope0, one = barrowman_fin(fins.aspect, 0, 0, &slope0);
    double line = hypot(s, f->sweep_length + 0.5 * (f->tip_chord - f->root_chord));
    double sum = f->root_chord + f->tip_chord;
    double bare = 4 * f->count * pow(s / d, 2) / (1 + sqrt(1 + pow(2 * line / sum, 2)));
    CHECK_NEAR("slope at Mach 0, relative", fins.slope * one / (bare * (1 + r / (s + r))), 1,
               1e-14);
    // strips: quarter chord weighted by chord; chord times distance from the axis and its square
    enum { STRIPS = 20000 };
    double area = 0, quarter = 0, first = 0, second = 0;
    for (int i = 0; i < STRIPS; i++) {
        double y = s * (i + 0.5) / STRIPS, width = s / STRIPS;
        double chord = f->root_chord + (f->tip_chord - f->root_chord) * y / s;
        area += chord * width;
        quarter += chord * width * (f->sweep_length * y / s + chord / 4);
        first += chord * width * (y + r);
        second += chord * width * (y + r) * (y + r);
    }
    CHECK_NEAR("place [m]", fins.center, quarter / area, 1e-10);
    // without the body's part, which grows small as the body does
    ld_air_surface thin = *f;
    thin.radius = 1e-7;
    barrowman_fins alone = barrowman_fins_of(&thin, S, d);
    double one_fin = alone.slope * 2 / f->count; // slope of one, but for `one`
    double reach = first / area - r, square = second / area - 2 * r * reach - r * r;
    CHECK_NEAR("forcing of a thin body, relative", alone.forcing / (f->count * one_fin * reach / d),
               1, 2e-6);
    CHECK_NEAR("damping of a thin body, relative",
               -alone.damping / (2 * f->count * one_fin * square / (d * d)), 1, 2e-6);
}

// What body and fins add to each other's roll, for the fins of Calisto: the factors that RocketPy
// 1.12 computes.
static void test_roll_interference(void **state)
{
    (void)state;
    const ld_air_surface f = {.count = 4,
                              .root_chord = 0.12,
                              .tip_chord = 0.04,
                              .span = 0.1,
                              .sweep_length = 0.08,
                              .radius = 0.0635};
    const double d = 0.127, S = pi * d * d / 4, area = 0.008, r = f.radius;
    double one = 2 * pi * (2 * 0.01 / area) * area / S;
    double reach = 0.1 / 3 * 0.2 / 0.16 + r, strips = 0;
    for (int i = 0; i < 1000; i++) {
        double y = 0.1 * (i + 0.5) / 1000;
        strips += (0.12 - 0.8 * y) * (y + r) * (y + r) * 1e-4;
    }
    barrowman_fins fins = barrowman_fins_of(&f, S, d);
    CHECK_NEAR("of forcing", fins.forcing / (4 * one * reach / d), 0.9349430000780612, 1e-14);
    CHECK_NEAR("of damping", fins.damping / (-2 * 4 * one / area * strips / (d * d)),
               1.2704014666093202, 1e-6);
}

// Over the Mach number: Prandtl and Glauert's factor, the same until Ackeret's is, and that; the
// derivative by differences.
static void test_mach(void **state)
{
    (void)state;
    const double aspect = 1.7, h = 1e-6;
    const double mach[] = {0, 0.3, 0.799, 0.81, 1.1, 1.17, 2, 5};
    const double beta[] = {
        1, sqrt(0.91), sqrt(1 - 0.799 * 0.799), 0.6, 0.6, sqrt(1.17 * 1.17 - 1), sqrt(3), sqrt(24)};
    double value = 0, slope = 0, here, unused;
    for (int i = 0; i < 8; i++) {
        double x = beta[i] * aspect, M = mach[i];
        double known = 1 / (2 + sqrt(4 + x * x));
        value = fmax(value, fabs(barrowman_fin(aspect, M, M, &here) - known));
        double before = barrowman_fin(aspect, M - h, M - h, &unused);
        double after = barrowman_fin(aspect, M + h, M + h, &unused);
        slope = fmax(slope, fabs(here - (after - before) / (2 * h)));
    }
    CHECK_BELOW("value", value, 1e-16);
    CHECK_BELOW("derivative", slope, 1e-9);
    // at the corners the derivative is that of the side asked for
    barrowman_fin(aspect, BARROWMAN_SUBSONIC, 0.5, &here);
    assert_true(here > 0.05);
    barrowman_fin(aspect, BARROWMAN_SUBSONIC, 1, &here);
    assert_true(here == 0);
    barrowman_fin(aspect, BARROWMAN_SUPERSONIC, 2, &here);
    assert_true(here < -0.05);
}

// Fins of more than four disturb each other (Niskanen): factors over n/2.
static void test_many_fins(void **state)
{
    (void)state;
    const double together[] = {1.5, 2, 2.37, 2.739, 2.989, 3.24};
    ld_air_surface fins = swept;
    fins.count = 4;
    double four = barrowman_fins_of(&fins, 0.01, 0.1).slope;
    for (int n = 3; n <= 8; n++) {
        fins.count = n;
        CHECK_NEAR("slope over that of four", barrowman_fins_of(&fins, 0.01, 0.1).slope / four,
                   together[n - 3] / 2, 1e-14);
    }
}

typedef struct printed_rocket {
    const char *name;
    double radius;                // [m] of reference
    double front, rear, length;   // [m] of the tail; 0: none
    ld_air_surface fins;          // at: their position
    double tail_slope, fin_slope; // printed
    double tail_at, fin_at;       // printed, behind the front ends [m]
} printed_rocket;

// Three rockets of RocketPy's documentation (docs/examples: Andromeda, NDRT 2020, SEB), which
// prints slopes and places at Mach 0 to three digits.
static void test_printed(void **state)
{
    (void)state;
    const double sweep = 0.165 * tan(13 * pi / 180);
    const printed_rocket rocket[] = {
        {"Andromeda",
         0.07535,
         0,
         0,
         0,
         {.count = 3,
          .root_chord = 0.23,
          .tip_chord = 0.11,
          .span = 0.185,
          .sweep_length = 0.12,
          .radius = 0.07535},
         0,
         9.255,
         0,
         0.3546 - 0.257},
        {"NDRT 2020",
         0.1015,
         0.1015,
         0.0775,
         0.127,
         {.count = 4,
          .root_chord = 0.152,
          .tip_chord = 0.0762,
          .span = 0.165,
          .sweep_length = sweep,
          .radius = 0.0775},
         -0.834,
         5.057,
         1.261 - 1.2,
         3.097 - 3.05},
        {"SEB",
         0.098,
         0.098,
         0.058,
         0.198,
         {.count = 4,
          .root_chord = 0.355,
          .tip_chord = 0.0803,
          .span = 0.156,
          .sweep_length = 0.355 - 0.0803,
          .radius = 0.098},
         -1.299,
         5.895,
         5.583 - (5.69 - 0.198),
         5.420 - 5.25},
    };
    for (int i = 0; i < 3; i++) {
        const printed_rocket *r = &rocket[i];
        double S = pi * r->radius * r->radius, derivative;
        barrowman_fins fins = barrowman_fins_of(&r->fins, S, 2 * r->radius);
        printf("%s\n", r->name);
        CHECK_NEAR("slope of the fins", fins.slope * barrowman_fin(fins.aspect, 0, 0, &derivative),
                   r->fin_slope, 5e-4);
        CHECK_NEAR("place of the fins [m]", fins.center, r->fin_at, 6e-4);
        if (r->length == 0)
            continue;
        barrowman_body tail = barrowman_tail(r->front, r->rear, r->length, S);
        CHECK_NEAR("slope of the tail", tail.slope, r->tail_slope, 5e-4);
        CHECK_NEAR("place of the tail [m]", tail.center, r->tail_at, 6e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_noses),
        cmocka_unit_test(test_tails),
        cmocka_unit_test(test_fins),
        cmocka_unit_test(test_mach),
        cmocka_unit_test(test_roll_interference),
        cmocka_unit_test(test_many_fins),
        cmocka_unit_test(test_printed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
