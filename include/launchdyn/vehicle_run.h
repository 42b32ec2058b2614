/// A run of a scenario's vehicle alone, stepped under a given wrench: for a program that
/// has its own launcher on it, or moves our launcher (base.kind: external) on it step by step.
///
/// The simulation is that of the whole scenario. The vehicle begins as it does there, in
/// equilibrium under tube and rocket; from then on it knows of them what it is given.
#ifndef LAUNCHDYN_VEHICLE_RUN_H
#define LAUNCHDYN_VEHICLE_RUN_H

#include <stddef.h>

#include "launchdyn/run.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct ld_vehicle_run ld_vehicle_run;

/// Begins at the start of the lead-in. The simulation must outlive it.
/// @param run NULL after a failure
/// @return LD_OK; LD_ERR_INPUT (a base of another kind, several firings, jets on the platform; a
///         start that the model cannot have); LD_ERR_LAUNCH, LD_ERR_NUMERIC, LD_ERR_MEMORY
ld_status ld_vehicle_run_begin(const ld_simulation *simulation, ld_vehicle_run **run,
                               ld_error *error);
/// NULL: nothing happens.
void ld_vehicle_run_end(ld_vehicle_run *run);

/// Continues to time t [s]; it has no end of its own.
/// @return LD_OK; LD_ERR_INPUT (t lies behind, or is not finite); LD_ERR_NUMERIC, LD_ERR_MEMORY,
///         now and whenever it is asked again
ld_status ld_vehicle_run_advance(ld_vehicle_run *run, double t, ld_error *error);
/// Present time [s], on the clock of the launch.
double ld_vehicle_run_time(const ld_vehicle_run *run);

/// What the tube does to the vehicle at the present time. Until it receives another it continues,
/// in the axes of the undeformed tube, with the rate that the last two wrenches report; at the
/// start, until it is given another one, it is that of tube and rocket at rest. Set again at the
/// same time, what it was given before at that time counts no more.
/// @return LD_OK; LD_ERR_INPUT (a number that is not finite); what ended the run
ld_status ld_vehicle_run_set_wrench(ld_vehicle_run *run, const ld_base_wrench *wrench,
                                    ld_error *error);
/// The wrench at the present time, as it continues.
ld_status ld_vehicle_run_wrench(ld_vehicle_run *run, ld_base_wrench *wrench, ld_error *error);

/// Where the vehicle holds the undeformed tube at the present time, for ld_run_set_base().
ld_status ld_vehicle_run_frame(ld_vehicle_run *run, ld_base_frame *frame, ld_error *error);

/// Columns of a vehicle alone, of which `t` is the first: of chassis, hinges, drive and wheels
/// those of a launch, then its own energies and works. They live as long as the simulation.
/// @return how many; 0: the simulation has no vehicle
size_t ld_vehicle_run_columns(const ld_simulation *simulation, const ld_column **columns);
/// Their values at the present time.
ld_status ld_vehicle_run_row(ld_vehicle_run *run, double *values, ld_error *error);

/// As ld_run_save() and ld_run_load(): continues with the same bits.
ld_status ld_vehicle_run_save(ld_vehicle_run *run, void *bytes, size_t capacity, size_t *size,
                              ld_error *error);
ld_status ld_vehicle_run_load(const ld_simulation *simulation, const void *bytes, size_t size,
                              ld_vehicle_run **run, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
