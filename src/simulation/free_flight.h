// The free flight of one rocket in time: from a state of systems/flight.h to the ground.
#ifndef LD_SIMULATION_FREE_FLIGHT_H
#define LD_SIMULATION_FREE_FLIGHT_H

#include "simulation/measures.h"
#include "simulation/summary.h"
#include "systems/flight.h"

// What is to be flown; the caller keeps what it points to.
typedef struct free_flight {
    const flight_system *system;
    const ld_model *model;       // run.flight_tolerance, output_step_flight, flight_limit, measures
    const measure_plan *measure; // [model->measure_count]
    double t_ignition;           // [s] on the run's clock, as all times here
    double t_start;
    double t_end;    // infinity: to the ground
    double launch_x; // [m] launch point in I
    double launch_z;
    const ld_run_options *options; // its progress is called; may be NULL
    // Called for each row of the history (at the output steps, the start, key instants and the
    // end); may be NULL.
    ld_status (*row)(void *self, const flight_phase *phase, double t, const double *state,
                     ld_error *error);
    void *self;
} free_flight;

// Flies from `state` (which it leaves at the end); fills `flight`, `final` and the measures of the
// flight of the rocket, adds to the summary's statistics and notes.
// @return LD_OK, LD_ERR_LAUNCH (begins below ground, beyond the aerodynamic table, does not land),
//         LD_ERR_NUMERIC, LD_ERR_INTERRUPTED, LD_ERR_MEMORY, or what `row` returned
ld_status free_flight_run(const free_flight *self, double state[FLIGHT_STATES],
                          ld_rocket_summary *rocket, ld_summary *summary, ld_error *error);

// The phase in which a flight begins at t.
flight_phase free_flight_phase(const flight_system *system, double t_ignition, double t);

// History of a flight: columns, to be freed, and the values of a row.
enum { FLIGHT_MAX_COLUMNS = 64 };
ld_status flight_columns(const flight_system *system, quantity_columns *columns, ld_error *error);
void flight_row(const flight_system *system, const quantity_columns *columns,
                const flight_phase *phase, double t, const double *state,
                double row[FLIGHT_MAX_COLUMNS]);

#endif
