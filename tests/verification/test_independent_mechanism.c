// Bases of bodies, joints, loops and force elements against the independent mechanism
// (support/dense_mechanism.h) on random states of random ones: every rate of the state, every
// power, what is reported of joints, drives, struts, bushings, feet and wheels.
#include "support/check.h"

#include <stdlib.h>

#include "model/model.h"
#include "support/mechanism_case.h"
#include "support/reference_model.h"
#include "systems/bases/mechanism_base.h"
#include "systems/mechanism/mechanism_loops.h"

static const double TWO_PI = 6.283185307179586476925;

// What the states went through; a mode that none is in would not be tested.
typedef struct coverage {
    int mechanisms, states, loops, redundant, carried;
    int tree[LD_JOINT_FREE + 1], loop[LD_JOINT_FREE + 1];
    int down, lifted, sliding, free_play, stopped, beyond, locked_later, holds, limited, digital,
        lagging, geared, actuators, wheels, off_road, windy;
} coverage;

typedef struct differences {
    double speeds, coordinates, states, power, carrying, elastic, kinetic, frame, reports, loads,
        joints, closure, consistency;
} differences;

static double differ(double a, double b, double size)
{
    double d = fabs(a - b) / size;
    return isnan(d) ? INFINITY : d;
}

static double largest(int n, const double *a)
{
    double size = 0;
    for (int i = 0; i < n; i++)
        size = fmax(size, fabs(a[i]));
    return size;
}

// Largest difference of n numbers over the largest of them, or over `least`.
static double differ_all(int n, const double *a, const double *b, double least)
{
    double size = fmax(largest(n, b), least), worst = 0;
    for (int i = 0; i < n; i++)
        worst = fmax(worst, differ(a[i], b[i], size));
    return worst;
}

static void note(double *worst, double value)
{
    *worst = fmax(*worst, value);
}

static void compare_rates(const dense_mechanism *dense, const double *rate, const double *other,
                          differences *worst)
{
    int q = dense->q_count, z = dense->z_at, wheels = dense->model->base.vehicle.wheel_count;
    note(&worst->speeds, differ_all(dense->u_count, rate + q, other + q, 1));
    note(&worst->coordinates, differ_all(q, rate, other, 1));
    // integrals, drives; what is remembered of locks and feet
    for (int i = z; i < dense->wheels_at; i++)
        note(&worst->states, differ(rate[i], other[i], fmax(1, fabs(other[i]))));
    rate += dense->wheels_at;
    other += dense->wheels_at;
    if (wheels > 0)
        note(&worst->states, differ_all(WHEEL_STATES * wheels + 1, rate, other, 1));
}

static double differ_v3(v3 a, v3 b, double size)
{
    return differ(0, v3_norm(v3_sub(a, b)), size);
}

static void compare_reports(const dense_mechanism *dense, const base_report *report,
                            const dense_mechanism_output *out, differences *worst)
{
    const ld_mechanism *given = dense->given;
    const mechanism_report *own = &report->mechanism.report;
    for (int i = 0; i < dense->hold_count; i++) {
        const hinge_report *a = &own->hold[i], *b = &out->hold[i];
        double pair[][2] = {{a->angle, b->angle},
                            {a->rate, b->rate},
                            {a->base_rate, b->base_rate},
                            {a->measured, b->measured},
                            {a->measured_rate, b->measured_rate},
                            {a->command, b->command},
                            {a->command_rate, b->command_rate},
                            {a->error, b->error},
                            {a->torque, b->torque}};
        for (int k = 0; k < 9; k++)
            note(&worst->reports, differ(pair[k][0], pair[k][1], fmax(1, fabs(pair[k][1]))));
    }
    for (int i = 0; i < given->foot_count; i++) {
        const foot_report *a = &own->foot[i], *b = &out->foot[i];
        note(&worst->reports, differ(a->deflection, b->deflection, 1));
        note(&worst->reports, differ(a->normal, b->normal, fmax(1, b->normal)));
        note(&worst->reports, differ_v3(a->force, b->force, fmax(1, b->normal)));
    }
    for (int i = 0; i < given->strut_count; i++) {
        const strut_report *a = &own->strut[i], *b = &out->strut[i];
        note(&worst->reports, differ(a->length, b->length, 1));
        note(&worst->reports, differ(a->rate, b->rate, 1));
        note(&worst->reports, differ(a->force, b->force, fmax(1, fabs(b->force))));
    }
    for (int i = 0; i < given->bushing_count; i++)
        note(&worst->reports,
             differ_v3(own->bushing[i], out->bushing[i], fmax(1, v3_norm(out->bushing[i]))));
    for (int i = 0; i < given->joint_count; i++)
        note(&worst->reports,
             differ(own->friction[i], out->friction[i], fmax(1, fabs(out->friction[i]))));
    for (int j = 0; j < dense->model->base.vehicle.wheel_count; j++) {
        const wheel_report *wheel = &report->marching.wheel[j];
        double normal = fmax(1, out->wheel[j].normal);
        note(&worst->reports, differ(wheel->deflection, out->wheel[j].deflection, 1));
        note(&worst->reports, differ(wheel->normal, out->wheel[j].normal, normal));
        note(&worst->reports, differ(wheel->along, out->wheel[j].along, normal));
        note(&worst->reports, differ(wheel->side, out->wheel[j].side, normal));
    }
}

