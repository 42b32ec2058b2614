#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/part_file.h"
#include "fit/fit_show.h"
#include "launchdyn/scenario.h"
#include "launchdyn/version.h"
#include "model/fields/source.h"
#include "model/model.h"
#include "results/json.h"

// ---- JSON

static void write_key(json_writer *json, const ld_fit *fit, int i)
{
    const fit_key *key = &fit->key[i];
    const fit_estimate *found = &fit->estimate[i];
    json_open(json, NULL, '{');
    json_text(json, "path", key->place.path);
    json_text(json, "unit", key->unit);
    json_number(json, "value", found->value);
    json_number(json, "deviation", found->deviation);
    json_number(json, "low", found->low);
    json_number(json, "high", found->high);
    json_truth(json, "low_is_bound", found->open[0]);
    json_truth(json, "high_is_bound", found->open[1]);
    json_truth(json, "at_bound", found->at_bound);
    json_number(json, "from", key->low);
    json_number(json, "to", key->low + key->width);
    bool prior = isfinite(key->deviation);
    json_number(json, "prior_mean", prior ? key->mean : NAN);
    json_number(json, "prior_deviation", prior ? key->deviation : NAN);
    json_close(json, '}');
}

static void write_matrix(json_writer *json, const ld_fit *fit)
{
    json_open(json, "covariance", '[');
    for (int i = 0; i < fit->keys; i++) {
        json_open(json, NULL, '[');
        for (int j = 0; j < fit->keys; j++)
            json_number(json, NULL,
                        fit->minimum.covariance[i * FIT_MOST_KEYS + j] * fit->inflation *
                            fit->key[i].width * fit->key[j].width);
        json_close(json, ']');
    }
    json_close(json, ']');
}

