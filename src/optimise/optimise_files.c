#include <math.h>
#include <stdlib.h>

#include "launchdyn/version.h"
#include "optimise/optimise.h"
#include "results/json.h"
#include "run/aims.h"
#include "search/found_scenario.h"

// ---- JSON

static void write_estimate(json_writer *json, const char *key, const ld_estimate *of)
{
    json_open(json, key, '{');
    json_number(json, "value", of->value);
    json_number(json, "low", of->low);
    json_number(json, "high", of->high);
    json_close(json, '}');
}

// Of the scenario's values and of the best, on the samples of the search and on others.
static void write_aim(json_writer *json, const ld_optimisation *self, int i)
{
    const optimise_aim *aim = &self->aim[i];
    const double *first = self->candidate[0].number, *best = self->candidate[self->best].number;
    char text[256];
    aim_text(aim->as, text, sizeof text);
    json_text(json, "text", text);
    json_text(json, "unit", aim->as->unit);
    if (i > 0) {
        json_number(json, "at_most", aim->as->at_most);
        json_number(json, "at_least", aim->as->at_least);
    }
    const double *const *others = (const double *const *)self->others;
    const struct {
        const char *key;
        optimise_pair of;
    } shown[] = {{"scenario", {first, NULL, false}},
                 {"found", {best, NULL, false}},
                 {"difference", {best, first, false}},
                 {"scenario_others", {others[0], NULL, true}},
                 {"found_others", {others[1], NULL, true}},
                 {"difference_others", {others[1], others[0], true}}};
    for (size_t k = 0; k < sizeof shown / sizeof *shown; k++) {
        bool pair = k % 3 == 2;
        if (!shown[k].of.number || (pair && !shown[k].of.from))
            continue;
        ld_estimate found = optimise_estimate(self, i, &shown[k].of);
        write_estimate(json, shown[k].key, &found);
    }
}

static void write_key(json_writer *json, const ld_optimisation *self, int i)
{
    const optimise_key *key = &self->key[i];
    json_open(json, NULL, '{');
    json_text(json, "path", key->place.path);
    json_text(json, "unit", key->unit);
    json_number(json, "scenario", field_get(self->model, &key->place));
    json_number(json, "found", optimise_key_value(key, self->candidate[self->best].x[i]));
    json_number(json, "from", key->from);
    json_number(json, "to", key->to);
    json_truth(json, "log", key->log);
    json_close(json, '}');
}

static void write_start(json_writer *json, const ld_optimisation *self, const optimum *start)
{
    static const char *const ends[] = {"precision", "noise", "evaluations", "no launch"};
    json_open(json, NULL, '{');
    json_text(json, "end", ends[start->end]);
    json_integer(json, "candidates", start->evaluations);
    json_integer(json, "best", start->best.number);
    json_number(json, "value", start->best.number >= 0 ? start->best.value : NAN);
    json_close(json, '}');
    (void)self;
}

static void write_candidate(json_writer *json, const ld_optimisation *self,
                            const optimise_candidate *of)
{
    json_open(json, NULL, '{');
    json_integer(json, "start", of->start);
    json_truth(json, "launched", of->there);
    json_number(json, "value", of->value);
    json_truth(json, "holds", !(of->worst > 0));
    json_open(json, "keys", '[');
    for (int i = 0; i < self->keys; i++)
        json_number(json, NULL, optimise_key_value(&self->key[i], of->x[i]));
    json_close(json, ']');
    json_close(json, '}');
}

static void write_course(json_writer *json, const ld_optimisation *self)
{
    json_open(json, "starts", '[');
    for (int i = 0; i < self->starts; i++)
        write_start(json, self, &self->start[i]);
    json_close(json, ']');
    json_open(json, "candidates", '[');
    for (int i = 0; i < self->candidates; i++)
        write_candidate(json, self, &self->candidate[i]);
    json_close(json, ']');
}

void ld_optimise_print_json(const ld_optimisation *self, FILE *stream)
{
    enum { FORMAT = 1 };
    json_writer json = {.file = stream};
    if (!self->done)
        return;
    json_open(&json, NULL, '{');
    json_integer(&json, "format", FORMAT);
    json_text(&json, "version", LD_VERSION);
    json_text(&json, "method", optimum_method_of(self->as->method)->name);
    json_integer(&json, "samples", self->samples);
    json_integer(&json, "others", optimise_is_noisy(self) ? self->others_count : 0);
    json_integer(&json, "simulated", self->simulated);
    json_integer(&json, "failed", self->failed);
    json_text(&json, "reason", self->reason);
    json_truth(&json, "holds", !(self->candidate[self->best].worst > 0));
    json_integer(&json, "best", self->best);
    json_open(&json, "least", '{');
    write_aim(&json, self, 0);
    json_close(&json, '}');
    json_open(&json, "keys", '[');
    for (int i = 0; i < self->keys; i++)
        write_key(&json, self, i);
    json_close(&json, ']');
    json_open(&json, "subject_to", '[');
    for (int i = 1; i < self->aims; i++) {
        json_open(&json, NULL, '{');
        write_aim(&json, self, i);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    write_course(&json, self);
    json_close(&json, '}');
    fputs("\n", stream);
}

// ---- files

static ld_status write_found(const ld_optimisation *self, const char *folder, ld_error *error)
{
    found_key key[LD_MAX_BOUNDS];
    for (int i = 0; i < self->keys; i++)
        key[i] = (found_key){&self->key[i].place, self->key[i].unit,
                             optimise_key_value(&self->key[i], self->candidate[self->best].x[i])};
    const found_scenario found = {.model = self->model,
                                  .how = "optimised values (launchdyn optimise)",
                                  .keys = self->keys,
                                  .key = key};
    return found_scenario_write(&found, folder, "optimised.yaml", error);
}

static ld_status print_document(void *user, FILE *stream, ld_error *error)
{
    const ld_optimisation *const *self = user;
    (void)error;
    ld_optimise_print_json(*self, stream);
    return LD_OK;
}

ld_status optimise_write(const ld_optimisation *self, const char *folder, ld_error *error)
{
    ld_status status = found_file_write(print_document, &self, folder, "optimise.json", error);
    return status ? status : write_found(self, folder, error);
}
