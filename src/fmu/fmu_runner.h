// What an instance of an FMU runs over the simulation of its scenario, whatever it is: begun, given
// inputs, taken forward, asked, saved, loaded.
#ifndef LD_FMU_FMU_RUNNER_H
#define LD_FMU_FMU_RUNNER_H

#include <stdbool.h>
#include <stddef.h>

#include "launch/launch_exchange_names.h"
#include "launchdyn/run.h"

enum {
    FMU_FRAME_NUMBERS = 13, // of a ld_base_frame: position, quaternion, velocity, rate
    FMU_WRENCH_NUMBERS = 6, // of a ld_base_wrench: force, moment
    FMU_MOST_NUMBERS = FMU_FRAME_NUMBERS,
};

// Functions return what the library's do.
typedef struct fmu_runner {
    int input_count;  // numbers that it receives from another FMU: a frame's, or none
    int output_count; // that it sends to another one: a wrench's
    bool follows;     // outputs follow what it receives at once, not by its states alone

    // Columns of its rows; the first one is the time.
    size_t (*columns)(const ld_simulation *simulation, const ld_column **columns);
    // NULL after a failure. `told` holds at the start; a number in it that is NaN becomes what it
    // is then on its own.
    void *(*begin)(const ld_simulation *simulation, double *inputs, ld_error *error);
    void (*end)(void *run);
    double (*time)(const void *run); // [s] on its own clock
    bool (*is_finished)(const void *run);

    // At the present: what it receives; the waiting rocket ignited at t (infinity: not until then;
    // NULL: it has none).
    ld_status (*set_inputs)(void *run, const double *inputs, ld_error *error);
    ld_status (*ignite)(void *run, double t, ld_error *error);

    ld_status (*get_outputs)(void *run, double *numbers, ld_error *error);
    ld_status (*get_row)(void *run, double *values, ld_error *error);
    const ld_summary *(*summary)(const void *run); // so far; NULL: it has none

    // To time t [s]; or to the next event that an importer wants to hear of, where one comes
    // before.
    ld_status (*advance)(void *run, double t, ld_error *error);
    ld_status (*advance_to_event)(void *run, double t, bool *found, ld_error *error);

    // As ld_run_save() and ld_run_load().
    ld_status (*save)(void *run, void *bytes, size_t capacity, size_t *size, ld_error *error);
    void *(*load)(const ld_simulation *simulation, const void *bytes, size_t size, ld_error *error);

    const struct fmu_exchanging *exchanging; // model exchange
} fmu_runner;

// As those above, of a run whose steps an importer takes (launch/launch_exchange.h says what each
// does); `check`: whether there can be one, NULL: always.
typedef struct fmu_exchanging {
    ld_status (*check)(const ld_simulation *simulation, ld_error *error);
    void *(*begin)(const ld_simulation *simulation, double *inputs, ld_error *error);
    void *(*load)(const ld_simulation *simulation, const void *bytes, size_t size, ld_error *error);
    int (*states)(const void *run);
    int (*indicators)(const void *run);
    exchange_quantity (*state)(const void *run, int i);
    exchange_quantity (*indicator)(const void *run, int i);
    void (*nominals)(const void *run, double *nominal);
    ld_status (*set_state)(void *run, double t, const double *x, const double *inputs,
                           ld_error *error);
    void (*get_state)(void *run, double *x);
    ld_status (*rates)(void *run, double *rate, ld_error *error);
    ld_status (*values)(void *run, double *indicator, ld_error *error);
    double (*next)(const void *run);
    ld_status (*accept)(void *run, bool *happens, ld_error *error);
    ld_status (*pass_events)(void *run, bool *happened, ld_error *error);
} fmu_exchanging;

// A launch on a base that continues its own, and on an externally driven one; a vehicle alone.
extern const fmu_runner fmu_launch, fmu_launch_external, fmu_vehicle;

#endif
