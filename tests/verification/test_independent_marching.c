// ctest: slow
// Whole launches from the vehicle against an independent program: support/dense_simulation.h with
// support/dense_vehicle.h, platforms as free bodies with multipliers, its own equilibrium and
// forces of wheels and stabilisers, classical Runge-Kutta steps of fixed size. Roads are
// deterministic. The program runs with its default tolerance; with a tighter one and half the step
// the two come closer on every count but one: where a wheel lands, the force of its tyre's damper
// begins with a jump, and a fixed step that crosses it is off by the step's length. Poles of the
// whole are compared too.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "quantities/summary.h"
#include "support/dense_simulation.h"
#include "support/reference_model.h"

typedef struct bounds {
    double place, speed, force;  // of the vehicle [m, rad], [m/s, rad/s], [N, N m]
    double instant;              // [s]
    double exit, attitude, rate; // of the rocket in I [m/s], [rad], [rad/s]
    double against;              // [m], [rad] of rocket in tube and of the tip
    double tip;                  // [m/s], [rad/s]
    double contact;              // [-]
} bounds;

typedef struct scenario {
    const char *name;
    void (*change)(ld_model *model);
    double speed; // [m/s]
    bounds bound;
} scenario;

static const double degree = 3.14159265358979323846 / 180;

// ---------------------------------------------------------------- scenarios

static void waves_and_a_bump(ld_model *model)
{
    ld_road *profile = &model->base.vehicle.road;
    profile->form = LD_ROAD_SUM;
    profile->sine_count = 2;
    profile->sine[0] = (ld_road_sine){0.010, 3, 0.4};
    profile->sine[1] = (ld_road_sine){0.002, 0.7, 1};
    profile->bump_count = 1;
    profile->bump[0] = (ld_bump){1.5, 1, 0.03, LD_TRACK_LEFT};
}

// Off the road's left edge into holes, a wheel at a time in the air, on bump stops, with weak
// stabilisers at their limits and an unbalanced rocket. At the default tolerance the jumps of the
// landings leave some 1e-6 m, as the steps happen to fall.
static void holes(ld_model *model)
{
    model->run.tolerance = 1e-8;
    ld_vehicle *vehicle = &model->base.vehicle;
    vehicle->road.form = LD_ROAD_SUM;
    vehicle->road.bump_count = 2;
    vehicle->road.bump[0] = (ld_bump){1.3, 0.8, -0.15, LD_TRACK_LEFT};
    vehicle->road.bump[1] = (ld_bump){2.0, 0.6, 0.08, LD_TRACK_RIGHT};
    vehicle->suspension.bump_stop.compression = 0.065;
    vehicle->suspension.bump_stop.extension = 0.2;
    vehicle->suspension.bump_stop.stiffness = 2e6;
    vehicle->wheel[1].driven = vehicle->wheel[4].driven = false;
    model->platform.azimuth.stabiliser.torque_limit = 1e3;
    model->platform.elevation.stabiliser.torque_limit = 2.2e4;
    model->rocket.eccentricity[0] = 0.5e-3;
    model->rocket.mass_error = 0.7;
    model->firing[0].tube = 18;
    model->tubes.empty_count = 3;
    model->tubes.empty[0] = 1;
    model->tubes.empty[1] = 7;
    model->tubes.empty[2] = 13;
}

static void parked_and_turning(ld_model *model)
{
    ld_platform *platform = &model->platform;
    free(platform->azimuth.stabiliser.command.data);
    free(platform->elevation.stabiliser.command.data);
    platform->azimuth.stabiliser.command =
        reference_table(3, 2, (double[]){-0.1, 0.3, 0.05, 0.32, 1, 0.32});
    platform->elevation.stabiliser.command =
        reference_table(2, 2, (double[]){-0.15, 20 * degree, 0.1, 22 * degree});
    model->firing[0].at = 0.02;
}

// Besides, tracks that lie elsewhere than the wheels: those of the right side are between them.
static void locked(ld_model *model)
{
    waves_and_a_bump(model);
    model->base.vehicle.road.places[0] = -0.5;
    model->base.vehicle.road.places[1] = 1.6;
    model->platform.azimuth.lock = (ld_hinge_lock){true, 1e8, 1e5};
    model->platform.elevation.lock = (ld_hinge_lock){true, 1e8, 1e5};
}

