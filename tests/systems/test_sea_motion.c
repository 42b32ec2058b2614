// A ship in its sea: one wave against the base of sines, irregular seas against differences, the
// wave-by-wave sum and the spectrum; sides, headings, overtaken waves, the arm to the tube.
#include "model/model.h"
#include "systems/bases/sea_motion.h"

#include "environment/sea.h"
#include "support/check.h"
#include "systems/bases/base.h"

static const double PI = 3.14159265358979323846;

enum { COLUMNS = 13 };

// omega, then amplitude and phase of surge, sway, heave, roll, pitch, yaw.
static double beam[4 * COLUMNS] = {
    0.2, 0.9, -1.5, 0.3, 1.6, 1.0, 0.0,  0.010, 1.5, 0.004, 1.4, 0.001, 3.0, //
    0.6, 0.4, -1.7, 0.2, 1.4, 0.8, -0.3, 0.060, 0.1, 0.016, 1.2, 0.003, 2.9, //
    1.0, 0.1, -2.6, 0.1, 0.5, 0.2, -1.6, 0.004, -2., 0.003, 0.1, 0.001, 2.2, //
    1.6, 0.0, 0.00, 0.0, 0.0, 0.0, 0.00, 0.000, 0.0, 0.000, 0.0, 0.000, 0.0, //
};
static double head[2 * COLUMNS] = {
    0.1, 0.8, -1.2, 0.0, 0.0, 0.9, 0.2, 0.000, 0.0, 0.008, 1.1, 0.000, 0.0, //
    1.9, 0.3, -2.2, 0.0, 0.0, 0.3, 1.2, 0.000, 0.0, 0.002, 0.1, 0.000, 0.0, //
};

static ld_model ship(ld_sea_spectrum spectrum)
{
    ld_model model;
    model_init(&model);
    model.base.kind = LD_BASE_PRESCRIBED;
    model.run.lead_in = 2;
    model.run.stuck_time = 3;
    model.firing_count = 1;
    model.firing[0] = (ld_firing){1, 0};
    ld_sea *sea = &model.base.sea;
    sea->present = true;
    sea->spectrum = spectrum;
    sea->height = 3;
    sea->period = 9;
    sea->heading = 2;
    sea->response_count = 1;
    sea->response[0] = (ld_sea_response){NAN, {4, COLUMNS, beam}};
    return model;
}

typedef struct course {
    double x[6], u[6], a[6];
} course;

static course course_at(const sea_motion *motion, double t)
{
    course at = {0};
    sea_motion_add(motion, t, at.x, at.u, at.a);
    return at;
}

static sea_motion motion_of(const ld_model *model, double first, double last)
{
    sea_motion motion;
    assert_int_equal(sea_motion_build(&motion, model, first, last, NULL), LD_OK);
    return motion;
}

static base_frame frame_of(const base_system *base, double t)
{
    base_frame frame;
    base_found found;
    base->kind->find_frame(base, t, NULL, &frame, &found);
    return frame;
}

// Largest difference of two courses, [m], [rad] and over s, s^2.
static double apart(const course *a, const course *b)
{
    const double *p = a->x, *q = b->x;
    double most = 0;
    for (int i = 0; i < 18; i++)
        most = fmax(most, fabs(p[i] - q[i]));
    return most;
}

// ---- one wave ----

static void set_sine(ld_sines *sines, double amplitude, double frequency, double lead)
{
    // a cosine that leads
    sines->count = 1;
    sines->term[0] = (ld_sine){amplitude, frequency, lead + PI / 2};
}

