// A vehicle alone as an FMU's instance runs it.
#include <math.h>
#include <string.h>

#include "fmu/fmu_runner.h"
#include "run/vehicle_run.h"

static ld_base_wrench wrench_of(const double *inputs)
{
    ld_base_wrench wrench;
    memcpy(wrench.force, inputs, sizeof wrench.force);
    memcpy(wrench.moment, inputs + 3, sizeof wrench.moment);
    return wrench;
}

static ld_status set_inputs(void *run, const double *inputs, ld_error *error)
{
    const ld_base_wrench wrench = wrench_of(inputs);
    return ld_vehicle_run_set_wrench(run, &wrench, error);
}

// What is not given of the wrench at the start is that under which the vehicle rests.
static void *begin_under(ld_vehicle_run *run, double *inputs, ld_error *error)
{
    ld_base_wrench own;
    bool given = false;
    ld_status status = ld_vehicle_run_wrench(run, &own, error);
    for (int i = 0; i < FMU_WRENCH_NUMBERS; i++)
        if (isnan(inputs[i]))
            inputs[i] = i < 3 ? own.force[i] : own.moment[i - 3];
        else
            given = true;
    if (!status && given)
        status = set_inputs(run, inputs, error);
    if (!status)
        return run;
    ld_vehicle_run_end(run);
    return NULL;
}

static void *begin(const ld_simulation *simulation, double *inputs, ld_error *error)
{
    ld_vehicle_run *run;
    return ld_vehicle_run_begin(simulation, &run, error) ? NULL : begin_under(run, inputs, error);
}

static void end(void *run)
{
    ld_vehicle_run_end(run);
}

static double time_of(const void *run)
{
    return ld_vehicle_run_time(run);
}

static bool is_finished(const void *run)
{
    (void)run;
    return false;
}

static ld_status get_outputs(void *run, double *numbers, ld_error *error)
{
    ld_base_frame frame;
    ld_status status = ld_vehicle_run_frame(run, &frame, error);
    if (status)
        return status;
    memcpy(numbers, frame.position, sizeof frame.position);
    memcpy(numbers + 3, frame.quaternion, sizeof frame.quaternion);
    memcpy(numbers + 7, frame.velocity, sizeof frame.velocity);
    memcpy(numbers + 10, frame.rate, sizeof frame.rate);
    return LD_OK;
}

static ld_status get_row(void *run, double *values, ld_error *error)
{
    return ld_vehicle_run_row(run, values, error);
}

static ld_status advance(void *run, double t, ld_error *error)
{
    return ld_vehicle_run_advance(run, t, error);
}

// Nothing happens to it that an importer wants to hear of.
static ld_status advance_to_event(void *run, double t, bool *found, ld_error *error)
{
    *found = false;
    return advance(run, t, error);
}

static ld_status save(void *run, void *bytes, size_t capacity, size_t *size, ld_error *error)
{
    return ld_vehicle_run_save(run, bytes, capacity, size, error);
}

static void *load(const ld_simulation *simulation, const void *bytes, size_t size, ld_error *error)
{
    ld_vehicle_run *run;
    ld_vehicle_run_load(simulation, bytes, size, &run, error);
    return run;
}

// ---- model exchange

static void *begin_exchange(const ld_simulation *simulation, double *inputs, ld_error *error)
{
    ld_vehicle_run *run;
    return vehicle_exchange_begin(simulation, &run, error) ? NULL : begin_under(run, inputs, error);
}

static void *load_exchange(const ld_simulation *simulation, const void *bytes, size_t size,
                           ld_error *error)
{
    ld_vehicle_run *run;
    vehicle_exchange_load(simulation, bytes, size, &run, error);
    return run;
}

static int count_states(const void *run)
{
    return vehicle_exchange_states(run);
}

static int count_indicators(const void *run)
{
    return vehicle_exchange_indicators(run);
}

static exchange_quantity name_state(const void *run, int i)
{
    return vehicle_exchange_state(run, i);
}

static exchange_quantity name_indicator(const void *run, int i)
{
    (void)run;
    return exchange_wheel(i);
}

static void find_nominals(const void *run, double *nominal)
{
    vehicle_exchange_nominals(run, nominal);
}

static ld_status set_state(void *run, double t, const double *x, const double *inputs,
                           ld_error *error)
{
    const ld_base_wrench wrench = wrench_of(inputs);
    return vehicle_exchange_place(run, t, x, &wrench, error);
}

static void get_state(void *run, double *x)
{
    vehicle_exchange_get(run, x);
}

static ld_status find_rates(void *run, double *rate, ld_error *error)
{
    return vehicle_exchange_rates(run, rate, error);
}

static ld_status find_values(void *run, double *indicator, ld_error *error)
{
    return vehicle_exchange_values(run, indicator, error);
}

static double next_instant(const void *run)
{
    return vehicle_exchange_next(run);
}

static ld_status accept_step(void *run, bool *happens, ld_error *error)
{
    return vehicle_exchange_accept(run, happens, error);
}

static ld_status pass_events(void *run, bool *happened, ld_error *error)
{
    return vehicle_exchange_pass_events(run, happened, error);
}

static const fmu_exchanging exchanging = {
    .begin = begin_exchange,
    .load = load_exchange,
    .states = count_states,
    .indicators = count_indicators,
    .state = name_state,
    .indicator = name_indicator,
    .nominals = find_nominals,
    .set_state = set_state,
    .get_state = get_state,
    .rates = find_rates,
    .values = find_values,
    .next = next_instant,
    .accept = accept_step,
    .pass_events = pass_events,
};

const fmu_runner fmu_vehicle = {
    .input_count = FMU_WRENCH_NUMBERS,
    .output_count = FMU_FRAME_NUMBERS,
    .columns = ld_vehicle_run_columns,
    .begin = begin,
    .end = end,
    .time = time_of,
    .is_finished = is_finished,
    .set_inputs = set_inputs,
    .get_outputs = get_outputs,
    .get_row = get_row,
    .advance = advance,
    .advance_to_event = advance_to_event,
    .save = save,
    .load = load,
    .exchanging = &exchanging,
};
