// Numbers and texts as people read them.
#ifndef LD_BASE_PRINTED_H
#define LD_BASE_PRINTED_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// What to print with "%.*f" and so many decimals: the value, but 0 where a negative one would come
// out as -0.000.
static inline double printed_fixed(double value, int decimals)
{
    double size = fabs(value);
    for (; decimals > 0; decimals--)
        size *= 10;
    return size <= 0.5 ? 0 : value;
}

// The character at the front of the text and the bytes that it takes; -1 and one byte where it is
// no UTF-8.
int32_t printed_code(const char *text, size_t *length);

// Whether a character is not seen as itself: a control, a mark of direction, the end of a line,
// one without width, or what is none. Unicode's Default_Ignorable_Code_Point, with those of
// categories Cc, Zl, Zp, the noncharacters and the marks of annotations (U+FFF9 to U+FFFB).
bool printed_is_hidden(int32_t code);

// The character at the front of the text as a terminal may show it: a byte of one that is hidden,
// or that is no UTF-8, as \x1b. Returns the bytes that it takes of the text.
size_t printed_character(const char *text, char shown[5]);

// A text from outside as a terminal may show it, until the end of the block; see ld_visible_text.
#define VISIBLE(text) ld_visible_text((text), (char[4096]){0}, 4096)

#endif
