// Jet damping and the rates of mass, centre and inertia: the momentum of the rocket with that of
// the gas inside and of all that has left, and closed forms of a rate that decays.
#include "support/check.h"

#include "math/vectors/quaternion.h"
#include "support/flight_text.h"
#include "systems/flight/flight.h"

// A motor of constant thrust in empty space without gravity, off the mass centre's way, so that c
// moves, and burning unevenly between the axes.
static const char text[] =
    "launchdyn: 1\n"
    "environment: {atmosphere: none, gravity: 0 m/s2, ground: none}\n"
    "rocket:\n"
    "  {mass: 60 kg, center: 1.1 0 0 m, inertia: 0.5 24 23.7 kg.m2,\n"
    "   empty: {mass: 40 kg, center: 1.3 0 0 m, inertia: 0.3 18 17.8 kg.m2},\n"
    "   motor: {thrust: [[0 s, 0 kN], [0 s, 8 kN], [2 s, 8 kN], [2 s, 0 kN]], at: -0.1 0 0 m,\n"
    "     jet_damping: yes, exit_radius: 40 mm}}\n"
    "flight: {position: 0 0 0 m, velocity: 30 -20 10 m/s, rate: 2 1.5 -1 rad/s}\n"
    "run: {end: 2 s}\n";

enum { MORE = 6, ALL = FLIGHT_STATES + MORE };

typedef struct momentum {
    v3 linear, angular; // about the origin of I, in I
} momentum;

// Numbers of the motor at time t: all that it does is linear or quadratic in t.
typedef struct inside {
    double m, mu, R2;
    v3 c, c_dot, exit, flow; // `flow`: integral of density times velocity in B, over the volume
    m3 J;
} inside;

static inside inside_at(const flight_system *system, double t)
{
    const double burn = 2, share = t / burn;
    const motor *burns = &system->motor;
    v3 c_change = v3_sub(burns->empty.c, burns->full.c);
    m3 J_change = m3_sub(burns->empty.J, burns->full.J);
    inside now = {.m = 60 - 20 * share, .mu = 20 / burn, .R2 = 0.04 * 0.04};
    now.c = v3_axpy(system->motor.full.c, share, c_change);
    now.c_dot = v3_scale(1 / burn, c_change);
    now.exit = system->thrust_point;
    // d(m c)/dt = flow - mu exit
    now.flow =
        v3_add(v3_axpy(v3_scale(-now.mu, now.c), now.m, now.c_dot), v3_scale(now.mu, now.exit));
    now.J = m3_add(system->motor.full.J, m3_scale(share, J_change));
    return now;
}

// Of body and gas inside.
static momentum held(const flight_system *system, double t, const double *y)
{
    inside now = inside_at(system, t);
    m3 A = m3_mul(q_matrix(q_from(y + FLIGHT_Q)), m3_rotation_x(y[FLIGHT_ROLL]));
    v3 w = m3_apply_transposed(m3_rotation_x(y[FLIGHT_ROLL]), v3_from(y + FLIGHT_W));
    momentum out;
    out.linear = v3_axpy(m3_apply(A, now.flow), now.m, v3_from(y + FLIGHT_V));
    // the gas flows along the axis through c: it has no moment of momentum about c on its own
    out.angular =
        v3_add(v3_cross(v3_from(y + FLIGHT_R), out.linear), m3_apply(A, m3_apply(now.J, w)));
    return out;
}

// What leaves a second, with the speed against the exit by which the thrust is what a stand
// measures: T = mu u - d/dt of `flow`.
static momentum leaving(const flight_system *system, double t, const double *y)
{
    inside now = inside_at(system, t);
    m3 A = m3_mul(q_matrix(q_from(y + FLIGHT_Q)), m3_rotation_x(y[FLIGHT_ROLL]));
    v3 w = m3_apply_transposed(m3_rotation_x(y[FLIGHT_ROLL]), v3_from(y + FLIGHT_W));
    v3 arm = v3_sub(now.exit, now.c);
    double unsteady = -2 * now.mu * now.c_dot.x, u = (8000 + unsteady) / now.mu;
    // velocity of the exit's middle and, of its disc, what turns about that
    v3 v = v3_add(v3_from(y + FLIGHT_V), m3_apply(A, v3_add(v3_cross(w, arm), v3_make(-u, 0, 0))));
    v3 spin = v3_scale(now.mu * now.R2 / 4, v3_make(2 * w.x, w.y, w.z));
    momentum out = {v3_scale(now.mu, v), v3_zero()};
    out.angular = v3_add(v3_cross(v3_add(v3_from(y + FLIGHT_R), m3_apply(A, arm)), out.linear),
                         m3_apply(A, spin));
    return out;
}

static void rates(const flight_system *system, flight_phase *phase, double t, const double *y,
                  double *y_dot)
{
    flight_rates(system, phase, t, y, y_dot);
    momentum out = leaving(system, t, y);
    v3_store(y_dot + FLIGHT_STATES, out.linear);
    v3_store(y_dot + FLIGHT_STATES + 3, out.angular);
}

