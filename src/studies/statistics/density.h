// Where most of a cloud of points lies, of whatever form: contours of its density.
#ifndef LD_STUDIES_DENSITY_H
#define LD_STUDIES_DENSITY_H

#include <stddef.h>

#include "launchdyn/status.h"

enum { DENSITY_GRID = 64, DENSITY_LEVELS = 2 };

// The shares of the points that lie within the contours: 50 % and 95 %.
extern const double density_share[DENSITY_LEVELS];

// A cloud's density on a grid along its main axes: node i, j lies at origin + i step[0] + j
// step[1].
typedef struct density_map {
    double origin[2], step[2][2];
    double value[DENSITY_GRID][DENSITY_GRID]; // [i][j] points a cell
    double level[DENSITY_LEVELS];             // of the contours
} density_map;

// Gaussian kernels in the axes in which the cloud has the covariance 1, as wide as n^(-1/6) (D. W.
// Scott, Multivariate density estimation, 1992), where n is `effective`: points that come in groups
// tell as much as so many independent ones (normality_of()). A level is the density that a share of
// the points have at least (R. J. Hyndman, Am. Stat. 50, 1996). 0 at the edge of the grid, some
// kernels away from all points. Points [count] with finite values, not on one line.
// @return LD_OK, LD_ERR_MEMORY
ld_status density_of(const double *x, const double *y, size_t count, double effective,
                     density_map *map);

// The density at a place, linear between nodes along both axes; 0 beside the grid.
double density_at(const density_map *map, double x, double y);

// Takes a closed line of a contour, its corners in nodes: {i, j}. What is denser lies at the left
// of the way from the first axis of the map to the second: outlines have a positive area, holes a
// negative one.
typedef void density_sink(void *self, double (*corner)[2], size_t count);

// The contour of a level above 0, line by line: straight through each cell of the grid (marching
// squares); where it may run either way, what is denser is joined.
// @return LD_OK, LD_ERR_MEMORY
ld_status density_contour(const density_map *map, double level, density_sink *take, void *self);

#endif
