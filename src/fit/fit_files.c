#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fit/fit_show.h"
#include "launchdyn/version.h"
#include "results/json.h"
#include "search/found_scenario.h"

// ---- JSON

static void write_key(json_writer *json, const ld_fit *fit, int i)
{
    const fit_key *key = &fit->key[i];
    const fit_estimate *found = &fit->estimate[i];
    json_open(json, NULL, '{');
    json_text(json, "path", key->name);
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

static void write_series(json_writer *json, const ld_fit *fit, const fit_log *log, int k)
{
    const fit_series *series = &log->series[k];
    json_open(json, NULL, '{');
    json_text(json, "name", log->log.sensor[k].column);
    json_text(json, "unit", log->log.sensor[k].si);
    json_number(json, "noise", series->noise);
    json_number(json, "correlation", series->correlation);
    json_open(json, "rows", '[');
    for (size_t i = 0; i < series->count; i++) {
        json_open(json, NULL, '[');
        json_number(json, NULL, series->t[i] + fit_log_offset(fit, log));
        json_number(json, NULL, series->value[i]);
        json_number(json, NULL, fit->fitted[(size_t)series->first + i]);
        json_close(json, ']');
    }
    json_close(json, ']');
    json_close(json, '}');
}

static void write_log(json_writer *json, const ld_fit *fit, const fit_log *log)
{
    json_open(json, NULL, '{');
    json_text(json, "file", log->file);
    json_number(json, "offset", fit_log_offset(fit, log));
    json_open(json, "series", '[');
    for (int k = 0; k < log->log.sensors; k++)
        write_series(json, fit, log, k);
    json_close(json, ']');
    json_open(json, "results", '[');
    for (int i = 0; i < log->scalars; i++) {
        const fit_scalar *scalar = &log->scalar[i];
        json_open(json, NULL, '{');
        json_text(json, "name", scalar->name);
        json_number(json, "measured", scalar->measured);
        json_number(json, "uncertainty", scalar->uncertainty);
        json_number(json, "fitted", fit->fitted[scalar->residual]);
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
    json_truth(&json, "profiled", !fit->rough);
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
    json_open(&json, "logs", '[');
    for (int i = 0; i < fit->logs; i++)
        write_log(&json, fit, &fit->log[i]);
    json_close(&json, ']');
    json_close(&json, '}');
    fputs("\n", stream);
}

// ---- files

static ld_status write_fitted(const ld_fit *fit, const char *folder, ld_error *error)
{
    found_key key[FIT_MOST_KEYS];
    for (int i = 0; i < fit->own_keys; i++)
        key[i] = (found_key){&fit->key[i].place, fit->key[i].unit, fit->estimate[i].value};
    const found_scenario found = {.model = fit->model,
                                  .how = "fitted values (launchdyn fit)",
                                  .keys = fit->own_keys,
                                  .key = key};
    return found_scenario_write(&found, folder, "fitted.yaml", error);
}

static ld_status print_document(void *user, FILE *stream, ld_error *error)
{
    const ld_fit *const *fit = user;
    (void)error;
    ld_fit_print_json(*fit, stream);
    return LD_OK;
}

ld_status fit_write(const ld_fit *fit, const char *folder, ld_error *error)
{
    ld_status status = found_file_write(print_document, &fit, folder, "fit.json", error);
    return status ? status : write_fitted(fit, folder, error);
}
