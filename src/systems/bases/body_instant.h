// A body, or a section of the tube, as its columns have it.
#ifndef LD_SYSTEMS_BODY_INSTANT_H
#define LD_SYSTEMS_BODY_INSTANT_H

#include "systems/mechanism/mechanism.h"

// Place and velocity of its origin in I, yaw, pitch, roll of Ry(yaw) Rz(pitch) Rx(roll), its rate
// in its own axes.
typedef struct body_instant {
    double r[3], angles[3], v[3], w[3];
} body_instant;

void body_instant_find(const body_motion *from, body_instant *to);

#endif
