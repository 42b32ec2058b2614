// States and event indicators of a launch whose steps are taken outside, by name.
#ifndef LD_LAUNCH_LAUNCH_EXCHANGE_NAMES_H
#define LD_LAUNCH_LAUNCH_EXCHANGE_NAMES_H

#include "launchdyn/run.h"

enum { OUTSIDE_NAME_SIZE = 64 };

// A state or what goes through zero at an event, as an importer sees it.
typedef struct exchange_quantity {
    char name[OUTSIDE_NAME_SIZE]; // "tube.position.x"; "exit.1"
    const char *unit;             // SI; "": none, or not reported
    const char *rate_unit;        // of a state
    const char *description;
} exchange_quantity;

exchange_quantity launch_exchange_state(const ld_run *run, int i);
exchange_quantity launch_exchange_indicator(const ld_run *run, int i);

// Of a vehicle without its launcher: its states, works of kinds of its forces, wheels.
exchange_quantity exchange_base_state(int i);
struct launcher_system;
exchange_quantity exchange_base_work(const struct launcher_system *launcher, int i);
exchange_quantity exchange_wheel(int i);

#endif
