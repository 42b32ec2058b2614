// A rocket driven by pressure against closed forms and quadratures of its own: a gas that expands,
// pressures over travel and time, the tube's recoil, rifling, the lock, the breech.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/launching/launcher.h"

static const double pi = 3.14159265358979323846;

// Level, without gravity, friction, slot and lock: a slug in a tube that nothing holds along x.
static void slug_in_a_free_tube(ld_model *model)
{
    reference_model(model);
    reference_by_pressure(model);
    model->gravity = 0;
    model->base.elevation = 0;
    model->tubes.slot.kind = LD_SLOT_NONE;
    model->rocket.lock.present = false;
    model->rocket.contact.friction = 0;
    model->run.start = LD_START_UNDEFORMED;
    model->run.tolerance = 1e-11;
    reference_recoil(model);
    model->tubes.support[0].recoil = (ld_recoil){.present = true, .friction_speed = 1, .stroke = 9};
}

static double bore_area(const ld_model *model)
{
    double radius = model->tubes.section[0].bore_radius;
    return pi * radius * radius;
}

static double tube_mass(const ld_model *model)
{
    const ld_tubes *tubes = &model->tubes;
    return tubes->section[0].mass_per_length * tubes->length + tubes->tail.mass;
}

static double reduced_mass(const ld_model *model)
{
    return 1 / (1 / model->rocket.full.mass + 1 / tube_mass(model));
}

// Work of the gas on the way `travel` [J].
static double gas_work(const ld_model *model, double travel)
{
    const ld_pressure *gas = &model->tubes.pressure;
    double A = bore_area(model), share = gas->volume / (gas->volume + A * travel);
    return gas->pressure * gas->volume / (gas->exponent - 1) * (1 - pow(share, gas->exponent - 1)) -
           gas->ambient * A * travel;
}

// Time of the way by Gauss' formula: s' = u^2, dt = 2 u du sqrt(mu/(2 W)).
static double gas_time(const ld_model *model, double travel)
{
    static const double node[3] = {-0.7745966692414834, 0, 0.7745966692414834};
    static const double weight[3] = {5. / 9, 8. / 9, 5. / 9};
    const int pieces = 200;
    double mu = reduced_mass(model), h = sqrt(travel) / pieces, sum = 0;
    for (int i = 0; i < pieces; i++)
        for (int k = 0; k < 3; k++) {
            double u = (i + 0.5 + 0.5 * node[k]) * h;
            sum += 0.5 * h * weight[k] * 2 * u * sqrt(mu / (2 * gas_work(model, u * u)));
        }
    return sum;
}

static double last_value(const recorded_run *run, const char *name)
{
    return recorded_value(run, run->rows - 1, recorded_column(run, name));
}

// What two free bodies get of the work W between them.
static void check_two_bodies(const ld_model *model, const recorded_run *run, double W)
{
    const ld_rocket_summary *rocket = &run->summary.rocket[0];
    double m = model->rocket.full.mass, M = tube_mass(model), mu = reduced_mass(model);
    double v = sqrt(2 * W / mu), momentum = mu * v;
    CHECK_BELOW("work of the pressure, relative", run->summary.energy.work[POWER_PRESSURE] / W - 1,
                1e-9);
    CHECK_BELOW("speed in the tube, relative", rocket->exit_speed / v - 1, 1e-10);
    CHECK_BELOW("momentum of the slug, relative", m * rocket->inertial_speed / momentum - 1, 1e-10);
    CHECK_BELOW("momentum of the tube, relative", M * last_value(run, "tube.vx") / -momentum - 1,
                1e-10);
    CHECK_BELOW("recoil [m], relative",
                last_value(run, "recoil.1.travel") * (m + M) / (m * (3 - model->rocket.start_at)) -
                    1,
                1e-10);
    CHECK_BELOW("energy balance, relative", run->summary.energy.residual_relative, 1e-9);
}

