// What an optimisation may make least or limit: numbers of a study or of a loop.
#ifndef LD_RUN_AIMS_H
#define LD_RUN_AIMS_H

#include <stdbool.h>
#include <stddef.h>

#include "launchdyn/model.h"
#include "model/blocks/optimise.h"

// Whether the aim is a number of the model that may be one; false: `why` says why not. Where
// rockets land is none but by the area of the footprint: launchdyn does not aim.
// @param unit SI, of the aim, "" without
bool aim_is_possible(const ld_model *model, const ld_aim *aim, char unit[LD_MAX_UNIT], char *why,
                     size_t size);

// "deviation of pitch_rate and yaw_rate"
void aim_text(const ld_aim *aim, char *text, size_t size);

static inline bool aim_is_margin(const ld_aim *aim)
{
    return aim->take == LD_AIM_GAIN_MARGIN || aim->take == LD_AIM_PHASE_MARGIN;
}

#endif