static void write_directions(json_writer *json, const ld_fit *fit)
{
    json_open(json, "directions", '[');
    for (int k = 0; k < fit->keys; k++) {
        json_open(json, NULL, '{');
        json_number(json, "singular_value", fit->minimum.singular_value[k]);
        json_truth(json, "told", !fit_is_untold(fit, k));
        json_open(json, "direction", '[');
        for (int i = 0; i < fit->keys; i++)
            json_number(json, NULL, fit->minimum.direction[k][i]);
        json_close(json, ']');
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void write_quality(json_writer *json, const ld_fit *fit)
{
    const fit_quality *quality = &fit->quality;
    json_number(json, "chi2", quality->chi2);
    json_integer(json, "freedom", quality->freedom);
    json_number(json, "p", quality->chance);
    json_number(json, "misfit_chi2", quality->misfit);
    json_integer(json, "misfit_freedom", (long long)quality->misfit_freedom);
    json_number(json, "misfit_p", quality->misfit_chance);
    json_integer(json, "estimated_results", fit->data.estimated);
    json_integer(json, "estimated_freedom", fit->data.freedom);
}

static void write_start(json_writer *json, const ld_fit *fit, const fit_start *start)
{
    json_open(json, NULL, '{');
    json_number(json, "chi2", start->chi2);
    json_open(json, "from", '[');
    for (int i = 0; i < fit->keys; i++)
        json_number(json, NULL, fit_key_value(&fit->key[i], start->from[i]));
    json_close(json, ']');
    json_open(json, "to", '[');
    for (int i = 0; i < fit->keys; i++)
        json_number(json, NULL, fit_key_value(&fit->key[i], start->to[i]));
    json_close(json, ']');
    json_close(json, '}');
}

static void write_launch(json_writer *json, const ld_fit *fit, const fit_launch *launch)
{
    json_open(json, NULL, '{');
    json_integer(json, "launches", (long long)launch->rows);
    json_open(json, "settings", '{');
    for (int i = 0; i < fit->data.settings; i++)
        json_number(json, fit->data.setting[i].path, launch->setting[i]);
    json_close(json, '}');
    json_open(json, "results", '[');
    for (int i = 0; i < launch->cells; i++) {
        json_open(json, NULL, '{');
        json_text(json, "name", fit->data.result[launch->result[i]].name);
        json_number(json, "measured", launch->mean[i]);
        json_number(json, "uncertainty", fit_cell_deviation(launch, i));
        json_number(json, "fitted", fit->fitted[launch->first + i]);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

void ld_fit_print_json(const ld_fit *fit, FILE *stream)
{
    enum { FORMAT = 1 };
    json_writer json = {.file = stream};
    if (!fit->done)
        return;
    json_open(&json, NULL, '{');
    json_integer(&json, "format", FORMAT);
    json_text(&json, "version", LD_VERSION);
    json_integer(&json, "simulated", fit->simulated);
    write_quality(&json, fit);
    json_open(&json, "keys", '[');
    for (int i = 0; i < fit->keys; i++)
        write_key(&json, fit, i);
    json_close(&json, ']');
    write_matrix(&json, fit);
    write_directions(&json, fit);
    json_open(&json, "starts", '[');
    for (int i = 0; i < fit->minimum.starts; i++)
        write_start(&json, fit, &fit->minimum.start[i]);
    json_close(&json, ']');
    json_open(&json, "launches", '[');
    for (size_t i = 0; i < fit->data.launches; i++)
        write_launch(&json, fit, &fit->data.launch[i]);
    json_close(&json, ']');
    json_close(&json, '}');
    fputs("\n", stream);
}

// ---- the scenario

// Where the parts of two paths differ first: the number of characters before that part.
static size_t shared_parts(const char *a, const char *b)
{
    size_t shared = 0;
    for (size_t i = 0; a[i] && a[i] == b[i]; i++)
        if (a[i] == '.')
            shared = i + 1;
    return shared;
}

static int by_path(const void *left, const void *right)
{
    const fit_key *a = *(const fit_key *const *)left, *b = *(const fit_key *const *)right;
    return strcmp(a->place.path, b->place.path);
}

// The keys as nested blocks, in the order of their paths.
static void write_blocks(const ld_fit *fit, FILE *stream)
{
    const fit_key *sorted[FIT_MOST_KEYS];
    const char *before = "";
    for (int i = 0; i < fit->keys; i++)
        sorted[i] = &fit->key[i];
    qsort(sorted, (size_t)fit->keys, sizeof(const fit_key *), by_path);
    for (int i = 0; i < fit->keys; i++) {
        const char *path = sorted[i]->place.path;
        size_t at = shared_parts(before, path);
        int depth = 0;
        for (size_t k = 0; k < at; k++)
            depth += path[k] == '.';
        for (const char *part = path + at; part; depth++) {
            int length = (int)strcspn(part, ".");
            fprintf(stream, "%*s%.*s:", 2 * depth, "", length, part);
            part = part[length] ? part + length + 1 : NULL;
            if (part)
                fputs("\n", stream);
        }
        char number[32];
        field_number_text(fit->estimate[sorted[i] - fit->key].value, number);
        fprintf(stream, " %s%s%s\n", number, sorted[i]->unit[0] ? " " : "", sorted[i]->unit);
        before = path;
    }
}

// The way from a folder to the scenario's file, both absolute.
static void write_way(const char *folder, const char *file, FILE *stream)
{
    size_t shared = 0;
    for (size_t i = 0; folder[i] == file[i] && file[i]; i++)
        if (file[i] == '/')
            shared = i + 1;
    size_t length = strlen(folder);
    if (strncmp(folder, file, length) == 0 && file[length] == '/')
        shared = length + 1;
    for (size_t i = shared; i < length; i++)
        if (i == shared || folder[i] == '/')
            fputs("../", stream);
    fputs(file + shared, stream);
}

// Whether the scenario can be included: it is a file, as it stands.
static bool can_include(const ld_model *model, char file[PATH_MAX])
{
    const ld_source *source = ld_model_source(model);
    char path[PATH_MAX];
    if (!source || !source->folder || source->set_count > 0 || source->file_count == 0)
        return false;
    int length = snprintf(path, sizeof path, "%s%s%s", source->folder, source->folder[0] ? "/" : "",
                          source->file[0]->name);
    return length > 0 && length < PATH_MAX && realpath(path, file);
}

// With overrides or without a file: all of it; false: no memory.
static bool write_whole(const ld_fit *fit, FILE *stream)
{
    ld_model *fitted = malloc(sizeof *fitted);
    if (!fitted)
        return false;
    *fitted = *fit->model;
    model_forget(fitted);
    for (int i = 0; i < fit->keys; i++)
        field_set(fitted, &fit->key[i].place, fit->estimate[i].value);
    model_complete(fitted);
    ld_model_print(fitted, stream);
    free(fitted);
    return true;
}

static bool write_scenario(const ld_fit *fit, const char *folder, FILE *stream)
{
    char file[PATH_MAX], there[PATH_MAX];
    if (!can_include(fit->model, file) || !realpath(folder, there))
        return write_whole(fit, stream);
    fputs("# The scenario with the fitted values (launchdyn fit).\ninclude: \"", stream);
    write_way(there, file, stream);
    fputs("\"\n", stream);
    write_blocks(fit, stream);
    return true;
}

// ---- files

static ld_status write_file(const ld_fit *fit, const char *folder, const char *name, bool json,
                            ld_error *error)
{
    char path[4096];
    part_file part;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    ld_status status = part_file_begin(&part, path, error);
    if (status)
        return status;
    FILE *stream = fopen(part.path, "w");
    if (!stream)
        return part_file_end(&part, part_file_failed(&part, errno, error), error);
    bool good = true;
    if (json)
        ld_fit_print_json(fit, stream);
    else
        good = write_scenario(fit, folder, stream);
    good = good && !ferror(stream);
    good = fclose(stream) == 0 && good;
    return part_file_end(&part, good ? LD_OK : part_file_failed(&part, errno, error), error);
}

ld_status fit_write(const ld_fit *fit, const char *folder, ld_error *error)
{
    ld_status status = write_file(fit, folder, "fit.json", true, error);
    return status ? status : write_file(fit, folder, "fitted.yaml", false, error);
}
