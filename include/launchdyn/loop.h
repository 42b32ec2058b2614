/// The loop that holds a hinge of a vehicle or a joint of a multibody base, opened at the torque
/// that its controller asks for: what it bears before it swings, how fast it follows, what it
/// leaves of a disturbance. From the linearised equations (docs/response.md), without runs.
#ifndef LAUNCHDYN_LOOP_H
#define LAUNCHDYN_LOOP_H

#include <stdbool.h>

#include "launchdyn/model.h"
#include "launchdyn/response.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// The loop of one hinge, the other's closed. One thread at a time may use it.
typedef struct ld_loop ld_loop;

/// At a frequency. A digital loop counts as a continuous one that is late by its delay and half its
/// period.
typedef struct ld_loop_point {
    ld_phasor open;        ///< L: the controller's torque for a torque in its place, sign turned
    ld_phasor tracking;    ///< measured angle per commanded one
    ld_phasor sensitivity; ///< S = 1/(1 + L): what a loop without feedforward leaves of an error
} ld_loop_point;

/// Between 0.05 and 500 Hz.
typedef struct ld_loop_margins {
    double raise, raise_at;  ///< all gains times this > 1 are at the limit of stability, where they
                             ///< swing [Hz]; infinity, NaN: none
    double lower, lower_at;  ///< the same with a factor < 1; 0, NaN: none
    double phase, crossover; ///< [rad] least distance of L from -1 where |L| = 1, the last [Hz] at
                             ///< which |L| = 1; infinity, NaN: nowhere
    double delay;            ///< [s] by which the loop may be later than it is; infinity: any
    double bandwidth;        ///< [Hz] at which |tracking| first falls to 1/sqrt(2); NaN: nowhere
    double peak, peak_at;    ///< greatest |S|, where [Hz]; 1, NaN: nowhere above one
} ld_loop_margins;

/// @param model kept by reference
/// @param hinge "azimuth", "elevation"; of a multibody base the name of a drive
/// @return as ld_response_create(), and LD_ERR_INPUT (no such hinge or drive, another base, a
/// locked
///         hinge, a delay that makes the loop unstable)
ld_status ld_loop_create(const ld_model *model, const char *hinge, ld_loop **loop, ld_error *error);
void ld_loop_free(ld_loop *loop);

/// @param frequency [Hz] > 0 [count]
/// @param point     [count]
/// @return LD_OK, LD_ERR_INPUT, LD_ERR_NUMERIC as ld_response_gain()
ld_status ld_loop_points(ld_loop *loop, const double *frequency, size_t count, ld_loop_point *point,
                         ld_error *error);

/// How the base disturbs the platform: the angle of the platform against I that the loop measures,
/// per angle by which the chassis turns about the hinge's axis, which stays where it is. Without
/// anything between them 0, without a loop in a hinge that sticks 1. What accelerates the hinge is
/// not in it.
/// @param frequency [Hz] > 0 [count]
/// @param rejection [count]
/// @return as ld_loop_points(), and LD_ERR_INPUT (of a multibody base)
ld_status ld_loop_rejection(ld_loop *loop, const double *frequency, size_t count,
                            ld_phasor *rejection, ld_error *error);

/// Whether it has that: of a vehicle.
bool ld_loop_has_rejection(const ld_loop *loop);

void ld_loop_margins_of(const ld_loop *loop, ld_loop_margins *margins);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
