// Adaptors that leave the guide at stations of their own, and fall off: tip-off against the closed
// form of a rocket that pivots on its rear adaptor, none where both leave together; momenta.
#include "elements/motor.h"
#include "model/model.h"
#include "support/check.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

// ---- on a rigid level tube, held on the axis

static const double thrust = 6e3, beside = 0.03e-3; // [N], [m] its distance from the axis, along z

// Two clamps leave the tube's four coordinates a plane nowhere to go: it is rigid.
static void rigid_tube(ld_model *model)
{
    reference_model(model);
    model->gravity = 0.05; // angles stay small
    model->base.elevation = 0;
    ld_tubes *tubes = &model->tubes;
    tubes->modes = (ld_modes){.bending = 2, .torsion = 1, .elements = 8, .span = LD_SPAN_SUPPORTED};
    tubes->support[0] = (ld_support){.at = 0, .clamped = (1u << LD_CLAMPS) - 1};
    tubes->support[1] = (ld_support){.at = tubes->length,
                                     .clamped = 1u << LD_CLAMP_Y | 1u << LD_CLAMP_Z |
                                                1u << LD_CLAMP_YAW | 1u << LD_CLAMP_PITCH};
    tubes->slot.kind = LD_SLOT_NONE;
    ld_rocket *rocket = &model->rocket;
    rocket->adaptor_count = 2;
    rocket->adaptor[1] = rocket->adaptor[2];
    rocket->contact = (ld_contact){.law = LD_CONTACT_IDEAL, .stiffness = NAN, .exponent = 1};
    rocket->empty = rocket->full;
    rocket->propellant = 0;
    rocket->motor.at[2] = beside;
    rocket->motor.thrust.rows = 2;
    memcpy(rocket->motor.thrust.data, (double[]){0, thrust, 5, thrust}, 4 * sizeof(double));
    model->run.tolerance = 1e-8;
}

// The rocket after its front adaptor has left: sums about the rear one, which falls off at last.
typedef struct pivoting {
    double mass, first, y, J_y, J_z; // [kg], [kg m] along x, [m] of the mass centre, [kg m2]
} pivoting;

static pivoting pivoting_of(const ld_rocket *rocket)
{
    const ld_falling *part = &rocket->adaptor[1].falls_off;
    double m = rocket->full.mass, x = rocket->full.center[0], at = rocket->adaptor[1].at;
    double p = part->present ? part->mass : 0, y = part->center[0];
    return (pivoting){m - p, m * x - p * at, -p * y / (m - p),
                      rocket->full.inertia[1] + m * x * x - part->inertia[1] - p * at * at,
                      rocket->full.inertia[2] + m * x * x - part->inertia[2] -
                          p * (at * at + y * y)};
}

// J theta'' = m x_C a theta + moment, from rest for tau
static double pivot_rate(const pivoting *rocket, double J, double moment, double tau)
{
    double k = sqrt(rocket->first * (thrust / rocket->mass) / J);
    return moment / (k * J) * sinh(k * tau);
}

static double end_of(const ld_model *model, int i)
{
    const ld_adaptor *one = &model->rocket.adaptor[i];
    return (isnan(one->leaves_at) ? model->tubes.length : one->leaves_at) - one->at -
           model->rocket.start_at;
}

static void check_exit(const ld_model *model)
{
    const ld_rocket *rocket = &model->rocket;
    const ld_adaptor *rear = &rocket->adaptor[0], *front = &rocket->adaptor[1];
    pivoting left = pivoting_of(rocket);
    double a = thrust / rocket->full.mass, after = thrust / left.mass;
    double to_front = end_of(model, 1), on = end_of(model, 0) - to_front;
    double v_front = sqrt(2 * a * to_front), speed = sqrt(v_front * v_front + 2 * after * on);
    double t_front = v_front / a, tau = (speed - v_front) / after, t_rear = t_front + tau;
    double weight = left.first * model->gravity;
    double pitch = pivot_rate(&left, left.J_z, thrust * left.y - weight, tau);
    double yaw = pivot_rate(&left, left.J_y, thrust * beside, tau);
    double x_C = left.first / (left.mass - (rear->falls_off.present ? rear->falls_off.mass : 0));
    ld_summary summary = summary_of_run(model);
    const ld_rocket_summary *out = &summary.rocket[0];
    printf("  front leaves at %g m, rear at %g m%s: %.4f and %.4f rad/s\n", front->leaves_at,
           rear->leaves_at, front->falls_off.present ? ", fall off" : "", out->tip_off.pitch_rate,
           out->tip_off.yaw_rate);
    CHECK_BELOW("t_front, relative", out->t_front / t_front - 1, 1e-13);
    CHECK_BELOW("t_rear, relative", out->t_rear / t_rear - 1, 5e-8);
    CHECK_BELOW("exit speed, relative", out->exit_speed / speed - 1, 3e-7);
    CHECK_BELOW("pitch rate [rad/s]", out->tip_off.pitch_rate - pitch, 1e-9);
    CHECK_BELOW("yaw rate [rad/s]", out->tip_off.yaw_rate - yaw, 3e-9);
    CHECK_BELOW("mass centre, up [m/s]", out->tip_off.vy - x_C * pitch, 2e-9);
    CHECK_BELOW("mass centre, to the right [m/s]", out->tip_off.vz + x_C * yaw, 3e-9);
    CHECK_BELOW("energy residual, relative", summary.energy.residual_relative, 1e-13);
    if (tau < 1e-9)
        assert_true(out->t_front == out->t_rear);
}

