// What fit.json says, and fits that are interrupted again and again.
#ifndef LD_TESTS_SUPPORT_FOUND_FIT_H
#define LD_TESTS_SUPPORT_FOUND_FIT_H

#include <stdbool.h>
#include <stdlib.h>

#include "launchdyn/fit.h"
#include "support/check.h"

enum { MOST_FOUND = 5 };

typedef struct found {
    double value[MOST_FOUND], deviation[MOST_FOUND], low[MOST_FOUND], high[MOST_FOUND]; // of keys
    double chance;
    double correlation[2], offset; // of a log, where there is one
} found;

// The number behind the next `name`, to which *text moves; NaN: null.
static inline double number_after(const char **text, const char *name)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\": ", name);
    const char *at = strstr(*text, quoted);
    assert_non_null(at);
    *text = at + strlen(quoted);
    return strncmp(*text, "null", 4) == 0 ? NAN : strtod(*text, NULL);
}

static inline char *json_of(const ld_fit *fit)
{
    enum { MOST = 1 << 18 };
    char *text = calloc(1, MOST);
    assert_non_null(text);
    FILE *stream = fmemopen(text, MOST, "w");
    assert_non_null(stream);
    ld_fit_print_json(fit, stream);
    assert_int_equal(fclose(stream), 0);
    return text;
}

// Reads what is said of all and of the first `count` keys; returns where that ends.
static inline const char *read_keys(const char *text, size_t count, found *of)
{
    of->chance = number_after(&text, "p");
    text = strstr(text, "\"keys\"");
    assert_non_null(text);
    for (size_t i = 0; i < count; i++) {
        of->value[i] = number_after(&text, "value");
        of->deviation[i] = number_after(&text, "deviation");
        of->low[i] = number_after(&text, "low");
        of->high[i] = number_after(&text, "high");
    }
    return text;
}

typedef struct patience {
    int left; // answers until it stops
} patience;

static inline bool wait_once_more(void *self)
{
    patience *left = self;
    return left->left-- > 0;
}

#endif
