#include "report/report_study_over.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "quantities/study_results.h"
#include "report/report_study_numbers.h"
#include "results/json_text.h"
#include "studies/points/over_statistic.h"

enum { MOST_RESULTS = 12, MOST_KEYS = 8, MOST_CELLS = 120, RATES = 4 };

// The rates at the exit first: of them the one is chosen that moves most.
static const char *const wanted[] = {"since_ignition.pitch_rate",
                                     "since_ignition.yaw_rate",
                                     "tip_off.pitch_rate",
                                     "tip_off.yaw_rate",
                                     "exit_speed",
                                     "downrange",
                                     "drift",
                                     "apogee"};

// How far the values of a key move a result: of means in standard deviations, where there are some,
// of deviations as the logarithm of their ratio. An effect is sure where its interval says so.
typedef struct over_effect {
    double size;
    bool sure, known;
    int result, key, value; // where it was found
    bool deviation;
} over_effect;

typedef struct over_writer {
    FILE *json;
    study_source *source;
    const study_data *data;
    const study_column *result[MOST_RESULTS];
    int results;
    over_effect lead;
    bool broken; // said already
} over_writer;

// Values of all keys.
static int count_cells(const study_data *data)
{
    int cells = 0;
    for (int k = 0; k < data->swept_count; k++)
        for (int i = 0; i < data->point_count; i++) {
            bool first = true;
            for (int j = 0; j < i && first; j++)
                first = strcmp(data->point[j].text[k], data->point[i].text[k]) != 0;
            cells += first;
        }
    return cells;
}

// The first of those wanted and of the scenario's measures, as many as have room.
static void choose_results(over_writer *self)
{
    const study_data *data = self->data;
    const char *nearest;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        const study_column *column = study_data_find(data, wanted[i], &nearest);
        if (column)
            self->result[self->results++] = column;
    }
    for (int i = 0; i < data->result_count && self->results < MOST_RESULTS; i++)
        if (study_result_is_measure(data->column[i].name))
            self->result[self->results++] = &data->column[i];
    while (self->results > 1 && self->results * count_cells(data) > MOST_CELLS)
        self->results--;
}

// ---- the key that matters

static bool is_rate(const study_column *column)
{
    for (int i = 0; i < RATES; i++)
        if (strcmp(column->name, wanted[i]) == 0)
            return true;
    return false;
}

// Keeps the greater one; a sure effect before one that is not.
static void offer_effect(over_writer *self, const over_effect *effect)
{
    over_effect *lead = &self->lead;
    if (!isfinite(effect->size))
        return;
    if (!lead->known || effect->sure > lead->sure ||
        (effect->sure == lead->sure && effect->size > lead->size))
        *lead = *effect;
    lead->known = true;
}

// ---- cells

// What cannot be read is said once, and left out.
static ld_status find(over_writer *self, over *of, int cell, over_kind kind,
                      const study_column *result, over_found *found)
{
    const over_statistic statistic = {.kind = kind};
    ld_error error;
    ld_status status = over_find(of, cell, &statistic, result, found, &error);
    if (!status || status == LD_ERR_MEMORY)
        return status;
    if (!self->broken)
        study_take_problem(self->source, "the sweep cannot be read: ", &error);
    self->broken = true;
    return LD_OK;
}

typedef struct over_numbers {
    over_found mean, deviation, difference, ratio;
} over_numbers;

// Of a key's value; from the reference the difference, too.
static ld_status find_numbers(over_writer *self, over of[2], int cell, const study_column *result,
                              over_numbers *to)
{
    ld_status status = find(self, &of[0], cell, OVER_MEAN, result, &to->mean);
    if (!status)
        status = find(self, &of[0], cell, OVER_DEVIATION, result, &to->deviation);
    if (!status)
        status = find(self, &of[1], cell, OVER_MEAN, result, &to->difference);
    return status ? status : find(self, &of[1], cell, OVER_DEVIATION, result, &to->ratio);
}

static void weigh_effects(over_writer *self, int result, int key, int value, const over_numbers *of,
                          double deviation)
{
    const estimate *d = &of->difference.of, *r = &of->ratio.of;
    over_effect mean = {.size = fabs(d->value) / (deviation > 0 ? deviation : 1),
                        .sure = d->low > 0 || d->high < 0,
                        .result = result,
                        .key = key,
                        .value = value};
    over_effect spread = mean;
    spread.size = fabs(portable_log(r->value));
    spread.sure = r->low > 1 || r->high < 1;
    spread.deviation = true;
    if (!is_rate(self->result[result]) && is_rate(self->result[0]))
        return;
    offer_effect(self, &mean);
    offer_effect(self, &spread);
}