static void tip_off_is_that_of_the_pivoting(void **state)
{
    (void)state;
    static const double ends[][2] = {{NAN, NAN}, {2.6, 2.9}, {2.35, NAN}, {2.5, 0.6}, {NAN, 1.1}};
    for (size_t i = 0; i < 2 * sizeof ends / sizeof *ends; i++) {
        ld_model model;
        rigid_tube(&model);
        ld_adaptor *adaptor = model.rocket.adaptor;
        adaptor[1].leaves_at = ends[i / 2][0];
        adaptor[0].leaves_at = ends[i / 2][1];
        if (i % 2) {
            adaptor[0].falls_off = (ld_falling){true, 1.5, {0.002, 0}, {0.01, 0.005, 0.004}};
            adaptor[1].falls_off = (ld_falling){true, 2, {0.002, 0}, {0.01, 0.005, 0.03}};
        }
        check_exit(&model);
        reference_model_free(&model);
    }
}

// ---- on a rail that gives: shoes that leave together do at one instant, however it is bent

static void shoes(ld_model *model)
{
    reference_model(model);
    model->tubes.slot.kind = LD_SLOT_NONE;
    model->tubes.guide = (ld_guide){.present = true,
                                    .form = LD_GUIDE_T_SLOT,
                                    .line = {0.16, 0.01},
                                    .t_slot = {{-0.08, 0}, 0.04, 0.4e-3, 0.3e-3}};
    ld_rocket *rocket = &model->rocket;
    ld_adaptor front = rocket->adaptor[2];
    rocket->adaptor[2] = rocket->adaptor[1]; // not in the order in which they leave
    rocket->adaptor[1] = front;
    for (int i = 0; i < 3; i++)
        rocket->adaptor[i].clearance = i * 0.1e-3;
}

static void those_together_leave_at_one_instant(void **state)
{
    (void)state;
    ld_model model;
    shoes(&model);
    ld_adaptor *rear = &model.rocket.adaptor[0], *front = rear + 1, *middle = rear + 2;
    const ld_rocket_summary *out;
    ld_summary summary;
    // all
    rear->leaves_at = 1;
    front->leaves_at = 1 + front->at;
    middle->leaves_at = 1 + middle->at;
    summary = summary_of_run(&model);
    out = &summary.rocket[0];
    assert_true(out->t_front > 0 && out->t_front == out->t_middle && out->t_front == out->t_rear);
    CHECK_BELOW("three: energy residual, relative", summary.energy.residual_relative, 1e-10);
    // a rail that is the same but ends a nanometre later under one of them
    middle->leaves_at += 1e-9;
    summary = summary_of_run(&model);
    assert_true(summary.rocket[0].t_middle == summary.rocket[0].t_front);
    // two; the foremost and the one behind it
    front->leaves_at = 0.8 + front->at;
    middle->leaves_at = 0.8 + middle->at;
    summary = summary_of_run(&model);
    out = &summary.rocket[0];
    assert_true(out->t_front == out->t_middle && out->t_front < out->t_rear);
    // one by one, the one in the middle first
    middle->leaves_at = 0.6 + middle->at;
    summary = summary_of_run(&model);
    out = &summary.rocket[0];
    assert_true(out->t_middle < out->t_front && out->t_front < out->t_rear);
    for (int i = 0; i < 3; i++)
        assert_true(out->t_exit[i] == (i == 0   ? out->t_rear
                                       : i == 1 ? out->t_front
                                                : out->t_middle));
    reference_model_free(&model);
}

