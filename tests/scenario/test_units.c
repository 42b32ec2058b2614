// Units: conversions against factors worked out by hand, and what must be refused.
#include "support/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "launchdyn/scenario.h"
#include "model/units.h"

static const double pi = 3.14159265358979323846;

static void test_factors(void **state)
{
    (void)state;
    const struct {
        const char *from, *to;
        double factor;
    } cases[] = {
        {"km/h", "m/s", 1 / 3.6},
        {"mm", "m", 1e-3},
        {"cm", "m", 1e-2},
        {"um", "m", 1e-6},
        {"g", "kg", 1e-3},
        {"t", "kg", 1e3},
        {"ms", "s", 1e-3},
        {"min", "s", 60},
        {"h", "s", 3600},
        {"deg", "rad", pi / 180},
        {"mrad", "rad", 1e-3},
        {"rev", "rad", 2 * pi},
        {"rpm", "rad/s", 2 * pi / 60},
        {"deg/s", "rad/s", pi / 180},
        {"kHz", "Hz", 1e3},
        {"1/s", "Hz", 1},
        {"s-1", "Hz", 1},
        {"kN", "N", 1e3},
        {"kg.m/s2", "N", 1},
        {"kg*m/s^2", "N", 1},
        {"kg.m.s-2", "N", 1},
        {"GPa", "Pa", 1e9},
        {"N/mm2", "Pa", 1e6},
        {"bar", "Pa", 1e5},
        {"kN/mm", "N/m", 1e6},
        {"N.m/deg", "N.m/rad", 180 / pi},
        {"kN.m.s/rad", "N.m.s/rad", 1e3},
        {"g.cm2", "kg.m2", 1e-7},
        {"g/cm3", "kg/m3", 1e3},
        {"cm4", "m4", 1e-8},
        {"kg/m", "kg/m", 1},
        {"%", "", 1e-2},
        {"ft", "m", 0.3048},
        {"kft", "m", 304.8},
        {"ft/s", "m/s", 0.3048},
        {"ft/s2", "m/s2", 0.3048},
        {"mi/h", "m/s", 5280 * 0.3048 / 3600},
        {"lb/ft3", "kg/m3", 0.45359237 / (0.3048 * 0.3048 * 0.3048)},
        {"lbf", "N", 0.45359237 * 9.80665},
        {"psi", "Pa", 0.45359237 * 9.80665 / (0.0254 * 0.0254)},
        {"g", "m/s2", 9.80665},
        {"mg", "m/s2", 9.80665e-3},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char unknown[32], what[64];
        double factor;
        snprintf(what, sizeof what, "%s -> %s", cases[i].from, cases[i].to);
        assert_int_equal(units_factor(cases[i].from, cases[i].to, &factor, unknown), UNITS_OK);
        CHECK_BELOW(what, factor / cases[i].factor - 1, 4.5e-16);
    }
}

static void test_refused(void **state)
{
    (void)state;
    const struct {
        const char *from, *to;
        units_result result;
    } cases[] = {
        {"m", "kg", UNITS_DIMENSION},
        {"rad/s", "Hz", UNITS_DIMENSION},
        {"Hz", "rad/s", UNITS_DIMENSION},
        {"s", "Hz", UNITS_DIMENSION},
        {"Hz", "s", UNITS_DIMENSION},
        {"%", "rad", UNITS_DIMENSION},
        {"rad", "", UNITS_DIMENSION},
        {"N.m", "N.m/rad", UNITS_DIMENSION},
        {"m0.5", "m", UNITS_SYNTAX},
        {"m^0.5", "m", UNITS_SYNTAX},
        {"m^(1/2)", "m", UNITS_SYNTAX},
        {"m0", "", UNITS_SYNTAX},
        {"m10", "m", UNITS_SYNTAX},
        {"2 m", "m", UNITS_SYNTAX},
        {"m @ 3", "m", UNITS_SYNTAX},
        {"m since 3", "m", UNITS_SYNTAX},
        {"lg(re m)", "m", UNITS_SYNTAX},
        {"N m", "N.m", UNITS_SYNTAX},
        {"m.", "m", UNITS_SYNTAX},
        {".m", "m", UNITS_SYNTAX},
        {"m//s", "m/s", UNITS_SYNTAX},
        {"m-", "m", UNITS_SYNTAX},
        {"1", "", UNITS_SYNTAX},
        {"", "m", UNITS_SYNTAX},
        {"\xc2\xb5m", "m", UNITS_SYNTAX},
        {"kph", "m/s", UNITS_UNKNOWN},
        {"Nm", "N.m", UNITS_UNKNOWN},
        {"degree", "rad", UNITS_UNKNOWN},
        {"inch", "m", UNITS_UNKNOWN},
        {"M", "m", UNITS_UNKNOWN},
        {"kg", "m/s2", UNITS_DIMENSION},
        {"ug", "m/s2", UNITS_DIMENSION},
        {"g.m/s2", "m/s2", UNITS_DIMENSION},
        {"g", "m/s", UNITS_DIMENSION},
        {"g/Hz", "m/s", UNITS_DIMENSION},
        {"g", "N", UNITS_DIMENSION},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char unknown[32];
        double factor;
        units_result result = units_factor(cases[i].from, cases[i].to, &factor, unknown);
        if (result != cases[i].result)
            fail_msg("\"%s\" for \"%s\": result %d, not %d", cases[i].from, cases[i].to, result,
                     cases[i].result);
        assert_true(isnan(factor) || result == UNITS_OK);
    }
}

