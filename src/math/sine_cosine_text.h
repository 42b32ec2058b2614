// The text of sine_cosine_lanes (sine_cosine.h) and real_sine_cosine_near (real_functions.h), which
// define NAME, NAME_WITHIN, NUMBER (a number or several), BITS (as many unsigned words) and how one
// is read as the other, TO_BITS and FROM_BITS.

// Sine and cosine of y + tail in [-pi/4, pi/4], by the polynomials of Sun's fdlibm (k_sin.c,
// k_cos.c).
LD_INLINE void NAME_WITHIN(NUMBER y, NUMBER tail, NUMBER *sine, NUMBER *cosine)
{
    NUMBER z = y * y, cube = z * y;
    NUMBER p = 2.75573137070700676789e-06 +
               z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
    p = 8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * p);
    *sine = y - ((z * (0.5 * tail - cube * p) - tail) - cube * -1.66666666666666324348e-01);
    NUMBER r = -2.75573143513906633035e-07 +
               z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11);
    r = 4.16666666666666019037e-02 +
        z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 + z * r));
    NUMBER half = 0.5 * z, w = 1.0 - half;
    *cosine = w + (((1.0 - w) - half) + (z * (z * r) - y * tail));
}

// Sines and cosines of angles below 5e5 (beyond, the reduction would lose digits), errors below one
// unit in the last place. Reduction by multiples of pi/2 in three pieces (fdlibm, e_rem_pio2.c).
LD_INLINE void NAME(NUMBER x, NUMBER *sine, NUMBER *cosine)
{
    // n = nearest integer of x/(pi/2), in the low bits of a large double; y + tail = x - n pi/2
    NUMBER shifted = x * 0.63661977236758134 + 6755399441055744.0;
    NUMBER n = shifted - 6755399441055744.0;
    NUMBER first = x - n * 1.57079632673412561417e+00;
    NUMBER second = n * 6.07710050630396597660e-11;
    NUMBER third = n * 2.02226624879595063154e-21;
    NUMBER middle = first - second;
    NUMBER lost = (first - middle) - second;
    NUMBER y = middle - (third - lost);
    NUMBER tail = (middle - y) - (third - lost);

    NUMBER s, c;
    NAME_WITHIN(y, tail, &s, &c);
    // odd quadrants swap the two, the second and third change the sign of the sine, the first and
    // second that of the cosine
    BITS quadrant = TO_BITS(shifted), swap = -(quadrant & 1);
    BITS sin_bits = (TO_BITS(s) & ~swap) | (TO_BITS(c) & swap);
    BITS cos_bits = (TO_BITS(c) & ~swap) | (TO_BITS(s) & swap);
    sin_bits ^= (quadrant & 2) << 62;
    cos_bits ^= ((quadrant + 1) & 2) << 62;
    *sine = FROM_BITS(sin_bits);
    *cosine = FROM_BITS(cos_bits);
}
#undef NAME
#undef NAME_WITHIN
#undef NUMBER
#undef BITS
#undef TO_BITS
#undef FROM_BITS
