// Adaptors held on the axis exactly: a launch on which three independent programs agree, and what
// is left of drift, momentum and energy.
#include <stdlib.h>

#include "model/model.h"
#include "support/check.h"
#include "support/launching_run.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_kinematics.h"

static const double degree = 3.14159265358979323846 / 180;

// The reference tube, undamped but for its supports; a rocket of constant mass on two points, no
// slot. Figures: a general multibody program, a flexible one and a planar modal code, converged
// ("Launch with two ideal sliding points" of the project's benchmark numbers).
static void peers_model(ld_model *model, int modes)
{
    reference_model(model);
    model->gravity = 9.81;
    model->tubes.modes.bending = modes;
    model->tubes.modes.damping = 0;
    model->tubes.slot.kind = LD_SLOT_NONE;
    ld_rocket *rocket = &model->rocket;
    rocket->full = rocket->empty = (ld_mass_data){60, {1.2, 0, 0}, {0.25, 30, 30}};
    rocket->propellant = 0;
    rocket->adaptor_count = 2;
    rocket->adaptor[1] = rocket->adaptor[2];
    rocket->contact = (ld_contact){.law = LD_CONTACT_IDEAL, .stiffness = NAN, .exponent = 1};
}

typedef struct launch_end {
    double peak, y, pitch, s, against_base; // [m], [rad]
    double drift;                           // [m] largest offset of a held adaptor
} launch_end;

// Tip against the undeformed tube, in the base's axes.
static launching_section tip_of(const launching_run *run)
{
    const launching_layout *at = &run->system->layout;
    launching_section tip;
    launching_section_at(run->system, run->state, run->system->tube.flexible.length, &tip);
    m3 to_base = m3_transpose(run->input.base.A);
    m3 A = m3_mul(to_base, q_matrix(q_from(run->state + at->quaternion)));
    tip.P = v3_add(m3_apply(to_base, v3_from(run->state + at->r)), m3_apply(A, tip.P));
    tip.A = m3_mul(A, tip.A);
    return tip;
}

static void watch(launching_run *run, double t)
{
    (void)t;
    launch_end *end = run->user;
    launching_output out;
    assert_int_equal(launching_evaluate(run->system, &run->input, &run->phase, run->state, &out),
                     LAUNCHING_OK);
    for (int i = 0; i < 2; i++)
        if (!run->phase.passed[i])
            end->drift = fmax(end->drift, hypot(out.adaptor[i].y, out.adaptor[i].z));
    end->peak = fmax(end->peak, fabs(tip_of(run).P.y));
}

static launch_end launch(int modes, double tolerance)
{
    ld_model model;
    launching_run run;
    launch_end end = {0};
    peers_model(&model, modes);
    launching_system *system = launching_system_of(&model);
    launching_run_begin(&run, system, 0.1);
    run.input.base.A = m3_rotation_z(20 * degree);
    run.input.base.q = q_from_matrix(run.input.base.A);
    memcpy(run.state + system->layout.quaternion, &run.input.base.q, sizeof run.input.base.q);
    run.input.thrust = 15e3;
    run.after_step = watch;
    run.user = &end;
    launching_run_follow(&run, tolerance, 0.09);
    run.phase.passed[1] = true;
    launching_run_follow(&run, tolerance, 0.153 - 0.09);
    launching_section tip = tip_of(&run);
    launching_pose pose;
    launching_output out;
    launching_rocket_pose(system, run.state, &pose, &out);
    m3 A = m3_mul(m3_transpose(run.input.base.A),
                  m3_mul(q_matrix(q_from(run.state + system->layout.quaternion)), pose.A_RB));
    end.y = tip.P.y;
    end.pitch = asin(tip.A.a[1][0]);
    end.s = run.state[system->layout.x];
    end.against_base = asin(A.a[1][0]);
    printf("  %d modes: %d steps, tip %.5e m, its pitch %.4e, rocket's %.6e rad\n", modes,
           (int)run.steps, end.y, end.pitch, end.against_base);
    launching_system_drop(system);
    reference_model_free(&model);
    return end;
}

