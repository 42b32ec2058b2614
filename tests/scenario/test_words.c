// Launchers in words, as `check` reports them.
#include "support/check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"

// The words for an example with changes, to be freed.
static char *words_for(const char *example, const char *const *sets, size_t count)
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
    ld_model_free(model);
    return text;
}

static void check_words(const char *example, const char *const *sets, size_t count,
                        const char *expected)
{
    char *text = words_for(example, sets, count);
    assert_string_equal(text, expected);
    free(text);
}

#define GUIDE                                                                                      \
    "# guides: 18 bores, each 3 m long\n"                                                          \
    "#   from 0 m: bore radius 82.5 mm, wall 2.5 mm, EI 969.1 kN.m2, GJ 745.4 kN.m2, 10.33 kg/m\n" \
    "# slot: a helix of 4 deg at the radius 82.5 mm, friction 0.1\n"
#define SUPPORTS "# supports: springs at 0.4 m, springs at 1.8 m\n"
#define ROCKET                                                                                     \
    "# rocket: 60 kg, from 0.1 m, on adaptors rear (0 m, clearance 0.3 mm), middle (1.2 m, "       \
    "0.5 mm), front (1.9 m, 0.4 mm)\n"
#define DRIVE "# drive: a motor of at most 15 kN, for 2.55 s; the lock releases at 5 kN\n"

static void test_bore(void **state)
{
    (void)state;
    check_words("examples/fixed.yaml", NULL, 0,
                "# base: fixed; launcher 19.8 deg up\n" GUIDE SUPPORTS ROCKET DRIVE);
    const char *sets[] = {"tubes.layout.rows=1",
                          "tubes.layout.columns=1",
                          "firing.1.tube=1",
                          "tubes.slot=none",
                          "base.elevation=-5 deg",
                          "rocket.lock=none",
                          "rocket.contact.law=bilateral"};
    check_words("examples/fixed.yaml", sets, sizeof sets / sizeof *sets,
                "# base: fixed; launcher 5 deg down\n"
                "# guide: a bore, 3 m long\n"
                "#   from 0 m: bore radius 82.5 mm, wall 2.5 mm, EI 969.1 kN.m2, GJ 745.4 kN.m2, "
                "10.33 kg/m\n" SUPPORTS
                "# rocket: 60 kg, from 0.1 m, on adaptors rear (0 m), middle (1.2 m), front "
                "(1.9 m), held to the axis by springs\n"
                "# drive: a motor of at most 15 kN, for 2.55 s; no lock\n");
}

// The same rocket on a rail, whatever guides it.
static void check_guide(const char *guide, const char *words)
{
    char expected[2048];
    const char *sets[] = {guide,
                          "tubes.layout={rows: 1, columns: 1}",
                          "firing.1.tube=1",
                          "tubes.slot=none",
                          "rocket.adaptors.2.clearance=0 mm",
                          "rocket.adaptors.1.leaves_at=2.8 m",
                          "rocket.adaptors.1.falls_off.mass=0.5 kg"};
    snprintf(expected, sizeof expected,
             "# base: fixed; launcher 19.8 deg up\n%s"
             "#   from 0 m: wall 2.5 mm, EI 969.1 kN.m2, GJ 745.4 kN.m2, 10.33 kg/m\n" SUPPORTS
             "# rocket: 60 kg, from 0.1 m, on shoes rear (0 m, gaps 0.3 mm wider, leaves "
             "at 2.8 m, falls off: 0.5 kg), middle "
             "(1.2 m), front (1.9 m, gaps 0.4 mm wider)\n" DRIVE,
             words);
    check_words("examples/fixed.yaml", sets, sizeof sets / sizeof *sets, expected);
}