static void test_one_wave_is_the_base_of_sines(void **state)
{
    (void)state;
    ld_model sea = ship(LD_SEA_REGULAR), sines;
    sea.base.velocity[0] = 6;
    sea.base.velocity[2] = -2;
    sea.base.sea.period = 2 * PI / 0.6; // the second row of its table
    sea.base.azimuth = 0.4;
    sea.base.at[1] = 5;
    sines = sea;
    sines.base.sea.present = false;
    double k = 0.36 / sea.gravity, met = 0.6 - k * (6 * cos(2) - 2 * sin(2)), f = met / (2 * PI);
    const double *row = beam + COLUMNS;
    set_sine(&sines.base.surge, 1.5 * row[1], f, row[2]);
    set_sine(&sines.base.sway, 1.5 * row[3], f, row[4]);
    set_sine(&sines.base.heave, 1.5 * row[5], f, row[6]);
    set_sine(&sines.base.roll, 1.5 * row[7], f, row[8]);
    set_sine(&sines.base.pitch, 1.5 * row[9], f, row[10]);
    set_sine(&sines.base.yaw, 1.5 * row[11], f, row[12]);
    base_system a, b;
    assert_int_equal(base_build(&a, &sea, NULL, NULL), LD_OK);
    assert_int_equal(base_build(&b, &sines, NULL, NULL), LD_OK);
    double error = 0;
    for (double t = -4; t < 6; t += 0.173) {
        base_frame p = frame_of(&a, t), q = frame_of(&b, t);
        error = fmax(error, v3_norm(v3_sub(p.r, q.r)));
        error = fmax(error, v3_norm(v3_sub(p.v, q.v)));
        error = fmax(error, v3_norm(v3_sub(p.a, q.a)));
        error = fmax(error, v3_norm(v3_sub(p.w, q.w)));
        error = fmax(error, v3_norm(v3_sub(p.alpha, q.alpha)));
        error =
            fmax(error,
                 v3_norm(v3_sub(m3_apply(p.A, v3_make(1, 2, 3)), m3_apply(q.A, v3_make(1, 2, 3)))));
    }
    CHECK_BELOW("frame, its rates and accelerations", error, 1e-14);
    base_free(&a);
    base_free(&b);
}

// A following wave that the ship overtakes: it leads in time as before, its crests come backwards.
static void test_overtaken_wave(void **state)
{
    (void)state;
    ld_model model = ship(LD_SEA_REGULAR);
    model.base.sea.period = 2 * PI / 0.6;
    model.base.sea.heading = 0;
    model.base.velocity[0] = 40;
    double met = 0.36 / model.gravity * 40 - 0.6, error = 0;
    assert_true(met > 0);
    sea_motion motion = motion_of(&model, -2, 3);
    for (double t = -2; t < 3; t += 0.1) {
        course at = course_at(&motion, t);
        error = fmax(error, fabs(at.x[1] - 1.5 * 0.8 * cos(met * t - 0.3)));
        error = fmax(error, fabs(at.x[4] - 1.5 * 0.016 * cos(met * t + 1.2)));
    }
    CHECK_BELOW("heave and pitch", error, 1e-14);
    sea_motion_free(&motion);
}

// ---- many waves ----

static void test_rates_are_derivatives(void **state)
{
    (void)state;
    ld_model model = ship(LD_SEA_JONSWAP);
    sea_motion motion = motion_of(&model, -2, 3);
    double error = 0, h = 1e-3;
    for (double t = -3; t < 4; t += 0.0837) {
        course at = course_at(&motion, t), before = course_at(&motion, t - h),
               after = course_at(&motion, t + h);
        for (int i = 0; i < 6; i++) {
            error = fmax(error, fabs((after.x[i] - before.x[i]) / (2 * h) - at.u[i]));
            error = fmax(error, fabs((after.u[i] - before.u[i]) / (2 * h) - at.a[i]));
        }
    }
    CHECK_BELOW("against central differences of 1 ms", error, 2e-7);
    sea_motion_free(&motion);
}

// Within its span it is a table of series, outside the waves themselves.
static void test_table_is_the_sum(void **state)
{
    (void)state;
    ld_model model = ship(LD_SEA_PIERSON_MOSKOWITZ);
    model.base.velocity[0] = 12;
    sea_motion table = motion_of(&model, -2, 30), sum = motion_of(&model, 1000, 1000);
    double error = 0;
    for (double t = -2; t < 30; t += 0.0137) {
        course a = course_at(&table, t), b = course_at(&sum, t);
        error = fmax(error, apart(&a, &b));
    }
    CHECK_BELOW("table against sum", error, 2e-14);
    for (size_t i = 1; i < table.cells; i++) {
        double t = table.from + (double)i * table.width;
        course a = course_at(&table, nextafter(t, -INFINITY)),
               b = course_at(&table, nextafter(t, INFINITY));
        error = fmax(error, apart(&a, &b));
    }
    CHECK_BELOW("and from cell to cell", error, 2e-14);
    sea_motion_free(&table);
    sea_motion_free(&sum);
}

