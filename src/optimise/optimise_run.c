#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "optimise/candidates.h"
#include "results/folder.h"

// ---- the search

static void find_start(const ld_optimisation *self, int start, double *x)
{
    for (int i = 0; i < self->keys; i++) {
        const optimise_key *key = &self->key[i];
        x[i] = start == 0 ? optimise_key_place(key, field_get(self->model, &key->place))
                          : random_uniform((uint64_t)self->as->seed, random_stream(key->place.path),
                                           (uint64_t)start, 0, 0);
        x[i] = x[i] < 0 ? 0 : x[i] > 1 ? 1 : x[i]; // rounded
    }
}

static int limit_count(const ld_optimisation *self)
{
    int count = 0;
    for (int i = 1; i < self->aims; i++)
        count += (self->aim[i].as->at_most == self->aim[i].as->at_most) +
                 (self->aim[i].as->at_least == self->aim[i].as->at_least);
    return count;
}

static ld_status search_from(ld_optimisation *self, candidates *all, int start, ld_error *error)
{
    const optimum_problem problem = {.keys = self->keys,
                                     .limits = limit_count(self),
                                     .method = self->as->method,
                                     .evaluations = self->as->evaluations,
                                     .precision = self->as->precision,
                                     .seed = (uint64_t)self->as->seed + (uint64_t)start,
                                     .self = all,
                                     .evaluate = candidates_evaluate,
                                     .is_enough =
                                         optimise_is_noisy(self) ? candidates_are_enough : NULL};
    double x[LD_MAX_BOUNDS];
    char text[48];
    find_start(self, start, x);
    snprintf(text, sizeof text, "start %d of %d", start + 1, self->as->starts);
    candidates_stage(all, text);
    all->start = start;
    return optimum_search(&problem, x, self->candidates, &self->start[start], error);
}

static ld_status search(ld_optimisation *self, candidates *all, ld_error *error)
{
    ld_status status = LD_OK;
    const optimum_found *best = NULL;
    for (int start = 0; start < self->as->starts && !status; start++) {
        status = search_from(self, all, start, error);
        if (status)
            break;
        self->starts++;
        const optimum_found *end = &self->start[start].best;
        if (end->number >= 0 && (!best || optimum_is_better(end, best)))
            best = end;
    }
    if (status)
        return status;
    if (!best)
        return ld_fail(error, LD_ERR_LAUNCH, "no launch at any start; first: %.900s", self->reason);
    self->best = best->number;
    return LD_OK;
}

// The samples behind those of the search, which the best candidate was not chosen by.
static ld_status try_others(ld_optimisation *self, candidates *all, ld_error *error)
{
    double x[LD_MAX_BOUNDS];
    find_start(self, 0, x);
    candidates_stage(all, "other samples");
    ld_status status = candidates_try_others(all, x, &self->others[0], error);
    return status
               ? status
               : candidates_try_others(all, self->candidate[self->best].x, &self->others[1], error);
}

// ---- from begin to end

// Forgets what an earlier run has found.
static void clear(ld_optimisation *self)
{
    for (int i = 0; i < self->candidates; i++)
        free(self->candidate[i].number);
    for (int i = 0; i < 2; i++) {
        free(self->others[i]);
        self->others[i] = NULL;
    }
    self->candidates = self->failed = self->starts = 0;
    self->reason[0] = '\0';
    self->done = false;
}

static ld_status search_and_check(ld_optimisation *self, candidates *all, ld_error *error)
{
    ld_status status = search(self, all, error);
    if (!status && optimise_is_noisy(self))
        status = try_others(self, all, error);
    if (status == LD_ERR_INTERRUPTED)
        return ld_fail(error, status, "interrupted after %d candidate%s, %lld launches%s",
                       self->candidates, self->candidates == 1 ? "" : "s",
                       (long long)all->counts.launches,
                       all->options->folder ? "; the same command continues" : "");
    return status;
}

ld_status ld_optimise_run(ld_optimisation *self, const ld_optimise_options *given, ld_error *error)
{
    assert(self);
    ld_error own;
    candidates all;
    const ld_optimise_options options = given ? *given : (ld_optimise_options){0};
    error = error ? error : &own;
    ld_status status = options.folder ? folder_ensure(options.folder, error) : LD_OK;
    if (status)
        return status;
    clear(self);
    status = candidates_open(&all, self, &options, error);
    if (!status)
        status = search_and_check(self, &all, error);
    self->simulated = all.counts.launches;
    self->done = !status;
    if (!status && options.folder)
        status = optimise_write(self, options.folder, error);
    candidates_close(&all);
    return status;
}
