#include "math/curves/low_pass.h"

#include "math/functions.h"

typedef low_pass_number complex_number;

static complex_number times(complex_number a, complex_number b)
{
    return (complex_number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static complex_number over(complex_number a, complex_number b)
{
    double square = b.re * b.re + b.im * b.im;
    complex_number up = times(a, (complex_number){b.re, -b.im});
    return (complex_number){up.re / square, up.im / square};
}

static complex_number scaled(double factor, complex_number a)
{
    return (complex_number){factor * a.re, factor * a.im};
}

static complex_number sum(complex_number a, complex_number b)
{
    return (complex_number){a.re + b.re, a.im + b.im};
}

void low_pass_begin(low_pass *self, double cutoff, int order, double input)
{
    const double pi = acos(-1), w = 2 * pi * cutoff;
    complex_number unit[LOW_PASS_MOST];
    self->terms = (order + 1) / 2;
    self->odd = order % 2;
    self->input = input;
    for (int k = 0; k < order; k++) {
        double angle = pi * (2 * k + order + 1) / (2 * order);
        unit[k] = (complex_number){cos(angle), sin(angle)};
    }
    if (self->odd)
        unit[order / 2] = (complex_number){-1, 0};
    for (int k = 0; k < self->terms; k++) {
        complex_number residue = {w, 0};
        for (int j = 0; j < order; j++)
            if (j != k)
                residue = over(residue, sum(unit[k], scaled(-1, unit[j])));
        self->pole[k] = scaled(w, unit[k]);
        self->residue[k] = residue;
        self->state[k] = over(scaled(-input, residue), self->pole[k]);
    }
}

// Integrals over a step of length 1 of exp(z (1 - s)) ds and s exp(z (1 - s)) ds.
static void step_weights(complex_number z, complex_number exponential, complex_number weight[2])
{
    if (z.re * z.re + z.im * z.im > 0.25) {
        complex_number whole = sum(exponential, (complex_number){-1, 0});
        weight[0] = over(whole, z);
        weight[1] = over(sum(weight[0], (complex_number){-1, 0}), z);
        return;
    }
    // sums of z^k/(k + 1)! and z^k/(k + 2)!
    complex_number term = {1, 0};
    weight[0] = weight[1] = (complex_number){0, 0};
    for (int k = 0; k < 16; k++) {
        weight[0] = sum(weight[0], term);
        term = scaled(1 / (k + 2.0), term);
        weight[1] = sum(weight[1], term);
        term = times(term, z);
    }
}

void low_pass_step(low_pass *self, double dt, double input)
{
    for (int k = 0; k < self->terms && dt > 0; k++) {
        complex_number z = scaled(dt, self->pole[k]), weight[2];
        double growth = exp(z.re);
        complex_number exponential = {growth * cos(z.im), growth * sin(z.im)};
        step_weights(z, exponential, weight);
        complex_number driven =
            sum(scaled(self->input, weight[0]), scaled(input - self->input, weight[1]));
        self->state[k] =
            sum(times(exponential, self->state[k]), scaled(dt, times(self->residue[k], driven)));
    }
    self->input = input;
}

double low_pass_output(const low_pass *self)
{
    double output = 0;
    for (int k = 0; k < self->terms; k++)
        output += (self->odd && k == self->terms - 1 ? 1 : 2) * self->state[k].re;
    return output;
}
