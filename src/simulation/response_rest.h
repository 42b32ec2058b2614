// What a linearised launcher is in its equilibrium.
#ifndef LD_SIMULATION_RESPONSE_REST_H
#define LD_SIMULATION_RESPONSE_REST_H

#include "launchdyn/response.h"

// A column's value in the equilibrium; not a number: there is no such column.
double response_rest(const ld_response *self, const char *column);

#endif
