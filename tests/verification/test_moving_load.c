// Moving force and moving mass through the whole launching subsystem (formulation.md, section 7,
// item 8): the rocket is a point mass on its rear adaptor, held on the axis of a simply supported
// tube; a thrust across the tube is the load, so that the tube has no weight of its own. Values:
// Fryba's series for the force; for the mass converged values of sine modes.
// ctest: slow
#include <stdlib.h>

#include "model/model.h"
#include "support/check.h"
#include "support/launching_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_kinematics.h"

// Pins that hold rigidly in place of springs, an adaptor on the axis exactly.
static void hold_rigidly(ld_model *model)
{
    const unsigned across = 1u << LD_CLAMP_Y | 1u << LD_CLAMP_Z;
    for (int k = 0; k < 2; k++)
        model->tubes.support[k] = (ld_support){.at = k * model->tubes.length, .clamped = across};
    model->tubes.support[0].clamped |= 1u << LD_CLAMP_X | 1u << LD_CLAMP_ROLL;
    model->rocket.adaptor_count = 2;
    model->rocket.contact = (ld_contact){.law = LD_CONTACT_IDEAL, .stiffness = NAN, .exponent = 1};
}

// Tube on pins at both ends, without tail and damping. What pins and adaptor give way by is below
// 1e-4 of the tube's deflection.
static void pinned_model(ld_model *model, double mass, bool rigid)
{
    reference_model(model);
    model->gravity = 0;
    ld_tubes *tubes = &model->tubes;
    tubes->tail = (ld_tail){0};
    tubes->modes.damping = 0;
    tubes->modes.bending = 24;
    tubes->modes.torsion = 1;
    tubes->modes.elements = 60;
    tubes->slot.kind = LD_SLOT_NONE;
    for (int k = 0; k < 2; k++) {
        ld_support *support = &tubes->support[k];
        *support = (ld_support){.at = k * tubes->length};
        support->stiffness[0] = k == 0 ? 1e9 : 0;
        support->stiffness[1] = support->stiffness[2] = 1e11;
        support->rotational_stiffness[0] = k == 0 ? 1e7 : 0;
    }
    ld_rocket *rocket = &model->rocket;
    rocket->full = (ld_mass_data){mass, {0, 0, 0}, {1, 1, 1}};
    rocket->contact.law = LD_CONTACT_BILATERAL;
    rocket->contact.stiffness = 2e10 * fmin(1, mass / 3);
    rocket->contact.damping = 2 * sqrt(rocket->contact.stiffness * mass);
    rocket->contact.friction = 0;
    rocket->motor.misalignment[0] = -1e9; // across the tube
    if (rigid)
        hold_rigidly(model);
}

typedef struct crossing {
    double unit;                           // [m] P L^3/(48 EI)
    double T;                              // [s]
    double largest, at, half, last, under; // as in the table
    double t_last;
} crossing;

static void watch(launching_run *run, double t)
{
    crossing *c = run->user;
    launching_section middle, below;
    launching_section_at(run->system, run->state, 0.5 * run->system->tube.flexible.length, &middle);
    launching_section_at(run->system, run->state, run->state[run->system->layout.x], &below);
    const double *state = run->state;
    const launching_layout *at = &run->system->layout;
    m3 A = q_matrix(q_from(state + at->quaternion));
    double w = -(state[at->r + 1] + m3_apply(A, middle.P).y) / c->unit;
    double under = -(state[at->r + 1] + m3_apply(A, below.P).y) / c->unit;
    if (w > c->largest) {
        c->largest = w;
        c->at = t / c->T;
    }
    if (c->t_last < 0.5 * c->T && t >= 0.5 * c->T) // linear between steps
        c->half = w + (c->last - w) * (t - 0.5 * c->T) / (t - c->t_last);
    c->under = fmax(c->under, under);
    c->last = w;
    c->t_last = t;
}

