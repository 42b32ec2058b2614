// The sea that a ship meets: plane waves on deep water, regular or of a spectrum (sea.md).
#ifndef LD_ENVIRONMENT_SEA_H
#define LD_ENVIRONMENT_SEA_H

#include <stddef.h>

#include "launchdyn/status.h"
#include "model/blocks/sea.h"

// A wave: the water stands at a cos(omega t - k (x cos heading + z sin heading) + phase) at (x, z)
// of I, k = omega^2/g.
typedef struct sea_wave {
    double amplitude; // [m]
    double omega;     // [rad/s]
    double heading;   // [rad] where it goes to, from x, positive to the right
    double phase;     // [rad] at t = 0 in I's origin
} sea_wave;

// The waves that the seed decides. *waves is to be freed.
ld_status sea_build(const ld_sea *model, sea_wave **waves, size_t *count, ld_error *error);

// Frequency [rad/s] at which a point meets it that goes at this velocity [m/s] along I's axes;
// negative: it overtakes the wave.
double sea_encounter(const sea_wave *wave, const double velocity[3], double gravity);

#endif
