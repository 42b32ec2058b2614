// Serial vectors for SUNDIALS with operations of our own: the packaged library is compiled without
// optimisation. An integrator's vectors, the library's among them, are made together, for the
// library does not look whether it was given one.
#ifndef LD_INTEGRATION_SERIAL_VECTOR_H
#define LD_INTEGRATION_SERIAL_VECTOR_H

#include <stddef.h>
#include <sundials/sundials_nvector.h>

typedef struct serial_vectors serial_vectors;

// Vectors of n elements, as many as an integrator needs; NULL: no memory.
serial_vectors *serial_vectors_new(size_t n, SUNContext context);
void serial_vectors_free(serial_vectors *set);

// One of them, all zero; N_VClone() of any of them takes one more, N_VDestroy() gives it back.
N_Vector serial_vectors_take(serial_vectors *set);

#endif
