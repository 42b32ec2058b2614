// Numbers are written with a decimal point whatever the locale of the program around us.
#ifndef LD_BASE_NUMERIC_LOCALE_H
#define LD_BASE_NUMERIC_LOCALE_H

#include <locale.h>

// Switches this thread to the C locale and returns the one before, for numeric_locale_leave().
static inline locale_t numeric_locale_enter(void)
{
    return uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0)); // the C locale is not allocated
}

static inline void numeric_locale_leave(locale_t before)
{
    uselocale(before);
}

#endif
