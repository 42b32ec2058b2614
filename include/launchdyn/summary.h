/// What came of a run: numbers by their names (docs/quantities.md).
#ifndef LAUNCHDYN_SUMMARY_H
#define LAUNCHDYN_SUMMARY_H

#include "launchdyn/simulation.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// An empty one, for ld_simulation_run(), which fills it; it then needs the simulation's model as
/// long as it is asked. NULL: no memory.
ld_summary *ld_summary_new(void);
/// May be NULL.
void ld_summary_free(ld_summary *summary);

/// A number of a summary by its name, in SI: of a rocket (from 1, in the order of firing)
/// "rocket.1.t_rear", "rocket.1.tip_off.pitch_rate", "rocket.1.max_contact_force.rear"; of the run
/// "equilibrium.lock_force", "energy.residual_relative", "statistics.steps"; of a natural mode of
/// tube and tail "mode.1.frequency".
/// @param value NaN where there is none: the rocket has not left its tube, or has not landed
/// @return LD_OK, LD_ERR_INPUT (no such number, with the nearest name; nothing has run)
ld_status ld_summary_number(const ld_summary *summary, const char *name, double *value,
                            ld_error *error);

/// One of them.
typedef struct ld_quantity {
    const char *name;
    const char *unit;        ///< SI; "" or "1": none
    const char *description; ///< one line, with frame
    double value;
} ld_quantity;

/// Hands out all numbers that there are, each valid during the call.
void ld_summary_each(const ld_summary *summary,
                     void (*take)(void *self, const ld_quantity *quantity), void *self);

/// Number of rockets fired.
int ld_summary_rockets(const ld_summary *summary);

/// Why the run ended early; NULL: it did not.
const char *ld_summary_stopped(const ld_summary *summary);

/// Remark `index` (from 0) that the user should see; NULL after the last.
const char *ld_summary_note(const ld_summary *summary, int index);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
