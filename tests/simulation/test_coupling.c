// Subsystems integrated apart, exchanging at fixed instants: the error against the run of all
// together falls with the square of the step; and what is written is consistent.
#include <math.h>
#include <string.h>

#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"
#include "support/exit_distance.h"
#include "support/reference_model.h"

// A launch at 30 km/h over sines, whose exit figures depend on the coupling.
static void marching_model(ld_model *model)
{
    reference_vehicle(model, 30 / 3.6);
    ld_road *road = &model->base.vehicle.road;
    road->form = LD_ROAD_SUM;
    road->sine_count = 1;
    road->sine[0] = (ld_road_sine){.amplitude = 5e-3, .wavelength = 2.5};
    model->run.lead_in = 0.1;
    model->run.tolerance = 1e-9;
}

static ld_summary launch(const ld_model *model)
{
    ld_simulation *simulation;
    ld_summary summary = {0};
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary;
}

static void second_order(void **state)
{
    (void)state;
    ld_model model;
    marching_model(&model);
    ld_summary together = launch(&model);
    static const double step[] = {0.8e-3, 0.4e-3, 0.2e-3, 0.1e-3};
    double error[4], balance[4];
    for (int i = 0; i < 4; i++) {
        model.run.coupling_step = step[i];
        ld_summary apart = launch(&model);
        error[i] = exit_distance(&apart, &together);
        balance[i] = fabs(apart.energy.residual_relative);
    }
    for (int i = 1; i < 4; i++)
        CHECK_WITHIN("order of the exit attitude and rates", log2(error[i - 1] / error[i]), 1.8,
                     2.2);
    CHECK_BELOW("exit attitude and rates at 0.1 ms [rad/s]", error[3], 4e-6);
    CHECK_BELOW("energy balance at 0.1 ms, of the largest work", balance[3], 1e-6);
    reference_model_free(&model);
}

// The launch together, and apart with this step.
static void launch_both(double step, ld_summary *together, ld_summary *apart)
{
    ld_model model;
    marching_model(&model);
    *together = launch(&model);
    model.run.coupling_step = step;
    *apart = launch(&model);
    reference_model_free(&model);
}

// Exchanges that fall on the corner of the thrust but for rounding (0.1 s of lead-in, 10 ms).
static void exchange_at_a_corner(void **state)
{
    (void)state;
    ld_summary together, apart;
    launch_both(0.05e-3, &together, &apart);
    CHECK_BELOW("exit attitude and rates at 0.05 ms [rad/s]", exit_distance(&apart, &together),
                1e-6);
    CHECK_NEAR("t_front [s]", apart.rocket[0].t_front, together.rocket[0].t_front, 4e-9);
}

// A step that does not divide the lead-in: ignition is an exchange besides.
static void any_step(void **state)
{
    (void)state;
    ld_summary together, apart;
    launch_both(0.37e-3, &together, &apart);
    CHECK_BELOW("exit rates at 0.37 ms [rad/s]", exit_distance(&apart, &together), 5e-5);
    CHECK_NEAR("t_rear [s]", apart.rocket[0].t_rear, together.rocket[0].t_rear, 1e-6);
}

// A boom whose cylinder closes a loop; wheels and jacks; a turntable with drives on a ship at sea.
static const struct {
    const char *file, *sets[5];
    double exit;
    bool order;
} bases[] = {
    {"erector",
     {"base.drives.lift.length.command=0.24 m", "base.joints.pivot.lock.from=-50 ms"},
     4e-6,
     false},
    {"trailer", {NULL}, 2e-5, true},
    {"ship-turntable", {NULL}, 1e-5, true},
};

static void read_base(size_t i, ld_model *model)
{
    const char *sets[8] = {"run.lead_in=0.1 s", "run.tolerance=1e-9", "run.end=tip"};
    size_t count = 3;
    char path[512];
    ld_messages messages = {0};
    for (int k = 0; bases[i].sets[k]; k++)
        sets[count++] = bases[i].sets[k];
    snprintf(path, sizeof path, LD_SOURCE_DIR "/examples/multibody/%s.yaml", bases[i].file);
    if (scenario_read(path, sets, count, model, &messages))
        fail_msg("%s cannot be read", bases[i].file);
}

static void multibody_bases(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bases / sizeof *bases; i++) {
        ld_model model;
        double error[2];
        read_base(i, &model);
        ld_summary together = launch(&model), apart;
        for (int k = 0; k < 2; k++) {
            model.run.coupling_step = k ? 0.1e-3 : 0.4e-3;
            apart = launch(&model);
            error[k] = exit_distance(&apart, &together);
        }
        printf("    %s: %.3g rad/s at 0.4 ms\n", bases[i].file, error[0]);
        if (bases[i].order)
            CHECK_WITHIN("order of the exit attitude and rates, multibody base",
                         log2(error[0] / error[1]) / 2, 1.8, 2.2);
        CHECK_BELOW("exit attitude and rates at 0.1 ms, multibody base [rad/s]", error[1],
                    bases[i].exit);
        CHECK_BELOW("energy balance, multibody base, of the largest work",
                    apart.energy.residual_relative, 1e-8);
        model_clear(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(second_order),
        cmocka_unit_test(exchange_at_a_corner),
        cmocka_unit_test(any_step),
        cmocka_unit_test(multibody_bases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
