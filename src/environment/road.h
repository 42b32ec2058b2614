// The road under the wheels: height and slope of two tracks over the distance (model.md, section
// 7).
#ifndef LD_ENVIRONMENT_ROAD_H
#define LD_ENVIRONMENT_ROAD_H

#include "launchdyn/model.h"

typedef enum road_track { ROAD_LEFT, ROAD_RIGHT, ROAD_TRACKS } road_track;

typedef struct road road;

// Builds the road; between x0 and x1 [m] its random part is tabulated (to rounding), outside it is
// summed harmonic by harmonic.
ld_status road_build(const ld_road *model, double x0, double x1, road **out, ld_error *error);
void road_free(road *self);

// Height h(x) [m] and slope h'(x) of a track at x [m] of I.
double road_height(const road *self, road_track track, double x, double *slope);

#endif
