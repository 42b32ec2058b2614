// The independent vehicle (support/dense_vehicle.h) on its own: its equations against their own
// energy and kinematics, equilibrium and poles of the reference vehicle.
#include "support/check.h"

#include "math/matrices/lapack.h"

#include "support/vehicle_case.h"

static const double degree = 3.14159265358979323846 / 180;

// ---------------------------------------------------------------- random states

// The case a time h later, to first order.
static vehicle_case later(const vehicle_case *c, const dense_vehicle_output *output, double h)
{
    vehicle_case next = *c;
    for (int i = 0; i < VEHICLE_BODY_STATES; i++)
        next.orientating[i] += h * output->orientating[i];
    for (int i = 0; i < DENSE_MARCHING_STATES; i++)
        next.marching[i] += h * output->marching[i];
    return next;
}

// Energies change by the power of the forces, and the tube's velocity by the accelerations of the
// platform that the multipliers hold: central differences along the motion.
static void energy_and_kinematics_of_random_states(void **state)
{
    (void)state;
    const double h = 1e-6;
    uint64_t seed = 1;
    double worst[2] = {0};
    for (int kind = 0; kind < 24; kind++) {
        ld_model model;
        dense_vehicle vehicle;
        draw_vehicle(&seed, kind, &model);
        dense_vehicle_create(&vehicle, &model, 8, (int[]){1, 5}, 2);
        for (int n = 0; n < 10; n++) {
            vehicle_case c, next[2];
            dense_vehicle_output now, there[2];
            draw_vehicle_state(&seed, &model, &c);
            dense_vehicle_input input = dense_input_of(&c);
            assert_true(dense_vehicle_evaluate(&vehicle, &input, &now));
            for (int i = 0; i < 2; i++) {
                next[i] = later(&c, &now, i ? h : -h);
                input = dense_input_of(&next[i]);
                assert_true(dense_vehicle_evaluate(&vehicle, &input, &there[i]));
            }
            double change =
                there[1].kinetic + there[1].potential - there[0].kinetic - there[0].potential;
            worst[0] = fmax(worst[0], fabs(change / (2 * h) - now.power) / now.kinetic);
            v3 arm = m3_apply(now.tube.A, vehicle.tube_at), w = now.tube.w;
            v3 a = v3_add(
                now.acceleration[DENSE_ELEVATION],
                v3_add(v3_cross(now.alpha[DENSE_ELEVATION], arm), v3_cross(w, v3_cross(w, arm))));
            v3 measured = v3_scale(0.5 / h, v3_sub(there[1].tube.v, there[0].tube.v));
            worst[1] = fmax(worst[1], v3_norm(v3_sub(measured, a)) / v3_norm(a));
            measured = v3_scale(0.5 / h, v3_sub(there[1].tube.w, there[0].tube.w));
            worst[1] = fmax(worst[1], v3_norm(v3_sub(measured, now.alpha[DENSE_ELEVATION])) /
                                          v3_norm(now.alpha[DENSE_ELEVATION]));
        }
        dense_vehicle_free(&vehicle);
        reference_model_free(&model);
    }
    CHECK_BELOW("power of the forces against energy [of the kinetic one/s]", worst[0], 3e-6);
    CHECK_BELOW("acceleration of the tube's frame [relative]", worst[1], 5e-10);
}

// ---------------------------------------------------------------- parked reference vehicle

// Equilibrium with every tube carried, the launching one too.
typedef struct parked {
    ld_model model;
    dense_vehicle vehicle;
    double orientating[VEHICLE_BODY_STATES], marching[DENSE_MARCHING_STATES];
    hold_rest rest[HINGES];
    double residual;
} parked;

static void set_up(parked *at)
{
    reference_vehicle(&at->model, 0);
    dense_vehicle_create(&at->vehicle, &at->model, 0, NULL, 0);
    assert_true(dense_vehicle_equilibrium(&at->vehicle, 0, 0, v3_zero(), v3_zero(), at->orientating,
                                          at->marching, at->rest, &at->residual));
}

static void tear_down(parked *at)
{
    dense_vehicle_free(&at->vehicle);
    reference_model_free(&at->model);
}

static void equilibrium_of_the_reference_vehicle(void **state)
{
    (void)state;
    static parked at;
    static const double load[3] = {25937.9, 25590.3, 25462.2}, travel[3] = {59.45, 58.58, 58.26};
    set_up(&at);
    dense_vehicle_input input = {.orientating = at.orientating, .marching = at.marching};
    dense_vehicle_output output;
    assert_true(dense_vehicle_evaluate(&at.vehicle, &input, &output));
    CHECK_BELOW("rates left", at.residual, 1e-8);
    double sum = 0;
    for (int i = 0; i < 6; i++) {
        sum += output.wheel[i].normal;
        CHECK_NEAR("wheel load [N]", output.wheel[i].normal, load[i / 2], 0.1);
        CHECK_NEAR("suspension [mm]", 1e3 * output.wheel[i].travel.y, travel[i / 2], 0.01);
        CHECK_NEAR("tyre [mm]", 1e3 * output.wheel[i].deflection, load[i / 2] / 1.1e3, 1e-3);
    }
    // mass of a tube with tail and rocket: a steel ring of 3 m, 8 kg, 60 kg
    double tube = 7850 * 180 * degree * (0.085 * 0.085 - 0.0825 * 0.0825) * 3 + 8 + 60;
    double mass = 11000 + 700 + 900 + 18 * tube + 6 * 220;
    CHECK_BELOW("wheel loads less the weight [relative]", sum / (mass * at.model.gravity) - 1,
                1e-13);
    CHECK_NEAR("elevation hinge [deg]", at.rest[1].angle / degree, 19.818, 5e-4);
    CHECK_NEAR("elevation torque [N m]", at.rest[1].torque, 15871, 0.5);
    tear_down(&at);
}

