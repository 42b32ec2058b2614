// Thrust as it is: side force and its noise, a nozzle that moves, a rise that is stretched and
// delayed, against closed forms, quadratures and tables written out.
#include "base/random.h"
#include "elements/side_noise.h"
#include "math/curves/spectrum.h"
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "support/dense_motor.h"
#include "support/flight_text.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

#define PI_LONG 3.14159265358979323846264338327950288L

static const double degree = 3.14159265358979323846 / 180;

// In empty space, the nozzle 1.3 m behind the mass centre; what is put in continues the motor.
#define IN_SPACE(motor)                                                                            \
    "launchdyn: 1\n"                                                                               \
    "environment: {atmosphere: none, gravity: 0 m/s2, ground: none}\n"                             \
    "rocket:\n"                                                                                    \
    "  {mass: 60 kg, center: 1.1 0 0 m, inertia: 2 24 24 kg.m2,\n"                                 \
    "   motor: {thrust: [[0 s, 3 kN], [0.4 s, 3 kN]], at: -0.2 0 0 m, " motor "}}\n"               \
    "flight: {point: center, position: 0 0 0 m, velocity: 0 0 0 m/s}\n"                            \
    "run: {end: 0.5 s, flight_tolerance: 1e-12}\n"

// Rates by the table's integral; the motion stays in one plane, its momentum by Simpson's rule.
static void test_side_force(void **state)
{
    (void)state;
    ld_model model = read_text(
        IN_SPACE("side_force: {force: [[0 s, 0 N, 0 N], [0.05 s, 120 N, -50 N], [0.2 s, -36 N, 15 "
                 "N], [0.3 s, 24 N, -10 N]], scale: 1.5, angle: 40 deg}"));
    ld_rocket_summary rocket = fly_model(&model);
    enum { STEPS = 4000 }; // each of 0.1 ms, so that rows are ends
    const double size = 1.5 * 130, direction = atan2(-50, 120) + 40 * degree;
    const double time[] = {0, 0.05, 0.2, 0.3, 0.4}, shape[] = {0, 1, -0.3, 0.2, 0.2};
    double w = 0, turn = 0, v[2] = {0}, h = 0.4 / STEPS;
    for (int i = 0; i < STEPS; i++) {
        int k = 3;
        while (k > 0 && (i + 0.5) * h < time[k])
            k--;
        double slope = (shape[k + 1] - shape[k]) / (time[k + 1] - time[k]) * size;
        double F = shape[k] * size + slope * (i * h - time[k]), J = -24 / 1.3;
        for (int n = 0; n < 3; n++) {
            double s = 0.5 * n * h, now = F + slope * s, weight = (n == 1 ? 4 : 1) * h / 6 / 60;
            double angle = turn + w * s + (F * s * s / 2 + slope * s * s * s / 6) / J;
            v[0] += weight * (3000 * cos(angle) - now * sin(angle));
            v[1] += weight * (3000 * sin(angle) + now * cos(angle));
        }
        turn += w * h + (F * h * h / 2 + slope * h * h * h / 6) / J;
        w += (F * h + slope * h * h / 2) / J;
    }
    CHECK_NEAR("rate about y [rad/s]", rocket.final.rate[1], -w * sin(direction), 2e-14);
    CHECK_NEAR("rate about z [rad/s]", rocket.final.rate[2], w * cos(direction), 2e-14);
    const double *u = rocket.final.center_velocity;
    CHECK_NEAR("velocity along x [m/s]", u[0], v[0], 3e-11);
    CHECK_NEAR("along y [m/s]", u[1], v[1] * cos(direction), 1e-10);
    CHECK_NEAR("along z [m/s]", u[2], v[1] * sin(direction), 1e-10);
    model_clear(&model);
}

