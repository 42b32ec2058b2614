// Flights through measured air: rows of us1976 are us1976; its scale and offset act as on that.
#include "model/model.h"
#include "support/check.h"

#include "environment/atmosphere.h"
#include "scenario/scenario.h"
#include "support/recorded_run.h"

#define PROFILE LD_BINARY_DIR "/measured-air.csv"

static void write_profile(double step, double top)
{
    const ld_atmosphere model = {.kind = LD_ATMOSPHERE_US1976, .density_scale = 1};
    atmosphere standard;
    assert_int_equal(atmosphere_build(&standard, &model, NULL), LD_OK);
    FILE *file = fopen(PROFILE, "w");
    assert_non_null(file);
    fprintf(file, "height [km], pressure [hPa], temperature [K]\n");
    for (double z = 0; z <= top; z += step) {
        double T, p;
        atmosphere_state(&standard, z, &T, &p);
        fprintf(file, "%.17g, %.17g, %.17g\n", z / 1000, p / 100, T);
    }
    fclose(file);
}

static ld_flight_summary fly(const char *above, const char *scale)
{
    const char *const set[] = {above,
                               scale,
                               "flight.velocity=6.5 37.2 0 m/s",
                               "flight.attitude.pitch=80 deg",
                               "environment.wind={speed: 5 m/s, heading: 40 deg}",
                               "environment.temperature_offset=7 K",
                               "run.flight_tolerance=1e-10"};
    ld_model model;
    ld_messages messages;
    static ld_summary summary;
    if (scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", set, 7, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    summary = summary_of_run(&model);
    model_clear(&model);
    return summary.rocket[0].flight;
}

static void test_rows_of_the_standard(void **state)
{
    (void)state;
    const char *const scale = "environment.density_scale=0.95";
    write_profile(250, 12000);
    ld_flight_summary measured = fly("environment.atmosphere={profile: " PROFILE "}", scale);
    ld_flight_summary standard = fly("environment.atmosphere=us1976", scale);
    printf("    apogee %.3f m, range %.3f m\n", standard.apogee, standard.range);
    CHECK_NEAR("apogee [m]", measured.apogee, standard.apogee, 1e-6);
    CHECK_NEAR("range [m]", measured.range, standard.range, 1e-6);
    CHECK_NEAR("largest Mach number", measured.max_mach, standard.max_mach, 1e-9);
    ld_flight_summary thick =
        fly("environment.atmosphere={profile: " PROFILE "}", "environment.density_scale=1");
    CHECK_WITHIN("apogee in thinner air over that in air [m]", measured.apogee - thick.apogee, 50,
                 500);
}

// One row on the ground, and us1976 from there on.
static void test_single_row(void **state)
{
    (void)state;
    const char *const scale = "environment.density_scale=1";
    ld_flight_summary measured =
        fly("environment.atmosphere={profile: [[0 m, 101325 Pa, 288.15 K]]}", scale);
    ld_flight_summary standard = fly("environment.atmosphere=us1976", scale);
    CHECK_NEAR("apogee [m]", measured.apogee, standard.apogee, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_of_the_standard),
        cmocka_unit_test(test_single_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
