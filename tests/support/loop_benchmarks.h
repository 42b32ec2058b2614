// The problems A01 to A05 of IFToMM's library of computational benchmarks for multibody systems:
// simple pendulum, N four-bar mechanism, Andrews' squeezer, Bricard's mechanism, flyball governor.
#ifndef LD_TESTS_SUPPORT_LOOP_BENCHMARKS_H
#define LD_TESTS_SUPPORT_LOOP_BENCHMARKS_H

#include "launchdyn/mstmm.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct benchmark {
    ld_mstmm *system;
    double *q, *u;            // start
    double end;               // [s]
    ld_mstmm_settings drives; // drive and context alone
    ld_mstmm_assembly found;
} benchmark;

static void benchmark_fail(const char *text)
{
    fprintf(stderr, "%s\n", text);
    exit(1);
}

// Builds, and closes the loops from the guess and speeds given, of which element 0 keeps its own.
static benchmark benchmark_build(const ld_mstmm_description *d, const double *q, const double *u,
                                 double end)
{
    benchmark b = {.end = end};
    ld_error error;
    if (ld_mstmm_build(d, &b.system, &error))
        benchmark_fail(error.text);
    size_t nq = (size_t)ld_mstmm_coordinate_count(b.system);
    size_t nu = (size_t)ld_mstmm_speed_count(b.system);
    b.q = calloc(nq + nu, sizeof *b.q);
    int *kept = calloc((size_t)d->element_count, sizeof *kept);
    if (!b.q || !kept)
        benchmark_fail("no memory");
    b.u = b.q + nq;
    memcpy(b.q, q, nq * sizeof *q);
    memcpy(b.u, u, nu * sizeof *u);
    kept[0] = 1;
    if (d->loop_count > 0 && ld_mstmm_assemble(b.system, b.q, b.u, kept, &b.found, &error))
        benchmark_fail(error.text);
    free(kept);
    b.drives.context = b.system;
    return b;
}

static inline void benchmark_free(benchmark *b)
{
    ld_mstmm_free(b->system);
    free(b->q);
}

static inline double benchmark_energy(const benchmark *b, const double *q, const double *u)
{
    ld_mstmm_energies e = ld_mstmm_energy(b->system, q, u);
    return e.kinetic + e.potential + e.elastic;
}

typedef struct planar_point {
    double x, y;
} planar_point;

// A body whose hinge turns about z.
static inline ld_mstmm_element planar_body(const char *name, const char *parent, planar_point at,
                                           double mass, planar_point center, double inertia)
{
    return (ld_mstmm_element){.name = name,
                              .parent = parent,
                              .at = {at.x, at.y, 0},
                              .hinge = LD_HINGE_REVOLUTE,
                              .axis = {0, 0, 1},
                              .mass = mass,
                              .center = {center.x, center.y, 0},
                              .inertia = {inertia, inertia, inertia}};
}

static inline ld_mstmm_loop planar_pin(const char *name, const char *first, planar_point at,
                                       const char *second, planar_point at_2)
{
    return (ld_mstmm_loop){.name = name,
                           .first = {.element = first, .at = {at.x, at.y, 0}},
                           .second = {.element = second, .at = {at_2.x, at_2.y, 0}},
                           .joint = LD_HINGE_REVOLUTE,
                           .axis = {0, 0, 1}};
}

// ---- A01: a point mass on a rod of 1 m, released at the horizontal

static inline benchmark simple_pendulum(void)
{
    ld_mstmm_element e =
        planar_body("bob", NULL, (planar_point){0, 0}, 1, (planar_point){-1, 0}, 0);
    const ld_mstmm_description d = {.elements = &e, .element_count = 1, .gravity = {0, -9.81, 0}};
    const double q[1] = {0}, u[1] = {0};
    return benchmark_build(&d, q, u, 10);
}

// ---- A02: N windows of rods of 1 m and 1 kg, upright, their top moving at 1 m/s

static inline benchmark four_bars(int n)
{
    const size_t rods = 2 * (size_t)n + 1;
    ld_mstmm_element *e = calloc(rods, sizeof *e);
    ld_mstmm_loop *l = calloc((size_t)n, sizeof *l);
    char(*name)[24] = calloc(rods + (size_t)n, sizeof *name);
    double *q = calloc(2 * rods, sizeof *q), *u = q + rods;
    if (!e || !l || !name || !q)
        benchmark_fail("no memory");
    for (int i = 0; i <= n; i++) {
        snprintf(name[i], sizeof *name, "upright %d", i);
        e[i] =
            planar_body(name[i], NULL, (planar_point){i, 0}, 1, (planar_point){0, 0.5}, 1.0 / 12);
    }
    for (int i = 0; i < n; i++) {
        snprintf(name[n + 1 + i], sizeof *name, "bar %d", i);
        snprintf(name[rods + (size_t)i], sizeof *name, "pin %d", i);
        e[n + 1 + i] = planar_body(name[n + 1 + i], name[i], (planar_point){0, 1}, 1,
                                   (planar_point){0.5, 0}, 1.0 / 12);
        l[i] = planar_pin(name[rods + (size_t)i], name[n + 1 + i], (planar_point){1, 0},
                          name[i + 1], (planar_point){0, 1});
    }
    u[0] = -1;
    const ld_mstmm_description d = {.elements = e,
                                    .element_count = (int)rods,
                                    .loops = l,
                                    .loop_count = n,
                                    .gravity = {0, -9.81, 0}};
    benchmark b = benchmark_build(&d, q, u, 10);
    free(e);
    free(l);
    free(name);
    free(q);
    return b;
}

