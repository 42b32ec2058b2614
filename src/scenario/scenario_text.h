// Parts of a scenario as it prints them, for those who show them. What is too long is cut.
#ifndef LD_SCENARIO_SCENARIO_TEXT_H
#define LD_SCENARIO_SCENARIO_TEXT_H

#include <stddef.h>

#include "launchdyn/status.h"
#include "model/blocks/study.h"
#include "model/fields/field.h"

// A factor's distribution, "normal: 0.2 kg, within: 3".
void scenario_factor_text(const ld_model *model, const ld_factor *factor, char *text, size_t size);
// A statistic with the half width that it is run until, "range.mean: 2 m".
void scenario_until_text(const ld_model *model, const ld_until *until, char *text, size_t size);
// A value as it is printed where that is a line, "" where not given; LD_ERR_INPUT: it is more.
ld_status scenario_value_text(const field_value *value, char *text, size_t size);

#endif
