// Explicit Runge-Kutta steps of order 5 with error control for few states: the pair 5(4) of Dormand
// and Prince (J. Comput. Appl. Math. 6, 1980), step sizes by the PI controller of Hairer, Norsett
// and Wanner (Solving Ordinary Differential Equations I, II.4 and IV.2). Between a step's ends a
// polynomial of degree 5, made when it is asked for.
#ifndef LD_SIMULATION_DORMAND_PRINCE_H
#define LD_SIMULATION_DORMAND_PRINCE_H

#include <stdbool.h>
#include <stdint.h>

enum { DORMAND_PRINCE_STATES = 16, DORMAND_PRINCE_STAGES = 7 };

typedef struct dormand_prince {
    // y_dot = f(t, y) of all the states (those not used: 0)
    void (*f)(double t, const double *y, double *y_dot, void *self);
    void *self;
    // error allowed in a step, root mean square over the states that count: absolute + relative |y|
    int count;
    double absolute[DORMAND_PRINCE_STATES], relative[DORMAND_PRINCE_STATES];

    double t;
    double y[DORMAND_PRINCE_STATES];
    double h;     // [s] of the next step; 0: to be found
    double error; // of the last step, for the controller
    double t0;    // where the last step began
    double y0[DORMAND_PRINCE_STATES];
    double k[DORMAND_PRINCE_STAGES][DORMAND_PRINCE_STATES]; // slopes of the last step, the first
                                                            // and the last at its ends
    bool open;                                              // the course between the ends is known
    double course[2][DORMAND_PRINCE_STATES];
    int64_t steps, evaluations;
} dormand_prince;

// (Re)starts at t from y[DORMAND_PRINCE_STATES], whenever the equations have changed.
void dormand_prince_start(dormand_prince *self, double t, const double *y);

// One step of error-controlled size, not beyond t_stop (on which it lands exactly).
// @return false: the step size fell to nothing, or the slopes are not finite
bool dormand_prince_step(dormand_prince *self, double t_stop);

// Takes the last step anew so that it ends at t, within it.
void dormand_prince_retake(dormand_prince *self, double t);

// State at t within the last step.
void dormand_prince_between(dormand_prince *self, double t, double *y);

#endif
