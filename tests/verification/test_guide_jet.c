// The jet of a rocket that has left on the front end of its guide, against the closed form of two
// bodies: the impulse over the exit by its work, of a rocket that burns on, or out on the way. A
// round jet on a ring against sums over the ring, and the momentum of the thrust.
#include <stdlib.h>
#include <string.h>

#include "elements/exchange.h"
#include "model/model.h"
#include "state/jets.h"
#include "support/check.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double reach = 3, full = 800, scale = 1.4; // [m], [N] at the tip

// A heavy tube that nothing holds along itself, a rocket of constant mass that touches it across
// alone, no weight, no air.
static void free_tube(ld_model *model, double thrust, double burns)
{
    reference_model(model);
    ld_rocket *rocket = &model->rocket;
    model->gravity = 0;
    model->environment.atmosphere.kind = LD_ATMOSPHERE_NONE;
    model->environment.ground = LD_GROUND_NONE;
    model->tubes.slot.kind = LD_SLOT_NONE;
    model->tubes.modes.bending = 2;
    model->tubes.modes.torsion = 1;
    for (int k = 0; k < model->tubes.support_count; k++)
        model->tubes.support[k].stiffness[0] = model->tubes.support[k].damping[0] = 0;
    model->tubes.support[0].stiffness[0] = 1e-6;
    rocket->contact.law = LD_CONTACT_BILATERAL;
    rocket->contact.friction = 0;
    rocket->lock.present = false;
    rocket->propellant = 0;
    rocket->empty = rocket->full;
    double rows[8] = {0, thrust, burns, thrust, burns + 1e-9, 0, 9, 0};
    free(rocket->motor.thrust.data);
    rocket->motor.thrust = reference_table(4, 2, rows);
    model->tubes.jet = reference_table(2, 2, (double[]){0, full, reach, 0});
    model->tubes.jet_scale = scale;
    model->run.tolerance = 1e-9;
    model->run.end = LD_END_TIME;
    model->run.end_time = 0.6;
}

static double mass_of(const ld_model *model)
{
    const ld_tubes *tubes = &model->tubes;
    return tubes->length * tubes->section[0].mass_per_length + tubes->tail.mass;
}

// d'' = T/m + F/M (1 - d/reach) = A - B d, from d = 0 at the speed v, until reach or for `longest`:
// the tube's speed.
static double speed_by_hand(const ld_model *model, double thrust, double v, double longest)
{
    double F = scale * full, M = mass_of(model);
    double B = F / (M * reach), A = thrust / model->rocket.full.mass + F / M, w = sqrt(B);
    double low = 0, high = longest;
    for (int i = 0; i < 200; i++) {
        double t = 0.5 * (low + high);
        if (A / B * (1 - cos(w * t)) + v / w * sin(w * t) < reach)
            low = t;
        else
            high = t;
    }
    double t = high;
    // int F/M (1 - d/reach)
    double way = A / B * (t - sin(w * t) / w) + v / B * (1 - cos(w * t));
    return F / M * (t - way / reach);
}

static void impulse_over_the_exit(void **state)
{
    (void)state;
    for (int n = 0; n < 2; n++) {
        ld_model model;
        double thrust = 12e3;
        free_tube(&model, thrust, 9);
        ld_summary calm;
        ld_table table = model.tubes.jet;
        model.tubes.jet.rows = 0;
        calm = summary_of_run(&model);
        model.tubes.jet = table;
        double v = calm.rocket[0].exit_speed, burns = 9;
        if (n) { // burns out on the way through the jet's reach
            burns = calm.rocket[0].t_rear + 0.03;
            reference_model_free(&model);
            free_tube(&model, thrust, burns);
        }
        ld_summary run = summary_of_run(&model);
        double u = speed_by_hand(&model, thrust, v, n ? 0.03 : 1);
        double work = 0.5 * mass_of(&model) * u * u;
        printf("  %s: tube at %.4f m/s, %.4g J\n", n ? "burnt out" : "burning", u, work);
        CHECK_BELOW("exit speed by the jet, relative", run.rocket[0].exit_speed / v - 1, 1e-12);
        CHECK_BELOW("work of the jet, relative", run.energy.work[POWER_GUIDE_JET] / work - 1, 5e-7);
        CHECK_BELOW("energy balance, relative", run.energy.residual_relative, 8e-14);
        reference_model_free(&model);
    }
}

// ---- a round jet

