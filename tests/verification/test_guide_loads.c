// What the tube carries, against closed forms: a cantilever under its own weight, a mass at its tip
// and a rocket; the influence line of a rocket on a simply supported tube; a moving force on one,
// against the sine series, whose quasi-static part is the triangle of statics.
#include <stdlib.h>

#include "model/model.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "support/check.h"
#include "support/fresh_launch.h"
#include "support/launching_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_figures.h"
#include "systems/launching/launching_kinematics.h"

static void ask_for(ld_model *model, int count, const double *at)
{
    model->tubes.station_count = count;
    for (int i = 0; i < count; i++)
        model->tubes.station[i].at = at[i];
}

// ---- statics ----

// Level, so stiff that the second order of its slopes is none; the rocket on its outer adaptors.
static void level_model(ld_model *model, double start)
{
    reference_model(model);
    model->base.elevation = 0;
    model->tubes.tail = (ld_tail){0};
    model->tubes.slot.kind = LD_SLOT_NONE;
    model->tubes.section[0].bending_stiffness *= 1e4;
    model->tubes.modes.bending = 3;
    model->rocket.start_at = start;
    for (int k = 0; k < model->tubes.support_count; k++) {
        ld_support *support = &model->tubes.support[k];
        *support = (ld_support){.at = k * model->tubes.length};
        for (int i = 0; i < 3; i++)
            support->stiffness[i] = i > 0 || k == 0 ? 1e11 : 0;
        support->rotational_stiffness[0] = 1e11;
    }
}

// Shear and bending moment at x of a beam held behind x, by hand; `held`: the force upwards at the
// tip.
static void by_hand(const ld_model *model, double x, double held, double *shear, double *moment)
{
    const ld_tubes *tubes = &model->tubes;
    const ld_rocket *rocket = &model->rocket;
    double g = model->gravity, rest = tubes->length - x;
    double w = tubes->section[0].mass_per_length * g, front = rocket->adaptor[2].at;
    double share = rocket->full.center[0] / front, weight = rocket->full.mass * g;
    *shear = held - w * rest;
    *moment = held * rest - 0.5 * w * rest * rest;
    for (int i = 0; i < tubes->point_mass_count; i++) {
        *shear -= tubes->point_mass[i].mass * g;
        *moment -= tubes->point_mass[i].mass * g * (tubes->point_mass[i].at - x);
    }
    for (int i = 0; i < 2; i++) {
        double s = rocket->start_at + i * front, force = weight * (i ? share : 1 - share);
        *shear -= s >= x ? force : 0;
        *moment -= s >= x ? force * (s - x) : 0;
    }
}

static launching_loads loads_at_rest(const ld_model *model)
{
    fresh_launch launch;
    ld_equilibrium_summary equilibrium;
    launcher_input input;
    launcher_output out;
    launching_loads loads;
    ld_error error;
    double y[LD_MAX_STATES] = {0};
    fresh_launch_make(&launch, model);
    double t = launch.state.t_ignition;
    if (simulation_equilibrium(&launch.state, t, y, &equilibrium, &error))
        fail_msg("%s", error.text);
    simulation_input(&launch.state, t, y, &input);
    assert_int_equal(simulation_loads(&launch.state, &input, y, &out, &loads), LAUNCHING_OK);
    fresh_launch_free(&launch);
    return loads;
}

// Largest differences at rest, of the largest moment and force.
static void check_at_rest(const ld_model *model, double held, const char *name, double bound)
{
    double worst = 0, largest = 0, largest_shear = 0, worst_shear = 0;
    launching_loads loads = loads_at_rest(model);
    for (int i = 0; i < model->tubes.station_count; i++) {
        double shear, moment;
        const guide_wrench *found = &loads.station[i].wrench;
        by_hand(model, model->tubes.station[i].at, held, &shear, &moment);
        worst = fmax(worst, fabs(found->m.z - moment));
        worst_shear = fmax(worst_shear, fabs(found->f.y - shear));
        largest = fmax(largest, fabs(moment));
        largest_shear = fmax(largest_shear, fabs(shear));
    }
    if (model->tubes.support_count == 1) { // carries all
        double shear, moment;
        const guide_wrench *reaction = &loads.support[0];
        by_hand(model, 0, 0, &shear, &moment);
        worst = fmax(worst, fabs(reaction->m.z + moment));
        worst_shear = fmax(worst_shear, fabs(reaction->f.y + shear));
    }
    printf("  %s: largest moment %.6g N m, shear %.6g N\n", name, largest, largest_shear);
    CHECK_BELOW("bending moment (relative)", worst / largest, bound);
    CHECK_BELOW("shear (relative)", worst_shear / largest_shear, bound);
}

static void cantilever_at_rest(void **state)
{
    (void)state;
    ld_model model;
    level_model(&model, 0.1);
    model.tubes.support_count = 1;
    model.tubes.point_mass_count = 1;
    model.tubes.point_mass[0] = (ld_point_mass){.at = model.tubes.length, .mass = 12};
    ask_for(&model, 6, (double[]){1e-9, 0.3, 1, 1.7, 2.5, 3});
    for (int i = 1; i < 3; i++)
        model.tubes.support[0].rotational_stiffness[i] = 1e11;
    check_at_rest(&model, 0, "cantilever on stiff springs", 1e-6);
    model.tubes.support[0].clamped = 0x3f;
    check_at_rest(&model, 0, "cantilever in a clamp", 1e-6);
    reference_model_free(&model);
}