// Eight digits: the numbers are of study show.
static void write_cell(FILE *json, const over_numbers *of)
{
    fputs("{\"mean\":", json);
    study_write_estimate(json, 0, of->mean.of, study_write_short);
    fputs(",\"deviation\":", json);
    study_write_estimate(json, 0, of->deviation.of, study_write_short);
    fputs(",\"difference\":", json);
    study_write_estimate(json, 0, of->difference.of, study_write_short);
    fputs(",\"ratio\":", json);
    study_write_estimate(json, 0, of->ratio.of, study_write_short);
    fprintf(json, ",\"count\":%zu,\"groups\":%zu}", of->mean.count, of->mean.groups);
}

// The point whose value of the key is the least number, or the first word.
static int reference_of(const over *of)
{
    const over_key *key = &of->key[0];
    int least = 0;
    for (int i = 1; i < key->count && key->numeric; i++)
        least = key->number[i] < key->number[least] ? i : least;
    for (int i = 0; i < of->data->point_count; i++)
        if (strcmp(of->data->point[i].text[key->axis], key->text[least]) == 0)
            return i + 1;
    return 1;
}

// `of`: over the key, and its differences.
static ld_status write_cells(over_writer *self, over of[2], int result, int key)
{
    int cells = over_cell_count(&of[0]);
    double deviation = NAN;
    over_numbers *found = calloc((size_t)cells + 1, sizeof *found);
    ld_status status = found ? LD_OK : LD_ERR_MEMORY;
    for (int i = 0; i < cells && !status; i++) {
        status = find_numbers(self, of, i, self->result[result], &found[i]);
        if (found[i].difference.reference)
            deviation = found[i].deviation.of.value;
    }
    fputs(key ? ",\n[" : "\n[", self->json);
    for (int i = 0; i < cells && !status; i++) {
        weigh_effects(self, result, key, i, &found[i], deviation);
        fputs(i ? "," : "", self->json);
        write_cell(self->json, &found[i]);
    }
    fputc(']', self->json);
    free(found);
    return status;
}

static ld_status open_key(over_writer *self, int key, over of[2])
{
    char point[16];
    ld_error error;
    of[0] = of[1] = (over){0};
    ld_status status = over_open(self->data->swept[key], NULL, self->data, &of[0], &error);
    if (!status) {
        snprintf(point, sizeof point, "%d", reference_of(&of[0]));
        status = over_open(self->data->swept[key], point, self->data, &of[1], &error);
    }
    return status;
}

static void close_key(over of[2])
{
    over_close(&of[0]);
    over_close(&of[1]);
}

static ld_status write_result(over_writer *self, int result)
{
    ld_status status = LD_OK;
    fputs(result ? ",\n{\"name\":" : "\n{\"name\":", self->json);
    json_write_text(self->json, self->result[result]->name);
    fputs(",\"unit\":", self->json);
    json_write_text(self->json, self->result[result]->unit);
    fputs(",\"keys\":[", self->json);
    for (int key = 0; key < self->data->swept_count && key < MOST_KEYS && !status; key++) {
        over of[2];
        status = open_key(self, key, of);
        if (!status)
            status = write_cells(self, of, result, key);
        close_key(of);
    }
    fputs("]}", self->json);
    return status;
}

// ---- keys

static void write_key(FILE *json, const over_key *key, int reference, const study_data *data)
{
    fputs("{\"name\":", json);
    json_write_text(json, key->name);
    fputs(",\"unit\":", json);
    json_write_text(json, key->numeric ? key->unit : "");
    fputs(",\"texts\":[", json);
    for (int i = 0; i < key->count; i++) {
        fputs(i ? "," : "", json);
        json_write_text(json, key->text[i]);
    }
    fputs("],\"numbers\":[", json);
    for (int i = 0; i < key->count && key->numeric; i++) {
        fputs(i ? "," : "", json);
        json_write_number(json, key->number[i]);
    }
    fputs("],\"reference\":", json);
    json_write_text(json, data->point[reference - 1].text[key->axis]);
    fputc('}', json);
}

static ld_status write_keys(over_writer *self)
{
    ld_status status = LD_OK;
    for (int key = 0; key < self->data->swept_count && key < MOST_KEYS && !status; key++) {
        over of[2];
        status = open_key(self, key, of);
        fputs(key ? ",\n" : "\n", self->json);
        if (!status)
            write_key(self->json, &of[0].key[0], reference_of(&of[0]), self->data);
        close_key(of);
    }
    return status;
}

ld_status study_write_over(FILE *json, study_source *source)
{
    over_writer self = {.json = json, .source = source, .data = &source->study[0]};
    if (source->study_count != 1 || self.data->swept_count == 0 || self.data->point_count < 2) {
        fputs("null", json);
        return LD_OK;
    }
    choose_results(&self);
    fputs("{\"keys\":[", json);
    ld_status status = write_keys(&self);
    fputs("],\"results\":[", json);
    for (int i = 0; i < self.results && !status; i++)
        status = write_result(&self, i);
    fprintf(json,
            "],\"lead\":{\"result\":%d,\"key\":%d,\"value\":%d,\"deviation\":%d,\"sure\":%d}}",
            self.results ? self.lead.result : -1, self.lead.key, self.lead.value,
            self.lead.deviation, self.lead.sure);
    return status;
}