static void gas_drives_slug_and_tube(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        ld_model model;
        recorded_run run;
        slug_in_a_free_tube(&model);
        model.rocket.start_at = i == 1 ? 0 : 0.1;
        model.tubes.pressure.exponent = i == 2 ? 1.1 : 1.4;
        model.run.formulation = i == 2 ? LD_FORMULATION_OVERALL : LD_FORMULATION_REDUCED;
        recorded_run_make(&run, &model);
        double way = 3 - model.rocket.start_at;
        printf("  from %g m: %.6f m/s\n", model.rocket.start_at, run.summary.rocket[0].exit_speed);
        check_two_bodies(&model, &run, gas_work(&model, way));
        CHECK_BELOW("time in the tube, relative",
                    run.summary.rocket[0].t_rear / gas_time(&model, way) - 1, 1e-9);
        CHECK_BELOW("largest pressure, relative", run.summary.rocket[0].max_pressure / 1.9e6 - 1,
                    1e-12);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

// Over travel, a straight line by two rows and by three; over time, with a jump.
static void tables_drive_slug_and_tube(void **state)
{
    (void)state;
    const double line[] = {0, 3e6, 1.45, 2e6, 2.9, 1e6}, ends[] = {0, 3e6, 2.9, 1e6};
    for (int i = 0; i < 2; i++) {
        ld_model model;
        recorded_run run;
        slug_in_a_free_tube(&model);
        model.tubes.pressure.form = LD_PRESSURE_OVER_TRAVEL;
        model.tubes.pressure.scale = 1.2;
        model.tubes.pressure.over_travel = reference_table(i ? 3 : 2, 2, i ? line : ends);
        recorded_run_make(&run, &model);
        check_two_bodies(&model, &run, (1.2 * 2e6 - 1e5) * bore_area(&model) * 2.9);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
    ld_model model;
    slug_in_a_free_tube(&model);
    model.tubes.pressure.form = LD_PRESSURE_OVER_TIME;
    model.tubes.pressure.ambient = 0;
    model.tubes.pressure.over_time =
        reference_table(5, 2, (double[]){0, 1e6, 4e-3, 3e6, 4e-3, 2e6, 9e-3, 1e6, 9e-3, 0});
    ld_summary summary = summary_of_run(&model);
    double impulse = (8e-3 + 7.5e-3) * 1e6 * bore_area(&model);
    CHECK_BELOW("impulse, relative",
                summary.rocket[0].exit_speed * reduced_mass(&model) / impulse - 1, 1e-10);
    reference_model_free(&model);
}

// The lock carries p A until its release force; what exceeds that at once lets it go at once, and
// what never does, never.
static void lock_lets_go(void **state)
{
    (void)state;
    const double ramp[] = {0, 0, 0.01, 1e6, 1, 1e6}, jump[] = {0, 1e6, 1, 1e6};
    for (int i = 0; i < 3; i++) {
        ld_model model;
        slug_in_a_free_tube(&model);
        model.tubes.pressure.form = LD_PRESSURE_OVER_TIME;
        model.tubes.pressure.ambient = 0;
        model.tubes.pressure.over_time =
            i == 1 ? reference_table(2, 2, jump) : reference_table(3, 2, ramp);
        model.run.tolerance = 1e-8;
        model.rocket.lock.present = true;
        model.rocket.lock.release_force = i == 2 ? 3e4 : 5e3;
        if (i == 2) {
            ld_error error;
            ld_simulation *simulation;
            ld_summary summary;
            assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
            model.run.stuck_time = 0.1;
            assert_int_equal(ld_simulation_run(simulation, NULL, &summary, &error), LD_ERR_LAUNCH);
            assert_non_null(
                strstr(error.text, "the lock never released: it carried at most 21382"));
            ld_simulation_free(simulation);
        } else {
            double release = i == 1 ? 0 : 0.01 * 5e3 / (1e6 * bore_area(&model));
            CHECK_BELOW("release [s]", summary_of_run(&model).rocket[0].t_release - release, 1e-9);
        }
        reference_model_free(&model);
    }
}

// The tube goes on after the slug has left: against preload and return spring, against a brake with
// the square of the speed, and into the stop behind and the front one, which throw it back.
static void tube_recoils(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        ld_model model;
        recorded_run run;
        slug_in_a_free_tube(&model);
        ld_recoil *slide = &model.tubes.support[0].recoil;
        model.tubes.support[0].damping[0] = 0;
        slide->preload = i == 0 ? 3e3 : 0;
        slide->stiffness = i == 0 ? 2e4 : 0;
        slide->quadratic_damping = i == 1 ? 60 : 0;
        slide->stroke = i == 2 ? 0.5 : 9;
        model.run.end = LD_END_TIME;
        model.run.end_time = 0.15;
        model.rocket.full.mass = model.rocket.empty.mass = 6;
        model.rocket.full.inertia[0] = model.rocket.empty.inertia[0] = 0.022;
        recorded_run_make(&run, &model);
        size_t travel = recorded_column(&run, "recoil.1.travel"), t = recorded_column(&run, "t");
        size_t rate = recorded_column(&run, "recoil.1.rate"), row = 0;
        while (recorded_value(&run, row, t) < run.summary.rocket[0].t_rear)
            row++;
        double M = tube_mass(&model), x = recorded_value(&run, row, travel);
        double v = recorded_value(&run, row, rate), most = run.summary.rocket[0].max_recoil[0];
        double v_end = last_value(&run, "recoil.1.rate"), since = model.run.end_time;
        since -= run.summary.rocket[0].t_rear;
        printf("  at the exit %.4f m, %.4f m/s; largest %.4f m\n", x, v, most);
        if (i == 0) {
            // M v^2/2 = F_0 (x_m - x) + k (x_m^2 - x^2)/2
            double k = slide->stiffness, F = slide->preload;
            double energy = 0.5 * M * v * v + F * x + 0.5 * k * x * x;
            double top = (sqrt(F * F + 2 * k * energy) - F) / k;
            CHECK_BELOW("largest recoil (at the ends of steps), relative", most / top - 1, 1e-4);
            double now = last_value(&run, "recoil.1.travel");
            CHECK_BELOW("energy at the end, relative",
                        (0.5 * M * v_end * v_end + F * now + 0.5 * k * now * now) / energy - 1,
                        1e-8);
        } else if (i == 1) {
            CHECK_BELOW("speed at the end, relative", v_end * (1 + 60 * v * since / M) / v - 1,
                        1e-8);
        } else {
            CHECK_BELOW("speed after both stops, relative", v_end / v - 1, 1e-8);
        }
        CHECK_BELOW("energy balance, relative", run.summary.energy.residual_relative, 1e-9);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

// At rest the front stop carries what the preload has beyond the weight; where the weight has
// more, the return spring does, off the stop.
static void rests_at_the_front_stop(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        ld_model model;
        recorded_run run;
        reference_model(&model);
        reference_recoil(&model);
        ld_recoil *slide = &model.tubes.support[0].recoil;
        slide->preload = i == 0 ? 2e3 : 100;
        model.base.elevation = pi / 3;
        recorded_run_make(&run, &model);
        double weight = (tube_mass(&model) + 60) * model.gravity * sin(pi / 3);
        double expected = i == 0 ? -(2e3 - weight) / model.tubes.support[0].stiffness[0]
                                 : (weight - 100) / slide->stiffness;
        double found = recorded_value(&run, 0, recorded_column(&run, "recoil.1.travel"));
        // a support that turns takes a little
        CHECK_BELOW("travel back at rest, relative", found / expected - 1, 1e-3);
        CHECK_BELOW("force [N], relative",
                    recorded_value(&run, 0, recorded_column(&run, "recoil.1.force")) / weight - 1,
                    1e-3);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

// Spin follows the rifling: s_dot tan(alpha)/R; a smooth bore gives none. The mass stays.
static void rifling_gives_spin(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        ld_model model;
        recorded_run run;
        slug_in_a_free_tube(&model);
        model.run.tolerance = 1e-7;
        model.tubes.modes.torsion = 0;
        model.rocket.contact.law = LD_CONTACT_BILATERAL;
        model.rocket.contact.stiffness = 1e10;
        if (i == 0) {
            model.tubes.slot.kind = LD_SLOT_HELIX;
            model.tubes.slot.friction = 0;
            free(model.tubes.slot.angle.data);
            model.tubes.slot.angle = reference_table(3, 2, (double[]){0, 0, 0.3, 0, 3, 0.1});
        }
        recorded_run_make(&run, &model);
        const ld_rocket_summary *rocket = &run.summary.rocket[0];
        double radius = model.tubes.slot.radius;
        double spin = i == 0 ? rocket->exit_speed * tan(0.1) / radius : 0;
        // what is left: the knob bends the tube, and the slot with it
        CHECK_BELOW("spin against the tube [rad/s]", rocket->relative.w_x - spin, 2e-3);
        CHECK_BELOW("mass [kg]", last_value(&run, "rocket.mass") - model.rocket.full.mass, 0);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gas_drives_slug_and_tube),
        cmocka_unit_test(tables_drive_slug_and_tube),
        cmocka_unit_test(lock_lets_go),
        cmocka_unit_test(tube_recoils),
        cmocka_unit_test(rests_at_the_front_stop),
        cmocka_unit_test(rifling_gives_spin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
