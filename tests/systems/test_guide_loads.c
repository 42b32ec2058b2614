// What the tube carries at its stations, on random states: the whole of what acts is recorded, the
// inertia of a part is that of its points, at a force the resultant jumps by it.
#include <stdlib.h>

#include "elements/tube/tube_dynamics.h"
#include "support/check.h"
#include "support/evaluators.h"
#include "support/launching_run.h"
#include "support/launching_state.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_figures.h"
#include "systems/launching/launching_general.h"
#include "systems/launching/launching_kinematics.h"
#include "systems/launching/launching_overall.h"

// A state with all that was found in it.
typedef struct instant {
    launching_case at;
    launching_load load;
    guide_forces record;
    launching_output out;
    launching_loads loads;
} instant;

// Locked, on the breech, free; with and without the front adaptors; a load at the tip; no rocket.
static void draw_instant(const launching_system *system, evaluator evaluate, uint64_t *seed, int k,
                         instant *now)
{
    launching_case *c = &now->at;
    memset(now, 0, sizeof *now);
    draw_state(system, seed, k % 4 == 0, c);
    for (int i = system->adaptors.count - 1; i > 0 && draw(seed) > 0.5; i--)
        c->phase.passed[i] = true;
    if (k % 4 == 1)
        c->phase.breech = c->state[system->layout.x] + 1e-3;
    c->phase.rocket = k % 7 != 6;
    now->load.tip_force = draw_v3(seed, 1e4);
    now->load.tip_moment = draw_v3(seed, 1e3);
    if (k % 5 == 3)
        c->input.load = &now->load;
    c->input.record = &now->record;
    guide_forces_begin(&now->record, system->tubes.station_count, system->tubes.station);
    assert_int_equal(evaluate(system, &c->input, &c->phase, c->state, &now->out), LAUNCHING_OK);
    launching_find_loads(system, &c->input, c->state, &now->out, &now->loads);
}

// ---- all that acts is recorded: what the whole tube leaves is what moves the tail ----

static double tail_error(const launching_system *system, const instant *now)
{
    const ld_tail *tail = &system->model->tubes.tail;
    const launching_layout *at = &system->layout;
    const double *y = now->at.state;
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 g = m3_apply_transposed(A_IR, v3_make(0, -system->tube.gravity, 0));
    v3 w = v3_from(y + at->w), c = v3_make(tail->center, 0, 0), J = v3_from(tail->inertia);
    v3 a = v3_add(now->out.a, v3_add(v3_cross(now->out.w_dot, c), v3_cross(w, v3_cross(w, c))));
    v3 f = v3_scale(tail->mass, v3_sub(a, g));
    v3 m = v3_add(v3_mul(J, now->out.w_dot), v3_cross(w, v3_mul(J, w)));
    m = v3_add(m, v3_cross(c, f));
    const guide_wrench *found = &now->loads.station[0].wrench;
    double force = v3_norm(f) + v3_norm(now->out.base_force) + fabs(now->out.N);
    for (int i = 0; i < system->adaptors.count && now->at.phase.rocket; i++)
        force += now->at.phase.passed[i] ? 0 : now->out.adaptor[i].force;
    return fmax(v3_norm(v3_sub(found->f, f)), v3_norm(v3_sub(found->m, m))) / force;
}

static void check_balance(const ld_model *model, evaluator evaluate, int count, const char *name)
{
    launching_system *system = launching_system_of(model);
    uint64_t seed = 20261122;
    double worst = 0;
    for (int k = 0; k < count; k++) {
        instant now;
        draw_instant(system, evaluate, &seed, k, &now);
        worst = fmax(worst, tail_error(system, &now));
    }
    CHECK_BELOW(name, worst, 1e-10);
    launching_system_drop(system);
}

static void ask_for(ld_model *model, int count, const double *at)
{
    model->tubes.station_count = count;
    for (int i = 0; i < count; i++)
        model->tubes.station[i].at = at[i];
}

