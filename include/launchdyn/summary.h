/// What came of a run: numbers by their names.
#ifndef LAUNCHDYN_SUMMARY_H
#define LAUNCHDYN_SUMMARY_H

#include <stdio.h>

#include "launchdyn/simulation.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// An empty one, for ld_simulation_run(). NULL: no memory.
ld_summary *ld_summary_new(void);
/// May be NULL.
void ld_summary_free(ld_summary *summary);

/// Number of rockets fired.
int ld_summary_rockets(const ld_summary *summary);

/// A result of rocket number `rocket` (from 1, in the order of firing), named as in studies
/// (docs/results.md): "t_rear", "muzzle_speed", "tip.pitch_rate", ..., in SI.
/// @param value NaN where there is none: the rocket has not left its tube, or has not landed
/// @return LD_OK, LD_ERR_INPUT (no such rocket or result)
ld_status ld_summary_number(const ld_summary *summary, int rocket, const char *name, double *value,
                            ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
