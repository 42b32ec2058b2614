// Bytes in a page: deflated (zlib), in base64.
#include <stdlib.h>
#include <zlib.h>

#include "report/report_parts.h"

static void write_base64(FILE *text, const unsigned char *byte, size_t count)
{
    static const char letter[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (; count >= 3; byte += 3, count -= 3) {
        char four[4] = {letter[byte[0] >> 2], letter[(byte[0] & 3) << 4 | byte[1] >> 4],
                        letter[(byte[1] & 15) << 2 | byte[2] >> 6], letter[byte[2] & 63]};
        fwrite(four, 1, 4, text);
    }
    if (count > 0) {
        unsigned second = count > 1 ? byte[1] : 0;
        char four[4] = {letter[byte[0] >> 2], letter[(byte[0] & 3) << 4 | second >> 4],
                        count > 1 ? letter[(second & 15) << 2] : '=', '='};
        fwrite(four, 1, 4, text);
    }
}

ld_status report_write_bytes(FILE *text, const void *bytes, size_t count, ld_error *error)
{
    uLongf length = compressBound(count);
    unsigned char *deflated = malloc(length);
    bool fine = deflated && compress2(deflated, &length, bytes, count, 6) == Z_OK;
    if (fine)
        write_base64(text, deflated, length);
    free(deflated);
    return fine ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
}
