#include "report/report_study_plan.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"
#include "model/parts.h"
#include "report/report_origin.h"
#include "results/json_text.h"
#include "scenario/scenario.h"
#include "scenario/scenario_text.h"

// A pair of texts, the second made by fprintf.
static void write_line(FILE *json, bool *first, const char *name, const char *format, ...)
    LD_PRINTF(4, 5);

static void write_line(FILE *json, bool *first, const char *name, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fputs(*first ? "[" : ",[", json);
    *first = false;
    json_write_text(json, name);
    fputc(',', json);
    json_write_text(json, text);
    fputc(']', json);
}

static void write_samples(FILE *json, bool *first, const ld_scatter *scatter)
{
    const char *each = scatter->replicates == 1 ? "" : "s";
    const int replicate = plan_replicate(scatter);
    if (scatter->plan == LD_PLAN_LHS)
        write_line(json, first, "plan", "%d Latin hypercube%s of %d samples", scatter->replicates,
                   each, replicate);
    else if (scatter->plan == LD_PLAN_SOBOL)
        write_line(json, first, "plan", "%d scrambling%s of %d Sobol points", scatter->replicates,
                   each, replicate);
    else if (scatter->plan == LD_PLAN_SALTELLI)
        write_line(json, first, "plan", "Saltelli's, %d rows of %d runs%s", scatter->samples,
                   plan_row(scatter), plan_has_points(scatter) ? ", scrambled Sobol points" : "");
    else if (scatter->plan == LD_PLAN_MORRIS)
        write_line(json, first, "plan", "Morris's, %d trajectories of %d runs", scatter->samples,
                   plan_row(scatter));
    else
        write_line(json, first, "plan", "random, %d samples", scatter->samples);
}

static void write_plan(FILE *json, const ld_model *model)
{
    const ld_scatter *scatter = model_scatter(model);
    bool first = true;
    fputs("\"plan\":[", json);
    if (scatter->present)
        write_samples(json, &first, scatter);
    if (scatter->present)
        write_line(json, &first, "seed", "%d", scatter->seed);
    for (int i = 0; i < scatter->until_count; i++) {
        char text[256];
        scenario_until_text(model, &scatter->until[i], text, sizeof text);
        write_line(json, &first, "until half the 95 % interval is at most", "%s", text);
    }
    for (int i = 0; i < model_sweep_count(model); i++)
        write_line(json, &first, "swept", "%s, %d values", model_sweep(model, i)->path,
                   model_sweep(model, i)->count);
    fputc(']', json);
}

static void write_factors(FILE *json, const ld_model *model)
{
    const ld_scatter *scatter = model_scatter(model);
    fputs(",\"factors\":[", json);
    for (int i = 0; i < scatter->factor_count; i++) {
        char text[512];
        scenario_factor_text(model, &scatter->factor[i], text, sizeof text);
        fputs(i ? ",\n[" : "[", json);
        json_write_text(json, scatter->factor[i].path);
        fputc(',', json);
        json_write_text(json, text);
        fprintf(json, ",\"each %s\"]", scatter->factor[i].per_rocket ? "rocket" : "sample");
    }
    fputs("],\"correlated\":[", json);
    for (int g = 0; g < scatter->correlated_count; g++) {
        const ld_correlated *group = &scatter->correlated[g];
        fputs(g ? ",[" : "[", json);
        for (int i = 0; i < group->count; i++) {
            fputs(i ? "," : "", json);
            json_write_text(json, scatter->factor[group->factor[i]].path);
        }
        fputc(']', json);
    }
    fputc(']', json);
}

ld_status study_write_plan(FILE *json, const study_source *source, int index)
{
    const study_data *data = &source->study[index];
    const ld_origin *origin = &source->origin[index];
    const char *text = origin->scenario ? origin->scenario : data->scenario;
    ld_messages messages;
    ld_model *model = malloc(sizeof *model);
    if (!model)
        return LD_ERR_MEMORY;
    fputs("{\"label\":", json);
    json_write_text(json, data->title && *data->title ? data->title : source->folder[index]);
    ld_status status =
        scenario_read_text(text, strlen(text), "study", ".", NULL, 0, model, &messages);
    if (!status) {
        fputc(',', json);
        write_plan(json, model);
        write_factors(json, model);
        model_clear(model);
    } else {
        ld_messages_free(&messages);
    }
    free(model);
    if (origin->scenario) {
        fputs(",\"origin\":", json);
        report_write_origin(json, origin, REPORT_ORIGIN_BYTES / (size_t)source->study_count);
    }
    fputc('}', json);
    return status == LD_ERR_MEMORY ? status : LD_OK;
}
