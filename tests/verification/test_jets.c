// The jets of rockets that have left: what they do to a platform, their impulse on a free vehicle,
// and where the rockets are meanwhile.
#include <stdlib.h>

#include "model/model.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "state/stepping/propagator.h"
#include "support/check.h"
#include "support/dense_vehicle.h"
#include "support/fresh_launch.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/bases/mechanism_base.h"

static const double reach = 4, full = 3e3; // [m], [N] at the mouth

static void give_a_jet(ld_model *model)
{
    model->platform.jet = reference_table(2, 2, (double[]){0, full, reach, 0});
    model->platform.jet_scale = 1;
    model->tubes.modes.bending = 2;
    model->tubes.modes.torsion = 1;
}

// ---- the platform

// Rates of the vehicle under a jet at the mouth of a tube beside the launching one, and its power,
// by the independent equations.
static void moves_as_under_a_force_at_the_mouth(void **state)
{
    (void)state;
    ld_model model;
    reference_vehicle(&model, 6);
    give_a_jet(&model);
    fresh_launch launch;
    launcher_input input;
    launcher_output with = {0}, without = {0};
    double y[LD_MAX_STATES];
    ld_error error;
    fresh_launch_make(&launch, &model);
    if (simulation_undeformed(&launch.state, 0, y, &error))
        fail_msg("%s", error.text);
    const launcher_system *launcher = &launch.state.launcher;
    double *orientating = y + launcher->base_at;
    orientating[VEHICLE_W + 1] = 0.3; // turning, one hinge, too
    orientating[VEHICLE_RATE] = -0.2;
    simulation_input(&launch.state, 0, y, &input);
    const v3 at = jets_mouth(&model, 4, 8);
    const ld_layout *layout = &model.tubes.layout;
    v3 by_hand = {model.tubes.length, 3 / layout->columns * layout->pitch,
                  3 % layout->columns * layout->pitch};
    by_hand.y -= 7 / layout->columns * layout->pitch;
    by_hand.z -= 7 % layout->columns * layout->pitch;
    CHECK_BELOW("mouth of tube 4 seen from tube 8 [m]", v3_norm(v3_sub(at, by_hand)), 1e-15);
    launching_phase phase = launch.state.phase;
    assert_int_equal(launcher_evaluate(launcher, &input, &phase, y, &without), LAUNCHING_OK);
    input.jet.force = v3_make(-full, 0, 0);
    input.jet.moment = v3_cross(at, input.jet.force);
    assert_int_equal(launcher_evaluate(launcher, &input, &phase, y, &with), LAUNCHING_OK);
    dense_vehicle vehicle;
    dense_vehicle_output still, pushed;
    const int fired[] = {8};
    dense_vehicle_create(&vehicle, &model, 8, fired, 0);
    dense_vehicle_input on = {.orientating = orientating,
                              .marching = orientating + mechanism_base_marching_at(&launcher->base),
                              .tube_force = with.launching.base_force,
                              .tube_moment = with.launching.base_moment};
    assert_true(dense_vehicle_evaluate(&vehicle, &on, &still));
    on.jet = full;
    on.jet_at = at;
    assert_true(dense_vehicle_evaluate(&vehicle, &on, &pushed));
    double worst = 0, most = 0;
    for (int i = VEHICLE_V; i < VEHICLE_RATE + HINGES; i++) {
        double change = pushed.orientating[i] - still.orientating[i];
        double found = with.base.rate[i] - without.base.rate[i];
        worst = fmax(worst, fabs(found - change));
        most = fmax(most, fabs(change));
    }
    printf("    greatest change of an acceleration %.3g\n", most);
    CHECK_BELOW("changes of the accelerations, relative", worst / most, 1e-9);
    CHECK_BELOW("power [W], relative",
                with.base.power[VEHICLE_JET] / (pushed.power - still.power) - 1, 1e-9);
    CHECK_BELOW("force told [N]", with.base.report.jet - full, 0);
    dense_vehicle_free(&vehicle);
    fresh_launch_free(&launch);
    reference_model_free(&model);
}

// ---- impulse

// Tyres that hold the vehicle up and nothing else.
static void set_free(ld_model *model)
{
    ld_vehicle *vehicle = &model->base.vehicle;
    vehicle->tyre.stiffness[0] = vehicle->tyre.stiffness[2] = 1e-9;
    vehicle->tyre.damping[0] = vehicle->tyre.damping[2] = 0;
    vehicle->drive = (ld_drive){1e-9, 0};
}