static void test_surfaces(void **state)
{
    (void)state;
    check_guide("tubes.guide={line: 160 0 mm, t_slot: {at: -90 0 mm, lips: 60 mm, gap: 0.5 mm, "
                "side_gap: 0.3 mm}}",
                "# guide: a rail, 3 m long, its line 160 mm above the elastic axis\n"
                "#   T-slot 90 mm below the line, lips 60 mm apart, gap 0.5 mm, at the sides "
                "0.3 mm\n");
    check_guide("tubes.guide={tower: {rails: 3, first: 30 deg, gap: 0.8 mm}}",
                "# guide: a tower of 3 rails, 3 m long\n"
                "#   the first rail at 30 deg, gap 0.8 mm\n");
    check_guide("tubes.guide={surfaces: [{name: floor, at: -80 0 mm, normal: 180 deg, gap: 0 mm}, "
                "{name: cheek, at: 0 -40 mm, normal: -90 deg, gap: 1 mm, shape: round}]}",
                "# guide: a rail, 3 m long\n"
                "#   surface floor: flat, 80 mm below the line, towards 180 deg, gap 0 mm\n"
                "#   surface cheek: round, 40 mm left of the line, towards -90 deg, gap 1 mm\n");
}

static void test_air(void **state)
{
    (void)state;
    const char *set =
        "rocket.aerodynamics={model: body, area: 0.02 m2, emerged: {nose: 2.5 m, drag: 1.2, "
        "diameter: 160 mm}}";
    check_words("examples/fixed.yaml", &set, 1,
                "# base: fixed; launcher 19.8 deg up\n" GUIDE SUPPORTS ROCKET DRIVE
                "# air: on what has come out of the bore, up to 2.5 m before the rear adaptor\n");
    check_words(
        "examples/rail/tower.yaml", NULL, 0,
        "# base: fixed; launcher 85 deg up\n# guide: a tower of 4 rails, 5 m long\n#   the first "
        "rail at 45 deg, gap 0.5 mm\n#   from 0 m: EI 40 MN.m2, GJ 10 MN.m2, 60 kg/m\n# supports: "
        "springs at 0.2 m, springs at 2.2 m\n# rocket: 80 kg, from 0.4 m, on shoes rear (0 m), "
        "front (1.6 m)\n# drive: a motor of at most 7 kN, for 4.1 s; the lock releases at 2 kN\n# "
        "air: on the whole rocket on its tower, from the start on\n");
}

static void test_line(void **state)
{
    (void)state;
    const char *line_set =
        "rocket.line={length: 250 m, mass_per_length: 8 g/m, diameter: 4 mm, stiffness: 10 kN, "
        "slack: 0.4 m, breaking_force: 2 kN, container_on: launcher}";
    const char *sets[] = {line_set, "tubes.layout={rows: 1, columns: 1}",
                          "firing=[{tube: 1, at: 0 s}]"};
    const char *const words =
        "# line: 250 m of 8 g/m, out of a container on the launcher, 0.4 m of "
        "it slack; it breaks at 2 kN\n";
    for (int i = 0; i < 2; i++) {
        char *text = words_for(i ? "examples/reference.yaml" : "examples/ship.yaml", sets, 3);
        const char *line = strstr(text, "# line: ");
        assert_non_null(line);
        assert_int_equal(strncmp(line, words, strlen(words)), 0);
        assert_string_equal(
            line + strlen(words),
            i ? "#   after the exit the container goes on with the velocity that it "
                "had there\n"
              : "");
        free(text);
    }
    sets[0] =
        "rocket.line={length: 250 m, mass_per_length: 8 g/m, diameter: 4 mm, stiffness: 10 kN}";
    char *text = words_for("examples/reference.yaml", sets, 3);
    assert_non_null(strstr(text, "# line: 250 m of 8 g/m, out of a container on the ground\n"));
    assert_null(strstr(text, "after the exit"));
    free(text);
}

