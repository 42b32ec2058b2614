// Guides that grip: drag against its work; shoes pressed between opposite surfaces (a gap below 0)
// against closed forms of a mass between two springs, on a rail that hardly gives.
#include "model/model.h"
#include "support/check.h"
#include "support/launching_run.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double k = 3e6, pressed = 0.2e-3, beside = 0.05e-3, mass = 60;

// A level rail of `stiffness` [N m2], held fast; a rocket on two shoes in its T-slot, without
// damping.
static void rail(ld_model *model, double stiffness)
{
    const unsigned across = 1u << LD_CLAMP_Y | 1u << LD_CLAMP_Z;
    reference_model(model);
    ld_tubes *tubes = &model->tubes;
    model->base.elevation = 0;
    tubes->section[0].bending_stiffness = tubes->section[0].torsion_stiffness = stiffness;
    tubes->modes = (ld_modes){.bending = 2, .torsion = 1, .elements = 8, .span = LD_SPAN_SUPPORTED};
    for (int i = 0; i < 2; i++)
        tubes->support[i] = (ld_support){.at = 2.5 * i, .clamped = across};
    tubes->support[0].clamped |= 1u << LD_CLAMP_X | 1u << LD_CLAMP_ROLL;
    tubes->slot.kind = LD_SLOT_NONE;
    tubes->guide = (ld_guide){.present = true,
                              .form = LD_GUIDE_T_SLOT,
                              .t_slot = {.lips = 0.06, .gap = -pressed, .side_gap = -beside}};
    ld_rocket *rocket = &model->rocket;
    rocket->adaptor_count = 2;
    rocket->adaptor[1] = rocket->adaptor[2];
    rocket->adaptor[0].clearance = rocket->adaptor[1].clearance = NAN;
    rocket->contact = (ld_contact){.law = LD_CONTACT_KELVIN_VOIGT,
                                   .stiffness = k,
                                   .exponent = 1,
                                   .reference_penetration = 1e-3,
                                   .reference_speed = 0.5,
                                   .friction_speed = 2e-3};
    rocket->empty = rocket->full;
    rocket->propellant = 0;
    model->run.tolerance = 1e-7;
}

