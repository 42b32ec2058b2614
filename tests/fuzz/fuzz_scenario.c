// Any text, read as a scenario, ends with messages or with a model that prints and reads back to
// the same bits, as it does from the texts that it keeps. Text before a zero byte is an override.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenario/scenario.h"
#include "support/model_compare.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char *print_model(const ld_model *model, size_t *length)
{
    char *text = NULL;
    FILE *stream = open_memstream(&text, length);
    ld_model_print(model, stream);
    fclose(stream);
    return text;
}

static void print_messages(const ld_messages *messages)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ld_messages_print(messages, stream);
    fclose(stream);
    free(text);
}

// What was read must pass the checks of hand-filled models and survive printing.
static void check_model(const ld_model *model)
{
    ld_model again;
    ld_messages messages;
    ld_error error;
    size_t length;
    char *text = print_model(model, &length);
    ld_status status = scenario_read_text(text, length, "printed", "", NULL, 0, &again, &messages);
    if (status != LD_OK) {
        ld_messages_print(&messages, stderr);
        abort();
    }
    if (!same_model(model, &again) || model_check(model, &error) != LD_OK)
        abort();
    model_clear(&again);
    free(text);
}

// The texts that the model keeps, and no file, give the same model.
static void check_source(const ld_model *model)
{
    ld_model again;
    ld_messages messages;
    char *folder = model->source->folder;
    model->source->folder = NULL;
    ld_status status = scenario_read_source(model->source, 0, &again, &messages);
    model->source->folder = folder;
    if (status != LD_OK) {
        ld_messages_print(&messages, stderr);
        abort();
    }
    if (!same_model(model, &again))
        abort();
    model_clear(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *text = (const char *)data, *zero = memchr(data, 0, size);
    size_t before = zero ? (size_t)(zero - text) + 1 : 0;
    const char *const sets[] = {text};
    ld_model model;
    ld_messages messages;
    ld_status status = scenario_read_text(text + before, size - before, "fuzz", "examples", sets,
                                          zero ? 1 : 0, &model, &messages);
    if ((status == LD_OK) != (messages.count == 0) || status == LD_ERR_MEMORY)
        abort();
    if (status == LD_OK) {
        check_model(&model);
        check_source(&model);
        model_clear(&model);
    }
    print_messages(&messages);
    ld_messages_free(&messages);
    return 0;
}