// A tilt in the gaps shifts the front shoe by up to 2 (gap + clearance)/at times the rocket's place
// beside the rail's axis: a shoe that is to leave before the rear one by less leaves with it.
static void none_is_left_behind(void **state)
{
    (void)state;
    ld_model model;
    shoes(&model);
    model.rocket.adaptor_count = 2;
    ld_adaptor *rear = &model.rocket.adaptor[0], *front = rear + 1;
    double shift = 2 * 0.5e-3 / front->at * 0.16;
    rear->leaves_at = 1;
    for (int i = 0; i < 2; i++) {
        double before = i ? 4 * shift : 0.1 * shift;
        front->leaves_at = 1 + front->at - before;
        ld_summary summary = summary_of_run(&model);
        const ld_rocket_summary *out = &summary.rocket[0];
        double apart = (out->t_rear - out->t_front) * out->exit_speed;
        printf("  %.1f of the shift before: %.2f\n", before / shift, apart / shift);
        if (i)
            CHECK_WITHIN("apart, over the shift", apart / shift, 3, 4);
        else
            assert_true(out->t_front == out->t_rear);
    }
    reference_model_free(&model);
}

// In a guide that is shorter than the rocket an adaptor beyond the end, that of all or its own,
// takes no part: the launch is that of a rocket without it.
static void shorter_than_the_rocket(void **state)
{
    (void)state;
    ld_summary summary[3];
    for (int n = 0; n < 3; n++) {
        ld_model model;
        reference_model(&model);
        ld_rocket *rocket = &model.rocket;
        rocket->adaptor[0].leaves_at = 1.5;
        rocket->adaptor[1].leaves_at = 2.6;
        rocket->adaptor[2].leaves_at = 1.2; // it starts at 2 m
        if (n == 1) {
            rocket->adaptor[2].at = model.tubes.length;
            rocket->adaptor[2].leaves_at = NAN;
        }
        rocket->adaptor_count = n < 2 ? 3 : 2;
        summary[n] = summary_of_run(&model);
        reference_model_free(&model);
    }
    const ld_rocket_summary *without = &summary[2].rocket[0];
    for (int n = 0; n < 2; n++) {
        const ld_rocket_summary *out = &summary[n].rocket[0];
        printf("  pitch rate %.6f rad/s, yaw rate %.6f rad/s\n", out->tip_off.pitch_rate,
               out->tip_off.yaw_rate);
        CHECK_BELOW("exit speed [m/s]", out->exit_speed - without->exit_speed, 0);
        CHECK_BELOW("t_rear [s]", out->t_rear - without->t_rear, 0);
        CHECK_BELOW("of the middle one [s]", out->t_exit[1] - without->t_exit[1], 0);
        CHECK_BELOW("pitch rate [rad/s]", out->tip_off.pitch_rate - without->tip_off.pitch_rate, 0);
        CHECK_BELOW("yaw rate [rad/s]", out->tip_off.yaw_rate - without->tip_off.yaw_rate, 0);
        CHECK_BELOW("energy residual, relative", summary[n].energy.residual_relative, 2e-11);
    }
}

// ---- what falls off

static double about_O1(const rocket_mass *mass, int i, int j)
{
    const double c[3] = {mass->c.x, mass->c.y, mass->c.z};
    return mass->J.a[i][j] + mass->m * ((i == j) * v3_norm2(mass->c) - c[i] * c[j]);
}

