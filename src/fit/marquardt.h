// Least squares between bounds, from one start: MINPACK's Levenberg-Marquardt (cminpack) on angles
// u with p = (1 + sin u)/2, so that no step leaves the unit cube.
#ifndef LD_FIT_MARQUARDT_H
#define LD_FIT_MARQUARDT_H

#include <stdbool.h>

#include "launchdyn/status.h"

enum { FIT_MOST_KEYS = 32 };

// Residuals of data, each over its standard deviation, as functions of keys p in the unit cube.
typedef struct fit_problem {
    int keys, residuals;
    int steady;                    // keys at the end that all starts have where the first has them
    const double *prior_mean;      // [keys] in the cube
    const double *prior_deviation; // [keys] in the cube; infinite: the key has no prior
    // Computes residuals[count][residuals] at points[count][keys]. there[i] false: there is no
    // launch at point i. Same points, same bits, whatever else is in the call.
    // @return LD_OK, or what ends the fit
    ld_status (*evaluate)(void *self, int count, const double *points, double *residuals,
                          bool *there, ld_error *error);
    // Told what comes next.
    void (*stage)(void *self, const char *text, double chi2);
    void *self;
} fit_problem;

// Residuals of data and priors: a key's prior has the row residuals + key, 0 without a prior.
static inline int fit_rows(const fit_problem *problem)
{
    return problem->residuals + problem->keys;
}

// A point with what was computed there.
typedef struct fit_point {
    bool there;
    double p[FIT_MOST_KEYS];
    double chi2;      // sum of the squared rows
    double *residual; // [fit_rows] the caller's; NULL: not wanted
} fit_point;

// Computes one point.
ld_status fit_point_compute(const fit_problem *problem, fit_point *point, ld_error *error);

// Derivatives of the rows by the free keys, [fit_rows x free] by columns, as forward differences
// into the cube (backward where there is no launch). *there false: neither.
ld_status fit_derivatives(const fit_problem *problem, const double *p, const double *row,
                          const bool *held, const double *step, double *jacobian, bool *there,
                          ld_error *error);

// Minimises from point->p over the keys that are not `always` held; those that come to a bound end
// on it. point->there false: there is no launch at the start, or beside it.
// @param step [keys] of the differences, in the cube
// @param fall relative, of the sum of squares: it ends where a step has and promises less
ld_status marquardt_minimise(const fit_problem *problem, const bool *always, const double *step,
                             double fall, fit_point *point, ld_error *error);

#endif