// What joints transmit, where constraints determine it, and how they stand.
static void compare_joints(const mechanism_system *own, const mechanism_motion *motion,
                           const base_output *output, const dense_mechanism_output *out,
                           differences *worst)
{
    joint_load load[LD_MAX_JOINTS];
    const ld_mechanism *given = own->given;
    double size = 1;
    mechanism_joint_loads(own, motion, output->rate, &output->report.mechanism, load);
    for (int i = 0; i < given->joint_count; i++)
        size = fmax(size, fmax(v3_norm(out->joint[i].force), v3_norm(out->joint[i].moment)));
    for (int i = 0; i < given->joint_count; i++) {
        bool turns = given->joint[i].kind == LD_JOINT_REVOLUTE;
        double x[JOINT_MOST_COORDINATES], rate[JOINT_MOST_SPEEDS];
        if (out->redundant == 0) {
            note(&worst->loads, differ_v3(load[i].force, out->joint[i].force, size));
            note(&worst->loads, differ_v3(load[i].moment, out->joint[i].moment, size));
        }
        if (!turns && given->joint[i].kind != LD_JOINT_PRISMATIC)
            continue;
        mechanism_joint_state(own, motion, i, x, rate);
        double apart = x[0] - out->joint[i].position[turns];
        note(&worst->joints, differ(0, turns ? remainder(apart, TWO_PI) : apart, 1));
        note(&worst->joints, differ(rate[0], out->joint[i].rate[turns], 1));
    }
}

static void count_feet(const ld_mechanism *given, const dense_mechanism_output *out, coverage *seen)
{
    for (int i = 0; i < given->foot_count; i++) {
        const foot_report *foot = &out->foot[i];
        double along = hypot(foot->force.x, foot->force.z);
        seen->down += foot->normal > 0;
        seen->lifted += foot->deflection <= 0;
        seen->sliding += foot->normal > 0 && along > 0.9 * given->foot[i].friction * foot->normal;
    }
}

static void count_holds(const dense_mechanism *dense, const mechanism_case *c, coverage *seen)
{
    const ld_mechanism *given = dense->given;
    for (int i = 0; i < dense->hold_count; i++) {
        const dense_hold *hold = &dense->hold[i];
        seen->holds++;
        seen->actuators += hold->strut >= 0;
        if (hold->drive < 0)
            continue;
        const ld_stabiliser *s = &given->drive[hold->drive].angle;
        if (given->drive[hold->drive].form == LD_DRIVE_LENGTH)
            s = &given->drive[hold->drive].length;
        seen->digital += s->sample > 0 && !c->linear;
        seen->lagging += s->bandwidth > 0;
        seen->geared += s->gear.present;
        seen->limited += fabs(c->state[dense->z_at + i]) > s->torque_limit;
    }
}

