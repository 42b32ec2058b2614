// Any overrides of a true scenario end with messages or with a model that holds what model_checks.h
// says; given to a model that is there they do the same; any path of them is found in the model or
// refused, and a text that is found there sets it to what it is. The first byte chooses the
// scenario, the lines after it are the overrides.
#include <stdint.h>
#include <string.h>

#include "fuzz/true_scenarios.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SETS = 8 };

// A model of its own, the same as the one that is kept.
static void copy_scenario(int which, ld_model *copy)
{
    ld_messages messages;
    must(scenario_read_source(true_scenario(which)->source, 0, copy, &messages) == LD_OK);
}

// What is found by the path, and that setting it to the text that it has changes nothing.
static void ask(ld_model *model, const char *path, const ld_model *same)
{
    char text[4096];
    double value;
    const double *table;
    size_t rows, columns;
    ld_error error = {0};
    ld_messages messages;
    ld_status status = ld_model_number(model, path, &value, &error);
    must(status == LD_OK || (status == LD_ERR_INPUT && error.text[0]));
    status = ld_model_table(model, path, &table, &rows, &columns, &error);
    must(status == LD_OK || (status == LD_ERR_INPUT && error.text[0]));
    status = ld_model_text(model, path, text, sizeof text, &error);
    must(status == LD_OK || (status == LD_ERR_INPUT && error.text[0]));
    if (status || !text[0] || strlen(text) == sizeof text - 1)
        return;
    status = ld_model_set(model, path, text, &messages);
    if (status)
        ld_messages_print(&messages, stderr);
    must(status == LD_OK && same_model(model, same));
}

static void run(int which, const char *const *sets, size_t count)
{
    ld_model given, read;
    ld_messages messages;
    copy_scenario(which, &given);
    ld_status status = ld_model_set_all(&given, sets, count, &messages);
    check_reading(status, &messages);
    must(status == LD_OK || same_model(&given, true_scenario(which)));
    must(read_with_sets(which, sets, count, &read) == status);
    if (status == LD_OK) {
        must(same_model(&given, &read));
        check_model(&read);
    }
    for (size_t i = 0; i < count; i++) {
        char path[256];
        snprintf(path, sizeof path, "%.*s", (int)strcspn(sets[i], "="), sets[i]);
        ask(&given, path, status ? true_scenario(which) : &read);
    }
    model_clear(&given);
    if (status == LD_OK)
        model_clear(&read);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char text[2048];
    const char *sets[SETS];
    size_t count = 0;
    if (size < 2 || size > sizeof text)
        return 0;
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    for (char *line = text; line && count < SETS;) {
        char *end = strchr(line, '\n');
        sets[count++] = line;
        if (end)
            *end++ = '\0';
        line = end;
    }
    run(data[0] % TRUE_SCENARIOS, sets, count);
    return 0;
}
