// Blocks of parts that several blocks have.
#ifndef LD_MODEL_TABLES_PARTS_H
#define LD_MODEL_TABLES_PARTS_H

#include "model/fields/field.h"

// Sections and material of a tube or beam; stabilisers of angles and of lengths.
extern const field_block material_block, section_block, stabiliser_block, positioner_block;

#endif
