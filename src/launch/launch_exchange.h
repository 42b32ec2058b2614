// A launch whose steps an integrator outside takes, as the importer of an FMU for model exchange
// does: it asks for rates and for what goes through zero at any time and state, reports where a
// step has ended, and lets happen what happens there.
//
// Its continuous states are those of the launch but for an externally driven base's, which
// are what was given.
#ifndef LD_LAUNCH_LAUNCH_EXCHANGE_H
#define LD_LAUNCH_LAUNCH_EXCHANGE_H

#include "launchdyn/run.h"
#include "systems/launching/launcher.h"

// Whether one of this simulation can be taken so; else why not (LD_ERR_MISSING).
ld_status launch_exchange_check(const ld_simulation *simulation, ld_error *error);

// ---- what it has (launch_exchange_names.h: by name)

int launch_exchange_states(const ld_run *run);
int launch_exchange_indicators(const ld_run *run); // LD_MAX_STATES at most
// How large a change of each state counts, relative to the others [states].
void launch_exchange_nominals(const ld_run *run, double *nominal);

// ---- where it is, at any time and state

// The present is t, the states x [launch_exchange_states()], and of an externally driven base the
// frame (else unread). LD_ERR_INPUT: one that is not finite.
ld_status launch_exchange_place(ld_run *run, double t, const double *x, const ld_base_frame *base,
                                ld_error *error);
void launch_exchange_get(ld_run *run, double *x);
// There, on any run: LD_ERR_NUMERIC where the equations have no solution.
ld_status launch_exchange_rates(ld_run *run, double *rate, ld_error *error);
ld_status launch_exchange_values(ld_run *run, double *indicator, ld_error *error);

// ---- steps

// When the next step must end [s]; infinity: at no known instant.
double launch_exchange_next(const ld_run *run);
// A step has ended at the present; `happens`: something does here, by
// launch_exchange_pass_events().
ld_status launch_exchange_accept(ld_run *run, bool *happens, ld_error *error);
// What happens at the present, at which a step then ends, has happened; `happened`: something has,
// and states and equations may be others.
ld_status launch_exchange_pass_events(ld_run *run, bool *happened, ld_error *error);

#endif
