// A study as one piece of bytes, from which any process reads it: the texts that it was read from.
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "launchdyn/scenario.h"
#include "model/fields/source.h"
#include "studies/plan/study.h"

static const char kind[8] = "ldstudy";

static void put_number(FILE *stream, size_t number)
{
    const uint64_t bits = number;
    fwrite(&bits, sizeof bits, 1, stream);
}

static void put_text(FILE *stream, const char *text, size_t length)
{
    put_number(stream, length);
    fwrite(text, 1, length, stream);
}

static void put_source(FILE *stream, const ld_source *source)
{
    fwrite(kind, 1, sizeof kind, stream);
    put_text(stream, source->name, strlen(source->name));
    put_number(stream, source->file_count);
    for (size_t i = 0; i < source->file_count; i++) {
        put_text(stream, source->file[i]->name, strlen(source->file[i]->name));
        put_text(stream, source->file[i]->text, source->file[i]->length);
    }
    put_number(stream, source->set_count);
    for (size_t i = 0; i < source->set_count; i++)
        put_text(stream, source->set[i], strlen(source->set[i]));
}

ld_status ld_study_pack(const ld_study *study, void **packed, size_t *size, ld_error *error)
{
    assert(study && packed && size);
    const ld_source *source = ld_model_source(study->nominal);
    char *text = NULL;
    *packed = NULL;
    if (!source || source->file_count == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "the study cannot run elsewhere: its model was not read from a scenario");
    FILE *stream = memory_stream(&text, size);
    if (stream)
        put_source(stream, source);
    if (!stream || fclose(stream) != 0) {
        free(text);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the texts of the study");
    }
    *packed = text;
    return LD_OK;
}

// ---- back

typedef struct packed_reader {
    const char *next, *end;
    bool good;
} packed_reader;

static size_t get_number(packed_reader *self)
{
    uint64_t bits = 0;
    self->good = self->good && (size_t)(self->end - self->next) >= sizeof bits;
    if (self->good) {
        memcpy(&bits, self->next, sizeof bits);
        self->next += sizeof bits;
    }
    return (size_t)bits;
}

// A text with a zero after its end, to be freed; NULL: there is none, or no memory.
static char *get_text(packed_reader *self, size_t *length)
{
    *length = get_number(self);
    self->good = self->good && (size_t)(self->end - self->next) >= *length;
    char *text = self->good ? malloc(*length + 1) : NULL;
    self->good = text != NULL;
    if (text) {
        memcpy(text, self->next, *length);
        text[*length] = '\0';
        self->next += *length;
    }
    return text;
}

static void get_file(packed_reader *self, ld_source *source)
{
    size_t length;
    char *name = get_text(self, &length);
    char *text = name ? get_text(self, &length) : NULL;
    self->good = text && source_add(source, name, text, length);
    free(name);
}

static void get_set(packed_reader *self, ld_source *source)
{
    size_t length;
    char *text = get_text(self, &length);
    self->good = text && source_add_set(source, text);
    free(text);
}

static ld_source *get_source(packed_reader *self)
{
    size_t length;
    char *name = get_text(self, &length);
    ld_source *source = name ? source_new(name, NULL) : NULL;
    free(name);
    self->good = source != NULL;
    for (size_t i = get_number(self); i > 0 && self->good; i--)
        get_file(self, source);
    for (size_t i = get_number(self); i > 0 && self->good; i--)
        get_set(self, source);
    if (self->good || !source)
        return source;
    source_free(source);
    return NULL;
}

ld_status ld_study_unpack(const void *packed, size_t size, ld_study **study, ld_messages *messages)
{
    assert(packed && study && messages);
    packed_reader reader = {packed, (const char *)packed + size, true};
    *study = NULL;
    *messages = (ld_messages){0};
    if (size < sizeof kind || memcmp(packed, kind, sizeof kind) != 0)
        return LD_ERR_INPUT;
    reader.next += sizeof kind;
    ld_source *source = get_source(&reader);
    if (!source)
        return LD_ERR_INPUT;
    ld_status status = ld_study_read_source(source, study, messages);
    source_free(source);
    return status;
}
