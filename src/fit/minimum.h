// The minimum of a least-squares problem, from several starts, and what surrounds it: covariance,
// directions that the data tell, profiles.
#ifndef LD_FIT_MINIMUM_H
#define LD_FIT_MINIMUM_H

#include <stdint.h>

#include "fit/marquardt.h"

enum { FIT_MOST_STARTS = 1000 };

// Where one start ended; NaN: there is no launch at it.
typedef struct fit_start {
    double from[FIT_MOST_KEYS], to[FIT_MOST_KEYS], chi2;
} fit_start;

// How chi2 rises along a key, minimised over the others: where a profile went.
enum { FIT_MOST_TRACE = 64 };
typedef struct fit_trace {
    int count;
    double p[FIT_MOST_TRACE], rise[FIT_MOST_TRACE]; // [count] unsorted
} fit_trace;

typedef struct fit_minimum {
    fit_point best;               // its rows are to be freed
    bool at_bound[FIT_MOST_KEYS]; // held there: the rows would fall on beyond it
    double step[FIT_MOST_KEYS];   // of the differences: a third of the standard deviation
    bool singular;                // rows and priors leave a direction untold
    // Of the keys off their bounds, by rows of FIT_MOST_KEYS; NaN of the others and where singular.
    double covariance[FIT_MOST_KEYS * FIT_MOST_KEYS];
    // Of the derivatives of the data alone, by all keys: how many standard deviations the rows
    // change along a unit of the cube, the largest first, and the directions, of length 1.
    double singular_value[FIT_MOST_KEYS], direction[FIT_MOST_KEYS][FIT_MOST_KEYS];
    fit_trace trace[FIT_MOST_KEYS]; // of the latest profile of each key
    int starts;
    fit_start *start; // [starts], to be freed
} fit_minimum;

// Whether each key changes no row at all, between a quarter and three quarters of its width.
ld_status fit_find_idle(const fit_problem *problem, const double *p, bool *idle, ld_error *error);

// The lowest minimum from `starts` points: first[keys], then random ones, functions of the seed and
// of the keys' streams.
// @param minimum to be freed in any case
// @return LD_OK; LD_ERR_LAUNCH, there is no launch at any start; or what evaluate() returned
ld_status fit_minimise(const fit_problem *problem, int starts, const double *first, uint64_t seed,
                       const uint64_t *stream, fit_minimum *minimum, ld_error *error);
void fit_minimum_free(fit_minimum *minimum);

// Minimises again from the best point, the rows having got other weights.
ld_status fit_minimise_again(const fit_problem *problem, fit_minimum *minimum, ld_error *error);

// An end of the interval of a key in which the minimum over the other keys rises by at most z^2.
typedef struct fit_end {
    double p;
    bool open; // it does not rise so far up to the bound, where p is, or up to where launches end
} fit_end;

// Both ends, the lower first. *lower: a minimum below the one known was found: *minimum has moved
// there, and what was found of others is void.
ld_status fit_profile(const fit_problem *problem, fit_minimum *minimum, int key, double z,
                      fit_end end[2], bool *lower, ld_error *error);

#endif
