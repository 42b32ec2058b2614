#include "optimise/candidates.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "launchdyn/loop.h"
#include "launchdyn/scenario.h"
#include "model/blocks/firing.h"
#include "model/model.h"
#include "run/aims.h"
#include "search/side_by_side.h"

static const double pi = 3.14159265358979323846;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the candidates");
}

// ---- a batch

// Points of the cube that are computed together.
typedef struct batch {
    candidates *self;
    int count;          // points
    int first, samples; // sample before the first; how many
    const double *points;
    double *number;                // [count][numbers]
    bool *there;                   // [count]
    bool *hopeless;                // [count] without a model, so that no sample is run
    int *failed_at;                // [count] the least sample that failed
    char (*reason)[LD_ERROR_TEXT]; // [count] its
    pthread_mutex_t at_work;
    ld_status status; // what ends the search
    ld_error *error;
} batch;

// The model with the keys of a point; false: `why` says why there is none.
static ld_status make_model(const ld_optimisation *of, const double *x, ld_model *model,
                            ld_error *error)
{
    *model = *of->model;
    model_forget(model); // it follows from what is set
    for (int i = 0; i < of->keys; i++)
        field_set(model, &of->key[i].place, optimise_key_value(&of->key[i], x[i]));
    model_complete(model);
    return model_check_drawn(model, error);
}

static void fail_point(batch *self, int point, int task, const char *reason)
{
    self->there[point] = false;
    if (task < self->failed_at[point])
        snprintf(self->reason[point], sizeof *self->reason, "%s", reason);
    self->failed_at[point] = task < self->failed_at[point] ? task : self->failed_at[point];
}

// The margins of a point's loops: least factor of all gains, least phase.
static ld_status find_margins(const ld_optimisation *of, const ld_model *model, double *margin,
                              ld_error *error)
{
    for (int i = 0; i < of->margins; i++) {
        const ld_aim *aim = of->margin[i];
        ld_loop_margins found;
        ld_loop *loop;
        ld_status status = ld_loop_create(model, aim->of, &loop, error);
        if (status)
            return status;
        ld_loop_margins_of(loop, &found);
        ld_loop_free(loop);
        margin[i] = aim->take == LD_AIM_GAIN_MARGIN ? fmin(found.raise, 1 / found.lower)
                                                    : fmin(found.phase, pi);
    }
    return LD_OK;
}

// The study whose points are those of the batch.
static ld_status make_points(batch *self, ld_error *error)
{
    candidates *all = self->self;
    const ld_optimisation *of = all->of;
    ld_study *study = &all->study;
    size_t numbers = optimise_numbers(of);
    study->points = self->count;
    study->samples = (int64_t)self->count * (self->first + self->samples);
    for (int i = 0; i < self->count; i++) {
        ld_error why;
        double *margin = &self->number[(size_t)(i + 1) * numbers - (size_t)of->margins];
        self->there[i] = true;
        self->failed_at[i] = self->samples;
        ld_status status = make_model(of, &self->points[i * of->keys], &study->model[i], &why);
        if (!status)
            status = find_margins(of, &study->model[i], margin, &why);
        if (status == LD_ERR_MEMORY)
            return no_memory(error);
        if (status)
            fail_point(self, i, 0, why.text);
        self->hopeless[i] = status != LD_OK;
        sampler_free(&study->sampler[i]);
        status = sampler_create(&study->sampler[i], &study->model[i], error);
        if (status)
            return status;
    }
    return LD_OK;
}

// ---- samples

static bool go_on(void *self)
{
    const ld_optimise_options *options = ((const candidates *)self)->options;
    return !options->go_on || options->go_on(options->self);
}

