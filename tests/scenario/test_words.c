// Launchers in words, as `check` tells them.
#include "support/check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"
#include "model/model.h"

// The words for an example with changes.
static void check_words(const char *example, const char *const *sets, size_t count,
                        const char *expected)
{
    char file[512], *text = NULL;
    size_t length;
    ld_model *model;
    ld_messages messages;
    snprintf(file, sizeof file, "%s/%s", LD_SOURCE_DIR, example);
    ld_status status = ld_scenario_read(file, sets, count, &model, &messages);
    if (status)
        ld_messages_print(&messages, stderr);
    assert_int_equal(status, LD_OK);
    FILE *stream = open_memstream(&text, &length);
    ld_model_describe(model, stream);
    fclose(stream);
    assert_string_equal(text, expected);
    free(text);
    ld_model_free(model);
}

#define GUIDE                                                                                      \
    "# guide: 18 tubes, each a bore, 3 m long\n"                                                   \
    "#   from 0 m: bore radius 82.5 mm, wall 2.5 mm, EI 969.1 kN.m2, GJ 745.4 kN.m2, 10.33 kg/m\n" \
    "# slot: a helix of 4 deg at the radius 82.5 mm, friction 0.1\n"
#define SUPPORTS "# supports: springs at 0.4 m, springs at 1.8 m\n"
#define ROCKET                                                                                     \
    "# rocket: 60 kg, from 0.1 m, on adaptors rear (0 m, clearance 0.3 mm), middle (1.2 m, "       \
    "0.5 mm), front (1.9 m, 0.4 mm)\n"
#define DRIVE "# drive: a motor of at most 15 kN, for 2.55 s; the lock lets go at 5 kN\n"

static void test_bore(void **state)
{
    (void)state;
    check_words("examples/fixed.yaml", NULL, 0,
                "# base: fixed; tube 19.8 deg up\n" GUIDE SUPPORTS ROCKET DRIVE);
    const char *sets[] = {"tubes.layout.rows=1",
                          "tubes.layout.columns=1",
                          "firing.1.tube=1",
                          "tubes.slot=none",
                          "base.elevation=-5 deg",
                          "rocket.lock=none",
                          "rocket.contact.law=bilateral"};
    check_words("examples/fixed.yaml", sets, sizeof sets / sizeof *sets,
                "# base: fixed; tube 5 deg down\n"
                "# guide: a bore, 3 m long\n"
                "#   from 0 m: bore radius 82.5 mm, wall 2.5 mm, EI 969.1 kN.m2, GJ 745.4 kN.m2, "
                "10.33 kg/m\n" SUPPORTS
                "# rocket: 60 kg, from 0.1 m, on adaptors rear (0 m), middle (1.2 m), front "
                "(1.9 m), held on the axis\n"
                "# drive: a motor of at most 15 kN, for 2.55 s; no lock\n");
}

static void test_bases(void **state)
{
    (void)state;
    check_words(
        "examples/ship.yaml", NULL, 0,
        "# base: a ship, moved as prescribed; tube 40 deg up, 60 deg to the left\n" GUIDE SUPPORTS
            ROCKET DRIVE);
    check_words("examples/reference.yaml", NULL, 0,
                "# base: a vehicle on 6 wheels\n" GUIDE SUPPORTS ROCKET DRIVE);
}

static void test_flight_alone(void **state)
{
    (void)state;
    check_words("examples/flight.yaml", NULL, 0, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bore), cmocka_unit_test(test_bases),
                                       cmocka_unit_test(test_flight_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
