// Runs from a given start, and runs whose steps are taken outside (launchdyn/run.h has the others).
#ifndef LD_RUN_RUN_H
#define LD_RUN_RUN_H

#include "integration/step_course.h"
#include "launchdyn/run.h"

struct launch_start; // launch/launch_run.h

// Runs from a given start to the end; one that ends early says why.
ld_status run_from(const ld_simulation *simulation, const struct launch_start *start,
                   ld_summary *summary, ld_error *error);

// As ld_simulation_run(), by steps that the course keeps, or those that it has.
ld_status run_course(const ld_simulation *simulation, const ld_run_options *options,
                     step_course *course, ld_summary *summary, ld_error *error);

// ld_run_begin() and ld_run_load() of one whose steps are taken outside.
ld_status run_begin_exchange(const ld_simulation *simulation, const ld_run_options *options,
                             ld_run **out, ld_error *error);
ld_status run_load_exchange(const ld_simulation *simulation, const void *bytes, size_t size,
                            ld_run **out, ld_error *error);

#endif