// A bar twice as high as broad: 6 M/(b h^2) at its upper edge.
static void stress_at_rest(void **state)
{
    (void)state;
    const double b = 0.05, h = 0.1;
    ld_model model;
    level_model(&model, 0.1);
    ld_tubes *tubes = &model.tubes;
    ld_section *section = &tubes->section[0];
    tubes->support_count = 1;
    tubes->support[0].clamped = 0x3f;
    section->form = LD_SECTION_PLANES;
    section->bending_stiffness_z = section->bending_stiffness;
    section->bending_stiffness_y = 0.25 * section->bending_stiffness;
    tubes->material.youngs_modulus = 12 * section->bending_stiffness / (b * h * h * h);
    ask_for(&model, 3, (double[]){0.3, 1, 1.7});
    for (int i = 0; i < 3; i++) {
        tubes->station[i].outer_fibre[0] = 0.5 * h;
        tubes->station[i].outer_fibre[1] = 0.5 * b;
    }
    launching_loads loads = loads_at_rest(&model);
    double worst = 0;
    for (int i = 0; i < 3; i++) {
        double shear, moment;
        by_hand(&model, tubes->station[i].at, 0, &shear, &moment);
        worst = fmax(worst, fabs(loads.station[i].stress * b * h * h / (6 * fabs(moment)) - 1));
    }
    CHECK_BELOW("stress at a bar's edge (relative)", worst, 1e-6);
    reference_model_free(&model);
}

// The rocket stands farther and farther forward.
static void influence_line(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        ld_model model;
        level_model(&model, 0.1 + 0.4 * k);
        const ld_rocket *rocket = &model.rocket;
        double L = model.tubes.length, g = model.gravity;
        double held = 0.5 * model.tubes.section[0].mass_per_length * L * g +
                      rocket->full.mass * g * (rocket->start_at + rocket->full.center[0]) / L;
        ask_for(&model, 5, (double[]){0.2, 0.8, 1.5, 2.2, 2.7});
        check_at_rest(&model, held, "simply supported", 1e-6);
        reference_model_free(&model);
    }
}

// ---- a moving force ----

enum { PLACES = 3 };
static const double places[PLACES] = {0.25, 0.5, 0.75}; // of the length

typedef struct crossing {
    double load, length, T, alpha, stiffness; // P, L, L/v, v/v_critical, E I
    int modes;
    // largest errors, of P L/4, against the whole series and against as many of its terms as there
    // are modes; of the deflection, of P L^3/(48 E I)
    double by_equilibrium, by_curvature, of_same_modes, of_deflection;
} crossing;

// What the motion of the n-th sine adds to the moments of statics at its crest, over P L.
static double motion_of(const crossing *c, int n, double tau)
{
    const double pi = 3.14159265358979323846;
    double ratio = c->alpha / n, phase = n * pi * tau / ratio;
    return 2 / (n * n * pi * pi) * (ratio * ratio * sin(n * pi * tau) - ratio * sin(phase)) /
           (1 - ratio * ratio);
}

// E I u'' there: triangle of statics and what the motion of so many sines adds.
static double series(const crossing *c, int terms, double x, double tau)
{
    const double pi = 3.14159265358979323846;
    double sum = x < tau ? x * (1 - tau) : tau * (1 - x);
    for (int n = 1; n <= terms; n++)
        sum += sin(n * pi * x) * motion_of(c, n, tau);
    return sum * c->load * c->length;
}

// Deflection there of so many sines, over P L^3/(48 E I).
static double deflection(const crossing *c, int terms, double x, double tau)
{
    const double pi = 3.14159265358979323846;
    double sum = 0;
    for (int n = 1; n <= terms; n++) {
        double still = 2 / (n * n * pi * pi) * sin(n * pi * tau);
        sum += sin(n * pi * x) * (still + motion_of(c, n, tau)) / (n * n * pi * pi);
    }
    return 48 * sum;
}

static double curvature(const launching_system *system, const double *state, double x)
{
    const flexible_tube *tube = &system->tube.flexible;
    const tube_element *element = &tube->element[flexible_tube_find(tube, x)];
    double sum = 0;
    for (int j = 0; j < tube->nb; j++)
        sum += state[system->layout.q + j] *
               (2 * element->b[PLANE_Y][2][j] + 6 * (x - element->x0) * element->b[PLANE_Y][3][j]);
    return sum;
}

// Deflection at so much of the length, over P L^3/(48 E I).
static double deflection_told(const launching_run *run, double x)
{
    const crossing *c = run->user;
    const launching_layout *at = &run->system->layout;
    launching_section section;
    launching_section_at(run->system, run->state, x * c->length, &section);
    m3 A = q_matrix(q_from(run->state + at->quaternion));
    double w = run->state[at->r + 1] + m3_apply(A, section.P).y;
    return -w * 48 * c->stiffness / (c->load * c->length * c->length * c->length);
}

