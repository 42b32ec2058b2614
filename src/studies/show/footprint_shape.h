// The form of a footprint: polygons with holes, in metres from the launch point or on the Earth.
#ifndef LD_STUDIES_FOOTPRINT_SHAPE_H
#define LD_STUDIES_FOOTPRINT_SHAPE_H

#include "environment/earth.h"
#include "studies/points/footprint.h"

// A closed line, its first corner not repeated: counter-clockwise an outline, else a hole.
typedef struct footprint_line {
    double (*at)[2]; // [count]
    size_t count;
    bool hole; // of the outline before it
} footprint_line;

// Polygons: outlines, each followed by its holes.
typedef struct footprint_shape {
    footprint_line *line; // [count]
    size_t count;
} footprint_shape;

// The contour of region `index`: x and y [m] from the launch point.
// @return LD_OK, LD_ERR_MEMORY
ld_status footprint_shape_of(const footprint *of, int index, footprint_shape *shape);
void footprint_shape_free(footprint_shape *shape);

// Where footprints lie on the Earth: with the launch point at the scenario's site.
typedef struct footprint_site {
    bool tangent; // a flat Earth, laid as a tangent plane on the WGS 84 ellipsoid
    earth globe;
    double ground;   // [m] altitude where rockets land
    double place[2]; // longitude, latitude [deg] of the site
} footprint_site;

// Whether the model says where on the Earth it is; fills the site.
// @return LD_OK, LD_ERR_MEMORY
ld_status footprint_site_of(const ld_model *model, footprint_site *site, bool *there);

// The same shape as longitude and latitude [deg], seen from above: longitudes from -180 to 180,
// polygons that cross the antimeridian cut there (RFC 7946, 3.1.9).
// @return LD_OK, LD_ERR_MEMORY, LD_ERR_INPUT (it goes round a pole, or lies beyond the horizon)
ld_status footprint_shape_on_earth(const footprint_site *site, const footprint_shape *flat,
                                   footprint_shape *shape, ld_error *error);

#endif
