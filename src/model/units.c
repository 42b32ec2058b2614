#include "model/units.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "math/functions.h"

enum { METRE, KILOGRAM, SECOND, RADIAN, KELVIN };

// A product of powers of units: its size in base units, and their powers.
typedef struct measure {
    double factor;
    int power[UNITS_BASES];
} measure;

static const struct {
    const char *symbol;
    measure is;
} units[] = {
    {"m", {1, {[METRE] = 1}}},
    {"kg", {1, {[KILOGRAM] = 1}}},
    {"s", {1, {[SECOND] = 1}}},
    {"rad", {1, {[RADIAN] = 1}}},
    {"K", {1, {[KELVIN] = 1}}},
    {"g", {1e-3, {[KILOGRAM] = 1}}},
    {"t", {1e3, {[KILOGRAM] = 1}}},
    {"min", {60, {[SECOND] = 1}}},
    {"h", {3600, {[SECOND] = 1}}},
    {"Hz", {1, {[SECOND] = -1}}},
    {"deg", {0.017453292519943295, {[RADIAN] = 1}}},
    {"rev", {6.283185307179586, {[RADIAN] = 1}}},
    {"rpm", {6.283185307179586 * (1.0 / 60), {[RADIAN] = 1, [SECOND] = -1}}},
    {"N", {1, {[KILOGRAM] = 1, [METRE] = 1, [SECOND] = -2}}},
    {"Pa", {1, {[KILOGRAM] = 1, [METRE] = -1, [SECOND] = -2}}},
    {"bar", {1e5, {[KILOGRAM] = 1, [METRE] = -1, [SECOND] = -2}}},
    {"J", {1, {[KILOGRAM] = 1, [METRE] = 2, [SECOND] = -2}}},
    {"W", {1, {[KILOGRAM] = 1, [METRE] = 2, [SECOND] = -3}}},
    {"ft", {0.3048, {[METRE] = 1}}},
    {"mi", {1609.344, {[METRE] = 1}}},
    {"lb", {0.45359237, {[KILOGRAM] = 1}}},
    {"lbf", {4.4482216152605, {[KILOGRAM] = 1, [METRE] = 1, [SECOND] = -2}}},
    {"psi", {6894.757293168361, {[KILOGRAM] = 1, [METRE] = -1, [SECOND] = -2}}},
    {"%", {1e-2, {0}}},
};

// Accelerations that look like masses: they are meant where an acceleration is requested.
static const struct {
    const char *symbol;
    measure is;
} falls[] = {
    {"g", {9.80665, {[METRE] = 1, [SECOND] = -2}}},
    {"mg", {9.80665e-3, {[METRE] = 1, [SECOND] = -2}}},
};

static const struct {
    char symbol;
    double factor;
} prefixes[] = {{'n', 1e-9}, {'u', 1e-6}, {'m', 1e-3}, {'c', 1e-2},
                {'h', 1e2},  {'k', 1e3},  {'M', 1e6},  {'G', 1e9}};

// Common units, for suggestions, and slips that are not a matter of spelling.
static const char *const common[] = {
    "m",   "mm",   "cm",  "um",  "km", "kg",  "g",   "t",  "s",  "ms", "us",  "min", "h",
    "rad", "mrad", "deg", "rev", "Hz", "kHz", "N",   "kN", "MN", "Pa", "hPa", "kPa", "MPa",
    "GPa", "bar",  "J",   "kJ",  "W",  "kW",  "rpm", "K",  "ft", "mi", "lb",  "lbf", "psi"};
static const struct {
    const char *wrong, *right;
} slips[] = {
    {"kph", "km/h"}, {"kmh", "km/h"},   {"mps", "m/s"},     {"Nm", "N.m"},    {"Ns", "N.s"},
    {"sec", "s"},    {"degree", "deg"}, {"degrees", "deg"}, {"cycle", "Hz"},  {"kgm2", "kg.m2"},
    {"tonne", "t"},  {"micron", "um"},  {"msec", "ms"},     {"hour", "h"},    {"newton", "N"},
    {"meter", "m"},  {"metre", "m"},    {"radian", "rad"},  {"percent", "%"}, {"feet", "ft"},
    {"foot", "ft"},  {"fps", "ft/s"},   {"mph", "mi/h"},    {"mile", "mi"},   {"miles", "mi"},
    {"G", "g"},      {"Gs", "g"},       {"gee", "g"},       {"lbs", "lb"}};

static bool find_symbol(const char *name, size_t length, measure *out)
{
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++)
        if (strlen(units[i].symbol) == length && memcmp(units[i].symbol, name, length) == 0) {
            *out = units[i].is;
            return true;
        }
    return false;
}

// A unit, or one with a prefix.
static bool find_unit(const char *name, size_t length, measure *out)
{
    if (find_symbol(name, length, out))
        return true;
    for (size_t i = 0; i < sizeof prefixes / sizeof prefixes[0]; i++)
        if (prefixes[i].symbol == name[0] && find_symbol(name + 1, length - 1, out)) {
            out->factor *= prefixes[i].factor;
            return true;
        }
    return false;
}

