// Soundings: each form read, its units, what is passed over, and that all say the same.
#include "model/model.h"
#include "support/check.h"

#include <string.h>

#include "scenario/scenario.h"

#define SOUNDINGS LD_SOURCE_DIR "/tests/data/soundings/"

// A flight in the air and the wind of a sounding.
static ld_model read_with(const char *name)
{
    char air[512], wind[512];
    const char *const sets[] = {air, wind};
    ld_model model;
    ld_messages messages;
    snprintf(air, sizeof air, "environment.atmosphere.profile=" SOUNDINGS "%s", name);
    snprintf(wind, sizeof wind, "environment.wind={axes: geographic, profile: " SOUNDINGS "%s}",
             name);
    ld_status status =
        scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", sets, 2, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    assert_int_equal(messages.count, 0);
    return model;
}

static double cell(const ld_table *table, size_t row, size_t column)
{
    assert_true(row < table->rows && column < table->columns);
    return table->data[row * table->columns + column];
}

// The numbers of tests/data/soundings/list.txt, by hand.
static void check_air(const ld_table *air)
{
    assert_true(air->rows == 6 && air->columns == 4);
    CHECK_NEAR("pressure of the first row", cell(air, 0, 1), 97300, 1e-9);
    CHECK_NEAR("its temperature", cell(air, 0, 2), 295.35, 1e-12);
    CHECK_NEAR("geopotential 345 m", cell(air, 0, 0), 345 + 345.0 * 345 / 6356766, 1e-5);
    CHECK_NEAR("geopotential 9485 m", cell(air, 5, 0), 9499.174, 1e-3);
    CHECK_NEAR("pressure of the last row", cell(air, 5, 1), 30000, 1e-9);
    CHECK_NEAR("its temperature", cell(air, 5, 2), 236.15, 1e-12);
    assert_true(cell(air, 5, 3) == 0);
}

static void check_wind(const ld_table *wind, double speed_error)
{
    const double knot = 0.5144444444444444;
    CHECK_NEAR("from south, northwards", cell(wind, 0, 1), 4 * knot, speed_error);
    CHECK_NEAR("from south, eastwards", cell(wind, 0, 2), 0, 1e-14);
    CHECK_NEAR("from south-west, northwards", cell(wind, 2, 1), 18 * knot * sqrt(0.5), speed_error);
    CHECK_NEAR("from south-west, eastwards", cell(wind, 2, 2), 18 * knot * sqrt(0.5), speed_error);
    CHECK_NEAR("from west, eastwards", cell(wind, wind->rows - 1, 2), 62 * knot, speed_error);
}

static void test_list(void **state)
{
    (void)state;
    ld_model m = read_with("list.txt");
    assert_int_equal(m.environment.atmosphere.kind, LD_ATMOSPHERE_PROFILE);
    check_air(&m.environment.atmosphere.profile);
    CHECK_NEAR("humidity", cell(&m.environment.atmosphere.profile, 1, 3), 0.73, 1e-15);
    // a level of wind alone is one of the wind's, not of the air's
    assert_true(m.environment.wind.profile.rows == 7);
    check_wind(&m.environment.wind.profile, 1e-13);
    model_clear(&m);
}

static void test_gsd(void **state)
{
    (void)state;
    ld_model m = read_with("gsd.txt");
    check_air(&m.environment.atmosphere.profile);
    // from dew points of a tenth of a degree
    CHECK_NEAR("humidity", cell(&m.environment.atmosphere.profile, 1, 3), 0.73, 3e-3);
    assert_true(m.environment.wind.profile.rows == 7);
    check_wind(&m.environment.wind.profile, 1e-13);
    model_clear(&m);
}

static void test_wyoming_csv(void **state)
{
    (void)state;
    ld_model m = read_with("wyoming.csv");
    check_air(&m.environment.atmosphere.profile);
    CHECK_NEAR("humidity", cell(&m.environment.atmosphere.profile, 1, 3), 0.73, 1e-15);
    // a level that stands there twice is one
    assert_true(m.environment.wind.profile.rows == 6);
    check_wind(&m.environment.wind.profile, 5e-3);
    model_clear(&m);
}