static void the_whole_tube_leaves_what_moves_the_tail(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    model.rocket.knob_angle = 0.4;
    ask_for(&model, 1, (double[]){0});
    check_balance(&model, launching_evaluate, 140, "reduced");
    check_balance(&model, launching_evaluate_general, 140, "reduced from the general matrix");
    check_balance(&model, launching_evaluate_overall, 140, "overall");
    model.tubes.modes.axial = 2;
    check_balance(&model, launching_evaluate, 70, "axial modes");
    model.tubes.modes.axial = 0;
    model.tubes.support[0].rotational_stiffness[1] = 5e5;
    model.tubes.point_mass_count = 2;
    model.tubes.point_mass[0] = (ld_point_mass){.at = 1.5, .mass = 0.4};
    model.tubes.point_mass[1] = (ld_point_mass){.at = 0, .mass = 0.3};
    model.rocket.contact.law = LD_CONTACT_BILATERAL;
    model.rocket.contact.damping = 2e4;
    check_balance(&model, launching_evaluate, 70, "bilateral, point masses, uneven support");
    model.rocket.contact.law = LD_CONTACT_HUNT_CROSSLEY;
    model.rocket.lock.x = 0.7;
    model.rocket.lock.radius = 0.0825;
    model.rocket.lock.angle = 2.2;
    check_balance(&model, launching_evaluate, 70, "lock off the axis");
    model.tubes.slot.kind = LD_SLOT_NONE;
    check_balance(&model, launching_evaluate_overall, 70,
                  "no slot, the lock holds the roll, overall");
    model.rocket.lock = (ld_lock){.release_force = 1e4};
    model.tubes.guide = (ld_guide){.present = true,
                                   .form = LD_GUIDE_T_SLOT,
                                   .line = {-0.08, 0.01},
                                   .t_slot = {.lips = 0.06, .gap = 0.5e-4, .side_gap = 0.3e-4}};
    for (int i = 0; i < 3; i++)
        model.rocket.adaptor[i].clearance = NAN;
    check_balance(&model, launching_evaluate, 70, "T-slot beside the axis");
    check_balance(&model, launching_evaluate_general, 70, "T-slot, from the general matrix");
    model.tubes.guide =
        (ld_guide){.present = true,
                   .form = LD_GUIDE_TOWER,
                   .tower = {.rails = 4, .first = 0.8, .gap = 3e-5, .radius = 0.08}};
    check_balance(&model, launching_evaluate, 70, "tower");
    model.tubes.guide = (ld_guide){0};
    model.rocket.adaptor_count = 2;
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    check_balance(&model, launching_evaluate, 70, "ideal adaptors");
    check_balance(&model, launching_evaluate_general, 70,
                  "ideal adaptors, from the general matrix");
    reference_model_free(&model);
}

static void clamps_recoil_and_pressure_leave_what_moves_the_tail(void **state)
{
    (void)state;
    static const unsigned clamped[][2] = {{0x3f, 0}, {0x0f, 0x16}, {0x2e, 0x01}};
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    ask_for(&model, 1, (double[]){0});
    reference_by_pressure(&model);
    check_balance(&model, launching_evaluate, 70, "pressure");
    reference_recoil(&model);
    check_balance(&model, launching_evaluate, 70, "pressure and recoil");
    check_balance(&model, launching_evaluate_general, 70,
                  "pressure and recoil, from the general matrix");
    check_balance(&model, launching_evaluate_overall, 70, "pressure and recoil, overall");
    model.tubes.support[0].recoil.present = false;
    for (int i = 0; i < 3; i++) {
        char name[64];
        model.tubes.support[0].clamped = clamped[i][0];
        model.tubes.support[1].clamped = clamped[i][1];
        snprintf(name, sizeof name, "clamped %#x and %#x", clamped[i][0], clamped[i][1]);
        check_balance(&model, launching_evaluate, 70, name);
    }
    check_balance(&model, launching_evaluate_general, 70, "the same, from the general matrix");
    model.tubes.modes.axial = 2;
    check_balance(&model, launching_evaluate, 70, "the same, axial modes");
    reference_model_free(&model);
}

// ---- the inertia of a part, from the accelerations of its sections ----

typedef struct part {
    guide_wrench rate; // of momentum less weight, about R's origin
    double size;
} part;

