// Bytes in a page: deflated (zlib), in base64.
#include <stdlib.h>
#include <zlib.h>

#include "base/base64.h"
#include "report/report_parts.h"

ld_status report_write_bytes(FILE *text, const void *bytes, size_t count, ld_error *error)
{
    uLongf length = compressBound(count);
    unsigned char *deflated = malloc(length);
    bool fine = deflated && compress2(deflated, &length, bytes, count, 6) == Z_OK;
    if (fine)
        base64_write(&(text_writer){.stream = text}, deflated, length);
    free(deflated);
    return fine ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
}
