/// A launch: from a model to rows of a history and a summary.
///
/// A simulation holds what is computed once from the model (modes, inertia coefficients, tables)
/// and then does not change: several threads may run it at a time. What a run changes is the run's
/// own; its steps allocate nothing.
#ifndef LAUNCHDYN_SIMULATION_H
#define LAUNCHDYN_SIMULATION_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/results.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum { LD_SHAPE_TEXT = 64 };

/// One natural frequency and what moves most in it. Of tube and rocket on a base that is held: of
/// the system without its dampers, and what the dampers do to that shape. Of a vehicle, whose
/// dampers are strong: modulus and damping of a pair of eigenvalues.
typedef struct ld_mode {
    double frequency; ///< [Hz]
    double damping;   ///< [-] ratio
    double real;      ///< [1/s] -damping 2 pi frequency
    char shape[LD_SHAPE_TEXT];
} ld_mode;

/// An eigenvalue of the linearised system with its dampers [1/s]; one of each conjugate pair.
typedef struct ld_pole {
    double real, imaginary;    ///< [1/s], [rad/s] >= 0
    char shape[LD_SHAPE_TEXT]; ///< what moves most
} ld_pole;

/// What came of a run (launchdyn/summary.h).
typedef struct ld_summary ld_summary;

typedef struct ld_simulation ld_simulation;

/// Builds a simulation from a model, which is kept by reference: it must outlive the simulation.
/// @return LD_OK; LD_ERR_INPUT (modes or sections that make no tube, ...), LD_ERR_NUMERIC or
///         LD_ERR_MEMORY
ld_status ld_simulation_create(const ld_model *model, ld_simulation **simulation, ld_error *error);
void ld_simulation_free(ld_simulation *simulation);

/// Where the undeformed tube is on its base, and how that moves: its rear end, and axes of which x
/// goes along it.
typedef struct ld_base_frame {
    double position[3];   ///< [m] of the rear end in I
    double quaternion[4]; ///< tube axes against I, scalar part first, of length 1
    double velocity[3];   ///< [m/s] of the rear end, in I
    double rate[3];       ///< [rad/s] angular velocity, in I
} ld_base_frame;

/// What the caller wants to hear while it runs, and what it says; every member may be NULL or 0.
typedef struct ld_run_options {
    const ld_sink *sink; ///< rows of the history at the output steps and at the key instants
    void *self;
    /// Called about every millisecond of a launch and every 50 ms of a flight with the share done
    /// (0 to 1, an estimate); return false to stop: the run then ends with LD_ERR_INTERRUPTED and
    /// keeps what it has.
    bool (*progress)(void *self, double share);
    const ld_base_frame *base; ///< of base.kind: external, which needs it, at the start of the run
    const void *reserved[4];   ///< NULL: room for what later versions may be asked
} ld_run_options;

/// Runs from the start to the end that the model asks for. On failure the summary holds what was
/// reached and why it stopped. Running again starts afresh and gives the same bits.
/// @return LD_OK; LD_ERR_INPUT (a start that the model cannot have: a wheel in the air, a
///         stabiliser too weak or unstable), LD_ERR_LAUNCH (no equilibrium, never released, stuck,
///         jammed, not landed, beyond a table), LD_ERR_NUMERIC, LD_ERR_MEMORY, LD_ERR_INTERRUPTED,
///         or what the sink returned. An error about a key of the scenario begins with its path
///         (ld_scenario_explain).
ld_status ld_simulation_run(const ld_simulation *simulation, const ld_run_options *options,
                            ld_summary *summary, ld_error *error);

/// Natural frequencies of tube and tail on their supports (base held, without gravity), ascending;
/// shapes of one frequency are those that the dampers do not couple, by ascending damping. None of
/// a flight alone.
/// @return the number written to `modes` (at most `capacity`)
int ld_simulation_tube_modes(const ld_simulation *simulation, ld_mode *modes, int capacity);

/// The whole (tube, tail, rocket on its adaptors, lock closed; with a vehicle also platforms and
/// wheels, on a flat road at the marching speed) linearised at its static equilibrium, without
/// Coulomb friction: modes by ascending frequency, and the eigenvalues with damping by ascending
/// modulus. Those that lock and slot leave at zero, and a vehicle's neutral directions, are left
/// out.
/// @return LD_OK, LD_ERR_INPUT (a flight alone), LD_ERR_NUMERIC or LD_ERR_MEMORY
ld_status ld_simulation_system_modes(const ld_simulation *simulation, ld_mode *modes, int capacity,
                                     int *count, ld_pole *poles, int pole_capacity, int *pole_count,
                                     ld_error *error);

/// Columns of the history, in order.
size_t ld_simulation_columns(const ld_simulation *simulation, const ld_column **columns);

/// Describes in words what the bodies of a base of kind multibody are: a tree with its loops and
/// degrees of freedom, in lines that begin with "# " as of ld_model_describe(). Nothing of others.
void ld_simulation_describe(const ld_simulation *simulation, FILE *stream);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
