// Energies of the launcher and what their balance misses.
#include "state/energy.h"

#include <math.h>
#include <string.h>

#include "state/launch_state.h"
#include "systems/launching/launching_figures.h"

_Static_assert((int)LAUNCHER_MOST_WORKS <= (int)LD_MAX_WORKS, "the works exceed their buffer");

void simulation_energy(const launch_state *self, const launcher_input *input,
                       const launcher_output *out, const double *y, double energy_start,
                       ld_energy *energy)
{
    const launcher_system *launcher = &self->launcher;
    const double *work = y + launcher->work_at;
    double sum = 0, largest = 0;
    for (int i = 0; i < launcher->work_count; i++) {
        // between a base that moves with it and the tube nothing is lost
        if (launcher->base.kind->dynamics && i == POWER_BASE)
            continue;
        sum += work[i];
        largest = fmax(largest, fabs(work[i]));
    }
    energy->kinetic = launcher_kinetic_energy(launcher, input, &self->phase, y);
    energy->potential = launching_potential_energy(&launcher->launching, y);
    energy->elastic = launcher_elastic_energy(launcher, out);
    memset(energy->work, 0, sizeof energy->work);
    int launching = launcher->launching.work_count;
    memcpy(energy->work, work, (size_t)launching * sizeof *work);
    memcpy(energy->work + POWER_COUNT, work + launching,
           (size_t)launcher->base.work_count * sizeof *work);
    energy->residual = energy->kinetic + energy->potential + energy->elastic - energy_start - sum;
    energy->residual_relative = largest > 0 ? energy->residual / largest : 0;
}
