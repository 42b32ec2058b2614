#include "studies/run/worker.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "flight/flight_alone.h"
#include "flight/flight_lanes.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "quantities/study_results.h"
#include "run/simulation_build.h"
#include "state/simulation.h"

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

static bool may_continue(void *self, double share)
{
    const permission *asked = self;
    (void)share;
    return asked->go_on(asked->argument);
}

static ld_status run_sample(study_worker *self, permission *asked, ld_error *error)
{
    ld_run_options options = {.self = asked, .progress = may_continue};
    ld_status status = simulation_renew(&self->simulation, self->sample->model, error);
    return status ? status : ld_simulation_run(self->simulation, &options, self->summary, error);
}

// Of what another point of the sweep may not have, such as a slot, or elsewhere, such as an adaptor
// or a measure by its name.
static double result_of(const quantity_walk *at, const ld_model *model,
                        const ld_rocket_summary *rocket)
{
    quantity_walk here = *at;
    quantity_each each = at->group->each;
    const quantity_things things = quantity_things_of(model);
    if (at->things->name[each])
        here.item =
            quantity_item_named(&things, each, quantity_name_of(at->things, each, at->item));
    return here.item < 0 || here.item >= things.count[each] ? NAN : quantity_value(&here, rocket);
}

// The numbers of the record: what was sampled and what came of it.
static void fill_values(study_worker *self)
{
    const ld_model *model = self->sample->model;
    const study_shape *shape = &self->record->shape;
    const double *drawn = self->sample->drawn;
    double *value = self->record->value;
    for (int k = 0; k < shape->of_sample; k++)
        *value++ = *drawn++;
    for (int i = 0; i < model_firing_count(model); i++) {
        *value++ = model_firing(model, i)->tube;
        for (int k = 0; k < shape->of_rocket; k++)
            *value++ = *drawn++;
        const ld_rocket_summary *rocket =
            i < self->summary->rocket_count ? &self->summary->rocket[i] : NULL;
        quantity_walk at = study_result_first(&self->study->things);
        for (; at.row; study_result_next(&at))
            *value++ = rocket ? result_of(&at, model, rocket) : NAN;
    }
}

static ld_status draw(study_worker *self, int64_t number, ld_error *error)
{
    const study_sampler *sampler = &self->study->sampler[study_point_of(self->study, number)];
    self->summary->rocket_count = 0;
    return sample_draw(self->sample, sampler, study_draw_of(self->study, number), error);
}

static void fill_record(study_worker *self, int64_t number, ld_status outcome,
                        const ld_error *error)
{
    study_record *record = self->record;
    record->number = number;
    record->outcome = outcome;
    record->shape = self->study->shape;
    record->shape.rockets = model_firing_count(self->sample->model);
    snprintf(record->reason, sizeof record->reason, "%s", outcome ? error->text : "");
    fill_values(self);
}

void worker_run(study_worker *self, int64_t number, bool (*go_on)(void *), void *argument)
{
    ld_error error = {0};
    ld_status outcome = draw(self, number, &error);
    if (!outcome)
        outcome = run_sample(self, &(permission){go_on, argument}, &error);
    fill_record(self, number, outcome, &error);
}

// ---- flights alone, side by side

typedef struct lane_worker {
    study_worker worker;
    int64_t number;
    ld_error error;
} lane_worker;

typedef struct lane_workers {
    const sample_source *source;
    permission asked;
    ld_run_options options;
    lane_worker lane[FLIGHT_MOST_LANES];
    bool waits; // the source did not know yet
} lane_workers;

static bool take_number(lane_workers *self, lane_worker *one)
{
    one->number = self->source->next(self->source->self);
    self->waits = one->number == SAMPLE_WAIT;
    return one->number > 0;
}

static void keep_outcome(lane_workers *self, lane_worker *one, ld_status outcome)
{
    fill_record(&one->worker, one->number, outcome, &one->error);
    self->source->keep(self->source->self, one->worker.record);
}