// Momentum [kg m/s] of everything along x of I: kinetic energy is a quadratic form of the speeds,
// to which a common one is added.
static double momentum_of(const launch_state *self, double t, const double *y)
{
    const launcher_system *launcher = &self->launcher;
    const launching_layout *at = &launcher->launching.layout;
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    double energy[2];
    for (int side = 0; side < 2; side++) {
        double moved[LD_MAX_STATES], u = side ? 1 : -1;
        launcher_input input;
        memcpy(moved, y, (size_t)launcher->state_count * sizeof *y);
        v3 along = m3_apply_transposed(A_IR, v3_make(u, 0, 0));
        v3_store(moved + at->v, v3_add(v3_from(moved + at->v), along));
        moved[launcher->base_at + VEHICLE_V] += u;
        double *wheel = moved + launcher->base_at + mechanism_base_marching_at(&launcher->base);
        for (int i = 0; i < self->model->base.vehicle.wheel_count; i++)
            wheel[WHEEL_STATES * i + WHEEL_V] += u;
        simulation_input(self, t, moved, &input);
        energy[side] = launcher_kinetic_energy(launcher, &input, &self->phase, moved);
    }
    return 0.5 * (energy[1] - energy[0]);
}

// A course straight ahead at 60 m/s, of which the place at t is known.
static v3 course_at(v3 from, v3 along, double t)
{
    return v3_axpy(from, 60 * t + 0.02, along);
}

// The jet's force along x of I, by hand.
static double force_at(const launch_state *self, double t, const double *y, v3 from, v3 along)
{
    base_frame tube;
    base_found unused;
    const base_system *base = &self->launcher.base;
    base->kind->find_frame(base, t, y + self->launcher.base_at, &tube, &unused);
    v3 mouth = v3_add(tube.r, v3_scale(self->model->tubes.length, m3_column(tube.A, 0)));
    double distance = v3_norm(v3_sub(course_at(from, along, t), mouth));
    return -full * (1 - distance / reach) * m3_column(tube.A, 0).x;
}

// No rocket in the tube; the momentum along the road against the integral of the force over each
// step of the integrator, by Boole's rule.
static void impulse_on_a_free_vehicle(void **state)
{
    (void)state;
    enum { PLACES = 52 };
    const double end = 0.05;
    ld_model model;
    reference_vehicle(&model, 5);
    give_a_jet(&model);
    set_free(&model);
    model.run.tolerance = 1e-11;
    model.run.max_step = 1e-3;
    fresh_launch launch;
    double y[LD_MAX_STATES], between[LD_MAX_STATES];
    ld_error error;
    fresh_launch_make(&launch, &model);
    launch_state *self = &launch.state;
    if (simulation_undeformed(self, 0, y, &error))
        fail_msg("%s", error.text);
    simulation_move_with_base(self, 0, y);
    self->phase.rocket = false;
    launcher_input input;
    simulation_input(self, 0, y, &input);
    v3 along = m3_column(input.launching.base.A, 0);
    v3 from = v3_axpy(input.launching.base.r, model.tubes.length, along);
    jet *one = &self->jets.of[0];
    *one = (jet){.flight = simulation_flight(launch.simulation, 0),
                 .t_ignition = -0.2,
                 .piece = 1,
                 .tube = 8,
                 .count = PLACES,
                 .place = calloc(PLACES, sizeof *one->place)};
    for (int i = 0; i < PLACES; i++)
        one->place[i] =
            (jet_pose){1e-3 * i, course_at(from, along, 1e-3 * i), v3_scale(60, along), along};
    self->jets.count = 1;
    propagator *stepper = NULL;
    if (propagator_create(self, false, &stepper, &error) ||
        propagator_start(stepper, 0, y, true, &error))
        fail_msg("%s", error.text);
    double before = momentum_of(self, 0, y), impulse = 0, worst = 0, t = 0;
    while (t < end) {
        assert_true(propagator_step(stepper, end, &error) != INTEGRATOR_FAILED);
        double next = propagator_time(stepper);
        const double weight[5] = {7, 32, 12, 32, 7};
        for (int i = 0; i < 5; i++) {
            double at = t + 0.25 * i * (next - t);
            propagator_interpolate(stepper, at, between);
            impulse += weight[i] / 90 * (next - t) * force_at(self, at, between, from, along);
        }
        t = next;
        double change = momentum_of(self, t, propagator_state(stepper)) - before;
        worst = fmax(worst, fabs(change - impulse));
    }
    const double *last = propagator_state(stepper);
    printf("    impulse %.6f N s, %lld steps\n", impulse, (long long)propagator_steps(stepper));
    CHECK_WITHIN("impulse [N s]", impulse, -95, -85);
    CHECK_BELOW("momentum less impulse, relative", worst / fabs(impulse), 1e-9);
    const launcher_output *out = simulation_output(self, t, last);
    simulation_input(self, t, last, &input);
    double told = -out->base.report.jet * m3_column(input.launching.base.A, 0).x;
    jet_wrench beside = jets_at(&self->jets, t, &input.launching.base, 4);
    v3 moment = v3_cross(jets_mouth(&model, 8, 4), beside.force);
    CHECK_WITHIN("moment seen from another tube [N m]", v3_norm(moment), 50, 1000);
    CHECK_BELOW("the same by jets_at [N m]", v3_norm(v3_sub(beside.moment, moment)), 1e-12);
    CHECK_BELOW("force told, relative", told / force_at(self, t, last, from, along) - 1, 1e-12);
    propagator_free(stepper);
    fresh_launch_free(&launch);
    reference_model_free(&model);
}

