// A run that is stepped: what is asked of it and reported to it; launch.c takes its steps.
#include "run/run.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/cpu_time.h"
#include "flight/flight_alone.h"
#include "integration/saved_state.h"
#include "launch/launch.h"
#include "launch/launch_archive.h"
#include "launch/launch_base.h"
#include "launch/launch_drive.h"
#include "launch/launch_exit_error.h"
#include "launch/launch_flights.h"
#include "launch/launch_rows.h"
#include "launch/launch_run.h"
#include "launch/launch_summary.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "state/history.h"

static bool has_launch(const ld_run *run)
{
    return model_has_launcher(run->launch.model);
}

// A run whose rocket stands in its tube; NULL: no memory.
static ld_run *run_create(const ld_simulation *simulation, const ld_run_options *options,
                          bool outside)
{
    // the lanes of its state want their alignment
    ld_run *run = aligned_alloc(64, (sizeof *run + 63) / 64 * 64);
    if (!run)
        return NULL;
    memset(run, 0, sizeof *run);
    if (options)
        run->options = *options;
    run->outside = outside;
    run->launch.system = simulation;
    run->launch.model = simulation->model;
    run->summary.model = simulation->model;
    if (has_launch(run))
        run->status = launch_state_begin(&run->launch, simulation, &run->error);
    return run;
}

static void run_free(ld_run *run)
{
    propagator_free(run->propagator);
    exit_error_free(run->exit_error);
    launch_state_end(&run->launch);
    free(run);
}

// What ended the run, to the caller.
static ld_status copy_error(const ld_run *run, ld_error *error)
{
    if (run->status && error)
        *error = run->error;
    return run->status;
}

// ---- forward

// What a run is given beside its scenario; NULL: the scenario's.
typedef struct run_given {
    bool outside; // its steps are taken outside
    const launch_start *start;
    step_course *course;
} run_given;

static ld_status begin(const ld_simulation *simulation, const ld_run_options *options,
                       const run_given *given, ld_run **out, ld_error *error)
{
    double start = cpu_time_now();
    ld_run *run = *out = run_create(simulation, options, given->outside);
    if (!run)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a run");
    run->start = given->start;
    run->launch.course = given->course;
    if (!run->status)
        run->status =
            has_launch(run) ? launch_begin(run) : flight_alone_begin(simulation, &run->error);
    run->cpu += cpu_time_now() - start;
    return copy_error(run, error);
}

ld_status ld_run_begin(const ld_simulation *simulation, const ld_run_options *options, ld_run **out,
                       ld_error *error)
{
    assert(simulation && out);
    return begin(simulation, options, &(run_given){0}, out, error);
}

ld_status run_begin_exchange(const ld_simulation *simulation, const ld_run_options *options,
                             ld_run **out, ld_error *error)
{
    return begin(simulation, options, &(run_given){.outside = true}, out, error);
}

static ld_status advance(ld_run *run, double t, bool to_event, ld_error *error)
{
    if (run->status || !has_launch(run))
        return copy_error(run, error);
    if (!(t >= run->t) && !launch_is_finished(run))
        return ld_fail(error, LD_ERR_INPUT,
                       "the run is at t = %.9g s and cannot continue to t = %.9g s", run->t, t);
    double start = cpu_time_now();
    if (run->launch.launcher.base.kind->receive_frame) // what it receives comes then
        run->t_input = t;
    launch_advance(run, t, to_event);
    run->t_input = INFINITY;
    run->cpu += cpu_time_now() - start;
    return copy_error(run, error);
}

ld_status ld_run_advance(ld_run *run, double t, ld_error *error)
{
    ld_status status = advance(run, t, false, error);
    run->event_reported = run->event_count;
    return status;
}

ld_status ld_run_advance_to_event(ld_run *run, double t, ld_event *next, ld_error *error)
{
    ld_status status = advance(run, t, true, error);
    *next = (ld_event){.kind = LD_EVENT_NONE, .t = run->t};
    if (!status && run->event_reported < run->event_count && !run->ahead)
        *next = run->event[run->event_reported++];
    else if (!status && ld_run_is_finished(run))
        next->kind = LD_EVENT_END;
    return status;
}

double ld_run_time(const ld_run *run)
{
    return run->t;
}

bool ld_run_is_finished(const ld_run *run)
{
    return run->status || !has_launch(run) || launch_is_finished(run);
}