// Mass, first moment and inertia about O1 are those of all parts before, so that momenta are where
// no speed jumps; rates against central differences.
static void momenta_stay(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    ld_rocket *rocket = &model.rocket;
    const double h = 1e-4,
                 masses[] = {0, 30, 0.9, 0.1, 4, 1, 24, 1.0, 0.09, 3.5, 3, 10, 1.1, 0.05, 2};
    rocket->products[0] = 0.02;
    rocket->eccentricity[1] = 1e-3;
    rocket->adaptor[0].falls_off = (ld_falling){true, 1.5, {0.1, -0.02}, {0.01, 0.005, 0.004}};
    rocket->adaptor[2].falls_off = (ld_falling){true, 2.5, {-0.05, 0.03}, {0.02, 0.01, 0.03}};
    for (int n = 0; n < 2; n++) {
        motor burns;
        rocket_mass whole, left, other, before, beyond;
        if (n)
            rocket->motor.masses = reference_table(3, 5, masses);
        assert_int_equal(motor_build(&burns, rocket, 0, NULL), LD_OK);
        rocket_mass *each[] = {&left, &before, &beyond};
        for (int k = 0; k < 3; k++) {
            motor_mass(&burns, 1, 0.7 + h * (k == 2) - h * (k == 1), each[k]);
            whole = k == 0 ? left : whole;
            rocket_mass_without(rocket, 0, each[k]);
            rocket_mass_without(rocket, 1, each[k]); // of which nothing falls
            rocket_mass_without(rocket, 2, each[k]);
        }
        other = whole;
        rocket_mass_without(rocket, 2, &other);
        rocket_mass_without(rocket, 0, &other);
        double moment = 0, inertia = 0, order = 0, rate = 0;
        const double *c = &left.c.x, *c_dot = &left.c_dot.x;
        for (int i = 0; i < 3; i++) {
            double first = left.m * c[i] - whole.m * (&whole.c.x)[i];
            for (int k = 0; k < 3; k += 2) {
                const ld_falling *part = &rocket->adaptor[k].falls_off;
                first += part->mass * (i ? part->center[i - 1] : rocket->adaptor[k].at);
            }
            moment = fmax(moment, fabs(first));
            rate = fmax(rate, fabs(((&beyond.c.x)[i] - (&before.c.x)[i]) / (2 * h) - c_dot[i]));
            for (int j = 0; j < 3; j++) {
                double all = about_O1(&left, i, j) - about_O1(&whole, i, j);
                for (int k = 0; k < 3; k += 2) {
                    const ld_falling *part = &rocket->adaptor[k].falls_off;
                    rocket_mass alone = {
                        .m = part->mass,
                        .c = {rocket->adaptor[k].at, part->center[0], part->center[1]},
                        .J = m3_diagonal(part->inertia[0], part->inertia[1], part->inertia[2])};
                    all += about_O1(&alone, i, j);
                }
                inertia = fmax(inertia, fabs(all));
                order = fmax(order, fabs(left.J.a[i][j] - other.J.a[i][j]));
                rate = fmax(rate, fabs((beyond.J.a[i][j] - before.J.a[i][j]) / (2 * h) -
                                       left.J_dot.a[i][j]));
            }
        }
        CHECK_BELOW("mass [kg]", left.m + 4 - whole.m, 1e-14);
        CHECK_BELOW("first moment [kg m]", moment, 3e-14);
        CHECK_BELOW("inertia about O1 [kg m2]", inertia, 1e-13);
        CHECK_BELOW("order of falling, inertia [kg m2]", order, 1e-13);
        CHECK_BELOW("rates of centre and inertia [m/s, kg m2/s]", rate, 1e-10);
        // that of the flight at the motor's corners
        motor_without_falling(&burns, rocket);
        rocket_mass corner = burns.full;
        if (!n)
            CHECK_BELOW("full, for the flight [kg]", corner.m - (60 - 4), 1e-14);
        motor_free(&burns);
    }
    reference_model_free(&model);
}

// In a burning launch on the flexible tube, two at once and the rear one: the balance holds where
// mass, centre, inertia and their rates do.
static void energy_is_kept(void **state)
{
    (void)state;
    for (int n = 0; n < 2; n++) {
        ld_model model;
        reference_model(&model);
        ld_adaptor *adaptor = model.rocket.adaptor;
        adaptor[1].leaves_at = 2.2;
        adaptor[2].leaves_at = n ? 2.9 : 2.2 + 0.7;
        adaptor[0].falls_off = (ld_falling){true, 1.5, {0, 0}, {0.01, 0.005, 0.005}};
        adaptor[1].falls_off = (ld_falling){true, 2, {0.01, 0.02}, {0.01, 0.005, 0.005}};
        adaptor[2].falls_off = (ld_falling){true, 3, {0, -0.01}, {0.01, 0.005, 0.005}};
        model.run.tolerance = 1e-8;
        model.run.end = n ? LD_END_TIP : LD_END_TIME;
        model.run.end_time = 0.3;
        ld_summary summary = summary_of_run(&model);
        CHECK_BELOW("energy residual, relative", summary.energy.residual_relative, 3e-11);
        reference_model_free(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tip_off_is_that_of_the_pivoting),
        cmocka_unit_test(those_together_leave_at_one_instant),
        cmocka_unit_test(none_is_left_behind),
        cmocka_unit_test(shorter_than_the_rocket),
        cmocka_unit_test(momenta_stay),
        cmocka_unit_test(energy_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
