// Sines and cosines of many angles at once, two by two in vector lanes.
#ifndef LD_MATH_SINE_COSINE_H
#define LD_MATH_SINE_COSINE_H

// sine[i], cosine[i] of angle[i] [rad] for i < n, errors below one unit in the last place. The
// arrays hold an even number of values: at odd n one more angle is read and its results written.
void sine_cosine(int n, const double *angle, double *sine, double *cosine);

#endif