// The nozzle turns evenly: the integral of eps/sqrt(1 + eps^2), eps = c t, is (sqrt(1 + c^2 t^2) -
// 1)/c. One that moves aside evenly: the integral of T z.
static void test_nozzle(void **state)
{
    (void)state;
    ld_model model =
        read_text(IN_SPACE("misalignment: 20 0 mrad, nozzle: [[0.1 s, -20 mrad, 0 rad, 0 m, 0 m], "
                           "[0.4 s, 0.28 rad, 0 rad, 0 m, 0 m]]"));
    ld_rocket_summary rocket = fly_model(&model);
    double M = 1.3 * 3000 / 24;
    CHECK_NEAR("nozzle that turns: rate about y [rad/s]", rocket.final.rate[1], 0, 1e-14);
    CHECK_NEAR("about z [rad/s]", rocket.final.rate[2], -M * (sqrt(1 + 0.09) - 1), 5e-14);
    model_clear(&model);
    model = read_text(IN_SPACE("nozzle: [[0 s, 0 rad, 0 rad, 0 m, 2 mm], [0.3 s, 0 rad, 0 rad, "
                               "0 m, -7 mm], [5 s, 0 rad, 0 rad, 0 m, 40 mm]]"));
    rocket = fly_model(&model);
    double way = -0.3 * 2.5e-3 + 0.1 * (-7e-3 + 0.5 * 0.1 / 4.7 * 47e-3);
    CHECK_NEAR("nozzle that moves: rate about y [rad/s]", rocket.final.rate[1], 3000 / 24.0 * way,
               1e-12);
    CHECK_NEAR("about z [rad/s]", rocket.final.rate[2], 0, 1e-14);
    model_clear(&model);
}

// ---- the motor's clock

// A flight of tables with times t [6], of which what is put in stands beside the thrust.
static ld_rocket_summary fly_times(const double *t, const char *more)
{
    char text[2000];
    snprintf(
        text, sizeof text,
        "launchdyn: 1\nenvironment: {atmosphere: none, ground: none}\n"
        "rocket:\n"
        "  {mass: 60 kg, center: 1.1 0 0 m, inertia: 2 24 24 kg.m2,\n"
        "   motor: {thrust: [[0 s, 0 kN], [%.17g s, 0 kN], [%.17g s, 2 kN], [%.17g s, 2.8 kN],\n"
        "      [%.17g s, 3 kN], [%.17g s, 0 kN]], %s\n"
        "     side_force: {force: [[%.17g s, 0 N, 0 N], [%.17g s, 90 N, 40 N],\n"
        "       [%.17g s, 5 N, 9 N]]},\n"
        "     nozzle: [[%.17g s, 0 rad, 0 rad, 0 m, 1 mm], [%.17g s, 4 mrad, 0 rad, 0 m, 0 m]],\n"
        "     masses: [[%.17g s, 20 kg, 0.8 m, 1 kg.m2, 3 kg.m2],\n"
        "       [%.17g s, 18 kg, 0.9 m, 0.9 kg.m2, 2.8 kg.m2],\n"
        "       [%.17g s, 10 kg, 0.7 m, 0.5 kg.m2, 2 kg.m2]]}}\n"
        "flight: {point: center, position: 0 0 0 m, velocity: 30 40 0 m/s, ignition: 0.1 s}\n"
        "run: {end: 1 s, flight_tolerance: 1e-12}\n",
        t[0], t[1], t[2], t[4], t[5], more, t[0], t[2], t[3], t[2], t[4], t[0], t[2], t[4]);
    ld_model model = read_text(text);
    ld_rocket_summary rocket = fly_model(&model);
    model_clear(&model);
    return rocket;
}

