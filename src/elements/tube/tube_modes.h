// Modes of the tube's lines, and from them the shapes of the flexible tube: tangent form,
// orthonormal (theory-tube.md).
#ifndef LD_ELEMENTS_TUBE_MODES_H
#define LD_ELEMENTS_TUBE_MODES_H

#include "elements/tube/beam_finite_elements.h"

// What is tied to a line besides itself: the tail's rigid mass at x = 0 and the supports.
typedef struct line_ties {
    double tail[2][2]; // tail's mass for the rigid shapes 1 and x (bars: 1 only)
    int springs;
    double at[LD_MAX_SUPPORTS];    // [m]
    double value[LD_MAX_SUPPORTS]; // stiffness against the shape's value
    double slope[LD_MAX_SUPPORTS]; // and, in bending, against its slope
    int held;                      // values and slopes that are held rigidly
    double held_at[LD_MAX_CLAMPED];
    bool held_slope[LD_MAX_CLAMPED];
} line_ties;

// A line with what is tied to it.
typedef struct tied_line {
    const tube_line *line;
    line_ties ties;
} tied_line;

// What a plane's bending stiffness is of the mean of both.
static inline double section_share(const ld_section *section, int plane)
{
    double along_y = section_stiffness_z(section), along_z = section_stiffness_y(section);
    return (plane == PLANE_Y ? along_y : along_z) / (0.5 * (along_y + along_z));
}

void tied_line_make(tied_line *self, const tube_line *line, const ld_tubes *model);

// The `wanted` lowest natural frequencies and modes of the free line with its ties, order N = n +
// width: rows of `vector` [requested][N] (rigid shapes, amplitudes of the elements) from the
// highest to the lowest, omega^2 [1/s2] in `lambda` [N] in the same order.
ld_status tied_line_solve(const tied_line *self, int wanted, double *vector, double *lambda,
                          ld_error *error);

// Whether both planes have the same shapes: their bending stiffnesses and, where the span has them,
// the springs of their supports are in one proportion; held are the same directions, and the tail
// has one inertia about y and z. Shapes and frequencies are then those of the line of their mean,
// the latter times the root of a plane's share.
bool tube_planes_alike(const ld_tubes *model);

// The shapes chosen on a line and the frequencies of its own with them, clamped at x = 0.
typedef struct line_shapes {
    int count;
    int slowed;                       // of these the last ones, at the cut
    double om2[LD_MAX_BENDING_MODES]; // [1/s2]
    double *nodal;                    // [count][n] nodal vectors, owned
} line_shapes;

// Chooses shapes->count shapes of the span that the model asks for.
ld_status line_shapes_choose(line_shapes *shapes, const tube_line *line, const ld_tubes *model,
                             ld_error *error);
// Selective mass scaling (theory-tube.md): shapes faster than the cut [Hz] keep b b^T / omega^2,
// what they give way to at rest, and have the cut's frequency.
void line_shapes_slow(line_shapes *shapes, const tube_line *line, double cut);
void line_shapes_free(line_shapes *shapes);

#endif
