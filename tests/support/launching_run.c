#include "support/launching_run.h"

#include <stdlib.h>

#include "support/check.h"
#include "support/launching_state.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_kinematics.h"

launching_system *launching_system_of(const ld_model *model)
{
    launching_system *system = aligned_alloc(64, (sizeof *system + 63) / 64 * 64);
    ld_error error;
    assert_int_equal(launching_build(system, model, NULL, &error), LD_OK);
    return system;
}

void launching_system_drop(launching_system *system)
{
    launching_free(system);
    free(system);
}

void launching_run_begin(launching_run *run, const launching_system *system, double s)
{
    const ld_rocket *rocket = &system->model->rocket;
    const double *J = rocket->full.inertia;
    memset(run, 0, sizeof *run);
    run->system = system;
    run->input.base.A = m3_identity();
    run->input.base.q.w = 1;
    run->input.mass.m = rocket->full.mass;
    run->input.mass.c = v3_from(rocket->full.center);
    run->input.mass.J = m3_diagonal(J[0], J[1], J[2]);
    run->phase.rocket = true;
    run->state[system->layout.quaternion] = 1;
    run->state[system->layout.x] = s;
}

// y is affine in V: its matrix by unit V, then elimination with pivots.
void launching_run_set_speeds(const launching_system *system, double *state, const double y[6])
{
    const launching_layout *at = &system->layout;
    launching_output out;
    launching_pose pose;
    double A[6][7], *V = state + at->V;
    memset(V, 0, 6 * sizeof *V);
    launching_rocket_pose(system, state, &pose, &out);
    double y0[6];
    memcpy(y0, out.y, sizeof y0);
    for (int j = 0; j < 6; j++) {
        V[j] = 1;
        launching_rocket_pose(system, state, &pose, &out);
        V[j] = 0;
        for (int i = 0; i < 6; i++)
            A[i][j] = out.y[i] - y0[i];
    }
    for (int i = 0; i < 6; i++)
        A[i][6] = y[i] - y0[i];
    // elimination with pivots
    for (int k = 0; k < 6; k++) {
        int p = k;
        for (int i = k + 1; i < 6; i++)
            p = fabs(A[i][k]) > fabs(A[p][k]) ? i : p;
        for (int j = 0; j < 7; j++) {
            double swap = A[k][j];
            A[k][j] = A[p][j];
            A[p][j] = swap;
        }
        for (int i = 0; i < 6; i++)
            for (int j = 6; i != k && j >= k; j--)
                A[i][j] -= A[i][k] / A[k][k] * A[k][j];
    }
    for (int i = 0; i < 6; i++)
        V[i] = A[i][6] / A[i][i];
}

static int rhs(double t, const double *state, double *state_dot, void *user)
{
    (void)t;
    launching_run *run = user;
    launching_output out;
    if (launching_evaluate(run->system, &run->input, &run->phase, state, &out))
        return -1;
    launching_rates(run->system, state, &out, run->phase.rocket, state_dot);
    memcpy(state_dot + run->system->layout.count, out.power,
           (size_t)run->system->work_count * sizeof *out.power);
    return 0;
}

static int project(double t, double *state, void *user)
{
    (void)t;
    launching_run *run = user;
    launching_project(run->system, &run->input, &run->phase, state);
    return 0;
}

void launching_run_follow(launching_run *run, double tolerance, double time)
{
    const launching_layout *at = &run->system->layout;
    ld_error error;
    struct integrator *stepper;
    double atol[RUN_STATES];
    int count = at->count + run->system->work_count;
    for (int i = 0; i < count; i++)
        atol[i] = i < at->count ? tolerance : 1e300;
    for (int i = 0; i < at->nq; i++)
        atol[at->q + i] = 1e-2 * tolerance;
    for (int i = 0; i < 5; i++)
        atol[at->x + 1 + i] = 1e-2 * tolerance;
    integrator_settings settings = {.n = (size_t)count,
                                    .rtol = tolerance,
                                    .atol = atol,
                                    .rhs = run->rhs ? run->rhs : rhs,
                                    .project = launching_holds_places(run->system) ? project : NULL,
                                    .self = run};
    assert_int_equal(integrator_create(&settings, &stepper, &error), LD_OK);
    assert_int_equal(integrator_start(stepper, 0, run->state, &error), LD_OK);
    integrator_outcome outcome = INTEGRATOR_STEPPED;
    while (outcome == INTEGRATOR_STEPPED) {
        outcome = integrator_step(stepper, time, &error);
        assert_true(outcome == INTEGRATOR_STEPPED || outcome == INTEGRATOR_STOPPED);
        double t = integrator_time(stepper);
        memcpy(run->state, integrator_state(stepper), (size_t)count * sizeof(double));
        if (run->project) {
            launching_project(run->system, &run->input, &run->phase, run->state);
            assert_int_equal(integrator_start(stepper, t, run->state, &error), LD_OK);
        }
        if (run->after_step)
            run->after_step(run, t);
    }
    run->steps = integrator_steps(stepper);
    run->evaluations = integrator_evaluations(stepper);
    integrator_free(stepper);
}

void launching_run_dense(const launching_run *run, const dense_launch *dense,
                         dense_launch_output *output)
{
    launching_case c;
    memset(&c, 0, sizeof c);
    memcpy(c.state, run->state, (size_t)run->system->layout.count * sizeof(double));
    c.input = run->input;
    c.phase = run->phase;
    copy_to_dense(run->system, &c);
    assert_true(dense_launch_evaluate(dense, &c.dense, output));
}
