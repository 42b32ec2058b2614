// Packs vehicle and launcher of a scenario, connected with each other, as an archive of SSP 1.0.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory_stream.h"
#include "base/numeric_locale.h"
#include "base/text_file.h"
#include "fmu/fmu_description.h"
#include "fmu/pack/fmu_export.h"
#include "fmu/pack/fmu_selection.h"
#include "fmu/pack/package.h"
#include "launchdyn/fmu.h"
#include "launchdyn/scenario.h"
#include "launchdyn/version.h"
#include "model/parts.h"

enum { PATH_SIZE = 4096, NAME_SIZE = 512, FMU_BYTES = 64 << 20, PARTS = 2 };

static const ld_fmu_part parts[PARTS] = {LD_FMU_VEHICLE, LD_FMU_LAUNCHER};

// What the archive holds, of each part.
typedef struct system_structure {
    const ld_model *model;
    const ld_fmu_options *options;
    fmu_variables variables[PARTS];
    char *fmu[PARTS];
    size_t fmu_length[PARTS];
    char *structure;
    size_t structure_length;
} system_structure;

// ---- SystemStructure.ssd ----

// What one part reports is an output, what it receives an input.
static void write_component(FILE *stream, const system_structure *self, int k)
{
    const char *name = fmu_part_name(parts[k]);
    fprintf(stream,
            "      <ssd:Component name=\"%s\" type=\"application/x-fmu-sharedlibrary\" "
            "source=\"resources/%s.fmu\" implementation=\"CoSimulation\">\n"
            "        <ssd:Connectors>\n",
            name, name);
    for (size_t i = 0; i < self->variables[k].count; i++) {
        const fmu_variable *v = &self->variables[k].item[i];
        if (fmu_is_input(v) || fmu_is_output(v))
            fprintf(stream,
                    "          <ssd:Connector name=\"%s\" kind=\"%s\"><ssc:%s/></ssd:Connector>\n",
                    v->name, fmu_is_input(v) ? "input" : "output",
                    fmu_type_of(v) == FMU_BOOLEAN ? "Boolean" : "Real");
    }
    fputs("        </ssd:Connectors>\n      </ssd:Component>\n", stream);
}

// The variable of a group by its number in it.
static const char *name_of(const fmu_variables *variables, fmu_group group, int index)
{
    for (size_t i = 0; i < variables->count; i++)
        if (variables->item[i].group == group && variables->item[i].index == index)
            return variables->item[i].name;
    return NULL;
}

// What part k reports, the other one receives.
static void write_connections(FILE *stream, const system_structure *self, int k)
{
    const fmu_variables *from = &self->variables[k], *to = &self->variables[1 - k];
    for (int i = 0; i < from->runner->output_count; i++)
        fprintf(stream,
                "      <ssd:Connection startElement=\"%s\" startConnector=\"%s\" "
                "endElement=\"%s\" endConnector=\"%s\"/>\n",
                fmu_part_name(parts[k]), name_of(from, FMU_PART_OUTPUT, i),
                fmu_part_name(parts[1 - k]), name_of(to, FMU_PART_INPUT, i));
}

static void write_structure(FILE *stream, const system_structure *self)
{
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<ssd:SystemStructureDescription version=\"1.0\" name=\"",
          stream);
    const char *title = model_title(self->model);
    fmu_write_text(stream, title ? title : "launch");
    fprintf(stream,
            "\" generationTool=\"launchdyn %s\"\n"
            "    xmlns:ssc=\"http://ssp-standard.org/SSP1/SystemStructureCommon\"\n"
            "    xmlns:ssd=\"http://ssp-standard.org/SSP1/SystemStructureDescription\">\n"
            "  <ssd:System name=\"launch\">\n    <ssd:Elements>\n",
            ld_version());
    for (int k = 0; k < PARTS; k++)
        write_component(stream, self, k);
    fputs("    </ssd:Elements>\n    <ssd:Connections>\n", stream);
    for (int k = 0; k < PARTS; k++)
        write_connections(stream, self, k);
    fputs("    </ssd:Connections>\n  </ssd:System>\n  <ssd:DefaultExperiment", stream);
    fmu_write_experiment(stream, self->variables[0].start, self->variables[0].stop, NAN);
    fputs("/>\n</ssd:SystemStructureDescription>\n", stream);
}

// ---- the archive ----

// The FMU of a part, by way of a file beside the archive.
static ld_status make_fmu(system_structure *self, int k, const char *file, ld_error *error)
{
    char path[PATH_SIZE];
    ld_error why;
    ld_fmu_options options = *self->options;
    options.part = parts[k];
    snprintf(path, sizeof path, "%.4000s.%s", file, fmu_part_name(parts[k]));
    ld_status status = fmu_export_part(self->model, &options, path, error);
    if (status)
        return status;
    status = text_file_read(path, FMU_BYTES, &self->fmu[k], &self->fmu_length[k], &why);
    unlink(path);
    return status ? ld_fail(error, status, "%.400s %s", path, why.text) : LD_OK;
}

static ld_status describe(system_structure *self, ld_error *error)
{
    fmu_part unused;
    for (int k = 0; k < PARTS; k++) {
        ld_status status =
            fmu_part_variables(parts[k], self->model, &unused, &self->variables[k], error);
        if (status)
            return status;
    }
    ld_status status = fmu_selection_check(self->options, self->variables, PARTS, error);
    if (status)
        return status;
    for (int k = 0; k < PARTS; k++)
        fmu_selection_take(self->options, &self->variables[k]);
    FILE *stream = memory_stream(&self->structure, &self->structure_length);
    if (stream)
        write_structure(stream, self);
    return stream && fclose(stream) == 0 ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory");
}

static void put_all(package *self, const void *data)
{
    const system_structure *from = data;
    char name[NAME_SIZE];
    package_put(self, "SystemStructure.ssd", from->structure, from->structure_length);
    for (int k = 0; k < PARTS; k++) {
        snprintf(name, sizeof name, "resources/%s.fmu", fmu_part_name(parts[k]));
        package_put(self, name, from->fmu[k], from->fmu_length[k]);
    }
}

ld_status ld_ssp_export(const ld_model *model, const ld_fmu_options *options, const char *file,
                        ld_error *error)
{
    system_structure self = {.model = model, .options = options};
    if (options->arrays)
        return ld_fail(error, LD_ERR_INPUT, "found arrays, which connectors of SSP 1.0 cannot be");
    locale_t before = numeric_locale_enter();
    ld_status status = describe(&self, error);
    numeric_locale_leave(before);
    for (int k = 0; k < PARTS && !status; k++)
        status = make_fmu(&self, k, file, error);
    if (!status)
        status = package_write(file, put_all, &self, error);
    for (int k = 0; k < PARTS; k++) {
        fmu_variables_free(&self.variables[k]);
        free(self.fmu[k]);
    }
    free(self.structure);
    return status;
}
