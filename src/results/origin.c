#include "results/origin.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "model/fields/source.h"
#include "model/model.h"
#include "results/json_text.h"
#include "results/program.h"
#include "scenario/scenario.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the texts of the scenario");
}

bool origin_add_fact(ld_origin *origin, const char *name, const char *text)
{
    ld_fact *list = realloc(origin->fact, (origin->fact_count + 1) * sizeof *list);
    if (!list)
        return false;
    origin->fact = list;
    ld_fact *fact = &list[origin->fact_count++];
    *fact = (ld_fact){strdup(name), strdup(text)};
    return fact->name && fact->text;
}

// An origin on its way.
typedef struct gathering {
    ld_origin *origin;
    bool fine;
} gathering;

static void gather_text(void *self, const char *name, const char *text)
{
    gathering *to = self;
    to->fine = to->fine && origin_add_fact(to->origin, name, text);
}

ld_status ld_origin_of(const ld_model *model, ld_origin *origin, ld_error *error)
{
    size_t length;
    gathering to = {origin, true};
    *origin = (ld_origin){.point = model->point, .sample = model->sample};
    origin->source = source_hold(model->source);
    program_describe(gather_text, &to);
    FILE *stream = memory_stream(&origin->scenario, &length);
    if (stream)
        ld_model_print(model, stream);
    if (stream && fclose(stream) == 0 && to.fine)
        return LD_OK;
    ld_origin_free(origin);
    return no_memory(error);
}

void ld_origin_free(ld_origin *origin)
{
    for (size_t i = 0; i < origin->fact_count; i++) {
        free(origin->fact[i].name);
        free(origin->fact[i].text);
    }
    free(origin->fact);
    free(origin->scenario);
    source_free(origin->source);
    *origin = (ld_origin){0};
}

// ---- is it this program?

typedef struct comparison {
    const ld_origin *origin;
    FILE *stream;
    int count; // of what differs
} comparison;

static void compare(void *self, const char *name, const char *text)
{
    comparison *between = self;
    const ld_origin *origin = between->origin;
    const char *before = "not known";
    for (size_t i = 0; i < origin->fact_count; i++)
        if (strcmp(origin->fact[i].name, name) == 0)
            before = origin->fact[i].text;
    if (strcmp(before, text) == 0)
        return;
    if (between->stream)
        fprintf(between->stream, "%s%s %s, here %s", between->count ? "; " : "", name, before,
                text);
    between->count++;
}

bool ld_origin_differs(const ld_origin *origin, char *text, size_t size)
{
    comparison between = {.origin = origin};
    char *whole = NULL;
    size_t length;
    between.stream = memory_stream(&whole, &length);
    program_describe(compare, &between);
    if (between.stream)
        fclose(between.stream);
    snprintf(text, size, "%s", whole ? whole : "no memory to say in what");
    free(whole);
    return between.count > 0;
}

// ---- as JSON

// "\n    " before a member, with a comma after another one.
static void begin_member(FILE *json, size_t index, int depth)
{
    fprintf(json, "%s\n%*s", index ? "," : "", 2 * depth, "");
}

void origin_write_program(FILE *json, const ld_origin *origin)
{
    fputc('{', json);
    for (size_t i = 0; i < origin->fact_count; i++) {
        begin_member(json, i, 2);
        json_write_text(json, origin->fact[i].name);
        fputs(": ", json);
        json_write_text(json, origin->fact[i].text);
    }
    fputs("\n  }", json);
}

void origin_write_source(FILE *json, const ld_origin *origin)
{
    const ld_source *source = origin->source;
    if (!source) {
        fputs("null", json);
        return;
    }
    fputs("{\n    \"files\": [", json);
    for (size_t i = 0; i < source->file_count; i++) {
        begin_member(json, i, 3);
        fputs("{\"name\": ", json);
        json_write_text(json, source->file[i]->name);
        fputs(", \"text\": ", json);
        json_write_text(json, source->file[i]->text);
        fputc('}', json);
    }
    fputs("\n    ],\n    \"set\": [", json);
    for (size_t i = 0; i < source->set_count; i++) {
        begin_member(json, i, 3);
        json_write_text(json, source->set[i]);
    }
    fprintf(json, "%s],\n    \"point\": %d,\n    \"sample\": %d\n  }",
            source->set_count ? "\n    " : "", origin->point, origin->sample);
}
