#include "studies/worker.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "simulation/simulation.h"
#include "simulation/study_results.h"

ld_status worker_create(study_worker *self, const ld_study *study, ld_error *error)
{
    *self = (study_worker){.study = study,
                           .sample = sample_create(&study->sampler[0]),
                           .summary = calloc(1, sizeof *self->summary),
                           .record = calloc(1, record_size(&study->shape))};
    if (self->sample && self->summary && self->record)
        return LD_OK;
    worker_free(self);
    return ld_fail(error, LD_ERR_MEMORY, "no memory for a sample");
}

void worker_free(study_worker *self)
{
    ld_simulation_free(self->simulation);
    sample_free(self->sample);
    free(self->summary);
    free(self->record);
    *self = (study_worker){0};
}

typedef struct permission {
    bool (*go_on)(void *);
    void *argument;
} permission;

static bool may_go_on(void *self, double share)
{
    const permission *asked = self;
    (void)share;
    return asked->go_on(asked->argument);
}

static ld_status run_sample(study_worker *self, permission *asked, ld_error *error)
{
    ld_run_options options = {.self = asked, .progress = may_go_on};
    ld_status status = simulation_renew(&self->simulation, &self->sample->model, error);
    return status ? status : ld_simulation_run(self->simulation, &options, self->summary, error);
}

// Of an adaptor or a measure by its name, which another point of the sweep may have elsewhere or
// not at all.
static double result_of(const quantity_walk *at, const ld_model *model,
                        const ld_rocket_summary *rocket)
{
    quantity_walk here = *at;
    quantity_each each = at->group->each;
    if (at->things->name[each]) {
        const char *name = quantity_name_of(at->things, each, at->item);
        const quantity_things things = quantity_things_of(model);
        here.item = quantity_item_named(&things, each, name);
    }
    return here.item < 0 ? NAN : quantity_value(&here, rocket);
}

// The numbers of the record: what was drawn and what came of it.
static void fill_values(study_worker *self)
{
    const ld_model *model = &self->sample->model;
    const study_shape *shape = &self->record->shape;
    const double *drawn = self->sample->drawn;
    double *value = self->record->value;
    for (int k = 0; k < shape->of_sample; k++)
        *value++ = *drawn++;
    for (int i = 0; i < model->firing_count; i++) {
        *value++ = model->firing[i].tube;
        for (int k = 0; k < shape->of_rocket; k++)
            *value++ = *drawn++;
        const ld_rocket_summary *rocket =
            i < self->summary->rocket_count ? &self->summary->rocket[i] : NULL;
        quantity_walk at = study_result_first(&self->study->things);
        for (; at.row; study_result_next(&at))
            *value++ = rocket ? result_of(&at, model, rocket) : NAN;
    }
}

void worker_run(study_worker *self, int64_t number, bool (*go_on)(void *), void *argument)
{
    const study_sampler *sampler = &self->study->sampler[study_point_of(self->study, number)];
    ld_error error = {0};
    self->summary->rocket_count = 0;
    ld_status outcome =
        sample_draw(self->sample, sampler, study_draw_of(self->study, number), &error);
    if (!outcome)
        outcome = run_sample(self, &(permission){go_on, argument}, &error);
    study_record *record = self->record;
    record->number = number;
    record->outcome = outcome;
    record->shape = self->study->shape;
    record->shape.rockets = self->sample->model.firing_count;
    snprintf(record->reason, sizeof record->reason, "%s", outcome ? error.text : "");
    fill_values(self);
}

void worker_run_all(study_ledger *ledger)
{
    study_worker worker;
    ld_error error;
    ld_status status = worker_create(&worker, ledger->study, &error);
    if (status) {
        ledger_stop(ledger, status, &error);
        return;
    }
    for (int64_t number; (number = ledger_next(ledger)) != 0;) {
        if (number == LEDGER_WAIT) {
            nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
            continue;
        }
        worker_run(&worker, number, ledger_goes_on, ledger);
        ledger_keep(ledger, worker.record);
    }
    worker_free(&worker);
}

static void *run_all(void *ledger)
{
    worker_run_all(ledger);
    return NULL;
}

int worker_start(pthread_t *thread, study_ledger *ledger)
{
    enum { STACK = 8 << 20 }; // whatever the limit of this process, by which it would be chosen
    pthread_attr_t attributes;
    int problem = pthread_attr_init(&attributes);
    if (problem)
        return problem;
    problem = pthread_attr_setstacksize(&attributes, STACK);
    if (!problem)
        problem = pthread_create(thread, &attributes, run_all, ledger);
    pthread_attr_destroy(&attributes);
    return problem;
}

void worker_run_side_by_side(study_ledger *ledger, int threads)
{
    ld_error error;
    int others = threads > 1 ? threads - 1 : 0, started = 0, problem = 0;
    pthread_t *thread = calloc((size_t)others + 1, sizeof *thread);
    if (!thread)
        problem = ENOMEM;
    while (!problem && started < others) {
        problem = worker_start(&thread[started], ledger);
        started += !problem;
    }
    if (problem) {
        ld_fail(&error, LD_ERR_MISSING, "cannot start thread %d of %d: %s", started + 2, threads,
                strerror(problem));
        ledger_stop(ledger, LD_ERR_MISSING, &error);
    }
    worker_run_all(ledger);
    while (started > 0)
        pthread_join(thread[--started], NULL);
    free(thread);
}