static const double pi = 3.14159265358979323846;
static const ld_jet_face ring = {true, 0.06, 0.15, 0.04, 0.09, 5};

// The two bodies on one axis, by the classical Runge-Kutta method: the tube's speed at the end.
static double speed_in_round_jet(double thrust, double m, double M, double v)
{
    enum { STEPS = 20000 };
    double y[3] = {0, v, 0}, h = 0.6 / STEPS; // distance, its rate, the tube's speed
    for (int n = 0; n < STEPS && y[0] < ring.reach; n++) {
        double k[5][3] = {{0}};
        for (int i = 1; i <= 4; i++) {
            double part = i == 1 ? 0 : i == 4 ? h : 0.5 * h, d = y[0] + part * k[i - 1][0];
            double b = ring.radius + ring.spread * d;
            double share = exp(-pow(ring.inner / b, 2)) - exp(-pow(ring.outer / b, 2));
            double fades = d > ring.reach ? 0 : fmin(1, 10 - 10 * d / ring.reach);
            k[i][2] = scale * thrust * share * fades / M;
            k[i][1] = thrust / m + k[i][2];
            k[i][0] = y[1] + part * k[i - 1][1];
        }
        for (int j = 0; j < 3; j++)
            y[j] += h / 6 * (k[1][j] + 2 * k[2][j] + 2 * k[3][j] + k[4][j]);
    }
    return y[2];
}

static void impulse_of_a_round_jet(void **state)
{
    (void)state;
    ld_model model;
    const double thrust = 12e3;
    free_tube(&model, thrust, 9);
    free(model.tubes.jet.data);
    model.tubes.jet = (ld_table){0};
    double v = summary_of_run(&model).rocket[0].exit_speed;
    model.tubes.jet_face = ring;
    ld_summary run = summary_of_run(&model);
    double u = speed_in_round_jet(thrust, model.rocket.full.mass, mass_of(&model), v);
    double work = 0.5 * mass_of(&model) * u * u;
    printf("  tube at %.4f m/s, %.4g J\n", u, work);
    CHECK_BELOW("work of the round jet, relative", run.energy.work[POWER_GUIDE_JET] / work - 1,
                2e-7);
    CHECK_BELOW("energy balance, relative", run.energy.residual_relative, 4e-14);
    reference_model_free(&model);
}

// A soft guide, turned by a rocket that drifts off its axis.
static void energy_of_a_ring_hit_aside(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    for (int k = 0; k < model.tubes.support_count; k++)
        model.tubes.support[k].stiffness[1] *= 0.1;
    model.tubes.jet_face = ring;
    model.tubes.jet_scale = scale;
    model.run.tolerance = 1e-9;
    model.run.end = LD_END_TIME;
    model.run.end_time = 0.4;
    ld_summary run = summary_of_run(&model);
    printf("  work of the jet %.3f J, largest %.0f J\n", run.energy.work[POWER_GUIDE_JET],
           run.energy.residual / run.energy.residual_relative);
    CHECK_BELOW("energy residual, over the work of the jet",
                run.energy.residual / run.energy.work[POWER_GUIDE_JET], 5e-9);
    reference_model_free(&model);
}

// Force, and its moments as y and z times the pressure, by the sum over a ring's area: Simpson's
// rule along the radius, evenly about it; the ring's axes are those of A, its centre `tip`.
static void sum_over_ring(const ld_jet_face *face, double thrust, v3 O1, v3 axis, v3 tip, m3 A,
                          double sum[3])
{
    enum { RADII = 400, TURNS = 400 };
    v3 normal = m3_column(A, 0);
    double away = v3_dot(v3_sub(O1, tip), normal) / v3_dot(axis, normal);
    v3 hit = v3_axpy(O1, -away, axis);
    double b = face->radius + face->spread * away, h = (face->outer - face->inner) / RADII;
    memset(sum, 0, 3 * sizeof *sum);
    for (int i = 0; i <= RADII; i++)
        for (int j = 0; j < TURNS; j++) {
            double r = face->inner + i * h, turn = 2 * pi * j / TURNS;
            double y = r * cos(turn), z = r * sin(turn);
            v3 point = v3_axpy(v3_axpy(tip, y, m3_column(A, 1)), z, m3_column(A, 2));
            double off = v3_norm(v3_sub(point, hit));
            double pressure = thrust / (pi * b * b) * exp(-off * off / (b * b));
            double area = (i % RADII == 0 ? 1 : i % 2 ? 4 : 2) * h / 3 * r * 2 * pi / TURNS;
            sum[0] += pressure * area;
            sum[1] += pressure * area * y;
            sum[2] += pressure * area * z;
        }
}

