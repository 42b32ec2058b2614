/// A line that the rocket pulls out of a container: the block `rocket.line`.
#ifndef LD_MODEL_BLOCKS_LINE_H
#define LD_MODEL_BLOCKS_LINE_H

#include <stdbool.h>

/// The end of the line in its container: held there, or free to leave it.
typedef enum ld_line_end { LD_LINE_HELD, LD_LINE_FREE } ld_line_end;
/// What the container stands on: axes I, or axes T of the (first) tube, with which it moves.
typedef enum ld_line_container { LD_LINE_ON_GROUND, LD_LINE_ON_LAUNCHER } ld_line_container;

/// Most segments.
enum { LD_LINE_MOST_SEGMENTS = 500 };

/// A line of equal properties along its length: model.md, section 8.
typedef struct ld_line {
    bool present;
    double length;          ///< [m] unstretched, in all
    double mass_per_length; ///< [kg/m]
    double diameter;        ///< [m]
    double stiffness;       ///< [N] EA: tension over strain
    double damping;         ///< [-] of a segment against its neighbours, of the critical one
    double breaking_force;  ///< [N] NaN: it does not break
    double drag_across;     ///< [-] on the diameter times the length
    double drag_along;      ///< [-] on the surface
    double bridle[3];       ///< [m] point of the rocket, in B
    double container[3];    ///< [m] where the line leaves it
    ld_line_container container_on;
    double tension; ///< [N] with which the container holds what leaves it
    double slack;   ///< [m] out of it at the start beyond the way to the bridle
    ld_line_end end;
    int segments; ///< of the whole length
} ld_line;

#endif
