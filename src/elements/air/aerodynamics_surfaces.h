// The air by surface: from slopes over the Mach number, or shapes, the one table that is looked up.
#ifndef LD_ELEMENTS_AERODYNAMICS_SURFACES_H
#define LD_ELEMENTS_AERODYNAMICS_SURFACES_H

#include "math/curves/curves.h"
#include "model/blocks/aerodynamics.h"
#include "model/blocks/limits.h"

// Columns of the table: ca_power_off, ca_power_on, the sums of cl_delta cant and of cl_p, then the
// slope of each surface that has one.
enum {
    SURFACES_FIRST = 4,
    SURFACES_COLUMNS = SURFACES_FIRST + LD_MAX_AIR_SURFACES,
    SURFACES_ACROSS = LD_MAX_AIR_SURFACES + 1, // of body lift, and that of `crossflow`
};

// Places [m, x of B] of the surfaces with a slope, and of those on which a drag of the lateral
// speed acts, with its coefficients on S; the Mach number at which the first of the tables given
// or of the slopes of fins ends, infinity where none does, and its key.
typedef struct air_surfaces {
    int slopes, acrosses;
    double slope_at[LD_MAX_AIR_SURFACES];
    double across_at[SURFACES_ACROSS], across[SURFACES_ACROSS];
    double last_mach;
    char last_of[LD_MAX_PATH];
} air_surfaces;

// With the table, which the caller frees, also after an error.
ld_status air_surfaces_build(air_surfaces *self, const ld_aerodynamics *model, curves *table,
                             ld_error *error);

#endif
