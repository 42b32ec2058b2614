#include "environment/turbulence.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/functions.h"

static const double PI = 3.14159265358979323846;
static const double FOOT = 0.3048;
static const double KAPPA_FIRST = 0.01, KAPPA_LAST = 100;

double turbulence_longitudinal(double kappa)
{
    return 2 / PI / (1 + kappa * kappa);
}

double turbulence_transverse(double kappa)
{
    double k2 = kappa * kappa;
    return (1 + 3 * k2) / (PI * (1 + k2) * (1 + k2));
}

// Integrals of the two from 0 on.
static double longitudinal_power(double kappa)
{
    return 2 / PI * atan(kappa);
}

static double transverse_power(double kappa)
{
    return (2 * atan(kappa) - kappa / (1 + kappa * kappa)) / PI;
}

// Cells equal in log kappa, kappa log-uniform in its cell, a^2/2 the power in the cell.
static void draw_component(turbulence *self, const ld_turbulence *model, int rocket, int j)
{
    uint64_t seed = (uint64_t)model->seed, kappas = random_stream("turbulence.kappa"),
             phases = random_stream("turbulence.phase");
    double (*power)(double) = j == 0 ? longitudinal_power : transverse_power;
    double cell = log(KAPPA_LAST / KAPPA_FIRST) / model->harmonics;
    for (int i = 0; i < model->harmonics; i++) {
        int n = j * self->harmonics + i;
        uint64_t key[3] = {(uint64_t)rocket, (uint64_t)j, (uint64_t)i};
        double u = random_uniform(seed, kappas, key[0], key[1], key[2]);
        double from = KAPPA_FIRST * exp(i * cell), to = KAPPA_FIRST * exp((i + 1) * cell);
        self->a[n] = sqrt(2 * (power(to) - power(from)));
        self->kappa[n] = KAPPA_FIRST * exp((i + u) * cell);
        self->phi[n] = 2 * PI * random_uniform(seed, phases, key[0], key[1], key[2]);
    }
}

ld_status turbulence_build(turbulence *self, const ld_turbulence *model, int rocket,
                           ld_error *error)
{
    *self = (turbulence){.present = model->present, .wind_at_6m = model->wind_at_6m};
    if (!model->present)
        return LD_OK;
    self->harmonics = model->harmonics;
    size_t count = (size_t)(TURBULENCE_COMPONENTS * self->harmonics);
    self->a = calloc(3 * count, sizeof(double));
    if (!self->a)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for turbulence");
    self->kappa = self->a + count;
    self->phi = self->a + 2 * count;
    for (int j = 0; j < TURBULENCE_COMPONENTS; j++)
        draw_component(self, model, rocket, j);
    return LD_OK;
}

void turbulence_free(turbulence *self)
{
    free(self->a);
    *self = (turbulence){0};
}

// MIL-F-8785C, 3.7.2: with the height h in feet, up to 1000 ft L_w = h, L_u = h/s^1.2, sigma_w =
// 0.1 W_20, sigma_u = sigma_w/s^0.4, s = 0.177 + 0.000823 h; above, lengths go linearly to 1750 ft
// at 2000 ft and deviations stay.
turbulence_scales turbulence_scales_at(const turbulence *self, double height)
{
    double h = fmax(height / FOOT, 10), sigma = 0.1 * self->wind_at_6m;
    if (h >= 1000) {
        double L = FOOT * (1000 + 0.75 * (fmin(h, 2000) - 1000));
        return (turbulence_scales){L, L, sigma, sigma};
    }
    double s = 0.177 + 0.000823 * h;
    return (turbulence_scales){FOOT * h / pow(s, 1.2), FOOT * h, sigma / pow(s, 0.4), sigma};
}

// 1 - 2 sin(x/2)^2 by the Taylor polynomial of degree 19, after whole turns are taken off in two
// pieces; absolute error below 1e-15 and the rounding of x. Without branches, so that a loop of
// these runs in vector lanes.
static inline double cosine(double x)
{
    const double round = 6755399441055744.0;
    double turns = (x * (1 / (2 * PI)) + round) - round;
    double y = 0.5 * ((x - turns * 6.28318530693650245668) - turns * 2.43084020260247689973e-10);
    double z = y * y, s = -1 / 121645100408832000.0;
    s = 1 / 355687428096000.0 + z * s;
    s = -1 / 1307674368000.0 + z * s;
    s = 1 / 6227020800.0 + z * s;
    s = -1 / 39916800.0 + z * s;
    s = 1 / 362880.0 + z * s;
    s = -1 / 5040.0 + z * s;
    s = 1 / 120.0 + z * s;
    s = -1 / 6.0 + z * s;
    s = y + y * z * s;
    return 1 - 2 * s * s;
}

static double sum_component(const turbulence *self, int j, double xi)
{
    enum { BLOCK = 64 };
    const double *a = self->a + j * self->harmonics, *kappa = self->kappa + j * self->harmonics,
                 *phi = self->phi + j * self->harmonics;
    double sum = 0, wave[BLOCK];
    for (int first = 0; first < self->harmonics; first += BLOCK) {
        int n = self->harmonics - first < BLOCK ? self->harmonics - first : BLOCK;
        for (int i = 0; i < n; i++)
            wave[i] = a[first + i] * cosine(kappa[first + i] * xi + phi[first + i]);
        for (int i = 0; i < n; i++)
            sum += wave[i];
    }
    return sum;
}

v3 turbulence_velocity(const turbulence *self, const turbulence_scales *scales, double xi_u,
                       double xi_w)
{
    return v3_make(scales->sigma_u * sum_component(self, 0, xi_u),
                   scales->sigma_w * sum_component(self, 2, xi_w),
                   scales->sigma_u * sum_component(self, 1, xi_u));
}
