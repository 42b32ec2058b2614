// Any text as an expression is refused, with a sentence and a place in it, or has a unit that reads
// back as itself and the same value each time, a number or none, its windows too; in parentheses it
// is the same.
#include <math.h>
#include <stdint.h>

#include "fuzz/memory_folder.h"
#include "quantities/expression.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char *const known[] = {"a", "b.c", "v", "turn", "x", "x-y", "y"};
static const char *const known_unit[] = {"m", "m", "m/s", "rad", "", "1", ""};
enum { KNOWN = sizeof known / sizeof *known, MOST_WINDOWS = 80 };

typedef struct fuzz_names {
    int windows, opened;
    expression_window window[MOST_WINDOWS];
} fuzz_names;

static int find(void *self, bool over_time, const char *name, const char **unit)
{
    (void)self, (void)over_time;
    must(strlen(name) < LD_MAX_QUANTITY);
    for (int i = 0; i < KNOWN; i++)
        if (strcmp(known[i], name) == 0) {
            *unit = known_unit[i];
            return i;
        }
    return -1;
}

static void explain(void *self, bool over_time, const char *name, char why[EXPRESSION_WHY])
{
    (void)self, (void)over_time;
    snprintf(why, EXPRESSION_WHY, "no \"%.95s\"", name);
}

static bool open_window(void *self, const expression_window *window, char why[EXPRESSION_WHY])
{
    fuzz_names *names = self;
    names->opened++;
    snprintf(why, EXPRESSION_WHY, "%s", window->from[0] == 'x' ? "no instant" : "");
    return !why[0];
}

static int close_window(void *self, const expression_window *window, char why[EXPRESSION_WHY])
{
    fuzz_names *names = self;
    must(--names->opened == 0);
    if (names->windows == MOST_WINDOWS) {
        snprintf(why, EXPRESSION_WHY, "too many");
        return -1;
    }
    names->window[names->windows] = *window;
    return KNOWN + names->windows++;
}

static double value_of(const void *self, int number)
{
    (void)self;
    return number % 5 == 4 ? NAN : number - 2.5;
}

static void must_be_a_number(const expression_code *code, expression_part part)
{
    must(part.first >= 0 && part.count > 0 && part.first + part.count <= code->count);
    double value = expression_value(code, part, value_of, NULL);
    must(isnan(value) || isfinite(value));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static expression_code code;
    fuzz_names self = {0};
    const expression_names names = {find, explain, open_window, close_window, &self};
    char text[EXPRESSION_MOST_TEXT + 40], again[sizeof text + 2], unit_text[UNITS_TEXT],
        unknown[32];
    expression_part part;
    units_dimension unit, back;
    expression_refusal refusal = {.at = -1};
    double factor;
    if (size >= sizeof text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    code.count = 0;
    if (!expression_read(text, &names, &code, &part, &unit, &refusal)) {
        must(refusal.at >= 0 && (size_t)refusal.at <= strlen(text) && refusal.why[0]);
        return 0;
    }
    must_be_a_number(&code, part);
    for (int i = 0; i < self.windows; i++)
        must_be_a_number(&code, self.window[i].of);
    units_write(&unit, unit_text);
    must(units_read(unit_text, &factor, &back, unknown) == UNITS_OK && factor == 1 &&
         memcmp(&unit, &back, sizeof unit) == 0);
    double value = expression_value(&code, part, value_of, NULL);
    must(strlen(text) + 3 <= sizeof again);
    snprintf(again, sizeof again, "(%s)", text);
    self.windows = code.count = 0;
    if (!expression_read(again, &names, &code, &part, &back, &refusal))
        return 0; // too deep or too long
    double other = expression_value(&code, part, value_of, NULL);
    must(memcmp(&unit, &back, sizeof unit) == 0 && memcmp(&value, &other, sizeof value) == 0);
    return 0;
}
