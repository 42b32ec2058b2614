// The surfaces of a guide, whichever way it is given.
#ifndef LD_MODEL_GUIDE_H
#define LD_MODEL_GUIDE_H

#include <stdbool.h>

#include "model/blocks/contact.h"
#include "model/blocks/guide.h"
#include "model/blocks/limits.h"
#include "model/blocks/tubes.h"

/// Fills `surface` with those of the guide, of a T-slot or a tower with the ones that these stand
/// for; returns how many there are, 0 for a bore.
int guide_surfaces(const ld_guide *guide, ld_surface surface[LD_MAX_SURFACES]);

/// Whether one of them is flat, so that the guide carries roll.
bool guide_is_flat(const ld_guide *guide);

/// What a shoe adds to the gap of each surface [m].
double guide_clearance(const ld_adaptor *shoe);

/// Station at which an adaptor leaves the guide [m]: where it says, or the tip's.
double guide_end(const ld_tubes *tubes, const ld_adaptor *adaptor);

/// Station of the rear adaptor when another one leaves a straight guide [m].
double guide_exit_station(const ld_tubes *tubes, const ld_adaptor *adaptor);

/// Adaptors that leave a straight guide so close together [m] leave at one instant.
#define GUIDE_TOGETHER 1e-6

#endif
