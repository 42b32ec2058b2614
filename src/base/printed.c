#include "base/printed.h"

#include <stdio.h>
#include <string.h>

#include "launchdyn/status.h"

// Bytes of the UTF-8 character at `c`, in its shortest form; 0: it is none.
static size_t utf8_length(const unsigned char *c)
{
    static const struct {
        unsigned char from, to, second_from, second_to; // the first byte and the second
        size_t length;
    } forms[] = {{0xc2, 0xdf, 0x80, 0xbf, 2}, {0xe0, 0xe0, 0xa0, 0xbf, 3},
                 {0xe1, 0xec, 0x80, 0xbf, 3}, {0xed, 0xed, 0x80, 0x9f, 3},
                 {0xee, 0xef, 0x80, 0xbf, 3}, {0xf0, 0xf0, 0x90, 0xbf, 4},
                 {0xf1, 0xf3, 0x80, 0xbf, 4}, {0xf4, 0xf4, 0x80, 0x8f, 4}};
    if (*c < 0x80)
        return 1;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        if (*c < forms[i].from || *c > forms[i].to)
            continue;
        if (c[1] < forms[i].second_from || c[1] > forms[i].second_to)
            return 0;
        for (size_t k = 2; k < forms[i].length; k++)
            if ((c[k] & 0xc0) != 0x80)
                return 0;
        return forms[i].length;
    }
    return 0;
}

size_t printed_character(const char *text, char shown[5])
{
    const unsigned char *c = (const unsigned char *)text;
    size_t length = utf8_length(c);
    bool control = *c < 0x20 || *c == 0x7f || (*c == 0xc2 && c[1] < 0xa0);
    if (length == 0 || control) {
        snprintf(shown, 5, "\\x%02x", *c);
        return 1;
    }
    memcpy(shown, text, length);
    shown[length] = '\0';
    return length;
}

char *ld_visible_text(const char *text, char *visible, size_t size)
{
    static const char more[] = "...";
    size_t used = 0, cut = 0; // where `more` has room
    char shown[5];
    visible[0] = '\0';
    while (*text) {
        text += printed_character(text, shown);
        size_t length = strlen(shown);
        if (used + length >= size) {
            snprintf(visible + cut, size - cut, "%s", more);
            break;
        }
        memcpy(visible + used, shown, length + 1);
        used += length;
        cut = used + sizeof more <= size ? used : cut;
    }
    return visible;
}