// Copies the results that are asked for out of a record; NULL, or the name of one that is missing.
static const char *take_results(const ld_optimisation *of, const ld_study *study,
                                const study_record *record, double *number)
{
    for (int k = 0; k < of->rockets; k++) {
        const double *result =
            &record->value[record_rocket(&record->shape, k) + 1 + record->shape.of_rocket];
        int place = 0;
        for (quantity_walk at = study_result_first(&study->things); at.row;
             study_result_next(&at), place++) {
            char name[QUANTITY_NAME];
            study_result_name(&at, name);
            for (int i = 0; i < of->results; i++)
                if (strcmp(of->result[i], name) == 0)
                    number[k * of->results + i] = result[place];
        }
    }
    for (int i = 0; i < of->rockets * of->results; i++)
        if (isnan(number[i]))
            return of->result[i % of->results];
    return NULL;
}

static bool run_task(void *user, int worker, int task)
{
    batch *self = user;
    candidates *all = self->self;
    const ld_optimisation *of = all->of;
    int point = task / self->samples, sample = task % self->samples;
    study_worker *own = &all->worker[worker];
    double *number = &self->number[(size_t)point * optimise_numbers(of) +
                                   (size_t)sample * (size_t)(of->rockets * of->results)];
    if (self->hopeless[point])
        return true;
    worker_run(own, (int64_t)(self->first + sample) * self->count + point + 1, go_on, all);
    const study_record *record = own->record;
    bool ends = record->outcome == LD_ERR_INTERRUPTED || record->outcome == LD_ERR_MEMORY;
    const char *missing = record->outcome ? NULL : take_results(of, &all->study, record, number);
    pthread_mutex_lock(&self->at_work);
    all->counts.launches++;
    if (ends) {
        self->status = ld_fail(self->error, (ld_status)record->outcome, "%s", record->reason);
    } else if (record->outcome) {
        fail_point(self, point, sample, record->reason);
    } else if (missing) {
        char text[LD_ERROR_TEXT];
        snprintf(text, sizeof text, "%s: a rocket has no such result", missing);
        fail_point(self, point, sample, text);
    }
    if (all->options->progress)
        all->options->progress(all->options->self, &all->counts);
    pthread_mutex_unlock(&self->at_work);
    return !ends;
}

static ld_status run_batch(batch *self)
{
    candidates *all = self->self;
    ld_status status = make_points(self, self->error);
    if (status)
        return status;
    const side_by_side work = {.tasks = self->count * self->samples,
                               .threads = all->threads,
                               .self = self,
                               .run = run_task};
    status = side_by_side_run(&work, self->error);
    return status ? status : self->status;
}

// Points, at most as many as keys or one, and what is found there.
typedef struct point_set {
    bool others; // samples behind those of the search
    int count;
    const double *points; // [count][keys]
    double *number;       // [count][numbers]
    bool *there;          // [count]
} point_set;

static ld_status compute(candidates *self, const point_set *set, ld_error *error)
{
    int failed_at[LD_MAX_BOUNDS + 1];
    bool hopeless[LD_MAX_BOUNDS + 1];
    batch all = {.self = self,
                 .count = set->count,
                 .first = set->others ? self->of->samples : 0,
                 .samples = set->others ? self->of->others_count : self->of->samples,
                 .points = set->points,
                 .number = set->number,
                 .there = set->there,
                 .hopeless = hopeless,
                 .failed_at = failed_at,
                 .reason = calloc((size_t)set->count, sizeof *all.reason),
                 .error = error,
                 .at_work = PTHREAD_MUTEX_INITIALIZER};
    ld_status status = all.reason ? run_batch(&all) : no_memory(error);
    for (int i = 0; i < set->count && !status; i++)
        if (!set->there[i] && !self->of->reason[0])
            snprintf(self->of->reason, sizeof self->of->reason, "%s", all.reason[i]);
    free(all.reason);
    return status;
}

