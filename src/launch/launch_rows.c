// Rows of a launch to who listens, at the output steps and the key instants.
#include "launch/launch_rows.h"

#include "base/cpu_time.h"
#include "model/parts.h"
#include "state/geometry.h"
#include "state/history.h"

// From ignition on rows come at the tube's step; before it, and where a rocket has left and another
// is to follow, at that of the lead-in.
static double output_step(const ld_run *run, double t)
{
    const launch_state *self = &run->launch;
    bool between = !self->phase.rocket && self->current + 1 < model_firing_count(self->model);
    return t < self->t_ignition || between ? model_run(self->model)->output_step_lead_in
                                           : model_run(self->model)->output_step_tube;
}

ld_status launch_open_output(ld_run *run)
{
    const ld_sink *sink = run->options.sink;
    const ld_simulation *system = run->launch.system;
    if (!sink)
        return LD_OK;
    double before = cpu_time_now();
    ld_status status = simulation_geometry(system, sink, &run->error);
    if (!status)
        status = sink->begin(sink->self, system->columns.column, (size_t)system->columns.count,
                             &run->error);
    run->cpu_output += cpu_time_now() - before;
    return status;
}

ld_status launch_write_row(ld_run *run, double t, const double *y)
{
    const ld_sink *sink = run->options.sink;
    if (!sink || t == run->last_row)
        return LD_OK;
    run->last_row = t;
    double start = cpu_time_now();
    history_row(&run->launch, t, y, run->energy_start, run->row);
    ld_status status =
        sink->row(sink->self, run->row, (size_t)run->launch.system->columns.count, &run->error);
    run->cpu_output += cpu_time_now() - start;
    run->sink_failed = status != LD_OK;
    return status;
}

// Rows that fell into the last step.
ld_status launch_write_rows(ld_run *run)
{
    double now = propagator_time(run->propagator);
    while (run->next_output <= now) {
        double t = run->next_output;
        if (run->options.sink)
            propagator_interpolate(run->propagator, t, run->between);
        ld_status status = launch_write_row(run, t, run->between);
        if (status)
            return status;
        run->output_index++;
        run->next_output = run->output_from + (double)run->output_index * run->output_step;
    }
    return LD_OK;
}

void launch_restart_output(ld_run *run, double t)
{
    run->output_from = t;
    run->output_index = 1;
    run->output_step = output_step(run, t);
    run->next_output = t + run->output_step;
}

// A run that ends early has its last state as its last row.
void launch_write_last_row(ld_run *run)
{
    ld_error first = run->error;
    if (!run->sink_failed)
        launch_write_row(run, propagator_time(run->propagator), propagator_state(run->propagator));
    run->error = first;
}
