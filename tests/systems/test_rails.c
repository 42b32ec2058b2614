// Shoes on the surfaces of a rail against dense multipliers from positions alone, whose contact is
// its own (support/dense_launch.h), on random states of random rails: surfaces of every direction,
// flat and round, T-slots, towers, pressed in or not, beside an offset guide line.
//   LD_RAIL_STATES   how many of each program (60)
#include <stdlib.h>

#include "support/check.h"
#include "support/evaluators.h"
#include "support/launching_state.h"
#include "support/random_model.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_general.h"
#include "systems/launching/launching_kinematics.h"
#include "systems/launching/launching_overall.h"

// ---- random rails ----

static void draw_surfaces(uint64_t *seed, ld_guide *guide)
{
    guide->form = LD_GUIDE_SURFACES;
    guide->surface_count = 3 + choice(seed, 6);
    for (int k = 0; k < guide->surface_count; k++)
        guide->surface[k] = (ld_surface){
            .at = {between(seed, -0.1, 0.1), between(seed, -0.1, 0.1)},
            .normal = between(seed, -3, 3),
            .gap = between(seed, -2e-4, 1e-3),
            .shape = chance(seed, 0.5) ? LD_SURFACE_FLAT : LD_SURFACE_ROUND,
        };
}

static void draw_guide(uint64_t *seed, int form, ld_guide *guide)
{
    guide->present = true;
    for (int i = 0; i < 2; i++)
        guide->line[i] = between(seed, -0.1, 0.1);
    guide->form = (ld_guide_form)form;
    if (form == LD_GUIDE_SURFACES)
        draw_surfaces(seed, guide);
    else if (form == LD_GUIDE_T_SLOT)
        guide->t_slot = (ld_t_slot){.at = {between(seed, -0.1, 0.1), between(seed, -0.05, 0.05)},
                                    .lips = between(seed, 0.02, 0.1),
                                    .gap = between(seed, -2e-4, 1e-3),
                                    .side_gap = between(seed, -2e-4, 1e-3)};
    else
        guide->tower = (ld_tower){.rails = 2 + choice(seed, 6),
                                  .first = between(seed, -3, 3),
                                  .gap = between(seed, -2e-4, 1e-3),
                                  .radius = between(seed, 0.05, 0.2)};
}

static void draw_contact(uint64_t *seed, ld_contact *contact)
{
    static const ld_contact_law law[] = {LD_CONTACT_HUNT_CROSSLEY, LD_CONTACT_LANKARANI_NIKRAVESH,
                                         LD_CONTACT_KELVIN_VOIGT};
    contact->law = law[choice(seed, 3)];
    contact->exponent = chance(seed, 0.5) ? 1 : between(seed, 1, 2);
    contact->damping = between(seed, 0, 2e4);
    contact->friction = chance(seed, 0.2) ? 0 : between(seed, 0, 0.5);
}

static void draw_rail(uint64_t *seed, int form, ld_model *model)
{
    reference_model(model);
    ld_tubes *tubes = &model->tubes;
    ld_rocket *rocket = &model->rocket;
    tubes->slot.kind = LD_SLOT_NONE;
    tubes->modes.bending = 2 + choice(seed, 4);
    tubes->modes.elements = 12;
    for (int k = 0; k < 2; k++) // not isotropic
        scale_all(seed, 3, tubes->support[k].stiffness);
    tubes->section_count = 2; // nor round: the planes' stiffnesses in no one proportion
    for (int k = 0; k < 2; k++) {
        ld_section *section = &tubes->section[k];
        *section = tubes->section[0];
        section->from = 1.2 * k;
        section->form = LD_SECTION_PLANES;
        section->bending_stiffness_y = section->bending_stiffness * between(seed, 0.3, 2);
        section->bending_stiffness_z = section->bending_stiffness * between(seed, 0.3, 2);
    }
    draw_guide(seed, form, &tubes->guide);
    draw_contact(seed, &rocket->contact);
    rocket->adaptor_count = 2 + choice(seed, 2);
    for (int i = 0; i < rocket->adaptor_count; i++)
        rocket->adaptor[i].clearance = chance(seed, 0.5) ? NAN : between(seed, 0, 1e-3);
    rocket->lock.holds_roll = (ld_hold)choice(seed, 3);
    rocket->lock.x = between(seed, -0.5, 0.5);
    rocket->lock.radius = between(seed, 0, 0.2);
    rocket->lock.angle = between(seed, -3, 3);
    uint64_t other = *seed + 1;
    double drag[4] = {0.3, between(&other, 0, 1e4), 1.7, between(&other, 0, 1e4)};
    rocket->contact.drag = reference_table((size_t)choice(&other, 3), 2, drag);
    rocket->contact.drag_scale = between(&other, 0.5, 2);
}

