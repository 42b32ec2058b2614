// The frame that carries something, and how it moves: of the base that carries the tube, of a
// chassis.
#ifndef LD_ELEMENTS_BASE_FRAME_H
#define LD_ELEMENTS_BASE_FRAME_H

#include "math/vectors/quaternion.h"

// Frame T of the undeformed tube: origin at its rear end, x along it; all vectors in I.
typedef struct base_frame {
    v3 r; // [m] origin
    v3 v; // [m/s] its velocity
    m3 A; // A_IT
    quat q;
    v3 w;     // [rad/s] angular velocity
    v3 a;     // [m/s2] acceleration of the origin
    v3 alpha; // [rad/s2] angular acceleration; both not known of a vehicle
} base_frame;

#endif
