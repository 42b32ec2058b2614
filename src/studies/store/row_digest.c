#include "studies/store/row_digest.h"

#include <string.h>
#include <zlib.h>

static uint32_t of_bits(uint32_t digest, int kind, const void *bits)
{
    unsigned char all[9] = {(unsigned char)kind};
    memcpy(all + 1, bits, 8);
    return (uint32_t)crc32(digest, all, sizeof all);
}

uint32_t digest_null(uint32_t digest)
{
    const unsigned char kind = SQLITE_NULL;
    return (uint32_t)crc32(digest, &kind, 1);
}

uint32_t digest_integer(uint32_t digest, int64_t value)
{
    return of_bits(digest, SQLITE_INTEGER, &value);
}

uint32_t digest_real(uint32_t digest, double value)
{
    value += 0.0;
    return of_bits(digest, SQLITE_FLOAT, &value);
}

static uint32_t of_bytes(uint32_t digest, int kind, const void *bytes, size_t length)
{
    const int64_t size = (int64_t)length;
    return (uint32_t)crc32_z(of_bits(digest, kind, &size), bytes, length);
}

uint32_t digest_text(uint32_t digest, const void *text, size_t length)
{
    return of_bytes(digest, SQLITE_TEXT, text, length);
}

uint32_t digest_columns(uint32_t digest, sqlite3_stmt *row, int first, int end)
{
    for (int i = first; i < end; i++) {
        const int kind = sqlite3_column_type(row, i);
        const void *bytes;
        switch (kind) {
        case SQLITE_INTEGER:
            digest = digest_integer(digest, sqlite3_column_int64(row, i));
            break;
        case SQLITE_FLOAT:
            digest = digest_real(digest, sqlite3_column_double(row, i));
            break;
        case SQLITE_NULL:
            digest = digest_null(digest);
            break;
        default: // a text is another value than the same bytes
            bytes = sqlite3_column_blob(row, i);
            digest =
                of_bytes(digest, kind, bytes ? bytes : "", (size_t)sqlite3_column_bytes(row, i));
        }
    }
    return digest;
}