static void test_clock(void **state)
{
    (void)state;
    const double given[6] = {0, 0.02, 0.05, 0.13, 0.4, 0.45};
    double t[6];
    for (int i = 0; i < 6; i++) // the rise ends at the third row, of 93 %
        t[i] = 0.03 + 1.1 * (given[i] < 0.05 ? 1.7 * given[i] : given[i] + 0.7 * 0.05);
    ld_rocket_summary scaled = fly_times(given, "time_scale: 1.1, rise_scale: 1.7, delay: 30 ms,");
    ld_rocket_summary written = fly_times(t, "");
    for (int i = 0; i < 3; i++) {
        const ld_final_state *a = &scaled.final, *b = &written.final;
        CHECK_NEAR("velocity [m/s]", a->center_velocity[i], b->center_velocity[i], 3e-14);
        CHECK_NEAR("rate [rad/s]", a->rate[i], b->rate[i], 5e-15);
    }
}

// In a launch, with what the lock holds meanwhile.
static void test_clock_of_launch(void **state)
{
    (void)state;
    const double given[4] = {0, 0.01, 2.5, 2.55}, force[4] = {0, 15e3, 15e3, 0};
    ld_summary summary[2];
    for (int k = 0; k < 2; k++) {
        ld_model model;
        double t[5] = {0}, row[10] = {0}, side[9] = {0}, nozzle[10] = {0};
        reference_model(&model);
        model.run.tolerance = 1e-9;
        ld_motor *motor = &model.rocket.motor;
        if (k == 0) {
            motor->delay = 7e-3;
            motor->rise_scale = 1.6;
        }
        for (int i = 0; i < 4; i++) {
            t[i + 1] = k == 0 ? given[i] : 7e-3 + given[i] + (i ? 0.6 * 0.01 : 0);
            row[2 * i + 2] = t[i + 1];
            row[2 * i + 3] = force[i];
        }
        memcpy(side + 3, (double[]){t[2], 300, -100, t[2] + 0.1, 0, 50}, 6 * sizeof(double));
        side[0] = t[1];
        memcpy(nozzle, (double[]){t[2], 0, 0, 1e-3, 0, t[2] + 0.1, 2e-3, -1e-3, 0, 0},
               sizeof nozzle);
        free(motor->thrust.data);
        motor->thrust = reference_table(k == 0 ? 4 : 5, 2, k == 0 ? row + 2 : row);
        motor->side_force =
            (ld_side_force){.present = true, .scale = 1, .force = reference_table(3, 3, side)};
        motor->nozzle = reference_table(2, 5, nozzle);
        summary[k] = summary_of_run(&model);
        reference_model_free(&model);
    }
    const ld_rocket_summary *a = &summary[0].rocket[0], *b = &summary[1].rocket[0];
    CHECK_NEAR("release [s]", a->t_release, b->t_release, 1e-12);
    CHECK_NEAR("exit [s]", a->t_rear, b->t_rear, 1e-10);
    CHECK_NEAR("exit speed [m/s]", a->exit_speed, b->exit_speed, 2e-8);
    CHECK_NEAR("pitch rate [rad/s]", a->pitch_rate, b->pitch_rate, 1e-8);
    CHECK_NEAR("yaw rate [rad/s]", a->yaw_rate, b->yaw_rate, 1e-8);
}

// ---- noise

static const double spectrum_rows[] = {0.5, 1, 2, 4, 3, 0, 5, 2};

static ld_side_noise noise_of(ld_spectrum_form form, int seed, int harmonics)
{
    return (ld_side_noise){.present = true,
                           .form = form,
                           .corner = 0.7,
                           .spectrum = {4, 2, (double *)(uintptr_t)spectrum_rows},
                           .seed = seed,
                           .harmonics = harmonics};
}

// Share of the power below f.
static long double power_below(ld_spectrum_form form, long double f)
{
    if (form == LD_SPECTRUM_CORNER)
        return atanl(fminl(f / 0.7L, 10)) / atanl(10);
    long double sum[2] = {0};
    for (int i = 0; i < 3; i++) {
        const double *a = spectrum_rows + 2 * i;
        for (int all = 0; all < 2; all++) {
            long double to = all ? a[2] : fminl(fmaxl(f, a[0]), a[2]);
            long double last = a[1] + (a[3] - a[1]) * (to - a[0]) / (a[2] - a[0]);
            sum[all] += (a[1] + last) / 2 * (to - a[0]);
        }
    }
    return sum[0] / sum[1];
}

