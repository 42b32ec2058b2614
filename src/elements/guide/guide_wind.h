// Wind on the guide itself (model.md, section 5): cross-flow drag by sections of the guide.
//
// Per length 1/2 rho C d |v_n| v_n at the axis, with v_n the velocity of the air against the axis
// there, less its part along the section's x axis. Each section is cut into panels, at least one a
// bending mode over the guide's length, with Gauss' formula of three points in each.
#ifndef LD_ELEMENTS_GUIDE_WIND_H
#define LD_ELEMENTS_GUIDE_WIND_H

#include "elements/instant.h"

// The part of a section between two stations.
typedef struct wind_panel {
    double from, to;   // [m]
    double half_width; // [m] C d/2
} wind_panel;

typedef struct guide_wind {
    int count;         // 0: the guide feels no wind
    wind_panel *panel; // owned
} guide_wind;

ld_status guide_wind_build(const ld_tubes *tubes, guide_wind *self, ld_error *error);
void guide_wind_free(guide_wind *self);

// Adds it to what acts on the tube, with its power; none where no air is about.
void guide_wind_add(const guide_wind *self, const tube_system *guide, launching_instant *now);

#endif