static void test_rocketpy(void **state)
{
    (void)state;
    ld_model m = read_with("rocketpy.csv");
    const ld_table *air = &m.environment.atmosphere.profile, *wind = &m.environment.wind.profile;
    assert_true(air->rows == 4 && wind->rows == 4);
    assert_true(cell(air, 1, 0) == 1000 && cell(air, 1, 1) == 89876 && cell(air, 1, 2) == 281.65);
    assert_true(cell(wind, 3, 0) == 3000 && cell(wind, 3, 1) == 5.8 && cell(wind, 3, 2) == -0.5);
    model_clear(&m);
}

// GSD as it was: pressures in hPa, winds in tenths of m/s, 32767 for what is missing.
static void test_old_gsd(void **state)
{
    (void)state;
    const char text[] = "254 0 1 JAN 2000\n1 3 4 40.0 10.0 100\n2 0 0 0 7\n3 NONE 10 ms\n"
                        "9 1005 100 150 32767 90 55\n4 850 1500 32767 20 100 60\n"
                        "5 700 3050 -20 -30 110 70\n";
    FILE *file = fopen(LD_BINARY_DIR "/old-gsd.txt", "w");
    fputs(text, file);
    fclose(file);
    const char *const sets[] = {"environment.atmosphere.profile=" LD_BINARY_DIR "/old-gsd.txt",
                                "environment.wind={axes: geographic, profile: " LD_BINARY_DIR
                                "/old-gsd.txt}"};
    ld_model m;
    ld_messages messages;
    assert_int_equal(scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", sets, 2, &m, &messages),
                     LD_OK);
    const ld_table *air = &m.environment.atmosphere.profile, *wind = &m.environment.wind.profile;
    assert_true(air->rows == 2 && wind->rows == 3);
    assert_true(cell(air, 0, 1) == 100500 && cell(air, 0, 3) == 0 && cell(air, 1, 1) == 70000);
    CHECK_NEAR("from east, westwards", cell(wind, 0, 2), -5.5, 1e-14);
    model_clear(&m);
}

// The same table behind a byte order mark, as spreadsheets write it.
static void test_marked(void **state)
{
    (void)state;
    char text[512];
    FILE *file = fopen(SOUNDINGS "rocketpy.csv", "r");
    size_t length = fread(text, 1, sizeof text, file);
    fclose(file);
    file = fopen(LD_BINARY_DIR "/marked.csv", "w");
    fputs("\xef\xbb\xbf", file);
    fwrite(text, 1, length, file);
    fclose(file);
    ld_model m = read_with("rocketpy.csv"), marked;
    const char *const sets[] = {"environment.atmosphere.profile=" LD_BINARY_DIR "/marked.csv"};
    ld_messages messages;
    ld_status status =
        scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", sets, 1, &marked, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    const ld_table *air = &m.environment.atmosphere.profile,
                   *same = &marked.environment.atmosphere.profile;
    assert_true(air->rows == same->rows && air->columns == same->columns);
    assert_memory_equal(air->data, same->data, air->rows * air->columns * sizeof *air->data);
    model_clear(&m);
    model_clear(&marked);
}

// An .eng file as some for Cesaroni's motors are: a mark, and comments behind points.
static void test_engine_with_comments(void **state)
{
    (void)state;
    const char text[] = "\xef\xbb\xbf; by hand\nCTI 75 757 0 3.1 5.2 Cesaroni ; diameter in mm\n"
                        "0.05 100 ; ignition\n0.1 200;\n;\n3.9 0 ; burnout\n";
    FILE *file = fopen(LD_BINARY_DIR "/commented.eng", "w");
    fputs(text, file);
    fclose(file);
    const char *const sets[] = {"rocket.motor.thrust=" LD_BINARY_DIR "/commented.eng"};
    ld_model m;
    ld_messages messages;
    ld_status status = scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", sets, 1, &m, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    const ld_table *thrust = &m.rocket.motor.thrust;
    assert_true(thrust->rows == 4);
    assert_true(cell(thrust, 2, 0) == 0.1 && cell(thrust, 2, 1) == 200 &&
                cell(thrust, 3, 0) == 3.9 && cell(thrust, 3, 1) == 0);
    model_clear(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_list),
        cmocka_unit_test(test_gsd),
        cmocka_unit_test(test_wyoming_csv),
        cmocka_unit_test(test_rocketpy),
        cmocka_unit_test(test_old_gsd),
        cmocka_unit_test(test_marked),
        cmocka_unit_test(test_engine_with_comments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
