// Marching and orientating subsystems, coupled, against the independent vehicle
// (support/dense_vehicle.h) on random states of random vehicles: every rate of the state, every
// tyre and hinge force.
#include "support/check.h"

#include "support/vehicle_bodies.h"
#include "support/vehicle_case.h"

enum { VEHICLES = 48, STATES = 21 }; // 1,008 states

// What the states went through; a mode that none is in would not be tested.
typedef struct coverage {
    int states, parked, in_air, sliding, limited, wound_up, locked, rough;
    int held, lagging, slewing, pressed, free;
} coverage;

typedef struct differences {
    double platforms, wheels, rate, tyre, hinge, drive, frame;
} differences;

typedef struct fast_vehicle {
    marching_system marching;
    vehicle_bodies orientating;
} fast_vehicle;

static void build(fast_vehicle *fast, const ld_model *model, int launching, const int *fired,
                  int count)
{
    ld_error error;
    if (marching_build(&fast->marching, &model->base.vehicle, model->gravity, (double[]){-10, 10},
                       NULL, &error) ||
        vehicle_bodies_build(&fast->orientating, model, launching, fired, count, &error))
        fail_msg("%s", error.text);
}

static double differ(double a, double b, double size)
{
    double d = fabs(a - b) / size;
    return isnan(d) ? INFINITY : d;
}

// Largest difference of n numbers over the largest of them.
static double differ_all(int n, const double *a, const double *b)
{
    double size = 0, worst = 0;
    for (int i = 0; i < n; i++)
        size = fmax(size, fabs(b[i]));
    for (int i = 0; i < n && size > 0; i++)
        worst = fmax(worst, differ(a[i], b[i], size));
    return worst;
}

// Accelerations of chassis and hinges, those of the wheels, and all kinematic rates together.
static void compare_rates(int wheels, const double *orientating, const double *marching,
                          const dense_vehicle_output *dense, differences *worst)
{
    enum { MOST = 9 + 5 * LD_MAX_WHEELS };
    double acceleration[2][MOST], rate[2][MOST];
    const double *rates[2][2] = {{orientating, marching}, {dense->orientating, dense->marching}};
    for (int side = 0; side < 2; side++) {
        memcpy(rate[side], rates[side][0], 9 * sizeof(double));
        for (int i = 0; i < wheels; i++) {
            const double *wheel = rates[side][1] + WHEEL_STATES * i;
            memcpy(&acceleration[side][3 * i], wheel + WHEEL_V, 3 * sizeof(double));
            memcpy(&rate[side][9 + 5 * i], wheel, 3 * sizeof(double));
            memcpy(&rate[side][12 + 5 * i], wheel + WHEEL_ETA, 2 * sizeof(double));
        }
    }
    int last = WHEEL_STATES * wheels;
    worst->platforms = fmax(worst->platforms,
                            differ_all(8, orientating + VEHICLE_V, dense->orientating + VEHICLE_V));
    worst->wheels = fmax(worst->wheels, differ_all(3 * wheels, acceleration[0], acceleration[1]));
    worst->rate = fmax(worst->rate, differ_all(9 + 5 * wheels, rate[0], rate[1]));
    worst->rate = fmax(worst->rate, differ(marching[last], dense->marching[last], 1));
}

static void compare_tyres(const ld_vehicle *model, const marching_output *output,
                          const dense_vehicle_output *dense, differences *worst, coverage *seen)
{
    for (int i = 0; i < model->wheel_count; i++) {
        const wheel_report *report = &output->wheel[i];
        double force[2][3] = {
            {report->normal, report->along, report->side},
            {dense->wheel[i].normal, dense->wheel[i].along, dense->wheel[i].side}};
        double travel[2][4] = {{report->deflection}, {dense->wheel[i].deflection}};
        v3_store(travel[0] + 1, report->travel);
        v3_store(travel[1] + 1, dense->wheel[i].travel);
        worst->tyre = fmax(worst->tyre, differ_all(3, force[0], force[1]));
        worst->tyre = fmax(worst->tyre, differ_all(4, travel[0], travel[1]));
        double held = hypot(report->along, report->side);
        seen->in_air += report->normal == 0;
        seen->sliding += held > 0.7 * model->tyre.friction * report->normal;
        seen->rough += report->slope != 0;
    }
}

