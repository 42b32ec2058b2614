// ctest: slow
// Whole launches of the program against an independent program: support/dense_simulation.h has
// equations of motion from positions alone, with multipliers in a dense system, its own
// equilibrium, base, mass and thrust, and classical Runge-Kutta steps of fixed size. Both read the
// same mode shapes. The program runs with its default tolerance. The tip's own rates are kept
// apart: an impact just before the exit leaves the tip ringing, and both programs' steps show there
// first.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "quantities/summary.h"
#include "support/dense_simulation.h"
#include "support/reference_model.h"

typedef struct bounds {
    double instant;  // [s]
    double speed;    // [m/s]
    double attitude; // [rad]
    double rate;     // [rad/s] of the rocket in I
    double place;    // [m], [rad] of rocket in tube and of the tip
    double tip;      // [m/s], [rad/s] of the tip, and of the rocket against it
    double force;    // [-]
} bounds;

typedef struct scenario {
    const char *name;
    void (*change)(ld_model *model);
    double step; // [s] of the independent program
    bounds bound;
} scenario;

static const double degree = 3.14159265358979323846 / 180;

static void reference(ld_model *model)
{
    (void)model;
}

static void no_slot(ld_model *model)
{
    model->tubes.slot.kind = LD_SLOT_NONE;
}

static void straight_slot(ld_model *model)
{
    model->tubes.slot.angle.data[1] = 0;
}

static void slot_table(ld_model *model)
{
    free(model->tubes.slot.angle.data);
    model->tubes.slot.angle = reference_table(3, 2, (double[]){0, 0, 1, 2 * degree, 3, 6 * degree});
    model->rocket.knob_angle = 130 * degree;
}

static void no_friction(ld_model *model)
{
    model->tubes.slot.friction = 0;
    model->rocket.contact.friction = 0;
}

static void little_clearance(ld_model *model)
{
    for (int i = 0; i < 3; i++)
        model->rocket.adaptor[i].clearance = 1e-5;
}

static void unbalanced(ld_model *model)
{
    ld_rocket *rocket = &model->rocket;
    rocket->eccentricity[0] = 0.3e-3;
    rocket->eccentricity[1] = -0.5e-3;
    rocket->products[0] = 0.02;
    rocket->products[1] = -0.03;
    rocket->products[2] = 0.01;
    rocket->mass_error = 0.7;
    rocket->motor.misalignment[0] = 1e-3;
    rocket->motor.misalignment[1] = -0.7e-3;
    rocket->motor.at[0] = -0.3;
    rocket->motor.at[1] = 0.4e-3;
    rocket->motor.at[2] = 0.2e-3;
}

static void at_sea(ld_model *model)
{
    ld_base *base = &model->base;
    base->kind = LD_BASE_PRESCRIBED;
    base->azimuth = 25 * degree;
    base->velocity[0] = 8.33;
    base->velocity[2] = -2;
    base->surge = (ld_sines){1, {{0.05, 1.1, 0.3}}};
    base->heave = (ld_sines){2, {{0.02, 2, 0}, {0.004, 7, 1}}};
    base->sway = (ld_sines){1, {{0.03, 1.6, 2}}};
    base->yaw = (ld_sines){1, {{1 * degree, 0.7, 0}}};
    base->pitch = (ld_sines){1, {{2 * degree, 1, 0}}};
    base->roll = (ld_sines){1, {{3 * degree, 0.8, 1}}};
}

static void hertz(ld_model *model)
{
    model->rocket.contact.exponent = 1.5;
    model->rocket.contact.stiffness = 3e8;
}

static void undeformed(ld_model *model)
{
    model->run.start = LD_START_UNDEFORMED;
}

static void two_adaptors(ld_model *model)
{
    model->rocket.adaptor_count = 2;
    model->rocket.adaptor[1] = model->rocket.adaptor[2];
}

static void few_modes(ld_model *model)
{
    model->tubes.modes.bending = 3;
    model->tubes.modes.torsion = 1;
}

static void coarse_tube(ld_model *model)
{
    few_modes(model);
    model->tubes.modes.elements = 4;
}

static void kelvin_voigt(ld_model *model)
{
    model->rocket.contact.law = LD_CONTACT_KELVIN_VOIGT;
    model->rocket.contact.damping = 5e3;
}

static void lankarani(ld_model *model)
{
    model->rocket.contact.law = LD_CONTACT_LANKARANI_NIKRAVESH;
}

static void bilateral(ld_model *model)
{
    model->rocket.contact.law = LD_CONTACT_BILATERAL;
    model->rocket.contact.damping = 5e3;
}