// A rail that is bent and twisted.
static void draw_initial_shape(uint64_t *seed, ld_initial_shape *shape)
{
    enum { ROWS = 4 };
    double row[ROWS][4];
    for (int i = 0; i < ROWS; i++) {
        row[i][0] = i * between(seed, 1, 1.2) - 0.1;
        for (int k = 1; k < 4; k++)
            row[i][k] = between(seed, -5e-3, 5e-3) * (k == 3 ? 8 : 1);
    }
    *shape = (ld_initial_shape){.present = true,
                                .scale = {between(seed, -2, 2), between(seed, -2, 2)},
                                .twist_scale = between(seed, -2, 2),
                                .offsets = reference_table(ROWS, 4, row[0])};
}

// Coefficients over the Mach number, with a drag of the lateral speed, or a plain body.
static void draw_air(uint64_t *seed, ld_aerodynamics *air)
{
    enum { ROWS = 4 };
    *air =
        (ld_aerodynamics){.present = true,
                          .model = chance(seed, 0.7) ? LD_AERODYNAMICS_TABLE : LD_AERODYNAMICS_BODY,
                          .reference_diameter = between(seed, 0.1, 0.3),
                          .fin_cant = between(seed, -0.1, 0.1),
                          .ca_scale = between(seed, 0.5, 2),
                          .cn_scale = between(seed, 0.5, 2),
                          .x_cp_shift = between(seed, -0.2, 0.2),
                          .area = 0.02,
                          .drag = between(seed, 0, 2),
                          .damping = {-1, -2, -3},
                          .lengths = {0.2, 2, 3}};
    if (chance(seed, 0.5)) {
        air->crossflow.present = true;
        air->crossflow.drag = between(seed, 0, 30);
        air->crossflow.at = between(seed, 0, 2);
    }
    double *row = malloc(sizeof(double) * 8 * ROWS);
    air->table = (ld_table){.rows = ROWS, .columns = 8, .data = row};
    for (int i = 0; i < ROWS; i++, row += 8) {
        const double low[8] = {0.2 * i, 0, 0, 2, 0, -5, -9, -400};
        const double high[8] = {0.2 * i, 1, 1, 12, 1.5, 5, 0, 0};
        for (int k = 0; k < 8; k++)
            row[k] = between(seed, low[k], high[k]);
    }
}

// A wind of up to Mach 1 on the rocket.
static void blow(uint64_t *seed, const aerodynamics *air, launching_case *c)
{
    c->input.air.v = draw_v3(seed, 60);
    c->input.air.density = between(seed, 0.5, 2);
    c->input.air.speed_of_sound = between(seed, 100, 400);
    c->input.power = chance(seed, 0.5);
    c->input.aerodynamics = air;
}

// ---- agreement ----

typedef struct agreement {
    double tube, rocket, lock, shoe, base, air; // largest differences, relative
    int pressed, rubbing;
} agreement;

static double apart3(const double *a, v3 b, double scale)
{
    return v3_norm(v3_sub(v3_from(a), b)) / scale;
}

static double size3(const double *a)
{
    return v3_norm(v3_from(a));
}

// Of one shoe: force across the rail and moment about the guide line, in the axes of its section.
static double shoe_difference(const launching_system *system, const launching_case *c, int i,
                              const launching_output *out, const dense_launch_output *dense)
{
    const launching_layout *at = &system->layout;
    tube_section_state section;
    const guide_station station = {&system->tube.flexible, system->tube.initial,
                                   dense->contact[i].s};
    launching_pose pose;
    launching_output unused;
    guide_section(&station, v3_zero(), c->state + at->q, c->state + at->q_dot, &section);
    launching_rocket_pose(system, c->state, &pose, &unused);
    m3 A = m3_mul(q_matrix(q_from(c->state + at->quaternion)), section.rotation);
    v3 F = m3_apply_transposed(A, v3_from(dense->contact[i].force));
    v3 M = m3_apply_transposed(A, v3_from(dense->contact[i].moment));
    v3 C = v3_add(pose.p1, v3_scale(system->adaptors.at[i], m3_column(pose.A_RB, 0)));
    v3 arm = m3_apply_transposed(section.rotation, v3_sub(C, section.position));
    double y = arm.y - system->surfaces.line_y, z = arm.z - system->surfaces.line_z;
    double worst = fabs(out->shoe[i].force_y - F.y) + fabs(out->shoe[i].force_z - F.z);
    worst = fmax(worst, fabs(out->shoe[i].moment_x - (M.x + y * F.z - z * F.y)));
    worst = fmax(worst, fabs(out->adaptor[i].normal - dense->contact[i].normal));
    worst = fmax(worst, fabs(out->adaptor[i].penetration - dense->contact[i].penetration) * 5e7);
    return worst;
}

