#include "elements/side_noise.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/sine_cosine.h"

static const double PI = 3.14159265358979323846;

// The frequency [Hz] below which lies the share u of the power.
static double frequency_below_corner(double corner, double u)
{
    double s, c;
    sincos(u * atan(NOISE_TOP), &s, &c);
    return corner * s / c;
}

static double power_of_rows(const double *a)
{
    return 0.5 * (a[3] + a[1]) * (a[2] - a[0]);
}

static double frequency_in_table(const ld_table *spectrum, double u)
{
    const double *row = spectrum->data, *last = row + 2 * (spectrum->rows - 2);
    double total = 0;
    for (const double *a = row; a <= last; a += 2)
        total += power_of_rows(a);
    double left = u * total;
    for (; row < last && left > power_of_rows(row); row += 2)
        left -= power_of_rows(row);
    // S_0 x + slope x^2/2 = left
    double slope = (row[3] - row[1]) / (row[2] - row[0]);
    double square = row[1] * row[1] + 2 * slope * left, sum = row[1] + sqrt(fmax(square, 0));
    return row[0] + (sum > 0 ? fmin(2 * left / sum, row[2] - row[0]) : 0);
}

static double frequency_at(const ld_side_noise *given, double u)
{
    return given->form == LD_SPECTRUM_TABLE ? frequency_in_table(&given->spectrum, u)
                                            : frequency_below_corner(given->corner, u);
}

ld_status side_noise_build(side_noise *self, const ld_side_noise *given, int rocket,
                           ld_error *error)
{
    uint64_t seed = (uint64_t)given->seed, frequencies = random_stream("side_force.frequency"),
             phases = random_stream("side_force.phase");
    int n = given->harmonics;
    *self = (side_noise){0};
    self->omega = calloc((size_t)(4 * n), sizeof(double));
    if (!self->omega)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the noise of the side force");
    self->harmonics = n;
    self->phi = self->omega + 2 * n;
    for (int k = 0; k < 2 * n; k++) {
        uint64_t key[3] = {(uint64_t)rocket, (uint64_t)(k / n), (uint64_t)(k % n)};
        double u = random_uniform(seed, frequencies, key[0], key[1], key[2]);
        self->omega[k] = 2 * PI * frequency_at(given, (k % n + u) / n);
        self->phi[k] = 2 * PI * random_uniform(seed, phases, key[0], key[1], key[2]);
    }
    return LD_OK;
}

void side_noise_free(side_noise *self)
{
    free(self->omega);
    *self = (side_noise){0};
}

static double sum_of(const side_noise *self, int j, double t)
{
    enum { BLOCK = 64 };
    double angle[BLOCK + 1], sine[BLOCK + 1], cosine[BLOCK + 1], sum = 0;
    const double *omega = self->omega + j * self->harmonics, *phi = self->phi + j * self->harmonics;
    for (int first = 0; first < self->harmonics; first += BLOCK) {
        int n = self->harmonics - first < BLOCK ? self->harmonics - first : BLOCK;
        for (int i = 0; i < n; i++)
            angle[i] = omega[first + i] * t + phi[first + i];
        angle[n] = 0;
        sine_cosine(n, angle, sine, cosine);
        for (int i = 0; i < n; i++)
            sum += cosine[i];
    }
    return sqrt(2.0 / self->harmonics) * sum;
}

void side_noise_at(const side_noise *self, double t, double x[2])
{
    for (int j = 0; j < 2; j++)
        x[j] = sum_of(self, j, t);
}
