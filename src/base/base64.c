#include "base/base64.h"

#include <string.h>

static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

void base64_write(text_writer *to, const void *bytes, size_t count)
{
    const unsigned char *byte = bytes;
    for (; count >= 3; byte += 3, count -= 3) {
        char four[4] = {letters[byte[0] >> 2], letters[(byte[0] & 3) << 4 | byte[1] >> 4],
                        letters[(byte[1] & 15) << 2 | byte[2] >> 6], letters[byte[2] & 63]};
        text_add(to, four, 4);
    }
    if (count > 0) {
        unsigned second = count > 1 ? byte[1] : 0;
        char four[4] = {letters[byte[0] >> 2], letters[(byte[0] & 3) << 4 | second >> 4],
                        count > 1 ? letters[(second & 15) << 2] : '=', '='};
        text_add(to, four, 4);
    }
}

size_t base64_room(size_t length)
{
    return length / 4 * 3 + 3;
}

size_t base64_read(const char *text, size_t length, unsigned char *bytes)
{
    unsigned held = 0; // the last bits
    size_t count = 0;
    for (size_t i = 0; i < length; i++) {
        const char *letter = text[i] ? strchr(letters, text[i]) : NULL;
        if (!letter)
            break;
        held = held << 6 | (unsigned)(letter - letters);
        if (i % 4 > 0)
            bytes[count++] = (unsigned char)(held >> (6 - 2 * (i % 4)));
    }
    return count;
}
