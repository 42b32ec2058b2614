// Units against UDUNITS with the same units reported in its own words: what is taken, and the
// factors.
// link: -ludunits2
#include "support/check.h"

#include <stdbool.h>
#include <string.h>

#include <udunits2.h>

#include "model/units.h"

enum { BASES = 5, UNITS = BASES + 19, PREFIXES = 8 };

// UDUNITS loses memory at texts that it refuses.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libudunits2";
}

static const char *const base[BASES] = {"m", "kg", "s", "rad", "K"};
static const struct {
    const char *symbol, *definition;
    int power[BASES]; // of the base units
} derived[] = {
    {"g", "0.001 kg", {0, 1}},
    {"t", "1000 kg", {0, 1}},
    {"min", "60 s", {0, 0, 1}},
    {"h", "3600 s", {0, 0, 1}},
    {"Hz", "s-1", {0, 0, -1}},
    {"deg", "0.017453292519943295 rad", {0, 0, 0, 1}},
    {"N", "kg.m.s-2", {1, 1, -2}},
    {"Pa", "N.m-2", {-1, 1, -2}},
    {"J", "N.m", {2, 1, -2}},
    {"W", "J.s-1", {2, 1, -3}},
    {"bar", "100000 Pa", {-1, 1, -2}},
    {"rev", "6.283185307179586 rad", {0, 0, 0, 1}},
    {"rpm", "rev/min", {0, 0, -1, 1}},
    {"ft", "0.3048 m", {1}},
    {"mi", "1609.344 m", {1}},
    {"lb", "0.45359237 kg", {0, 1}},
    {"lbf", "4.4482216152605 N", {1, 1, -2}},
    {"psi", "6894.757293168361 Pa", {-1, 1, -2}},
    {"%", "0.01", {0}},
};
static const struct {
    const char *symbol;
    double factor;
} prefixes[] = {{"n", 1e-9}, {"u", 1e-6}, {"m", 1e-3}, {"c", 1e-2},
                {"h", 1e2},  {"k", 1e3},  {"M", 1e6},  {"G", 1e9}};

static ut_system *make_system(void)
{
    ut_set_error_message_handler(ut_ignore);
    ut_system *system = ut_new_system();
    for (int i = 0; i < BASES; i++)
        ut_map_symbol_to_unit(base[i], UT_ASCII, ut_new_base_unit(system));
    for (int i = 0; i < PREFIXES; i++)
        ut_add_symbol_prefix(system, prefixes[i].symbol, prefixes[i].factor);
    for (int i = 0; i < UNITS - BASES; i++)
        ut_map_symbol_to_unit(derived[i].symbol, UT_ASCII,
                              ut_parse(system, derived[i].definition, UT_ASCII));
    return system;
}

static const char *symbol(int i)
{
    return i < BASES ? base[i] : derived[i - BASES].symbol;
}

// What it makes of a text for a target, where it knows the text; factor NaN of another dimension.
static bool by_udunits(ut_system *system, const char *text, const char *target, double *factor)
{
    ut_unit *from = ut_parse(system, text, UT_ASCII);
    ut_unit *to = ut_parse(system, target[0] ? target : "1", UT_ASCII);
    ut_unit *one = ut_get_dimensionless_unit_one(system);
    bool known = from != NULL;
    assert_true(to && one);
    *factor = NAN;
    ut_unit *ratio = from ? ut_divide(from, to) : NULL;
    if (ratio && ut_is_dimensionless(ratio)) {
        cv_converter *converter = ut_get_converter(ratio, one);
        *factor = cv_convert_double(converter, 1);
        cv_free(converter);
    }
    ut_free(ratio);
    ut_free(from);
    ut_free(to);
    ut_free(one);
    return known;
}

// Of the texts compared: all, those taken, of the dimension asked for, with equal bits; the largest
// deviation of a factor.
static struct {
    int texts, taken, same, equal;
    double worst;
} tally;

static void compare(ut_system *system, const char *text, const char *target)
{
    double ours, theirs;
    char unknown[32];
    units_result result = units_factor(text, target, &ours, unknown);
    bool known = by_udunits(system, text, target, &theirs);
    if (known != (result == UNITS_OK || result == UNITS_DIMENSION) ||
        (known && isnan(theirs) != (result == UNITS_DIMENSION)))
        fail_msg("\"%s\" for \"%s\": %d and %g, UDUNITS %d and %g", text, target, (int)result, ours,
                 known, theirs);
    tally.texts++;
    tally.taken += known;
    if (result == UNITS_OK) {
        tally.same++;
        tally.equal += ours == theirs;
        tally.worst = fmax(tally.worst, fabs(ours / theirs - 1));
    }
}

