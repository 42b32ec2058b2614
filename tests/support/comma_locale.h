// A locale with a decimal comma, made for a test, since few systems have one.
#ifndef LD_TESTS_SUPPORT_COMMA_LOCALE_H
#define LD_TESTS_SUPPORT_COMMA_LOCALE_H

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/check.h"

// Makes it in a folder and sets it. The test is skipped where the system has no sources of locales
// (Debian's package `locales`).
static inline void set_comma_locale(const char *folder)
{
    char command[512];
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8", folder);
    setenv("LOCPATH", folder, 1);
    if (system(command) != 0 || !setlocale(LC_ALL, "de_DE.UTF-8"))
        skip();
    assert_true(strtod("0,5", NULL) == 0.5);
}

static inline void leave_comma_locale(void)
{
    setlocale(LC_ALL, "C");
    unsetenv("LOCPATH");
}

#endif
