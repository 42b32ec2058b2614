// What holds of whatever was read as a scenario.
#ifndef LD_TESTS_FUZZ_MODEL_CHECKS_H
#define LD_TESTS_FUZZ_MODEL_CHECKS_H

#include <stdio.h>
#include <stdlib.h>

#include "fuzz/memory_folder.h"
#include "model/fields/source.h"
#include "scenario/scenario.h"
#include "support/model_compare.h"

// A reading ends with a model, or with messages, which can be printed and are freed here.
static inline void check_reading(ld_status status, ld_messages *messages)
{
    char *text = NULL;
    size_t length = 0;
    must((status == LD_OK) == (messages->count == 0) && status != LD_ERR_MEMORY);
    FILE *stream = open_memstream(&text, &length);
    ld_messages_print(messages, stream);
    fclose(stream);
    free(text);
    ld_messages_free(messages);
}

// A reading that goes well and gives this model.
static inline void must_be(ld_status status, ld_model *read, ld_messages *messages,
                           const ld_model *model)
{
    if (status)
        ld_messages_print(messages, stderr);
    must(status == LD_OK && same_model(model, read));
    model_clear(read);
}

// What was read survives printing, where the files that a sweep names are.
static inline void check_printed(const ld_model *model)
{
    ld_model again;
    ld_messages messages;
    char *text = NULL;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    ld_model_print(model, stream);
    fclose(stream);
    ld_status status = scenario_read_text(text, length, "printed", model->source->folder, NULL, 0,
                                          &again, &messages);
    must_be(status, &again, &messages, model);
    free(text);
}

// The texts that the model keeps, and no file, give the same model, and its points end, too, with a
// model or with messages.
static inline void check_source(const ld_model *model)
{
    ld_model again;
    ld_messages messages;
    ld_source *source = model->source;
    char *folder = source->folder;
    source->folder = NULL;
    must_be(scenario_read_source(source, 0, &again, &messages), &again, &messages, model);
    int points = ld_scenario_points(model);
    for (int i = 0; i < 2 && points > 1; i++) {
        ld_status status = scenario_read_source(source, i ? points : 1, &again, &messages);
        check_reading(status, &messages);
        if (status == LD_OK)
            model_clear(&again);
    }
    source->folder = folder;
}

// A model that was read passes the checks of hand-filled ones, too.
static inline void check_model(const ld_model *model)
{
    ld_error error;
    must(model_check(model, &error) == LD_OK);
    check_printed(model);
    check_source(model);
}

#endif