static void test_planes(void **state)
{
    (void)state;
    const char *sets[] = {
        "tubes.layout={rows: 1, columns: 1}", "firing.1.tube=1",
        "tubes.sections=[{from: 0 m, bore_radius: 82.5 mm, mass_per_length: 10 kg/m, "
        "axial_stiffness: 3e8 N, bending_stiffness_y: 0.2 MN.m2, bending_stiffness_z: 900 N.m2, "
        "torsion_stiffness: 80 kN.m2, polar_inertia: 0.03 kg.m}]"};
    check_words(
        "examples/fixed.yaml", sets, sizeof sets / sizeof *sets,
        "# base: fixed; launcher 19.8 deg up\n"
        "# guide: a bore, 3 m long\n"
        "#   from 0 m: bore radius 82.5 mm, EI 200 kN.m2 about y, 900 N.m2 about z, GJ "
        "80 kN.m2, 10 kg/m\n"
        "# slot: a helix of 4 deg at the radius 82.5 mm, friction 0.1\n" SUPPORTS ROCKET DRIVE);
}

static void test_clamps(void **state)
{
    (void)state;
    const char *sets[] = {
        "tubes.supports=[{at: 0.4 m, clamped: all}, {at: 1 m, clamped: [y]}, {at: "
        "1.8 m, stiffness: 1e6 0 0 N/m, clamped: [y, z, roll]}]"};
    check_words("examples/fixed.yaml", sets, 1,
                "# base: fixed; launcher 19.8 deg up\n" GUIDE
                "# supports: a clamp at 0.4 m, a clamp of y at 1 m, a clamp of y, z and roll, with "
                "springs, at 1.8 m\n" ROCKET DRIVE);
}

static void test_pressure(void **state)
{
    (void)state;
    check_words(
        "examples/line-thrower.yaml", NULL, 0,
        "# base: fixed; launcher 30 deg up\n"
        "# guide: a bore, 1.5 m long\n"
        "#   from 0 m: bore radius 40 mm, wall 4 mm, EI 65.32 kN.m2, GJ 49.11 kN.m2, 2.85 kg/m\n"
        "# supports: springs at 0.1 m, springs at 0.8 m\n"
        "# rocket: 4 kg, from 0.1 m, on adaptors rear (0 m, clearance 0.2 mm), front (0.3 m, 0.2 "
        "mm)\n"
        "# drive: 12 l of gas at 1 MPa against 100 kPa; no lock\n"
        "# line: 250 m of 8 g/m, out of a container on the launcher; it breaks at 2 kN\n");
    check_words("examples/spin-rig.yaml", NULL, 0,
                "# base: fixed; launcher 10 deg up\n# guide: a bore, 2 m long\n#   from 0 m: bore "
                "radius 20 mm, wall 18 mm, EI 317.5 kN.m2, GJ 244.2 kN.m2, 25.75 kg/m\n#   from 1 "
                "m: bore radius 20 mm, wall 12 mm, EI 146.6 kN.m2, GJ 112.7 kN.m2, 15.39 kg/m\n# "
                "slot: a helix of 0 deg to 6 deg at the radius 20 mm, friction 0.05\n# supports: "
                "springs at 0.2 m with a recoil slide of 200 mm, springs at 0.8 m\n# rocket: 1 kg, "
                "from 0.1 m, on adaptors band (0 m, clearance 0.02 mm), front (0.1 m, 0.05 mm)\n# "
                "drive: a pressure over time, of at most 8 MPa; the lock releases at 500 N\n");
}

static void test_bases(void **state)
{
    (void)state;
    check_words(
        "examples/ship.yaml", NULL, 0,
        "# base: prescribed, a ship; launcher 40 deg up, 60 deg to the left\n" GUIDE SUPPORTS ROCKET
            DRIVE);
    check_words("examples/reference.yaml", NULL, 0,
                "# base: vehicle on 6 wheels\n" GUIDE SUPPORTS ROCKET DRIVE);
}

static void test_flight_alone(void **state)
{
    (void)state;
    check_words("examples/flight.yaml", NULL, 0, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bore),        cmocka_unit_test(test_surfaces),
        cmocka_unit_test(test_air),         cmocka_unit_test(test_line),
        cmocka_unit_test(test_planes),      cmocka_unit_test(test_clamps),
        cmocka_unit_test(test_pressure),    cmocka_unit_test(test_bases),
        cmocka_unit_test(test_flight_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
