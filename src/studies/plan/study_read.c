#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "model/fields/source.h"
#include "model/model.h"
#include "quantities/study_results.h"
#include "scenario/scenario.h"
#include "studies/plan/study.h"

// Adds to a message which point it is about: " (point 5 of the sweep, rocket.mass: 61 kg)".
static void name_point(ld_message *message, const ld_model *model, int point)
{
    char *text = NULL;
    size_t length;
    FILE *stream = memory_stream(&text, &length);
    if (!stream)
        return;
    fprintf(stream, "%s (point %d of the sweep", message->text, point);
    for (int i = 0; i < model->sweep_count; i++)
        fprintf(stream, ", %s: %s", model->sweep[i].path,
                model->sweep[i].value[ld_scenario_value(model, point, i)]);
    fputc(')', stream);
    if (fclose(stream) == 0 && text) {
        free(message->text);
        message->text = text;
    } else {
        free(text);
    }
}

// Where nothing else says what is wrong.
static ld_status add_message(ld_messages *messages, const char *file, ld_status status,
                             const char *text)
{
    messages->item = calloc(1, sizeof *messages->item);
    if (!messages->item)
        return LD_ERR_MEMORY;
    messages->count = 1;
    ld_message *message = messages->item;
    *message = (ld_message){.file = strdup(file),
                            .path = strdup("scatter"),
                            .text = strdup(text),
                            .source = strdup("")};
    if (message->file && message->path && message->text && message->source)
        return status;
    ld_messages_free(messages);
    return LD_ERR_MEMORY;
}

static ld_status read_points(ld_study *self, ld_messages *messages)
{
    const ld_model *nominal = self->nominal;
    if (nominal->sweep_count == 0) {
        self->model = self->nominal;
        self->points = 1;
        return LD_OK;
    }
    int points = ld_scenario_points(nominal);
    self->model = calloc((size_t)points, sizeof *self->model);
    if (!self->model)
        return LD_ERR_MEMORY;
    for (; self->points < points; self->points++) {
        int point = self->points + 1;
        ld_status status =
            scenario_read_source(nominal->source, point, &self->model[point - 1], messages);
        for (size_t i = 0; status && i < messages->count; i++)
            name_point(&messages->item[i], nominal, point);
        if (status)
            return status;
    }
    return LD_OK;
}

static ld_status find_factors(ld_study *self, ld_error *error)
{
    const ld_scatter *scatter = &self->nominal->scatter;
    self->samples = self->points * plan_runs(scatter);
    self->sampler = calloc((size_t)self->points, sizeof *self->sampler);
    if (!self->sampler)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's factors");
    for (int i = 0; i < self->points; i++) {
        ld_status status = sampler_create(&self->sampler[i], &self->model[i], error);
        if (status)
            return status;
        if (self->model[i].firing_count > self->shape.rockets)
            self->shape.rockets = self->model[i].firing_count;
    }
    self->shape.of_sample = self->sampler[0].of_sample;
    self->shape.of_rocket = self->sampler[0].of_rocket;
    self->things = quantity_things_of(self->nominal);
    self->shape.results = study_result_count(&self->things);
    return LD_OK;
}

// The study of a nominal model that was read with this status; takes the model. `name`: for
// messages.
static ld_status make_study(ld_status status, ld_model *nominal, const char *name, ld_study **out,
                            ld_messages *messages)
{
    ld_study *self = calloc(1, sizeof *self);
    ld_error error = {LD_ERR_MEMORY, "no memory for the study"};
    if (self)
        self->nominal = calloc(1, sizeof *self->nominal);
    if (status || !self || !self->nominal) {
        if (!status)
            model_clear(nominal);
        status = status ? status : LD_ERR_MEMORY;
    } else {
        *self->nominal = *nominal;
        status = read_points(self, messages);
    }
    if (!status)
        status = find_factors(self, &error);
    if (!status) {
        *out = self;
        return LD_OK;
    }
    ld_study_free(self);
    bool told = messages->count > 0 || status == LD_ERR_MEMORY;
    return told ? status : add_message(messages, name, status, error.text);
}

ld_status ld_study_read(const char *path, const char *const *sets, size_t count, ld_study **study,
                        ld_messages *messages)
{
    assert(path && study && messages);
    ld_model nominal;
    ld_status status = scenario_read(path, sets, count, &nominal, messages);
    return make_study(status, &nominal, path, study, messages);
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_study_read_text(const char *text, size_t length, const char *name, const char *folder,
                             const char *const *sets, size_t count, ld_study **study,
                             ld_messages *messages)
{
    ld_model nominal;
    ld_status status =
        scenario_read_text(text, length, name, folder, sets, count, &nominal, messages);
    return make_study(status, &nominal, name, study, messages);
}

ld_status ld_study_read_source(ld_source *source, ld_study **study, ld_messages *messages)
{
    ld_model nominal;
    ld_status status = scenario_read_source(source, 0, &nominal, messages);
    return make_study(status, &nominal, source->name, study, messages);
}

void ld_study_free(ld_study *self)
{
    if (!self)
        return;
    for (int i = 0; i < self->points; i++) {
        if (self->sampler)
            sampler_free(&self->sampler[i]);
        if (self->model != self->nominal)
            model_clear(&self->model[i]);
    }
    if (self->nominal)
        model_clear(self->nominal);
    if (self->model != self->nominal)
        free(self->model);
    free(self->nominal);
    free(self->sampler);
    free(self);
}

const ld_model *ld_study_model(const ld_study *self)
{
    return self->nominal;
}
