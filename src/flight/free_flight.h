// The free flight of one rocket in time: from a state of systems/flight/flight.h to the ground.
#ifndef LD_FLIGHT_FREE_FLIGHT_H
#define LD_FLIGHT_FREE_FLIGHT_H

#include "flight/descent.h"
#include "integration/dormand_prince.h"
#include "quantities/measuring.h"
#include "quantities/quantity_table.h"
#include "quantities/summary.h"
#include "systems/flight/flight.h"
#include "systems/flight/line.h"

// What is to be flown; the caller keeps what it points to.
typedef struct free_flight {
    const flight_system *system;
    const ld_model *model; // run.flight_tolerance, output_step_flight, flight_limit, measures
    const measure_plans *measure; //
    double t_ignition;            // [s] on the run's clock, as all times here
    double t_start;
    double t_end;    // infinity: to the ground
    double launch_x; // [m] launch point in I
    double launch_z;
    v3 container; // [m] of the rocket's line, in I, as of line_setting are the next
    line_bridle (*carried)(const void *carrier, double t);
    const void *carrier;
    line_break broken;             // of the line, before
    const ld_run_options *options; // its progress is called; may be NULL
    // Called for each row of the history (at the output steps, the start, key instants and the
    // end); may be NULL.
    ld_status (*row)(void *self, const flight_phase *phase, double t, const double *state,
                     ld_error *error);
    void *self;
} free_flight;

// Flies from `state` (which it leaves at the end); fills `flight`, `final` and the measures of the
// flight of the rocket, adds to the summary's statistics and warnings.
// @return LD_OK, LD_ERR_LAUNCH (begins below ground, beyond the aerodynamic table, does not land),
//         LD_ERR_NUMERIC, LD_ERR_INTERRUPTED, LD_ERR_MEMORY, or what `row` returned
ld_status free_flight_run(const free_flight *self, double state[FLIGHT_STATES],
                          ld_rocket_summary *rocket, ld_summary *summary, ld_error *error);

// The phase in which a flight begins at t.
flight_phase free_flight_phase(const flight_system *system, double t_ignition, double t);

// ---- step by step, alone or beside others

typedef struct flight_run {
    const free_flight *job;
    flight_phase phase;
    dormand_prince steps;
    flight_line *line; // that the rocket pulls; NULL: none
    ld_rocket_summary *rocket;
    ld_summary *summary;
    ld_error *error;
    double next_output, last_row, output_from;
    int64_t output_index;
    double next_progress;
    double next_check;       // [steps]
    double apogee, t_apogee; // [m] as flight_height counts, [s]; NaN at the end: it rises still
    flight_extremes extremes;
    double t_beyond;   // when the Mach number first went past the table's last; NaN: not
    double t_tumbling; // when the angle of attack first passed 90 degrees; NaN: not
    double last_time;  // the end of the last step
    double t_limit;
    bool burnt_out, past_apex, landed; // in this flight
    bool topped;                       // ended at its highest point
    double t_topped;                   // when a step was ended there; NaN: none was
    double t_open[LD_MAX_PARACHUTES];  // NaN: not triggered yet
    bool opened[LD_MAX_PARACHUTES];
    int canopy;               // the parachute below whose canopy it flies, -1: none
    descent descent;          // of it
    double t_full, area;      // when the one that fills is full [s], infinity: none does; then [m2]
    quantity_columns columns; // where something is measured
    measure_window window[LD_MAX_TAKEN];
} flight_run;

// Begins a flight from `state`; what the run is given stays where it is until its end.
ld_status flight_run_begin(flight_run *self, const free_flight *job, const double *state,
                           ld_rocket_summary *rocket, ld_summary *summary, ld_error *error);

// Whether there are steps to come.
bool flight_run_continues(const flight_run *self);

// One of them.
ld_status flight_run_step(flight_run *self);

// After a step of `steps`, or where there was none available: what happened in it. It must be asked
// where the step ended at its stop, or flight_watch says so, or so many steps as `next_check` are
// done. seen: flight_watch has said so.
ld_status flight_run_examine(flight_run *self, bool seen);

// Fills what free_flight_run fills; the state at the end.
void flight_run_end(flight_run *self, ld_status status, double *state);

#endif
