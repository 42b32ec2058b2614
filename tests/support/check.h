// Checks that print the measured value beside its bound (cmocka has none for doubles).
#ifndef LD_TESTS_SUPPORT_CHECK_H
#define LD_TESTS_SUPPORT_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

// How many of the cases that differ in numbers alone: with sanitizers, ten times slower, a few.
#ifdef LD_SANITIZED
#define OF_ALL(all, few) (few)
#else
#define OF_ALL(all, few) (all)
#endif

// |measured| <= bound, printed either way; NaN fails.
#define CHECK_BELOW(what, measured, bound)                                                         \
    do {                                                                                           \
        double check_measured = (measured), check_bound = (bound);                                 \
        printf("    %-58s %10.3e  bound %8.1e\n", what, check_measured, check_bound);              \
        if (!(fabs(check_measured) <= check_bound))                                                \
            fail_msg("%s: %.17g exceeds %.3g", what, check_measured, check_bound);                 \
    } while (0)

// low <= measured <= high, printed either way; NaN fails.
#define CHECK_WITHIN(what, measured, low, high)                                                    \
    do {                                                                                           \
        double check_measured = (measured), check_low = (low), check_high = (high);                \
        printf("    %-58s %10.6g  in [%g, %g]\n", what, check_measured, check_low, check_high);    \
        if (!(check_measured >= check_low && check_measured <= check_high))                        \
            fail_msg("%s: %.17g is not in [%.17g, %.17g]", what, check_measured, check_low,        \
                     check_high);                                                                  \
    } while (0)

#define CHECK_NEAR(what, measured, expected, bound)                                                \
    do {                                                                                           \
        double check_value = (measured), check_expected = (expected);                              \
        printf("    %-42s %15.9g  is %15.9g", what, check_value, check_expected);                  \
        CHECK_BELOW("", check_value - check_expected, bound);                                      \
    } while (0)

#endif