static void compare(const launching_system *system, const launching_case *c,
                    const launching_output *out, const dense_launch_output *dense, agreement *worst)
{
    double modal = 0, modal_error = 0, force = 1e3 + fabs(dense->lock_force);
    for (int i = 0; i < system->layout.nq; i++) {
        modal = fmax(modal, fabs(dense->q_ddot[i]));
        modal_error = fmax(modal_error, fabs(dense->q_ddot[i] - out->q_ddot[i]));
    }
    for (int i = 0; i < system->adaptors.count; i++)
        force += dense->contact[i].normal;
    for (int i = 0; i < system->adaptors.count; i++)
        if (!c->phase.passed[i])
            worst->shoe = fmax(worst->shoe, shoe_difference(system, c, i, out, dense) / force);
    worst->tube = fmax(worst->tube, apart3(dense->a, out->a, size3(dense->a)));
    worst->tube = fmax(worst->tube, apart3(dense->w_dot, out->w_dot, size3(dense->w_dot)));
    worst->tube = fmax(worst->tube, modal_error / modal);
    double a = size3(dense->a_O1) + size3(dense->a);
    double alpha = size3(dense->alpha_B) + size3(dense->w_dot);
    worst->rocket = fmax(worst->rocket, apart3(dense->a_O1, out->a_O1, a));
    worst->rocket = fmax(worst->rocket, apart3(dense->alpha_B, out->alpha_B, alpha));
    worst->lock = fmax(worst->lock, fabs(dense->lock_force - out->lock_force) / force);
    if (c->input.aerodynamics) {
        worst->air = fmax(worst->air, apart3(dense->air_force, out->air_force, force));
        worst->air = fmax(worst->air, apart3(dense->air_moment, out->air_moment, force));
    }
    worst->base =
        fmax(worst->base, apart3(dense->base_force, out->base_force, size3(dense->base_force)));
    worst->base =
        fmax(worst->base, apart3(dense->base_moment, out->base_moment, size3(dense->base_moment)));
}

// ---- states ----

// Speeds at first touch: of listed surfaces one each, of a shorthand's one a shoe.
static void draw_touch_speeds(uint64_t *seed, const ld_model *model, launching_case *c)
{
    int shoes = model->rocket.adaptor_count;
    bool listed = model->tubes.guide.form == LD_GUIDE_SURFACES;
    for (int i = 0; i < shoes; i++) {
        double speed = between(seed, 0.05, 0.2);
        for (int k = 0; k < LD_MAX_SURFACES; k++) {
            speed = listed ? between(seed, 0.05, 0.2) : speed;
            c->phase.surface_speed[i][k] = speed;
            if (k * shoes + i < DENSE_MAX_SURFACES)
                c->dense.conditions.surface_touch_speed[k * shoes + i] = speed;
        }
    }
}

static void compare_states(const ld_model *model, const evaluator evaluate[3], uint64_t *seed,
                           uint64_t *weather, int count, agreement worst[3])
{
    launching_system *system = aligned_alloc(64, (sizeof *system + 63) / 64 * 64);
    dense_launch *dense = malloc(sizeof *dense);
    aerodynamics air;
    ld_error error;
    assert_int_equal(launching_build(system, model, NULL, &error), LD_OK);
    assert_int_equal(aerodynamics_build(&air, &model->rocket.aerodynamics, &error), LD_OK);
    dense_launch_create(dense, model, &system->tube.flexible);
    for (int n = 0; n < count; n++) {
        launching_case c;
        launching_output out;
        dense_launch_output reference;
        draw_state(system, seed, n % 3 == 0, &c);
        for (int i = system->adaptors.count - 1; i > 0 && chance(seed, 0.3); i--)
            c.phase.passed[i] = true;
        c.phase.frictionless = chance(seed, 0.1);
        if (air.present)
            blow(weather, &air, &c);
        copy_to_dense(system, &c);
        draw_touch_speeds(seed, model, &c);
        assert_true(dense_launch_evaluate(dense, &c.dense, &reference));
        for (int i = 0; i < 3; i++) {
            assert_int_equal(evaluate[i](system, &c.input, &c.phase, c.state, &out), LAUNCHING_OK);
            compare(system, &c, &out, &reference, &worst[i]);
            for (int k = 0; k < dense->surface_count; k++)
                worst[i].pressed += reference.surface[k].normal > 0;
        }
    }
    dense_launch_free(dense);
    free(dense);
    aerodynamics_free(&air);
    launching_free(system);
    free(system);
}