static void test_every_unit_with_every_prefix(void **state)
{
    ut_system *system = *state;
    static const char *const targets[] = {"m", "kg", "s", "rad", "K",     "Hz",
                                          "N", "Pa", "J", "W",   "rad/s", ""};
    char text[32];
    memset(&tally, 0, sizeof tally);
    for (int i = 0; i < UNITS; i++)
        for (int p = -1; p < PREFIXES; p++) {
            // "%" has none in a scenario
            if (p >= 0 && strcmp(symbol(i), "%") == 0)
                continue;
            snprintf(text, sizeof text, "%s%s", p < 0 ? "" : prefixes[p].symbol, symbol(i));
            for (size_t k = 0; k < sizeof targets / sizeof targets[0]; k++)
                compare(system, text, targets[k]);
        }
    // two prefixes, none but a prefix, another case: all unknown or known to both
    for (int i = 0; i < PREFIXES; i++)
        for (int k = 0; k < PREFIXES; k++)
            for (int u = 0; u < UNITS - 1; u++) {
                snprintf(text, sizeof text, "%s%s%s", prefixes[i].symbol, prefixes[k].symbol,
                         symbol(u));
                compare(system, text, "m");
            }
    CHECK_BELOW("factors, of themselves", tally.worst, 0);
    printf("    %d texts, %d taken, %d of the dimension asked for\n", tally.texts, tally.taken,
           tally.same);
}

static int pick(unsigned *seed, int below)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (int)((*seed >> 8) % (unsigned)below);
}

// One to four factors with and without prefixes and powers, and the base units that they come to.
static void write_product(unsigned *seed, char text[128], int sum[BASES])
{
    static const struct {
        const char *text;
        int power;
    } powers[] = {{"", 1},    {"", 1},     {"", 1},   {"2", 2},   {"3", 3}, {"-1", -1},
                  {"-2", -2}, {"^-3", -3}, {"^2", 2}, {"^+4", 4}, {"9", 9}, {"^-9", -9}};
    bool below = pick(seed, 8) == 0;
    int at = below ? sprintf(text, "1/") : 0;
    for (int i = 0, count = 1 + pick(seed, 4); i < count; i++) {
        int unit = pick(seed, UNITS), power = pick(seed, 12);
        bool bare = pick(seed, 2) || strcmp(symbol(unit), "%") == 0;
        if (i > 0) {
            text[at] = ".*//"[pick(seed, 4)];
            below = text[at++] == '/';
        }
        at += sprintf(text + at, "%s%s%s", bare ? "" : prefixes[pick(seed, PREFIXES)].symbol,
                      symbol(unit), powers[power].text);
        for (int b = 0; b < BASES; b++)
            sum[b] += (below ? -1 : 1) * powers[power].power *
                      (unit < BASES ? unit == b : derived[unit - BASES].power[b]);
    }
}

// The product of base units with these powers, "m9.m2.s-1"; "" of none.
static void write_base(const int power[BASES], char *text)
{
    const char *start = text;
    text[0] = '\0';
    for (int b = 0; b < BASES; b++)
        for (int left = power[b]; left != 0;) {
            int now = left > 9 ? 9 : left < -9 ? -9 : left;
            text += sprintf(text, "%s%d.", base[b], now);
            left -= now;
        }
    if (text > start)
        text[-1] = '\0';
}

static void test_products(void **state)
{
    ut_system *system = *state;
    unsigned seed = 1;
    memset(&tally, 0, sizeof tally);
    for (int i = 0; i < 20000; i++) {
        char text[128], target[512];
        int power[BASES] = {0};
        write_product(&seed, text, power);
        write_base(power, target);
        if (strlen(target) <= 60)
            compare(system, text, target);
        compare(system, text, "N.m/rad");
    }
    CHECK_BELOW("factors, of themselves", tally.worst, 1e-15);
    printf("    %d texts, %d taken, %d of the dimension asked for, %d of equal bits\n", tally.texts,
           tally.taken, tally.same, tally.equal);
    assert_true(tally.same > 10000);
}

// Any letters, digits and signs: what one takes the other takes. UDUNITS takes more (numbers,
// times, functions, powers of two digits): that is for the form to refuse.
static void test_any_text(void **state)
{
    ut_system *system = *state;
    static const char letters[] = "mkgsradKNPaJWHzthbrepniflbi%.*/^-+123456789";
    unsigned seed = 2;
    int taken = 0;
    for (int i = 0; i < 100000; i++) {
        char text[8], unknown[32];
        double ours, theirs;
        int length = 1 + pick(&seed, 6);
        for (int k = 0; k < length; k++)
            text[k] = letters[pick(&seed, (int)sizeof letters - 1)];
        text[length] = '\0';
        units_result result = units_factor(text, "m", &ours, unknown);
        if (result != UNITS_OK && result != UNITS_DIMENSION)
            continue;
        taken++;
        if (!by_udunits(system, text, "m", &theirs) || isnan(theirs) != isnan(ours) ||
            (!isnan(ours) && ours != theirs))
            fail_msg("\"%s\": %d and %g, UDUNITS %g", text, (int)result, ours, theirs);
    }
    printf("    %d of 100000 texts are units\n", taken);
    assert_true(taken > 1000);
}

static int open_system(void **state)
{
    *state = make_system();
    return *state == NULL;
}

static int close_system(void **state)
{
    ut_free_system(*state);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_unit_with_every_prefix),
        cmocka_unit_test(test_products),
        cmocka_unit_test(test_any_text),
    };
    return cmocka_run_group_tests(tests, open_system, close_system);
}
