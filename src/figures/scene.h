// The moving scene of a launch as a binary glTF 2.0 file.
#ifndef LD_FIGURES_SCENE_H
#define LD_FIGURES_SCENE_H

#include "launchdyn/output.h"
#include "results/history.h"

// Writes a run's scene: nodes launcher (the undeformed tube's frame) with tube, which bends, and
// the other tubes; rockets; the base's bodies. `picture`: from, to, scene.
// @return LD_OK, LD_ERR_INPUT (no launcher, nothing between from and to), LD_ERR_MEMORY
ld_status scene_write(const history_data *history, const ld_picture *picture, FILE *file,
                      ld_error *error);

#endif
