// Packs an FMU: description, binary, resources, notices.
#include "fmu/pack/fmu_export.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "base/numeric_locale.h"
#include "fmu/fmu_description.h"
#include "fmu/fmu_inside.h"
#include "fmu/fmu_source.h"
#include "fmu/pack/fmu_icon.h"
#include "fmu/pack/fmu_page.h"
#include "fmu/pack/fmu_selection.h"
#include "fmu/pack/package.h"
#include "foreign/unpack.h"
#include "launchdyn/fmu.h"
#include "launchdyn/scenario.h"
#include "math/functions.h"
#include "model/fields/digest.h"
#include "model/fields/source.h"
#include "model/model.h"

enum { NAME_SIZE = 512, IDENTIFIER_SIZE = 64 }; // MATLAB cuts longer names

// ---- what goes in ----

typedef struct contents {
    const ld_model *model;
    ld_fmu_options options;
    bool checked; // what is selected must be there
    char token[FMU_TOKEN_SIZE];
    char identifier[IDENTIFIER_SIZE];
    char *scenario, *description, *list, *part, *page, *svg, *png;
    size_t scenario_length, description_length, list_length, part_length, page_length, svg_length,
        png_length;
} contents;

// The icon, which FMI 2.0 has as PNG alone.
#define ICON_2 "model.png"
#define ICON_3 "terminalsAndIcons/icon"

static ld_status print_scenario(const ld_model *model, contents *self, ld_error *error)
{
    FILE *stream = memory_stream(&self->scenario, &self->scenario_length);
    if (stream)
        ld_model_print(model, stream);
    bool fine = stream && fclose(stream) == 0;
    stream = fine ? memory_stream(&self->list, &self->list_length) : NULL;
    if (stream)
        fmu_source_write_list(ld_model_source(model), stream);
    if (!stream || fclose(stream) != 0)
        return ld_fail(error, LD_ERR_MEMORY, "no memory");
    return LD_OK;
}

static ld_status print_part(const fmu_part *part, contents *self, ld_error *error)
{
    FILE *stream = memory_stream(&self->part, &self->part_length);
    if (stream)
        fmu_part_write(part, stream);
    return stream && fclose(stream) == 0 ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory");
}

// "Reference launcher: vehicle".
static void name_part(const ld_model *model, ld_fmu_part part, char title[NAME_SIZE])
{
    bool all = part == LD_FMU_ALL;
    snprintf(title, NAME_SIZE, "%.400s%s%s", model->title ? model->title : "launch",
             all ? "" : ": ", all ? "" : fmu_part_name(part));
}

// Adds "_word" for each word of a text, as far as there is room.
static void add_words(char *identifier, size_t size, const char *text)
{
    size_t length = strlen(identifier);
    bool inside = false;
    for (; *text && length + 2 < size; text++) {
        bool letter = isascii((unsigned char)*text) && isalnum((unsigned char)*text);
        if (letter && !inside)
            identifier[length++] = '_';
        if (letter)
            identifier[length++] = (char)tolower((unsigned char)*text);
        inside = letter;
    }
    identifier[length] = '\0';
}

// A name of C, another one for every other FMU: several may be open in one importer that
// distinguishes their binaries by it.
static void make_identifier(contents *self)
{
    enum { LONGEST_TITLE = 44 };
    const ld_fmu_options *options = &self->options;
    const char *texts[] = {self->token, options->outputs, "/", options->parameters};
    uint64_t digest = digest_bytes(DIGEST_BEGIN, &(char){(char)options->version}, 1);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        digest = digest_bytes(digest, texts[i] ? texts[i] : "*", strlen(texts[i] ? texts[i] : "*"));
    if (options->arrays)
        digest = digest_bytes(digest, "[]", 2);
    strcpy(self->identifier, "launchdyn");
    add_words(self->identifier, LONGEST_TITLE, self->model->title ? self->model->title : "");
    if (options->part != LD_FMU_ALL)
        add_words(self->identifier, IDENTIFIER_SIZE, fmu_part_name(options->part));
    size_t length = strlen(self->identifier);
    snprintf(self->identifier + length, IDENTIFIER_SIZE - length, "_%08" PRIx32,
             (uint32_t)(digest ^ digest >> 32));
}

