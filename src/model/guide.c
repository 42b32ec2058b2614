#include "model/guide.h"

#include <stdio.h>

#include "math/functions.h"

static const double PI = 3.14159265358979323846;

// A slot with its lips along z: over and under each of them, and on either side of the middle.
static int t_slot_surfaces(const ld_t_slot *slot, ld_surface *surface)
{
    double y = slot->at[0], z = slot->at[1], half = slot->lips / 2;
    double gap = slot->gap, side = slot->side_gap;
    const ld_surface six[] = {
        {"right_over", {y, z + half}, 0, gap, LD_SURFACE_FLAT},
        {"right_under", {y, z + half}, PI, gap, LD_SURFACE_FLAT},
        {"left_over", {y, z - half}, 0, gap, LD_SURFACE_FLAT},
        {"left_under", {y, z - half}, PI, gap, LD_SURFACE_FLAT},
        {"right", {y, z}, PI / 2, side, LD_SURFACE_FLAT},
        {"left", {y, z}, -PI / 2, side, LD_SURFACE_FLAT},
    };
    for (int k = 0; k < 6; k++)
        surface[k] = six[k];
    return 6;
}

static int tower_surfaces(const ld_tower *tower, ld_surface *surface)
{
    for (int k = 0; k < tower->rails; k++) {
        double angle = tower->first + 2 * PI * k / tower->rails, r = tower->radius;
        surface[k] = (ld_surface){.at = {r * cos(angle), r * sin(angle)},
                                  .normal = angle,
                                  .gap = tower->gap,
                                  .shape = LD_SURFACE_ROUND};
        snprintf(surface[k].name, sizeof surface[k].name, "rail_%d", k + 1);
    }
    return tower->rails;
}

int guide_surfaces(const ld_guide *guide, ld_surface surface[LD_MAX_SURFACES])
{
    if (!guide->present)
        return 0;
    if (guide->form == LD_GUIDE_T_SLOT)
        return t_slot_surfaces(&guide->t_slot, surface);
    if (guide->form == LD_GUIDE_TOWER)
        return tower_surfaces(&guide->tower, surface);
    for (int k = 0; k < guide->surface_count; k++)
        surface[k] = guide->surface[k];
    return guide->surface_count;
}

bool guide_is_flat(const ld_guide *guide)
{
    ld_surface surface[LD_MAX_SURFACES];
    int count = guide_surfaces(guide, surface);
    for (int k = 0; k < count; k++)
        if (surface[k].shape == LD_SURFACE_FLAT)
            return true;
    return false;
}

double guide_clearance(const ld_adaptor *shoe)
{
    return isnan(shoe->clearance) ? 0 : shoe->clearance;
}

double guide_end(const ld_tubes *tubes, const ld_adaptor *adaptor)
{
    return isnan(adaptor->leaves_at) ? tubes->length : adaptor->leaves_at;
}

double guide_exit_station(const ld_tubes *tubes, const ld_adaptor *adaptor)
{
    return guide_end(tubes, adaptor) - adaptor->at;
}
