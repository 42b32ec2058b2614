// Wind: velocity of the air against the ground, by profile and gusts (model.md, section 8).
#ifndef LD_ENVIRONMENT_WIND_H
#define LD_ENVIRONMENT_WIND_H

#include <stdbool.h>

#include "math/curves/curves.h"
#include "math/vec3.h"
#include "model/blocks/environment.h"
#include "model/blocks/limits.h"

enum { WIND_FUNCTIONS = 2 }; // of a profile: along x and z

typedef struct wind {
    bool present;
    bool geographic; // axes north, up, east and heights above the ellipsoid; else axes of I and
                     // heights above ground
    bool has_profile;
    v3 steady; // [m/s] without profile: scaled speed; with it: what is added
    double scale;
    curves profile; // along x and z
    int gust_count;
    ld_gust gust[LD_MAX_GUSTS];
} wind;

ld_status wind_build(wind *self, const ld_wind *model, ld_error *error);
void wind_free(wind *self);

// Velocity of the air [m/s] in the wind's axes at time t and height [m].
v3 wind_at(const wind *self, double t, double height);

// What the gusts make of the wind without them.
v3 wind_add_gusts(const wind *self, double t, v3 steady);

// The next corner of a gust after t, where the wind is not smooth in time; infinity without.
double wind_next_corner(const wind *self, double t);

#endif
