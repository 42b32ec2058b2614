#include "launch/launch_parts.h"

#include "launch/launch_summary.h"
#include "model/blocks/base.h"
#include "model/parts.h"
#include "state/evaluation.h"

void launch_watch_parts(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    double since = t - self->t_ignition;
    if (!model_has_multibody(self->model) || !self->phase.rocket || self->phase.passed[0] ||
        !(since >= 0))
        return;
    const ld_mechanism *given = &model_base(self->model)->mechanism;
    const launcher_output *at = simulation_output(self, t, y);
    ld_rocket_summary *rocket = &run->summary.rocket[self->current];
    if (!at)
        return;
    const mechanism_report *report = &at->base.report.mechanism.report;
    for (int i = 0; i < given->drive_count; i++)
        launch_watch_hinge(&run->drive_watch[i], since, &report->hold[i], &rocket->drive[i]);
    for (int i = 0; i < given->foot_count; i++) {
        ld_foot_summary *foot = &rocket->foot[i];
        foot->force_peak = fmax(foot->force_peak, report->foot[i].normal);
        foot->force_least = fmin(foot->force_least, report->foot[i].normal);
    }
}