// ---------------------------------------------------------------- the program's rows

// The rows at ignition and at the end, and extremes of all.
typedef struct rows {
    const ld_column *column;
    size_t count;
    double t_ignition; // [s]
    double *ignition, *exit;
    double least_tyre, most_travel, most_torque[HINGES]; // of all rows [N], [m], [N m]
} rows;

static ld_status begin_rows(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)error;
    rows *kept = self;
    kept->column = columns;
    kept->count = count;
    kept->ignition = calloc(count, sizeof(double));
    kept->exit = calloc(count, sizeof(double));
    return LD_OK;
}

static bool ends_with(const char *name, const char *end)
{
    size_t n = strlen(name), m = strlen(end);
    return n >= m && strcmp(name + n - m, end) == 0;
}

static ld_status keep_row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)error;
    rows *kept = self;
    memcpy(kept->exit, values, count * sizeof *values);
    if (fabs(values[0] - kept->t_ignition) < 1e-12)
        memcpy(kept->ignition, values, count * sizeof *values);
    for (size_t i = 0; i < count; i++) {
        const char *name = kept->column[i].name;
        if (ends_with(name, ".tyre_force"))
            kept->least_tyre = fmin(kept->least_tyre, values[i]);
        if (ends_with(name, ".travel"))
            kept->most_travel = fmax(kept->most_travel, values[i]);
        for (int k = 0; k < HINGES; k++)
            if (ends_with(name, k ? "elevation.torque" : "azimuth.torque"))
                kept->most_torque[k] = fmax(kept->most_torque[k], fabs(values[i]));
    }
    return LD_OK;
}

static double value(const rows *kept, const double *row, const char *group, const char *name)
{
    char full[128];
    snprintf(full, sizeof full, "%s.%s", group, name);
    for (size_t i = 0; i < kept->count; i++)
        if (strcmp(kept->column[i].name, full) == 0)
            return row[i];
    fail_msg("no column %s", full);
    return NAN;
}

// ---------------------------------------------------------------- comparison

static double largest(int count, const double *a, const double *b)
{
    double worst = 0;
    for (int i = 0; i < count; i++)
        if (!(isnan(a[i]) && isnan(b[i])))
            worst = fmax(worst, isfinite(a[i] - b[i]) ? fabs(a[i] - b[i]) : INFINITY);
    return worst;
}

static void add_difference(double *worst, double a, double b)
{
    *worst = fmax(*worst, largest(1, &a, &b));
}

typedef struct differences {
    double place, speed, force; // [m, rad], [m/s, rad/s], [N, N m]
} differences;

static void compare_chassis(const rows *kept, const double *row, const dense_instant *dense,
                            differences *worst)
{
    static const char *const place[] = {"x", "y", "z", "yaw", "pitch", "roll"};
    static const char *const speed[] = {"vx", "vy", "vz", "wx", "wy", "wz"};
    const double *state = dense->orientating, *q = state + VEHICLE_QUATERNION;
    // angles of Ry(yaw) Rz(pitch) Rx(roll) from the matrix' first column and middle row
    double angle[6] = {state[0],
                       state[1],
                       state[2],
                       atan2(2 * (q[0] * q[2] - q[1] * q[3]), 1 - 2 * (q[2] * q[2] + q[3] * q[3])),
                       asin(2 * (q[1] * q[2] + q[0] * q[3])),
                       atan2(2 * (q[0] * q[1] - q[2] * q[3]), 1 - 2 * (q[1] * q[1] + q[3] * q[3]))};
    for (int i = 0; i < 6; i++) {
        add_difference(&worst->place, value(kept, row, "chassis", place[i]), angle[i]);
        add_difference(&worst->speed, value(kept, row, "chassis", speed[i]), state[VEHICLE_V + i]);
    }
}