static void watch(launching_run *run, double t)
{
    crossing *c = run->user;
    guide_forces record;
    launching_output out;
    launching_loads loads;
    launching_input input = run->input;
    double tau = t / c->T, unit = 0.25 * c->load * c->length;
    if (tau < 0.05 || tau > 0.99)
        return;
    input.record = &record;
    guide_forces_begin(&record, PLACES, run->system->tubes.station);
    launching_evaluate(run->system, &input, &run->phase, run->state, &out);
    launching_find_loads(run->system, &input, run->state, &out, &loads);
    for (int i = 0; i < PLACES; i++) {
        double exact = series(c, 400, places[i], tau), same = series(c, c->modes, places[i], tau);
        double bent = c->stiffness * curvature(run->system, run->state, places[i] * c->length);
        double moment = loads.station[i].wrench.m.z;
        double off = deflection_told(run, places[i]) - deflection(c, c->modes, places[i], tau);
        c->by_equilibrium = fmax(c->by_equilibrium, fabs(moment - exact) / unit);
        c->by_curvature = fmax(c->by_curvature, fabs(bent - exact) / unit);
        c->of_same_modes = fmax(c->of_same_modes, fabs(moment - same) / unit);
        c->of_deflection = fmax(c->of_deflection, fabs(off));
    }
}

// On rigid pins at both ends, without tail, weight and damping; a point mass that is next to
// nothing, on the axis, carries the force, a thrust across the tube. The force is so small that
// what the tube's slope makes of it along the tube does not show in the speed.
static crossing cross(int modes, int elements, double alpha)
{
    const double pi = 3.14159265358979323846;
    const unsigned across = 1u << LD_CLAMP_Y | 1u << LD_CLAMP_Z;
    ld_model model;
    launching_run run;
    reference_model(&model);
    ld_tubes *tubes = &model.tubes;
    const ld_section *section = &tubes->section[0];
    double L = tubes->length, EI = section->bending_stiffness, mu = section->mass_per_length;
    double mass = 1e-7 * mu * L, v = alpha * pi / L * sqrt(EI / mu), load = 0.03;
    model.gravity = 0;
    tubes->tail = (ld_tail){0};
    tubes->modes.damping = 0;
    tubes->modes.bending = modes;
    tubes->modes.torsion = 1;
    tubes->modes.elements = elements;
    tubes->slot.kind = LD_SLOT_NONE;
    for (int k = 0; k < 2; k++)
        tubes->support[k] = (ld_support){.at = k * L, .clamped = across};
    tubes->support[0].clamped |= 1u << LD_CLAMP_X | 1u << LD_CLAMP_ROLL;
    model.rocket.full = (ld_mass_data){mass, {0, 0, 0}, {1, 1, 1}};
    model.rocket.adaptor_count = 2;
    model.rocket.contact = (ld_contact){.law = LD_CONTACT_IDEAL, .stiffness = NAN, .exponent = 1};
    model.rocket.motor.misalignment[0] = -1e9; // across the tube
    ask_for(&model, PLACES, (double[]){places[0] * L, places[1] * L, places[2] * L});
    launching_system *system = launching_system_of(&model);
    crossing c = {
        .load = load, .length = L, .T = L / v, .alpha = alpha, .stiffness = EI, .modes = modes};
    launching_run_begin(&run, system, 0);
    run.phase.passed[1] = true;
    run.input.thrust = load;
    run.state[system->layout.V] = v;
    run.after_step = watch;
    run.user = &c;
    launching_run_follow(&run, 1e-12, c.T);
    printf("  %d modes, alpha %g: %d steps; by equilibrium %.2e, by E I u'' %.2e of P L/4\n", modes,
           alpha, (int)run.steps, c.by_equilibrium, c.by_curvature);
    launching_system_drop(system);
    reference_model_free(&model);
    return c;
}

static void moving_force(void **state)
{
    (void)state;
    crossing few = cross(4, 80, 0.5), more = cross(8, 160, 0.5);
    CHECK_BELOW("4 modes against 4 sines, moment", few.of_same_modes, 1e-6);
    CHECK_BELOW("8 modes against 8 sines, moment", more.of_same_modes, 1e-6);
    CHECK_BELOW("4 modes against 4 sines, deflection", few.of_deflection, 1e-6);
    CHECK_BELOW("8 modes against 8 sines, deflection", more.of_deflection, 1e-6);
    CHECK_BELOW("4 modes, by equilibrium", few.by_equilibrium, 6e-3);
    CHECK_BELOW("8 modes, by equilibrium", more.by_equilibrium, 1.4e-3);
    CHECK_WITHIN("4 modes, by E I u''", few.by_curvature, 0.08, 0.12);
    CHECK_WITHIN("8 modes, by E I u''", more.by_curvature, 0.04, 0.06);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cantilever_at_rest),
        cmocka_unit_test(stress_at_rest),
        cmocka_unit_test(influence_line),
        cmocka_unit_test(moving_force),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