static void shoes_equal_dense(void **state)
{
    (void)state;
    static const char *const form[] = {"listed surfaces", "T-slots", "towers"};
    static const char *const program[] = {"reduced", "from the general matrix", "overall"};
    static const evaluator evaluate[] = {launching_evaluate, launching_evaluate_general,
                                         launching_evaluate_overall};
    const char *asked = getenv("LD_RAIL_STATES");
    int states = asked ? atoi(asked) : 60, each = 5;
    uint64_t seed = 15, weather = 16, bent = 17;
    for (int f = 0; f < 3; f++) {
        agreement worst[3] = {0};
        for (int n = 0; n < states; n += each) {
            ld_model model;
            draw_rail(&seed, f, &model);
            if (n % 2)
                draw_air(&weather, &model.rocket.aerodynamics);
            if (n / each % 3 > 0)
                draw_initial_shape(&bent, &model.tubes.initial_shape);
            compare_states(&model, evaluate, &seed, &weather, each, worst);
            reference_model_free(&model);
        }
        for (int i = 0; i < 3; i++) {
            printf("  %s, %s, %d states, %.1f surfaces pressed in each:\n", form[f], program[i],
                   states, (double)worst[i].pressed / states);
            // the overall form solves for all unknowns at once: its rounding grows with the number
            // of states, 3.7e-11 in 1000 with initial shapes
            CHECK_BELOW("tube accelerations", worst[i].tube, asked && i == 2 ? 5e-11 : 1e-11);
            CHECK_BELOW("rocket accelerations", worst[i].rocket, 1e-11);
            CHECK_BELOW("lock force", worst[i].lock, 6e-11);
            CHECK_BELOW("force and moment of the air", worst[i].air, 1e-13);
            CHECK_BELOW("forces and moments of shoes", worst[i].shoe, 6e-11);
            CHECK_BELOW("force and moment on the base", worst[i].base, 1e-12);
        }
    }
}

// ---- closed forms ----

// A straight rail at rest in its base, the rocket in it as `x` says (after s), every speed zero.
static void place(const launching_system *system, const double x[5], launching_case *c)
{
    const launching_layout *at = &system->layout;
    memset(c, 0, sizeof *c);
    c->state[at->quaternion] = 1;
    c->state[at->x] = 0.4;
    memcpy(c->state + at->x + 1, x, 5 * sizeof *x);
    c->input.base.A = m3_identity();
    c->input.base.q = q_from_matrix(c->input.base.A);
    c->input.mass.m = 60;
    c->input.mass.c = v3_make(1.1, 0, 0);
    c->input.mass.J = m3_diagonal(0.22, 24, 24);
    c->phase.rocket = true;
}

static launching_system *system_of(const ld_model *model)
{
    launching_system *system = aligned_alloc(64, (sizeof *system + 63) / 64 * 64);
    ld_error error;
    assert_int_equal(launching_build(system, model, NULL, &error), LD_OK);
    return system;
}