// |H|^2 of heave (column 5) or roll (7) at omega, of the first table.
static double gain(int column, double omega)
{
    int i = omega < 0.6 ? 0 : omega < 1.0 ? 1 : 2;
    const double *p = beam + i * COLUMNS, *q = p + COLUMNS;
    double t = (omega - p[0]) / (q[0] - p[0]);
    double re = (1 - t) * p[column] * cos(p[column + 1]) + t * q[column] * cos(q[column + 1]);
    double im = (1 - t) * p[column] * sin(p[column + 1]) + t * q[column] * sin(q[column + 1]);
    return omega > 1.6 ? 0 : re * re + im * im;
}

// JONSWAP's shape over frequencies in those of the peak (Hasselmann et al., 1973), gamma as it is
// given.
static double shape(double gamma, double x)
{
    double s = x < 1 ? 0.07 : 0.09;
    return pow(x, -5) * exp(-1.25 * pow(x, -4)) * pow(gamma, exp(-pow((x - 1) / s, 2) / 2));
}

// Mean square over all waves of Hs^2/16 for the sea's height.
static double mean_square(const ld_sea *sea, int column)
{
    double sum = 0, all = 0, step = 5e-3, peak = 2 * PI / sea->period;
    for (double w = 0.5 * peak + step / 2; w < 10 * peak; w += step) {
        double power = shape(sea->peakedness, w / peak);
        all += power;
        sum += power * gain(column, w);
    }
    return sea->height * sea->height / 16 * sum / all;
}

static void test_mean_squares_over_seeds(void **state)
{
    (void)state;
    enum { SEEDS = 1000 };
    ld_model model = ship(LD_SEA_JONSWAP);
    double heave = 0, roll = 0;
    model.base.sea.waves = 60;
    for (int seed = 0; seed < SEEDS; seed++) {
        model.base.sea.seed = seed;
        sea_motion motion = motion_of(&model, 0, 0);
        course at = course_at(&motion, 50);
        heave += at.x[1] * at.x[1] / SEEDS;
        roll += at.x[5] * at.x[5] / SEEDS;
        sea_motion_free(&motion);
    }
    double expected = mean_square(&model.base.sea, 5);
    CHECK_BELOW("heave's mean square over its standard error",
                (heave / expected - 1) * sqrt(SEEDS / 2.0), 1.96);
    expected = mean_square(&model.base.sea, 7);
    CHECK_BELOW("roll's mean square over its standard error",
                (roll / expected - 1) * sqrt(SEEDS / 2.0), 1.96);
}

// ---- headings ----

static void test_sides(void **state)
{
    (void)state;
    static const int turned[6] = {1, 1, -1, -1, 1, -1}; // x, y, z, yaw, pitch, roll
    ld_model model = ship(LD_SEA_JONSWAP);
    sea_motion right = motion_of(&model, 0, 1);
    model.base.sea.heading = 2 * PI - 2;
    sea_motion left = motion_of(&model, 0, 1);
    double error = 0;
    for (double t = 0; t < 1; t += 0.1) {
        course a = course_at(&right, t), b = course_at(&left, t);
        for (int i = 0; i < 6; i++)
            error = fmax(error, fabs(a.x[i] - turned[i] * b.x[i]));
    }
    CHECK_BELOW("waves from the other side", error, 1e-14);
    sea_motion_free(&right);
    sea_motion_free(&left);
}

