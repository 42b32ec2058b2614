/// The slot that a knob of the rocket follows: the block `tubes.slot`.
#ifndef LD_MODEL_BLOCKS_SLOT_H
#define LD_MODEL_BLOCKS_SLOT_H

#include "model/blocks/table.h"

typedef enum ld_slot_kind { LD_SLOT_NONE, LD_SLOT_HELIX } ld_slot_kind;

typedef struct ld_slot {
    ld_slot_kind kind;
    ld_table angle;  ///< s [m], alpha [rad]; one row: constant; linear between, constant outside
    double radius;   ///< [m] R_k, of the knob's circle
    double friction; ///< [-] mu_s
} ld_slot;

#endif
