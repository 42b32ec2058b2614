// The block `optimise`.
#ifndef LD_MODEL_TABLES_OPTIMISE_H
#define LD_MODEL_TABLES_OPTIMISE_H

#include "model/fields/field.h"

extern const field_block optimise_block;

#endif