// A tube of two sections with a guide ring, unequal supports, axial modes, clamped shapes.
// (The tolerance: errors of the default one are as large as the bounds.)
static void uneven_tube(ld_model *model)
{
    ld_tubes *tubes = &model->tubes;
    model->run.tolerance = 1e-6;
    tubes->section_count = 2;
    tubes->section[1] = tubes->section[0];
    tubes->section[1].from = 1.3;
    tubes->section[1].bending_stiffness *= 0.7;
    tubes->section[1].mass_per_length *= 0.8;
    tubes->point_mass_count = 1;
    tubes->point_mass[0] = (ld_point_mass){.at = 2.8, .mass = 0.6};
    tubes->modes.axial = 2;
    tubes->modes.span = LD_SPAN_CLAMPED;
    tubes->support[0].stiffness[1] = 3e7;
    tubes->support[1].rotational_stiffness[2] = 4e5;
    tubes->support_count = 3;
    tubes->support[2] = tubes->support[1];
    tubes->support[2].at = 2.6;
}

// Fired 30 ms after the clock's zero, with a lead-in; a motor with a jump, scaled.
static void late_at_sea(ld_model *model)
{
    at_sea(model);
    model->firing[0].at = 0.03;
    model->run.lead_in = 0.01;
    free(model->rocket.motor.thrust.data);
    model->rocket.motor.thrust =
        reference_table(5, 2, (double[]){0, 14e3, 0.05, 16e3, 0.05, 12e3, 2.5, 15e3, 2.55, 0});
    model->rocket.motor.time_scale = 1.1;
    model->rocket.motor.thrust_scale = 1.05;
}

static void unlocked(ld_model *model)
{
    model->run.tolerance = 1e-6;
    model->rocket.lock.present = false;
}

static void from_the_breech(ld_model *model)
{
    at_sea(model);
    unlocked(model);
    model->rocket.start_at = 0;
    model->run.lead_in = 0.02;
}

// A pressure with a jump that opens the lock at once, and rifling.
static void by_pressure(ld_model *model)
{
    slot_table(model);
    reference_by_pressure(model);
    reference_recoil(model);
    model->tubes.support[0].recoil.stroke = NAN;
    model->tubes.pressure.form = LD_PRESSURE_OVER_TIME;
    model->tubes.pressure.over_time =
        reference_table(5, 2, (double[]){0, 4e5, 0.01, 9e5, 0.01, 1e6, 0.1, 8e5, 1, 3e5});
}

static void cold_gas_at_sea(ld_model *model)
{
    at_sea(model);
    coarse_tube(model);
    reference_by_pressure(model);
}

// The tube recoils into the stop at the end of its stroke. (The tolerance: the stop hits.)
static void into_the_stop(ld_model *model)
{
    cold_gas_at_sea(model);
    reference_recoil(model);
    model->run.tolerance = 1e-8;
}

// At the default tolerance the couple's ringing moves the release by 1.2e-8 s.
static void lock_at_the_wall(ld_model *model)
{
    model->run.tolerance = 1e-9;
    ld_lock *lock = &model->rocket.lock;
    lock->release_force = 12e3;
    lock->x = 0.2;
    lock->radius = 0.0825;
    lock->angle = 100 * degree;
}

// Four rails about a rocket that stands on the breech, with touches that latch.
static void tower_from_the_breech(ld_model *model)
{
    lankarani(model);
    unlocked(model);
    model->tubes.slot.kind = LD_SLOT_NONE;
    model->tubes.guide =
        (ld_guide){.present = true,
                   .form = LD_GUIDE_TOWER,
                   .line = {0.02, 0.03},
                   .tower = {.rails = 4, .first = 30 * degree, .gap = 0.2e-3, .radius = 0.09}};
}

// A keel below, a bar beside it and one above, not symmetric, undeformed. (The tolerance: the
// start rings.)
static void three_surfaces(ld_model *model)
{
    model->run.tolerance = 1e-9;
    two_adaptors(model);
    undeformed(model);
    model->tubes.slot.kind = LD_SLOT_NONE;
    model->tubes.guide = (ld_guide){.present = true, .line = {0.05, 0.08}, .surface_count = 5};
    ld_surface *surface = model->tubes.guide.surface;
    surface[0] = (ld_surface){"", {-0.08, 0.03}, 170 * degree, 0.2e-3, LD_SURFACE_FLAT};
    surface[1] = (ld_surface){"", {-0.08, -0.03}, -150 * degree, 0.2e-3, LD_SURFACE_FLAT};
    surface[2] = (ld_surface){"", {0.08, 0.02}, 10 * degree, 0.3e-3, LD_SURFACE_FLAT};
    surface[3] = (ld_surface){"", {0, 0.08}, 80 * degree, 0.3e-3, LD_SURFACE_ROUND};
    surface[4] = (ld_surface){"", {0, -0.08}, -80 * degree, 0.3e-3, LD_SURFACE_ROUND};
}

