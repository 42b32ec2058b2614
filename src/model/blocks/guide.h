/// Surfaces on which shoes slide: the block `tubes.guide`.
#ifndef LD_MODEL_BLOCKS_GUIDE_H
#define LD_MODEL_BLOCKS_GUIDE_H

#include <stdbool.h>

#include "model/blocks/limits.h"
#include "model/blocks/table.h"

typedef enum ld_surface_shape {
    LD_SURFACE_FLAT,  ///< the shoe's point beside the surface's counts: roll opens and closes gaps
    LD_SURFACE_ROUND, ///< the shoe's centre counts: roll changes nothing
} ld_surface_shape;

/// A surface on which every shoe slides: model.md, section 5.
typedef struct ld_surface {
    char name[LD_MAX_NAME];
    double at[2];  ///< [m] y, z of a point of it, from the guide line
    double normal; ///< [rad] of the normal from shoe to surface, from y towards z
    double gap;    ///< [m] between a shoe in its centred place and the surface; < 0: pressed
    ld_surface_shape shape;
} ld_surface;

/// Six flat surfaces: over, under and beside both lips of a slot.
typedef struct ld_t_slot {
    double at[2];    ///< [m] y, z of its middle, from the guide line
    double lips;     ///< [m] from one lip's middle to the other's, along z
    double gap;      ///< [m] over and under the lips
    double side_gap; ///< [m] on either side
} ld_t_slot;

/// Round surfaces around the guide line, evenly spaced.
typedef struct ld_tower {
    int rails;
    double first;  ///< [rad] of the first rail, from y towards z
    double gap;    ///< [m] radial
    double radius; ///< [m] from the guide line to the rails' surfaces, where friction acts
} ld_tower;

typedef enum ld_guide_form {
    LD_GUIDE_SURFACES,
    LD_GUIDE_T_SLOT,
    LD_GUIDE_TOWER,
} ld_guide_form;

/// What guides the rocket. Of surfaces: guide_surfaces() in model/guide.h makes one list of each
/// form.
typedef struct ld_guide {
    bool present; ///< false: a bore, with a radial clearance for each adaptor
    ld_guide_form form;
    double line[2]; ///< [m] y, z of the guide line, from the elastic axis
    int surface_count;
    ld_surface surface[LD_MAX_SURFACES];
    ld_t_slot t_slot;
    ld_tower tower;
} ld_guide;

#endif
