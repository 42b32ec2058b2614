/// Which tubes fire, and when: the block `firing`.
#ifndef LD_MODEL_BLOCKS_FIRING_H
#define LD_MODEL_BLOCKS_FIRING_H

#include <stdbool.h>

#include "model/blocks/limits.h"

typedef struct ld_firing {
    int tube;  ///< number from 1
    double at; ///< [s] on the run's clock
} ld_firing;

/// The firings as an order of tubes at one interval; where it is present, model_complete() makes
/// the list of firings from it.
typedef struct ld_firing_order {
    bool present;
    int tube_count;
    int tube[LD_MAX_FIRINGS]; ///< numbers from 1
    double start;             ///< [s] first ignition, on the run's clock
    double interval;          ///< [s] from one ignition to the next
} ld_firing_order;

#endif
