// Loops closed: their forces at acceleration level, and projection of positions and speeds.
#ifndef LD_SYSTEMS_CLOSING_H
#define LD_SYSTEMS_CLOSING_H

#include "systems/multibody/multibody.h"

// Between the inward and the outward sweep of an evaluation: finds the forces that keep the loops
// closed and adds them to what the axes do.
ld_status loops_close(ld_mstmm *system, ld_error *error);

// q displaced by size times small motions d along the speeds.
void multibody_displace(const ld_mstmm *system, const double *q, double size, const double *d,
                        double *out);

// By how much [rad] they turn the sections of beams with geometric stiffness at most.
double multibody_turn(const ld_mstmm *system, const double *d);

// Inverse dynamics with the loops' forces of the latest evaluation, of constant size along
// directions that turn with the bodies.
void multibody_needed_forces(ld_mstmm *system, const double *q, const double *u,
                             const double *u_dot, double *tau);

#endif