static ld_status print_description(const fmu_variables *variables, contents *self, ld_error *error)
{
    char title[NAME_SIZE];
    fmu_description description = {.version = self->options.version,
                                   .title = title,
                                   .token = self->token,
                                   .identifier = self->identifier,
                                   .start = variables->start,
                                   .stop = variables->stop,
                                   .variables = variables,
                                   .arrays = self->options.arrays};
    fmu_token(self->scenario, self->scenario_length, self->options.part, self->token);
    name_part(self->model, self->options.part, title);
    make_identifier(self);
    ld_model_number(self->model, "run.tolerance", &description.tolerance, NULL);
    FILE *stream = memory_stream(&self->description, &self->description_length);
    if (stream)
        fmu_description_write(&description, stream);
    bool fine = stream && fclose(stream) == 0;
    stream = fine ? memory_stream(&self->page, &self->page_length) : NULL;
    if (stream)
        fmu_page_write(&description, self->model,
                       self->options.version == 2 ? "../" ICON_2 : "../" ICON_3 ".png", stream);
    return stream && fclose(stream) == 0 ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory");
}

static ld_status draw_icon(contents *self, ld_error *error)
{
    FILE *stream = memory_stream(&self->svg, &self->svg_length);
    if (stream)
        fmu_icon_write_svg(self->model, self->options.part, stream);
    bool fine = stream && fclose(stream) == 0;
    stream = fine ? memory_stream(&self->png, &self->png_length) : NULL;
    if (stream)
        fine = fmu_icon_write_png(self->model, self->options.part, stream);
    return stream && fclose(stream) == 0 && fine ? LD_OK
                                                 : ld_fail(error, LD_ERR_MEMORY, "no memory");
}

// When the launch of the whole is over, a base outside at rest: its length rounded up to two
// digits. NaN: it does not come to its end. LD_ERR_MEMORY alone is a failure.
static ld_status find_stop(const ld_model *model, const ld_simulation *whole, double *stop,
                           ld_error *error)
{
    const fmu_runner *runner = fmu_part_runner(LD_FMU_ALL, model);
    fmu_part part;
    *stop = NAN;
    ld_status status = fmu_part_find(LD_FMU_ALL, whole, &part, error);
    void *run = status ? NULL : runner->begin(whole, part.start, error);
    if (!run)
        return error->status == LD_ERR_MEMORY ? LD_ERR_MEMORY : LD_OK;
    double start = runner->time(run);
    status = runner->advance(run, INFINITY, error);
    double length = runner->time(run) - start, digit = pow(10, floor(log10(length)) - 1);
    runner->end(run);
    if (!status && length > 0)
        *stop = start + digit * ceil(length / digit * (1 - 1e-12));
    return status == LD_ERR_MEMORY ? status : LD_OK;
}

// The launcher of a vehicle is simulated on its own.
ld_status fmu_part_variables(ld_fmu_part which, const ld_model *model, fmu_part *part,
                             fmu_variables *variables, ld_error *error)
{
    ld_model *of_part = malloc(sizeof *of_part);
    ld_simulation *whole = NULL, *alone = NULL;
    *variables = (fmu_variables){0};
    if (!of_part)
        return ld_fail(error, LD_ERR_MEMORY, "no memory");
    *of_part = *model; // shares what the model holds
    ld_status status = ld_simulation_create(model, &whole, error);
    if (!status)
        status = fmu_part_find(which, whole, part, error);
    fmu_part_take(which, of_part);
    if (!status && which == LD_FMU_LAUNCHER)
        status = ld_simulation_create(of_part, &alone, error);
    if (!status)
        status = fmu_variables_make(part, of_part, alone ? alone : whole, variables, error);
    if (!status)
        status = find_stop(model, whole, &variables->stop, error);
    ld_simulation_free(alone);
    ld_simulation_free(whole);
    free(of_part);
    return status;
}

static ld_status describe(contents *self, ld_error *error)
{
    fmu_part part;
    fmu_variables variables;
    ld_status status =
        fmu_part_variables(self->options.part, self->model, &part, &variables, error);
    if (!status && self->checked)
        status = fmu_selection_check(&self->options, &variables, 1, error);
    if (!status)
        status = print_part(&part, self, error);
    if (!status) {
        fmu_selection_take(&self->options, &variables);
        status = print_description(&variables, self, error);
    }
    fmu_variables_free(&variables);
    return status;
}

