// The breech: a rocket without a lock rests on it, falls on it as a mass on a spring, and bounces
// by the contact's law; a lock at the tube's very end needs none.
#include "model/model.h"
#include "support/check.h"

#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double degree = 3.14159265358979323846 / 180;

static ld_summary launch(double start_at, double lead_in, bool at_sea)
{
    ld_model model;
    reference_model(&model);
    model.rocket.start_at = start_at;
    model.run.lead_in = lead_in;
    model.run.tolerance = 1e-9;
    if (at_sea) {
        model.base.kind = LD_BASE_PRESCRIBED;
        model.base.heave = (ld_sines){1, {{0.05, 1.5, 1}}};
        model.base.pitch = (ld_sines){1, {{2 * degree, 1, 0}}};
    }
    ld_summary summary = summary_of_run(&model);
    reference_model_free(&model);
    return summary;
}

// A lock at 0 m holds, with and without a lead-in, as it does a little further on.
static void starts_at_the_rear_end(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        double lead_in = i % 2 ? 0.1 : 0;
        ld_summary at = launch(0, lead_in, i > 1), beyond = launch(1e-9, lead_in, i > 1);
        printf("  %s base, lead-in %g s: %.6f m/s\n", i > 1 ? "moving" : "fixed", lead_in,
               at.rocket[0].exit_speed);
        CHECK_BELOW("t_rear [s]", at.rocket[0].t_rear - beyond.rocket[0].t_rear, 2e-10);
        CHECK_BELOW("exit speed [m/s]", at.rocket[0].exit_speed - beyond.rocket[0].exit_speed,
                    5e-8);
        CHECK_BELOW("pitch rate [rad/s]", at.rocket[0].pitch_rate - beyond.rocket[0].pitch_rate,
                    1e-7);
    }
}

// The front adaptor at the tip, or a nanometre before it, where its foot on the bent tube is beyond
// it already, is out; ten micrometres before it leaves after the release.
static void starts_at_the_tip(void **state)
{
    (void)state;
    ld_summary at = launch(1.1, 0, false), before = launch(1.1 - 1e-9, 0, false);
    ld_summary inside = launch(1.1 - 1e-5, 0, false);
    assert_true(isnan(at.rocket[0].t_front) && isnan(before.rocket[0].t_front));
    CHECK_BELOW("exit speed [m/s]", at.rocket[0].exit_speed - before.rocket[0].exit_speed, 5e-8);
    CHECK_WITHIN("ten micrometres before it: out after [ms]", 1e3 * inside.rocket[0].t_front, 3.8,
                 6);
}