static double defined(const ld_side_noise *given, int place, int j, double t)
{
    long double sum = 0;
    for (int i = 0; i < given->harmonics; i++) {
        const uint64_t seed = (uint64_t)given->seed, key[] = {(uint64_t)place, (uint64_t)j};
        long double u = random_uniform(seed, random_stream("side_force.frequency"), key[0], key[1],
                                       (uint64_t)i);
        long double phase =
            random_uniform(seed, random_stream("side_force.phase"), key[0], key[1], (uint64_t)i);
        long double low = 0, high = 10;
        for (int n = 0; n < 80; n++) { // halved
            long double f = (low + high) / 2;
            if (power_below(given->form, f) < (i + u) / given->harmonics)
                low = f;
            else
                high = f;
        }
        sum += cosl(2 * PI_LONG * (low * t + phase));
    }
    return (double)(sum * sqrtl(2.0L / given->harmonics));
}

static void test_noise(void **state)
{
    (void)state;
    static const int harmonics[] = {100, 7};
    for (int n = 0; n < 4; n++) {
        ld_side_noise given = noise_of((ld_spectrum_form)(n % 2), 11, harmonics[n / 2]);
        side_noise self;
        double error = 0;
        assert_int_equal(side_noise_build(&self, &given, 3, NULL), LD_OK);
        for (int k = 0; k < 12; k++) {
            double t = -0.3 + 0.71 * k, x[2];
            side_noise_at(&self, t, x);
            for (int j = 0; j < 2; j++)
                error = fmax(error, fabs(x[j] - defined(&given, 3, j, t)));
        }
        side_noise_free(&self);
        CHECK_BELOW("noise against its definition", error, 2e-13);
    }
}

// Density in bands over many seeds, against the spectrum; variance and correlation at one instant.
static void test_spectrum(void **state)
{
    (void)state;
    enum { SEEDS = 100, SAMPLES = 1 << 11, BANDS = 6 };
    static double x[2][SAMPLES];
    static const double edge[2][BANDS + 1] = {{0.1, 0.3, 0.7, 1.4, 2.5, 4.5, 7},
                                              {0.6, 1, 1.5, 2, 2.5, 3.5, 4.9}};
    for (int form = 0; form < 2; form++) {
        double sum[2][BANDS] = {{0}}, worst = 0, square[3] = {0};
        for (int seed = 0; seed < SEEDS; seed++) {
            ld_side_noise given = noise_of((ld_spectrum_form)form, seed, 60);
            side_noise self;
            assert_int_equal(side_noise_build(&self, &given, 0, NULL), LD_OK);
            for (int i = 0; i < SAMPLES; i++) {
                double now[2];
                side_noise_at(&self, 0.06 * i, now);
                for (int j = 0; j < 2; j++)
                    x[j][i] = now[j];
                square[0] += now[0] * now[0] / (SEEDS * SAMPLES);
                square[1] += now[1] * now[1] / (SEEDS * SAMPLES);
                square[2] += now[0] * now[1] / (SEEDS * SAMPLES);
            }
            side_noise_free(&self);
            double density[2][BANDS];
            const spectrum_series series = {SAMPLES, 0.06, x[0], x[1]};
            const spectrum_bands bands = {BANDS, edge[form], density[0], density[1], NULL};
            assert_int_equal(spectrum_in_bands(&series, &bands, NULL), LD_OK);
            for (int i = 0; i < BANDS; i++)
                for (int j = 0; j < 2; j++)
                    sum[j][i] += density[j][i] / SEEDS;
        }
        for (int i = 0; i < BANDS; i++) {
            double from = edge[form][i], to = edge[form][i + 1];
            double power = (double)(power_below((ld_spectrum_form)form, to) -
                                    power_below((ld_spectrum_form)form, from));
            for (int j = 0; j < 2; j++)
                worst = fmax(worst, fabs(sum[j][i] * (to - from) / power - 1));
        }
        printf("  %s\n", form ? "by a table" : "by a corner");
        CHECK_BELOW("power in a band, relative", worst, 0.05);
        CHECK_BELOW("variance of y, less 1", square[0] - 1, 0.01);
        CHECK_BELOW("variance of z, less 1", square[1] - 1, 0.01);
        CHECK_BELOW("covariance", square[2], 0.01);
    }
}