static void compare_hinges(const rows *kept, const double *row, const dense_instant *dense,
                           differences *worst)
{
    static const char *const hinge[HINGES] = {"azimuth", "elevation"};
    for (int i = 0; i < HINGES; i++) {
        add_difference(&worst->place, value(kept, row, hinge[i], "angle"),
                       dense->orientating[VEHICLE_ANGLE + i]);
        add_difference(&worst->place, value(kept, row, hinge[i], "measured"),
                       dense->output.hinge[i].measured);
        add_difference(&worst->speed, value(kept, row, hinge[i], "rate"),
                       dense->orientating[VEHICLE_RATE + i]);
        add_difference(&worst->force, value(kept, row, hinge[i], "torque"),
                       dense->output.hinge[i].torque);
        add_difference(&worst->force, value(kept, row, hinge[i], "friction"),
                       dense->output.hinge[i].friction);
    }
}

static void compare_wheels(const ld_vehicle *vehicle, const rows *kept, const double *row,
                           const dense_instant *dense, differences *worst)
{
    for (int i = 0; i < vehicle->wheel_count; i++) {
        char group[96];
        snprintf(group, sizeof group, "wheel.%s", vehicle->wheel[i].name);
        const double *state = dense->marching + WHEEL_STATES * i;
        const double pair[][2] = {
            {value(kept, row, group, "x"), state[0]},
            {value(kept, row, group, "y"), state[1]},
            {value(kept, row, group, "z"), state[2]},
            {value(kept, row, group, "travel"), dense->output.wheel[i].travel.y},
            {value(kept, row, group, "deflection"), dense->output.wheel[i].deflection}};
        for (int k = 0; k < 5; k++)
            add_difference(&worst->place, pair[k][0], pair[k][1]);
        add_difference(&worst->force, value(kept, row, group, "tyre_force"),
                       dense->output.wheel[i].normal);
        add_difference(&worst->force, value(kept, row, group, "along"),
                       dense->output.wheel[i].along);
        add_difference(&worst->force, value(kept, row, group, "side"), dense->output.wheel[i].side);
    }
}

static void compare_vehicle(const char *when, const ld_vehicle *vehicle, const rows *kept,
                            const double *row, const dense_instant *dense, const bounds *bound)
{
    differences worst = {0};
    compare_chassis(kept, row, dense, &worst);
    compare_hinges(kept, row, dense, &worst);
    compare_wheels(vehicle, kept, row, dense, &worst);
    printf("   vehicle at %s\n", when);
    CHECK_BELOW("places and angles [m, rad]", worst.place, bound->place);
    CHECK_BELOW("speeds and rates [m/s, rad/s]", worst.speed, bound->speed);
    CHECK_BELOW("tyre forces and hinge torques [N, N m]", worst.force, bound->force);
}

static void compare_equilibrium(const ld_vehicle *vehicle, const ld_equilibrium_summary *summary,
                                const dense_summary *dense)
{
    const dense_instant *start = &dense->start;
    double place = 0, force = 0;
    add_difference(&place, summary->chassis.y, start->orientating[1]);
    for (int i = 0; i < vehicle->wheel_count; i++) {
        add_difference(&force, summary->wheel[i].tyre_force, start->output.wheel[i].normal);
        add_difference(&place, summary->wheel[i].tyre_deflection,
                       start->output.wheel[i].deflection);
        add_difference(&place, summary->wheel[i].suspension[0], start->output.wheel[i].travel.x);
        add_difference(&place, summary->wheel[i].suspension[1], start->output.wheel[i].travel.y);
        add_difference(&place, summary->wheel[i].suspension[2], start->output.wheel[i].travel.z);
    }
    for (int i = 0; i < HINGES; i++) {
        add_difference(&place, summary->hinge[i].angle, start->orientating[VEHICLE_ANGLE + i]);
        add_difference(&force, summary->hinge[i].torque, start->output.hinge[i].torque);
    }
    add_difference(&force, summary->lock_force, dense->equilibrium.lock_force);
    add_difference(&place, summary->tip_sag[0], dense->equilibrium.tip_sag[0]);
    add_difference(&place, summary->tip_sag[1], dense->equilibrium.tip_sag[1]);
    printf("   equilibrium\n");
    CHECK_BELOW("places and angles [m, rad]", place, 1e-12);
    CHECK_BELOW("forces and torques [N, N m]", force, 1e-6);
}