static crossing cross(double kappa, double alpha, bool rigid)
{
    const double pi = 3.14159265358979323846;
    ld_model model;
    launching_run run;
    reference_model(&model);
    double L = model.tubes.length, EI = model.tubes.section[0].bending_stiffness;
    double mu = model.tubes.section[0].mass_per_length, load = 1e-1;
    reference_model_free(&model);
    pinned_model(&model, kappa * mu * L, rigid);
    launching_system *system = launching_system_of(&model);
    double v = alpha * pi / L * sqrt(EI / mu);
    crossing c = {.unit = load * L * L * L / (48 * EI), .T = L / v};
    launching_run_begin(&run, system, 0);
    run.phase.passed[1] = run.phase.passed[2] = true;
    run.input.thrust = load;
    run.state[system->layout.V] = v;
    run.after_step = watch;
    run.user = &c;
    launching_run_follow(&run, 1e-9, c.T);
    printf("  kappa %g, alpha %g: %d steps\n", kappa, alpha, (int)run.steps);
    CHECK_NEAR("place at the end [m]", run.state[system->layout.x], L, 5e-10);
    launching_system_drop(system);
    reference_model_free(&model);
    return c;
}

// A mass of 0.1 and 0.2 percent of the tube's carries the force; extrapolated to none.
static void moving_force(void **state)
{
    (void)state;
    static const double table[4][5] = {{0.10, 1.09645, 0.5435, 1.00997, 0},
                                       {0.25, 1.25761, 0.4021, 1.06579, 0},
                                       {0.50, 1.70545, 0.6666, 1.32888, 0},
                                       {1.00, 1.54807, 1.0000, 0.51311, 1.54807}};
    for (int i = 0; i < 4; i++) {
        const double *row = table[i];
        crossing twice = cross(2e-3, row[0], false), c = cross(1e-3, row[0], false);
        CHECK_NEAR("largest at midspan", 2 * c.largest - twice.largest, row[1], 5e-5);
        CHECK_NEAR("at t/T", 2 * c.at - twice.at, row[2], 7e-4);
        CHECK_NEAR("at t = T/2", 2 * c.half - twice.half, row[3], 2e-5);
        CHECK_NEAR("at exit", 2 * c.last - twice.last, row[4], 7e-5);
    }
}

static void cross_as_published(bool rigid)
{
    // kappa, alpha, largest at midspan, its t/T, at T/2, at exit, largest under the mass
    static const double table[5][7] = {{0.1, 0.25, 1.28719, 0.4235, 1.17916, 0.14304, 1.26637},
                                       {0.1, 0.50, 1.76290, 0.7105, 1.25278, 0.27371, 1.59148},
                                       {0.2, 0.25, 1.31817, 0.4440, 1.26859, 0.19678, 1.30765},
                                       {0.2, 0.50, 1.82459, 0.7450, 1.18350, 0.56840, 1.57907},
                                       {0.5, 0.50, 2.02212, 0.8545, 1.01626, 1.39501, 1.52453}};
    for (int i = 0; i < 5; i++) {
        const double *row = table[i];
        crossing c = cross(row[0], row[1], rigid);
        CHECK_NEAR("largest at midspan", c.largest, row[2], 2e-4);
        CHECK_NEAR("at t/T", c.at, row[3], 4e-4);
        CHECK_NEAR("at t = T/2", c.half, row[4], 3e-5);
        CHECK_NEAR("at exit", c.last, row[5], 5e-4);
        CHECK_NEAR("largest under the mass", c.under, row[6], 1e-4);
    }
}

static void moving_mass(void **state)
{
    (void)state;
    cross_as_published(false);
}

static void moving_mass_on_rigid_pins(void **state)
{
    (void)state;
    cross_as_published(true);
}

// ---- a mass on a beam with initial curvature ----

// A light mass m on the half wave y = a sin(pi x/L) presses with m v^2 a (pi/L)^2 sin(pi v t/L), so
// that mode n of the beam has
//   q_n'' + omega_n^2 q_n = m/(mu L) a v^2 (pi/L)^2 (cos (n - 1) W t - cos (n + 1) W t), W = pi v/L
// A mode cos(p t) of the right side leaves (cos p t - cos omega t)/(omega^2 - p^2).
static double bent_beam_at_middle(const ld_model *model, double v, int modes, double t)
{
    const ld_section *beam = &model->tubes.section[0];
    double L = model->tubes.length, W = 3.14159265358979323846 * v / L, sum = 0;
    double size = model->rocket.full.mass / (beam->mass_per_length * L) * W * W;
    for (int n = 1; n <= modes; n += 2) { // even ones rest in the middle
        double omega =
            n * n * W / v * W / v * sqrt(beam->bending_stiffness / beam->mass_per_length);
        for (int side = -1; side < 2; side += 2) {
            double p = (n + side) * W;
            sum -= side * size * (n % 4 == 1 ? 1 : -1) * (cos(p * t) - cos(omega * t)) /
                   (omega * omega - p * p);
        }
    }
    return sum;
}

