// Finite elements of the bare tube: a mesh along x, and on it three kinds of line (bending in one
// plane, torsion, stretch), each with its consistent mass.
//
// Bending: Euler-Bernoulli beam, cubic Hermite shapes, nodal degrees of freedom (value, slope);
// with a shear coefficient Timoshenko's beam, (value, turn of the section), exact static shapes.
// Torsion and stretch: bar, linear shapes, nodal value. The stiffness is never assembled: a tube
// clamped at one end is statically determinate, so the elements' own deformations (their natural
// modes; Argyris 1964) are coordinates, one by one, in which the elastic stiffness is diagonal.
// Low modes keep all their digits on fine meshes that way, where a stiffness matrix loses h^4.
#ifndef LD_ELEMENTS_BEAM_FINITE_ELEMENTS_H
#define LD_ELEMENTS_BEAM_FINITE_ELEMENTS_H

#include "launchdyn/status.h"
#include "model/blocks/tubes.h"

// Stations of the nodes: at section steps, point masses and supports, evenly between them.
typedef struct tube_mesh {
    int elements;
    double *node; // [elements + 1] [m], owned
    int *section; // [elements] index of the section an element lies in, owned
} tube_mesh;

// Of deflections along y, along z; and both planes as one line with the mean of what they have.
enum { PLANE_Y, PLANE_Z, PLANES_ALIKE };

typedef enum line_kind { LINE_BENDING, LINE_TORSION, LINE_STRETCH } line_kind;

// One family of deformation. Nodal vectors have `width` numbers a node, first the value and then,
// in bending, the slope; those of clamped shapes leave out the node at x = 0.
typedef struct tube_line {
    line_kind kind;
    int plane; // of bending
    const tube_mesh *mesh;
    int width;     // degrees of freedom a node, and rigid shapes (1, x): 2 bending, 1 bars
    int n;         // degrees of freedom of the clamped line
    double *shape; // [n][n] nodal vectors of the clamped line with one element deformed alone,
                   // row by row: elastic stiffness E, f^T K f = 1
    double *mass;  // [n][n] mass matrix in the amplitudes of these shapes [s2]
    double low;    // [1/s2] below the lowest clamped omega^2, and close to it: 1 / trace of mass
    double *moment[2];  // [n] nodal vectors M 1 and M x: their products with a shape f are the
                        // integrals of f and x f over mass (torsion: over polar inertia)
    double rigid[2][2]; // integrals of 1, x; x, x^2 over the same, rotary inertia included
    double *shear;      // [elements] 12 E I/(k G A h^2); NULL: rigid in shear
    double *rotary;     // [elements] [kg m2] rho I h of the plane, where there is shear
} tube_line;

// Lays the mesh: model->modes.elements elements, or as many as the stations ask for.
ld_status tube_mesh_build(tube_mesh *mesh, const ld_tubes *model, ld_error *error);
void tube_mesh_free(tube_mesh *mesh);

// Index of the element that holds station x: the first for x < 0, the last for x >= L, the one
// that begins there at an inner node.
int tube_mesh_find(const tube_mesh *mesh, double x);

// Assembles a line on `mesh` (which must outlive it), for bending that of a plane.
ld_status tube_line_build(tube_line *line, line_kind kind, int plane, const tube_mesh *mesh,
                          const ld_tubes *model, ld_error *error);
void tube_line_free(tube_line *line);

// Value at station x [m] of the shape with nodal vector `nodal` [n]; slope: its x-derivative.
double tube_line_value(const tube_line *line, const double *nodal, double x);
double tube_line_slope(const tube_line *line, const double *nodal, double x);

// Coefficients of xi^k, xi = x - x0, of the shape with nodal vector `nodal` [n] in an element.
void tube_line_polynomial(const tube_line *line, const double *nodal, int element,
                          double coefficient[4]);
// Shear strain of that shape in the element: slope of the axis less turn of the section.
double tube_line_strain(const tube_line *line, const double *nodal, int element);

#endif