static void add_section(const launching_system *system, const instant *now, double x, double mass,
                        double polar, v3 g, part *sum)
{
    const launching_layout *at = &system->layout;
    const double *y = now->at.state, *q_dot = y + at->q_dot;
    const flexible_tube *tube = &system->tube.flexible;
    tube_section_state section;
    v3 w = v3_from(y + at->w);
    int n = 6 + at->nq;
    tube_section(tube, x, w, y + at->q, q_dot, &section);
    double a[3];
    for (int i = 0; i < 3; i++) {
        const double *L = section.L + i * n;
        a[i] = section.gamma[i];
        const double rigid[6] = {now->out.a.x,     now->out.a.y,     now->out.a.z,
                                 now->out.w_dot.x, now->out.w_dot.y, now->out.w_dot.z};
        for (int j = 0; j < n; j++)
            a[i] += L[j] * (j < 6 ? rigid[j] : now->out.q_ddot[j - 6]);
    }
    v3 f = v3_scale(mass, v3_sub(v3_from(a), g));
    sum->rate.f = v3_add(sum->rate.f, f);
    sum->rate.m = v3_add(sum->rate.m, v3_cross(section.position, f));
    sum->size += v3_norm(f);
    // spin about R's x axis
    const tube_element *e = &tube->element[flexible_tube_find(tube, x)];
    double spin = w.x, rate = now->out.w_dot.x;
    for (int j = 0; j < tube->nt; j++) {
        double tau = e->tau[0][j] + (x - e->x0) * e->tau[1][j];
        spin += tau * q_dot[2 * tube->nb + j];
        rate += tau * now->out.q_ddot[2 * tube->nb + j];
    }
    v3 turn = v3_cross(w, v3_make(polar * spin, 0, 0));
    sum->rate.m = v3_add(sum->rate.m, v3_add(v3_make(polar * rate, 0, 0), turn));
}

// Gauss with five points on each element.
static part part_beyond(const launching_system *system, const instant *now, double from)
{
    static const double at[5] = {-0.90617984593866399280, -0.53846931010568309104, 0,
                                 0.53846931010568309104, 0.90617984593866399280};
    static const double weight[5] = {0.23692688505618908751, 0.47862867049936646804,
                                     0.56888888888888888889, 0.47862867049936646804,
                                     0.23692688505618908751};
    const ld_tubes *model = &system->tubes;
    const flexible_tube *tube = &system->tube.flexible;
    m3 A_IR = q_matrix(q_from(now->at.state + system->layout.quaternion));
    v3 g = m3_apply_transposed(A_IR, v3_make(0, -system->tube.gravity, 0));
    part sum = {{v3_zero(), v3_zero()}, 0};
    for (int e = 0; e < tube->element_count; e++) {
        double x0 = fmax(from, tube->element[e].x0), half = 0.5 * (tube->element[e].x1 - x0);
        const ld_section *section = &model->section[0];
        while (section + 1 < model->section + model->section_count && section[1].from <= x0)
            section++;
        for (int i = 0; i < 5 && half > 0; i++)
            add_section(system, now, x0 + half * (1 + at[i]),
                        section->mass_per_length * half * weight[i],
                        section->polar_inertia * half * weight[i], g, &sum);
    }
    for (int i = 0; i < model->point_mass_count; i++)
        if (model->point_mass[i].at >= from)
            add_section(system, now, model->point_mass[i].at, model->point_mass[i].mass, 0, g,
                        &sum);
    return sum;
}

// `apart`: the planes have shapes of their own.
static void check_inertia_of_parts(bool apart)
{
    static const double at[] = {0, 0.213, 1.2, 1.5, 1.77, 2.9, 3};
    enum { STATIONS = sizeof at / sizeof *at };
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 5;
    model.tubes.modes.axial = 2;
    model.tubes.section_count = 2;
    model.tubes.section[1] = model.tubes.section[0];
    model.tubes.section[1].from = 1.2;
    model.tubes.section[1].mass_per_length *= 0.6;
    model.tubes.section[1].polar_inertia *= 0.5;
    model.tubes.point_mass_count = 1;
    model.tubes.point_mass[0] = (ld_point_mass){.at = 1.5, .mass = 0.4};
    if (apart)
        model.tubes.support[0].stiffness[1] *= 0.04;
    ask_for(&model, STATIONS, at);
    launching_system *system = launching_system_of(&model);
    uint64_t seed = 5;
    double worst_force = 0, worst_moment = 0;
    for (int k = 0; k < 20; k++) {
        instant now;
        draw_instant(system, launching_evaluate_general, &seed, k, &now);
        for (int i = 0; i < STATIONS; i++) {
            part whole = part_beyond(system, &now, at[i]);
            launching_section section;
            launching_section_at(system, now.at.state, at[i], &section);
            const guide_wrench *found = &now.loads.station[i].wrench,
                               *forces = &now.record.beyond[i];
            v3 f = v3_sub(forces->f, whole.rate.f), m = v3_sub(forces->m, whole.rate.m);
            m = v3_sub(m, v3_cross(section.P, f));
            double size = whole.size + v3_norm(forces->f);
            worst_force =
                fmax(worst_force, v3_norm(v3_sub(m3_apply(section.A, found->f), f)) / size);
            worst_moment =
                fmax(worst_moment, v3_norm(v3_sub(m3_apply(section.A, found->m), m)) / size);
        }
    }
    CHECK_BELOW("force carried", worst_force, 1e-12);
    CHECK_BELOW("moment carried [m]", worst_moment, 1e-11);
    launching_system_drop(system);
    reference_model_free(&model);
}