// Takes one factor, "m", "m2", "s-2", "m^2" or "%", from the front of `text`; returns its end (NULL
// if it is none), the length of its name and its power.
static const char *take_factor(const char *text, size_t *name, int *power)
{
    const char *end = text;
    if (*end == '%')
        end++;
    else
        while (isalpha((unsigned char)*end) && (unsigned char)*end < 128)
            end++;
    *name = (size_t)(end - text);
    *power = 1;
    if (end == text)
        return NULL;
    const char *digit = end;
    if (*digit == '^')
        digit++;
    if (*digit == '-' || *digit == '+')
        digit++;
    if (*digit >= '1' && *digit <= '9') {
        *power = (digit[-1] == '-' ? -1 : 1) * (*digit - '0');
        return digit + 1;
    }
    return digit == end ? end : NULL;
}

static void multiply(measure *product, const measure *unit, int power, bool below)
{
    double factor = pow(unit->factor, power);
    product->factor *= below ? 1 / factor : factor;
    for (int i = 0; i < UNITS_BASES; i++)
        product->power[i] += (below ? -power : power) * unit->power[i];
}

// Reads factors joined by . * or /, maybe after "1/"; `unknown` names the first that is not a unit.
static units_result read_product(const char *text, measure *product, char unknown[32])
{
    units_result result = UNITS_OK;
    *product = (measure){.factor = 1};
    unknown[0] = '\0';
    if (strlen(text) > 60)
        return UNITS_SYNTAX;
    bool below = strncmp(text, "1/", 2) == 0;
    for (text += below ? 2 : 0;; text++) {
        size_t length;
        int power;
        measure unit;
        const char *end = take_factor(text, &length, &power);
        if (!end)
            return UNITS_SYNTAX;
        if (find_unit(text, length, &unit)) {
            multiply(product, &unit, power, below);
        } else if (result == UNITS_OK) {
            result = UNITS_UNKNOWN;
            snprintf(unknown, 32, "%.*s", (int)length, text);
        }
        text = end;
        below = *end == '/';
        if (*end == '\0')
            return result;
        if (*end != '.' && *end != '*' && *end != '/')
            return UNITS_SYNTAX;
    }
}

// Standard gravity by its symbol, where `to` is an acceleration.
static bool find_fall(const char *text, const measure *to, measure *from)
{
    for (size_t i = 0; i < sizeof falls / sizeof falls[0]; i++)
        if (strcmp(falls[i].symbol, text) == 0 &&
            memcmp(falls[i].is.power, to->power, sizeof to->power) == 0) {
            *from = falls[i].is;
            return true;
        }
    return false;
}

units_result units_factor(const char *text, const char *target, double *factor, char unknown[32])
{
    measure from, to = {.factor = 1};
    char ours[32];
    *factor = NAN;
    units_result result = read_product(text, &from, unknown);
    if (result != UNITS_OK)
        return result;
    if (target[0] && read_product(target, &to, ours) != UNITS_OK)
        return UNITS_DIMENSION;
    if (memcmp(from.power, to.power, sizeof from.power) != 0 && !find_fall(text, &to, &from))
        return UNITS_DIMENSION;
    double ratio = strcmp(text, target) == 0 ? 1 : from.factor / to.factor;
    if (!isnormal(ratio))
        return UNITS_DIMENSION; // Gm9.Gm9.Gm9.Gm9: beyond all numbers
    *factor = ratio;
    return UNITS_OK;
}

units_result units_read(const char *text, double *factor, units_dimension *dimension,
                        char unknown[32])
{
    measure product = {.factor = 1};
    units_result result = UNITS_OK;
    unknown[0] = '\0';
    if (text[0] && strcmp(text, "1") != 0)
        result = read_product(text, &product, unknown);
    *factor = product.factor;
    memcpy(dimension->power, product.power, sizeof product.power);
    bool beyond = !isnormal(product.factor);
    for (int i = 0; i < UNITS_BASES; i++)
        beyond |= abs(product.power[i]) > UNITS_MOST_POWER;
    return result == UNITS_OK && beyond ? UNITS_DIMENSION : result;
}

// Adds the base units with powers of one sign.
static void write_powers(const units_dimension *dimension, int sign, char text[UNITS_TEXT])
{
    static const char *const base[UNITS_BASES] = {"m", "kg", "s", "rad", "K"};
    static const int order[UNITS_BASES] = {KILOGRAM, METRE, SECOND, RADIAN, KELVIN};
    for (int i = 0; i < UNITS_BASES; i++) {
        int power = sign * dimension->power[order[i]];
        size_t length = strlen(text);
        if (power <= 0)
            continue;
        const char *before = sign < 0 ? length ? "/" : "1/" : length ? "." : "";
        snprintf(text + length, UNITS_TEXT - length, power == 1 ? "%s%s" : "%s%s%d", before,
                 base[order[i]], power);
    }
}

void units_write(const units_dimension *dimension, char text[UNITS_TEXT])
{
    static const char *const named[] = {"N", "N.m", "Pa", "W"};
    text[0] = '\0';
    for (size_t i = 0; i < sizeof named / sizeof *named; i++) {
        measure of;
        char unknown[32];
        read_product(named[i], &of, unknown);
        if (memcmp(of.power, dimension->power, sizeof of.power) == 0)
            strcpy(text, named[i]);
    }
    if (text[0])
        return;
    write_powers(dimension, 1, text);
    write_powers(dimension, -1, text);
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
