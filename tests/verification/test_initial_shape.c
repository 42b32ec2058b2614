// Guides that are not straight (model.md, section 5): a rigid rocket on a rigid sine, launches
// whose energy balances.
#include <stdlib.h>

#include "model/model.h"
#include "support/check.h"
#include "support/launching_run.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"

static const double PI = 3.14159265358979323846;

// Rows of an initial shape: sines along both planes, of the wave number k.
static void bend_guide(int rows, double length, double a_y, double a_z, double k, ld_model *model)
{
    double *row = malloc((size_t)rows * 3 * sizeof *row);
    for (int i = 0; i < rows; i++) {
        double x = length * i / (rows - 1);
        row[3 * i] = x;
        row[3 * i + 1] = a_y * sin(k * x);
        row[3 * i + 2] = a_z * cos(k * x);
    }
    model->tubes.initial_shape = (ld_initial_shape){
        .present = true, .scale = {1, 1}, .twist_scale = 1, .offsets = {rows, 3, row}};
}

// ---- a rigid rocket on a rigid sine ----

// Two adaptors, held on a line u(x) exactly, l apart, the mass centre c before the rear one:
// u_C'' = u_r'' + c th'', th = (u_f - u_r)/l, of u'' = u_xx v^2 at the speed v. Forces of rear and
// front from m u_C'' and J th'', to first order in u.
static void expected_forces(const rocket_mass *mass, double l, double rear, double front,
                            double force[2])
{
    double th = (front - rear) / l, c = mass->c.x, J = mass->J.a[2][2];
    double sum = mass->m * (rear + c * th), couple = J * th; // F_f (l - c) - F_r c = couple
    force[1] = (couple + sum * c) / l;
    force[0] = sum - force[1];
}

// The largest error of the forces along the guide, of the largest force, with so many rows.
static double error_on_a_sine(int rows)
{
    const double a[2] = {2e-5, -3e-5}, k = 2 * PI / 0.8, v = 37;
    ld_model model;
    reference_model(&model);
    model.gravity = 0;
    model.tubes.tail = (ld_tail){0};
    model.tubes.section[0].mass_per_length = 1e12; // nothing moves it
    model.tubes.section[0].polar_inertia = 1e10;
    model.tubes.modes.bending = 2;
    model.tubes.slot.kind = LD_SLOT_NONE;
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    model.rocket.adaptor_count = 2;
    double l = model.rocket.adaptor[1].at, worst = 0, largest = 0, bend = -k * k * v * v;
    bend_guide(rows, model.tubes.length, a[0], a[1], k, &model);
    launching_system *system = launching_system_of(&model);
    for (int i = 0; i < 40; i++) {
        launching_run run;
        launching_output out;
        double s = 0.1 + 0.04 * i, y[2], z[2];
        launching_run_begin(&run, system, s);
        run.input.mass = (rocket_mass){.m = 60, .c = {1.1, 0, 0}, .J = m3_diagonal(0.2, 24, 24)};
        run.state[system->layout.V] = v;
        launching_project(system, &run.input, &run.phase, run.state);
        assert_int_equal(launching_evaluate(system, &run.input, &run.phase, run.state, &out),
                         LAUNCHING_OK);
        expected_forces(&run.input.mass, l, bend * a[0] * sin(k * s),
                        bend * a[0] * sin(k * (s + l)), y);
        expected_forces(&run.input.mass, l, bend * a[1] * cos(k * s),
                        bend * a[1] * cos(k * (s + l)), z);
        for (int j = 0; j < 2; j++) {
            largest = fmax(largest, hypot(y[j], z[j]));
            worst = fmax(worst, fabs(out.adaptor[j].normal - hypot(y[j], z[j])));
        }
    }
    launching_system_drop(system);
    reference_model_free(&model);
    printf("  %d rows: largest force %.1f N\n", rows, largest);
    return worst / largest;
}

// The spline's curvature is wrong by (k h)^2/12 between rows h apart.
static void rigid_rocket_on_a_sine(void **state)
{
    (void)state;
    double coarse = error_on_a_sine(301), fine = error_on_a_sine(1201);
    CHECK_BELOW("forces on a sine, of the largest", fine, 5e-5);
    CHECK_WITHIN("their order in the distance of rows", 0.5 * log2(coarse / fine), 1.9, 2.1);
}

// ---- launches ----

// What a launch from a guide of these offsets leaves of the energy.
static void check_launch(const char *name, ld_model *model, double bound)
{
    model->run.tolerance = 1e-8;
    double straight = summary_of_run(model).rocket[0].pitch_rate;
    bend_guide(7, model->tubes.length, 3e-4, -2e-4, 2 * PI / 1.7, model);
    ld_summary summary = summary_of_run(model);
    printf("  %s: exit pitch rate %.5f rad/s, straight %.5f\n", name, summary.rocket[0].pitch_rate,
           straight);
    CHECK_BELOW("energy residual over the largest work", summary.energy.residual_relative, bound);
    assert_true(fabs(summary.rocket[0].pitch_rate - straight) > 1e-3);
    reference_model_free(model);
}

static void energy_of_launches(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    check_launch("bore with slot", &model, 1e-11);
    reference_model(&model);
    model.tubes.slot.kind = LD_SLOT_NONE;
    model.tubes.guide = (ld_guide){.present = true,
                                   .form = LD_GUIDE_T_SLOT,
                                   .line = {0.07, 0.02},
                                   .t_slot = {.lips = 0.06, .gap = 0.2e-3, .side_gap = 0.3e-3}};
    for (int i = 0; i < 3; i++)
        model.rocket.adaptor[i].clearance = NAN;
    check_launch("T-slot", &model, 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rigid_rocket_on_a_sine),
        cmocka_unit_test(energy_of_launches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
