// Operations on the serial vectors of SUNDIALS. Debian's package is built without optimisation, so
// those that count in every step of the integrator are our own: plain loops over the elements.
#ifndef LD_SIMULATION_SERIAL_VECTOR_H
#define LD_SIMULATION_SERIAL_VECTOR_H

#include <sundials/sundials_nvector.h>

// Replaces them in a serial vector, and so in those cloned from it.
void serial_vector_operations(N_Vector v);

#endif