// Small changes of the state: chassis' place (0-2) and turning (3-5), then the rest of the
// orientating state from the hinge angles on, then the marching state.
enum { HINGE_CHANGES = VEHICLE_BODY_STATES - VEHICLE_ANGLE, WHEEL_CHANGES = 6 + HINGE_CHANGES };
enum { CHANGES = WHEEL_CHANGES + 6 * WHEEL_STATES + 1 };

static void displace(int k, double change, double *o, double *m)
{
    if (k < 3)
        o[VEHICLE_R + k] += change;
    else if (k < 6) {
        quat turn = {1, k == 3 ? 0.5 * change : 0, k == 4 ? 0.5 * change : 0,
                     k == 5 ? 0.5 * change : 0};
        quat q = q_multiply(q_from(o + VEHICLE_QUATERNION), turn);
        memcpy(o + VEHICLE_QUATERNION, &q, sizeof q);
    } else if (k < WHEEL_CHANGES)
        o[VEHICLE_ANGLE + k - 6] += change;
    else
        m[k - WHEEL_CHANGES] += change;
}

// Rates of the changes about the equilibrium, where every rate is zero.
static void rates_of(const parked *at, int k, double change, double *rate)
{
    double o[VEHICLE_BODY_STATES], m[DENSE_MARCHING_STATES];
    dense_vehicle_output output;
    memcpy(o, at->orientating, sizeof o);
    memcpy(m, at->marching, sizeof m);
    displace(k, change, o, m);
    dense_vehicle_input input = {.orientating = o, .marching = m, .frictionless = true};
    assert_true(dense_vehicle_evaluate(&at->vehicle, &input, &output));
    memcpy(rate, o + VEHICLE_V, 6 * sizeof *rate);
    memcpy(rate + 6, output.orientating + VEHICLE_ANGLE, HINGE_CHANGES * sizeof *rate);
    memcpy(rate + WHEEL_CHANGES, output.marching, (6 * WHEEL_STATES + 1) * sizeof *rate);
}

typedef struct pole {
    double real, imaginary;
} pole;

static int by_modulus(const void *a, const void *b)
{
    const pole *p = a, *q = b;
    double d = hypot(p->real, p->imaginary) - hypot(q->real, q->imaginary);
    return (d > 0) - (d < 0);
}

// The frequencies known of the reference vehicle are moduli of its damped poles over 2 pi; wheels
// hop at 12.4 to 13.1 Hz.
static void poles_of_the_parked_vehicle(void **state)
{
    (void)state;
    static parked at;
    static double jacobian[CHANGES * CHANGES];
    double low[CHANGES], high[CHANGES], real[CHANGES], imaginary[CHANGES];
    const double h = 1e-6;
    set_up(&at);
    for (int k = 0; k < CHANGES; k++) {
        rates_of(&at, k, -h, low);
        rates_of(&at, k, h, high);
        for (int i = 0; i < CHANGES; i++)
            jacobian[i * CHANGES + k] = (high[i] - low[i]) / (2 * h);
    }
    assert_int_equal(LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'N', CHANGES, jacobian, CHANGES, real,
                                   imaginary, NULL, 1, NULL, 1),
                     0);
    // those that swing, and the fast real ones, by modulus
    pole swing[CHANGES], creep[CHANGES];
    int swings = 0, creeps = 0;
    for (int i = 0; i < CHANGES; i++)
        if (imaginary[i] > 1e-3)
            swing[swings++] = (pole){real[i], imaginary[i]};
        else if (imaginary[i] == 0 && real[i] < -2)
            creep[creeps++] = (pole){real[i], 0};
    qsort(swing, (size_t)swings, sizeof *swing, by_modulus);
    qsort(creep, (size_t)creeps, sizeof *creep, by_modulus);
    static const struct {
        const char *what;
        double frequency, damping;
    } expected[] = {{"sway and roll [Hz]", 0.8702, 0.1205}, {"surge [Hz]", 1.3527, 0.1307},
                    {"heave [Hz]", 1.8368, 0.2563},         {"yaw [Hz]", 2.5281, 0.0688},
                    {"pitch [Hz]", 2.8381, 0.2077},         {"roll [Hz]", 3.8360, 0.1516},
                    {"wheel hop [Hz]", 12.4054, 0.8870},    {"wheel hop [Hz]", 12.4577, 0.8589},
                    {"wheel hop [Hz]", 12.7278, 0.8595},    {"wheel hop [Hz]", 13.1418, 0.7982}};
    for (int i = 0; i < 10; i++) {
        double modulus = hypot(swing[i].real, swing[i].imaginary);
        CHECK_NEAR(expected[i].what, modulus / (360 * degree), expected[i].frequency, 1e-4);
        CHECK_NEAR("  damping ratio", -swing[i].real / modulus, expected[i].damping, 1e-4);
    }
    static const double fast[4] = {-13.694, -15.987, -114.469, -122.746};
    assert_int_equal(creeps, 4);
    for (int i = 0; i < 4; i++)
        CHECK_NEAR("stabiliser [1/s]", creep[i].real, fast[i], 1e-3);
    tear_down(&at);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_and_kinematics_of_random_states),
        cmocka_unit_test(equilibrium_of_the_reference_vehicle),
        cmocka_unit_test(poles_of_the_parked_vehicle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