// Rolled by gamma, each lip of a T-slot presses on one side with k (sin(gamma) lips/2 - gap): the
// shoes carry the roll by these couples and by nothing else.
static void lips_carry_roll(void **state)
{
    (void)state;
    ld_model model;
    launching_case c;
    launching_output out;
    reference_model(&model);
    model.gravity = 0;
    model.tubes.slot.kind = LD_SLOT_NONE;
    model.tubes.guide = (ld_guide){.present = true,
                                   .form = LD_GUIDE_T_SLOT,
                                   .line = {0.07, 0.02},
                                   .t_slot = {.lips = 0.06, .gap = 0.5e-3, .side_gap = 0.3e-3}};
    for (int i = 0; i < 3; i++)
        model.rocket.adaptor[i].clearance = NAN;
    launching_system *system = system_of(&model);
    for (int sign = -1; sign <= 1; sign += 2) {
        double gamma = sign * 0.025, k = model.rocket.contact.stiffness, half = 0.03;
        double couple = 2 * k * (sin(0.025) * half - 0.5e-3) * half * cos(gamma), sum = 0;
        place(system, (double[5]){0.07, 0.02, 0, 0, gamma}, &c);
        assert_int_equal(launching_evaluate(system, &c.input, &c.phase, c.state, &out),
                         LAUNCHING_OK);
        for (int i = 0; i < 3; i++) {
            sum -= sign * couple;
            CHECK_BELOW("force on the shoe, of its normal forces",
                        hypot(out.shoe[i].force_y, out.shoe[i].force_z) / out.adaptor[i].normal,
                        1e-13);
            CHECK_BELOW("moment of the lips, relative", out.shoe[i].moment_x / (-sign * couple) - 1,
                        1e-12);
        }
        CHECK_BELOW("roll acceleration, relative", out.alpha_B.x / (sum / 0.22) - 1, 1e-12);
    }
    launching_free(system);
    free(system);
    reference_model_free(&model);
}

// The same state in two guides; the largest difference of forces and accelerations, relative.
static double guides_differ(launching_system *const system[2], const launching_case *c)
{
    launching_output out[2];
    double worst = 0;
    for (int g = 0; g < 2; g++)
        assert_int_equal(launching_evaluate(system[g], &c->input, &c->phase, c->state, &out[g]),
                         LAUNCHING_OK);
    v3 a[2], alpha[2], w_dot[2];
    for (int g = 0; g < 2; g++) {
        a[g] = out[g].a_O1;
        alpha[g] = out[g].alpha_B;
        w_dot[g] = out[g].w_dot;
    }
    worst = fmax(worst, v3_norm(v3_sub(a[0], a[1])) / v3_norm(a[0]));
    double turning = v3_norm(alpha[0]) + v3_norm(w_dot[0]);
    worst = fmax(worst, v3_norm(v3_sub(alpha[0], alpha[1])) / turning);
    worst = fmax(worst, v3_norm(v3_sub(w_dot[0], w_dot[1])) / v3_norm(w_dot[0]));
    for (int i = 0; i < 3; i++)
        worst = fmax(worst, fabs(out[0].adaptor[i].normal / out[1].adaptor[i].normal - 1));
    return worst;
}

// Pressed towards one of four rails, on a straight guide, a tower is the bore of the same gap: with
// friction, where the rails are as far out as the wall.
static void four_rails_are_a_bore(void **state)
{
    (void)state;
    ld_model model;
    uint64_t seed = 3;
    double worst = 0;
    for (int n = 0; n < 40; n++) {
        launching_system *system[2];
        launching_case c;
        double angle = between(&seed, -3, 3), e[2] = {cos(angle), sin(angle)};
        double gap = between(&seed, 0, 1e-3);
        for (int tower = 0; tower < 2; tower++) {
            reference_model(&model);
            model.tubes.slot.kind = LD_SLOT_NONE;
            for (int i = 0; i < 3; i++)
                model.rocket.adaptor[i].clearance = tower ? NAN : gap;
            model.tubes.guide = (ld_guide){
                .present = tower, .form = LD_GUIDE_TOWER, .tower = {4, angle, gap, 0.0825}};
            system[tower] = system_of(&model);
            reference_model_free(&model);
        }
        // leant towards the rail, exactly
        double out = between(&seed, 1.5e-3, 2e-3), lean = between(&seed, -2e-4, 2e-4);
        double psi = atan2(sin(lean) * e[0], cos(lean)), theta = -asin(sin(lean) * e[1]);
        place(system[0], (double[5]){out * e[0], out * e[1], psi, theta, between(&seed, -3, 3)},
              &c);
        // small speeds along the rail's direction, large ones along the guide
        const launching_layout *at = &system[0]->layout;
        v3_store(c.state + at->v, v3_make(5, 0, 0));
        v3_store(c.state + at->V, v3_make(20, 0.1 * e[0], 0.1 * e[1]));
        assert_int_equal(at->V, system[1]->layout.V);
        worst = fmax(worst, guides_differ(system, &c));
        for (int g = 0; g < 2; g++) {
            launching_free(system[g]);
            free(system[g]);
        }
    }
    CHECK_BELOW("four rails against the bore, relative", worst, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shoes_equal_dense),
        cmocka_unit_test(lips_carry_roll),
        cmocka_unit_test(four_rails_are_a_bore),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
