#include "flight/flight_alone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/cpu_time.h"
#include "flight/flight_history.h"
#include "model/blocks/flight.h"
#include "model/parts.h"
#include "quantities/summary_quantities.h"

typedef struct alone_run {
    const ld_simulation *self;
    const ld_sink *sink; // NULL: no rows requested
    double cpu_output;   // [s] spent on rows and their sink
} alone_run;

static ld_status write_row(void *user, const flight_phase *phase, double t, const double *state,
                           ld_error *error)
{
    alone_run *run = user;
    double row[FLIGHT_MAX_COLUMNS], start = cpu_time_now();
    flight_row(&run->self->flight, &run->self->columns, phase, t, state, row);
    ld_status status =
        run->sink->row(run->sink->self, row, (size_t)run->self->columns.count, error);
    run->cpu_output += cpu_time_now() - start;
    return status;
}

ld_status flight_alone_create(ld_simulation *self, ld_error *error)
{
    ld_status status = flight_renew(&self->flight, self->model, 0, error);
    return status ? status : flight_columns(&self->flight, &self->columns, error);
}

// The flight, and its start in `state`.
static free_flight flight_of(const ld_simulation *self, double state[FLIGHT_STATES])
{
    const ld_model *model = self->model;
    const ld_flight *start = model_flight(model);
    const ld_run_settings *run = model_run(model);
    double ignition = start->ignition;
    flight_phase phase = free_flight_phase(&self->flight, ignition, 0);
    flight_pose pose;
    flight_start(&self->flight, &phase, start, state);
    flight_leave(&self->flight, &phase, 0, state, &pose);
    return (free_flight){
        .system = &self->flight,
        .model = model,
        .measure = &self->measure,
        .t_ignition = ignition,
        .t_end = run->end == LD_END_TIME ? ignition + run->end_time : INFINITY,
        .launch_x = pose.r_O1.x,
        .launch_z = pose.r_O1.z,
        .container = v3_from(self->flight.rocket->line.container),
    };
}

void flight_alone_prepare(const ld_simulation *self, const ld_run_options *options,
                          free_flight *job, double *state, ld_summary *summary)
{
    *job = flight_of(self, state);
    job->options = options;
    summary->model = self->model;
    summary->rocket_count = 1;
    summary->note_count = 0;
    summary->statistics = (ld_statistics){0};
    rocket_clear(&summary->rocket[0], false);
    summary->rocket[0].t_ignition = job->t_ignition;
}

ld_status flight_alone_begin(const ld_simulation *self, ld_error *error)
{
    double state[FLIGHT_STATES];
    free_flight job = flight_of(self, state);
    job.t_end = job.t_start; // not a step
    ld_summary *summary = calloc(1, sizeof *summary);
    if (!summary)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a summary");
    ld_status status = free_flight_run(&job, state, &summary->rocket[0], summary, error);
    free(summary);
    return status;
}

static ld_status fly(alone_run *run, const ld_run_options *options, ld_summary *summary,
                     ld_error *error)
{
    const ld_simulation *self = run->self;
    double state[FLIGHT_STATES];
    free_flight job;
    flight_alone_prepare(self, options, &job, state, summary);
    job.row = run->sink ? write_row : NULL;
    job.self = run;
    double start = cpu_time_now();
    ld_status status = LD_OK;
    if (run->sink)
        status = run->sink->begin(run->sink->self, self->columns.column,
                                  (size_t)self->columns.count, error);
    run->cpu_output += cpu_time_now() - start;
    if (!status)
        status = free_flight_run(&job, state, &summary->rocket[0], summary, error);
    return status;
}

ld_status flight_alone_run(const ld_simulation *self, const ld_run_options *options,
                           ld_summary *summary, ld_error *error)
{
    alone_run run = {.self = self, .sink = options ? options->sink : NULL};
    double start = cpu_time_now();
    ld_status status = fly(&run, options, summary, error);
    summary->complete = status == LD_OK;
    if (status && !error->text[0])
        ld_fail(error, status, "the receiver of the rows stopped the run");
    if (status)
        memcpy(summary->stopped, error->text, sizeof summary->stopped);
    summary->statistics.cpu_seconds = cpu_time_now() - start - run.cpu_output;
    summary->statistics.cpu_seconds_setup = self->cpu_seconds_setup;
    return status;
}
