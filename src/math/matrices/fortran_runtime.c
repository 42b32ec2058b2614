// What LAPACK asks of the Fortran run-time library, so that the programs do without that library:
// it takes memory and reads the environment before main, and may end a program on its own.
#include <assert.h>
#include <stddef.h>
#include <string.h>

#include "math/matrices/lapack.h"

void concatenate(size_t size, char *text, size_t size_a, const char *a, size_t size_b,
                 const char *b) __asm__("_gfortran_concat_string");

// LAPACK's report of an argument that cannot be: a fault of ours.
void wrong_argument(const char *routine, const int *number, size_t length)
{
    (void)routine, (void)number, (void)length;
    assert(!"LAPACK received a wrong argument");
}

// text = a // b, filled up with blanks or cut to its size, like every text of Fortran.
void concatenate(size_t size, char *text, size_t size_a, const char *a, size_t size_b,
                 const char *b)
{
    memset(text, ' ', size);
    memcpy(text, a, size_a < size ? size_a : size);
    if (size_a < size)
        memcpy(text + size_a, b, size_b < size - size_a ? size_b : size - size_a);
}
