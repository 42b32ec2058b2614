// Summaries as handles.
#include <math.h>
#include <stdlib.h>

#include "launchdyn/summary.h"
#include "simulation/summary_quantities.h"

ld_summary *ld_summary_new(void)
{
    return calloc(1, sizeof(ld_summary));
}

void ld_summary_free(ld_summary *self)
{
    free(self);
}

int ld_summary_rockets(const ld_summary *self)
{
    return self->rocket_count;
}

ld_status ld_summary_number(const ld_summary *self, int rocket, const char *name, double *value,
                            ld_error *error)
{
    const quantity_things things = {
        .count = {[EACH_RUN] = 1, [EACH_ADAPTOR] = self->adaptor_count},
        .name = {[EACH_ADAPTOR] = self->adaptor[0]},
        .stride = {[EACH_ADAPTOR] = sizeof self->adaptor[0]},
    };
    quantity_walk found = quantity_find(&rocket_quantities, &things, name);
    *value = NAN;
    if (rocket < 1 || rocket > self->rocket_count)
        return ld_fail(error, LD_ERR_INPUT, "there is no rocket %d: they go from 1 to %d", rocket,
                       self->rocket_count);
    if (!found.row)
        return ld_fail(error, LD_ERR_INPUT, "there is no result \"%s\"", name);
    *value = quantity_value(&found, &self->rocket[rocket - 1]);
    return LD_OK;
}
