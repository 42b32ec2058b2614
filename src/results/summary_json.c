#include "results/summary_json.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory_stream.h"
#include "base/numeric_locale.h"
#include "launchdyn/output.h"
#include "launchdyn/version.h"
#include "model/parts.h"
#include "quantities/summary.h"
#include "quantities/summary_quantities.h"
#include "results/json.h"
#include "results/json_text.h"
#include "results/origin.h"
#include "run/measure_names.h"

// ---- numbers by their paths

// Whether what ends there in a path of segments, each with a point after it, is a list ("[]").
static bool is_list(const char *path, size_t end)
{
    return end >= 3 && strncmp(path + end - 3, "[].", 3) == 0;
}

// Opens the object or list that the path's segment from `at` to `end` names; an item of a list has
// its name within.
static void open_segment(json_writer *json, const char *path, size_t at, size_t end)
{
    char name[QUANTITY_NAME];
    bool item = is_list(path, at), list = is_list(path, end);
    snprintf(name, sizeof name, "%.*s", (int)(end - at - (list ? 3 : 1)), path + at);
    json_open(json, item ? NULL : name, list ? '[' : '{');
    if (item)
        json_text(json, "name", name);
}

// Closes what is not of the path, opens what it has besides; `inside` is the object or list that
// numbers stand in, "" or with a point.
static void enter_object(json_writer *json, char inside[QUANTITY_NAME], const char *path)
{
    size_t same = 0;
    for (size_t i = 0; path[i] && path[i] == inside[i]; i++)
        same = path[i] == '.' ? i + 1 : same;
    for (size_t at = strlen(inside); at > same;) {
        json_close(json, is_list(inside, at) ? ']' : '}');
        for (at--; at > 0 && inside[at - 1] != '.'; at--)
            ;
    }
    for (size_t at = same, end; path[at]; at = end) {
        end = at + strcspn(path + at, ".") + 1;
        open_segment(json, path, at, end);
    }
    snprintf(inside, QUANTITY_NAME, "%s", path);
}

static void write_number(json_writer *json, char inside[QUANTITY_NAME], const quantity_walk *at,
                         const void *from)
{
    char path[QUANTITY_NAME], in[QUANTITY_NAME];
    quantity_text(at->row->json ? at->row->json : at->row->name, at->group->each, at->item,
                  at->things, path, sizeof path - 1);
    const char *end = strrchr(path, '.'), *key = end ? end + 1 : path;
    bool in_list = strchr(key, '[') != NULL;
    if (in_list)
        strcat(path, ".");
    snprintf(in, sizeof in, "%.*s", (int)(in_list ? strlen(path) : (size_t)(key - path)), path);
    enter_object(json, inside, in);
    double value = quantity_value(at, from);
    if (at->row->at.type == QUANTITY_NUMBER)
        json_number(json, in_list ? NULL : key, value);
    else
        json_integer(json, in_list ? NULL : key, (long long)value);
}

// The quantities of a table that are there, in its order.
static void write_numbers(json_writer *json, const quantity_table *table,
                          const quantity_things *things, const void *from)
{
    char inside[QUANTITY_NAME] = "";
    for (quantity_walk at = quantity_first(table, things); at.row; quantity_next(&at))
        if ((things->launcher || !at.group->launch) && quantity_is_there(at.group, from))
            write_number(json, inside, &at, from);
    enter_object(json, inside, "");
}