static bool next_flight(void *user, int lane, lane_flight *flight)
{
    lane_workers *self = user;
    lane_worker *one = &self->lane[lane];
    study_worker *worker = &one->worker;
    while (take_number(self, one)) {
        one->error = (ld_error){0};
        ld_status status = draw(worker, one->number, &one->error);
        if (!status)
            status = simulation_renew(&worker->simulation, worker->sample->model, &one->error);
        if (!status) {
            ld_summary *summary = worker->summary;
            flight_alone_prepare(worker->simulation, &self->options, &flight->job, flight->state,
                                 summary);
            flight->rocket = &summary->rocket[0];
            flight->summary = summary;
            flight->error = &one->error;
            return true;
        }
        keep_outcome(self, one, status);
    }
    return false;
}

static void flight_done(void *user, int lane, lane_flight *flight, ld_status status)
{
    lane_workers *self = user;
    (void)flight;
    keep_outcome(self, &self->lane[lane], status);
}

static ld_status fly_all(const sample_source *from, ld_error *error)
{
    int lanes = flight_lanes_here();
    lane_workers *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for flights side by side");
    const lane_source source = {next_flight, flight_done, self, NULL};
    self->source = from;
    self->asked = (permission){from->continues, from->self};
    self->options = (ld_run_options){.self = &self->asked, .progress = may_continue};
    ld_status status = LD_OK;
    for (int i = 0; i < lanes && !status; i++)
        status = worker_create(&self->lane[i].worker, from->study, error);
    while (!status) {
        status = flight_lanes_fly(lanes, &source, error);
        if (!self->waits)
            break;
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    for (int i = 0; i < lanes; i++)
        worker_free(&self->lane[i].worker);
    free(self);
    return status;
}

// ---- all

static ld_status run_one_by_one(const sample_source *from, ld_error *error)
{
    study_worker worker;
    ld_status status = worker_create(&worker, from->study, error);
    if (status)
        return status;
    for (int64_t number; (number = from->next(from->self)) != 0;) {
        if (number == SAMPLE_WAIT) {
            nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
            continue;
        }
        worker_run(&worker, number, from->continues, from->self);
        from->keep(from->self, worker.record);
    }
    worker_free(&worker);
    return LD_OK;
}

static bool has_launches(const ld_study *study)
{
    int i = 0;
    while (i < study->points && !model_has_launcher(study->sampler[i].nominal))
        i++;
    return i < study->points;
}

int worker_samples_at_once(const ld_study *study)
{
    return has_launches(study) ? 1 : FLIGHT_MOST_LANES;
}

void worker_run_all(const sample_source *from)
{
    ld_error error;
    bool flights = worker_samples_at_once(from->study) > 1;
    ld_status status = flights ? fly_all(from, &error) : run_one_by_one(from, &error);
    if (status)
        from->stop(from->self, status, &error);
}

static void *run_all(void *from)
{
    worker_run_all(from);
    return NULL;
}

int worker_start_thread(pthread_t *thread, void *(*work)(void *), void *data)
{
    enum { STACK = 8 << 20 }; // whatever the limit of this process, by which it would be chosen
    pthread_attr_t attributes;
    int problem = pthread_attr_init(&attributes);
    if (problem)
        return problem;
    problem = pthread_attr_setstacksize(&attributes, STACK);
    if (!problem)
        problem = pthread_create(thread, &attributes, work, data);
    pthread_attr_destroy(&attributes);
    return problem;
}

int worker_start(pthread_t *thread, const sample_source *from)
{
    return worker_start_thread(thread, run_all, (void *)from);
}

int worker_start_some(pthread_t *thread, int count, int of, const sample_source *from)
{
    ld_error error;
    int started = 0, problem = 0;
    while (!problem && started < count) {
        problem = worker_start(&thread[started], from);
        started += !problem;
    }
    if (problem) {
        ld_fail(&error, LD_ERR_MISSING, "cannot start thread %d of %d: %s",
                of - count + started + 1, of, strerror(problem));
        from->stop(from->self, LD_ERR_MISSING, &error);
    }
    return started;
}

void worker_run_side_by_side(const sample_source *from, int threads)
{
    ld_error error;
    int others = threads > 1 ? threads - 1 : 0, started = 0;
    pthread_t *thread = calloc((size_t)others + 1, sizeof *thread);
    if (thread)
        started = worker_start_some(thread, others, threads, from);
    else
        from->stop(from->self, ld_fail(&error, LD_ERR_MEMORY, "no memory for threads"), &error);
    worker_run_all(from);
    while (started > 0)
        pthread_join(thread[--started], NULL);
    free(thread);
}
