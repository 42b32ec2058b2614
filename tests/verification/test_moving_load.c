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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moving_force),
        cmocka_unit_test(moving_mass),
        cmocka_unit_test(moving_mass_on_rigid_pins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
