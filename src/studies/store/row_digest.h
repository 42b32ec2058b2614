// A digest of values as a database keeps them: CRC-32 (zlib's) of the kind and the bits of each.
// Enough against accidents, not against intent. It begins with 0.
#ifndef LD_STUDIES_ROW_DIGEST_H
#define LD_STUDIES_ROW_DIGEST_H

#include <sqlite3.h>
#include <stddef.h>
#include <stdint.h>

uint32_t digest_null(uint32_t digest);
uint32_t digest_integer(uint32_t digest, int64_t value);
// SQLite keeps no negative zero: both zeros are one.
uint32_t digest_real(uint32_t digest, double value);
uint32_t digest_text(uint32_t digest, const void *text, size_t length);
// Of the columns of a row read, from `first` to before `end`.
uint32_t digest_columns(uint32_t digest, sqlite3_stmt *row, int first, int end);

#endif
