// Scenarios read into a model that the caller has; launchdyn/scenario.h hands handles out.
#ifndef LD_SCENARIO_SCENARIO_H
#define LD_SCENARIO_SCENARIO_H

#include <stddef.h>

#include "launchdyn/scenario.h"

// As ld_scenario_read() and ld_scenario_read_text(), with the values of point `point` (from 1 to
// ld_scenario_points()) of the sweep in place of the nominal ones; 0: the nominal ones. A value's
// place in messages is that in the sweep. An override of a swept key takes its axis away; other
// overrides are laid over the point. The model keeps the axes, and everything else may differ
// between points. Standard input can be read once only: its points from 1 on come from what the
// nominal model keeps. `model` is filled on success (free with model_clear()), untouched on
// failure.
ld_status scenario_read_point(const char *path, const char *const *sets, size_t count, int point,
                              ld_model *model, ld_messages *messages);
ld_status scenario_read_text_point(const char *text, size_t length, const char *name,
                                   const char *folder, const char *const *sets, size_t count,
                                   int point, ld_model *model, ld_messages *messages);

// The same of the nominal values.
ld_status scenario_read(const char *path, const char *const *sets, size_t count, ld_model *model,
                        ld_messages *messages);
ld_status scenario_read_text(const char *text, size_t length, const char *name, const char *folder,
                             const char *const *sets, size_t count, ld_model *model,
                             ld_messages *messages);

// As ld_scenario_read_source().
ld_status scenario_read_source(ld_source *source, int point, ld_model *model,
                               ld_messages *messages);

#endif
