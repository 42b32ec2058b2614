// A vehicle alone as an FMU's instance runs it.
#include <math.h>
#include <string.h>

#include "fmu/fmu_runner.h"
#include "launchdyn/vehicle_run.h"

static ld_status set_inputs(void *run, const double *inputs, ld_error *error)
{
    ld_base_wrench wrench;
    memcpy(wrench.force, inputs, sizeof wrench.force);
    memcpy(wrench.moment, inputs + 3, sizeof wrench.moment);
    return ld_vehicle_run_set_wrench(run, &wrench, error);
}

// What is not given of the wrench at the start is that under which the vehicle rests.
static void *begin(const ld_simulation *simulation, double *inputs, ld_error *error)
{
    ld_vehicle_run *run;
    ld_base_wrench own;
    bool given = false;
    if (ld_vehicle_run_begin(simulation, &run, error))
        return NULL;
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
};