// Between two responses, on each and beyond both.
static void test_between_headings(void **state)
{
    (void)state;
    static const double headings[] = {0.5, 1, 1.5, 3, 3.1}, share[] = {0, 0, 0.25, 1, 1};
    ld_model model = ship(LD_SEA_JONSWAP);
    ld_sea *sea = &model.base.sea;
    sea_motion one = motion_of(&model, 0, 1);
    sea->response[0].table = (ld_table){2, COLUMNS, head};
    sea_motion other = motion_of(&model, 0, 1);
    sea->response_count = 2;
    sea->response[0] = (ld_sea_response){1, {4, COLUMNS, beam}};
    sea->response[1] = (ld_sea_response){3, {2, COLUMNS, head}};
    for (int k = 0; k < 5; k++) {
        sea->heading = headings[k];
        sea_motion both = motion_of(&model, 0, 1);
        course a = course_at(&one, 0.7), b = course_at(&other, 0.7), c = course_at(&both, 0.7);
        double error = 0;
        for (int i = 0; i < 6; i++)
            error = fmax(error, fabs(c.x[i] - ((1 - share[k]) * a.x[i] + share[k] * b.x[i])));
        CHECK_BELOW("linear between headings", error, 1e-14);
        sea_motion_free(&both);
    }
    sea_motion_free(&one);
    sea_motion_free(&other);
}

// Below the first row as there, above the last nothing.
static void test_beyond_the_table(void **state)
{
    (void)state;
    ld_model model = ship(LD_SEA_REGULAR);
    model.base.sea.period = 2 * PI / 0.1;
    sea_motion slow = motion_of(&model, 0, 1);
    CHECK_BELOW("below: the first row", course_at(&slow, 0).x[1] - 1.5, 1e-15);
    model.base.sea.period = 2 * PI / 1.61;
    sea_motion quick = motion_of(&model, 0, 1);
    assert_int_equal(quick.count, 0);
    assert_true(course_at(&quick, 0).x[1] == 0);
    model.base.sea.response[0].table.rows = 1;
    model.base.sea.period = 2 * PI / 0.1;
    sea_motion row = motion_of(&model, 0, 1);
    CHECK_BELOW("a table of one row", course_at(&row, 0).x[1] - 1.5, 1e-15);
    sea_motion_free(&slow);
    sea_motion_free(&quick);
    sea_motion_free(&row);
}

// ---- the tube's place on the ship ----

// Its frame moves as the point of a rigid body, by differences.
static void test_arm(void **state)
{
    (void)state;
    ld_model model = ship(LD_SEA_JONSWAP), bare;
    model.base.sea.height = 12;
    model.base.azimuth = 0.7;
    model.base.elevation = 0.5;
    bare = model;
    bare.base.azimuth = bare.base.elevation = 0;
    model.base.at[0] = 30, model.base.at[1] = 6, model.base.at[2] = -4;
    base_system base, ship_alone;
    assert_int_equal(base_build(&base, &model, NULL, NULL), LD_OK);
    assert_int_equal(base_build(&ship_alone, &bare, NULL, NULL), LD_OK);
    double place = 0, rates = 0, h = 1e-3;
    for (double t = -1; t < 2; t += 0.11) {
        base_frame at = frame_of(&base, t), origin = frame_of(&ship_alone, t),
                   before = frame_of(&base, t - h), after = frame_of(&base, t + h);
        v3 arm = m3_apply(origin.A, v3_make(30, 6, -4));
        place = fmax(place, v3_norm(v3_sub(at.r, v3_add(origin.r, arm))));
        v3 v = v3_scale(0.5 / h, v3_sub(after.r, before.r));
        v3 a = v3_scale(0.5 / h, v3_sub(after.v, before.v));
        rates = fmax(rates, fmax(v3_norm(v3_sub(v, at.v)), v3_norm(v3_sub(a, at.a))));
    }
    CHECK_BELOW("place", place, 2e-14);
    CHECK_BELOW("velocity and acceleration against differences", rates, 1e-6);
    base_free(&base);
    base_free(&ship_alone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_wave_is_the_base_of_sines),
        cmocka_unit_test(test_overtaken_wave),
        cmocka_unit_test(test_rates_are_derivatives),
        cmocka_unit_test(test_table_is_the_sum),
        cmocka_unit_test(test_mean_squares_over_seeds),
        cmocka_unit_test(test_sides),
        cmocka_unit_test(test_between_headings),
        cmocka_unit_test(test_beyond_the_table),
        cmocka_unit_test(test_arm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
