// The jet of a rocket that has left on the front end of its guide, against the closed form of two
// bodies: the impulse over the exit by its work, of a rocket that burns on, or out on the way. A
// jet on a ring, round or by a table, against sums over the ring, and the momentum of the thrust; a
// deflector against two bodies.
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
static const ld_jet_face ring = {true, 0.06, 0.15};
static const ld_plume plume = {true, LD_PLUME_ROUND, 0.04, 0.09, {0}, 5};
static const ld_deflector plate = {true, -0.35, 0.01, 0.22, {-0.7, 0.1, 0.3}};

// The share of the round jet that hits a ring at that distance.
static double share_at(double inner, double outer, double distance)
{
    double b = plume.radius + plume.spread * distance;
    double fades = distance > plume.reach ? 0 : fmin(1, 10 - 10 * distance / plume.reach);
    return fades * (exp(-pow(inner / b, 2)) - exp(-pow(outer / b, 2)));
}

// The two bodies on one axis, by the classical Runge-Kutta method, from the distance d of the
// nozzle from the tip and the rate v on: the tube's speed after a time. Only with a deflector does
// the jet act before the exit.
typedef struct two_bodies {
    const ld_model *model;
    double thrust, d, v, time;
} two_bodies;

static void two_rates(const two_bodies *self, const double *y, double *rate)
{
    const ld_tubes *tubes = &self->model->tubes;
    const ld_deflector *back = &tubes->deflector;
    double force = y[0] > 0 ? share_at(ring.inner, ring.outer, y[0]) : 0;
    if (back->present)
        force -=
            back->push[0] * share_at(back->inner, back->outer, y[0] + tubes->length - back->at);
    rate[2] = scale * self->thrust * force / mass_of(self->model);
    rate[1] = self->thrust / self->model->rocket.full.mass + rate[2];
    rate[0] = y[1];
}

static void two_step(const two_bodies *self, double h, double *y)
{
    double k[5][3] = {{0}};
    for (int i = 1; i <= 4; i++) {
        double part = i == 1 ? 0 : i == 4 ? h : 0.5 * h, at[3];
        for (int j = 0; j < 3; j++)
            at[j] = y[j] + part * k[i - 1][j];
        two_rates(self, at, k[i]);
    }
    for (int j = 0; j < 3; j++)
        y[j] += h / 6 * (k[1][j] + 2 * k[2][j] + 2 * k[3][j] + k[4][j]);
}

static double speed_in_round_jet(const two_bodies *self)
{
    enum { STEPS = 40000 };
    double y[3] = {self->d, self->v, 0}, h = self->time / STEPS; // distance, its rate, the speed
    for (int n = 0; n < STEPS; n++) {
        double before[3] = {y[0], y[1], y[2]};
        two_step(self, h, y);
        if (before[0] < 0 && y[0] > 0) { // once to the tip, where the force jumps
            double part = h * before[0] / (before[0] - y[0]);
            memcpy(y, before, sizeof y);
            for (int i = 0; i < 3; i++) // Newton's method
                part -= (memcpy(y, before, sizeof y), two_step(self, part, y), y[0] / y[1]);
            memcpy(y, before, sizeof y);
            two_step(self, part, y);
            y[0] = 1e-15;
            two_step(self, h - part, y);
        }
    }
    return y[2];
}

static void check_work(const char *name, const ld_model *model, double u, double balance)
{
    ld_summary run = summary_of_run(model);
    double work = 0.5 * mass_of(model) * u * u;
    printf("  %s: tube at %.4f m/s, %.4g J\n", name, u, work);
    CHECK_BELOW("work of the round jet, relative", run.energy.work[POWER_GUIDE_JET] / work - 1,
                2e-7);
    CHECK_BELOW("energy balance, relative", run.energy.residual_relative, balance);
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
    model.rocket.motor.plume = plume;
    model.tubes.jet_face = ring;
    two_bodies bodies = {&model, thrust, 1e-15, v, 0.6};
    check_work("front end", &model, speed_in_round_jet(&bodies), 4e-14);
    model.tubes.deflector = plate;
    model.tubes.deflector.push[1] = model.tubes.deflector.push[2] = 0;
    model.run.end_time = 0.4;
    bodies.d = model.rocket.start_at - model.tubes.length;
    bodies.v = 0;
    bodies.time = 0.4;
    check_work("with a deflector", &model, speed_in_round_jet(&bodies), 1e-11);
    reference_model_free(&model);
}

// A plate that takes all of the jet and sends it back across: the momentum of both bodies along the
// axis is 0 at the exit; what is turned aside by half leaves half of the thrust's impulse.
static void deflector_takes_the_momentum(void **state)
{
    (void)state;
    for (int n = 0; n < 2; n++) {
        ld_model model;
        const double thrust = 9e3, push = n ? -0.5 : -1;
        free_tube(&model, thrust, 9);
        free(model.tubes.jet.data);
        model.tubes.jet = (ld_table){0};
        model.tubes.jet_scale = 1;
        model.rocket.motor.plume = (ld_plume){true, LD_PLUME_ROUND, 0.1, 0, {0}, 50};
        model.tubes.deflector = (ld_deflector){true, -0.2, 0, 0.8, {push, 0, 0}};
        ld_summary run = summary_of_run(&model);
        const ld_rocket_summary *rocket = &run.rocket[0];
        double m = model.rocket.full.mass, M = mass_of(&model), t = rocket->t_rear;
        double rocket_speed = thrust * t / m, tube_speed = push * thrust * t / M;
        CHECK_BELOW("exit speed, relative", rocket->exit_speed / (rocket_speed - tube_speed) - 1,
                    2e-10);
        reference_model_free(&model);
    }
}

