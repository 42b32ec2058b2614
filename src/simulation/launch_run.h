// One run of a launch: its state, who listens, and what its loop, rows, events, limits, summary and
// flights keep.
#ifndef LD_SIMULATION_LAUNCH_RUN_H
#define LD_SIMULATION_LAUNCH_RUN_H

#include "simulation/propagator.h"
#include "systems/flight.h"

typedef struct launch_run {
    launch_state launch;
    const ld_run_options *options; // who listens
    ld_summary *summary;
    ld_error *error;
    propagator *propagator;
    double *row;         // one row of the history
    double *between;     // state between steps
    double energy_start; // [J]
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
    double point[LD_MAX_FIRINGS][2]; // [m] x and z of the rear adaptors at their ignition
    flight_system flight;            // of the rocket that flies now
    int flight_column_count;
    double cpu_output; // [s] spent on rows and their sink
} launch_run;

// ---- rows (launch_rows.c)

// A row at t and state y; one instant gives one row.
ld_status launch_write_row(launch_run *run, double t, const double *y);
// Rows that fell into the last step.
ld_status launch_write_rows(launch_run *run);
// Output instants count from t on, at the step that holds there.
void launch_restart_output(launch_run *run, double t);
// A run that ends early has its last state as its last row.
void launch_write_last_row(launch_run *run);

// ---- events and stops (launch_events.c)

// Switches what the events just located say; true where the equations changed.
bool launch_switch_phase(launch_run *run, double t, const double *y);
// Opens a lock that carries more than its release force without a crossing to be located.
void launch_let_go_at_once(launch_run *run, double t, const double *y);
// When the next tube takes the place of the one that is empty now [s].
double launch_change_instant(const launch_state *self);
// The next instant at which a step must end [s]; at one: what begins there, true where the
// equations change.
double launch_next_stop(const launch_run *run, double t);
bool launch_pass_stop(launch_run *run, double t);

// ---- what ends a run early (launch_limits.c)

ld_status launch_check_tube(launch_run *run, double t, const double *y);
ld_status launch_check_base(launch_run *run, double t);
// After each step; each millisecond the caller hears of it.
ld_status launch_check_step(launch_run *run, double t, const double *y);

// ---- summary (launch_summary.c)

void launch_record_ignition(launch_run *run, double t, const double *y);
void launch_record_exit(launch_run *run, double t, const double *landed);
// Largest contact and slot forces so far.
void launch_watch_forces(launch_run *run, double t, const double *y);
void launch_energy_at(const launch_state *self, double t, const double *y, double energy_start,
                      ld_energy *energy);
void launch_summarise(launch_run *run, ld_status status, double cpu_seconds);

// ---- saving and loading (launch_archive.c)

// All that the run's steps, rows and summary to come depend on, or that the summary holds by now;
// loads into a run of the same model, whose propagator is there. One walk, as in archive.h. After a
// failed load the run can only be ended.
void launch_archive(launch_run *run, archive *bytes);

// ---- flights (launch_flights.c)

// Every rocket that has left its tube flies to the ground, or until the run's end.
ld_status launch_fly_all(launch_run *run);

#endif
