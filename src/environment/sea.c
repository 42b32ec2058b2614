#include "environment/sea.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "math/functions.h"

static const double TWO_PI = 6.283185307179586476925286766559;

// The waves' frequencies lie between these, in those of the peak.
static const double LOWEST = 0.5, HIGHEST = 10;

// Pierson-Moskowitz' spectrum over x = omega/omega_p, its integral 1: 5 x^-5 exp(-5/4 x^-4); times
// peakedness^exp(-(x - 1)^2/(2 s^2)), s = 0.07 below the peak and 0.09 above, JONSWAP's before it
// is scaled (Hasselmann et al., 1973).
static double shape(const ld_sea *model, double x)
{
    double x4 = x * x * x * x, s = x < 1 ? 0.07 : 0.09;
    double calm = 5 / (x * x4) * exp(-1.25 / x4);
    if (model->spectrum == LD_SEA_PIERSON_MOSKOWITZ)
        return calm;
    return calm * pow(model->peakedness, exp(-(x - 1) * (x - 1) / (2 * s * s)));
}

// Integral of the shape over dx, by Simpson's rule in log x.
static double shape_between(const ld_sea *model, double from, double to, int pieces)
{
    double sum = 0, step = log(to / from) / pieces;
    for (int i = 0; i <= pieces; i++) {
        double x = from * exp(i * step);
        sum += (i == 0 || i == pieces ? 1 : i % 2 ? 4 : 2) * x * shape(model, x);
    }
    return sum * step / 3;
}

enum { PIECES = 2000 };

// The angle off the mean heading below which the share u of cos^2s(angle/2) lies: sin(angle/2) has
// the symmetric distribution whose square is that of Beta(1/2, s + 1/2).
static double spread_angle(double s, double u)
{
    double wanted = fabs(2 * u - 1), low = 0, high = 1;
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (beta_cumulative(0.5, s + 0.5, middle * middle) < wanted)
            low = middle;
        else
            high = middle;
    }
    return copysign(2 * asin(low), u - 0.5);
}

// Cells equal in log omega, omega log-uniform in its cell, a^2/2 the power in the cell.
static void draw_waves(const ld_sea *model, sea_wave *waves)
{
    uint64_t seed = (uint64_t)model->seed, frequencies = random_stream("sea.frequency"),
             phases = random_stream("sea.phase"), headings = random_stream("sea.heading");
    double cell = log(HIGHEST / LOWEST) / model->waves, power = 0;
    int pieces = 2 * (1 + PIECES / 2 / model->waves);
    for (int i = 0; i < model->waves; i++) {
        uint64_t at = (uint64_t)i;
        double from = LOWEST * exp(i * cell);
        double square = shape_between(model, from, LOWEST * exp((i + 1) * cell), pieces);
        power += square;
        waves[i].amplitude = sqrt(2 * square);
        waves[i].omega =
            TWO_PI / model->period * from * exp(cell * random_uniform(seed, frequencies, at, 0, 0));
        waves[i].phase = TWO_PI * random_uniform(seed, phases, at, 0, 0);
        waves[i].heading = model->heading;
        if (isfinite(model->spreading))
            waves[i].heading +=
                spread_angle(model->spreading, random_uniform(seed, headings, at, 0, 0));
    }
    for (int i = 0; i < model->waves; i++)
        waves[i].amplitude *= 0.25 * model->height / sqrt(power);
}

ld_status sea_build(const ld_sea *model, sea_wave **waves, size_t *count, ld_error *error)
{
    *count = model->spectrum == LD_SEA_REGULAR ? 1 : (size_t)model->waves;
    *waves = malloc(*count * sizeof **waves);
    if (!*waves)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the sea");
    if (model->spectrum == LD_SEA_REGULAR)
        **waves = (sea_wave){model->height / 2, TWO_PI / model->period, model->heading, 0};
    else
        draw_waves(model, *waves);
    return LD_OK;
}

double sea_encounter(const sea_wave *wave, const double velocity[3], double gravity)
{
    double along = velocity[0] * cos(wave->heading) + velocity[2] * sin(wave->heading);
    return wave->omega - wave->omega * wave->omega / gravity * along;
}