// The numbers of points, kept ones first.
static ld_status find_numbers(candidates *self, const point_set *set, ld_error *error)
{
    const ld_optimisation *of = self->of;
    size_t numbers = optimise_numbers(of), keys = (size_t)of->keys;
    size_t known = 0, all = (size_t)set->count;
    while (known < all && search_state_next(&self->state, &set->points[known * keys],
                                            &set->number[known * numbers], &set->there[known]))
        known++;
    self->counts.launches += (int64_t)known * (set->others ? of->others_count : of->samples);
    if (known == all)
        return LD_OK;
    const point_set rest = {set->others, (int)(all - known), &set->points[known * keys],
                            &set->number[known * numbers], &set->there[known]};
    ld_status status = compute(self, &rest, error);
    for (size_t i = known; i < all && !status; i++)
        status = search_state_put(&self->state, &set->points[i * keys], &set->number[i * numbers],
                                  set->there[i], error);
    return status ? status : search_state_flush(&self->state, error);
}

// ---- candidates

static bool make_room(ld_optimisation *of, int count)
{
    enum { LEAST = 64 };
    int wanted = of->candidates + count;
    if (wanted <= of->room)
        return true;
    int room = wanted > 2 * of->room ? wanted + LEAST : 2 * of->room;
    optimise_candidate *grown = realloc(of->candidate, (size_t)room * sizeof *grown);
    if (!grown)
        return false;
    of->candidate = grown;
    of->room = room;
    return true;
}

// Value and constraints of a candidate from its numbers.
static void judge(candidates *self, optimise_candidate *to, double *limit)
{
    const ld_optimisation *of = self->of;
    int count = 0;
    to->value = to->there ? optimise_aim_of(of, 0, to->number, self->work) : NAN;
    to->worst = to->there ? -INFINITY : INFINITY;
    for (int i = 1; i < of->aims && to->there; i++) {
        double value = optimise_aim_of(of, i, to->number, self->work);
        for (int lower = 0; lower < 2; lower++) {
            if (isnan(lower ? of->aim[i].as->at_least : of->aim[i].as->at_most))
                continue;
            limit[count] = optimise_excess(&of->aim[i], value, lower);
            to->worst = fmax(to->worst, limit[count++]);
        }
    }
    if (to->there && !(to->worst > 0) && !(self->counts.least <= to->value))
        self->counts.least = to->value;
}

static int limit_count(const ld_optimisation *of)
{
    int count = 0;
    for (int i = 1; i < of->aims; i++)
        count += !isnan(of->aim[i].as->at_most) + !isnan(of->aim[i].as->at_least);
    return count;
}

static ld_status add_candidate(candidates *self, const double *x, const double *number, bool there,
                               ld_error *error)
{
    ld_optimisation *of = self->of;
    size_t size = optimise_numbers(of) * sizeof *number;
    optimise_candidate *to = &of->candidate[of->candidates];
    *to = (optimise_candidate){.start = self->start, .there = there};
    memcpy(to->x, x, (size_t)of->keys * sizeof *x);
    if (there && !(to->number = malloc(size + 1)))
        return no_memory(error);
    if (there)
        memcpy(to->number, number, size);
    of->candidates++;
    of->failed += !there;
    self->counts.candidates = of->candidates;
    return LD_OK;
}

ld_status candidates_evaluate(void *user, int count, const double *points, double *values,
                              bool *there, ld_error *error)
{
    candidates *self = user;
    ld_optimisation *of = self->of;
    size_t numbers = optimise_numbers(of);
    int row = 1 + limit_count(of);
    double *number = calloc((size_t)count * numbers + 1, sizeof *number);
    if (!number)
        return no_memory(error);
    ld_status status = make_room(of, count) ? LD_OK : no_memory(error);
    if (!status)
        status = find_numbers(self, &(point_set){false, count, points, number, there}, error);
    for (int i = 0; i < count && !status; i++) {
        status = add_candidate(self, &points[i * of->keys], &number[(size_t)i * numbers], there[i],
                               error);
        if (status)
            break;
        optimise_candidate *added = &of->candidate[of->candidates - 1];
        judge(self, added, &values[i * row + 1]);
        values[i * row] = added->value;
    }
    free(number);
    return status;
}