ld_status ld_run_set_base(ld_run *run, const ld_base_frame *base, ld_error *error)
{
    if (run->status)
        return copy_error(run, error);
    if (ld_run_is_finished(run))
        return ld_fail(error, LD_ERR_INPUT,
                       "the launch is over: the base's motion can no longer be set");
    double start = cpu_time_now();
    ld_status status = launch_drive_base(run, base, error);
    run->cpu += cpu_time_now() - start;
    return status ? status : copy_error(run, error);
}

// ---- what it reports

ld_status ld_run_row(ld_run *run, double *values, ld_error *error)
{
    if (run->status)
        return copy_error(run, error);
    if (!has_launch(run))
        return ld_fail(error, LD_ERR_INPUT, "a scenario of flight only cannot be stepped");
    history_row(&run->launch, run->t, run_present_state(run), run->energy_start, values);
    return LD_OK;
}

// Number of the columns where there is none of that name.
static int column_named(const ld_simulation *system, const char *name)
{
    int i = 0;
    while (i < system->columns.count && strcmp(system->columns.column[i].name, name) != 0)
        i++;
    return i;
}

ld_status ld_run_number(ld_run *run, const char *name, double *value, ld_error *error)
{
    const ld_simulation *system = run->launch.system;
    char now[LD_MAX_QUANTITY];
    int i = column_named(system, name);
    if (i == system->columns.count && ld_current_name(name, now, sizeof now))
        i = column_named(system, now);
    if (i == system->columns.count)
        return ld_fail(error, LD_ERR_INPUT, "there is no column \"%s\"", name);
    ld_status status = ld_run_row(run, run->row, error);
    *value = status ? NAN : run->row[i];
    return status;
}

ld_status ld_run_base_wrench(ld_run *run, ld_base_wrench *wrench, ld_error *error)
{
    if (run->status)
        return copy_error(run, error);
    if (!has_launch(run))
        return ld_fail(error, LD_ERR_INPUT, "a scenario of flight only has no base");
    return launch_wrench(run, run_present_state(run), wrench, error);
}

const ld_summary *ld_run_summary(const ld_run *run)
{
    return &run->summary;
}

// ---- what it receives

ld_status ld_run_ignite(ld_run *run, double t, ld_error *error)
{
    launch_state *launch = &run->launch;
    const ld_model *model = launch->model;
    if (run->status)
        return copy_error(run, error);
    if (!has_launch(run) || launch_is_ignited(launch) || run->t >= launch->t_ignition)
        return ld_fail(error, LD_ERR_INPUT, "no rocket waits for its ignition at t = %.9g s",
                       run->t);
    if (!(t >= run->t))
        return ld_fail(error, LD_ERR_INPUT,
                       "the run is at t = %.9g s: no rocket can be ignited at t = %.9g s", run->t,
                       t);
    bool last = launch->current + 1 == model_firing_count(model);
    if (!last && t >= model_firing(model, launch->current + 1)->at)
        return ld_fail(error, LD_ERR_INPUT,
                       "at t = %.9g s rocket %d cannot be ignited: the next rocket is fired", t,
                       launch->current + 1);
    // a step that is under way may continue beyond the ignition
    if (launch_find_rest(run))
        return copy_error(run, error);
    launch->t_ignition = run->summary.rocket[launch->current].t_ignition = t;
    if (last && model_run(model)->end == LD_END_TIME)
        run->t_end = t + model_run(model)->end_time;
    if (t == run->t)
        launch_ignite(run);
    return copy_error(run, error);
}

// ---- as bytes

static const saved_state saved_run = {0x6e7572206e796c6e, 5, "run"}; // "nlyn run"

ld_status ld_run_save(ld_run *run, void *bytes, size_t capacity, size_t *size, ld_error *error)
{
    *size = 0;
    if (run->status)
        return copy_error(run, error);
    if (!has_launch(run))
        return ld_fail(error, LD_ERR_INPUT, "a run of flight only cannot be saved");
    archive count = archive_save(NULL, 0), saved = archive_save(bytes, capacity);
    saved_state_head(&saved_run, run->launch.model, &count, 0);
    launch_archive(run, &count);
    saved_state_sum(&count);
    if (run->archived.status)
        return ld_fail(error, run->archived.status, "%s", run->archived.text);
    *size = count.at;
    if (capacity < *size)
        return ld_fail(error, LD_ERR_INPUT,
                       "the run's state requires %zu bytes, the buffer has %zu", *size, capacity);
    saved_state_head(&saved_run, run->launch.model, &saved, (int64_t)*size);
    launch_archive(run, &saved);
    saved_state_sum(&saved);
    return LD_OK;
}

