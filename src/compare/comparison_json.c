// A comparison as JSON, in SI.
#include "compare/comparison.h"
#include "launchdyn/version.h"
#include "results/json.h"
#include "results/json_text.h"

static void write_validation(json_writer *json, const ld_validation *of)
{
    static const char *const words[] = {"agree", "disagree", "cannot tell"};
    json_number(json, "u_num", of->u_num);
    json_number(json, "u_input", of->u_input);
    json_number(json, "u_D", of->u_data);
    json_number(json, "u_val", of->u_val);
    json_number(json, "limit", of->limit);
    json_text(json, "verdict", words[of->verdict]);
}

// In one line.
static void write_numbers(json_writer *json, const char *key, const double *value, size_t count)
{
    json_key(json, key);
    for (size_t i = 0; i < count; i++) {
        fputs(i ? ", " : "[", json->file);
        json_write_number(json->file, value[i]);
    }
    fputs(count ? "]" : "[]", json->file);
}

static void write_series(json_writer *json, const ld_compared_series *series)
{
    json_open(json, NULL, '{');
    json_text(json, "name", series->name);
    json_text(json, "unit", series->unit);
    json_integer(json, "samples", (long long)series->count);
    json_integer(json, "saturated", (long long)series->saturated);
    json_integer(json, "missing", (long long)series->gaps);
    json_integer(json, "outside", (long long)series->outside);
    json_number(json, "bias", series->bias);
    json_number(json, "bias_uncertainty", series->bias_uncertainty);
    json_number(json, "E_mean", series->mean);
    json_number(json, "E_rms", series->of.error);
    json_number(json, "E_max", series->largest);
    json_number(json, "t_max", series->t_largest);
    write_validation(json, &series->of);
    write_numbers(json, "t", series->t, series->count);
    write_numbers(json, "measured", series->measured, series->count);
    write_numbers(json, "simulated", series->simulated, series->count);
    write_numbers(json, "u", series->u_val, series->count);
    json_close(json, '}');
}

static void write_result(json_writer *json, const ld_compared_result *result)
{
    json_open(json, NULL, '{');
    json_text(json, "name", result->name);
    json_text(json, "unit", result->unit);
    json_number(json, "measured", result->measured);
    json_number(json, "simulated", result->simulated);
    json_number(json, "E", result->of.error);
    write_validation(json, &result->of);
    json_close(json, '}');
}

void ld_comparison_print_json(const ld_comparison *self, FILE *stream)
{
    json_writer json = {.file = stream, .first = true};
    json_open(&json, NULL, '{');
    json_integer(&json, "format", 1);
    json_text(&json, "version", LD_VERSION);
    json_open(&json, "clock", '{');
    json_number(&json, "offset", self->clock.offset);
    json_number(&json, "uncertainty", self->clock.uncertainty);
    if (self->clock.found_by)
        json_text(&json, "found_by", self->clock.found_by);
    json_close(&json, '}');
    json_open(&json, "series", '[');
    for (int i = 0; i < self->log.sensors; i++)
        write_series(&json, &self->series[i]);
    json_close(&json, ']');
    json_open(&json, "results", '[');
    for (int i = 0; i < self->log.results; i++)
        write_result(&json, &self->result[i]);
    json_close(&json, ']');
    json_open(&json, "notes", '[');
    for (int i = 0; i < self->notes; i++)
        json_text(&json, NULL, self->note[i]);
    json_close(&json, ']');
    json_close(&json, '}');
    fputc('\n', stream);
}
