#include "state/stepping/tolerances.h"

#include <math.h>
#include <string.h>

#include "model/parts.h"

void tolerances_find(const launch_state *self, tolerances *all)
{
    const launching_layout *at = &self->launcher.launching.layout;
    double tolerance = model_run(self->model)->tolerance, *atol = all->atol;
    memset(all->absolute, 0, sizeof all->absolute);
    for (int i = 0; i < LD_MAX_STATES; i++)
        atol[i] = INFINITY;
    for (int i = 0; i < 3; i++) {
        atol[at->r + i] = 1e-2 * tolerance;
        all->absolute[at->r + i] = true;
        atol[at->v + i] = atol[at->w + i] = tolerance;
        atol[at->V + i] = atol[at->V + 3 + i] = tolerance;
    }
    for (int i = 0; i < X_COUNT; i++)
        atol[at->x + i] = i == X_S ? tolerance : 1e-2 * tolerance;
    for (int i = 0; i < 4; i++)
        atol[at->quaternion + i] = 1e-2 * tolerance;
    for (int i = 0; i < at->nq; i++) {
        atol[at->q + i] = 1e-2 * tolerance;
        atol[at->q_dot + i] = tolerance;
    }
    const base_dynamics *base = self->launcher.base.kind->dynamics;
    int base_at = self->launcher.base_at;
    if (base)
        base->tolerances(&self->launcher.base, tolerance, atol + base_at, all->absolute + base_at);
}
