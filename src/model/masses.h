// The rocket's mass data at the rows of rocket.motor.masses: model.md, section 5.
#ifndef LD_MODEL_MASSES_H
#define LD_MODEL_MASSES_H

#include <stddef.h>

#include "math/vectors/mat3.h"
#include "model/blocks/rocket.h"

enum { MASSES_TIME, MASSES_MASS, MASSES_CENTER, MASSES_AXIAL, MASSES_TRANSVERSE, MASSES_COLUMNS };

// At row `row` of the table, from 0: what the part of the rocket that it reports of has lost since
// the first row is taken from the rocket at ignition, without mass error and eccentricity. With the
// part's mass p at x, its moments of inertia I about its own centre, and X = x - c_0:
//   m = m_0 + p - p_0,  c = c_0 + (p X - p_0 X_0)/m,
//   J = J_0 + I - I_0 + p X^2 - p_0 X_0^2 - m (c - c_0)^2, of the axial one without the squares
// (Huygens and Steiner).
ld_mass_data masses_at(const ld_rocket *rocket, size_t row);

// Moments of inertia about y or z (axis 1 or 2), or x (0), that all that falls off leaves of `full`
// or `empty`, without mass error, eccentricity and products [kg m2]; *mass: what is left of it
// [kg].
double masses_left(const ld_rocket *rocket, const ld_mass_data *data, int axis, double *mass);

// With further motors: mass [kg] and mass centre [m] in B, t [s] after ignition, from those at
// ignition, and by how much the inertia about it [kg m2] has grown. The parts lie on lines along x,
// the first one's through the mass centre at ignition, the others' through their nozzles; of each,
// between its rows, mass, centre and moments go linearly. With S(a) = a.a E - a a^T
//   m' = m + sum (p - p_0),  c' = (m c + sum (p X - p_0 X_0))/m',
//   J' - J = sum (I - I_0 + p S(X) - p_0 S(X_0)) + m S(c) - m' S(c')
m3 masses_of_parts(const ld_rocket *rocket, double t, double *mass, v3 *center);

#endif
