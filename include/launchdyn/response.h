/// What a launcher at rest in its tube, or on the march, answers to small motions: of its road, of
/// its base, of its stabilisers' commands, to forces. From the equations linearised about the
/// equilibrium (docs/response.md), without runs.
#ifndef LAUNCHDYN_RESPONSE_H
#define LAUNCHDYN_RESPONSE_H

#include <stdbool.h>

#include "launchdyn/model.h"
#include "launchdyn/results.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// A launcher linearised at any speed of a range. One thread at a time may use it.
typedef struct ld_response ld_response;

/// Amplitude and phase as a complex number: u = cos(w t) makes y = Re(gain e^(i w t)).
typedef struct ld_phasor {
    double real, imaginary;
} ld_phasor;

/// Who is asked, where something takes seconds, whether to continue.
typedef struct ld_watch {
    bool (*go_on)(void *self);
    void *self;
} ld_watch;

/// @param model   kept by reference
/// @param slowest, fastest of a vehicle: the speeds [m/s] from and to which it is asked; NaN: the
///                model's
/// @return LD_OK; LD_ERR_INPUT (a flight alone, a range that is none, stabilisers that do not hold,
///         a motion that grows), LD_ERR_LAUNCH, LD_ERR_NUMERIC (no equilibrium), LD_ERR_MEMORY
ld_status ld_response_create(const ld_model *model, double slowest, double fastest,
                             ld_response **response, ld_error *error);
void ld_response_free(ld_response *response);

/// What may act, by name: "road" (both tracks under all wheels, each at its time), "road.left",
/// "road.right", "wheel.front-left.road", "elevation.command", "chassis.force_y", "base.y", ...
size_t ld_response_inputs(const ld_response *response, const ld_column **inputs);

/// Whether the hinges rub, as they do not at first: their Coulomb friction then counts as a viscous
/// one, which at each speed is the mean of its slope over the rates that the model's road gives
/// them (docs/response.md).
/// @return LD_OK; as ld_response_create()
ld_status ld_response_friction(ld_response *response, bool friction, ld_error *error);

/// Columns of the history, each of which can be asked for.
size_t ld_response_columns(const ld_response *response, const ld_column **columns);

/// Chooses the columns that the functions below report, in this order; first there is none.
/// @return LD_OK, LD_ERR_INPUT (no such column), LD_ERR_MEMORY
ld_status ld_response_choose(ld_response *response, const char *const *names, size_t count,
                             ld_error *error);

/// Frequency response from an input to the columns chosen.
/// @param speed     [m/s] of a vehicle
/// @param frequency [Hz] > 0 [count]
/// @param gain      [count][columns chosen] in their units per that of the input, of a road as it
/// is
///                  under the chassis' mass centre; NaN where a column has no value before the
///                  launch
/// @return LD_OK, LD_ERR_INPUT (no such input, a speed out of range, a road under a vehicle that
///         stands), LD_ERR_NUMERIC (a frequency at which an undamped motion answers without bounds)
ld_status ld_response_gain(ld_response *response, double speed, const char *input,
                           const double *frequency, size_t count, ld_phasor *gain, ld_error *error);

/// Root mean square of the columns chosen on the model's road, over all the phases that its sines
/// may have: its random part and its sines, not bumps and profiles.
/// @param rms       [columns chosen] about the equilibrium, in the columns' units
/// @param strongest [columns chosen] [Hz] of the sine of the road to which most is owed; may be
/// NULL
/// @return as ld_response_gain(), and LD_ERR_INPUT (no vehicle)
ld_status ld_response_on_road(ld_response *response, double speed, double *rms, double *strongest,
                              ld_error *error);

/// One-sided power spectral densities of the columns chosen on the random part of the model's road,
/// as its class has it between its longest and its shortest wavelength.
/// @param density [count][columns chosen] in the squares of their units per Hz
/// @return as ld_response_on_road()
ld_status ld_response_density(ld_response *response, double speed, const double *frequency,
                              size_t count, double *density, ld_error *error);

/// Root mean square of the columns chosen where an input is random and steady.
/// @param frequency [points] [Hz] rising, from 0 or above; between them the density is a straight
///                  line, beyond them there is nothing
/// @param density   [points] one-sided power spectral density, in the square of the input's unit
///                  per Hz; that of a column at a frequency is this one times the square of its
///                  gain there
/// @param rms       [columns chosen] about the equilibrium
/// @param strongest [columns chosen] [Hz] where the density is greatest
/// @return as ld_response_gain(), LD_ERR_INPUT (no such density)
ld_status ld_response_random(ld_response *response, double speed, const char *input,
                             const double *frequency, const double *density, size_t points,
                             double *rms, double *strongest, ld_error *error);

/// By what the model's road scatters a launch: its first rocket, lit as the vehicle marches over
/// the road's random part and its sines, over all the phases that these may have. From launches
/// that begin at the ignition, in the linear state that the road leaves there (with
/// ld_response_friction() as it is in runs).
/// @param speed     [m/s] of a vehicle; at rest nothing scatters
/// @param draws     2 or more: so many launches, each with phases drawn by the road's seed. 0: to
///                  the first order, from two launches for each of some 70 to 150 independent
///                  patterns of the road, of one standard deviation each, and one from rest
/// @param names     [count] numbers of the launch that a study keeps of a rocket, such as
///                  "pitch_rate" or "tip_off.yaw" (docs/quantities.md), not of its flight
/// @param mean      [count] of the draws; without them what they are from rest on a flat road
/// @param deviation [count] standard deviations
/// @return as ld_response_on_road(), LD_ERR_INPUT (no such number, 1 or fewer draws),
///         LD_ERR_INTERRUPTED by ld_response_watch(), and what a launch that fails returns
ld_status ld_response_exit(ld_response *response, double speed, int draws, const char *const *names,
                           size_t count, double *mean, double *deviation, ld_error *error);

/// Lets somebody stop ld_response_exit(), who is asked before each of its launches.
/// @param watch kept by reference; NULL, as at first: no one
void ld_response_watch(ld_response *response, const ld_watch *watch);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