static void momentum_is_the_thrust(void **state)
{
    (void)state;
    ld_jet_face plate = {true, 0, 0.8, 0.03, 0.07, 9};
    for (int i = 0; i < 8; i++) { // a disc that takes all of the jet, off its axis and on it
        plate.outer = 8 * (plate.radius + plate.spread * 0.4 * i);
        v3 r = v3_make(0.4 * i, 5e-3 * i, -8e-3 * i);
        jet_load load = jet_on_face(&plate, 700, r, v3_make(1, 0, 0));
        double fades = fmin(1, 10 - 10 * r.x / plate.reach);
        CHECK_BELOW("force, over the thrust", load.force / (700 * fades) - 1, 2e-15);
        CHECK_BELOW("where, y [m]", load.at[0] - r.y, 1e-15);
        CHECK_BELOW("where, z [m]", load.at[1] - r.z, 1e-15);
    }
}

static v3 turned_to(v3 from, v3 to, double angle)
{
    return v3_add(v3_scale(cos(angle), from), v3_scale(sin(angle), to));
}

// The load of a launch's own look-up: a rocket between two places, a guide askew in space.
static void ring_off_the_axis(void **state)
{
    (void)state;
    enum { PLACES = 8 };
    static flight_system flight;
    ld_model model;
    reference_model(&model);
    model.tubes.jet_face = ring;
    model.tubes.jet_scale = scale;
    double times[2] = {0, 1}, thrusts[2] = {4e3, 2e3};
    flight.motor.corner_count = 2;
    flight.motor.t = times;
    flight.motor.thrust = thrusts;
    m3 A = m3_mul(m3_rotation_x(0.7), q_matrix(q_from((double[]){0.9, 0.1, -0.3, 0.3})));
    v3 tip = v3_make(3, 2, -1), e = m3_column(A, 0);
    jet_pose place[PLACES];
    for (int n = 0; n < 5; n++) {
        double far = 0.02 + 0.7 * n, tilt = 0.03 * (n - 1), off = 0.012 * n;
        v3 across = v3_add(v3_scale(0.6, m3_column(A, 1)), v3_scale(-0.8, m3_column(A, 2)));
        v3 v = v3_scale(40, v3_axpy(e, tilt, across)), turned;
        for (int i = 0; i < PLACES; i++) {
            v3 r = v3_axpy(v3_axpy(tip, far, e), off, m3_column(A, 2));
            turned = turned_to(e, across, tilt + 2e-3 * i); // at 2 rad/s
            place[i] = (jet_pose){1e-3 * i, v3_axpy(r, 1e-3 * i, v), v, turned};
        }
        jets left = {.model = &model, .count = 1};
        left.of[0] = (jet){.flight = &flight,
                           .t_ignition = -0.25,
                           .tube = 3,
                           .count = PLACES,
                           .greatest = 4e3,
                           .place = place};
        double t = 3.3e-3, by_sum[3];
        jet_load load = jets_on_guide(&left, t, tip, A, 3);
        double thrust = scale * (4e3 - 2e3 * (t + 0.25));
        turned = turned_to(e, across, tilt + 2 * t);
        sum_over_ring(&ring, thrust, v3_axpy(place[0].r, t, v), turned, tip, A, by_sum);
        printf("  %.2f m: %.1f of %.0f N, %.1f mm off\n", far, load.force, thrust,
               1e3 * hypot(load.at[0], load.at[1]));
        CHECK_BELOW("force, over the thrust", (load.force - by_sum[0]) / thrust, 5e-10);
        for (int k = 0; k < 2; k++)
            CHECK_BELOW("moment, over thrust and radius",
                        (load.force * load.at[k] - by_sum[1 + k]) / (thrust * ring.outer), 5e-10);
        CHECK_BELOW("of another tube [N]", jets_on_guide(&left, t, tip, A, 2).force, 0);
        CHECK_BELOW("beyond the course [N]", jets_on_guide(&left, 8e-3, tip, A, 3).force, 0);
    }
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(impulse_over_the_exit),      cmocka_unit_test(impulse_of_a_round_jet),
        cmocka_unit_test(energy_of_a_ring_hit_aside), cmocka_unit_test(momentum_is_the_thrust),
        cmocka_unit_test(ring_off_the_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