static void count(const dense_mechanism *dense, const mechanism_case *c,
                  const dense_mechanism_output *out, coverage *seen)
{
    const ld_mechanism *given = dense->given;
    seen->states++;
    seen->redundant += out->redundant > 0;
    seen->windy += given->drag_count > 0 && dense->model->environment.wind.present;
    count_feet(given, out, seen);
    count_holds(dense, c, seen);
    for (int i = 0; i < given->joint_count; i++) {
        const ld_joint *joint = &given->joint[i];
        bool turns = joint->kind == LD_JOINT_REVOLUTE;
        double x = out->joint[i].position[turns];
        ++*(dense->closes[i] ? &seen->loop[joint->kind] : &seen->tree[joint->kind]);
        seen->beyond += joint->stops.present && (x > joint->stops.high || x < joint->stops.low);
        seen->locked_later += dense->later_at[i] >= 0 && c->t >= joint->lock.from;
        seen->carried += strcmp(joint->parent, "carrier") == 0;
    }
    for (int i = 0; i < given->bushing_count; i++) {
        const double f[3] = {out->bushing[i].x, out->bushing[i].y, out->bushing[i].z};
        for (int k = 0; k < 3; k++) {
            seen->free_play += given->bushing[i].clearance[k] > 0 && f[k] == 0;
            seen->stopped += fabs(f[k]) > 5e3;
        }
    }
    for (int j = 0; j < dense->model->base.vehicle.wheel_count; j++) {
        seen->wheels++;
        seen->off_road += out->wheel[j].normal == 0;
    }
}

static void compare(const base_system *base, const dense_mechanism *dense, mechanism_case *c,
                    differences *worst, coverage *seen)
{
    static base_output own;
    static dense_mechanism_output out;
    base_frame tube;
    base_found found;
    base_load load = {
        .force = c->tube_force, .moment = c->tube_moment, .rest = c->rest, .linear = c->linear};
    base->kind->find_frame(base, c->t, c->state, &tube, &found);
    assert_int_equal(base->kind->dynamics->evaluate(base, &found, &load, c->state, &own), 0);
    double kinetic = base->kind->dynamics->kinetic_energy(base, &found, c->state);
    dense_mechanism_input input = {.t = c->t,
                                   .state = c->state,
                                   .carrier = &found.mechanism.carrier,
                                   .tube_force = c->tube_force,
                                   .tube_moment = c->tube_moment,
                                   .rest = c->rest.hold,
                                   .linear = c->linear};
    assert_true(dense_mechanism_evaluate(dense, &input, &out));
    assert_int_equal(base->state_count, dense->state_count);
    compare_rates(dense, own.rate, out.rate, worst);
    double size = fmax(1, largest(MULTIBODY_POWERS, out.power));
    for (int k = 0; k < base->work_count; k++)
        note(k == MECHANISM_CARRYING ? &worst->carrying : &worst->power,
             differ(own.power[k], out.power[k], size));
    note(&worst->elastic, differ(own.elastic, out.elastic, fmax(1, fabs(out.elastic))));
    note(&worst->kinetic, differ(kinetic, out.kinetic, out.kinetic));
    note(&worst->frame, differ_v3(tube.r, out.tube.r, 1));
    note(&worst->frame, differ_v3(tube.v, out.tube.v, 1));
    note(&worst->frame, differ_v3(tube.w, out.tube.w, 1));
    note(&worst->frame, differ_all(9, tube.A.a[0], out.tube.A.a[0], 1));
    compare_reports(dense, &own.report, &out, worst);
    compare_joints(mechanism_of(base), &found.mechanism, &own, &out, worst);
    note(&worst->closure, out.open);
    note(&worst->consistency,
         out.inconsistent / fmax(1, largest(dense->u_count, out.rate + dense->q_count)));
    count(dense, c, &out, seen);
}

