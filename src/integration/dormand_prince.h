// Explicit Runge-Kutta steps of order 5 with error control for few states: the pair 5(4) of Dormand
// and Prince (J. Comput. Appl. Math. 6, 1980), step sizes by the PI controller of Hairer, Norsett
// and Wanner (Solving Ordinary Differential Equations I, II.4 and IV.2). Between a step's ends a
// polynomial of degree 5, made when it is asked for.
#ifndef LD_INTEGRATION_DORMAND_PRINCE_H
#define LD_INTEGRATION_DORMAND_PRINCE_H

#include <stdbool.h>

// Most states; where not more than the fewer count, the others are left alone.
enum { DORMAND_PRINCE_STATES = 23, DORMAND_PRINCE_FEW = 16, DORMAND_PRINCE_STAGES = 7 };

// y_dot = f(t, y) of all the states (those not used: 0).
typedef void dormand_prince_slopes(const double *t, const double *y, double *y_dot, void *self);

// The numbers of a step, all doubles: lanes keep them side by side (math/real.h).
typedef struct dormand_prince_numbers {
    double t0, size; // [s] where it begins, how long it is
    double error;    // against what is allowed: 1 is just allowed
    double y0[DORMAND_PRINCE_STATES], y[DORMAND_PRINCE_STATES]; // at its ends
    double k[DORMAND_PRINCE_STAGES][DORMAND_PRINCE_STATES];     // slopes, the first and the last
                                                                // at its ends
    // error allowed in a step, root mean square over the states that count: absolute + relative |y|
    double absolute[DORMAND_PRINCE_STATES], relative[DORMAND_PRINCE_STATES];
    double t;          // its end
    double t_stop;     // where it may end at the latest, and then ends exactly
    double h;          // [s] of the next step; 0: to be found
    double log_before; // the logarithm of its error, for the controller
    double most;       // how many times longer the next one may be
    double outcome;    // of the trial, a dormand_prince_outcome
    double steps, evaluations;
} dormand_prince_numbers;

// The least of these logarithms, of 1e-4.
#define DORMAND_PRINCE_LOG_LEAST (-9.2103403719761827)

typedef enum dormand_prince_outcome {
    DORMAND_PRINCE_LOST = -1, // the size fell to nothing, or the slopes are not finite
    DORMAND_PRINCE_REFUSED,   // to be tried again with another size
    DORMAND_PRINCE_DONE,
} dormand_prince_outcome;

typedef struct dormand_prince {
    dormand_prince_slopes *f;
    void *self;
    int count;                   // of the states
    dormand_prince_numbers step; // the last step
    bool open;                   // the course between the ends is known
    double course[2][DORMAND_PRINCE_STATES];
} dormand_prince;

// (Re)starts at t from y[DORMAND_PRINCE_STATES], whenever the equations have changed.
void dormand_prince_start(dormand_prince *self, double t, const double *y);

// One step of error-controlled size, not beyond t_stop (on which it lands exactly).
// @return false: the step size fell to nothing, or the slopes are not finite
bool dormand_prince_step(dormand_prince *self, double t_stop);

// Trials of steps side by side, in a block [DORMAND_PRINCE_NUMBERS][lanes] of 4 or 8 lanes, aligned
// for these, by slopes of as many; `count` states count. Where the last trial's outcome is a step
// that is done the next one begins. Each lane has the bits of one alone. Lanes have the fewer
// states.
enum { DORMAND_PRINCE_NUMBERS = sizeof(dormand_prince_numbers) / sizeof(double) };
void dormand_prince_try_default(double *block, int count, dormand_prince_slopes *f, void *self);
void dormand_prince_try_avx2(double *block, int count, dormand_prince_slopes *f, void *self);
void dormand_prince_try_avx512(double *block, int count, dormand_prince_slopes *f, void *self);

// y at the end of the step of size `size` from y0, with its stages; `count` states count.
void dormand_prince_stages(dormand_prince_numbers *step, int count, dormand_prince_slopes *f,
                           void *self);

// Takes the last step again so that it ends at t, within it.
void dormand_prince_retake(dormand_prince *self, double t);

// State at t within the last step.
void dormand_prince_between(dormand_prince *self, double t, double *y);

#endif
