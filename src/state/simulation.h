// The system of a simulation: what is computed once from the model and then stays as it is, so that
// several runs may continue over one, each on its own thread.
#ifndef LD_STATE_SIMULATION_H
#define LD_STATE_SIMULATION_H

#include "elements/motor.h"
#include "quantities/measuring.h"
#include "quantities/quantity_table.h"
#include "quantities/summary.h"
#include "systems/flight/flight.h"
#include "systems/launching/launcher.h"

enum { LD_MAX_COLUMNS = 1024 };

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

    quantity_columns columns;         // of the history; of a flight alone: of its flight
    quantity_columns vehicle_columns; // of its vehicle alone, where it has one
    measure_plans measure;            // of the model's measures
};

// An empty one, to be freed; NULL: LD_ERR_MEMORY.
ld_simulation *simulation_make(ld_error *error);
// Frees what it holds: it is empty.
void simulation_clear(ld_simulation *self);

// Motor of firing i.
const motor *simulation_motor(const ld_simulation *self, int i);

// Flight of firing i; NULL where the launch has none.
const flight_system *simulation_flight(const ld_simulation *self, int i);

#endif
