// Motion of a multibody system in time.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "integration/integrator.h"
#include "launchdyn/mstmm.h"

// What the integrator's callback needs; the state is (q, u).
typedef struct run {
    ld_mstmm *system;
    const ld_mstmm_settings *settings;
    int q_count, u_count, wrench_count;
    double *tau, *wrench, *state, *atol;
    double *moved; // (q, u) with what is prescribed
    ld_error failure;
} run;

// Near singular poses the drift of a step's stages is taken out too: the forces amplify it there.
static const double near_singular = 1e-2;

// Writes the prescribed motion into a state; its rates are the first part of tau.
static void prescribe(run *r, double t, double *y)
{
    memset(r->tau, 0, (size_t)r->u_count * sizeof *r->tau);
    if (r->settings->motion)
        r->settings->motion(t, y, y + r->q_count, r->tau, r->settings->context);
}

static int derivative(double t, const double *y, double *y_dot, void *self)
{
    run *r = self;
    const double *wrench = NULL;
    if (r->settings->motion) {
        memcpy(r->moved, y, (size_t)(r->q_count + r->u_count) * sizeof *y);
        prescribe(r, t, r->moved);
        y = r->moved;
    } else if (r->settings->drive) {
        memset(r->tau, 0, (size_t)r->u_count * sizeof *r->tau);
    }
    const double *q = y, *u = y + r->q_count;
    if (r->settings->drive) {
        memset(r->wrench, 0, (size_t)r->wrench_count * sizeof *r->wrench);
        r->settings->drive(t, q, u, r->tau, r->wrench, r->settings->context);
        wrench = r->wrench;
    }
    const double *tau = r->settings->motion || r->settings->drive ? r->tau : NULL;
    double *u_dot = y_dot + r->q_count;
    ld_status status = ld_mstmm_accelerations(r->system, q, u, tau, wrench, u_dot, &r->failure);
    if (ld_mstmm_singularity(r->system, NULL) < near_singular) {
        if (y != r->moved)
            memcpy(r->moved, y, (size_t)(r->q_count + r->u_count) * sizeof *y);
        if (!ld_mstmm_project(r->system, r->moved, r->moved + r->q_count, NULL)) {
            q = r->moved;
            u = r->moved + r->q_count;
            status = ld_mstmm_accelerations(r->system, q, u, tau, wrench, u_dot, &r->failure);
        }
    }
    ld_mstmm_rates(r->system, q, u, y_dot);
    return status;
}

// A step's end gets what is prescribed, and the loops are closed.
static int settle(double t, double *y, void *self)
{
    run *r = self;
    if (r->settings->motion)
        prescribe(r, t, y);
    return ld_mstmm_project(r->system, y, y + r->q_count, &r->failure);
}

static ld_status advance(run *r, integrator *stepper, double t_0, double t_1, ld_error *error)
{
    const ld_mstmm_settings *settings = r->settings;
    ld_status status = integrator_start(stepper, t_0, r->state, error);
    double every = settings->output_step > 0 ? settings->output_step : t_1 - t_0;
    const double *y = integrator_state(stepper);
    if (!status && settings->sink && settings->sink(t_0, y, y + r->q_count, settings->context))
        return ld_fail(error, LD_ERR_INTERRUPTED, "stopped on request at t = %.9g s", t_0);
    for (int64_t k = 1; !status && integrator_time(stepper) < t_1; k++) {
        double t_stop = fmin(t_0 + (double)k * every, t_1);
        if (t_1 - t_stop < 1e-9 * every)
            t_stop = t_1;
        while (integrator_time(stepper) < t_stop)
            if (integrator_step(stepper, t_stop, error) == INTEGRATOR_FAILED)
                return r->failure.status ? ld_fail(error, r->failure.status, "%s (t = %.9g s)",
                                                   r->failure.text, integrator_time(stepper))
                                         : integrator_failure(stepper);
        y = integrator_state(stepper);
        if (settings->sink && settings->sink(t_stop, y, y + r->q_count, settings->context))
            status = ld_fail(error, LD_ERR_INTERRUPTED, "stopped on request at t = %.9g s", t_stop);
    }
    memcpy(r->state, integrator_state(stepper),
           (size_t)(r->q_count + r->u_count) * sizeof *r->state);
    return status;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_mstmm_integrate(ld_mstmm *system, const ld_mstmm_settings *settings, double t_0,
                             double t_1, double *q, double *u, ld_mstmm_statistics *statistics,
                             ld_error *error)
{
    run r = {.system = system,
             .settings = settings,
             .q_count = ld_mstmm_coordinate_count(system),
             .u_count = ld_mstmm_speed_count(system),
             .wrench_count = 6 * ld_mstmm_element_count(system)};
    size_t nq = (size_t)r.q_count, nu = (size_t)r.u_count, n = nq + nu;
    if (n == 0)
        return ld_fail(error, LD_ERR_INPUT, "a system without hinges does not move");
    if (!(t_1 >= t_0))
        return ld_fail(error, LD_ERR_INPUT, "found an end at %.9g s, before the start at %.9g s",
                       t_1, t_0);
    double *block = calloc(3 * n + nu + (size_t)r.wrench_count, sizeof *block);
    if (!block)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for an integration");
    r.state = block;
    r.atol = block + n;
    r.moved = block + 2 * n;
    r.tau = block + 3 * n;
    r.wrench = r.tau + nu;
    memcpy(r.state, q, nq * sizeof *q);
    memcpy(r.state + nq, u, nu * sizeof *u);
    if (settle(t_0, r.state, &r)) {
        free(block);
        return ld_fail(error, r.failure.status, "%s (t = %.9g s)", r.failure.text, t_0);
    }
    for (size_t i = 0; i < n; i++)
        r.atol[i] = settings->atol > 0 ? settings->atol : 1e-8;

    integrator *stepper = NULL;
    const bool projects = settings->motion || ld_mstmm_loop_count(system) > 0;
    const integrator_settings setup = {.n = n,
                                       .method = INTEGRATOR_DORMAND_PRINCE,
                                       .rtol = settings->rtol > 0 ? settings->rtol : 1e-8,
                                       .atol = r.atol,
                                       .rhs = derivative,
                                       .project = projects ? settle : NULL,
                                       .self = &r};
    ld_status status = integrator_create(&setup, &stepper, error);
    if (!status)
        status = advance(&r, stepper, t_0, t_1, error);
    if (stepper && statistics) {
        statistics->steps = integrator_steps(stepper);
        statistics->evaluations = integrator_evaluations(stepper);
    }
    if (!status) {
        memcpy(q, r.state, nq * sizeof *q);
        memcpy(u, r.state + nq, nu * sizeof *u);
    }
    integrator_free(stepper);
    free(block);
    return status;
}
