// The system of a simulation: what is computed once from the model and then stays as it is, so that
// several runs may go on over one, each on its own thread.
#ifndef LD_SIMULATION_SIMULATION_H
#define LD_SIMULATION_SIMULATION_H

#include "elements/motor.h"
#include "quantities/measures.h"
#include "quantities/quantity_table.h"
#include "quantities/summary.h"
#include "systems/flight/flight.h"
#include "systems/launching/launcher.h"

enum { LD_MAX_COLUMNS = 1024 };

// CPU time of the process [s].
double simulation_cpu_now(void);

struct ld_simulation {
    const ld_model *model;
    launcher_system launcher;       // with the first rocket in its tube
    motor motor_of[LD_MAX_FIRINGS]; // of each firing where the rockets of a salvo differ, else one
    int motor_count;
    flight_system flight; // of a flight alone
    // of each firing, where the launch asks what its rocket flies in; NULL: it does not
    flight_system *flight_of;
    int flight_count;

    // of a vehicle, linearised about its equilibrium on a flat road
    ld_status stability; // whether its stabilisers hold its platform; else why not
    ld_error unstable;
    ld_pole growing; // what grows there, if anything

    double cpu_seconds_setup;
    int mode_count;
    ld_mode mode[6 + LD_MAX_MODES]; // tube and tail on their supports

    quantity_columns columns;              // of the history; of a flight alone: of its flight
    quantity_columns vehicle_columns;      // of its vehicle alone, where it has one
    measure_plan measure[LD_MAX_MEASURES]; // of the model's measures
};

// Makes *simulation (NULL: a new one) that of `model`, as ld_simulation_create does but without the
// modes for the summary. What was found once of an equal tube is used again: the results are the
// same to the bit. After a failure it is empty, to be renewed or freed.
ld_status simulation_renew(ld_simulation **simulation, const ld_model *model, ld_error *error);

// Motor of firing i.
const motor *simulation_motor(const ld_simulation *self, int i);

// Flight of firing i; NULL where the launch has none.
const flight_system *simulation_flight(const ld_simulation *self, int i);

// Adds a remark that the user should see.
void simulation_note(ld_summary *summary, const char *format, ...) LD_PRINTF(2, 3);

// Set-up, start and run of a model without launcher.
ld_status flight_alone_create(ld_simulation *self, ld_error *error);
// Whether the flight can begin.
ld_status flight_alone_begin(const ld_simulation *self, ld_error *error);
// The flight (flight/free_flight.h) from `state`, without rows; clears the summary for it.
struct free_flight;
void flight_alone_prepare(const ld_simulation *self, const ld_run_options *options,
                          struct free_flight *job, double *state, ld_summary *summary);
ld_status flight_alone_run(const ld_simulation *self, const ld_run_options *options,
                           ld_summary *summary, ld_error *error);

// Hands places, sizes and mode shapes of the launcher to the sink, where it wants them.
ld_status simulation_geometry(const ld_simulation *self, const ld_sink *sink, ld_error *error);

// Names the columns of the history, once.
ld_status history_build(ld_simulation *self, ld_error *error);

// Those of its vehicle alone.
ld_status vehicle_run_name_columns(ld_simulation *self, ld_error *error);

// ld_simulation_tube_modes(), found: LD_ERR_MEMORY, LD_ERR_NUMERIC.
ld_status simulation_tube_modes(const ld_simulation *self, ld_mode *modes, int capacity, int *count,
                                ld_error *error);

// Refuses a vehicle's stabiliser that cannot hold its platform, by the equations linearised about
// the equilibrium on a flat road. `growing`: the fastest growing eigenvalue of any part, zero where
// there is none.
ld_status simulation_check_stability(const ld_simulation *self, ld_pole *growing, ld_error *error);

// Direction angles: pitch and yaw of d (any length) and their rates under d_dot (model.md, section
// 1).
typedef struct direction_angles {
    double pitch, yaw, pitch_rate, yaw_rate;
} direction_angles;
direction_angles direction_angles_of(v3 d, v3 d_dot);

#endif