// Late, slow to rise, across the axis, by a nozzle that moves; two further motors, one of them lit
// and out on the way; a drag over travel and speed.
static void thrust_as_it_is(ld_model *model)
{
    const double side[] = {0, 0, 0, 0.02, 300, -120, 0.12, -50, 80},
                 nozzle[] = {0.01, 0, 0, 0, 1e-3, 0.15, 4e-3, -2e-3, 1e-3, 0},
                 early[] = {0, 0, 0.01, 3e3, 0.06, 2e3, 0.07, 0}, late[] = {0, 4e3, 2, 2e3},
                 travel[] = {0, 300, 1, 100}, speed[] = {0, 50, 20, 400};
    ld_rocket *rocket = &model->rocket;
    ld_motor *motor = &rocket->motor;
    motor->delay = 8e-3;
    motor->rise_scale = 1.6;
    motor->time_scale = 0.9;
    motor->side_force = (ld_side_force){
        .present = true, .scale = 0.8, .angle = 0.4, .force = reference_table(3, 3, side)};
    motor->nozzle = reference_table(2, 5, nozzle);
    rocket->further_motor_count = 2;
    rocket->further_motor[0] = (ld_further_motor){.thrust = reference_table(4, 2, early),
                                                  .at = {-0.1, 0.05, 0.03},
                                                  .misalignment = {-0.02, 0.05},
                                                  .thrust_scale = 0.9,
                                                  .time_scale = 1.1,
                                                  .delay = 0.03};
    rocket->further_motor[1] = (ld_further_motor){.thrust = reference_table(2, 2, late),
                                                  .at = {0.1, -0.04, 0.02},
                                                  .misalignment = {0.03, 0},
                                                  .thrust_scale = 1,
                                                  .time_scale = 1,
                                                  .delay = 0.09};
    rocket->contact.drag = reference_table(2, 2, travel);
    rocket->contact.drag_over_speed = reference_table(2, 2, speed);
    rocket->contact.drag_scale = 1.3;
}

static double largest(int count, const double *a, const double *b)
{
    double worst = 0;
    for (int i = 0; i < count; i++)
        if (!(isnan(a[i]) && isnan(b[i])))
            worst = fmax(worst, isfinite(a[i] - b[i]) ? fabs(a[i] - b[i]) : INFINITY);
    return worst;
}

static void compare(const ld_model *model, const ld_summary *summary, const dense_summary *dense,
                    const bounds *bound)
{
    const ld_rocket_summary *rocket = &summary->rocket[0];
    double forces = 0;
    if (model->rocket.lock.present)
        CHECK_BELOW("release [s]", rocket->t_release - dense->t_release, bound->instant);
    CHECK_BELOW("front, middle, rear [s]", largest(3, &rocket->t_front, &dense->t_front),
                bound->instant);
    CHECK_BELOW("exit speed [m/s]", rocket->exit_speed - dense->exit_speed, bound->speed);
    CHECK_BELOW("inertial speed [m/s]", rocket->inertial_speed - dense->inertial_speed,
                bound->speed);
    CHECK_BELOW("pitch, yaw [rad]", largest(2, &rocket->pitch, &dense->pitch), bound->attitude);
    CHECK_BELOW("spin, pitch and yaw rate [rad/s]",
                fmax(fabs(rocket->spin_rate - dense->spin_rate),
                     largest(2, &rocket->pitch_rate, &dense->pitch_rate)),
                bound->rate);
    CHECK_BELOW("rocket against tube: place [m], angles [rad]",
                largest(5, &rocket->relative.y, &dense->relative.y), bound->place);
    CHECK_BELOW("rocket against tube: rates [rad/s]",
                largest(3, &rocket->relative.w_x, &dense->relative.w_x), bound->tip);
    CHECK_BELOW("tip: place [m], angles [rad]", largest(4, &rocket->tip.y, &dense->tip.y),
                bound->place);
    CHECK_BELOW("tip: speeds [m/s], rates [rad/s]", largest(4, &rocket->tip.vy, &dense->tip.vy),
                bound->tip);
    for (int i = 0; i < model->rocket.adaptor_count; i++)
        forces = fmax(forces, fabs(rocket->max_contact_force[i] / dense->max_contact_force[i] - 1));
    CHECK_BELOW("greatest contact forces [relative]", forces, bound->force);
    if (model->tubes.slot.kind == LD_SLOT_HELIX)
        CHECK_BELOW("greatest slot force [relative]",
                    (rocket->max_slot_force - dense->max_slot_force) / (1 + dense->max_slot_force),
                    bound->force);
}

