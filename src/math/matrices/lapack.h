// LAPACK, with what stands in for Fortran's library.
#ifndef LD_MATH_LAPACK_H
#define LD_MATH_LAPACK_H

#include <lapacke.h>

// fortran_runtime.c. Who calls LAPACK refers to it, so that a linker which looks into our archive
// before LAPACK's takes it, and not LAPACK's own, which needs Fortran's library.
void wrong_argument(const char *routine, const int *number, size_t length) __asm__("xerbla_");
static void (*const lapack_reports_to)(const char *, const int *, size_t)
    __attribute__((used)) = wrong_argument;

#endif
