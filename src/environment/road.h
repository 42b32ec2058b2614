// The road under the wheels: height and slope of two tracks over the distance (model.md, section
// 7).
#ifndef LD_ENVIRONMENT_ROAD_H
#define LD_ENVIRONMENT_ROAD_H

#include <stddef.h>

#include "launchdyn/status.h"
#include "model/blocks/road.h"

typedef enum road_track { ROAD_LEFT, ROAD_RIGHT, ROAD_TRACKS } road_track;

typedef struct road road;

// Builds the road from the model (kept by reference); between x0 and x1 [m] its random part is
// tabulated (to rounding), outside it is summed harmonic by harmonic.
ld_status road_build(const ld_road *model, double x0, double x1, road **out, ld_error *error);
// The same in the place of a road that is used no more, or NULL: takes over its table where that is
// the same to the bit. *self becomes NULL where it fails.
ld_status road_renew(road **self, const ld_road *model, double x0, double x1, ld_error *error);
void road_free(road *self);

// Height h(x) [m] and slope h'(x) of a track at x [m] of I; slope may be NULL.
double road_height(const road *self, road_track track, double x, double *slope);

// How much of the right track's height, and of the left one's the rest, is that at z [m] in chassis
// axes: linear between the tracks' places; where these are not given, that of the side.
double road_right_share(const ld_road *model, double z);

// Height and slope, as above, where the right track has a share of 0 to 1.
static inline double road_height_between(const road *self, double right, double x, double *slope)
{
    if (right == 0)
        return road_height(self, ROAD_LEFT, x, slope);
    if (right == 1)
        return road_height(self, ROAD_RIGHT, x, slope);
    double h_left, h_right, left_slope, right_slope;
    h_left = road_height(self, ROAD_LEFT, x, &left_slope);
    h_right = road_height(self, ROAD_RIGHT, x, &right_slope);
    *slope = (1 - right) * left_slope + right * right_slope;
    return (1 - right) * h_left + right * h_right;
}

// A sine of the road, random or given: how often it comes [1/m], its mean square [m2] on each
// track, and how much of the right track's is the left one's (from 0, independent, to 1, the same).
typedef struct road_line {
    double n, square, shared;
} road_line;

// All sines of a road, as a spectrum; bumps and profiles are not in it. *lines is to be freed.
ld_status road_lines(const ld_road *model, road_line **lines, size_t *count, ld_error *error);

// Density [m3] of the random part at n [1/m], 0 beyond its wavelengths, and how much is shared.
double road_density(const ld_road *model, double n, double *shared);

// The places from + i step [m], i < count.
typedef struct road_places {
    double from, step;
    size_t count;
} road_places;

// Heights [m] there.
ld_status road_profile(const road *self, road_track track, const road_places *places,
                       double *height, ld_error *error);

// Power spectral density G_d(n) [m3] of a class (0: A) at n [1/m] (ISO 8608, class means).
double road_class_density(int iso_class, double n);

#endif
