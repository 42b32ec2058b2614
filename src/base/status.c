#include "launchdyn/status.h"

#include <stdarg.h>
#include <stdio.h>

const char *ld_status_name(ld_status status)
{
    static const char *const names[] = {
        [LD_OK] = "ok",
        [LD_ERR_INPUT] = "input",
        [LD_ERR_FILE] = "file",
        [LD_ERR_MEMORY] = "memory",
        [LD_ERR_NUMERIC] = "numeric",
        [LD_ERR_LAUNCH] = "launch",
        [LD_ERR_INTERRUPTED] = "interrupted",
        [LD_ERR_MISSING] = "missing",
    };
    return names[status];
}

ld_status ld_fail(ld_error *error, ld_status status, const char *format, ...)
{
    if (error) {
        char text[LD_ERROR_TEXT];
        va_list arguments;
        va_start(arguments, format);
        error->status = status;
        vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
        ld_visible_text(text, error->text, sizeof error->text);
    }
    return status;
}
