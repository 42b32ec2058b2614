// The arrays of a launcher's geometry under way.
#ifndef LD_STATE_GEOMETRY_ARRAYS_H
#define LD_STATE_GEOMETRY_ARRAYS_H

#include "elements/tube/flexible_tube.h"
#include "elements/tube/initial_shape.h"
#include "launchdyn/results.h"
#include "model/model.h"
#include "systems/mechanism/mechanism.h"

enum { GEOMETRY_MOST_ARRAYS = 100, GEOMETRY_NAME = 32 };

// Their values lie one after the other in `value`; names that are made stand in `name`.
typedef struct geometry {
    ld_array array[GEOMETRY_MOST_ARRAYS];
    char name[GEOMETRY_MOST_ARRAYS][GEOMETRY_NAME];
    size_t count;
    double *value;
    size_t used;
} geometry;

// Room for one more array, to be filled row by row; one without numbers is left out.
double *geometry_add(geometry *all, const char *name, const char *unit, size_t rows, size_t columns,
                     const char *description);
void geometry_add_row(geometry *all, const char *name, const char *unit, int count,
                      const double *values, const char *description);

// Shapes and sections of a tube or beam, as OF.station and so on; numbers of the shapes.
void geometry_add_shapes(geometry *all, const char *of, const flexible_tube *tube);
void geometry_add_sections(geometry *all, const char *of, const ld_section *section, int count);
size_t geometry_shapes_room(const flexible_tube *tube);
// The guide's initial shape, NULL where it is straight.
void geometry_add_initial_shape(geometry *all, const initial_shape *shape);
size_t geometry_initial_shape_room(const initial_shape *shape);

// Bodies, beams, joints and force elements of a base of kind multibody; numbers that they take, 0
// where there is none.
void geometry_add_mechanism(geometry *all, const mechanism_system *mechanism);
size_t geometry_mechanism_room(const mechanism_system *mechanism);

#endif
