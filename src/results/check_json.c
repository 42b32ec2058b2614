// What a check of a scenario has found, and its natural frequencies, as JSON. The scenario is what
// ld_model_print() prints, turned into JSON event by event: one text has all keys.
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "base/memory_stream.h"
#include "base/numeric_locale.h"
#include "launchdyn/output.h"
#include "launchdyn/scenario.h"
#include "launchdyn/version.h"
#include "model/blocks/limits.h"
#include "results/json.h"

enum { FORMAT = 1, MOST_LEVELS = 16 };

// Where the events of a printed scenario are: what is open, and the key that waits for its value.
typedef struct turning {
    json_writer *json;
    bool array[MOST_LEVELS]; // else an object
    int level;               // -1: nothing is open
    bool has_key;            // there is a key that waits
    char name[LD_MAX_PATH];  // of it
    bool literal;            // under `scatter` or `sweep`: what has a unit stays a text
} turning;

static const char *key_of(const turning *self)
{
    return self->has_key ? self->name : NULL;
}

// The length of the number at the front of a printed value, with nothing but a blank behind it; 0:
// there is none. It is one of JSON, too.
static size_t number_length(const char *text)
{
    char *end = (char *)text;
    if (isdigit((unsigned char)*text) || *text == '-')
        strtod(text, &end);
    return *end && *end != ' ' ? 0 : (size_t)(end - text);
}

// Numbers that a printed value begins with, "0 0 1 m" has three; *unit becomes what follows.
static int count_numbers(const char *text, const char **unit)
{
    int count = 0;
    for (size_t length; (length = number_length(text)) > 0; count++)
        text += length + strspn(text + length, " ");
    *unit = text;
    return count;
}

// A value: a number, an array of several, or a text.
static void turn_scalar(turning *self, const char *text, bool quoted)
{
    const char *key = key_of(self);
    const char *unit;
    int count = quoted ? 0 : count_numbers(text, &unit);
    if (count == 0 || (self->literal && *unit)) {
        json_text(self->json, key, text);
        return;
    }
    if (count > 1)
        json_open(self->json, key, '[');
    for (int i = 0; i < count; i++) {
        size_t length = number_length(text);
        json_key(self->json, count > 1 ? NULL : key);
        fwrite(text, 1, length, self->json->file);
        text += length + strspn(text + length, " ");
    }
    if (count > 1)
        json_close(self->json, ']');
}

static void turn_open(turning *self, bool array)
{
    if (self->level >= 0)
        json_open(self->json, key_of(self), array ? '[' : '{');
    else
        json_open(self->json, "scenario", '{');
    self->array[++self->level] = array;
}

// Takes one event; false where it is none of a printed scenario.
static bool turn_event(turning *self, const yaml_event_t *event)
{
    const char *text = (const char *)event->data.scalar.value;
    bool value = self->level >= 0 && (self->has_key || self->array[self->level]);
    switch (event->type) {
    case YAML_SCALAR_EVENT:
        if (!value) {
            if (self->level == 0)
                self->literal = strcmp(text, "scatter") == 0 || strcmp(text, "sweep") == 0;
            snprintf(self->name, sizeof self->name, "%s", text);
            self->has_key = true;
            return true;
        }
        turn_scalar(self, text, event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE);
        break;
    case YAML_MAPPING_START_EVENT:
    case YAML_SEQUENCE_START_EVENT:
        if (self->level + 1 >= MOST_LEVELS)
            return false;
        turn_open(self, event->type == YAML_SEQUENCE_START_EVENT);
        break;
    case YAML_MAPPING_END_EVENT:
    case YAML_SEQUENCE_END_EVENT:
        json_close(self->json, self->array[self->level--] ? ']' : '}');
        return true;
    default:
        return true;
    }
    self->has_key = false;
    return true;
}

static bool turn_text(json_writer *json, const char *text, size_t length)
{
    turning self = {.json = json, .level = -1};
    yaml_parser_t parser;
    bool good = yaml_parser_initialize(&parser), more = good;
    if (!good)
        return false;
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
    while (good && more) {
        yaml_event_t event;
        good = yaml_parser_parse(&parser, &event);
        if (!good)
            break;
        more = event.type != YAML_STREAM_END_EVENT;
        good = turn_event(&self, &event);
        yaml_event_delete(&event);
    }
    yaml_parser_delete(&parser);
    return good;
}

static bool write_scenario(json_writer *json, const ld_model *model)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = memory_stream(&text, &length);
    if (!stream)
        return false;
    ld_model_print(model, stream);
    bool good = fclose(stream) == 0 && text && turn_text(json, text, length);
    free(text);
    return good;
}

static void write_messages(json_writer *json, const char *key, const ld_messages *messages)
{
    json_open(json, key, '[');
    for (size_t i = 0; messages && i < messages->count; i++) {
        const ld_message *message = &messages->item[i];
        json_open(json, NULL, '{');
        json_text(json, "file", message->file);
        json_integer(json, "line", message->line);
        json_integer(json, "column", message->column);
        json_text(json, "path", message->path);
        json_text(json, "text", message->text);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void write_begin(json_writer *json)
{
    json_open(json, NULL, '{');
    json_integer(json, "format", FORMAT);
    json_text(json, "version", LD_VERSION);
}

static void write_end(json_writer *json)
{
    json_close(json, '}');
    fputc('\n', json->file);
}

ld_status ld_check_print_json(const ld_model *model, const ld_messages *errors,
                              const ld_messages *notes, FILE *stream, ld_error *error)
{
    json_writer json = {.file = stream};
    locale_t before = numeric_locale_enter();
    bool good = true;
    write_begin(&json);
    json_truth(&json, "ok", !(errors && errors->count > 0));
    write_messages(&json, "errors", errors);
    write_messages(&json, "notes", notes);
    if (model) {
        json_integer(&json, "points", ld_scenario_points(model));
        good = write_scenario(&json, model);
    }
    write_end(&json);
    numeric_locale_leave(before);
    return good ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the scenario as JSON");
}

static void write_modes(json_writer *json, const char *key, const ld_mode *mode, int count)
{
    json_open(json, key, '[');
    for (int i = 0; i < count; i++) {
        json_open(json, NULL, '{');
        json_number(json, "frequency", mode[i].frequency);
        json_number(json, "damping", mode[i].damping);
        json_text(json, "shape", mode[i].shape);
        json_close(json, '}');
    }
    json_close(json, ']');
}

void ld_modes_print_json(const ld_found_modes *modes, FILE *stream)
{
    json_writer json = {.file = stream};
    locale_t before = numeric_locale_enter();
    write_begin(&json);
    write_modes(&json, "tube", modes->tube, modes->tube_count);
    write_modes(&json, "system", modes->system, modes->system_count);
    json_open(&json, "eigenvalues", '[');
    for (int i = 0; i < modes->pole_count; i++) {
        json_open(&json, NULL, '{');
        json_number(&json, "real", modes->pole[i].real);
        json_number(&json, "imaginary", modes->pole[i].imaginary);
        json_text(&json, "shape", modes->pole[i].shape);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    write_end(&json);
    numeric_locale_leave(before);
}
