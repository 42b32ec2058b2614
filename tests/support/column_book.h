// What every column of a history ought to hold, said by name. A column of which nothing is said
// fails the test, and so does one that is zero throughout, which would show no fault.
#ifndef LD_TESTS_SUPPORT_COLUMN_BOOK_H
#define LD_TESTS_SUPPORT_COLUMN_BOOK_H

#include <fnmatch.h>
#include <stdlib.h>

#include "launchdyn/results.h"
#include "support/check.h"

enum { BOOK_COLUMNS = 400 };

typedef struct column_book {
    const ld_column *column;
    size_t count;
    const double *row; // the present one
    int said[BOOK_COLUMNS];
    double worst[BOOK_COLUMNS], largest[BOOK_COLUMNS];
} column_book;

// How near the columns of these names (a pattern of fnmatch; the first that fits holds) must come
// to what is said of them, relative to the column's largest value.
typedef struct column_bound {
    const char *names;
    double bound;
    bool zero; // may be zero throughout: then the bound is absolute
} column_bound;

static inline size_t column_named(const column_book *book, const char *name)
{
    for (size_t i = 0; i < book->count; i++)
        if (strcmp(book->column[i].name, name) == 0)
            return i;
    fail_msg("no column %s", name);
    return 0;
}

static inline double column_value(const column_book *book, const char *name)
{
    return book->row[column_named(book, name)];
}

// In the present row the column holds `value`; NaN: nothing.
static inline void expect(column_book *book, const char *name, double value)
{
    size_t i = column_named(book, name);
    double found = book->row[i];
    book->said[i]++;
    if (isnan(value) != isnan(found))
        fail_msg("%s at %.9g s: %g, expected %g", name, book->row[0], found, value);
    if (isnan(value))
        return;
    book->worst[i] = fmax(book->worst[i], fabs(found - value));
    book->largest[i] = fmax(book->largest[i], fabs(value));
}

// The same of the column PART.NAME.
static inline void expect_of(column_book *book, const char *part, const char *name, double value)
{
    char text[128];
    snprintf(text, sizeof text, "%s.%s", part, name);
    expect(book, text, value);
}

// Of three columns that differ by their last letters.
static inline void expect3(column_book *book, const char *stem, const char *const letters[3],
                           const double value[3])
{
    char text[128];
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, "%s%s", stem, letters[i]);
        expect(book, text, value[i]);
    }
}

static inline void check_book(const column_book *book, const column_bound *bound, size_t bounds)
{
    double worst[64] = {0};
    const char *which[64] = {0};
    for (size_t i = 0; i < book->count; i++) {
        const char *name = book->column[i].name;
        size_t k = 0;
        while (k < bounds && fnmatch(bound[k].names, name, 0) != 0)
            k++;
        if (book->said[i] == 0 || k == bounds)
            fail_msg("nothing is said of column %s", name);
        if (book->largest[i] == 0 && !bound[k].zero)
            fail_msg("column %s is zero throughout", name);
        double relative = book->worst[i] / (bound[k].zero ? 1 : book->largest[i]);
        if (!which[k] || relative > worst[k]) {
            worst[k] = relative;
            which[k] = name;
        }
    }
    for (size_t k = 0; k < bounds; k++)
        if (which[k]) {
            char text[128];
            snprintf(text, sizeof text, "%s (%s)", bound[k].names, which[k]);
            CHECK_BELOW(text, worst[k], bound[k].bound);
        }
}

#endif