static void compare_mechanism(uint64_t *seed, int kind, const mechanism_options *options,
                              differences *worst, coverage *seen)
{
    enum { STATES = 12 };
    ld_model model;
    ld_error error;
    base_system base;
    dense_mechanism dense;
    mechanism_case c;
    double start[BASE_MOST_STATES];
    draw_mechanism(seed, kind, options, &model);
    if (base_build(&base, &model, NULL, &error))
        fail_msg("mechanism %d: %s", kind, error.text);
    dense_mechanism_create(&dense, &model, model.firing[0].tube, NULL, 0);
    dense_mechanism_start(&dense, start);
    base_frame carrier = mechanism_base_carrier(&base, 0);
    const mechanism_base *own = base.own;
    if (mechanism_assemble(&own->of_tube[0], &carrier, start, &error))
        fail_msg("mechanism %d: %s", kind, error.text);
    dense_mechanism_begin(&dense, &carrier, start);
    for (int n = 0; n < STATES; n++)
        if (draw_mechanism_state(seed, &dense, &model, &base, &c))
            compare(&base, &dense, &c, worst, seen);
    seen->mechanisms++;
    seen->loops += model.base.mechanism.joint_count - model.base.mechanism.body_count;
    base_free(&base);
    reference_model_free(&model);
}

static void random_states_of_random_mechanisms(void **state)
{
    (void)state;
    uint64_t seed = 20261128;
    differences worst = {0};
    coverage seen = {0};
    for (int kind = 0; kind < OF_ALL(96, 12); kind++) {
        mechanism_options options = {.bodies = 2 + kind % 7,
                                     .loops = kind % 3 ? 1 + kind % 4 : 0,
                                     .carrier = kind % 4 == 1,
                                     .wheels = kind % 8 == 3 || kind % 8 == 6,
                                     .elements = kind % 6 != 5,
                                     .whole = kind % 5 == 0,
                                     .flat = kind % 6 == 4};
        compare_mechanism(&seed, kind, &options, &worst, &seen);
    }
    printf("    %d states of %d mechanisms with %d loops; %d with redundant constraints\n",
           seen.states, seen.mechanisms, seen.loops, seen.redundant);
    for (int k = 0; k <= LD_JOINT_FREE; k++)
        printf("    joint kind %d: %d in trees, %d closing loops\n", k, seen.tree[k], seen.loop[k]);
    printf("    feet: %d down, %d lifted, %d sliding; bushings: %d in their play, %d loaded;\n"
           "    joints: %d beyond stops, %d locked later, %d on the carrier;\n"
           "    %d drives and locks, %d at limits, %d digital, %d lagging, %d with gears, %d "
           "actuators;\n    %d wheels, %d off the road; %d states in wind\n",
           seen.down, seen.lifted, seen.sliding, seen.free_play, seen.stopped, seen.beyond,
           seen.locked_later, seen.carried, seen.holds, seen.limited, seen.digital, seen.lagging,
           seen.geared, seen.actuators, seen.wheels, seen.off_road, seen.windy);
    CHECK_BELOW("gaps of the joints [m, -]", worst.closure, 5e-14);
    CHECK_BELOW("accelerations that joints do not let happen, of the largest", worst.consistency,
                5e-15);
    CHECK_BELOW("accelerations of joints, of the largest", worst.speeds, 5e-11);
    CHECK_BELOW("rates of coordinates, of the largest", worst.coordinates, 5e-16);
    CHECK_BELOW("rates of drives, feet and wheels (relative)", worst.states, 3e-11);
    CHECK_BELOW("powers by name, of the largest", worst.power, 5e-13);
    CHECK_BELOW("power of the carrier, of the largest", worst.carrying, 3e-12);
    CHECK_BELOW("elastic energy (relative)", worst.elastic, 3e-14);
    CHECK_BELOW("kinetic energy (relative)", worst.kinetic, 2e-14);
    CHECK_BELOW("tube's frame [m, m/s, rad/s]", worst.frame, 5e-14);
    CHECK_BELOW("forces and moments of joints, of the largest", worst.loads, 2e-11);
    CHECK_BELOW("coordinates and rates of joints [m, rad, m/s, rad/s]", worst.joints, 2e-14);
    CHECK_BELOW("reports of drives, struts, bushings, feet, wheels (relative)", worst.reports,
                1e-10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_states_of_random_mechanisms)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
