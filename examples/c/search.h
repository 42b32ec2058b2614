// The least value of a function of a few bounded variables under constraints, without derivatives:
// linear approximations on a simplex (COBYLA, M. J. D. Powell 1994) of NLopt.
#ifndef SEARCH_H
#define SEARCH_H

enum { SEARCH_MOST = 16 };

typedef struct search {
    int variables, constraints; // at most SEARCH_MOST of each
    const double *low, *high;   // [variables]
    int evaluations;            // at most so many
    double precision;           // of the variables, of their ranges
    void *self;
    // Finds the value at x and the constraints, which hold where they are not above 0. Other than
    // 0 ends the search.
    int (*evaluate)(void *self, const double *x, double *value, double *constraint);
} search;

// Starts at x and leaves there the best that was found: the least value where all constraints hold,
// where they nowhere do the point that breaks the worst one least.
// Returns what ended it: 0, or what evaluate returned; -1: out of memory or NLopt refuses.
int search_minimum(const search *self, double *x);

#endif