typedef struct bent_crossing {
    const ld_model *model;
    double v, a[2]; // [m] of the initial half wave along y, z
    double miss[2], largest;
} bent_crossing;

static void watch_bent(launching_run *run, double t)
{
    bent_crossing *c = run->user;
    const launching_layout *at = &run->system->layout;
    launching_section middle;
    launching_section_at(run->system, run->state, 0.5 * run->system->tube.flexible.length, &middle);
    m3 A = q_matrix(q_from(run->state + at->quaternion));
    v3 P = v3_add(v3_from(run->state + at->r), m3_apply(A, middle.P));
    double unit = bent_beam_at_middle(c->model, c->v, c->model->tubes.modes.bending, t);
    c->largest = fmax(c->largest, fabs(unit));
    c->miss[0] = fmax(c->miss[0], fabs(P.y / c->a[0] - unit));
    c->miss[1] = fmax(c->miss[1], fabs(P.z / c->a[1] - unit));
}

// Largest error of the deflection in the middle, of the largest, with a mass of kappa times the
// beam's.
static void cross_bent(double kappa, double alpha, double error[2])
{
    ld_model model;
    launching_run run;
    reference_model(&model);
    double L = model.tubes.length, EI = model.tubes.section[0].bending_stiffness;
    double mu = model.tubes.section[0].mass_per_length;
    reference_model_free(&model);
    pinned_model(&model, kappa * mu * L, true);
    model.tubes.modes.bending = 6;
    model.tubes.initial_shape =
        (ld_initial_shape){.present = true,
                           .seed = 5,
                           .random = {.present = true, .deviation = 1e-4, .terms = 1, .decay = 2}};
    launching_system *system = launching_system_of(&model);
    bent_crossing c = {.model = &model, .v = alpha * 3.14159265358979323846 / L * sqrt(EI / mu)};
    initial_section middle;
    initial_shape_at(system->tube.initial, L / 2, &middle);
    c.a[0] = middle.P.y;
    c.a[1] = middle.P.z;
    launching_run_begin(&run, system, 0);
    run.phase.passed[1] = run.phase.passed[2] = true;
    run.state[system->layout.V] = c.v;
    launching_project(system, &run.input, &run.phase, run.state);
    run.after_step = watch_bent;
    run.user = &c;
    launching_run_follow(&run, 1e-10, 0.98 * L / c.v);
    printf("  kappa %g, alpha %g, a %.3g and %.3g m: largest %.4g a, %d steps\n", kappa, alpha,
           c.a[0], c.a[1], c.largest, (int)run.steps);
    for (int k = 0; k < 2; k++)
        error[k] = c.miss[k] / c.largest;
    launching_system_drop(system);
    reference_model_free(&model);
}

// What the mass's own motion adds goes with its share kappa.
static void moving_mass_on_bent_beam(void **state)
{
    (void)state;
    static const double alpha[] = {0.11, 0.37, 0.8};
    for (int i = 0; i < 3; i++) {
        double error[2], twice[2];
        cross_bent(2e-3, alpha[i], twice);
        cross_bent(1e-3, alpha[i], error);
        for (int k = 0; k < 2; k++) {
            CHECK_BELOW("deflection in the middle, of the largest", error[k], 4e-3);
            CHECK_WITHIN("its order in the mass", log2(twice[k] / error[k]), 0.99, 1.01);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moving_force),
        cmocka_unit_test(moving_mass),
        cmocka_unit_test(moving_mass_on_rigid_pins),
        cmocka_unit_test(moving_mass_on_bent_beam),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
