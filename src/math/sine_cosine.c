#include "math/sine_cosine.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

typedef double two __attribute__((vector_size(16)));
typedef int64_t bits __attribute__((vector_size(16)));

// Beyond this angle the reduction below would lose digits.
static const double largest = 5e5;

// Reduction by multiples of pi/2 in three pieces and the polynomials on [-pi/4, pi/4] are those of
// Sun's fdlibm (k_sin.c, k_cos.c, e_rem_pio2.c).
static void pair(const double *angle, double *sine, double *cosine)
{
    two x;
    memcpy(&x, angle, sizeof x);

    // n = nearest integer of x/(pi/2), in the low bits of a large double; y + tail = x - n pi/2
    two shifted = x * 0.63661977236758134 + 6755399441055744.0;
    two n = shifted - 6755399441055744.0;
    two first = x - n * 1.57079632673412561417e+00;
    two second = n * 6.07710050630396597660e-11;
    two third = n * 2.02226624879595063154e-21;
    two middle = first - second;
    two lost = (first - middle) - second;
    two y = middle - (third - lost);
    two tail = (middle - y) - (third - lost);

    // sine and cosine of y + tail
    two z = y * y, cube = z * y;
    two p = 2.75573137070700676789e-06 +
            z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
    p = 8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * p);
    two s = y - ((z * (0.5 * tail - cube * p) - tail) - cube * -1.66666666666666324348e-01);
    two r = -2.75573143513906633035e-07 +
            z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11);
    r = 4.16666666666666019037e-02 +
        z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 + z * r));
    two half = 0.5 * z, w = 1.0 - half;
    two c = w + (((1.0 - w) - half) + (z * (z * r) - y * tail));

    // odd quadrants swap the two, the second and third change the sign of the sine, the first and
    // second that of the cosine
    bits quadrant = (bits)shifted, swap = -(quadrant & 1);
    bits sin_bits = ((bits)s & ~swap) | ((bits)c & swap);
    bits cos_bits = ((bits)c & ~swap) | ((bits)s & swap);
    sin_bits ^= (quadrant & 2) << 62;
    cos_bits ^= ((quadrant + 1) & 2) << 62;
    memcpy(sine, &sin_bits, sizeof sin_bits);
    memcpy(cosine, &cos_bits, sizeof cos_bits);
}

void sine_cosine(int n, const double *angle, double *sine, double *cosine)
{
    for (int i = 0; i < n; i += 2) {
        if (fabs(angle[i]) < largest && fabs(angle[i + 1]) < largest) {
            pair(angle + i, sine + i, cosine + i);
        } else {
            for (int k = i; k < i + 2; k++) {
                sine[k] = sin(angle[k]);
                cosine[k] = cos(angle[k]);
            }
        }
    }
}