// Sums of an angle, a rate and an integral, measured in what each may reach.
static void compare_hinges(const ld_model *model, const vehicle_motion *motion,
                           const double *orientating, const dense_vehicle_output *dense,
                           differences *worst, coverage *seen)
{
    const ld_turret *turret[HINGES] = {&model->platform.azimuth, &model->platform.elevation};
    for (int i = 0; i < HINGES; i++) {
        const hinge_report *report = &motion->hinge[i];
        double limit = turret[i]->stabiliser.torque_limit, z_dot = orientating[VEHICLE_Z + i];
        double pair[5][3] = {{report->torque, dense->hinge[i].torque, limit},
                             {report->friction, dense->hinge[i].friction, limit},
                             {report->measured, dense->hinge[i].measured, 1},
                             {report->measured_rate, dense->hinge[i].measured_rate, 1},
                             {z_dot, dense->orientating[VEHICLE_Z + i], turret[i]->stabiliser.ki}};
        for (int k = 0; k < 5; k++)
            worst->hinge = fmax(worst->hinge, differ(pair[k][0], pair[k][1], pair[k][2]));
        seen->limited += report->limited;
        seen->locked += turret[i]->lock.present;
        seen->wound_up += z_dot == 0;
    }
}

// Rates of lags, gears and motors, measured in the greatest that each may have; where the program
// has no drives, the independent vehicle's are still.
static void compare_drives(const ld_model *model, bool linear, const double *state,
                           const double *orientating, const dense_vehicle_output *dense,
                           differences *worst, coverage *seen)
{
    const ld_turret *turret[HINGES] = {&model->platform.azimuth, &model->platform.elevation};
    for (int i = 0; i < HINGES; i++) {
        const ld_stabiliser *s = &turret[i]->stabiliser;
        int at = VEHICLE_DRIVE + DRIVE_STATES * i;
        const double *own = orientating + at, *other = dense->orientating + at;
        double motor = s->gear.present ? s->torque_limit / s->gear.inertia : 1;
        double size[DRIVE_STATES] = {s->torque_limit * fmax(s->bandwidth, 1), 1, 1, 1, motor};
        if (turret[i]->lock.present)
            continue;
        for (int k = 0; k < DRIVE_STATES; k++)
            worst->drive = fmax(worst->drive, differ(own[k], other[k], size[k]));
        seen->held += s->sample > 0 && !linear;
        seen->lagging += own[DRIVE_TORQUE] != 0;
        seen->slewing += s->slew > 0 && fabs(own[DRIVE_TORQUE]) == s->slew;
        if (s->gear.present && s->gear.backlash > 0 && !linear) {
            bool touch = 2 * fabs(state[at + DRIVE_TWIST]) > s->gear.backlash;
            seen->pressed += touch;
            seen->free += !touch;
        }
    }
}

static void compare(fast_vehicle *fast, const dense_vehicle *vehicle, const vehicle_case *c,
                    differences *worst, coverage *seen)
{
    const ld_model *model = vehicle->model;
    // the program's two subsystems
    vehicle_motion motion;
    marching_output wheel_forces;
    vehicle_output hinge_forces;
    double marching[DENSE_MARCHING_STATES], orientating[VEHICLE_MOST_BODY_STATES] = {0};
    vehicle_bodies_move(&fast->orientating, c->t, c->orientating, &motion);
    marching_evaluate(&fast->marching, &motion.chassis, false, NULL, c->marching, marching,
                      &wheel_forces);
    vehicle_input input = {.chassis_force = wheel_forces.force,
                           .chassis_moment = wheel_forces.moment,
                           .tube_force = c->tube_force,
                           .tube_moment = c->tube_moment,
                           .linear = c->frictionless};
    memcpy(input.rest, c->rest, sizeof input.rest);
    assert_int_equal(vehicle_bodies_evaluate(&fast->orientating, &input, c->orientating, &motion,
                                             orientating, &hinge_forces),
                     0);
    // the independent one
    dense_vehicle_output dense;
    dense_vehicle_input dense_input = dense_input_of(c);
    assert_true(dense_vehicle_evaluate(vehicle, &dense_input, &dense));
    compare_rates(model->base.vehicle.wheel_count, orientating, marching, &dense, worst);
    compare_tyres(&model->base.vehicle, &wheel_forces, &dense, worst, seen);
    compare_hinges(model, &motion, orientating, &dense, worst, seen);
    compare_drives(model, c->frictionless, c->orientating, orientating, &dense, worst, seen);
    worst->frame = fmax(worst->frame, v3_norm(v3_sub(motion.tube.r, dense.tube.r)));
    worst->frame = fmax(worst->frame, v3_norm(v3_sub(motion.tube.v, dense.tube.v)));
    worst->frame = fmax(worst->frame, v3_norm(v3_sub(motion.tube.w, dense.tube.w)));
    worst->frame = fmax(worst->frame, differ_all(9, motion.tube.A.a[0], dense.tube.A.a[0]));
    seen->states++;
    seen->parked += model->base.vehicle.speed == 0;
}

