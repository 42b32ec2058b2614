// Equations of motion by d'Alembert's principle, of point masses whose places are given functions
// of coordinates q and time t: sum J^T (m a - F) = Q. Jacobians and velocities are derivatives by
// complex steps, so that the places, written out by hand, are all that a mechanism has to say. A
// rigid body is six point masses on its principal axes. Nothing of launchdyn's equations is used.
#ifndef LD_TESTS_SUPPORT_POINT_MASSES_H
#define LD_TESTS_SUPPORT_POINT_MASSES_H

#include <complex.h>
#include <stdbool.h>

typedef double complex cplx;

enum { MOST_COORDINATES = 60, MOST_POINTS = 400, MOST_EXTRA = 8, RIGID_POINTS = 6 };

// What the forces may depend on.
typedef struct mass_motion {
    const double *q, *u, *z;
    double r[MOST_POINTS][3], v[MOST_POINTS][3]; // [m], [m/s]
} mass_motion;

typedef struct mass_system {
    int coordinates, extra, points; // extra: states z with rates of their own
    double mass[MOST_POINTS];       // [kg] 0: a marker, for forces
    double gravity;                 // [m/s2] along -y
    bool held[MOST_COORDINATES];    // keeps its value
    void (*place)(const void *self, cplx t, const cplx *q, cplx (*r)[3]);
    // Adds forces F [N] on points and Q on coordinates, sets the rates of z.
    void (*push)(const void *self, double t, const mass_motion *now, double (*F)[3], double *Q,
                 double *z_dot);
    const void *self;
} mass_system;

// The point masses of a rigid body with its mass centre c [m] and moments of inertia J [kg m2]
// about it, in its axes, which are principal ones.
void rigid_points(double mass, const double c[3], const double J[3], double point[][3],
                  double *point_mass);

// State y = (q, u, z). Its rates at t; what holds the held coordinates (NULL: not asked for).
void masses_rates(const mass_system *system, double t, const double *y, double *y_dot,
                  double *holding);
// A step of the classical Runge-Kutta method.
void masses_step(const mass_system *system, double t, double h, double *y);

// Rotations, by rows: about z, y and x.
typedef struct cplx_matrix {
    cplx a[3][3];
} cplx_matrix;
cplx_matrix turn_x(cplx angle);
cplx_matrix turn_y(cplx angle);
cplx_matrix turn_z(cplx angle);
cplx_matrix turns(cplx_matrix first, cplx_matrix second);
// to = from + A p
void put_point(const cplx from[3], const cplx_matrix *A, const double p[3], cplx to[3]);

// Adds the force of a spring-damper between two points.
typedef struct mass_spring {
    double stiffness, damping, length; // [N/m], [N s/m], [m] unloaded
} mass_spring;
void add_spring(const mass_motion *now, int a, int b, const mass_spring *spring, double (*F)[3]);
// Distance of two points and its rate.
double distance_of(const mass_motion *now, int a, int b, double *rate);
// Force f [N] on b along the line from a, and back on a.
void push_apart(const mass_motion *now, int a, int b, double f, double (*F)[3]);

#endif
