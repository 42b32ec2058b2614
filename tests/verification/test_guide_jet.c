// The jet of a rocket that has left on the front end of its guide, against the closed form of two
// bodies: the impulse over the exit by its work, of a rocket that burns on, or out on the way.
#include <stdlib.h>

#include "elements/exchange.h"
#include "model/model.h"
#include "support/check.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double reach = 3, full = 800, scale = 1.4; // [m], [N] at the tip

// A heavy tube that nothing holds along itself, a rocket of constant mass that touches it across
// alone, no weight, no air.
static void free_tube(ld_model *model, double thrust, double burns)
{
    reference_model(model);
    ld_rocket *rocket = &model->rocket;
    model->gravity = 0;
    model->environment.atmosphere.kind = LD_ATMOSPHERE_NONE;
    model->environment.ground = LD_GROUND_NONE;
    model->tubes.slot.kind = LD_SLOT_NONE;
    model->tubes.modes.bending = 2;
    model->tubes.modes.torsion = 1;
    for (int k = 0; k < model->tubes.support_count; k++)
        model->tubes.support[k].stiffness[0] = model->tubes.support[k].damping[0] = 0;
    model->tubes.support[0].stiffness[0] = 1e-6;
    rocket->contact.law = LD_CONTACT_BILATERAL;
    rocket->contact.friction = 0;
    rocket->lock.present = false;
    rocket->propellant = 0;
    rocket->empty = rocket->full;
    double rows[8] = {0, thrust, burns, thrust, burns + 1e-9, 0, 9, 0};
    free(rocket->motor.thrust.data);
    rocket->motor.thrust = reference_table(4, 2, rows);
    model->tubes.jet = reference_table(2, 2, (double[]){0, full, reach, 0});
    model->tubes.jet_scale = scale;
    model->run.tolerance = 1e-9;
    model->run.end = LD_END_TIME;
    model->run.end_time = 0.6;
}

static double mass_of(const ld_model *model)
{
    const ld_tubes *tubes = &model->tubes;
    return tubes->length * tubes->section[0].mass_per_length + tubes->tail.mass;
}

// d'' = T/m + F/M (1 - d/reach) = A - B d, from d = 0 at the speed v, until reach or for `longest`:
// the tube's speed.
static double speed_by_hand(const ld_model *model, double thrust, double v, double longest)
{
    double F = scale * full, M = mass_of(model);
    double B = F / (M * reach), A = thrust / model->rocket.full.mass + F / M, w = sqrt(B);
    double low = 0, high = longest;
    for (int i = 0; i < 200; i++) {
        double t = 0.5 * (low + high);
        if (A / B * (1 - cos(w * t)) + v / w * sin(w * t) < reach)
            low = t;
        else
            high = t;
    }
    double t = high;
    // int F/M (1 - d/reach)
    double way = A / B * (t - sin(w * t) / w) + v / B * (1 - cos(w * t));
    return F / M * (t - way / reach);
}

static void impulse_over_the_exit(void **state)
{
    (void)state;
    for (int n = 0; n < 2; n++) {
        ld_model model;
        double thrust = 12e3;
        free_tube(&model, thrust, 9);
        ld_summary calm;
        ld_table jet = model.tubes.jet;
        model.tubes.jet.rows = 0;
        calm = summary_of_run(&model);
        model.tubes.jet = jet;
        double v = calm.rocket[0].exit_speed, burns = 9;
        if (n) { // burns out on the way through the jet's reach
            burns = calm.rocket[0].t_rear + 0.03;
            reference_model_free(&model);
            free_tube(&model, thrust, burns);
        }
        ld_summary run = summary_of_run(&model);
        double u = speed_by_hand(&model, thrust, v, n ? 0.03 : 1);
        double work = 0.5 * mass_of(&model) * u * u;
        printf("  %s: tube at %.4f m/s, %.4g J\n", n ? "burnt out" : "burning", u, work);
        CHECK_BELOW("exit speed by the jet, relative", run.rocket[0].exit_speed / v - 1, 1e-12);
        CHECK_BELOW("work of the jet, relative", run.energy.work[POWER_GUIDE_JET] / work - 1, 5e-7);
        CHECK_BELOW("energy balance, relative", run.energy.residual_relative, 8e-14);
        reference_model_free(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(impulse_over_the_exit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