static void write_rockets(json_writer *json, const ld_summary *summary,
                          const quantity_things *things)
{
    json_open(json, "rockets", '[');
    for (int i = 0; i < summary->rocket_count; i++) {
        json_open(json, NULL, '{');
        write_numbers(json, &rocket_quantities, things, &summary->rocket[i]);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void write_modes(json_writer *json, const ld_summary *summary, const quantity_things *things)
{
    json_open(json, "modes", '[');
    for (int i = 0; i < summary->mode_count; i++) {
        json_open(json, NULL, '{');
        write_numbers(json, &mode_quantities, things, &summary->mode[i]);
        json_text(json, "shape", summary->mode[i].shape);
        json_close(json, '}');
    }
    json_close(json, ']');
}

// What each number of `measure` is, where there are such.
static void write_measures(json_writer *json, const ld_model *model)
{
    static const char *const takes[] = {"value", "peak",    "change", "rms",
                                        "mean",  "largest", "least",  "expression"};
    if (model_measure_count(model) == 0)
        return;
    json_open(json, "measures", '[');
    for (int i = 0; i < model_measure_count(model); i++) {
        const ld_measure *measure = model_measure(model, i);
        json_open(json, NULL, '{');
        json_text(json, "name", measure->name);
        json_text(json, "unit", measure_unit(model, i));
        if (measure->take == LD_TAKE_EXPRESSION) {
            json_text(json, "expression", measure->expression);
            json_close(json, '}');
            continue;
        }
        json_text(json, "of", measure->of);
        json_text(json, "take", takes[measure->take]);
        json_text(json, measure->take == LD_TAKE_VALUE ? "at" : "from", measure->from);
        if (measure->take != LD_TAKE_VALUE) {
            json_text(json, "to", measure->to);
            json_open(json, "within", '[');
            json_number(json, NULL, measure->within[0]);
            json_number(json, NULL, measure->within[1]);
            json_close(json, ']');
        }
        json_close(json, '}');
    }
    json_close(json, ']');
}

// ---- the whole

static void write_end(json_writer *json, const ld_summary *summary)
{
    json_number(json, "t_end", summary->t_end);
    json_truth(json, "complete", summary->complete);
    json_key(json, "stopped");
    if (summary->complete)
        fputs("null", json->file);
    else
        json_write_text(json->file, summary->stopped);
    json_open(json, "notes", '[');
    for (int i = 0; i < summary->note_count; i++)
        json_text(json, NULL, summary->note[i]);
    json_close(json, ']');
}

// Last of all, and the scenario's texts last of that: a report leaves them out of what it shows.
static void write_texts(json_writer *json, const ld_origin *origin)
{
    json_text(json, "scenario", origin->scenario);
    json_key(json, "source");
    origin_write_source(json->file, origin);
}

static void write_files(json_writer *json, const manifest_file *file)
{
    char digest[24];
    json_open(json, "files", '[');
    for (int i = 0; i < MANIFEST_FILES; i++) {
        if (!file[i].there)
            continue;
        snprintf(digest, sizeof digest, "%016" PRIx64, file[i].digest);
        json_open(json, NULL, '{');
        json_text(json, "name", manifest_name[i]);
        json_integer(json, "size", file[i].size);
        json_text(json, "digest", digest);
        json_close(json, '}');
    }
    json_close(json, ']');
}

// Up to the last member, the digest.
static void write_summary(json_writer *json, const ld_model *model, const ld_summary *summary,
                          const ld_origin *origin, const manifest_file *file)
{
    const quantity_things things = quantity_things_of(model);
    json_open(json, NULL, '{');
    json_key(json, "format");
    fputs(MANIFEST_FORMAT, json->file);
    const char *title = model_title(model);
    json_text(json, "title", title ? title : "");
    json_text(json, "version", LD_VERSION);
    json_key(json, "program");
    origin_write_program(json->file, origin);
    write_end(json, summary);
    write_rockets(json, summary, &things);
    write_measures(json, model);
    write_numbers(json, &run_quantities, &things, summary);
    if (model_has_launcher(model))
        write_modes(json, summary, &things);
    write_numbers(json, &cost_quantities, &things, summary);
    write_texts(json, origin);
    write_files(json, file);
    fputs(",\n", json->file);
}

// The text before the digest, to be freed.
static ld_status make_text(const ld_model *model, const ld_summary *summary,
                           const manifest_file *file, char **text, size_t *length, ld_error *error)
{
    ld_origin origin;
    ld_status status = ld_origin_of(model, &origin, error);
    if (status)
        return status;
    json_writer json = {.file = memory_stream(text, length)};
    locale_t before = numeric_locale_enter();
    if (json.file)
        write_summary(&json, model, summary, &origin, file);
    numeric_locale_leave(before);
    ld_origin_free(&origin);
    return json.file && fclose(json.file) == 0 && *text
               ? LD_OK
               : ld_fail(error, LD_ERR_MEMORY, "no memory for the summary");
}

static ld_status print_sealed(const ld_model *model, const ld_summary *summary,
                              const manifest_file *file, FILE *stream, ld_error *error)
{
    char *text = NULL;
    size_t length = 0;
    ld_status status = make_text(model, summary, file, &text, &length, error);
    if (!status)
        manifest_seal(stream, text, length);
    free(text);
    return status;
}

ld_status ld_summary_print_json(const ld_model *model, const ld_summary *summary, FILE *stream,
                                ld_error *error)
{
    return print_sealed(model, summary, (manifest_file[MANIFEST_FILES]){{0}}, stream, error);
}

ld_status summary_write(const char *path, const ld_model *model, const ld_summary *summary,
                        const manifest_file file[MANIFEST_FILES], ld_error *error)
{
    FILE *stream = fopen(path, "w");
    if (!stream)
        return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(errno));
    ld_status status = print_sealed(model, summary, file, stream, error);
    bool wrong = fflush(stream) != 0 || ferror(stream);
    int number = errno;
    if (fclose(stream) != 0 && !wrong) {
        wrong = true;
        number = errno;
    }
    if (!status && !wrong)
        return LD_OK;
    unlink(path);
    return status ? status
                  : ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(number));
}

ld_status ld_summary_write(const char *path, const ld_model *model, const ld_summary *summary,
                           ld_error *error)
{
    return summary_write(path, model, summary, (manifest_file[MANIFEST_FILES]){{0}}, error);
}