// A soft guide, turned by a rocket that drifts off its axis.
static void energy_of_a_ring_hit_aside(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    for (int k = 0; k < model.tubes.support_count; k++)
        model.tubes.support[k].stiffness[1] *= 0.1;
    model.rocket.motor.plume = plume;
    model.tubes.jet_face = ring;
    model.tubes.deflector = plate;
    model.tubes.jet_scale = scale;
    model.run.tolerance = 1e-9;
    model.run.end = LD_END_TIME;
    model.run.end_time = 0.4;
    ld_summary run = summary_of_run(&model);
    printf("  work of the jet %.3f J, largest %.0f J\n", run.energy.work[POWER_GUIDE_JET],
           run.energy.residual / run.energy.residual_relative);
    CHECK_BELOW("energy residual, over the work of the jet",
                run.energy.residual / run.energy.work[POWER_GUIDE_JET], 3e-8);
    reference_model_free(&model);
}

static double round_pressure(const ld_plume *self, double thrust, double distance, double off)
{
    double b = self->radius + self->spread * distance;
    return thrust / (pi * b * b) * exp(-off * off / (b * b));
}

// A jet's pressure on a ring's points.
typedef double pressure_law(const ld_plume *self, double thrust, double distance, double off);

// A ring in space, and a rocket before it.
typedef struct ring_scene {
    pressure_law *law;
    const ld_plume *plume;
    double inner, outer, thrust;
    v3 O1, axis, center;
    m3 A;
} ring_scene;

// Force, and its moments as y and z times the pressure, by the sum over a ring's area: Simpson's
// rule along the radius, evenly about it; the ring's axes are those of A.
static void sum_over_ring(const ring_scene *scene, double sum[3])
{
    enum { RADII = 400, TURNS = 400 };
    v3 normal = m3_column(scene->A, 0);
    double away = v3_dot(v3_sub(scene->O1, scene->center), normal) / v3_dot(scene->axis, normal);
    v3 hit = v3_axpy(scene->O1, -away, scene->axis);
    double h = (scene->outer - scene->inner) / RADII;
    memset(sum, 0, 3 * sizeof *sum);
    for (int i = 0; i <= RADII; i++)
        for (int j = 0; j < TURNS; j++) {
            double r = scene->inner + i * h, turn = 2 * pi * j / TURNS;
            double y = r * cos(turn), z = r * sin(turn);
            v3 point = v3_axpy(v3_axpy(scene->center, y, m3_column(scene->A, 1)), z,
                               m3_column(scene->A, 2));
            double pressure =
                scene->law(scene->plume, scene->thrust, away, v3_norm(v3_sub(point, hit)));
            double area = (i % RADII == 0 ? 1 : i % 2 ? 4 : 2) * h / 3 * r * 2 * pi / TURNS;
            sum[0] += pressure * area;
            sum[1] += pressure * area * y;
            sum[2] += pressure * area * z;
        }
}