// In a flight: rates by the integral of deviation times noise, in steps of 2 us.
static void test_noise_in_flight(void **state)
{
    (void)state;
    ld_model model = read_text(IN_SPACE("delay: 20 ms, side_force: {scale: 1.2, fluctuation: "
                                        "{deviation: [[0 s, 0 N], [5 ms, 200 N], "
                                        "[60 ms, 200 N], [80 ms, 0 N]], corner: 70 Hz, seed: 4}}"));
    ld_rocket_summary rocket = fly_model(&model);
    side_noise self;
    const ld_motor *motor = &model.rocket.motor;
    const ld_side_noise *given = &motor->side_force.noise;
    assert_int_equal(side_noise_build(&self, given, 0, NULL), LD_OK);
    double sum[2] = {0}, h = 4e-6;
    for (int i = 0; i < 20000; i++) {
        double t = 0.02 + (i + 0.5) * h, x[2], size;
        side_noise_at(&self, t, x);
        size = 1.2 * dense_motor_column(motor, &given->deviation, 1, t);
        for (int j = 0; j < 2; j++)
            sum[j] += h * size * x[j];
    }
    side_noise_free(&self);
    CHECK_NEAR("fluctuation: rate about y [rad/s]", rocket.final.rate[1], 1.3 / 24 * sum[1], 2e-8);
    CHECK_NEAR("about z [rad/s]", rocket.final.rate[2], -1.3 / 24 * sum[0], 2e-8);
    model_clear(&model);
}

// In a launch, at the usual tolerance and at one of 1e-9.
static void test_noise_in_launch(void **state)
{
    (void)state;
    double rate[2][2], size = 0, apart = 0;
    const double deviation[] = {0, 0, 0.005, 300, 0.3, 100};
    for (int k = 0; k < 2; k++) {
        ld_model model;
        reference_model(&model);
        model.rocket.motor.side_force = (ld_side_force){.present = true, .scale = 1};
        ld_side_noise *noise = &model.rocket.motor.side_force.noise;
        *noise = noise_of(LD_SPECTRUM_CORNER, 9, 100);
        noise->spectrum = (ld_table){0};
        noise->corner = 60;
        noise->deviation = reference_table(3, 2, deviation);
        if (k)
            model.run.tolerance = 1e-9;
        ld_summary summary = summary_of_run(&model);
        rate[k][0] = summary.rocket[0].pitch_rate;
        rate[k][1] = summary.rocket[0].yaw_rate;
        CHECK_BELOW("energy balance, relative", summary.energy.residual_relative, 5e-11);
        reference_model_free(&model);
    }
    for (int i = 0; i < 2; i++) {
        size = fmax(size, fabs(rate[1][i]));
        apart = fmax(apart, fabs(rate[1][i] - rate[0][i]));
    }
    CHECK_BELOW("rates at the exit, usual tolerance, relative", apart / size, 2e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_side_force),      cmocka_unit_test(test_nozzle),
        cmocka_unit_test(test_clock),           cmocka_unit_test(test_clock_of_launch),
        cmocka_unit_test(test_noise),           cmocka_unit_test(test_spectrum),
        cmocka_unit_test(test_noise_in_flight), cmocka_unit_test(test_noise_in_launch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
