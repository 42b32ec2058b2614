// An externally driven base, one that acts on its own at instants, and the wrench on any base.
#include "launch/launch_base.h"

#include <math.h>
#include <string.h>

#include "launch/launch_run.h"
#include "state/evaluation.h"

static bool are_finite(const double *values, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += 0 * values[i];
    return sum == 0;
}

// A quaternion's last digits are put right.
ld_status launch_read_frame(const ld_base_frame *given, base_frame *frame, ld_error *error)
{
    if (!are_finite(given->position, 3) || !are_finite(given->quaternion, 4) ||
        !are_finite(given->velocity, 3) || !are_finite(given->rate, 3))
        return ld_fail(error, LD_ERR_INPUT,
                       "the base received a position or a motion that is not finite");
    quat q = q_from(given->quaternion);
    double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(fabs(length - 1) <= 1e-6))
        return ld_fail(error, LD_ERR_INPUT,
                       "the base received a quaternion of length %.9g, expected 1", length);
    *frame = (base_frame){
        .r = v3_from(given->position),
        .v = v3_from(given->velocity),
        .A = q_matrix(q),
        .q = {q.w / length, q.x / length, q.y / length, q.z / length},
        .w = v3_from(given->rate),
    };
    return LD_OK;
}

ld_status launch_base_listens(const base_system *base, ld_error *error)
{
    if (base->kind->receive_frame)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "the base's motion can be set with base.kind: external only");
}

ld_status launch_begin_base(ld_run *run)
{
    if (!run->options.base)
        return LD_OK;
    run->launch.reported = &run->reported;
    ld_status status = launch_base_listens(&run->launch.launcher.base, &run->error);
    return status ? status : launch_read_frame(run->options.base, &run->reported, &run->error);
}

double launch_next_sample(const ld_run *run, double t)
{
    const base_system *base = &run->launch.launcher.base;
    return base->kind->next_sample ? base->kind->next_sample(base, t) : INFINITY;
}

static ld_status wrench_at(ld_run *run, double t, const double *y, base_wrench *wrench,
                           ld_error *error)
{
    launcher_input input;
    const launcher_output *out = simulation_output(&run->launch, t, y);
    if (!out)
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the equations of motion gave no finite result at t = %.9g s", t);
    launcher_place(&run->launch.launcher, t, y, &input);
    const m3 *A = &input.launching.base.A;
    wrench->force = m3_apply(*A, out->launching.base_force);
    wrench->moment = m3_apply(*A, out->launching.base_moment);
    return LD_OK;
}

ld_status launch_step_base(ld_run *run, double t, double *y)
{
    const launcher_system *launcher = &run->launch.launcher;
    const base_system *base = &launcher->base;
    base_wrench on;
    if (!base->kind->stepping)
        return LD_OK;
    ld_status status = wrench_at(run, t, y, &on, &run->error);
    return status ? status
                  : base->kind->stepping->step_on(base, t, &on, y + launcher->base_at, &run->error);
}

ld_status launch_sample_base(ld_run *run)
{
    const launcher_system *launcher = &run->launch.launcher;
    double t = propagator_time(run->propagator), y[LD_MAX_STATES];
    bool stepped = launcher->base.kind->stepping != NULL;
    if (launch_next_sample(run, nextafter(t, -INFINITY)) != t ||
        (stepped && launch_is_finished(run)))
        return LD_OK;
    memcpy(y, propagator_state(run->propagator), (size_t)launcher->state_count * sizeof *y);
    ld_status status = launch_step_base(run, t, y);
    if (!stepped)
        launcher->base.kind->sample(&launcher->base, t, y + launcher->base_at);
    return status ? status : propagator_start(run->propagator, t, y, false, &run->error);
}

ld_status launch_wrench(ld_run *run, const double *y, ld_base_wrench *wrench, ld_error *error)
{
    base_wrench found;
    ld_status status = wrench_at(run, run->t, y, &found, error);
    if (status)
        return status;
    v3_store(wrench->force, found.force);
    v3_store(wrench->moment, found.moment);
    return LD_OK;
}
