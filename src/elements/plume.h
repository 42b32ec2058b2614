// A motor's jet on rings across a guide: the front end, a deflector (model.md, section 5).
#ifndef LD_ELEMENTS_PLUME_H
#define LD_ELEMENTS_PLUME_H

#include "math/vectors/mat3.h"
#include "model/blocks/motor.h"

// What bears a jet: a ring.
typedef struct plume_ring {
    double inner, outer; // [m] radii
} plume_ring;

// The push of a motor.
typedef struct plume_thrust {
    double now, greatest; // [N]
} plume_thrust;

// What hits a ring, against its x axis.
typedef struct plume_load {
    double force; // [N]
    double at[2]; // [m] y and z of the centre of pressure
} plume_load;

// In axes of the ring from its centre, x normal to it: `r` [m] where the nozzle is, `axis` that of
// the rocket, of length 1.
plume_load plume_on_ring(const ld_plume *plume, plume_ring ring, plume_thrust thrust, v3 r,
                         v3 axis);

#endif
