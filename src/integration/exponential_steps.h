// Long steps of error-controlled size for a launcher that moves little: exponential ones
// (math/matrices/exponential.h), with the Jacobian of where they began as their linear part. What
// they cannot do, an event, an instant off their grid, a stretch too rough for them, they refuse;
// then an explicit integrator continues to an instant that they name.
#ifndef LD_INTEGRATION_EXPONENTIAL_STEPS_H
#define LD_INTEGRATION_EXPONENTIAL_STEPS_H

#include "integration/integrator.h"

typedef struct exponential_steps exponential_steps;

enum { EXPONENTIAL_STEPS_KINDS = 3 };

typedef struct exponential_steps_settings {
    const integrator_settings *equations; // rhs, project, events and tolerances (copied)
    const int
        *block; // [n] which states have their Jacobian in common, as in math/matrices/exponential.h
    int block_count;
    double row; // [s] sizes are this by powers of two
    // rates of a motion like the present one, y_dot at y, in which the equations hardly change: [n]
    void (*drift)(double t, const double *y, const double *y_dot, double *drift, void *self);
} exponential_steps_settings;

typedef enum exponential_outcome {
    EXPONENTIAL_STEPPED,
    EXPONENTIAL_STOPPED, // landed on t_stop
    EXPONENTIAL_REFUSED, // nothing done: explicit steps until exponential_steps_resume()
} exponential_outcome;

// LD_ERR_MEMORY. *out stays as it is where it fails.
ld_status exponential_steps_create(const exponential_steps_settings *settings,
                                   exponential_steps **out, ld_error *error);
void exponential_steps_free(exponential_steps *self);

// The instants of steps count from t on.
void exponential_steps_count_from(exponential_steps *self, double t);
// The equations are those of a kind from now on: each has its Jacobian, kept for when it comes
// again, though another tube may have taken the place of that of before. LD_ERR_MEMORY, where it is
// new.
ld_status exponential_steps_take(exponential_steps *self, int kind, ld_error *error);
// Continues from (t, y); the equations may be others than before.
void exponential_steps_start(exponential_steps *self, double t, const double *y);

// One step, not beyond t_stop.
exponential_outcome exponential_steps_step(exponential_steps *self, double t_stop);
double exponential_steps_resume(const exponential_steps *self);

double exponential_steps_time(const exponential_steps *self);
double exponential_steps_previous_time(const exponential_steps *self);
const double *exponential_steps_state(const exponential_steps *self);
// State where the last step began, and at a time within it.
const double *exponential_steps_previous(const exponential_steps *self);
void exponential_steps_interpolate(exponential_steps *self, double t, double *y);

int64_t exponential_steps_count(const exponential_steps *self);
int64_t exponential_steps_evaluations(const exponential_steps *self);

// As integrator_archive.
void exponential_steps_archive(exponential_steps *self, archive *bytes);

#endif