// Classical Runge-Kutta steps of the flight and of what has left.
static void step(const flight_system *system, flight_phase *phase, double t, double h, double *y)
{
    static const double at[] = {0, 0.5, 0.5, 1}, weight[] = {1, 2, 2, 1};
    double k[4][ALL] = {{0}}, z[ALL], sum[ALL] = {0};
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < ALL; i++)
            z[i] = y[i] + (stage ? at[stage] * h * k[stage - 1][i] : 0);
        rates(system, phase, t + at[stage] * h, z, k[stage]);
        for (int i = 0; i < ALL; i++)
            sum[i] += weight[stage] * k[stage][i];
    }
    for (int i = 0; i < ALL; i++)
        y[i] += h / 6 * sum[i];
}

// Flies 1.9 s of the burn; returns the state with what has left.
static void burn(const flight_system *system, const ld_model *model, double *y)
{
    enum { STEPS = 4000 };
    flight_phase phase = {.t_ignition = 0};
    flight_set_piece(system, &phase, 1);
    memset(y, 0, ALL * sizeof *y);
    flight_start(system, &phase, &model->flight, y);
    for (int i = 0; i < STEPS; i++)
        step(system, &phase, 1.9 * i / STEPS, 1.9 / STEPS, y);
}

// All momentum is there: of rocket, gas inside and gas outside.
static void test_momentum(void **state)
{
    (void)state;
    ld_model model = read_text(text);
    flight_system system;
    double y[ALL], first[ALL] = {0};
    assert_int_equal(flight_build(&system, &model, 0, NULL), LD_OK);
    flight_phase phase = {.t_ignition = 0};
    flight_set_piece(&system, &phase, 1);
    flight_start(&system, &phase, &model.flight, first);
    momentum before = held(&system, 0, first);
    burn(&system, &model, y);
    momentum after = held(&system, 1.9, y);
    v3 gone = v3_from(y + FLIGHT_STATES), turned = v3_from(y + FLIGHT_STATES + 3);
    v3 linear = v3_sub(v3_add(after.linear, gone), before.linear);
    v3 angular = v3_sub(v3_add(after.angular, turned), before.angular);
    CHECK_WITHIN("momentum that has left [N s]", v3_norm(gone), 1e3, 1e5);
    CHECK_BELOW("momentum, over what has left", v3_norm(linear) / v3_norm(gone), 1e-10);
    CHECK_BELOW("angular momentum, over what has left", v3_norm(angular) / v3_norm(turned), 1e-10);
    flight_free(&system);
    model_clear(&model);
}

// Without the option the momentum is not all there: what the test above sees is not a nothing.
static void test_without(void **state)
{
    (void)state;
    ld_model model = read_text(text);
    flight_system system;
    double y[ALL], first[ALL] = {0};
    model.rocket.motor.jet_damping = LD_JET_DAMPING_NO;
    assert_int_equal(flight_build(&system, &model, 0, NULL), LD_OK);
    flight_phase phase = {.t_ignition = 0};
    flight_set_piece(&system, &phase, 1);
    flight_start(&system, &phase, &model.flight, first);
    momentum before = held(&system, 0, first);
    burn(&system, &model, y);
    momentum after = held(&system, 1.9, y);
    v3 gone = v3_from(y + FLIGHT_STATES);
    v3 linear = v3_sub(v3_add(after.linear, gone), before.linear);
    CHECK_WITHIN("momentum missing, over what has left", v3_norm(linear) / v3_norm(gone), 1e-4, 1);
    flight_free(&system);
    model_clear(&model);
}

// A rate across the axis with the mass centre at rest: J' = const, so w = w_0 (J/J_0)^-(1 + mu (l^2
// + R^2/4)/J'); a roll on its own with l^2 + R^2/4 put for R^2/2.
static void test_decay(void **state)
{
    (void)state;
    for (int roll = 0; roll < 2; roll++) {
        ld_model model = read_text(text);
        model.rocket.empty.center[0] = model.rocket.full.center[0];
        model.flight.rate[0] = roll ? 3 : 0;
        model.flight.rate[1] = 0;
        model.flight.rate[2] = roll ? 0 : -1;
        flight_system system;
        double y[ALL];
        assert_int_equal(flight_build(&system, &model, 0, NULL), LD_OK);
        burn(&system, &model, y);
        double J0 = roll ? 0.5 : 23.7, J_dot = roll ? -0.1 : -2.95, J = J0 + 1.9 * J_dot;
        double square = roll ? 0.04 * 0.04 / 2 : 1.2 * 1.2 + 0.04 * 0.04 / 4;
        double left = pow(J / J0, -(1 + 10 * square / J_dot));
        CHECK_NEAR(roll ? "roll rate over the first" : "rate across over the first",
                   roll ? y[FLIGHT_W] / 3 : -(y[FLIGHT_W + 2] * cos(y[FLIGHT_ROLL])), left, 1e-12);
        flight_free(&system);
        model_clear(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_momentum),
                                       cmocka_unit_test(test_without),
                                       cmocka_unit_test(test_decay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