static void a_part_has_the_inertia_of_its_sections(void **state)
{
    (void)state;
    check_inertia_of_parts(false);
    check_inertia_of_parts(true);
}

// ---- jumps ----

// The jump of what is carried between two places beside x, in R.
static guide_wrench jump_at(const launching_system *system, const instant *now, double x)
{
    guide_wrench side[2];
    for (int i = 0; i < 2; i++) {
        const guide_wrench *carried = &now->loads.station[i].wrench;
        launching_section section;
        launching_section_at(system, now->at.state, now->record.at[i], &section);
        side[i].f = m3_apply(section.A, carried->f);
        side[i].m = m3_apply(section.A, carried->m);
    }
    assert_true(now->record.at[0] < x && x < now->record.at[1]);
    return (guide_wrench){v3_sub(side[0].f, side[1].f), v3_sub(side[0].m, side[1].m)};
}

// Asks for both sides of x and evaluates again.
static guide_wrench jump_of(launching_system *system, instant *now, double x)
{
    launching_case *c = &now->at;
    ld_station beside[2] = {{.at = x - 1e-10}, {.at = x + 1e-10}};
    guide_forces_begin(&now->record, 2, beside);
    for (int i = 0; i < 2; i++)
        guide_cut_build(&system->cut[i], &system->tube.flexible, &system->tubes, &beside[i]);
    assert_int_equal(launching_evaluate(system, &c->input, &c->phase, c->state, &now->out),
                     LAUNCHING_OK);
    launching_find_loads(system, &c->input, c->state, &now->out, &now->loads);
    return jump_at(system, now, x);
}

// Largest error of a jump at a support by its reaction, of the larger of force [N] and moment
// [N m].
static double support_error(launching_system *system, instant *now, int i)
{
    m3 A_TR = m3_mul(m3_transpose(now->at.input.base.A),
                     q_matrix(q_from(now->at.state + system->layout.quaternion)));
    guide_wrench jump = jump_of(system, now, system->supports.support[i].x);
    const guide_wrench *reaction = &now->loads.support[i];
    double f = v3_norm(v3_sub(m3_apply(A_TR, jump.f), reaction->f));
    double m = v3_norm(v3_sub(m3_apply(A_TR, jump.m), reaction->m));
    return fmax(f, m) / fmax(v3_norm(jump.f), v3_norm(jump.m));
}

static void check_jumps(const ld_model *model, const char *supports)
{
    launching_system *system = launching_system_of(model);
    uint64_t seed = 9;
    double worst_contact = 0, worst_support = 0;
    for (int k = 0; k < 60; k++) {
        instant now;
        draw_instant(system, launching_evaluate, &seed, 2, &now); // rocket free, no tip load
        for (int i = 1; i < system->adaptors.count; i++) { // the slot acts where the rear one does
            const adaptor_report adaptor = now.out.adaptor[i];
            if (now.at.phase.passed[i] || adaptor.s > 2.99 || adaptor.force < 1e3)
                continue;
            guide_wrench jump = jump_of(system, &now, adaptor.s);
            worst_contact = fmax(worst_contact, fabs(v3_norm(jump.f) / adaptor.force - 1));
        }
        for (int i = 0; i < system->supports.count; i++)
            worst_support = fmax(worst_support, support_error(system, &now, i));
    }
    CHECK_BELOW("at an adaptor, of its force", worst_contact, 1e-6);
    CHECK_BELOW(supports, worst_support, 1e-6);
    launching_system_drop(system);
}

