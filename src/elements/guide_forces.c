#include "elements/guide_forces.h"

#include <string.h>

void guide_forces_begin(guide_forces *self, int count, const ld_station *station)
{
    memset(self, 0, sizeof *self);
    self->count = count;
    for (int i = 0; i < count; i++)
        self->at[i] = station[i].at;
}

void guide_forces_add(guide_forces *self, double x, v3 f, v3 m)
{
    double from = fmax(x, 0);
    for (int i = 0; i < self->count; i++)
        if (from >= self->at[i]) {
            self->beyond[i].f = v3_add(self->beyond[i].f, f);
            self->beyond[i].m = v3_add(self->beyond[i].m, m);
        }
}
