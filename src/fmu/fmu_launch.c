// A launch as an FMU's instance runs it.
#include <math.h>
#include <string.h>

#include "fmu/fmu_runner.h"
#include "launch/launch_exchange.h"
#include "run/run.h"

typedef ld_status beginning(const ld_simulation *simulation, const ld_run_options *options,
                            ld_run **run, ld_error *error);

static void *begin_run(beginning *how, const ld_simulation *simulation, const ld_base_frame *base,
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

static void *begin(const ld_simulation *simulation, double *inputs, ld_error *error)
{
    (void)inputs;
    return begin_run(ld_run_begin, simulation, NULL, error);
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

static ld_status get_outputs(void *run, double *numbers, ld_error *error)
{
    ld_base_wrench wrench;
    ld_status status = ld_run_base_wrench(run, &wrench, error);
    memcpy(numbers, wrench.force, sizeof wrench.force);
    memcpy(numbers + 3, wrench.moment, sizeof wrench.moment);
    return status;
}

static ld_status get_row(void *run, double *values, ld_error *error)
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
static bool is_reported(const ld_event *event)
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
    while (!status && event.kind != LD_EVENT_NONE && !is_reported(&event));
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
    .output_count = FMU_WRENCH_NUMBERS, .columns = ld_simulation_columns, .end = end,              \
    .time = time_of, .is_finished = is_finished, .ignite = ignite, .get_outputs = get_outputs,     \
    .get_row = get_row, .summary = summary, .advance = advance,                                    \
    .advance_to_event = advance_to_event, .save = save, .load = load

static void *begin_exchange(const ld_simulation *simulation, double *inputs, ld_error *error)
{
    (void)inputs;
    return begin_run(run_begin_exchange, simulation, NULL, error);
}

static void *load_exchange(const ld_simulation *simulation, const void *bytes, size_t size,
                           ld_error *error)
{
    ld_run *run;
    run_load_exchange(simulation, bytes, size, &run, error);
    return run;
}

static ld_status set_state(void *run, double t, const double *x, const double *inputs,
                           ld_error *error)
{
    (void)inputs;
    return launch_exchange_place(run, t, x, NULL, error);
}

// ---- model exchange

static int count_states(const void *run)
{
    return launch_exchange_states(run);
}

static int count_indicators(const void *run)
{
    return launch_exchange_indicators(run);
}

static exchange_quantity name_state(const void *run, int i)
{
    return launch_exchange_state(run, i);
}

static exchange_quantity name_indicator(const void *run, int i)
{
    return launch_exchange_indicator(run, i);
}

static void find_nominals(const void *run, double *nominal)
{
    launch_exchange_nominals(run, nominal);
}

static void get_state(void *run, double *x)
{
    launch_exchange_get(run, x);
}

static ld_status find_rates(void *run, double *rate, ld_error *error)
{
    return launch_exchange_rates(run, rate, error);
}

static ld_status find_values(void *run, double *indicator, ld_error *error)
{
    return launch_exchange_values(run, indicator, error);
}

static double next_instant(const void *run)
{
    return launch_exchange_next(run);
}

static ld_status accept_step(void *run, bool *happens, ld_error *error)
{
    return launch_exchange_accept(run, happens, error);
}

static ld_status pass_events(void *run, bool *happened, ld_error *error)
{
    return launch_exchange_pass_events(run, happened, error);
}

#define EXCHANGING                                                                                 \
    .check = launch_exchange_check, .load = load_exchange, .states = count_states,                 \
    .indicators = count_indicators, .state = name_state, .indicator = name_indicator,              \
    .nominals = find_nominals, .get_state = get_state, .rates = find_rates, .values = find_values, \
    .next = next_instant, .accept = accept_step, .pass_events = pass_events

static const fmu_exchanging exchanging = {EXCHANGING, .begin = begin_exchange,
                                          .set_state = set_state};
const fmu_runner fmu_launch = {ANY_BASE, .begin = begin, .exchanging = &exchanging};

// ---- on an externally driven base ----

// The frame that is reported, its quaternion made of length 1.
static ld_base_frame frame_of(const double *inputs)
{
    ld_base_frame base;
    double length = 0;
    memcpy(base.position, inputs, sizeof base.position);
    memcpy(base.quaternion, inputs + 3, sizeof base.quaternion);
    memcpy(base.velocity, inputs + 7, sizeof base.velocity);
    memcpy(base.rate, inputs + 10, sizeof base.rate);
    for (int i = 0; i < 4; i++)
        length += base.quaternion[i] * base.quaternion[i];
    for (int i = 0; i < 4 && length != 1; i++)
        base.quaternion[i] /= sqrt(length);
    return base;
}

static void *begin_external(const ld_simulation *simulation, double *inputs, ld_error *error)
{
    const ld_base_frame base = frame_of(inputs);
    return begin_run(ld_run_begin, simulation, &base, error);
}

static ld_status set_inputs(void *run, const double *inputs, ld_error *error)
{
    const ld_base_frame base = frame_of(inputs);
    return ld_run_set_base(run, &base, error);
}

static void *begin_exchange_external(const ld_simulation *simulation, double *inputs,
                                     ld_error *error)
{
    const ld_base_frame base = frame_of(inputs);
    return begin_run(run_begin_exchange, simulation, &base, error);
}

static ld_status place_external(void *run, double t, const double *x, const double *inputs,
                                ld_error *error)
{
    const ld_base_frame base = frame_of(inputs);
    return launch_exchange_place(run, t, x, &base, error);
}

static const fmu_exchanging exchanging_external = {EXCHANGING, .begin = begin_exchange_external,
                                                   .set_state = place_external};
const fmu_runner fmu_launch_external = {ANY_BASE,
                                        .input_count = FMU_FRAME_NUMBERS,
                                        .follows = true,
                                        .begin = begin_external,
                                        .set_inputs = set_inputs,
                                        .exchanging = &exchanging_external};