static ld_status load(ld_run *run, const void *bytes, size_t size)
{
    if (!has_launch(run))
        return ld_fail(&run->error, LD_ERR_INPUT, "a run of flight only cannot be saved");
    ld_status status = saved_state_check(&saved_run, run->launch.model, bytes, size, &run->error);
    if (!status)
        status = propagator_create(&run->launch, run->outside, &run->propagator, &run->error);
    if (status)
        return status;
    archive loaded = archive_load(bytes, size);
    saved_state_head(&saved_run, run->launch.model, &loaded, (int64_t)size);
    launch_archive(run, &loaded);
    run->t_input = INFINITY;
    if (run->archived.status)
        return ld_fail(&run->error, run->archived.status, "%s", run->archived.text);
    if (loaded.failed || loaded.at + 8 != size)
        return ld_fail(&run->error, LD_ERR_INPUT, "the saved run is damaged");
    return launch_open_output(run);
}

// Loads into a run that has been created; NULL: there was no memory.
static ld_status load_into(ld_run *run, const void *bytes, size_t size, ld_run **out,
                           ld_error *error)
{
    *out = run;
    if (!run)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a run");
    if (!run->status)
        run->status = load(run, bytes, size);
    ld_status status = copy_error(run, error);
    if (status) {
        run_free(run);
        *out = NULL;
    }
    return status;
}

ld_status ld_run_load(const ld_simulation *simulation, const ld_run_options *options,
                      const void *bytes, size_t size, ld_run **out, ld_error *error)
{
    return load_into(run_create(simulation, options, false), bytes, size, out, error);
}

ld_status run_load_exchange(const ld_simulation *simulation, const void *bytes, size_t size,
                            ld_run **out, ld_error *error)
{
    return load_into(run_create(simulation, NULL, true), bytes, size, out, error);
}

// ---- the end

static ld_status end_early(ld_run *run)
{
    if (launch_find_rest(run))
        return run->status;
    launch_write_last_row(run);
    return ld_fail(&run->error, LD_ERR_INTERRUPTED, "ended at t = %.6g s", run->t);
}

ld_status ld_run_end(ld_run *run, ld_summary *summary, ld_error *error)
{
    if (!run)
        return LD_OK;
    double start = cpu_time_now();
    if (!has_launch(run) && summary) {
        run->status =
            flight_alone_run(run->launch.system, &run->options, &run->summary, &run->error);
    } else if (summary) {
        if (!run->status)
            run->status = launch_is_finished(run) ? launch_fly_all(run) : end_early(run);
        run->cpu += cpu_time_now() - start;
        launch_summarise(run);
    }
    if (summary)
        *summary = run->summary;
    ld_status status = copy_error(run, error);
    run_free(run);
    return status;
}

// Of a run that no one steps, reports or saves.
static ld_status begin_exit_error(ld_run *run)
{
    const launch_state *launch = &run->launch;
    if (!has_launch(run) || model_run(launch->model)->exit_error != LD_EXIT_ERROR_YES)
        return LD_OK;
    double start = cpu_time_now();
    ld_status status = exit_error_create(launch->system, &run->exit_error, &run->error);
    run->cpu += cpu_time_now() - start;
    return status;
}

static ld_status run_whole(const ld_simulation *simulation, const ld_run_options *options,
                           const run_given *given, ld_summary *summary, ld_error *error)
{
    ld_run *run;
    ld_status status = begin(simulation, options, given, &run, error);
    if (!run) {
        *summary = (ld_summary){0};
        return status;
    }
    if (!run->status && !given->start && !given->course)
        run->status = begin_exit_error(run);
    ld_run_advance(run, INFINITY, error);
    return ld_run_end(run, summary, error);
}

ld_status ld_simulation_run(const ld_simulation *simulation, const ld_run_options *options,
                            ld_summary *summary, ld_error *error)
{
    assert(simulation && summary);
    ld_error own;
    if (!error)
        error = &own;
    *error = (ld_error){0};
    return run_whole(simulation, options, &(run_given){0}, summary, error);
}

ld_status run_course(const ld_simulation *simulation, const ld_run_options *options,
                     step_course *course, ld_summary *summary, ld_error *error)
{
    ld_status status =
        run_whole(simulation, options, &(run_given){.course = course}, summary, error);
    if (!status && course->failed)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the steps of a run");
    return status;
}

ld_status run_from(const ld_simulation *simulation, const launch_start *start, ld_summary *summary,
                   ld_error *error)
{
    return run_whole(simulation, NULL, &(run_given){.start = start}, summary, error);
}
