/// Stiffness of a section in each plane: the block `tubes.sections`.
#ifndef LD_MODEL_BLOCKS_SECTION_H
#define LD_MODEL_BLOCKS_SECTION_H

#include "launchdyn/section.h"

/// Bending stiffness of a section about y, which deflections along z meet.
static inline double section_stiffness_y(const ld_section *section)
{
    return section->form == LD_SECTION_PLANES ? section->bending_stiffness_y
                                              : section->bending_stiffness;
}

/// Bending stiffness of a section about z, which deflections along y meet.
static inline double section_stiffness_z(const ld_section *section)
{
    return section->form == LD_SECTION_PLANES ? section->bending_stiffness_z
                                              : section->bending_stiffness;
}

#endif
