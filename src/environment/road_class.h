// The class of a measured road (ISO 8608), from its heights.
#ifndef LD_ENVIRONMENT_ROAD_CLASS_H
#define LD_ENVIRONMENT_ROAD_CLASS_H

#include <stddef.h>

#include "launchdyn/status.h"

typedef struct road_estimate {
    double from, to;              // [1/m] of the fit
    double density;               // [m3] G_d at n0 = 0.1/m; NaN: the heights do not report
    double factor;                // 95 % interval: from density/factor to density*factor
    int lowest, nearest, highest; // of density and that interval's ends, 0: A
} road_estimate;

// Heights [m] of a road, `step` [m] apart, and the inverse wavelengths [1/m] that they are known to
// have.
typedef struct road_record {
    size_t count;
    double step;
    const double *height;
    double from, to;
} road_record;

// Class (0: A to 7: H) whose bounds, twice and half its mean G_d(n0), hold a density [m3].
int road_class_of(double density);

// Fits G_d(n0) (n0/n)^2 to the heights: the mean of ln G_d (n/n0)^2 over thirds of octaves of what
// the heights are known to have and segments of them resolve, 0.011 to 2.83/m at most.
ld_status road_classify(const road_record *record, road_estimate *estimate, ld_error *error);

#endif
