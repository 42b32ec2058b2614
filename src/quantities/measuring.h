// Measures as they are taken: of a launch, or of the flight of a rocket, step by step.
#ifndef LD_QUANTITIES_MEASURING_H
#define LD_QUANTITIES_MEASURING_H

#include <stdbool.h>

#include "model/quantity.h"
#include "quantities/expression.h"
#include "quantities/summary.h"

// An instant of a rocket. The start is that of the run, of a later rocket when its tube took the
// place of the one before; the end when the next one's does, of the last that of the launch; in a
// flight that of the flight.
typedef struct measure_instant {
    enum {
        INSTANT_START,
        INSTANT_IGNITION,
        INSTANT_RELEASE,
        INSTANT_EXIT,
        INSTANT_BURNOUT, // from here on of a flight
        INSTANT_APOGEE,
        INSTANT_IMPACT,
        INSTANT_END
    } kind;
    int adaptor; // of an exit
} measure_instant;

// A measure as a simulation takes it, or a figure over time in the expression of one.
typedef struct measure_plan {
    bool flight;          // of a column of the rocket's flight, not of the launch
    int column;           // -1: of several
    expression_part part; // expression of columns; of a measure that is an expression, of results
    ld_take take;
    measure_instant from, to; // of a value the same
    double within[2];         // [s] since `from`
} measure_plan;

// A result that an expression names.
typedef struct measure_result {
    quantity_place where, at;
    int item;
} measure_result;

enum { MEASURE_MOST_RESULTS = 120 };

// The model's measures in their order, then figures over time of their expressions.
typedef struct measure_plans {
    int count, results;
    measure_plan plan[LD_MAX_TAKEN];
    measure_result result[MEASURE_MOST_RESULTS];
    expression_code code;
} measure_plans;

// A measure of one rocket, as far as it has been taken.
typedef struct measure_window {
    bool open, done;
    double t_from; // [s] when its first instant came
    double value;  // of its column where the last step ended; since then after what happened there
    double reference; // what magnitudes count from; NaN: the window has not begun
    double sum;       // integral over the window of the column, for rms of its square
    double peak;      // largest magnitude in it
} measure_window;

// What is measured: columns of a launch, or those of a flight, found at any time of the last step.
typedef struct measuring {
    const measure_plans *plans; // those of the other kind, launch or flight, are passed over
    bool flight;
    measure_window *window;
    double *result; // in SI; stays as it is where its window does not come
    void (*row)(void *self, double t, double *row);
    bool (*has_come)(void *self, measure_instant instant);
    void *self;
} measuring;

enum { MEASURING_MOST_COLUMNS = 1024 };

// Instants are still to come.
void measuring_begin(measure_window *window, int count);
// Whether any is in its window; whether there is any at all.
bool measuring_is_open(const measuring *self);
bool measuring_is_there(const measuring *self);

// Takes the step from `from` to `to`, where the columns are `end` before anything happens; NULL: of
// no interest, since none is open.
void measuring_step(const measuring *self, double from, double to, const double *end);
// What has happened at t, after which the columns are `now`: windows begin and end.
void measuring_instant(const measuring *self, double t, const double *now);
// The last instant, at the end of the last step.
void measuring_end(const measuring *self, double t);
// Computes the expressions from what else is known of the rocket.
void measuring_express(const measure_plans *plans, ld_rocket_summary *rocket);

#endif