// ---- a sequence

enum { MOST_ROWS = 4000, ROW = 9, FLIGHT_ROW = 7 };

// Rows of the launch and of the flights: t, base (place, angles), force; t, O1, its velocity.
typedef struct watched {
    int columns[ROW], flight_columns[FLIGHT_ROW];
    int flights, rows, flown[2];
    double row[MOST_ROWS][ROW], flight[2][MOST_ROWS][FLIGHT_ROW];
} watched;

static int column_of(const ld_column *columns, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(columns[i].name, name) == 0)
            return (int)i;
    fail_msg("no column %s", name);
    return 0;
}

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    static const char *const names[ROW] = {"t",         "base.x",    "base.y",
                                           "base.z",    "base.yaw",  "base.pitch",
                                           "base.roll", "jet.force", "work.jet"};
    (void)error;
    for (int i = 0; i < ROW; i++)
        ((watched *)self)->columns[i] = column_of(columns, count, names[i]);
    return LD_OK;
}

static ld_status begin_flight(void *self, int rocket, const ld_column *columns, size_t count,
                              ld_error *error)
{
    static const char *const names[FLIGHT_ROW] = {"t",         "rocket.x",  "rocket.y", "rocket.z",
                                                  "rocket.vx", "rocket.vy", "rocket.vz"};
    (void)error;
    for (int i = 0; i < FLIGHT_ROW; i++)
        ((watched *)self)->flight_columns[i] = column_of(columns, count, names[i]);
    ((watched *)self)->flights = rocket;
    return LD_OK;
}

static ld_status row(void *user, const double *values, size_t count, ld_error *error)
{
    watched *self = user;
    (void)count, (void)error;
    if (self->flights == 0) {
        assert_true(self->rows < MOST_ROWS);
        for (int i = 0; i < ROW; i++)
            self->row[self->rows][i] = values[self->columns[i]];
        self->rows++;
        return LD_OK;
    }
    int *flown = &self->flown[self->flights - 1];
    for (int i = 0; i < FLIGHT_ROW && *flown < MOST_ROWS; i++)
        self->flight[self->flights - 1][*flown][i] = values[self->flight_columns[i]];
    *flown += *flown < MOST_ROWS;
    return LD_OK;
}

// O1 of flight i at t: cubic between its rows; false where it has none there.
static bool find_rocket(const watched *self, int i, double t, v3 *place)
{
    for (int k = 1; k < self->flown[i]; k++) {
        const double *a = self->flight[i][k - 1], *b = self->flight[i][k];
        double h = b[0] - a[0], x = (t - a[0]) / h;
        if (t < a[0] || t > b[0])
            continue;
        v3 r = v3_scale((1 + 2 * x) * (1 - x) * (1 - x), v3_from(a + 1));
        r = v3_axpy(r, x * (1 - x) * (1 - x) * h, v3_from(a + 4));
        r = v3_axpy(r, x * x * (3 - 2 * x), v3_from(b + 1));
        *place = v3_axpy(r, -x * x * (1 - x) * h, v3_from(b + 4));
        return true;
    }
    return false;
}

// Thrust [N] of the model's motor, between whose corners the rows lie.
static double thrust_at(const ld_model *model, double since)
{
    const double *p = model->rocket.motor.thrust.data;
    for (size_t i = 0; i + 1 < model->rocket.motor.thrust.rows; i++, p += 2)
        if (since >= p[0] && since < p[2])
            return p[1] + (p[3] - p[1]) * (since - p[0]) / (p[2] - p[0]);
    return 0;
}

