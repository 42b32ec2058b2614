// Building the joints that close loops: checked, cut into rows, with their paths to the ground.
#ifndef LD_SYSTEMS_LOOP_DESCRIPTION_H
#define LD_SYSTEMS_LOOP_DESCRIPTION_H

#include "systems/multibody/multibody.h"

// Fails with a sentence that names the joint.
ld_status loops_check(const ld_mstmm_description *description, ld_error *error);

// Ends of loops that stand on beams: each requires a section.
int loops_sections(const ld_mstmm_description *description);

// The loops of a system whose nodes are made, those for `sections` of its ends, from first_section
// on, not yet linked with their beams.
ld_status loops_build(ld_mstmm *system, const ld_mstmm_description *description, int first_section,
                      ld_error *error);

// The workspace for them; returns false without memory.
bool loops_allocate(ld_mstmm *system);
// What ld_mstmm_assemble has found, into a copy.
void loops_copy(ld_mstmm *system, const ld_mstmm *from);

void loops_free_workspace(ld_mstmm *system);
void loops_free(ld_mstmm *system);

#endif
