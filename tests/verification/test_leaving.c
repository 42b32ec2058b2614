// Adaptors that leave the guide at stations of their own: tip-off against the closed form of a
// rocket that pivots on its rear adaptor, none where both leave together.
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

// J theta'' = m x_C a theta + moment, from rest for tau
static double pivot_rate(const ld_rocket *rocket, double moment, double tau)
{
    double m = rocket->full.mass, x_C = rocket->full.center[0];
    double J = rocket->full.inertia[2] + m * x_C * x_C, k = sqrt(m * x_C * (thrust / m) / J);
    return moment / (k * J) * sinh(k * tau);
}

static void check_exit(const ld_model *model)
{
    const ld_rocket *rocket = &model->rocket;
    const ld_adaptor *rear = &rocket->adaptor[0], *front = &rocket->adaptor[1];
    double m = rocket->full.mass, x_C = rocket->full.center[0], a = thrust / m;
    double way =
        (isfinite(rear->leaves_at) ? rear->leaves_at : model->tubes.length) - rocket->start_at;
    double to_front = (isfinite(front->leaves_at) ? front->leaves_at : model->tubes.length) -
                      front->at - rocket->start_at;
    double t_front = sqrt(2 * to_front / a), t_rear = sqrt(2 * way / a), tau = t_rear - t_front;
    double pitch = pivot_rate(rocket, -m * model->gravity * x_C, tau);
    double yaw = pivot_rate(rocket, thrust * beside, tau);
    ld_summary summary = summary_of_run(model);
    const ld_rocket_summary *out = &summary.rocket[0];
    printf("  front leaves at %g m, rear at %g m: %.4f and %.4f rad/s\n", front->leaves_at,
           rear->leaves_at, out->tip_off.pitch_rate, out->tip_off.yaw_rate);
    CHECK_BELOW("t_front, relative", out->t_front / t_front - 1, 1e-13);
    CHECK_BELOW("t_rear, relative", out->t_rear / t_rear - 1, 5e-8);
    CHECK_BELOW("exit speed, relative", out->exit_speed / (a * t_rear) - 1, 3e-7);
    CHECK_BELOW("pitch rate [rad/s]", out->tip_off.pitch_rate - pitch, 3e-10);
    CHECK_BELOW("yaw rate [rad/s]", out->tip_off.yaw_rate - yaw, 2e-10);
    CHECK_BELOW("mass centre, up [m/s]", out->tip_off.vy - x_C * pitch, 1e-9);
    CHECK_BELOW("mass centre, to the right [m/s]", out->tip_off.vz + x_C * yaw, 1e-10);
    CHECK_BELOW("energy residual, relative", summary.energy.residual_relative, 1e-13);
    if (tau < 1e-9)
        assert_true(out->t_front == out->t_rear);
}

static void tip_off_is_that_of_the_pivoting(void **state)
{
    (void)state;
    static const double ends[][2] = {{NAN, NAN}, {2.6, 2.9}, {2.35, NAN}, {2.5, 0.6}, {NAN, 1.1}};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        ld_model model;
        rigid_tube(&model);
        model.rocket.adaptor[1].leaves_at = ends[i][0];
        model.rocket.adaptor[0].leaves_at = ends[i][1];
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tip_off_is_that_of_the_pivoting),
        cmocka_unit_test(those_together_leave_at_one_instant),
        cmocka_unit_test(none_is_left_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