// Two lips under the shoe carry its share W with what the two over it leave: W = 4 k d while these
// touch, d < the preload, then 2 k (d + preload).
static void springs_share_the_weight(void **state)
{
    (void)state;
    static const double gravity[] = {0.5, 9.80665, 12, 90};
    for (int i = 0; i < 4; i++) {
        ld_model model;
        recorded_run run;
        rail(&model, 1e11);
        model.gravity = gravity[i];
        model.run.end = LD_END_TIME;
        model.run.end_time = 1e-4;
        recorded_run_make(&run, &model);
        double share = model.rocket.full.center[0] / model.rocket.adaptor[1].at;
        printf("  gravity %g m/s2\n", gravity[i]);
        for (int shoe = 0; shoe < 2; shoe++) {
            double W = mass * gravity[i] * (shoe ? share : 1 - share), d = W / (4 * k);
            d = d > pressed ? W / (2 * k) - pressed : d;
            double over = fmax(0, pressed - d), normal = 2 * k * (pressed + d + over + beside);
            size_t y = recorded_column(&run, shoe ? "contact.front.y" : "contact.rear.y");
            CHECK_BELOW("place, over the preload", (recorded_value(&run, 0, y) + d) / pressed,
                        5e-12);
            CHECK_BELOW("sum of the normal forces, relative",
                        run.summary.equilibrium.contact_force[shoe] / normal - 1, 2e-12);
        }
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

// Quarter of the period [s] of a mass on springs of stiffness 2 K about the middle that press by g,
// of which one lifts beyond g; the speed in the middle.
static double quarter(double K, double g, double amplitude, double *speed)
{
    double both = sqrt(2 * K / mass), one = sqrt(K / mass), A = amplitude;
    if (A <= g) {
        *speed = both * A;
        return acos(0) / both;
    }
    double at_g = one * sqrt((A + g) * (A + g) - 4 * g * g);
    *speed = hypot(at_g, both * g);
    return acos(2 * g / (A + g)) / one + atan(both * g / at_g) / both;
}

// The rocket on both springs, then on one of them in turns: across and beside the rail.
static void springs_lift(void **state)
{
    (void)state;
    static const double amplitude[] = {0.7, 1.8};
    ld_model model;
    rail(&model, 1e11);
    model.gravity = 0;
    model.rocket.full.center[0] = 0.5 * model.rocket.adaptor[1].at;
    launching_system *system = launching_system_of(&model);
    for (int n = 0; n < 4; n++) {
        launching_run run;
        double g = n % 2 ? beside : pressed, A = amplitude[n / 2] * g, top;
        double quarter_period = quarter(n % 2 ? 2 * k : 4 * k, g, A, &top);
        int at = system->layout.x + 1 + n % 2;
        launching_run_begin(&run, system, 0.3);
        run.state[at] = A;
        launching_run_follow(&run, 1e-10, quarter_period);
        printf("  %s, %g of the preload: %.3f Hz\n", n % 2 ? "beside" : "across", A / g,
               0.25 / quarter_period);
        CHECK_BELOW("place in the middle, over the amplitude", run.state[at] / A, 2e-5);
        double V = run.state[system->layout.V + 1 + n % 2];
        CHECK_BELOW("speed there, relative", V / -top - 1, 2e-5);
        launching_run_follow(&run, 1e-10, quarter_period);
        CHECK_BELOW("half a period later, over the amplitude", run.state[at] / A + 1, 2e-5);
    }
    launching_system_drop(system);
    reference_model_free(&model);
}

// While all surfaces touch, each shoe rubs with mu k (4 preload + 2 beside) over its way, whatever
// weight and motion add on one side and take from the other.
static void preload_rubs(void **state)
{
    (void)state;
    for (int n = 0; n < 2; n++) {
        ld_model model;
        double mu = n ? 0.15 : 0.4, thrust = 6e3, way = 0;
        rail(&model, 1e8);
        model.gravity = n ? 0 : 9.80665; // turns the rocket about its rear shoe
        ld_rocket *rocket = &model.rocket;
        rocket->contact.friction = mu;
        rocket->motor.thrust.rows = 2;
        memcpy(rocket->motor.thrust.data, (double[]){0, thrust, 5, thrust}, 4 * sizeof(double));
        ld_summary summary = summary_of_run(&model);
        for (int i = 0; i < 2; i++)
            way += model.tubes.length - rocket->start_at - rocket->adaptor[i].at;
        double loss = mu * k * (4 * pressed + 2 * beside) * way;
        double work = thrust * (model.tubes.length - rocket->start_at);
        double speed = sqrt(2 * (work - loss) / mass);
        printf("  friction %g: %.1f N on each shoe\n", mu, loss / way);
        CHECK_BELOW("work of the friction, relative",
                    summary.energy.work[POWER_CONTACT_FRICTION] / -loss - 1, 3e-7);
        if (n)
            CHECK_BELOW("exit speed, relative", summary.rocket[0].exit_speed / speed - 1, 3e-7);
        CHECK_BELOW("energy balance, relative", summary.energy.residual_relative, 1e-9);
        reference_model_free(&model);
    }
}

// Drag over the travel, a share on each adaptor until it is out: on the rail, in a bore. Constant
// thrust and no weight give the exit speed by the works alone.
static void drag_takes_its_work(void **state)
{
    (void)state;
    for (int n = 0; n < 3; n++) {
        ld_model model;
        double thrust = 6e3, drag[6] = {0, 900, 0.8, 300, 2, 500}, scale = 1.3, loss = 0;
        rail(&model, 1e8);
        model.gravity = 0;
        ld_rocket *rocket = &model.rocket;
        if (n == 1)
            model.tubes.guide.present = false;
        if (n == 2) {
            rocket->adaptor[0].leaves_at = 2.8;
            rocket->adaptor[1].leaves_at = 2.6;
        }
        for (int i = 0; i < 2; i++)
            rocket->adaptor[i].clearance = 0.1e-3;
        model.tubes.guide.t_slot.gap = model.tubes.guide.t_slot.side_gap = 0;
        rocket->motor.thrust.rows = 2;
        memcpy(rocket->motor.thrust.data, (double[]){0, thrust, 5, thrust}, 4 * sizeof(double));
        rocket->contact.drag = reference_table(3, 2, drag);
        rocket->contact.drag_scale = scale;
        ld_summary summary = summary_of_run(&model);
        // the integral of the table, to 2 m and on at its last value
        double end = n == 2 ? 2.8 : model.tubes.length, way = end - rocket->start_at;
        double front = (n == 2 ? 2.6 : end) - rocket->adaptor[1].at - rocket->start_at, in = 0.8;
        double to_2m = 0.8 * 600 + 1.2 * 400, all = to_2m + (way - 2) * 500;
        double to_front = front < in ? front * (900 - front / in * 300)
                                     : in * 600 + (front - in) * (300 + (front - in) / 1.2 * 100);
        loss = scale * (all + to_front) / 2;
        double speed = sqrt(2 * (thrust * way - loss) / mass);
        printf("  %s: %.1f J\n", n == 1 ? "bore" : "rail", loss);
        CHECK_BELOW("work of the drag, relative",
                    summary.energy.work[POWER_CONTACT_FRICTION] / -loss - 1, 5e-7);
        CHECK_BELOW("exit speed, relative", summary.rocket[0].exit_speed / speed - 1, 2e-8);
        CHECK_BELOW("energy balance, relative", summary.energy.residual_relative, 1e-9);
        reference_model_free(&model);
    }
}

// Drag over the speed, F_0 + c v: with constant thrust T the speed goes as V (1 - exp(-k t)), the
// way is its integral, with k = 2 c/m of two adaptors' halves until the front one leaves.
static void drag_over_speed(void **state)
{
    (void)state;
    ld_model model;
    const double thrust = 6e3, F_0 = 500, c = 40, scale = 1.2;
    rail(&model, 1e8);
    model.gravity = 0;
    ld_rocket *rocket = &model.rocket;
    for (int i = 0; i < 2; i++)
        rocket->adaptor[i].clearance = 0.1e-3;
    model.tubes.guide.t_slot.gap = model.tubes.guide.t_slot.side_gap = 0;
    rocket->motor.thrust.rows = 2;
    memcpy(rocket->motor.thrust.data, (double[]){0, thrust, 5, thrust}, 4 * sizeof(double));
    rocket->contact.drag_over_speed =
        reference_table(3, 2, (double[]){0, F_0, 10, F_0 + 10 * c, 400, F_0 + 400 * c});
    rocket->contact.drag = reference_table(1, 2, (double[]){0, 100});
    rocket->contact.drag_scale = scale;
    ld_summary summary = summary_of_run(&model);
    double way[2] = {model.tubes.length - rocket->start_at - rocket->adaptor[1].at,
                     rocket->adaptor[1].at};
    double v = 0, t = 0;
    for (int part = 0; part < 2; part++) {
        double share = scale * (part ? 0.5 : 1), rate = share * c / mass;
        double V = (thrust - share * (F_0 + 100)) / (share * c), lasts = 0.1;
        for (int n = 0; n < 60; n++) { // Newton's steps for the way's end
            double fade = exp(-rate * lasts);
            double x = V * lasts + (v - V) * (1 - fade) / rate;
            lasts -= (x - way[part]) / (V + (v - V) * fade);
        }
        v = V + (v - V) * exp(-rate * lasts);
        t += lasts;
    }
    printf("  exit at %.4f m/s, without drag %.4f m/s\n", v,
           sqrt(2 * thrust * (way[0] + way[1]) / mass));
    CHECK_BELOW("exit speed, relative", summary.rocket[0].exit_speed / v - 1, 2e-8);
    CHECK_BELOW("exit, relative", (summary.rocket[0].t_rear - summary.rocket[0].t_ignition) / t - 1,
                3e-5);
    CHECK_BELOW("energy balance, relative", summary.energy.residual_relative, 1e-12);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_share_the_weight),
        cmocka_unit_test(springs_lift),
        cmocka_unit_test(preload_rubs),
        cmocka_unit_test(drag_takes_its_work),
        cmocka_unit_test(drag_over_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
