// What a linearised launcher is in its equilibrium, and in which state its road puts it.
#ifndef LD_LINEAR_RESPONSE_STATE_H
#define LD_LINEAR_RESPONSE_STATE_H

#include "environment/road.h"
#include "launchdyn/response.h"

// ld_response_create(), with the adaptors' friction or without, as ld_simulation_system_modes() is.
ld_status response_create(const ld_model *model, double slowest, double fastest, bool rubbing,
                          ld_response **response, ld_error *error);

// A column's value in the equilibrium; not a number: there is no such column.
double response_rest(const ld_response *self, const char *column);

// What it was made of, and the sines of its road.
const ld_model *response_model(const ld_response *self);
const road_line *response_lines(const ld_response *self, size_t *count);

// Whether who watches over it lets it continue.
bool response_continues(const ld_response *self);

// LD_ERR_INPUT where there is no road, or nothing moves over it.
ld_status response_check_road(const ld_response *self, double speed, ld_error *error);

// How many unknowns of linear_system there are; what they are, times e^(i w t), on a sine of unit
// height on the left track [unknowns] and on the right one [unknowns].
int response_unknowns(const ld_response *self);
ld_status response_states(ld_response *self, double speed, double frequency, ld_phasor *state,
                          ld_error *error);

#endif
