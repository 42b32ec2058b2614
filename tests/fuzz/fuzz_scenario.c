// Any text, read as a scenario, ends with messages or with a model that holds what model_checks.h
// says. Text before a zero byte is an override.
#include <stdint.h>
#include <string.h>

#include "fuzz/model_checks.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *text = (const char *)data, *zero = memchr(data, 0, size);
    size_t before = zero ? (size_t)(zero - text) + 1 : 0;
    const char *const sets[] = {text};
    ld_model model;
    ld_messages messages;
    ld_status status = scenario_read_text(text + before, size - before, "fuzz", "examples", sets,
                                          zero ? 1 : 0, &model, &messages);
    check_reading(status, &messages);
    if (status == LD_OK) {
        check_model(&model);
        model_clear(&model);
    }
    return 0;
}
