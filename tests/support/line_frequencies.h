// Natural frequencies of the tube's finite elements with tail and supports, base held: what the
// modes of the program are taken from, whatever their number.
#ifndef LD_TESTS_SUPPORT_LINE_FREQUENCIES_H
#define LD_TESTS_SUPPORT_LINE_FREQUENCIES_H

#include <stdlib.h>

#include "elements/tube/tube_modes.h"
#include "support/check.h"

// The `count` lowest [rad/s], ascending, of a line as it is in a plane.
static inline void line_frequencies(const ld_tubes *model, line_kind kind, int plane, int count,
                                    double *omega)
{
    ld_error error;
    tube_mesh mesh;
    tube_line line;
    tied_line of_plane;
    assert_int_equal(tube_mesh_build(&mesh, model, &error), LD_OK);
    assert_int_equal(tube_line_build(&line, kind, plane, &mesh, model, &error), LD_OK);
    tied_line_make(&of_plane, &line, model);
    int N = line.n + line.width;
    double *vector = malloc((size_t)((count + 1) * N) * sizeof *vector);
    double *lambda = vector + count * N;
    assert_int_equal(tied_line_solve(&of_plane, count, vector, lambda, &error), LD_OK);
    for (int k = 0; k < count; k++)
        omega[k] = sqrt(lambda[count - 1 - k]);
    free(vector);
    tube_line_free(&line);
    tube_mesh_free(&mesh);
}

#endif
