// Any files, of which the first is read as a scenario: it and those that it names end with messages
// or with a model that holds what model_checks.h says. The texts lie between zero bytes: a.yaml,
// b.yaml, c.yaml, d.csv, e.eng; what is missing is not there.
#include <stdint.h>

#include "fuzz/model_checks.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const name[] = {"a.yaml", "b.yaml", "c.yaml", "d.csv", "e.eng"};
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        const uint8_t *zero = size ? memchr(data, 0, size) : NULL;
        size_t length = zero ? (size_t)(zero - data) : size;
        remove(in_memory(name[i]));
        if (length > 0)
            write_in_memory(name[i], data, length);
        data += length + (zero != NULL);
        size -= length + (zero != NULL);
    }
    ld_model model;
    ld_messages messages;
    ld_status status = scenario_read(in_memory("a.yaml"), NULL, 0, &model, &messages);
    check_reading(status, &messages);
    if (status == LD_OK) {
        check_model(&model);
        model_clear(&model);
    }
    return 0;
}