static void random_states_of_random_vehicles(void **state)
{
    const ld_formulation *formulation = *state;
    uint64_t seed = 20261121;
    differences worst = {0};
    coverage seen = {0};
    for (int kind = 0; kind < VEHICLES; kind++) {
        ld_model model;
        dense_vehicle vehicle;
        fast_vehicle fast;
        const int fired[2] = {1, 5};
        draw_vehicle(&seed, kind, &model);
        model.run.formulation = *formulation;
        int launching = 1 + kind % 18;
        dense_vehicle_create(&vehicle, &model, launching, fired, kind % 3);
        build(&fast, &model, launching, fired, kind % 3);
        for (int n = 0; n < STATES; n++) {
            vehicle_case c;
            draw_vehicle_state(&seed, &model, &c);
            compare(&fast, &vehicle, &c, &worst, &seen);
        }
        marching_free(&fast.marching);
        vehicle_bodies_free(&fast.orientating);
        dense_vehicle_free(&vehicle);
        reference_model_free(&model);
    }
    printf("    drives: %d digital, %d lagging, %d at their slew limit, teeth of %d pressed, %d "
           "free\n",
           seen.held, seen.lagging, seen.slewing, seen.pressed, seen.free);
    printf("    %d states, %d parked; wheels: %d in the air, %d near the friction limit, %d on "
           "slopes;\n    hinges: %d at the limit, %d locked, %d with a still integral\n",
           seen.states, seen.parked, seen.in_air, seen.sliding, seen.rough, seen.limited,
           seen.locked, seen.wound_up);
    assert_true(seen.states > 1000 && seen.parked > 100 && seen.in_air > 100 &&
                seen.sliding > 100 && seen.rough > 100 && seen.limited > 100 && seen.locked > 100 &&
                seen.wound_up > seen.locked);
    assert_true(seen.held > 100 && seen.lagging > 100 && seen.slewing > 100 && seen.pressed > 100 &&
                seen.free > 50);
    CHECK_BELOW("accelerations of chassis and hinges, of the largest", worst.platforms, 1e-13);
    CHECK_BELOW("accelerations of the wheels, of the largest", worst.wheels, 1e-13);
    CHECK_BELOW("other rates, of the largest", worst.rate, 3e-14);
    CHECK_BELOW("tyre forces and deflections, of the largest", worst.tyre, 2e-13);
    CHECK_BELOW("hinge torques and integrals [of their limits], angles", worst.hinge, 2e-13);
    CHECK_BELOW("rates of drives, of the largest", worst.drive, 1e-12);
    CHECK_BELOW("tube's frame [m, m/s, rad/s]", worst.frame, 3e-14);
}

int main(void)
{
    static ld_formulation reduced = LD_FORMULATION_REDUCED, overall = LD_FORMULATION_OVERALL;
    const struct CMUnitTest tests[] = {
        {"reduced form", random_states_of_random_vehicles, NULL, NULL, &reduced},
        {"overall form", random_states_of_random_vehicles, NULL, NULL, &overall},
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
