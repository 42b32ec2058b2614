// Random options of a stabiliser, each in about half of them.
#ifndef LD_TESTS_SUPPORT_STABILISER_OPTIONS_H
#define LD_TESTS_SUPPORT_STABILISER_OPTIONS_H

#include <stdbool.h>

#include "model/blocks/stabiliser.h"
#include "support/draw.h"

// Its logarithm is uniform.
static inline double draw_size(uint64_t *seed, double low, double high)
{
    return low * pow(high / low, 0.5 * (1 + draw(seed)));
}

static inline void draw_computer(uint64_t *seed, ld_stabiliser *s)
{
    s->sample = draw_size(seed, 2e-4, 1e-2);
    s->delay = draw(seed) > 0 ? 0.5 * (1 + draw(seed)) * s->sample : 0;
    if (draw(seed) > 0)
        s->noise = (ld_sensor_noise){draw_size(seed, 1e-6, 1e-4), draw_size(seed, 1e-4, 1e-2), 3};
    if (draw(seed) > 0)
        s->resolution = (ld_resolution){draw_size(seed, 1e-6, 1e-4), draw_size(seed, 1e-4, 1e-2)};
}

static inline void draw_stabiliser_options(uint64_t *seed, ld_stabiliser *s)
{
    if (draw(seed) > 0)
        s->feedforward = 0.5 * (1 + draw(seed));
    if (draw(seed) > 0)
        s->cascade = (ld_cascade){true, draw_size(seed, 3, 30), draw_size(seed, 1e5, 1e6),
                                  draw(seed) > 0 ? draw_size(seed, 1e4, 3e6) : 0};
    if (draw(seed) > 0) {
        s->bandwidth = draw_size(seed, 5, 300);
        s->slew = draw(seed) > 0 ? draw_size(seed, 1e5, 1e7) : 0;
    }
    if (draw(seed) > 0)
        draw_computer(seed, s);
    if (draw(seed) > 0)
        s->gear =
            (ld_gear){true, draw_size(seed, 1e7, 1e9), draw_size(seed, 1e3, 1e5),
                      draw_size(seed, 30, 1000), draw(seed) > 0 ? draw_size(seed, 1e-5, 2e-3) : 0};
}

#endif
