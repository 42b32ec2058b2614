#include "fmu/pack/fmu_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "launchdyn/scenario.h"
#include "launchdyn/version.h"

static const char style[] =
    "body{font:16px/1.5 sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}"
    "table{border-collapse:collapse;width:100%;font-size:14px}"
    "th,td{border-bottom:1px solid #ccc;text-align:left;padding:2px 8px;vertical-align:top}"
    "pre,code{font-family:monospace}pre{white-space:pre-wrap}img{float:right}";

static void write_head(FILE *stream, const fmu_description *self, const char *icon)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>", stream);
    fmu_write_text(stream, self->title);
    fprintf(stream, "</title>\n<style>%s</style></head>\n<body>\n<img src=\"%s\" alt=\"\">\n<h1>",
            style, icon);
    fmu_write_text(stream, self->title);
    fprintf(stream,
            "</h1>\n<p>A Functional Mock-up Unit, FMI %d.0, for co-simulation%s, written by "
            "launchdyn %s. All numbers are in SI, angles in rad. Inertial frame I: x forward, y "
            "up, z to the right.</p>\n",
            self->version, self->variables->exchange ? " and model exchange" : "", ld_version());
}

// The scenario in words, lines that begin with "# ".
static void write_words(FILE *stream, const ld_model *model)
{
    char *text = NULL, *mark;
    size_t length;
    FILE *words = memory_stream(&text, &length);
    if (!words)
        return;
    ld_model_describe(model, words);
    if (fclose(words) == 0) {
        fputs("<h2>What it is</h2>\n<pre>", stream);
        for (char *line = text; *line; line = mark + 1) {
            mark = line + strcspn(line, "\n");
            bool last = !*mark;
            *mark = '\0';
            fmu_write_text(stream, line + (strncmp(line, "# ", 2) == 0 ? 2 : 0));
            fputc('\n', stream);
            if (last)
                break;
        }
        fputs("</pre>\n", stream);
    }
    free(text);
}

static void write_coupling(FILE *stream, const fmu_description *self)
{
    const fmu_runner *runner = self->variables->runner;
    fputs("<h2>How to couple it</h2>\n<ul>\n", stream);
    if (runner == &fmu_vehicle)
        fputs("<li>At each communication point set <code>input.wrench.*</code>, the wrench of the "
              "tube on its base about the undeformed tube's rear end, in I; step; read "
              "<code>base.*</code>, the frame of the undeformed tube. Outputs depend on no input "
              "at once.</li>\n",
              stream);
    else if (runner->input_count > 0)
        fputs("<li>At each communication point set <code>input.base.*</code>, the frame of the "
              "undeformed tube, in I, first; then read <code>wrench.*</code>, the wrench of the "
              "tube on its base about that tube's rear end; step. A quaternion 0 0 0 0 is one "
              "that is not set yet.</li>\n",
              stream);
    else
        fputs("<li>Outputs do not depend on the communication step.</li>\n", stream);
    if (runner->ignite)
        fputs("<li>Rockets are ignited at their times in the scenario, or, with "
              "<code>ignition_by_input</code>, where <code>input.ignition</code> becomes "
              "true.</li>\n",
              stream);
    if (self->version == 3)
        fputs(
            "<li>With event mode and early return a step ends at ignition, release, exits and the "
            "end.</li>\n",
            stream);
    fputs("<li>Parameters hold from the initialisation on. A value that is refused is one line of "
          "the log.</li>\n",
          stream);
    fprintf(stream, "<li>The run starts at %.12g s.", self->start);
    if (!isnan(self->stop))
        fprintf(stream, " It is over at %.12g s.", self->stop);
    fputs("</li>\n</ul>\n", stream);
}

// Of an array of that length, 1: of a variable that is none.
static void write_row(FILE *stream, const fmu_variable *v, size_t length)
{
    fputs("<tr><td><code>", stream);
    if (length > 1)
        fmu_write_array_name(stream, v);
    else
        fmu_write_text(stream, v->name);
    fputs("</code>", stream);
    if (length > 1)
        fprintf(stream, " [%zu]", length);
    fputs("</td><td>", stream);
    fmu_write_text(stream, v->unit);
    fputs("</td><td>", stream);
    if (v->text)
        fmu_write_text(stream, v->text);
    else if (fmu_type_of(v) == FMU_BOOLEAN)
        fputs(v->start != 0 ? "true" : "false", stream);
    else if (!isnan(v->start))
        for (size_t i = 0; i < length; i++)
            fprintf(stream, "%s%.9g", i > 0 ? " " : "", v[i].start);
    fputs("</td><td>", stream);
    fmu_write_array_meaning(stream, v, length);
    fputs("</td></tr>\n", stream);
}

static void write_table(FILE *stream, const fmu_description *self, const char *title,
                        bool asked(const fmu_variable *))
{
    const fmu_variables *all = self->variables;
    bool begun = false;
    for (size_t i = 0; i < all->count; i += fmu_listed_length(self, i)) {
        if (!asked(&all->item[i]))
            continue;
        if (!begun)
            fprintf(stream,
                    "<h2>%s</h2>\n<table>\n<tr><th>name</th><th>unit</th><th>start</th>"
                    "<th>meaning</th></tr>\n",
                    title);
        begun = true;
        write_row(stream, &all->item[i], fmu_listed_length(self, i));
    }
    if (begun)
        fputs("</table>\n", stream);
}

void fmu_page_write(const fmu_description *self, const ld_model *model, const char *icon,
                    FILE *stream)
{
    write_head(stream, self, icon);
    write_words(stream, model);
    write_coupling(stream, self);
    write_table(stream, self, "Inputs", fmu_is_input);
    write_table(stream, self, "Outputs", fmu_is_output);
    write_table(stream, self, "Parameters", fmu_is_parameter);
    write_table(stream, self, "States, rates, event indicators", fmu_is_local);
    fputs("</body>\n</html>\n", stream);
}