// Without a lock: what of the weight the tube's axis takes, as deep as the contact says, for as
// long as nothing ignites the motor.
static void rests(void **state)
{
    (void)state;
    static const double elevation[] = {5, 19.8, 60, 90}, exponent[] = {1, 1.5, 1, 1};
    for (int i = 0; i < 4; i++) {
        ld_model model;
        recorded_run run;
        reference_model(&model);
        model.base.elevation = elevation[i] * degree;
        model.rocket.start_at = i % 2 ? 0 : 0.1;
        model.rocket.contact.exponent = exponent[i];
        model.rocket.lock.present = false;
        model.run.lead_in = 0.1;
        recorded_run_make(&run, &model);
        double load = 60 * model.gravity * sin(elevation[i] * degree);
        double depth = 1e-3 * pow(load / (5e7 * 1e-3), 1 / exponent[i]);
        size_t s = recorded_column(&run, "rocket.s"), t = recorded_column(&run, "t");
        double moved = 0, start = recorded_value(&run, 0, s);
        for (size_t row = 0; recorded_value(&run, row, t) <= 0; row++)
            moved = fmax(moved, fabs(recorded_value(&run, row, s) - start));
        printf("  %g deg, exponent %g\n", elevation[i], exponent[i]);
        // the tube sags by some 0.1 mrad
        CHECK_NEAR("force [N]", run.summary.equilibrium.breech_force, load, 0.05);
        CHECK_BELOW("depth, relative", (model.rocket.start_at - start) / depth - 1, 3e-4);
        CHECK_BELOW("moved in 0.1 s [m]", moved, 1e-11);
        CHECK_BELOW("energy balance, relative", run.summary.energy.residual_relative, 1e-9);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

// An upright smooth bore on stiff supports, the rocket on the breech, nothing else touched.
static void upright_model(ld_model *model)
{
    reference_model(model);
    model->base.elevation = 90 * degree;
    model->tubes.slot.kind = LD_SLOT_NONE;
    for (int i = 0; i < 2; i++)
        model->tubes.support[i].stiffness[0] = 1e10;
    model->rocket.lock.present = false;
    model->rocket.contact.stiffness = 1e5;
    model->rocket.contact.restitution = 1;
    model->run.start = LD_START_UNDEFORMED;
    model->run.tolerance = 1e-9;
}

// Released at no depth: s = s_0 - m g/k (1 - cos(omega t)).
static void falls_as_on_a_spring(void **state)
{
    (void)state;
    ld_model model;
    recorded_run run;
    upright_model(&model);
    model.run.lead_in = 0.5;
    recorded_run_make(&run, &model);
    size_t s = recorded_column(&run, "rocket.s"), t = recorded_column(&run, "t");
    size_t force = recorded_column(&run, "breech.force");
    double k = 1e5, omega = sqrt(k / 60), sag = 60 * model.gravity / k, off = 0, pull = 0;
    for (size_t row = 0; recorded_value(&run, row, t) <= 0; row++) {
        double now = recorded_value(&run, row, t) + 0.5;
        double expected = 0.1 - sag * (1 - cos(omega * now));
        off = fmax(off, fabs(recorded_value(&run, row, s) - expected) / sag);
        pull = fmax(pull, recorded_value(&run, row, force) / (2 * 60 * model.gravity));
    }
    CHECK_BELOW("way, over m g/k", off, 1e-4);
    CHECK_WITHIN("greatest force over 2 m g", pull, 0.9999, 1.0001);
    CHECK_BELOW("energy balance, relative", run.summary.energy.residual_relative, 1e-12);
    recorded_run_free(&run);
    reference_model_free(&model);
}

// Speed when the force ends after an impact at `speed`, with damping chi [s/m] or c [N s/m].
static double rebound(double speed, double chi, double c, double g)
{
    double p = 0, v = speed, force = 1;
    const double h = 1e-6, k = 1e5;
    for (int i = 0; force > 0 && i < 1000000; i++) {
        double at[2] = {p, v}, slope[2] = {0};
        for (int stage = 0; stage < 2; stage++) {
            force = k * at[0] * (1 + chi * at[1]) + c * at[1];
            slope[0] = at[1];
            slope[1] = g - fmax(0, force) / 60;
            at[0] = p + 0.5 * h * slope[0];
            at[1] = v + 0.5 * h * slope[1];
        }
        p += h * slope[0];
        v += h * slope[1];
    }
    return -v;
}

// A push of a tenth of a second lifts it, it falls back and bounces.
static void bounces(void **state)
{
    (void)state;
    static const ld_contact_law law[] = {LD_CONTACT_HUNT_CROSSLEY, LD_CONTACT_LANKARANI_NIKRAVESH,
                                         LD_CONTACT_KELVIN_VOIGT, LD_CONTACT_BILATERAL};
    static const char *const name[] = {"hunt-crossley", "lankarani-nikravesh", "kelvin-voigt",
                                       "bilateral"};
    for (int i = 0; i < 4; i++) {
        ld_model model;
        recorded_run run;
        upright_model(&model);
        model.rocket.motor.thrust.data[7] = model.rocket.motor.thrust.data[5] = 0;
        model.rocket.motor.thrust.data[2] = 0.05;
        model.rocket.motor.thrust.data[3] = 3e3;
        model.rocket.motor.thrust.data[4] = 0.1;
        model.rocket.empty = model.rocket.full;
        model.rocket.propellant = 0;
        model.rocket.contact.law = law[i];
        model.rocket.contact.restitution = i < 2 ? 0.7 : 1;
        model.rocket.contact.damping = i < 2 ? 0 : 500;
        model.rocket.lock.present = false;
        model.firing_count = 1;
        model.run.end = LD_END_TIME;
        model.run.end_time = 0.6;
        recorded_run_make(&run, &model);
        size_t s_dot = recorded_column(&run, "rocket.s_dot");
        size_t force = recorded_column(&run, "breech.force"), t = recorded_column(&run, "t");
        double before = 0, after = 0;
        for (size_t row = 1; row < run.rows && after == 0; row++) {
            bool was = recorded_value(&run, row - 1, force) > 0;
            bool is = recorded_value(&run, row, force) > 0;
            if (recorded_value(&run, row, t) < 0.12)
                continue;
            if (is && !was)
                before = -recorded_value(&run, row - 1, s_dot);
            if (was && !is && before > 0)
                after = recorded_value(&run, row, s_dot);
        }
        double chi[] = {1.5 * 0.3 / 0.5, 0.75 * (1 - 0.49) / before, 0, 0};
        double expected = rebound(before, chi[i], model.rocket.contact.damping, model.gravity);
        printf("  %s: falls on it at %.4f m/s\n", name[i], before);
        CHECK_BELOW("rebound, relative", after / expected - 1, 2e-3);
        CHECK_BELOW("energy balance, relative", run.summary.energy.residual_relative, 5e-10);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(starts_at_the_rear_end),
        cmocka_unit_test(starts_at_the_tip),
        cmocka_unit_test(rests),
        cmocka_unit_test(falls_as_on_a_spring),
        cmocka_unit_test(bounces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