// ---- A03: seven bodies, a motor's torque at O, a spring from C to D

enum { SQUEEZER_TRIANGLE = 2 };

static const double squeezer_torque = 0.033, squeezer_stiffness = 4530, squeezer_rest = 0.07785;

// The spring from the ground to D: its length, and the force on the triangle.
static inline double squeezer_spring(double gamma, double force[2], double arm[2])
{
    const double B[2] = {-0.03635, 0.03273}, C[2] = {0.014, 0.072}, s = sin(gamma), c = cos(gamma);
    arm[0] = 0.02 * c + 0.018 * s;
    arm[1] = 0.02 * s - 0.018 * c;
    double d[2] = {C[0] - B[0] - arm[0], C[1] - B[1] - arm[1]}, length = hypot(d[0], d[1]);
    for (int k = 0; k < 2; k++)
        force[k] = squeezer_stiffness * (length - squeezer_rest) * d[k] / length;
    return length;
}

static inline void squeezer_drive(double t, const double *q, const double *u, double *tau,
                                  double *wrench, void *context)
{
    (void)t, (void)u, (void)context;
    double force[2], arm[2], *on = wrench + 6 * SQUEEZER_TRIANGLE;
    squeezer_spring(q[SQUEEZER_TRIANGLE], force, arm);
    on[0] = force[0];
    on[1] = force[1];
    on[5] = arm[0] * force[1] - arm[1] * force[0];
    tau[0] = squeezer_torque;
}

// Kinetic energy and the spring's, less the motor's work from the angle beta_0 on.
static inline double squeezer_balance(const benchmark *b, const double *q, const double *u,
                                      double beta_0)
{
    double force[2], arm[2],
        off = squeezer_spring(q[SQUEEZER_TRIANGLE], force, arm) - squeezer_rest;
    return ld_mstmm_energy(b->system, q, u).kinetic + 0.5 * squeezer_stiffness * off * off -
           squeezer_torque * (q[0] - beta_0);
}

static inline benchmark andrews_squeezer(double beta)
{
    const double A[2] = {-0.06934, -0.00227}, B[2] = {-0.03635, 0.03273};
    const ld_mstmm_element e[7] = {
        planar_body("OF", NULL, (planar_point){0, 0}, 0.04325, (planar_point){0.00092, 0},
                    2.194e-6),
        planar_body("FE", "OF", (planar_point){0.007, 0}, 0.00365, (planar_point){-0.0115, 0},
                    4.410e-7),
        planar_body("BDE", NULL, (planar_point){B[0], B[1]}, 0.02373,
                    (planar_point){0.01043, -0.01874}, 5.255e-6),
        planar_body("AG", NULL, (planar_point){A[0], A[1]}, 0.07050,
                    (planar_point){0.02308, 0.00916}, 1.169e-5),
        planar_body("GE", "AG", (planar_point){0.04, 0}, 0.00706, (planar_point){0, -0.00579},
                    5.667e-7),
        planar_body("AH", NULL, (planar_point){A[0], A[1]}, 0.05498,
                    (planar_point){-0.00449, -0.01228}, 1.912e-5),
        planar_body("HE", "AH", (planar_point){0, -0.04}, 0.00706, (planar_point){0.00579, 0},
                    5.667e-7),
    };
    const ld_mstmm_loop l[3] = {
        planar_pin("E of FE", "BDE", (planar_point){0, -0.035}, "FE", (planar_point){-0.028, 0}),
        planar_pin("E of GE", "BDE", (planar_point){0, -0.035}, "GE", (planar_point){0, -0.02}),
        planar_pin("E of HE", "BDE", (planar_point){0, -0.035}, "HE", (planar_point){0.02, 0})};
    const ld_mstmm_description d = {.elements = e, .element_count = 7, .loops = l, .loop_count = 3};
    const double q[7] = {beta, 0, 0.45, 0.49, 0.22, 1.23, -0.22}, u[7] = {0};
    benchmark b = benchmark_build(&d, q, u, 0.05);
    b.drives.drive = squeezer_drive;
    return b;
}