static void compare_rocket(const ld_rocket_summary *rocket, const dense_summary *dense,
                           const bounds *bound)
{
    double forces = 0;
    printf("   rocket at the exit\n");
    CHECK_BELOW("release, front, middle, rear [s]",
                largest(4, &rocket->t_release, &dense->t_release), bound->instant);
    CHECK_BELOW("exit speed, inertial speed [m/s]",
                largest(2, &rocket->exit_speed, &dense->exit_speed), bound->exit);
    CHECK_BELOW("pitch, yaw [rad]", largest(2, &rocket->pitch, &dense->pitch), bound->attitude);
    CHECK_BELOW("pitch and yaw rate, spin [rad/s]",
                fmax(largest(2, &rocket->pitch_rate, &dense->pitch_rate),
                     fabs(rocket->spin_rate - dense->spin_rate)),
                bound->rate);
    CHECK_BELOW("against the tube: place [m], angles [rad]",
                largest(5, &rocket->relative.y, &dense->relative.y), bound->against);
    CHECK_BELOW("tip: place [m], angles [rad]", largest(4, &rocket->tip.y, &dense->tip.y),
                bound->against);
    CHECK_BELOW("tip: speeds [m/s], rates [rad/s]", largest(4, &rocket->tip.vy, &dense->tip.vy),
                bound->tip);
    for (int i = 0; i < 3; i++)
        forces = fmax(forces, fabs(rocket->max_contact_force[i] / dense->max_contact_force[i] - 1));
    CHECK_BELOW("greatest contact forces [relative]", forces, bound->contact);
}

