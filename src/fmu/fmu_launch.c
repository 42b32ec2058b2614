// A launch as an FMU's instance runs it.
#include <math.h>
#include <string.h>

#include "fmu/fmu_runner.h"
#include "launch/launch_outside.h"
#include "run/run.h"

typedef ld_status beginning(const ld_simulation *simulation, const ld_run_options *options,
                            ld_run **run, ld_error *error);

static void *begun(beginning *how, const ld_simulation *simulation, const ld_base_frame *base,
                   ld_error *error)
{
    ld_run *run;
    ld_run_options options = {.base = base};
    if (!how(simulation, &options, &run, error))
        return run;
    if (run)
        ld_run_end(run, NULL, NULL);
    return NULL;
}

static void *begin(const ld_simulation *simulation, double *told, ld_error *error)
{
    (void)told;
    return begun(ld_run_begin, simulation, NULL, error);
}

static void end(void *run)
{
    ld_run_end(run, NULL, NULL);
}

static double time_of(const void *run)
{
    return ld_run_time(run);
}

static bool is_finished(const void *run)
{
    return ld_run_is_finished(run);
}

static ld_status ignite(void *run, double t, ld_error *error)
{
    return ld_run_ignite(run, t, error);
}

static ld_status tells(void *run, double *numbers, ld_error *error)
{
    ld_base_wrench wrench;
    ld_status status = ld_run_base_wrench(run, &wrench, error);
    memcpy(numbers, wrench.force, sizeof wrench.force);
    memcpy(numbers + 3, wrench.moment, sizeof wrench.moment);
    return status;
}

static ld_status row(void *run, double *values, ld_error *error)
{
    return ld_run_row(run, values, error);
}

static const ld_summary *summary(const void *run)
{
    return ld_run_summary(run);
}

static ld_status advance(void *run, double t, ld_error *error)
{
    return ld_run_advance(run, t, error);
}

// Whether an importer wants to hear of it: not what happens to wheels and walls many times.
static bool is_told(const ld_event *event)
{
    return event->kind == LD_EVENT_IGNITION || event->kind == LD_EVENT_RELEASE ||
           event->kind == LD_EVENT_EXIT || event->kind == LD_EVENT_TUBE ||
           event->kind == LD_EVENT_END;
}

static ld_status advance_to_event(void *run, double t, bool *found, ld_error *error)
{
    ld_event event;
    ld_status status;
    do
        status = ld_run_advance_to_event(run, t, &event, error);
    while (!status && event.kind != LD_EVENT_NONE && !is_told(&event));
    *found = !status && event.kind != LD_EVENT_NONE;
    return status;
}

static ld_status save(void *run, void *bytes, size_t capacity, size_t *size, ld_error *error)
{
    return ld_run_save(run, bytes, capacity, size, error);
}

static void *load(const ld_simulation *simulation, const void *bytes, size_t size, ld_error *error)
{
    ld_run *run;
    ld_run_load(simulation, NULL, bytes, size, &run, error);
    return run;
}

#define ANY_BASE                                                                                   \
    .tells_count = FMU_WRENCH_NUMBERS, .columns = ld_simulation_columns, .end = end,               \
    .time = time_of, .is_finished = is_finished, .ignite = ignite, .tells = tells, .row = row,     \
    .summary = summary, .advance = advance, .advance_to_event = advance_to_event, .save = save,    \
    .load = load

static void *begin_exchange(const ld_simulation *simulation, double *told, ld_error *error)
{
    (void)told;
    return begun(run_begin_outside, simulation, NULL, error);
}

static void *load_exchange(const ld_simulation *simulation, const void *bytes, size_t size,
                           ld_error *error)
{
    ld_run *run;
    run_load_outside(simulation, bytes, size, &run, error);
    return run;
}

static ld_status place(void *run, double t, const double *x, const double *told, ld_error *error)
{
    (void)told;
    return launch_outside_place(run, t, x, NULL, error);
}

static const fmu_exchanging exchanging = {begin_exchange, load_exchange, place};
const fmu_runner fmu_launch = {ANY_BASE, .begin = begin, .exchanging = &exchanging};

// ---- on a base that is told where it is ----

// The frame that is told, its quaternion made of length 1.
static ld_base_frame frame_of(const double *told)
{
    ld_base_frame base;
    double length = 0;
    memcpy(base.position, told, sizeof base.position);
    memcpy(base.quaternion, told + 3, sizeof base.quaternion);
    memcpy(base.velocity, told + 7, sizeof base.velocity);
    memcpy(base.rate, told + 10, sizeof base.rate);
    for (int i = 0; i < 4; i++)
        length += base.quaternion[i] * base.quaternion[i];
    for (int i = 0; i < 4 && length != 1; i++)
        base.quaternion[i] /= sqrt(length);
    return base;
}

static void *begin_outside(const ld_simulation *simulation, double *told, ld_error *error)
{
    const ld_base_frame base = frame_of(told);
    return begun(ld_run_begin, simulation, &base, error);
}

static ld_status tell(void *run, const double *told, ld_error *error)
{
    const ld_base_frame base = frame_of(told);
    return ld_run_tell_base(run, &base, error);
}

static void *begin_exchange_outside(const ld_simulation *simulation, double *told, ld_error *error)
{
    const ld_base_frame base = frame_of(told);
    return begun(run_begin_outside, simulation, &base, error);
}

static ld_status place_outside(void *run, double t, const double *x, const double *told,
                               ld_error *error)
{
    const ld_base_frame base = frame_of(told);
    return launch_outside_place(run, t, x, &base, error);
}

static const fmu_exchanging exchanging_outside = {begin_exchange_outside, load_exchange,
                                                  place_outside};
const fmu_runner fmu_launch_outside = {ANY_BASE,        .told_count = FMU_FRAME_NUMBERS,
                                       .follows = true, .begin = begin_outside,
                                       .tell = tell,    .exchanging = &exchanging_outside};
