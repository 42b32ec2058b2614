// Any text as a unit is refused, or has a factor that is a number above zero, and that of its
// inverse is one over it; an unknown unit is named, and what is suggested for it is a unit. The
// first byte chooses the unit that is requested.
#include <math.h>
#include <stdint.h>

#include "fuzz/memory_folder.h"
#include "model/units.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_unknown(const char *text, const char *unknown)
{
    double factor;
    char again[32];
    const char *suggestion = units_suggestion(unknown);
    must(unknown[0] && strlen(unknown) < sizeof again && strstr(text, unknown));
    must(units_factor(unknown, "", &factor, again) == UNITS_UNKNOWN);
    if (suggestion)
        must(units_factor(suggestion, "m", &factor, again) <= UNITS_DIMENSION &&
             units_factor(suggestion, "m", &factor, again) != UNITS_UNKNOWN);
}

// "1/unit" where that is one.
static void check_inverse(const char *text, double factor)
{
    char inverse[80], unknown[32];
    double one;
    snprintf(inverse, sizeof inverse, "1/%.70s", text);
    if (strpbrk(text, "./*1") || units_factor(inverse, inverse + 2, &one, unknown) == UNITS_SYNTAX)
        return;
    must(units_factor(inverse, "", &one, unknown) != UNITS_OK || fabs(one * factor - 1) < 1e-14);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const wanted[] = {
        "",    "m",    "s",     "rad", "kg", "N/m", "N.m/rad", "kg.m2", "N.m.s/rad", "Pa",
        "1/m", "m/s2", "kg/m3", "K",   "Hz", "m2",  "N.s/m",   "rad/s", "1/s"};
    char text[128], unknown[32] = "";
    double factor;
    if (size < 1 || size > sizeof text)
        return 0;
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    size_t chosen = data[0] % (sizeof wanted / sizeof *wanted);
    units_result result = units_factor(text, wanted[chosen], &factor, unknown);
    must((result == UNITS_OK) == (isfinite(factor) && factor > 0));
    must(result == UNITS_OK || isnan(factor));
    if (result == UNITS_UNKNOWN)
        check_unknown(text, unknown);
    if (result == UNITS_OK && chosen == 0)
        check_inverse(text, factor);
    return 0;
}
