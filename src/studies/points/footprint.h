// Footprints, for range safety: the regions in which 95, 99 and 99.9 % of landings lie, or of what
// lies of a line.
#ifndef LD_STUDIES_FOOTPRINT_H
#define LD_STUDIES_FOOTPRINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "studies/statistics/density.h"
#include "studies/statistics/statistics.h"
#include "studies/store/study_data.h"

enum { FOOTPRINT_SHARES = 3 }; // 95, 99, 99.9 %

// Of what: landing points; places of the line at equal parts of its length.
typedef enum footprint_kind { FOOTPRINT_LANDINGS, FOOTPRINT_LINE, FOOTPRINT_KINDS } footprint_kind;

typedef ld_study_footprint footprint_region;

typedef struct footprint {
    size_t count; // landings, or places
    bool on_line; // they lie on one line, or there are fewer than three: no footprint
    density_map map;
    footprint_region region[FOOTPRINT_SHARES];
    estimate level[FOOTPRINT_SHARES]; // of the density at the edge
} footprint;

// Landings [count] with finite values, in the order of their groups, which rise; x and y [m] from
// the launch point. Every third group draws the density (density.h), the others rank: the edge is
// the contour at a quantile of the density at their landings. To it they are as new as any further
// landing. So, whatever the distribution, the share outside is that below an order statistic of n
// independent landings, of a beta distribution (S. S. Wilks, Ann. Math. Stat. 12, 1941). Of
// landings in groups n is the effective number of the cloud (normality_of()) or of the tail
// (tail_quantile_of()), whichever is less.
// @return LD_OK, LD_ERR_MEMORY
ld_status footprint_of(const double *x, const double *y, const int64_t *group, size_t count,
                       footprint *result);

// The same of downrange and drift as they are read (study_data_read()).
ld_status footprint_of_values(const study_values *values, footprint *result);

// The same of a point's rockets, which are read; on_line where the study has none of the kind. Of a
// line all its places, x and z of I: those of one line count as one group.
ld_status footprint_read(const study_data *data, const study_point *point, footprint_kind kind,
                         study_values *values, footprint *result, ld_error *error);

// Why a region is not stated.
void footprint_why_not(footprint_kind kind, const footprint_region *region, char text[128]);

// A place on the edge, x and y [m] from the launch point, from nodes of the map.
void footprint_place(const footprint *of, const double node[2], double place[2]);

#endif
