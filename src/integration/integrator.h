// The integrator's adapter: explicit Runge-Kutta steps with error control and event location by
// SUNDIALS ARKODE (ERKStep), which stays behind this header.
#ifndef LD_INTEGRATION_INTEGRATOR_H
#define LD_INTEGRATION_INTEGRATOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/archive.h"
#include "integration/step_course.h"
#include "launchdyn/status.h"

typedef struct integrator integrator;

// y_dot = f(t, y); a return value other than 0 ends the integration with LD_ERR_NUMERIC.
typedef int (*integrator_rhs)(double t, const double *y, double *y_dot, void *self);
// Takes out of the state y that a step has reached at t what it has drifted; other than 0 ends the
// integration likewise.
typedef int (*integrator_project)(double t, double *y, void *self);
// g[i] = 0 is event i.
typedef int (*integrator_events)(double t, const double *y, double *g, void *self);

typedef enum integrator_method {
    INTEGRATOR_DORMAND_PRINCE,   // order 5(4), 7 stages, the last one serves the next step
    INTEGRATOR_BOGACKI_SHAMPINE, // order 3(2), 4 stages, likewise
    INTEGRATOR_CASH_KARP,        // order 5(4), 6 stages
    INTEGRATOR_OSCILLATING,      // order 4(3), 6 stages, for oscillations that are hardly damped
} integrator_method;

// Up to this h omega INTEGRATOR_OSCILLATING is stable, up to a tenth of the critical damping.
static const double INTEGRATOR_STABLE_TO = 4.8;

typedef struct integrator_settings {
    size_t n; // states
    integrator_method method;
    double rtol;          // relative tolerance
    const double *atol;   // [n] absolute tolerance of each state (copied)
    const bool *absolute; // [n] states without relative tolerance (copied); NULL: none
    double max_step;      // 0: none
    integrator_rhs rhs;
    integrator_project project; // NULL: none
    integrator_events events;   // NULL: none
    int event_count;
    void *self;          // handed to rhs, project and events
    step_course *course; // NULL: steps of error-controlled size that no one keeps
} integrator_settings;

typedef enum integrator_outcome {
    INTEGRATOR_STEPPED, // one step done, nothing special
    INTEGRATOR_STOPPED, // landed on t_stop
    INTEGRATOR_EVENT,   // landed on an event: integrator_event(i) says which
    INTEGRATOR_FAILED,  // error holds the reason
} integrator_outcome;

ld_status integrator_create(const integrator_settings *settings, integrator **out, ld_error *error);
void integrator_free(integrator *self);

// (Re)starts at t with state y (copied). Call it whenever the equations have changed.
ld_status integrator_start(integrator *self, double t, const double *y, ld_error *error);

// One step of error-controlled size, not beyond t_stop. At an event the step is taken again to end
// on it, so that the state there is a step's end and not an interpolated one. After an event the
// next step starts again, whether integrator_start was called or not.
integrator_outcome integrator_step(integrator *self, double t_stop, ld_error *error);

// Of the step that failed: LD_ERR_NUMERIC, LD_ERR_MEMORY.
ld_status integrator_failure(const integrator *self);

// Takes the last step again so that it ends at t, which lies in it; where error control makes it
// still shorter, before t. INTEGRATOR_STEPPED or _FAILED.
integrator_outcome integrator_return(integrator *self, double t, ld_error *error);

double integrator_time(const integrator *self);
const double *integrator_state(const integrator *self);
// Where the last step began.
double integrator_previous_time(const integrator *self);
// State at a time within the last step (cubic Hermite interpolation).
void integrator_interpolate(integrator *self, double t, double *y);
// 0, or the direction (-1, +1) in which g[i] went through zero at the event just landed on.
int integrator_event(const integrator *self, int i);

// Estimated error of the last step [n], not known before one.
void integrator_error(integrator *self, double *error);

int64_t integrator_steps(const integrator *self);
int64_t integrator_evaluations(const integrator *self);

// Saves all that the steps to come depend on, the last one's interpolation and the counts, or loads
// it into an integrator of the same settings, which then continues with the same bits; one that was
// saved on a stop as after integrator_start there. After a failed load it requires
// integrator_start.
void integrator_archive(integrator *self, archive *bytes);

#endif
