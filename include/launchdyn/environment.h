/// Roads and winds to look at: what a scenario's seeds gave.
#ifndef LAUNCHDYN_ENVIRONMENT_H
#define LAUNCHDYN_ENVIRONMENT_H

#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

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

/// Where a wind is shown.
typedef struct ld_wind_section {
    double height; ///< [m] above ground of gusts and turbulence
    double top;    ///< [m] up to which the profile goes
    double length; ///< [m] of the line along which turbulence is shown; NaN: 100 L_u
    double step;   ///< [m] along it; NaN: 0.03 of the smaller length scale
    int rocket;    ///< whose turbulence, from 1
} ld_wind_section;

/// Profile, gusts, and turbulence along a line at constant height with its power spectral
/// densities.
typedef struct ld_wind_view ld_wind_view;

/// @param model with a wind, kept by reference
/// @return LD_OK, LD_ERR_INPUT (no wind, a section that is none) or LD_ERR_MEMORY
ld_status ld_wind_view_create(const ld_model *model, ld_wind_section section, ld_wind_view **view,
                              ld_error *error);
void ld_wind_view_free(ld_wind_view *view);

/// Prints profile, gusts and spectra as tables for a terminal.
void ld_wind_view_print(const ld_wind_view *view, FILE *stream);

/// Writes wind-profile.csv and, where there are such, wind-gusts.csv, wind-turbulence.csv and
/// wind-spectrum.csv into the folder, which is made where it is not there.
/// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE or LD_ERR_MEMORY
ld_status ld_wind_view_write(const ld_wind_view *view, const char *folder, ld_error *error);

/// Draws them with gnuplot; the ending of the file says what it becomes: .svg, .pdf or .png.
/// @return LD_OK, LD_ERR_INPUT (ending), LD_ERR_FILE, LD_ERR_MEMORY, LD_ERR_MISSING (no gnuplot)
ld_status ld_wind_view_draw(const ld_wind_view *view, const char *file, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
