#include "base/printed.h"

#include <stdio.h>
#include <string.h>

#include "launchdyn/status.h"

int32_t printed_code(const char *text, size_t *length)
{
    static const struct {
        unsigned char from, to, second_from, second_to; // the first byte and the second
        size_t length;
    } forms[] = {{0xc2, 0xdf, 0x80, 0xbf, 2}, {0xe0, 0xe0, 0xa0, 0xbf, 3},
                 {0xe1, 0xec, 0x80, 0xbf, 3}, {0xed, 0xed, 0x80, 0x9f, 3},
                 {0xee, 0xef, 0x80, 0xbf, 3}, {0xf0, 0xf0, 0x90, 0xbf, 4},
                 {0xf1, 0xf3, 0x80, 0xbf, 4}, {0xf4, 0xf4, 0x80, 0x8f, 4}};
    const unsigned char *c = (const unsigned char *)text;
    *length = 1;
    if (*c < 0x80)
        return *c;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        if (*c < forms[i].from || *c > forms[i].to)
            continue;
        if (c[1] < forms[i].second_from || c[1] > forms[i].second_to)
            return -1;
        int32_t code = *c & (0x7f >> forms[i].length);
        for (size_t k = 1; k < forms[i].length; k++) {
            if ((c[k] & 0xc0) != 0x80)
                return -1;
            code = code << 6 | (c[k] & 0x3f);
        }
        *length = forms[i].length;
        return code;
    }
    return -1;
}

bool printed_is_hidden(int32_t code)
{
    static const struct {
        int32_t from, to;
    } hidden[] = {{0x0, 0x1f},      {0x7f, 0x9f},       {0xad, 0xad},       {0x34f, 0x34f},
                  {0x61c, 0x61c},   {0x115f, 0x1160},   {0x17b4, 0x17b5},   {0x180b, 0x180f},
                  {0x200b, 0x200f}, {0x2028, 0x202e},   {0x2060, 0x206f},   {0x3164, 0x3164},
                  {0xfdd0, 0xfdef}, {0xfe00, 0xfe0f},   {0xfeff, 0xfeff},   {0xffa0, 0xffa0},
                  {0xfff0, 0xfffb}, {0x1bca0, 0x1bca3}, {0x1d173, 0x1d17a}, {0xe0000, 0xe0fff}};
    for (size_t i = 0; i < sizeof hidden / sizeof *hidden; i++)
        if (code >= hidden[i].from && code <= hidden[i].to)
            return true;
    return (code & 0xfffe) == 0xfffe;
}

size_t printed_character(const char *text, char shown[5])
{
    size_t length;
    int32_t code = printed_code(text, &length);
    if (code < 0 || printed_is_hidden(code)) {
        snprintf(shown, 5, "\\x%02x", (unsigned char)*text);
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