static void run_scenario(void **state)
{
    const scenario *s = *state;
    ld_model model;
    ld_error error;
    ld_simulation *simulation = NULL;
    static ld_summary summary;
    static dense_summary dense;
    reference_vehicle(&model, s->speed);
    // a small tube, for the cost of the independent program
    model.tubes.modes.bending = 3;
    model.tubes.modes.torsion = 1;
    model.tubes.modes.elements = 12;
    model.run.lead_in = 0.2;
    s->change(&model);
    rows kept = {.t_ignition = model.firing[0].at, .least_tyre = INFINITY};
    ld_sink sink = {.self = &kept, .begin = begin_rows, .row = keep_row};
    ld_run_options options = {.sink = &sink};
    if (model_check(&model, &error) || ld_simulation_create(&model, &simulation, &error) ||
        ld_simulation_run(simulation, &options, &summary, &error))
        fail_msg("%s", error.text);
    flexible_tube tube;
    assert_int_equal(flexible_tube_build(&tube, &model.tubes, &error), LD_OK);
    assert_true(dense_simulate(&model, &tube, 100e-6, &dense));
    printf("  %s: %.4f m/s, pitch rate %.4f rad/s, yaw rate %.4f rad/s\n", s->name,
           dense.exit_speed, dense.pitch_rate, dense.yaw_rate);
    printf("    tyres down to %.0f N, suspensions up to %.1f mm, torques up to %.0f and %.0f N m\n",
           kept.least_tyre, 1e3 * kept.most_travel, kept.most_torque[0], kept.most_torque[1]);
    if (s->change == holes) { // it must go through what it is there for
        assert_true(kept.least_tyre == 0);
        assert_true(kept.most_travel > model.base.vehicle.suspension.bump_stop.compression);
        assert_true(kept.most_torque[0] == model.platform.azimuth.stabiliser.torque_limit);
        assert_true(kept.most_torque[1] == model.platform.elevation.stabiliser.torque_limit);
    }
    compare_equilibrium(&model.base.vehicle, &summary.equilibrium, &dense);
    compare_vehicle("ignition", &model.base.vehicle, &kept, kept.ignition, &dense.ignition,
                    &s->bound);
    compare_vehicle("the exit", &model.base.vehicle, &kept, kept.exit, &dense.exit, &s->bound);
    compare_rocket(&summary.rocket[0], &dense, &s->bound);
    free(kept.ignition);
    free(kept.exit);
    flexible_tube_free(&tube);
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

// ---------------------------------------------------------------- poles

// Both poles of each conjugate pair; returns their number.
static int both_of_each(const ld_pole *pole, int count, dense_pole *all, int capacity)
{
    int n = 0;
    for (int i = 0; i < count; i++)
        for (int sign = 1; sign >= (pole[i].imaginary > 0 ? -1 : 1); sign -= 2) {
            assert_true(n < capacity);
            all[n++] = (dense_pole){pole[i].real, sign * pole[i].imaginary};
        }
    return n;
}

// The largest distance of a pole from the one nearest to it that is not taken, relative.
static double farthest(const dense_pole *pole, dense_pole *dense, int count)
{
    double worst = 0;
    for (int i = 0; i < count; i++) {
        int nearest = 0;
        double least = INFINITY;
        for (int k = 0; k < count; k++) {
            double apart =
                hypot(pole[i].real - dense[k].real, pole[i].imaginary - dense[k].imaginary);
            nearest = apart < least ? k : nearest;
            least = fmin(least, apart);
        }
        worst = fmax(worst, least / hypot(dense[nearest].real, dense[nearest].imaginary));
        dense[nearest].real = INFINITY; // taken
    }
    return worst;
}

// Every pole of the whole, parked and rolling, against the one nearest to it. The wheels' side
// forces relax at one rate, a multiple real pole, of which rounding may make conjugate pairs a
// hair's breadth apart: it counts as many poles either way. What the dense program has beyond those
// must be the poles at zero of lock, slot and neutral directions, which the differences' error
// spreads: some are multiple and lack eigenvectors.
static void poles(void **state)
{
    enum { MOST = 400 };
    const double *speed = *state;
    ld_model model;
    ld_error error;
    ld_simulation *simulation = NULL;
    static ld_mode mode[MOST];
    static ld_pole pole[MOST];
    static dense_pole all[MOST], dense[MOST];
    int mode_count, pole_count = 0;
    reference_vehicle(&model, *speed);
    if (ld_simulation_create(&model, &simulation, &error) ||
        ld_simulation_system_modes(simulation, mode, MOST, &mode_count, pole, MOST, &pole_count,
                                   &error))
        fail_msg("%s", error.text);
    flexible_tube tube;
    assert_int_equal(flexible_tube_build(&tube, &model.tubes, &error), LD_OK);
    int count = both_of_each(pole, pole_count, all, MOST);
    int zeros = dense_poles(&model, &tube, dense, MOST) - count;
    printf("    %d poles, and %d at zero; the smallest of modulus %.3f 1/s\n", count, zeros,
           hypot(all[0].real, all[0].imaginary));
    assert_true(count > 100);
    assert_true(zeros > 0);
    CHECK_BELOW("poles at zero, by the dense program [1/s]",
                hypot(dense[zeros - 1].real, dense[zeros - 1].imaginary), 5e-3);
    CHECK_BELOW("poles [relative]", farthest(all, dense + zeros, count), 5e-5);
    flexible_tube_free(&tube);
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

int main(void)
{
    static const bounds smooth = {3e-8, 5e-7, 0.15, 5e-9, 1e-6, 2e-7, 3e-5, 1e-6, 3e-5, 1e-2};
    static const bounds hard = {3e-7, 3e-6, 1, 4e-8, 3e-5, 5e-6, 5e-4, 4e-6, 2e-4, 2e-2};
    scenario scenarios[] = {
        {"30 km/h over waves and a bump", waves_and_a_bump, 30 / 3.6, smooth},
        {"30 km/h into holes", holes, 30 / 3.6, hard},
        {"15 km/h, hinges locked", locked, 15 / 3.6, smooth},
        {"parked, platforms turning", parked_and_turning, 0, hard},
    };
    static double speed[2] = {0, 30 / 3.6};
    enum { COUNT = sizeof scenarios / sizeof scenarios[0] };
    struct CMUnitTest tests[COUNT + 2] = {
        {"poles, parked", poles, NULL, NULL, &speed[0]},
        {"poles, 30 km/h", poles, NULL, NULL, &speed[1]},
    };
    for (int i = 0; i < COUNT; i++)
        tests[i + 2] =
            (struct CMUnitTest){scenarios[i].name, run_scenario, NULL, NULL, &scenarios[i]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