// The scenario as it was written, with what it includes, tables and overrides.
static void put_sources(package *self, const contents *from, const ld_source *source)
{
    char name[FMU_SOURCE_NAME], path[FMU_SOURCE_NAME + 16];
    package_put(self, "resources/" FMU_SOURCE_LIST, from->list, from->list_length);
    for (size_t i = 0; i < source->file_count; i++) {
        fmu_source_name(source, i, name);
        snprintf(path, sizeof path, "resources/%s", name);
        package_put(self, path, source->file[i]->text, source->file[i]->length);
    }
}

// This machine's, and that for Windows where it was built.
static void put_binaries(package *self, const contents *from)
{
    bool two = from->options.version == 2;
    char binary[IDENTIFIER_SIZE + 32];
    size_t windows = (size_t)(fmu_windows_end - fmu_windows);
    snprintf(binary, sizeof binary, "binaries/%s/%s.so",
             two ? FOREIGN_BINARIES_2 : FOREIGN_BINARIES_3, from->identifier);
    package_put(self, binary, fmu_binary, (size_t)(fmu_binary_end - fmu_binary));
    snprintf(binary, sizeof binary, "binaries/%s/%s.dll", two ? "win64" : "x86_64-windows",
             from->identifier);
    if (windows > 0)
        package_put(self, binary, fmu_windows, windows);
}

static void put_all(package *self, const void *data)
{
    const contents *from = data;
    package_put(self, "modelDescription.xml", from->description, from->description_length);
    put_binaries(self, from);
    package_put(self, "resources/" FMU_SCENARIO_FILE, from->scenario, from->scenario_length);
    package_put(self, "resources/" FMU_PART_FILE, from->part, from->part_length);
    put_sources(self, from, ld_model_source(from->model));
    package_put(self, "documentation/licenses/license.txt", fmu_notices,
                (size_t)(fmu_notices_end - fmu_notices));
    package_put(self, "documentation/index.html", from->page, from->page_length);
    package_put(self, from->options.version == 2 ? ICON_2 : ICON_3 ".png", from->png,
                from->png_length);
    if (from->options.version > 2)
        package_put(self, ICON_3 ".svg", from->svg, from->svg_length);
}

static ld_status export_checked(const ld_model *model, const ld_fmu_options *options, bool checked,
                                const char *file, ld_error *error)
{
    contents from = {.model = model, .options = *options, .checked = checked};
    char kind[16];
    if (options->version != 2 && options->version != 3)
        return ld_fail(error, LD_ERR_INPUT, "found FMI %d, expected 2 or 3", options->version);
    if (options->arrays && options->version != 3)
        return ld_fail(error, LD_ERR_INPUT, "found arrays with FMI 2, expected FMI 3");
    if (!ld_model_text(model, "base.kind", kind, sizeof kind, NULL) && strcmp(kind, "fmu") == 0)
        return ld_fail(
            error, LD_ERR_INPUT,
            "a launch on base.kind: fmu cannot be exported: an FMU cannot run another FMU");
    if (fmu_binary_end - fmu_binary < 2)
        return ld_fail(error, LD_ERR_MISSING, "this launchdyn was built without FMU export");
    locale_t before = numeric_locale_enter();
    ld_status status = print_scenario(model, &from, error);
    if (!status)
        status = describe(&from, error);
    if (!status)
        status = draw_icon(&from, error);
    numeric_locale_leave(before);
    if (!status)
        status = package_write(file, put_all, &from, error);
    free(from.scenario);
    free(from.list);
    free(from.part);
    free(from.description);
    free(from.page);
    free(from.svg);
    free(from.png);
    return status;
}

ld_status ld_fmu_export(const ld_model *model, const ld_fmu_options *options, const char *file,
                        ld_error *error)
{
    return export_checked(model, options, true, file, error);
}

ld_status fmu_export_part(const ld_model *model, const ld_fmu_options *options, const char *file,
                          ld_error *error)
{
    return export_checked(model, options, false, file, error);
}
