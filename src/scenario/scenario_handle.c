// Models as handles.
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"
#include "model/parts.h"
#include "scenario/scenario.h"

// Hands out what has been read; NULL after a failure.
static ld_status hand_out(ld_status status, ld_model *read, ld_model **model)
{
    if (status)
        free(read);
    *model = status ? NULL : read;
    return status;
}

ld_status ld_scenario_read(const char *path, const char *const *sets, size_t count,
                           ld_model **model, ld_messages *messages)
{
    assert(path && model && messages);
    ld_model *self = malloc(sizeof *self);
    *messages = (ld_messages){0};
    return hand_out(self ? scenario_read(path, sets, count, self, messages) : LD_ERR_MEMORY, self,
                    model);
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_scenario_read_text(const char *text, size_t length, const char *name,
                                const char *folder, const char *const *sets, size_t count,
                                ld_model **model, ld_messages *messages)
{
    assert(text && name && folder && model && messages);
    ld_model *self = malloc(sizeof *self);
    *messages = (ld_messages){0};
    return hand_out(
        self ? scenario_read_text(text, length, name, folder, sets, count, self, messages)
             : LD_ERR_MEMORY,
        self, model);
}

ld_status ld_scenario_read_source(ld_source *source, int point, ld_model **model,
                                  ld_messages *messages)
{
    ld_model *self = malloc(sizeof *self);
    *messages = (ld_messages){0};
    return hand_out(self ? scenario_read_source(source, point, self, messages) : LD_ERR_MEMORY,
                    self, model);
}

ld_status ld_model_new(const char *const *sets, size_t count, ld_model **model,
                       ld_messages *messages)
{
    static const char nothing[] = "launchdyn: 1\n";
    return ld_scenario_read_text(nothing, strlen(nothing), "defaults", "", sets, count, model,
                                 messages);
}

ld_source *ld_model_source(const ld_model *model)
{
    return model->source;
}

bool ld_model_has_launcher(const ld_model *model)
{
    return model_has_launcher(model);
}

const char *ld_model_guide(const ld_model *model)
{
    return model_guide_word(model);
}

bool ld_model_has_vehicle(const ld_model *model)
{
    return model_has_vehicle(model);
}
