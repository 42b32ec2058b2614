// Exponential Runge-Kutta steps for stiff equations y_dot = f(t, y), of which a matrix L takes the
// stiff part: order 4 in the form of Krogstad (J. Comput. Phys. 203, 2005), with an error of order
// 3 by the slope at the step's end. L is any matrix near the Jacobian; where f = L y + c, a step of
// any size is exact. It consists of blocks on the diagonal. States in none of them are integrals of
// the others, on which nothing depends: Simpson's rule.
//
// Steps have the sizes longest / 2^rung, since each requires functions phi of its own:
// phi_k(z) = integral over x from 0 to 1 of exp((1 - x) z) x^(k - 1) / (k - 1)!.
#ifndef LD_MATH_EXPONENTIAL_H
#define LD_MATH_EXPONENTIAL_H

typedef struct exponential exponential;

enum { EXPONENTIAL_NO_BLOCK = -1, EXPONENTIAL_MOST_BLOCKS = 64, EXPONENTIAL_MOST_RUNGS = 6 };

typedef struct exponential_settings {
    int n;            // states
    const int *block; // [n] in which block each is, from 0 on without gaps, or NO_BLOCK (copied)
    int block_count;
    double longest; // step of rung 0
    int rungs;      // rungs 0 to rungs - 1 are taken
    // y_dot at t, y; other than 0: there is none
    int (*f)(double t, const double *y, double *y_dot, void *self);
    void *self;
} exponential_settings;

// NULL: no memory.
exponential *exponential_new(const exponential_settings *settings);
void exponential_free(exponential *self);

// L of a block [count][count] by columns, its states in their order; to be filled before
// exponential_prepare(), which finds its functions for all rungs.
double *exponential_block(exponential *self, int which, int *count);
// Other than 0: L is not finite, or too large.
int exponential_prepare(exponential *self);

double exponential_size(const exponential *self, int rung);

// Where a step begins: y with its slope y_dot, and `drift`, a motion with constant rates in which f
// is the same, e.g. the travel of all there is; L is applied to what moves against it.
typedef struct exponential_start {
    double t;
    const double *y, *y_dot, *drift; // [n]
} exponential_start;

// Where it ends, with the error of y.
typedef struct exponential_end {
    double *y, *y_dot, *error; // [n]
} exponential_end;

// Fills the arrays of the end. Other than 0: f failed.
int exponential_step(exponential *self, int rung, const exponential_start *start,
                     const exponential_end *end);

// What is known within the last step, so that its course can be kept: y, y_dot and drift where it
// began, the remainder's linear and quadratic part over the step.
typedef struct exponential_course {
    int rung;
    double *y, *y_dot, *drift, *linear, *quadratic; // [n]
} exponential_course;

// The course of the last step, or the one that is to be the last step's; its arrays can be written.
exponential_course *exponential_last(exponential *self);
// Where they have been written.
void exponential_forget(exponential *self);

// State at `since` after the beginning of the last step, within it: the remainder being a
// polynomial, exact steps of the finest rung, between them the cubics with the slopes at their
// ends.
void exponential_between(exponential *self, double since, double *y);

#endif
