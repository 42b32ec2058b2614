#include "scenario/units.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <udunits2.h>

#include "base/suggestion.h"

struct unit_system {
    ut_system *system;
    ut_unit *base[5];
};

// Derived units in terms of those above them; "%" is a hundredth.
static const struct {
    const char *symbol, *definition;
} derived[] = {
    {"g", "0.001 kg"},  {"t", "1000 kg"},     {"min", "60 s"},
    {"h", "3600 s"},    {"Hz", "s-1"},        {"deg", "0.017453292519943295 rad"},
    {"N", "kg.m.s-2"},  {"Pa", "N.m-2"},      {"J", "N.m"},
    {"W", "J.s-1"},     {"bar", "100000 Pa"}, {"rev", "6.283185307179586 rad"},
    {"rpm", "rev/min"}, {"%", "0.01"},
};

static const struct {
    const char *symbol;
    double factor;
} prefixes[] = {{"n", 1e-9}, {"u", 1e-6}, {"m", 1e-3}, {"c", 1e-2},
                {"k", 1e3},  {"M", 1e6},  {"G", 1e9}};

// Common units, for suggestions, and slips that are no matter of spelling.
static const char *const common[] = {"m",   "mm", "cm",  "um", "km",  "kg",   "g",   "t",   "s",
                                     "ms",  "us", "min", "h",  "rad", "mrad", "deg", "rev", "Hz",
                                     "kHz", "N",  "kN",  "MN", "Pa",  "kPa",  "MPa", "GPa", "bar",
                                     "J",   "kJ", "W",   "kW", "rpm", "K"};
static const struct {
    const char *wrong, *right;
} slips[] = {{"kph", "km/h"}, {"kmh", "km/h"},   {"mps", "m/s"},    {"Nm", "N.m"},
             {"Ns", "N.s"},   {"sec", "s"},      {"degree", "deg"}, {"degrees", "deg"},
             {"cycle", "Hz"}, {"kgm2", "kg.m2"}, {"tonne", "t"},    {"micron", "um"},
             {"msec", "ms"},  {"hour", "h"},     {"newton", "N"},   {"meter", "m"},
             {"metre", "m"},  {"radian", "rad"}, {"percent", "%"}};

static bool map_symbol(ut_system *system, const char *symbol, const char *definition)
{
    ut_unit *unit = ut_parse(system, definition, UT_ASCII);
    bool good = unit && ut_map_symbol_to_unit(symbol, UT_ASCII, unit) == UT_SUCCESS;
    ut_free(unit);
    return good;
}

static bool build(unit_system *units)
{
    static const char *const base[] = {"m", "kg", "s", "rad", "K"};
    ut_set_error_message_handler(ut_ignore);
    units->system = ut_new_system();
    bool good = units->system != NULL;
    for (int i = 0; good && i < 5; i++) {
        ut_unit *unit = units->base[i] = ut_new_base_unit(units->system);
        good = unit && ut_map_symbol_to_unit(base[i], UT_ASCII, unit) == UT_SUCCESS;
    }
    for (size_t i = 0; good && i < sizeof prefixes / sizeof prefixes[0]; i++)
        good = ut_add_symbol_prefix(units->system, prefixes[i].symbol, prefixes[i].factor) ==
               UT_SUCCESS;
    for (size_t i = 0; good && i < sizeof derived / sizeof derived[0]; i++)
        good = map_symbol(units->system, derived[i].symbol, derived[i].definition);
    return good;
}

unit_system *units_open(void)
{
    static unit_system units;
    static bool built;
    built = built || build(&units);
    return built ? &units : NULL;
}

// Takes one factor, "m", "m2", "s-2", "m^2" or "%", from the front of `text`; returns its end (NULL
// if it is none) and the length of its name.
static const char *take_factor(const char *text, size_t *name)
{
    const char *end = text;
    if (*end == '%')
        end++;
    else
        while (isalpha((unsigned char)*end) && (unsigned char)*end < 128)
            end++;
    *name = (size_t)(end - text);
    if (end == text)
        return NULL;
    const char *power = end;
    if (*power == '^')
        power++;
    if (*power == '-' || *power == '+')
        power++;
    if (*power >= '1' && *power <= '9')
        return power + 1;
    return power == end ? end : NULL;
}

// Checks the form (factors joined by . * or /, maybe after "1/") and that each name is known.
static units_result check_form(const unit_system *units, const char *text, char unknown[32])
{
    units_result result = UNITS_OK;
    unknown[0] = '\0';
    if (strlen(text) > 60)
        return UNITS_SYNTAX;
    if (strncmp(text, "1/", 2) == 0)
        text += 2;
    for (;;) {
        size_t length;
        char name[64];
        const char *end = take_factor(text, &length);
        if (!end)
            return UNITS_SYNTAX;
        memcpy(name, text, length);
        name[length] = '\0';
        ut_unit *unit = ut_parse(units->system, name, UT_ASCII);
        ut_free(unit);
        if (!unit && result == UNITS_OK) {
            result = UNITS_UNKNOWN;
            memcpy(unknown, name, length < 31 ? length : 31);
            unknown[length < 31 ? length : 31] = '\0';
        }
        if (*end == '\0')
            return result;
        if (*end != '.' && *end != '*' && *end != '/')
            return UNITS_SYNTAX;
        text = end + 1;
    }
}

// The quotient must be a plain number: ut_are_convertible would also take s for Hz.
static units_result quotient(const unit_system *units, ut_unit *from, ut_unit *to, double *factor)
{
    units_result result = UNITS_MEMORY;
    ut_unit *ratio = from && to ? ut_divide(from, to) : NULL;
    ut_unit *one = ut_get_dimensionless_unit_one(units->system);
    if (ratio && one) {
        result = UNITS_DIMENSION;
        if (ut_is_dimensionless(ratio)) {
            cv_converter *converter = ut_get_converter(ratio, one);
            result = converter ? UNITS_OK : UNITS_MEMORY;
            *factor = converter ? cv_convert_double(converter, 1.0) : NAN;
            cv_free(converter);
        }
    }
    ut_free(ratio);
    ut_free(one);
    return result;
}

units_result units_factor(unit_system *units, const char *text, const char *target, double *factor,
                          char unknown[32])
{
    *factor = NAN;
    units_result result = check_form(units, text, unknown);
    if (result != UNITS_OK)
        return result;
    if (strcmp(text, target) == 0) {
        *factor = 1;
        return UNITS_OK;
    }
    ut_unit *from = ut_parse(units->system, text, UT_ASCII);
    ut_unit *to = ut_parse(units->system, target[0] ? target : "1", UT_ASCII);
    result = quotient(units, from, to, factor);
    ut_free(from);
    ut_free(to);
    return result;
}

double units_scale(double value, double factor)
{
    double inverse = round(1 / factor);
    if (factor < 1 && fabs(inverse * factor - 1) < 1e-14)
        return value / inverse;
    return value * factor;
}

const char *units_suggestion(const char *unknown)
{
    for (size_t i = 0; i < sizeof slips / sizeof slips[0]; i++)
        if (strcmp(slips[i].wrong, unknown) == 0)
            return slips[i].right;
    name_suggestion best = suggestion_begin(unknown);
    for (size_t i = 0; i < sizeof common / sizeof common[0]; i++)
        suggestion_offer(&best, common[i]);
    return best.name;
}
