// A vehicle on a road of small sines: heave and pitch of the chassis, and the platform's pitch,
// against the transfer function of the linearised equations, (i omega - J)^-1 B.
// ctest: slow
#include "math/matrices/lapack.h"
#include "model/model.h"
#include <complex.h>
#include <stdlib.h>

#include "state/launch_state.h"
#include "state/linearise.h"
#include "support/check.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double two_pi = 6.283185307179586476925;
static const double speed = 15 / 3.6, amplitude = 1e-5;

// Heave [m] and pitch [rad] of the chassis, pitch [rad] of the stabilised platform, as factors of
// exp(i omega t).
typedef struct response {
    double complex heave, pitch, platform;
} response;

// ---- linear ----

// Where wheel j is at t = 0 [m].
static double place_of(const recorded_run *run, const ld_wheel *wheel)
{
    char name[LD_MAX_NAME + 16];
    size_t last = run->rows - 1;
    snprintf(name, sizeof name, "wheel.%s.x", wheel->name);
    return recorded_value(run, last, recorded_column(run, name)) -
           speed * recorded_value(run, last, 0);
}

// Rates of the wheels' vertical speeds under a road a sin(2 pi x/wavelength), wheel j at
// x_j + speed t: tyre force k h + c h' speed over the mass.
static void excite(const recorded_run *run, const ld_model *model, const linear_system *system,
                   double omega, double complex *b)
{
    const ld_vehicle *vehicle = &model->base.vehicle;
    const ld_tyre *tyre = &vehicle->tyre;
    int wheels_at = system->half + system->tube + system->rocket + 8;
    memset(b, 0, (size_t)system->count * sizeof *b);
    for (int j = 0; j < vehicle->wheel_count; j++) {
        double phase = omega / speed * place_of(run, &vehicle->wheel[j]);
        double complex h = -I * amplitude * cexp(I * phase);
        b[wheels_at + 3 * j + 1] =
            (tyre->stiffness[1] + I * omega * tyre->damping[1]) * h / vehicle->wheel[j].mass;
    }
}

static response linear_response(const recorded_run *run, const ld_model *model, double omega)
{
    linear_system system;
    ld_error error;
    launch_state launch;
    assert_int_equal(launch_state_begin(&launch, run->simulation, &error), LD_OK);
    assert_int_equal(simulation_linearise(&launch, false, false, &system, &error), LD_OK);
    launch_state_end(&launch);
    int n = system.count, chassis = system.tube + system.rocket;
    double complex *A = malloc((size_t)n * (size_t)n * sizeof *A),
                   *x = malloc((size_t)n * sizeof *x);
    lapack_int *pivot = malloc((size_t)n * sizeof *pivot);
    for (int i = 0; i < n * n; i++)
        A[i] = -system.J[i] + (i % (n + 1) == 0 ? I * omega : 0);
    excite(run, model, &system, omega, x);
    assert_int_equal(LAPACKE_zgesv(LAPACK_COL_MAJOR, n, 1, A, n, pivot, x, n), 0);
    // no roll and yaw at rest: rotations about z are pitch
    response found = {x[chassis + 1], x[chassis + 5], x[chassis + 5] + x[chassis + 7]};
    free(A);
    free(x);
    free(pivot);
    free(system.J);
    return found;
}

// ---- in the run ----

// Least squares of a column from t = 0 on by 1, t, cos(omega t), sin(omega t): factor of
// exp(i omega t).
static double complex fit(const recorded_run *run, const char *name, double omega)
{
    double A[16] = {0}, b[4] = {0};
    lapack_int pivot[4];
    size_t column = recorded_column(run, name);
    for (size_t i = 0; i < run->rows; i++) {
        double t = recorded_value(run, i, 0), value = recorded_value(run, i, column);
        if (t < 0)
            continue;
        double base[4] = {1, t, cos(omega * t), sin(omega * t)};
        for (int j = 0; j < 4; j++) {
            b[j] += base[j] * value;
            for (int k = 0; k < 4; k++)
                A[4 * j + k] += base[j] * base[k];
        }
    }
    assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, 4, 1, A, 4, pivot, b, 4), 0);
    return b[2] - I * b[3];
}

static void check_wavelength(double wavelength, double bound)
{
    ld_model model;
    recorded_run run;
    double omega = two_pi * speed / wavelength;
    reference_vehicle(&model, speed);
    model.base.vehicle.road.form = LD_ROAD_SUM;
    model.base.vehicle.road.sine_count = 1;
    model.base.vehicle.road.sine[0] = (ld_road_sine){amplitude, wavelength, 0};
    // what is not linear at small speeds
    model.platform.azimuth.friction.coulomb = model.platform.elevation.friction.coulomb = 0;
    model.rocket.contact.friction = 0;
    model.run.lead_in = 8;
    model.run.tolerance = 1e-9;
    model.run.end = LD_END_TIME;
    model.run.end_time = 0;
    model.firing[0].at = 2;
    recorded_run_make(&run, &model);
    response linear = linear_response(&run, &model, omega);
    response measured = {fit(&run, "chassis.y", omega), fit(&run, "chassis.pitch", omega),
                         fit(&run, "elevation.measured", omega)};
    printf(
        "  wavelength %.2f m, %.2f Hz: heave %.4f of the road at %.1f deg, pitch %.4f of its slope "
        "at %.1f deg, %.1f s of CPU\n",
        wavelength, omega / two_pi, cabs(linear.heave) / amplitude,
        360 / two_pi * carg(linear.heave), cabs(linear.pitch) / amplitude * speed / omega,
        360 / two_pi * carg(linear.pitch), run.summary.statistics.cpu_seconds);
    CHECK_BELOW("heave", cabs(measured.heave - linear.heave) / cabs(linear.heave), bound);
    CHECK_BELOW("pitch", cabs(measured.pitch - linear.pitch) / cabs(linear.pitch), bound);
    CHECK_BELOW("elevation platform",
                cabs(measured.platform - linear.platform) / cabs(linear.platform), bound);
    recorded_run_free(&run);
    reference_model_free(&model);
}

static void transfer_function(void **state)
{
    (void)state;
    check_wavelength(8, 2e-5);
    check_wavelength(2.7, 2e-5);
    check_wavelength(0.9, 2e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transfer_function),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