static void momentum_is_the_thrust(void **state)
{
    (void)state;
    const ld_plume wide = {true, LD_PLUME_ROUND, 0.03, 0.07, {0}, 9};
    for (int i = 0; i < 8; i++) { // a disc that takes all of the jet, off its axis and on it
        plume_ring disc = {0, 8 * (wide.radius + wide.spread * 0.4 * i)};
        v3 r = v3_make(0.4 * i, 5e-3 * i, -8e-3 * i);
        plume_load load = plume_on_ring(&wide, disc, (plume_thrust){700, 900}, r, v3_make(1, 0, 0));
        double fades = fmin(1, 10 - 10 * r.x / wide.reach);
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
    model.tubes.deflector = plate;
    model.tubes.jet_scale = scale;
    double times[2] = {0, 1}, thrusts[2] = {4e3, 2e3};
    flight.motor.corner_count = 2;
    flight.motor.t = times;
    flight.motor.thrust = thrusts;
    flight.motor.greatest = 4e3;
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
        left.of[0] = (jet){
            .flight = &flight, .t_ignition = -0.25, .tube = 3, .count = PLACES, .place = place};
        double t = 3.3e-3, thrust = scale * (4e3 - 2e3 * (t + 0.25)), by_sum[3];
        jet_source from = jets_source(&left, t, 3);
        turned = turned_to(e, across, tilt + 2 * t);
        ring_scene scene = {round_pressure, &plume, ring.inner,
                            ring.outer,     thrust, v3_axpy(place[0].r, t, v),
                            turned,         tip,    A};
        guide_push push = jet_on_face(&model.tubes, &plume, &from, tip, A);
        sum_over_ring(&scene, by_sum);
        printf("  %.2f m: %.1f of %.0f N, %.1f mm off\n", far, push.hit, thrust,
               1e3 * hypot(push.at.y, push.at.z));
        CHECK_BELOW("force, over the thrust", (push.hit - by_sum[0]) / thrust, 5e-10);
        CHECK_BELOW("backwards, over the thrust",
                    v3_norm(v3_sub(push.force, v3_make(-push.hit, 0, 0))) / thrust, 0);
        CHECK_BELOW("moment y, over thrust and radius",
                    (push.hit * push.at.y - by_sum[1]) / (thrust * ring.outer), 5e-10);
        CHECK_BELOW("moment z, over thrust and radius",
                    (push.hit * push.at.z - by_sum[2]) / (thrust * ring.outer), 5e-10);
        // a deflector, the rear end where the tip was
        scene.center = v3_axpy(tip, plate.at, e);
        scene.inner = plate.inner;
        scene.outer = plate.outer;
        sum_over_ring(&scene, by_sum);
        push = jet_on_deflector(&model.tubes, &plume, &from, tip, A);
        v3 force = v3_scale(by_sum[0], v3_from(plate.push));
        CHECK_BELOW("deflector: force, over the thrust",
                    v3_norm(v3_sub(push.force, force)) / thrust, 5e-10);
        v3 at = v3_make(plate.at, by_sum[1] / by_sum[0], by_sum[2] / by_sum[0]);
        CHECK_BELOW("deflector: where [m]", v3_norm(v3_sub(push.at, at)), 5e-10);
        CHECK_BELOW("of another tube [N]", jets_source(&left, t, 2).thrust.now, 0);
        CHECK_BELOW("beyond the course [N]", jets_source(&left, 8e-3, 3).thrust.now, 0);
    }
    reference_model_free(&model);
}

// ---- by a table

static double table_rows[][3] = {
    {0, 0, 9e5},     {0, 0.05, 4e5}, {0, 0.08, 0},  {0.6, 0, 3e5}, {0.6, 0.03, 3.2e5},
    {0.6, 0.1, 1e5}, {0.6, 0.16, 0}, {2.5, 0, 5e4}, {2.5, 0.3, 0},
};

// Between two of its rows at one distance.
static double table_row_pressure(int first, int last, double off)
{
    for (int k = first; k < last; k++)
        if (off < table_rows[k + 1][1])
            return table_rows[k][2] + (off - table_rows[k][1]) *
                                          (table_rows[k + 1][2] - table_rows[k][2]) /
                                          (table_rows[k + 1][1] - table_rows[k][1]);
    return 0;
}

static double table_pressure(const ld_plume *self, double thrust, double distance, double off)
{
    (void)self;
    double near = table_row_pressure(0, 2, off), middle = table_row_pressure(3, 6, off);
    double far = table_row_pressure(7, 8, off), share = distance / 0.6;
    double pressure = near + share * (middle - near);
    if (distance > 0.6)
        pressure = middle + (distance - 0.6) / (2.5 - 0.6) * (far - middle);
    return thrust * pressure;
}

static void ring_in_a_jet_by_a_table(void **state)
{
    (void)state;
    ld_plume tabled = {true, LD_PLUME_TABLE, 0, 0, reference_table(9, 3, table_rows[0]), 2.5};
    v3 axis = v3_scale(1 / sqrt(1 + 2e-3), v3_make(1, 0.04, -0.02));
    plume_ring shapes[] = {{0.06, 0.15}, {0, 0.05}, {0.02, 0.4}};
    for (int n = 0; n < 12; n++) {
        v3 r = v3_make(0.17 * n + 0.01, 7e-3 * n, -3e-3 * n);
        plume_ring one = shapes[n % 3];
        double by_sum[3], now = 2.1e3, greatest = 3e3;
        ring_scene scene = {table_pressure, &tabled,   one.inner,    one.outer, now / greatest, r,
                            axis,           v3_zero(), m3_identity()};
        sum_over_ring(&scene, by_sum);
        plume_load load = plume_on_ring(&tabled, one, (plume_thrust){now, greatest}, r, axis);
        printf("  %.2f m: %.1f N\n", r.x, load.force);
        CHECK_BELOW("table: force, over the sum", load.force / by_sum[0] - 1, 2e-5);
        for (int k = 0; k < 2; k++)
            CHECK_BELOW("table: moment, over force and radius",
                        (load.force * load.at[k] - by_sum[1 + k]) / (by_sum[0] * one.outer), 5e-6);
    }
    free(tabled.pressure.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(impulse_over_the_exit),        cmocka_unit_test(impulse_of_a_round_jet),
        cmocka_unit_test(energy_of_a_ring_hit_aside),   cmocka_unit_test(momentum_is_the_thrust),
        cmocka_unit_test(deflector_takes_the_momentum), cmocka_unit_test(ring_off_the_axis),
        cmocka_unit_test(ring_in_a_jet_by_a_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
