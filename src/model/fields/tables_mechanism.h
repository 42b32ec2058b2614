// Blocks of a base of bodies, joints and force elements, and those of the other tables in them.
#ifndef LD_MODEL_TABLES_MECHANISM_H
#define LD_MODEL_TABLES_MECHANISM_H

#include "model/fields/field.h"

extern const field_block body_block, beam_block, joint_block, bushing_block, strut_block,
    joint_drive_block, foot_block, load_block, drag_block;

#endif