// ---- A04: five rods of 1 m and 1 kg, six pins, a square section of 0.1 m

static inline benchmark bricard(void)
{
    static const char *const name[5] = {"1", "2", "3", "4", "5"};
    // along the cube's edges, in inertial axes
    static const double along[5][3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}};
    static const double axis[6][3] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0},
                                      {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    ld_mstmm_element e[5];
    memset(e, 0, sizeof e);
    for (int i = 0; i < 5; i++) {
        e[i].name = name[i];
        e[i].parent = i ? name[i - 1] : NULL;
        e[i].hinge = LD_HINGE_REVOLUTE;
        e[i].mass = 1;
        for (int k = 0; k < 3; k++) {
            e[i].at[k] = i ? along[i - 1][k] : 0;
            e[i].axis[k] = axis[i][k];
            e[i].center[k] = 0.5 * along[i][k];
            e[i].inertia[k] = along[i][k] != 0 ? 0.02 / 12 : 1.01 / 12;
        }
    }
    ld_mstmm_loop l = {.name = "sixth",
                       .first = {.element = "5", .at = {0, 1, 0}},
                       .second = {.at = {0, 0, 1}},
                       .joint = LD_HINGE_REVOLUTE,
                       .axis = {1, 0, 0}};
    const ld_mstmm_description d = {
        .elements = e, .element_count = 5, .loops = &l, .loop_count = 1, .gravity = {0, -9.81, 0}};
    const double q[5] = {0}, u[5] = {0};
    return benchmark_build(&d, q, u, 10);
}

// ---- A05: shaft, slider, two rods with masses; springs and dampers from rods to slider

enum { GOVERNOR_SLIDER = 1, GOVERNOR_ROD = 2 };

// Spring and damper between the middle of a rod and the slider, in the plane of both: x outwards
// from the hinge, z up. The rod hangs at the angle a below the horizontal.
static inline void governor_drive(double t, const double *q, const double *u, double *tau,
                                  double *wrench, void *context)
{
    (void)t, (void)context, (void)wrench;
    for (int side = 0; side < 2; side++) {
        const double a = q[GOVERNOR_ROD + side], a_dot = u[GOVERNOR_ROD + side];
        const double s = q[GOVERNOR_SLIDER], s_dot = u[GOVERNOR_SLIDER];
        const double x = 0.5 * cos(a), z = 1 - 0.5 * sin(a) - s, length = hypot(x, z);
        const double x_dot = -0.5 * sin(a) * a_dot, z_dot = -0.5 * cos(a) * a_dot - s_dot;
        const double pull = 8e5 * (length - 0.5) + 4e4 * (x * x_dot + z * z_dot) / length;
        tau[GOVERNOR_SLIDER] += pull * z / length;
        tau[GOVERNOR_ROD + side] += pull * (0.5 * sin(a) * x + 0.5 * cos(a) * z) / length;
    }
}

static inline benchmark flyball_governor(void)
{
    const double rod = 0.3, thin = 0.3 * 2e-4 / 12, wide = 0.3 * 1.0001 / 12;
    const ld_mstmm_element e[6] = {
        {.name = "shaft",
         .hinge = LD_HINGE_REVOLUTE,
         .axis = {0, 0, 1},
         .mass = rod,
         .center = {0, 0, 0.5},
         .inertia = {wide, wide, thin}},
        {.name = "slider",
         .parent = "shaft",
         .hinge = LD_HINGE_PRISMATIC,
         .axis = {0, 0, 1},
         .mass = 3,
         .inertia = {0.005, 0.005, 0.005}},
        {.name = "right rod",
         .parent = "shaft",
         .at = {0.05, 0, 1},
         .hinge = LD_HINGE_REVOLUTE,
         .axis = {0, 1, 0},
         .mass = rod,
         .center = {0.5, 0, 0},
         .inertia = {thin, wide, wide}},
        {.name = "left rod",
         .parent = "shaft",
         .at = {-0.05, 0, 1},
         .hinge = LD_HINGE_REVOLUTE,
         .axis = {0, -1, 0},
         .mass = rod,
         .center = {-0.5, 0, 0},
         .inertia = {thin, wide, wide}},
        {.name = "right ball", .parent = "right rod", .at = {1, 0, 0}, .mass = 5},
        {.name = "left ball", .parent = "left rod", .at = {-1, 0, 0}, .mass = 5},
    };
    const ld_mstmm_description d = {.elements = e, .element_count = 6, .gravity = {0, 0, -9.81}};
    const double q[4] = {0, 0.5, acos(-1) / 6, acos(-1) / 6}, u[4] = {2 * acos(-1), 0, 0, 0};
    benchmark b = benchmark_build(&d, q, u, 10);
    b.drives.drive = governor_drive;
    return b;
}

#endif
