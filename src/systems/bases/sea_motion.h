// How a ship moves in its sea: what its linear response (response amplitude operators) makes of
// each wave, summed; place, velocity and acceleration (sea.md).
#ifndef LD_SYSTEMS_SEA_MOTION_H
#define LD_SYSTEMS_SEA_MOTION_H

#include <stddef.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

enum {
    SEA_LANES = 8,        // x, y, z, yaw, pitch, roll, and two of nothing
    SEA_COEFFICIENTS = 16 // of a Taylor series
};

// The part of the motion that a wave makes: Re(c_j e^(i omega t)) of coordinate j.
typedef struct sea_line {
    double omega; // [rad/s] as the ship meets it
    double re[SEA_LANES], im[SEA_LANES];
} sea_line;

typedef struct sea_motion {
    size_t count; // 0: no sea
    sea_line *line;
    double from, width; // [s] Taylor series about the middles of cells that wide
    size_t cells;
    double (*cell)[SEA_COEFFICIENTS][SEA_LANES]; // over (t - middle)/width
} sea_motion;

// Of a base with the model's sea; its course from `first` to `last` [s] is tabulated to rounding,
// outside it is summed wave by wave.
ld_status sea_motion_build(sea_motion *self, const ld_model *model, double first, double last,
                           ld_error *error);
void sea_motion_free(sea_motion *self);

// Adds it at t [s]: x, y, z [m], yaw, pitch, roll [rad], their rates and accelerations.
void sea_motion_add(const sea_motion *self, double t, double x[6], double u[6], double a[6]);

#endif
