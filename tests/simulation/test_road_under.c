// link: -Wl,--wrap=sine_cosine
// The table of a random road covers where the wheels come: in a run no harmonics are summed. The
// linker leads the sums' blocks of sines through a counter; the platforms ask for two at a time.
#include "math/sine_cosine.h"
#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/reference_model.h"

static long sums;

void __real_sine_cosine(int n, const double *angle, double *sine, double *cosine);
void __wrap_sine_cosine(int n, const double *angle, double *sine, double *cosine);

void __wrap_sine_cosine(int n, const double *angle, double *sine, double *cosine)
{
    sums += n > 2;
    __real_sine_cosine(n, angle, sine, cosine);
}

// Sums at the build (which fills the table) and in the run.
static void count_sums(ld_model *model, long *build, long *run)
{
    ld_error error;
    ld_simulation *simulation;
    ld_summary summary;
    sums = 0;
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    *build = sums;
    if (ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    *run = sums - *build;
    ld_simulation_free(simulation);
}

static void check_sums(const char *what, double speed, double lead_in, double fired, double until)
{
    ld_model model;
    long build, run;
    reference_vehicle(&model, speed);
    ld_road *given = &model.base.vehicle.road;
    given->form = LD_ROAD_SUM;
    given->iso_class = 0;
    given->harmonics = 100;
    given->seed = 1;
    given->wavelengths[0] = 0.5;
    given->wavelengths[1] = 50;
    model.tubes.modes.bending = 2;
    model.run.lead_in = lead_in;
    model.firing[0].at = fired;
    if (until > 0) {
        model.run.end = LD_END_TIME;
        model.run.end_time = until;
    }
    count_sums(&model, &build, &run);
    printf("  %s: %ld blocks of sines fill the table\n", what, build);
    assert_true(build > 0);
    CHECK_BELOW("blocks of sines in the run", (double)run, 0);
    reference_model_free(&model);
}

static void test_no_sums(void **state)
{
    (void)state;
    check_sums("to the tip, after a lead-in", 20, 0.3, 0, 0);
    check_sums("fired later", 20, 0, 0.3, 0);
    check_sums("to a time", 20, 0, 0, 0.3);
    check_sums("parked", 0, 0.01, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_no_sums)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