bool candidates_are_enough(void *user, int before, int now)
{
    const candidates *self = user;
    const ld_optimisation *of = self->of;
    if (before == now)
        return true;
    const optimise_pair pair = {of->candidate[now].number, of->candidate[before].number, false};
    return optimise_estimate(of, 0, &pair).high >= 0;
}

ld_status candidates_try_others(candidates *self, const double *x, double **number, ld_error *error)
{
    ld_optimisation *of = self->of;
    bool there = false;
    if (!(*number = calloc(optimise_numbers(of) + 1, sizeof **number)))
        return no_memory(error);
    ld_status status = find_numbers(self, &(point_set){true, 1, x, *number, &there}, error);
    if (status || !there) {
        free(*number);
        *number = NULL;
    }
    return status;
}

void candidates_stage(candidates *self, const char *text)
{
    snprintf(self->stage, sizeof self->stage, "%s", text);
    self->counts.stage = self->stage;
}

// ---- from begin to end

// A study whose points are candidates, with room for as many as there are keys.
static ld_status make_study(candidates *self, ld_error *error)
{
    const ld_optimisation *of = self->of;
    ld_study *study = &self->study;
    size_t room = (size_t)of->keys + 1;
    *study = (ld_study){.points = 1};
    study->model = calloc(room + 1, sizeof *study->model); // the last is the nominal one
    study->sampler = calloc(room, sizeof *study->sampler);
    if (!study->model || !study->sampler)
        return no_memory(error);
    study->model[0] = study->model[room] = *of->model;
    study->nominal = &study->model[room];
    ld_status status = sampler_create(&study->sampler[0], &study->model[0], error);
    if (status)
        return status;
    study->things = quantity_things_of(of->model);
    study->shape = (study_shape){.rockets = of->model->firing_count,
                                 .of_sample = study->sampler[0].of_sample,
                                 .of_rocket = study->sampler[0].of_rocket,
                                 .results = study_result_count(&study->things)};
    return LD_OK;
}

static ld_status make_workers(candidates *self, ld_error *error)
{
    ld_status status = LD_OK;
    self->worker = calloc((size_t)self->threads, sizeof *self->worker);
    self->work = calloc((size_t)self->of->samples * (size_t)self->of->rockets + 1, sizeof(double));
    if (!self->worker || !self->work)
        return no_memory(error);
    for (int i = 0; i < self->threads && !status; i++)
        status = worker_create(&self->worker[i], &self->study, error);
    return status;
}

// What the optimisation is of, as text; NULL: no memory.
static char *identity_of(const ld_model *model)
{
    char *text = NULL;
    size_t length;
    FILE *stream = memory_stream(&text, &length);
    if (!stream)
        return NULL;
    ld_model_print(model, stream);
    return fclose(stream) == 0 ? text : NULL;
}

ld_status candidates_open(candidates *self, ld_optimisation *of, const ld_optimise_options *options,
                          ld_error *error)
{
    *self = (candidates){.of = of,
                         .options = options,
                         .state = {.lock = -1},
                         .threads = options->threads > 1 ? options->threads : 1,
                         .counts = {.least = NAN, .stage = ""}};
    ld_status status = make_study(self, error);
    if (!status)
        status = make_workers(self, error);
    char *identity = status ? NULL : identity_of(of->model);
    if (!status && !identity)
        status = no_memory(error);
    const search_kind kind = {"optimise", of->keys, (int)optimise_numbers(of)};
    if (!status)
        status = search_state_open(&self->state, &kind, options->folder, identity, error);
    free(identity);
    return status;
}

void candidates_close(candidates *self)
{
    search_state_close(&self->state);
    for (int i = 0; self->worker && i < self->threads; i++)
        worker_free(&self->worker[i]);
    for (int i = 0; self->study.sampler && i <= self->of->keys; i++)
        sampler_free(&self->study.sampler[i]);
    free(self->worker);
    free(self->work);
    free(self->study.sampler);
    free(self->study.model);
    self->worker = NULL;
}
