// Packs an FMU: description, binary, resources, notices.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <minizip/zip.h>

#include "base/child.h"
#include "base/memory_stream.h"
#include "base/numeric_locale.h"
#include "fmu/fmu_description.h"
#include "fmu/fmu_inside.h"
#include "fmu/fmu_source.h"
#include "launchdyn/fmu.h"
#include "launchdyn/scenario.h"
#include "model/source.h"

enum { PATH_SIZE = 4096, NAME_SIZE = 512 };

// A package being written: what has gone wrong stays.
typedef struct package {
    zipFile zip;
    bool failed;
    int number; // why, of errno
} package;

// Every entry is of the same day, so that equal scenarios make equal packages.
static void put(package *self, const char *name, const void *bytes, size_t size)
{
    const zip_fileinfo info = {.tmz_date = {.tm_mday = 1, .tm_year = 1980}};
    if (self->failed)
        return;
    errno = 0;
    int result = zipOpenNewFileInZip(self->zip, name, &info, NULL, 0, NULL, 0, NULL, Z_DEFLATED,
                                     Z_DEFAULT_COMPRESSION);
    if (result == ZIP_OK)
        result = zipWriteInFileInZip(self->zip, bytes, (unsigned)size);
    if (result == ZIP_OK)
        result = zipCloseFileInZip(self->zip);
    self->failed = result != ZIP_OK;
    self->number = errno;
}

// ---- what goes in ----

typedef struct contents {
    char *scenario, *description, *list, *part;
    size_t scenario_length, description_length, list_length, part_length;
} contents;

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
    char whole[NAME_SIZE - 16];
    ld_model_text(model, "title", whole, sizeof whole, NULL);
    bool all = part == LD_FMU_ALL;
    snprintf(title, NAME_SIZE, "%s%s%s", whole, all ? "" : ": ", all ? "" : fmu_part_name(part));
}

static ld_status print_description(const fmu_part *part, const ld_model *model,
                                   const ld_simulation *simulation, int version, contents *self,
                                   ld_error *error)
{
    char token[FMU_TOKEN_SIZE], title[NAME_SIZE];
    fmu_variables variables;
    fmu_description description = {
        .version = version, .title = title, .token = token, .variables = &variables};
    fmu_token(self->scenario, self->scenario_length, part->which, token);
    name_part(model, part->which, title);
    ld_model_number(model, "run.tolerance", &description.tolerance, NULL);
    ld_status status = fmu_variables_make(part, model, simulation, &variables, error);
    if (!status) {
        description.start = variables.start;
        FILE *stream = memory_stream(&self->description, &self->description_length);
        if (stream)
            fmu_description_write(&description, stream);
        if (!stream || fclose(stream) != 0)
            status = ld_fail(error, LD_ERR_MEMORY, "no memory");
    }
    fmu_variables_free(&variables);
    return status;
}

// Part and description of the FMU; the launcher of a vehicle is simulated by itself.
static ld_status describe(const ld_model *model, ld_fmu_part which, int version, contents *self,
                          ld_error *error)
{
    ld_model of_part = *model; // shares what the model holds
    ld_simulation *whole = NULL, *alone = NULL;
    fmu_part part;
    ld_status status = ld_simulation_create(model, &whole, error);
    if (!status)
        status = fmu_part_find(which, whole, &part, error);
    if (!status)
        status = print_part(&part, self, error);
    fmu_part_take(which, &of_part);
    if (!status && which == LD_FMU_LAUNCHER)
        status = ld_simulation_create(&of_part, &alone, error);
    if (!status)
        status = print_description(&part, &of_part, alone ? alone : whole, version, self, error);
    ld_simulation_free(alone);
    ld_simulation_free(whole);
    return status;
}

// The scenario as it was written, with what it includes, tables and overrides.
static void put_sources(package *self, const contents *from, const ld_source *source)
{
    char name[FMU_SOURCE_NAME], path[FMU_SOURCE_NAME + 16];
    put(self, "resources/" FMU_SOURCE_LIST, from->list, from->list_length);
    for (size_t i = 0; i < source->file_count; i++) {
        fmu_source_name(source, i, name);
        snprintf(path, sizeof path, "resources/%s", name);
        put(self, path, source->file[i]->text, source->file[i]->length);
    }
}

static void put_all(package *self, const ld_model *model, int version, const contents *from)
{
    put(self, "modelDescription.xml", from->description, from->description_length);
    put(self,
        version == 2 ? "binaries/linux64/" FMU_MODEL_IDENTIFIER ".so"
                     : "binaries/x86_64-linux/" FMU_MODEL_IDENTIFIER ".so",
        fmu_binary, (size_t)(fmu_binary_end - fmu_binary));
    put(self, "resources/" FMU_SCENARIO_FILE, from->scenario, from->scenario_length);
    put(self, "resources/" FMU_PART_FILE, from->part, from->part_length);
    put_sources(self, from, ld_model_source(model));
    put(self, "documentation/licenses/license.txt", fmu_notices,
        (size_t)(fmu_notices_end - fmu_notices));
}

static ld_status write_package(const ld_model *model, int version, const contents *from,
                               const char *file, ld_error *error)
{
    char part[PATH_SIZE + 8];
    package self = {0};
    snprintf(part, sizeof part, "%.4000s.part", file);
    child_writes(part);
    self.zip = zipOpen64(part, APPEND_STATUS_CREATE);
    if (!self.zip) {
        self.failed = true;
        self.number = errno;
    } else {
        put_all(&self, model, version, from);
        errno = 0;
        if (zipClose(self.zip, NULL) != ZIP_OK && !self.failed) {
            self.failed = true;
            self.number = errno;
        }
        if (!self.failed && rename(part, file) != 0) {
            self.failed = true;
            self.number = errno;
        }
        if (self.failed)
            unlink(part);
    }
    child_wrote(part);
    if (self.failed)
        return ld_fail(error, LD_ERR_FILE, "cannot write %.400s: %s", file,
                       self.number ? strerror(self.number) : "the package cannot be closed");
    return LD_OK;
}

ld_status ld_fmu_export(const ld_model *model, ld_fmu_part part, int version, const char *file,
                        ld_error *error)
{
    contents from = {0};
    if (version != 2 && version != 3)
        return ld_fail(error, LD_ERR_INPUT, "there is no FMI %d here, but 2 and 3", version);
    if (fmu_binary_end - fmu_binary < 2)
        return ld_fail(error, LD_ERR_MISSING, "this launchdyn was built without what an FMU holds");
    locale_t before = numeric_locale_enter();
    ld_status status = print_scenario(model, &from, error);
    if (!status)
        status = describe(model, part, version, &from, error);
    numeric_locale_leave(before);
    if (!status)
        status = write_package(model, version, &from, file, error);
    free(from.scenario);
    free(from.list);
    free(from.part);
    free(from.description);
    return status;
}
