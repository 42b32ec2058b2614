/// Roads to look at: what the seed of a scenario's road gave.
#ifndef LAUNCHDYN_ENVIRONMENT_H
#define LAUNCHDYN_ENVIRONMENT_H

#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A stretch of places, from `from` to `to`, `step` apart; NaN: the usual value.
typedef struct ld_stretch {
    double from, to, step; ///< [m]
} ld_stretch;

/// Both tracks of a road over a stretch, and their power spectral densities by thirds of octaves.
typedef struct ld_road_view ld_road_view;

/// @param model   of a vehicle, kept by reference
/// @param stretch x of I, where NaN: -100 m to 100 m, 20 mm apart or, if that is less, a tenth of
///                the shortest wavelength. x = 0 is where the chassis is at ignition.
/// @return LD_OK, LD_ERR_INPUT (no vehicle, a stretch without length, too many places) or
///         LD_ERR_MEMORY
ld_status ld_road_view_create(const ld_model *model, ld_stretch stretch, ld_road_view **view,
                              ld_error *error);
void ld_road_view_free(ld_road_view *view);

/// Prints heights and spectrum as a table for a terminal.
void ld_road_view_print(const ld_road_view *view, FILE *stream);

/// Writes road.csv (x, heights of both tracks) and road-spectrum.csv into the folder, which is made
/// where it is not there.
/// @return LD_OK, LD_ERR_FILE or LD_ERR_MEMORY
ld_status ld_road_view_write(const ld_road_view *view, const char *folder, ld_error *error);

/// Draws both with gnuplot; the ending of the file says what it becomes: .svg, .pdf or .png.
/// @return LD_OK, LD_ERR_INPUT (ending), LD_ERR_FILE, LD_ERR_MEMORY, LD_ERR_MISSING (no gnuplot)
ld_status ld_road_view_draw(const ld_road_view *view, const char *file, ld_error *error);

#ifdef __cplusplus
}
#endif

#endif
