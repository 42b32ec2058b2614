// One run of a launch: its state, who listens, and what its loop, rows, events, limits, summary and
// flights keep.
#ifndef LD_LAUNCH_LAUNCH_RUN_H
#define LD_LAUNCH_LAUNCH_RUN_H

#include "launchdyn/run.h"
#include "quantities/measuring.h"
#include "state/stepping/propagator.h"
#include "systems/flight/flight.h"

// At one instant.
enum {
    MOST_EVENTS = LD_MAX_ADAPTORS * (1 + LD_MAX_SURFACES) + LD_MAX_WHEELS +
                  LD_SLIDE_STOPS * LD_MAX_SUPPORTS + 8
};

// Of a hinge's error, torque and power since the ignition, for its means.
typedef struct hinge_watch {
    double since; // [s] until when; NaN: not yet begun
    double latest[4], sum[4];
} hinge_watch;

// A start that is given in place of the scenario's: the state at the run's first instant, what its
// base keeps of the equilibrium, the road of a vehicle.
typedef struct launch_start {
    double y[LD_MAX_STATES];
    base_rest rest;
    bool on_breech;
    road *road;
} launch_start;

// What a run keeps of how far the errors of its steps have come.
typedef struct exit_error exit_error;

struct ld_run {
    launch_state launch;
    const launch_start *start; // NULL: the scenario's
    ld_run_options options;    // who listens
    ld_summary summary;        // so far
    ld_status status;          // what ended the run early, with its sentence
    ld_error error;
    ld_error archived; // why what the base has besides its state could not be saved or loaded
    propagator *propagator;
    exit_error *exit_error; // NULL: not estimated
    base_frame reported;    // frame T at the start, of an externally driven base
    // where it was given last [s], and its state before that: set again there it was not reported
    // before
    double reported_at, before_driven[BASE_MOST_STATES];

    bool outside; // whoever asks takes the steps (launch_exchange.h)
    double t;     // [s] the present
    bool ahead;   // a step ends later than the present: what happens at its end has not
    integrator_outcome outcome;      // of that step
    double t_input;                  // [s] a step ends there, for an input; infinity: none comes
    int event_count, event_reported; // at the present
    ld_event event[MOST_EVENTS];

    double row[LD_MAX_COLUMNS];    // one row of the history
    double between[LD_MAX_STATES]; // state between steps
    double energy_start;           // [J]
    double t_start, t_end;
    double next_output; // time of the next row
    double output_step;
    int64_t output_index; // rows since the last change of the output step
    double output_from;   // where that was
    double last_row;      // time of the last row written
    double next_progress;
    int64_t steps_since_progress;
    bool sink_failed;
    double greatest_lock_force;
    hinge_watch watch[HINGES], drive_watch[LD_MAX_DRIVES];
    double t_rocket;                      // [s] start of the current rocket's instants
    double t_measured;                    // [s] where the last step ended
    measure_window measure[LD_MAX_TAKEN]; // of the rocket that is in its tube
    double point[LD_MAX_FIRINGS][2];      // [m] x and z of the rear adaptors at their ignition
    double container[6];                  // [m], [m/s] in I: of a line, at the exit
    flight_system flight;                 // of the rocket that flies now
    quantity_columns flight_columns;      // its, where rows are requested
    double cpu, cpu_output;               // [s] spent in all; of it on rows and their sink
};

// The state at the present, in which no step need end.
const double *run_present_state(ld_run *run);
bool launch_is_finished(const ld_run *run);
// Keeps what happens at t for whoever asks; `part`: adaptor or wheel, -1: of none.
void launch_record_event(ld_run *run, ld_event_kind kind, double t, int part);

#endif