static void agrees_with_the_peers(void **state)
{
    (void)state;
    const double peak = 0.478e-3;
    launch_end end = launch(12, 1e-6);
    CHECK_NEAR("peak of the tip [m]", end.peak, peak, 5e-7);
    CHECK_NEAR("tip at 0.153 s [m]", end.y, -2.5046e-4, 3e-4 * peak);
    CHECK_NEAR("its pitch [rad]", end.pitch, -2.310e-4, 8e-7); // a slope: slower over modes
    CHECK_NEAR("rear point [m]", end.s, 2.9869, 1e-4);
    CHECK_NEAR("rocket's pitch [rad]", end.against_base, -1.27613e-2, 2e-7);
    CHECK_BELOW("held adaptors off the axis [m]", end.drift, 1e-14);
}

// No parameter but the modes: the tip converges with them.
static void converges_over_modes(void **state)
{
    (void)state;
    double tip[3];
    for (int i = 0; i < 3; i++)
        tip[i] = launch(4 * (i + 1), 1e-6).y / 0.478e-3;
    CHECK_BELOW("tip from 4 to 8 modes, over its peak", tip[1] - tip[0], 2e-3);
    CHECK_BELOW("tip from 8 to 12 modes", tip[2] - tip[1], 2e-4);
}

// The whole run, from its equilibrium, with and without a slot: released at the tip, balanced.
static void run_balances(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        ld_model model;
        peers_model(&model, 6);
        model.run.tolerance = 1e-8;
        model.run.start = i == 1 ? LD_START_UNDEFORMED : LD_START_EQUILIBRIUM;
        model.tubes.slot.kind = i == 2 ? LD_SLOT_HELIX : LD_SLOT_NONE;
        recorded_run run;
        recorded_run_make(&run, &model);
        size_t y = recorded_column(&run, "rocket.y");
        double off = 0;
        for (size_t row = 0; row < run.rows; row++)
            off = fmax(off, fabs(recorded_value(&run, row, y)));
        printf("  front leaves at %.6f s, rear at %.6f s\n", run.summary.rocket[0].t_front,
               run.summary.rocket[0].t_rear);
        CHECK_BELOW("rear adaptor off the axis, in any row [m]", off, 1e-15);
        CHECK_BELOW("energy balance, of the largest work", run.summary.energy.residual_relative,
                    1e-9);
        double carried = 60 * 9.81 * cos(model.base.elevation);
        const double *held = run.summary.equilibrium.contact_force;
        if (model.run.start == LD_START_EQUILIBRIUM)
            CHECK_NEAR("weight that the two carry [N]", held[0] + held[1], carried, 2e-2);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

// Held on both sides, adaptors let steps be as long as is stable: 0.69 over the tube's highest
// frequency, by a method that others would want half as many again of.
static void steps_are_as_long_as_is_stable(void **state)
{
    (void)state;
    ld_model model;
    peers_model(&model, 12);
    model.run.tolerance = 1e-5;
    model.run.max_step = 6e-5;
    model.run.start = LD_START_UNDEFORMED;
    recorded_run run;
    recorded_run_make(&run, &model);
    double until = run.summary.rocket[0].t_rear, highest = 0;
    for (int i = 0; i < run.summary.mode_count; i++)
        highest = fmax(highest, run.summary.mode[i].frequency);
    CHECK_BELOW("the longest step, by the highest frequency", model.run.max_step * highest, 0.69);
    CHECK_BELOW("steps over those of the longest", (double)run.summary.statistics.steps,
                1.1 * until / model.run.max_step);
    recorded_run_free(&run);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_peers),
        cmocka_unit_test(converges_over_modes),
        cmocka_unit_test(run_balances),
        cmocka_unit_test(steps_are_as_long_as_is_stable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