// A decimal prefix must not cost the last digit.
static void test_scale_is_exact(void **state)
{
    (void)state;
    assert_true(units_scale(82.5, 1e-3) == 0.0825);
    assert_true(units_scale(0.3, 1e-3) == 0.0003);
    assert_true(units_scale(210, 1e9) == 210e9);
    assert_true(units_scale(1, 1e-2) == 0.01);
    assert_true(units_scale(7, 1) == 7);
    // whole numbers of small units are the doubles next to them
    for (int exponent = 2; exponent <= 9; exponent++)
        for (int k = 1; k < 1000; k++) {
            char text[32], factor[32];
            snprintf(text, sizeof text, "%de-%d", k, exponent);
            snprintf(factor, sizeof factor, "1e-%d", exponent);
            assert_true(units_scale(k, strtod(factor, NULL)) == strtod(text, NULL));
        }
}

static void test_suggestions(void **state)
{
    (void)state;
    assert_string_equal(units_suggestion("kph"), "km/h");
    assert_string_equal(units_suggestion("Nm"), "N.m");
    assert_string_equal(units_suggestion("Deg"), "deg");
    assert_string_equal(units_suggestion("gpa"), "GPa");
    assert_string_equal(units_suggestion("feet"), "ft");
    assert_string_equal(units_suggestion("Gs"), "g");
    assert_null(units_suggestion("lightyear"));
    name_suggestion best = suggestion_begin("clerance");
    suggestion_offer(&best, "at");
    suggestion_offer(&best, "clearance");
    assert_string_equal(best.name, "clearance");
}

static void test_quantities(void **state)
{
    (void)state;
    const struct {
        const char *text, *unit;
        double value; // NaN: refused
    } cases[] = {{"100", "m", 100},     {"0.1 km", "m", 100},       {"-3.5mm", "mm", -3.5},
                 {"2 s", "ms", 2000},   {"1 kHz", "Hz", 1000},      {"50 %", "", 0.5},
                 {"7", "", 7},          {"2 s", "m", NAN},          {"", "m", NAN},
                 {"x", "m", NAN},       {"1,5 m", "m", NAN},        {"1e999 m", "m", NAN},
                 {"10 ft", "m", 3.048}, {"-2 g", "m/s2", -19.6133}, {"5 g", "kg", 0.005},
                 {"3 metre", "m", NAN}, {"nan", "m", NAN},          {"inf m", "m", NAN}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ld_error error = {0};
        double value = 17;
        ld_status status = ld_read_quantity(cases[i].text, cases[i].unit, &value, &error);
        assert_int_equal(status, isnan(cases[i].value) ? LD_ERR_INPUT : LD_OK);
        assert_true(value == (status ? 17 : cases[i].value));
        assert_int_equal(*error.text != '\0', status != LD_OK);
        if (strstr(cases[i].text, "metre"))
            assert_string_equal(error.text,
                                "found \"3 metre\", expected a number in m; did you mean \"m\"?");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_factors),        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_scale_is_exact), cmocka_unit_test(test_suggestions),
        cmocka_unit_test(test_quantities),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
