// Any text as the description of an FMU is refused with one sentence that names the FMU, or has
// variables in the order of their names, each of which is found by its own.
#include <stdint.h>
#include <string.h>

#include "foreign/description.h"
#include "fuzz/must_say.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    foreign_description of;
    ld_error error = {0};
    ld_status status = foreign_describe_text((const char *)data, size, "x.fmu", &of, &error);
    must(!status || (strstr(error.text, "x.fmu: ") && of.count == 0 && !of.token));
    for (size_t i = 0; i < of.count; i++)
        must(foreign_variable_find(&of, of.variable[i].name) == &of.variable[i]);
    must(status || ((of.version == 2 || of.version == 3) && of.token && of.identifier));
    foreign_description_free(&of);
    return 0;
}
