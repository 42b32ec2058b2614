// What sensors on the launcher measure, from the columns of the part that carries them: a body, a
// platform, a section of the tube at a station.
#ifndef LD_COMPARE_LAUNCHER_READING_H
#define LD_COMPARE_LAUNCHER_READING_H

#include "compare/sensor.h"

// The columns PART.NAME side by side, as run_series_take().
ld_status launcher_take(const char *part, const run_series *run, const char *const *names,
                        size_t width, run_signal *signal, ld_error *error);

// Accelerometer at r: axis . A' (dv/dt + g e_y), v = v_O + A (w x r) the velocity of its place in
// I. Between two rows dv/dt is the mean, as a low pass needs it, and stands at their middle.
// @return LD_OK, LD_ERR_INPUT (no such columns), LD_ERR_MEMORY
ld_status launcher_accelerate(const sensor *self, const run_series *run, run_signal *signal,
                              ld_error *error);

// Strain gauge along the tube at (y, z) of the section: strain - y u_y'' - z u_z''.
ld_status launcher_strain(const sensor *self, const run_series *run, run_signal *signal,
                          ld_error *error);

#endif