static void the_force_jumps_by_what_acts(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    ask_for(&model, 2, (double[]){0.1, 0.2});
    check_jumps(&model, "at a support, of its reaction");
    reference_recoil(&model);
    check_jumps(&model, "at a slide, of its reaction");
    model.tubes.support[0].recoil.present = false;
    model.tubes.modes.bending = 4;
    model.tubes.support[0].clamped = 0x0f;
    model.tubes.support[1].clamped = 0x16;
    check_jumps(&model, "at a clamp, of its reaction");
    reference_model_free(&model);
}

// ---- stress ----

// Largest error of the stress against `by_hand` on random states, relative.
static double stress_error(const ld_model *model, double (*by_hand)(v3 moment))
{
    launching_system *system = launching_system_of(model);
    uint64_t seed = 11;
    double worst = 0;
    for (int k = 0; k < 20; k++) {
        instant now;
        draw_instant(system, launching_evaluate, &seed, k, &now);
        double exact = by_hand(now.loads.station[0].wrench.m);
        worst = fmax(worst, fabs(now.loads.station[0].stress / exact - 1));
        if (system->tubes.section[0].form != LD_SECTION_ANNULUS)
            assert_true(isnan(now.loads.station[1].stress)); // without an outer fibre
    }
    launching_system_drop(system);
    return worst;
}

static const double breadth = 0.06, height = 0.09, outer = 0.085, inner = 0.08; // [m]

// Of a bar, breadth along z, over its four corners.
static double stress_of_bar(v3 moment)
{
    double I_z = breadth * height * height * height / 12,
           I_y = height * breadth * breadth * breadth / 12, largest = 0;
    for (int corner = 0; corner < 4; corner++) {
        double y = (corner & 1 ? 0.5 : -0.5) * height, z = (corner & 2 ? 0.5 : -0.5) * breadth;
        largest = fmax(largest, moment.y * z / I_y - moment.z * y / I_z);
    }
    return largest;
}

// Of a ring, in the direction of the moment.
static double stress_of_ring(v3 moment)
{
    double I = 0.25 * acos(-1) * (pow(outer, 4) - pow(inner, 4));
    return outer * hypot(moment.y, moment.z) / I;
}

static void stress_is_that_of_bar_and_ring(void **state)
{
    (void)state;
    const double E = 7e10, h = height, b = breadth;
    ld_model model;
    reference_model(&model);
    ask_for(&model, 2, (double[]){0.7, 1.1});
    ld_section *section = &model.tubes.section[0];
    ld_station *station = model.tubes.station;
    model.tubes.material.youngs_modulus = E;
    station[0].outer_fibre[0] = h / 2;
    station[0].outer_fibre[1] = b / 2;
    station[1].outer_fibre[0] = station[1].outer_fibre[1] = NAN;
    section->form = LD_SECTION_PLANES;
    section->bending_stiffness_y = E * h * b * b * b / 12;
    section->bending_stiffness_z = E * b * h * h * h / 12;
    CHECK_BELOW("at a bar's corner", stress_error(&model, stress_of_bar), 1e-12);
    station[0].outer_fibre[0] = station[0].outer_fibre[1] = NAN;
    section->form = LD_SECTION_ANNULUS;
    section->outer_radius = outer;
    section->bending_stiffness = E * 0.25 * acos(-1) * (pow(outer, 4) - pow(inner, 4));
    CHECK_BELOW("of a ring", stress_error(&model, stress_of_ring), 1e-12);
    reference_model_free(&model);
}

// A record changes no bit of what is found.
static void a_record_changes_nothing(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    ask_for(&model, 1, (double[]){1});
    launching_system *system = launching_system_of(&model);
    uint64_t seed = 3;
    for (int k = 0; k < 20; k++) {
        instant now;
        launching_output plain;
        memset(&plain, 0, sizeof plain);
        draw_instant(system, launching_evaluate, &seed, k, &now);
        now.at.input.record = NULL;
        launching_evaluate(system, &now.at.input, &now.at.phase, now.at.state, &plain);
        assert_memory_equal(&plain, &now.out, sizeof plain);
    }
    launching_system_drop(system);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_whole_tube_leaves_what_moves_the_tail),
        cmocka_unit_test(clamps_recoil_and_pressure_leave_what_moves_the_tail),
        cmocka_unit_test(a_part_has_the_inertia_of_its_sections),
        cmocka_unit_test(the_force_jumps_by_what_acts),
        cmocka_unit_test(stress_is_that_of_bar_and_ring),
        cmocka_unit_test(a_record_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