static ld_summary watch(const ld_model *model, watched *seen)
{
    ld_simulation *simulation;
    ld_summary summary = {0};
    ld_error error;
    ld_sink sink = {.self = seen, .begin = begin, .row = row, .flight = begin_flight};
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, &(ld_run_options){.sink = &sink}, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary;
}

// Two rockets, one soon after the other; the first one's thrust falls while it is near.
static void make_sequence(ld_model *model)
{
    reference_vehicle(model, 5);
    give_a_jet(model);
    double *thrust = model->rocket.motor.thrust.data;
    thrust[4] = 0.175;
    thrust[6] = 0.22;
    thrust[3] = thrust[5] = 16e3;
    model->firing_count = 2;
    model->firing[0] = (ld_firing){8, 0};
    model->firing[1] = (ld_firing){11, 0.3};
    model->run.end = LD_END_TIME;
    model->run.end_time = 0.3;
    model->run.lead_in = 0;
    model->run.output_step_flight = 1e-3;
    model->run.flight_tolerance = 1e-11;
    model->run.output_step_lead_in = model->run.output_step_tube = 1e-3;
    model->run.tolerance = 1e-9;
}

static void rockets_in_sequence(void **state)
{
    (void)state;
    ld_model model;
    make_sequence(&model);
    watched *seen = calloc(1, sizeof *seen);
    ld_summary summary = watch(&model, seen);
    const double out[2] = {summary.rocket[0].t_rear, 0.3 + summary.rocket[1].t_rear};
    double worst = 0, greatest = 0;
    int felt[2] = {0};
    printf("    out at %.4f and %.4f s\n", out[0], out[1]);
    // the tube of the second takes its position as soon as the first one is out
    for (int k = 0; k < seen->rows; k++) {
        const double *now = seen->row[k];
        double t = now[0], expected = 0;
        if (fmin(fabs(t - out[0]), fabs(t - out[1])) < 1e-9)
            continue; // before the exit or after it
        m3 A = m3_mul(m3_rotation_y(now[4]), m3_mul(m3_rotation_z(now[5]), m3_rotation_x(now[6])));
        for (int i = 0; i < 2; i++) {
            v3 place;
            if (t < out[i] || !find_rocket(seen, i, t, &place))
                continue;
            v3 mouth = jets_mouth(&model, model.firing[i].tube, 11);
            mouth = v3_add(v3_from(now + 1), m3_apply(A, mouth));
            double distance = v3_norm(v3_sub(place, mouth));
            double thrust = thrust_at(&model, t - model.firing[i].at);
            double force = distance < reach ? full * (1 - distance / reach) * thrust / 16e3 : 0;
            felt[i] += force > 0;
            expected += force;
        }
        worst = fmax(worst, fabs(now[7] - expected));
        greatest = fmax(greatest, now[7]);
    }
    printf("    %d and %d rows under their jets\n", felt[0], felt[1]);
    assert_true(felt[0] > 30 && felt[1] > 30);
    CHECK_BELOW("force of the jets, relative", worst / greatest, 1e-7);
    CHECK_BELOW("energy balance, relative", summary.energy.residual_relative, 1e-9);
    CHECK_BELOW("work of the jets told [J]",
                summary.energy.work[POWER_COUNT + VEHICLE_JET] - seen->row[seen->rows - 1][8], 0);
    free(seen);
    reference_model_free(&model);
}

// The subsystems apart: the platform has continued to the next exchange, up to 0.1 ms, when a
// rocket leaves.
static void subsystems_apart(void **state)
{
    (void)state;
    ld_model model;
    make_sequence(&model);
    model.run.tolerance = 1e-7;
    ld_summary together = summary_of_run(&model);
    model.run.coupling_step = 1e-4;
    ld_summary apart = summary_of_run(&model);
    double work[2] = {together.energy.work[POWER_COUNT + VEHICLE_JET],
                      apart.energy.work[POWER_COUNT + VEHICLE_JET]};
    printf("    work of the jets %.6f and %.6f J\n", work[0], work[1]);
    CHECK_BELOW("work of the jets, relative", work[1] / work[0] - 1, 3e-3);
    CHECK_BELOW("energy balance apart, relative", apart.energy.residual_relative, 1e-4);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moves_as_under_a_force_at_the_mouth),
        cmocka_unit_test(impulse_on_a_free_vehicle),
        cmocka_unit_test(rockets_in_sequence),
        cmocka_unit_test(subsystems_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
