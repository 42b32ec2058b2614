#include "launch/launch_drive.h"

#include <string.h>

#include "launch/launch.h"
#include "launch/launch_base.h"
#include "launch/launch_events.h"
#include "launch/launch_measures.h"
#include "launch/launch_rows.h"
#include "launch/launch_summary.h"

// What the base received before at the present counts no more.
static void restart_driven(ld_run *run, const base_frame *now, double *state)
{
    const base_system *base = &run->launch.launcher.base;
    size_t size = (size_t)base->state_count * sizeof *state;
    if (run->reported_at == run->t)
        memcpy(state, run->before_driven, size);
    else
        memcpy(run->before_driven, state, size);
    run->reported_at = run->t;
    base->kind->receive_frame(base, run->t, false, now, state);
}

ld_status launch_drive_base(ld_run *run, const ld_base_frame *given, ld_error *error)
{
    const launcher_system *launcher = &run->launch.launcher;
    double y[LD_MAX_STATES];
    base_frame now;
    ld_status status = launch_base_listens(&launcher->base, error);
    if (!status)
        status = launch_read_frame(given, &now, error);
    if (status || launch_find_rest(run))
        return status;
    memcpy(y, propagator_state(run->propagator), (size_t)launcher->state_count * sizeof *y);
    restart_driven(run, &now, y + launcher->base_at);
    memset(run->launch.phase.pushing, 0, sizeof run->launch.phase.pushing); // the tube is elsewhere
    launch_release_at_once(run, run->t, y);
    launch_measure_instant(run, run->t, y);
    run->status = propagator_start(run->propagator, run->t, y, false, &run->error);
    return LD_OK;
}

ld_status launch_ignite(ld_run *run)
{
    double t = propagator_time(run->propagator);
    const double *y = propagator_state(run->propagator);
    launch_record_ignition(run, t, y);
    run->status = launch_write_row(run, t, y);
    launch_pass_stop(run, t);
    launch_restart_output(run, t);
    launch_release_at_once(run, t, y);
    launch_measure_instant(run, t, y);
    if (!run->status)
        run->status = propagator_start(run->propagator, t, y, false, &run->error);
    return run->status;
}
