#include "fmu/fmu_exchange.h"

#include <math.h>
#include <string.h>

#include "fmu/fmu_instance_own.h"

static size_t count_of(const fmu_instance *self, fmu_vector which)
{
    const fmu_exchanging *by = self->variables.runner->exchanging;
    return (size_t)(which == FMU_INDICATORS ? by->indicators(self->run) : by->states(self->run));
}

// ---- modes ----

static ld_status check_exchange(const fmu_instance *self, ld_error *error)
{
    if (!self->exchange.is)
        return ld_fail(error, LD_ERR_INPUT,
                       "this is a co-simulation instance: it has its own integrator");
    return LD_OK;
}

// `continuous`: a call of continuous-time mode, else of event mode.
static ld_status check_mode(const fmu_instance *self, bool continuous, ld_error *error)
{
    ld_status status = check_exchange(self, error);
    if (status)
        return status;
    if (!self->going)
        return ld_fail(error, LD_ERR_INPUT, "the run has not begun");
    if (self->exchange.continuous == continuous)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   continuous ? "the instance is in event mode: enter continuous-time mode first"
                              : "the instance is in continuous-time mode: enter event mode first");
}

// ---- where the importer is ----

ld_status fmu_set_time(fmu_instance *self, double t, ld_error *error)
{
    ld_status status = check_mode(self, true, error);
    if (!status && !isfinite(t))
        status = ld_fail(error, LD_ERR_INPUT, "the time is not a number");
    if (status)
        return status;
    self->exchange.moved |= t != self->exchange.t;
    self->exchange.t = t;
    return LD_OK;
}

// The launch has come to its end. That is reported at the end of the next step, so that an importer
// records what came of it; until then all stands still.
static bool is_over(const fmu_instance *self)
{
    return self->variables.runner->is_finished(self->run);
}

static ld_status check_count(const fmu_instance *self, fmu_vector which, size_t count,
                             ld_error *error)
{
    size_t wanted = count_of(self, which);
    if (count == wanted)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "found %zu numbers for %zu %s", count, wanted,
                   which == FMU_INDICATORS ? "event indicators" : "continuous states");
}

ld_status fmu_set_states(fmu_instance *self, const double *x, size_t count, ld_error *error)
{
    double sum = 0;
    ld_status status = check_mode(self, true, error);
    if (!status)
        status = check_count(self, FMU_STATES, count, error);
    for (size_t i = 0; !status && i < count; i++)
        sum += 0 * x[i];
    if (!status && sum != 0)
        status = ld_fail(error, LD_ERR_NUMERIC, "a state is not a number");
    if (status)
        return status;
    memcpy(self->exchange.x, x, count * sizeof *x);
    self->exchange.moved = true;
    return LD_OK;
}

ld_status fmu_get_vector(fmu_instance *self, fmu_vector which, double *value, size_t count,
                         ld_error *error)
{
    ld_status status = check_exchange(self, error);
    if (!status)
        status = fmu_begin(self, error);
    if (!status)
        status = fmu_place(self, error);
    if (!status)
        status = check_count(self, which, count, error);
    if (status)
        return status;
    switch (which) {
    case FMU_STATES:
        self->variables.runner->exchanging->get_state(self->run, value);
        return LD_OK;
    case FMU_NOMINALS:
        self->variables.runner->exchanging->nominals(self->run, value);
        return LD_OK;
    case FMU_RATES:
        return fmu_rates(self, value, error);
    default:
        return fmu_indicators(self, value, error);
    }
}

ld_status fmu_count_vector(fmu_instance *self, fmu_vector which, size_t *count, ld_error *error)
{
    ld_status status = check_exchange(self, error);
    if (!status)
        status = fmu_begin(self, error);
    *count = status ? 0 : count_of(self, which);
    return status;
}

// ---- steps and events ----

ld_status fmu_complete_step(fmu_instance *self, bool *at_event, bool *ended, ld_error *error)
{
    *at_event = *ended = false;
    ld_status status = check_mode(self, true, error);
    *ended = !status && is_over(self);
    if (status || *ended)
        return status;
    status = fmu_place(self, error);
    if (!status)
        status = self->variables.runner->exchanging->accept(self->run, at_event, error);
    fmu_forget_outputs(self);
    *at_event |= !status && is_over(self);
    return status;
}

ld_status fmu_enter_event_mode(fmu_instance *self, ld_error *error)
{
    ld_status status = check_exchange(self, error);
    if (!status && !self->going)
        status = check_mode(self, false, error);
    if (!status)
        status = fmu_place(self, error);
    if (!status)
        self->exchange.continuous = false;
    return status;
}

ld_status fmu_update_states(fmu_instance *self, fmu_update *update, ld_error *error)
{
    *update = (fmu_update){.next = INFINITY};
    ld_status status = check_mode(self, false, error);
    update->ended = !status && is_over(self);
    if (status || update->ended)
        return status;
    status = fmu_place(self, error);
    if (!status)
        status =
            self->variables.runner->exchanging->pass_events(self->run, &update->changed, error);
    if (!status)
        status = fmu_ignite(self, &update->changed, error);
    fmu_forget_outputs(self);
    if (status)
        return status;
    self->variables.runner->exchanging->get_state(self->run, self->exchange.x);
    if (!is_over(self))
        update->next = self->variables.runner->exchanging->next(self->run) + self->ahead;
    return LD_OK;
}

ld_status fmu_enter_continuous_time(fmu_instance *self, ld_error *error)
{
    ld_status status = check_exchange(self, error);
    if (!status && !self->exchange.continuous)
        status = check_mode(self, false, error);
    self->exchange.continuous |= !status;
    return status;
}