static void run_scenario(void **state)
{
    const scenario *s = *state;
    ld_model model;
    ld_error error;
    ld_simulation *simulation = NULL;
    ld_summary summary;
    dense_summary dense;
    reference_model(&model);
    model.tubes.modes.elements = 12; // the independent program's cost goes with them
    s->change(&model);
    if (model_check(&model, &error) || ld_simulation_create(&model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    flexible_tube tube;
    assert_int_equal(flexible_tube_build(&tube, &model.tubes, &error), LD_OK);
    assert_true(dense_simulate(&model, &tube, s->step, &dense));
    printf("  %s: %.4f m/s, pitch rate %.4f rad/s (independent program, steps of %g us)\n", s->name,
           dense.exit_speed, dense.pitch_rate, 1e6 * s->step);
    compare(&model, &summary, &dense, &s->bound);
    flexible_tube_free(&tube);
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

// The paper's overall form against the reduced one, through a whole launch.
static void overall_form_gives_the_same_launch(void **state)
{
    (void)state;
    ld_summary summary[2];
    for (int i = 0; i < 2; i++) {
        ld_model model;
        ld_simulation *simulation;
        ld_error error;
        reference_model(&model);
        model.run.formulation = i ? LD_FORMULATION_OVERALL : LD_FORMULATION_REDUCED;
        if (ld_simulation_create(&model, &simulation, &error) ||
            ld_simulation_run(simulation, NULL, &summary[i], &error))
            fail_msg("%s", error.text);
        ld_simulation_free(simulation);
        reference_model_free(&model);
    }
    const ld_rocket_summary *reduced = &summary[0].rocket[0], *overall = &summary[1].rocket[0];
    printf("  %s\n", summary[1].note[0]);
    CHECK_BELOW("instants [s]", largest(4, &overall->t_release, &reduced->t_release), 1e-9);
    CHECK_BELOW("speeds, spin, attitude, rates",
                largest(7, &overall->exit_speed, &reduced->exit_speed), 1e-5);
    CHECK_BELOW("rocket against tube", largest(8, &overall->relative.y, &reduced->relative.y),
                3e-5);
    CHECK_BELOW("tip", largest(8, &overall->tip.y, &reduced->tip.y), 3e-5);
}

int main(void)
{
    static const bounds usual = {3e-9, 3e-6, 4e-7, 3e-5, 1e-6, 5e-4, 2e-2};
    static const bounds ringing = {3e-9, 2e-5, 4e-7, 1e-4, 1e-6, 8e-3, 2e-2};
    static const bounds pressed = {6e-8, 1e-5, 4e-7, 1e-4, 1e-6, 5e-4, 2e-2};
    static const bounds stopped = {8e-8, 8e-5, 4e-6, 2e-3, 2e-5, 4e-3, 2e-2};
    static const bounds uneven = {9e-8, 3e-6, 4e-7, 3e-5, 1e-6, 5e-4, 2e-2};
    scenario scenarios[] = {
        {"reference", reference, 100e-6, usual},
        {"no slot", no_slot, 100e-6, ringing},
        {"straight slot", straight_slot, 100e-6, ringing},
        {"slot angle by a table", slot_table, 100e-6, usual},
        {"no friction", no_friction, 100e-6, usual},
        {"clearance 10 um", little_clearance, 100e-6, usual},
        {"unbalanced", unbalanced, 100e-6, usual},
        {"at sea", at_sea, 100e-6, usual},
        {"contact exponent 1.5", hertz, 100e-6, usual},
        {"kelvin-voigt", kelvin_voigt, 100e-6, usual},
        {"lankarani-nikravesh", lankarani, 100e-6, usual},
        {"bilateral", bilateral, 100e-6, usual},
        {"undeformed start", undeformed, 100e-6, usual},
        {"thrust as it is", thrust_as_it_is, 100e-6, usual},
        {"two adaptors", two_adaptors, 100e-6, usual},
        {"few modes", few_modes, 100e-6, usual},
        {"uneven tube", uneven_tube, 100e-6, uneven},
        {"late at sea", late_at_sea, 100e-6, usual},
        {"unlocked", unlocked, 50e-6, usual},
        {"lock at the wall", lock_at_the_wall, 50e-6, usual},
        {"at sea, from a breech at 0 m", from_the_breech, 50e-6, usual},
        {"by a pressure over time, on a recoil slide", by_pressure, 100e-6, usual},
        {"cold gas, at sea", cold_gas_at_sea, 100e-6, pressed},
        {"cold gas, at sea, recoil into the stop", into_the_stop, 50e-6, stopped},
        {"tower, from the breech", tower_from_the_breech, 50e-6, usual},
        {"three surfaces and two bars", three_surfaces, 50e-6, usual},
    };
    enum { COUNT = sizeof scenarios / sizeof scenarios[0] };
    struct CMUnitTest tests[COUNT + 1] = {cmocka_unit_test(overall_form_gives_the_same_launch)};
    for (int i = 0; i < COUNT; i++)
        tests[i + 1] =
            (struct CMUnitTest){scenarios[i].name, run_scenario, NULL, NULL, &scenarios[i]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
