// The launching subsystem against dense multipliers from positions alone, on random states.
#include <stdlib.h>

#include "model/parts.h"
#include "support/check.h"
#include "support/evaluators.h"
#include "support/launching_state.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_general.h"
#include "systems/launching/launching_kinematics.h"
#include "systems/launching/launching_overall.h"

typedef struct agreement {
    double eta, V, slot, lock, contact, breech, base, crossflow, wind;
} agreement;

static double relative3(const double *a, v3 b, double scale)
{
    double d[3];
    v3_store(d, b);
    return sqrt((a[0] - d[0]) * (a[0] - d[0]) + (a[1] - d[1]) * (a[1] - d[1]) +
                (a[2] - d[2]) * (a[2] - d[2])) /
           scale;
}

static double norm3(const double *a)
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

// Largest differences, relative to the largest acceleration of the kind and to the largest force.
// The rocket's accelerations are the tube's and the relative ones together, of which both may be
// large where their sum is not: the tube's count too.
static void compare(const launching_system *system, const launching_case *c,
                    const launching_output *out, const dense_launch_output *dense, agreement *worst)
{
    double modal = 0, modal_error = 0, force = fabs(dense->slot_force) + fabs(dense->lock_force);
    force += dense->breech_force;
    for (int i = 0; i < system->layout.nq; i++) {
        modal = fmax(modal, fabs(dense->q_ddot[i]));
        modal_error = fmax(modal_error, fabs(dense->q_ddot[i] - out->q_ddot[i]));
    }
    for (int i = 0; i < system->adaptors.count; i++)
        force += c->phase.passed[i] ? 0 : fabs(dense->contact[i].normal);
    worst->eta = fmax(worst->eta, relative3(dense->a, out->a, norm3(dense->a)));
    worst->eta = fmax(worst->eta, relative3(dense->w_dot, out->w_dot, norm3(dense->w_dot)));
    worst->eta = fmax(worst->eta, modal_error / modal);
    double a = norm3(dense->a_O1) + norm3(dense->a);
    double alpha = norm3(dense->alpha_B) + norm3(dense->w_dot);
    worst->V = fmax(worst->V, relative3(dense->a_O1, out->a_O1, a));
    worst->V = fmax(worst->V, relative3(dense->alpha_B, out->alpha_B, alpha));
    worst->slot = fmax(worst->slot, fabs(dense->slot_force - out->N) / force);
    worst->lock = fmax(worst->lock, fabs(dense->lock_force - out->lock_force) / force);
    worst->breech = fmax(worst->breech, fabs(dense->breech_force - out->breech_force) / force);
    for (int i = 0; i < system->adaptors.count; i++)
        if (!c->phase.passed[i])
            worst->contact = fmax(worst->contact,
                                  fabs(dense->contact[i].normal - out->adaptor[i].normal) / force);
    worst->crossflow = fmax(worst->crossflow, relative3(dense->crossflow, out->crossflow, force));
    if (system->wind.count)
        worst->wind = fmax(worst->wind,
                           relative3(dense->guide_wind, out->guide_wind, norm3(dense->guide_wind)));
    worst->base =
        fmax(worst->base, relative3(dense->base_force, out->base_force, norm3(dense->base_force)));
    worst->base = fmax(worst->base,
                       relative3(dense->base_moment, out->base_moment, norm3(dense->base_moment)));
}

// Every other unlocked state is pressed on the breech, half of them behind the tube's rear end. At
// half the laws' speeds the damping would cut the force off: these press on.
static void put_on_breech(const launching_system *system, int k, launching_case *c)
{
    double *y = c->state, *s = y + system->layout.x;
    launching_pose pose;
    launching_output out;
    if (k % 4 == 2)
        *s = -1e-3;
    c->phase.breech = *s + 1e-3;
    // slot and tube give way to the change
    for (int pass = 0; pass < 4; pass++) {
        launching_rocket_pose(system, y, &pose, &out);
        v3 back = v3_scale(-out.y[0] - 0.1, m3_column(pose.A_RS, 0));
        v3_store(y + system->layout.V, v3_add(pose.v_O1, back));
        launching_project(system, &c->input, &c->phase, y);
    }
}

// A wind across the rocket, stronger than its own lateral speed anywhere.
static void blow(const launching_system *system, uint64_t *seed, launching_case *c)
{
    const launching_layout *at = &system->layout;
    launching_pose pose;
    launching_output unused;
    launching_rocket_pose(system, c->state, &pose, &unused);
    double angle = 3 * draw(seed);
    v3 across = m3_apply(pose.A_RB, v3_make(9, 120 * cos(angle), 120 * sin(angle)));
    m3 A_IR = q_matrix(q_from(c->state + at->quaternion));
    c->input.air.v = m3_apply(A_IR, v3_add(pose.v_O1, across));
    c->input.air.density = 1.2 + 0.1 * draw(seed);
}

static moving_air same_air(const void *self, double t, v3 r)
{
    (void)t, (void)r;
    return *(const moving_air *)self;
}

// A wind along the guide, of its own speeds in size, and a jet on its front end.
static void blow_on_guide(uint64_t *seed, launching_case *c)
{
    static moving_air air;
    if (c->input.air.density == 0) {
        c->input.air.v = draw_v3(seed, 20);
        c->input.air.density = 1.2 + 0.1 * draw(seed);
    }
    air = c->input.air;
    c->input.about = (air_about){.at = same_air, .self = &air};
    v3 gust = draw_v3(seed, 5);
    air.v = v3_sub(air.v, gust);
    c->input.about.turbulence = gust;
    double hit = 500 * (1 + draw(seed));
    c->input.jet_face = (guide_push){hit, {-hit, 0, 0}, {0, 3e-5 * hit, -5e-5 * hit}};
    c->input.deflector = (guide_push){2 * hit,
                                      {-1.1 * hit, 0.3 * hit, -0.6 * hit},
                                      {1e-3 * (hit - 500), -4e-5 * hit, 7e-5 * hit}};
}

static void check_agreement(const ld_model *model, evaluator evaluate, int count, const char *name)
{
    launching_system *system = aligned_alloc(64, (sizeof *system + 63) / 64 * 64);
    dense_launch dense;
    ld_error error;
    assert_int_equal(launching_build(system, model, NULL, &error), LD_OK);
    dense_launch_create(&dense, model, &system->tube.flexible);
    uint64_t seed = 20261121;
    agreement worst = {0};
    int pressed = 0, emerged = 0;
    for (int k = 0; k < count; k++) {
        launching_case c;
        launching_output out;
        dense_launch_output reference;
        draw_state(system, &seed, k % 4 == 0, &c);
        for (int i = system->adaptors.count - 1; i > 0 && draw(&seed) > 0.5; i--)
            c.phase.passed[i] = true;
        if (k % 4 == 1 || k % 4 == 2)
            put_on_breech(system, k, &c);
        if (model_has_crossflow(model))
            blow(system, &seed, &c);
        if (system->wind.count)
            blow_on_guide(&seed, &c);
        copy_to_dense(system, &c);
        assert_int_equal(evaluate(system, &c.input, &c.phase, c.state, &out), LAUNCHING_OK);
        assert_true(dense_launch_evaluate(&dense, &c.dense, &reference));
        compare(system, &c, &out, &reference, &worst);
        pressed += reference.breech_force > 0;
        emerged += reference.emerged > 0;
    }
    printf("  %s, %d states:\n", name, count);
    // clamps leave of the tube's accelerations what is small beside those without them
    double lost = system->supports.clamps ? 10 : 1;
    CHECK_BELOW("tube accelerations", worst.eta, lost * 1e-11);
    CHECK_BELOW("rocket accelerations", worst.V, lost * 1e-11);
    CHECK_BELOW("slot force", worst.slot, lost * 6e-11);
    CHECK_BELOW("lock force", worst.lock, lost * 6e-11);
    CHECK_BELOW("contact forces", worst.contact, lost * 6e-11);
    CHECK_BELOW("breech force", worst.breech, lost * 6e-11);
    CHECK_WITHIN("share of states on the breech", (double)pressed / count, 0.4, 0.5);
    CHECK_BELOW("force and moment on the base", worst.base, lost * 1e-12);
    if (system->wind.count)
        CHECK_BELOW("force of the wind on the guide", worst.wind, 1e-13);
    if (model_has_crossflow(model)) {
        CHECK_BELOW("force of the air", worst.crossflow, 1e-12);
        CHECK_WITHIN("share of states in the air", (double)emerged / count, 0.5, 0.9);
    }
    dense_launch_free(&dense);
    launching_free(system);
    free(system);
}

static void reduced_equals_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.rocket.motor.misalignment[0] = 1e-3;
    model.rocket.motor.misalignment[1] = -2e-3;
    model.rocket.motor.at[1] = 1e-3;
    model.rocket.knob_angle = 0.4;
    int modes[2] = {3, 5};
    for (int i = 0; i < 2; i++) {
        char name[64];
        model.tubes.modes.bending = modes[i];
        snprintf(name, sizeof name, "reduced, %d bending modes a plane", modes[i]);
        check_agreement(&model, launching_evaluate, 500, name);
    }
    reference_model_free(&model);
}

// A rail of two sections, each with its own bending stiffness of each plane, out of proportion.
static void split_planes(ld_tubes *tubes)
{
    tubes->section_count = 2;
    tubes->section[1] = tubes->section[0];
    tubes->section[1].from = 1.3;
    for (int i = 0; i < 2; i++) {
        ld_section *s = &tubes->section[i];
        double EI = s->bending_stiffness;
        s->form = LD_SECTION_PLANES;
        s->bending_stiffness_y = (i ? 1.2 : 0.3) * EI;
        s->bending_stiffness_z = (i ? 0.5 : 1.7) * EI;
        s->bending_stiffness = NAN;
    }
    tubes->modes.damping = 0.02;
}

static double worst_condition;

static launching_outcome overall(const launching_system *system, const launching_input *input,
                                 const launching_phase *phase, const double *state,
                                 launching_output *out)
{
    launching_outcome outcome = launching_evaluate_overall(system, input, phase, state, out);
    assert_false(out->fell_back);
    worst_condition = fmax(worst_condition, out->condition);
    return outcome;
}

static void overall_equals_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.rocket.knob_angle = -0.7;
    int modes[2] = {3, 5};
    for (int i = 0; i < 2; i++) {
        char name[64];
        model.tubes.modes.bending = modes[i];
        worst_condition = 0;
        snprintf(name, sizeof name, "overall 19 x 19, %d bending modes a plane", modes[i]);
        check_agreement(&model, overall, 500, name);
        printf("    condition of the tube's transfer matrix up to %.2g\n", worst_condition);
    }
    reference_model_free(&model);
}

// Each plane with shapes of its own, for its own supports, tail and stiffness.
static void planes_equal_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 5;
    for (int k = 0; k < 2; k++) {
        model.tubes.support[k].stiffness[1] = 5e6;
        model.tubes.support[k].stiffness[2] = 5e5;
        model.tubes.support[k].rotational_stiffness[1] = 5e3;
        model.tubes.support[k].rotational_stiffness[2] = 5e5;
    }
    check_agreement(&model, launching_evaluate, 200, "reduced, unlike supports");
    model.tubes.tail.inertia[1] = 0.7;
    split_planes(&model.tubes);
    check_agreement(&model, launching_evaluate, 200, "reduced, planes out of proportion");
    check_agreement(&model, launching_evaluate_general, 100, "general, planes out of proportion");
    check_agreement(&model, overall, 100, "overall, planes out of proportion");
    model.tubes.modes.bending = 3;
    check_agreement(&model, launching_evaluate, 100, "reduced, with 3 modes");
    model.tubes.modes.bending = 5;
    model.tubes.modes.axial = 2;
    check_agreement(&model, launching_evaluate, 100, "reduced, with axial modes");
    check_agreement(&model, overall, 100, "overall, with axial modes");
    model.tubes.modes.axial = 0;
    model.tubes.support[0].clamped = 0x2a; // y, roll, pitch
    model.tubes.support[1].clamped = 0x04; // z
    check_agreement(&model, launching_evaluate, 200,
                    "reduced, clamped in planes out of proportion");
    model.rocket.adaptor_count = 2;
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    check_agreement(&model, launching_evaluate, 100, "reduced, clamped, ideal adaptors");
    check_agreement(&model, launching_evaluate_general, 100, "general, clamped, ideal adaptors");
    reference_model_free(&model);
}

static void options_equal_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    model.tubes.modes.axial = 2;
    check_agreement(&model, launching_evaluate, 200, "reduced, axial modes");
    check_agreement(&model, overall, 200, "overall, axial modes");
    model.tubes.modes.axial = 0;
    check_agreement(&model, launching_evaluate_general, 200, "reduced from the general matrix");
    model.tubes.modes.span = LD_SPAN_FREE_FREE;
    model.tubes.support[0].rotational_stiffness[1] = 5e5; // not isotropic
    model.tubes.point_mass_count = 1;
    model.tubes.point_mass[0] = (ld_point_mass){.at = 1.5, .mass = 0.4};
    check_agreement(&model, launching_evaluate, 200, "free-free span, point mass, uneven support");
    model.rocket.contact.law = LD_CONTACT_LANKARANI_NIKRAVESH;
    model.rocket.contact.exponent = 1.5;
    check_agreement(&model, launching_evaluate, 200, "lankarani-nikravesh, n = 1.5");
    model.rocket.contact.law = LD_CONTACT_KELVIN_VOIGT;
    model.rocket.contact.damping = 2e4;
    check_agreement(&model, launching_evaluate, 200, "kelvin-voigt");
    model.rocket.contact.law = LD_CONTACT_BILATERAL;
    check_agreement(&model, launching_evaluate, 200, "bilateral");
    const ld_lock lock = model.rocket.lock;
    model.rocket.lock.x = 0.7;
    model.rocket.lock.radius = 0.0825;
    model.rocket.lock.angle = 2.2;
    check_agreement(&model, launching_evaluate, 200, "lock off the axis");
    check_agreement(&model, overall, 200, "lock off the axis, overall");
    model.tubes.slot.kind = LD_SLOT_NONE;
    check_agreement(&model, launching_evaluate, 200, "lock off the axis, no slot");
    model.tubes.slot.kind = LD_SLOT_HELIX;
    model.rocket.lock = lock;
    model.rocket.contact.law = LD_CONTACT_HUNT_CROSSLEY;
    model.tubes.slot.kind = LD_SLOT_NONE;
    check_agreement(&model, launching_evaluate, 200, "no slot (the lock holds the roll)");
    check_agreement(&model, overall, 200, "no slot, overall");
    model.tubes.slot.kind = LD_SLOT_HELIX;
    free(model.tubes.slot.angle.data);
    model.tubes.slot.angle = reference_table(3, 2, (double[]){0, 0, 1, 0.05, 3, 0.3});
    check_agreement(&model, launching_evaluate, 200, "slot angle from a table");
    reference_model_free(&model);
}

// Both adaptors, or the rear one alone, held on the axis exactly.
static void ideal_adaptors_equal_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    model.rocket.adaptor_count = 2;
    model.rocket.adaptor[1] = model.rocket.adaptor[2];
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    check_agreement(&model, launching_evaluate, 200, "ideal");
    check_agreement(&model, launching_evaluate_general, 200, "ideal from the general matrix");
    check_agreement(&model, overall, 200, "ideal, overall");
    model.tubes.modes.axial = 2;
    check_agreement(&model, launching_evaluate, 200, "ideal, axial modes");
    check_agreement(&model, overall, 200, "ideal, axial modes, overall");
    model.tubes.modes.axial = 0;
    model.tubes.slot.kind = LD_SLOT_NONE;
    check_agreement(&model, launching_evaluate, 200, "ideal, no slot");
    model.tubes.slot.kind = LD_SLOT_HELIX;
    reference_model_free(&model);
}

// Supports that hold the tube rigidly on a base that moves and accelerates.
static void clamped_supports_equal_dense(void **state)
{
    (void)state;
    static const unsigned clamped[][2] = {{0x3f, 0}, {0x07, 0x06}, {0x0f, 0x16}, {0x2e, 0x01}};
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    model.tubes.support[1].rotational_stiffness[1] = 5e5; // not isotropic
    for (int i = 0; i < 4; i++) {
        char name[64];
        model.tubes.support[0].clamped = clamped[i][0];
        model.tubes.support[1].clamped = clamped[i][1];
        snprintf(name, sizeof name, "clamped %#x and %#x", clamped[i][0], clamped[i][1]);
        check_agreement(&model, launching_evaluate, 200, name);
    }
    check_agreement(&model, launching_evaluate_general, 200, "the same from the general matrix");
    model.tubes.modes.axial = 2;
    check_agreement(&model, launching_evaluate, 100, "the same, axial modes");
    model.rocket.adaptor_count = 2;
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    check_agreement(&model, launching_evaluate, 100, "the same, ideal adaptors");
    reference_model_free(&model);
}

// How far the sections of clamped stations are from where the base holds them, along x, y, z [m],
// and how fast they move against it [m/s].
static void off_clamps(const launching_system *system, const launching_case *c, double *place,
                       double *speed)
{
    const launching_layout *at = &system->layout;
    const base_frame *base = &c->input.base;
    m3 A_IR = q_matrix(q_from(c->state + at->quaternion));
    for (int k = 0; k < system->supports.count; k++) {
        double x = system->model->tubes.support[k].at;
        launching_section section;
        launching_section_at(system, c->state, x, &section);
        v3 P = v3_add(v3_from(c->state + at->r), m3_apply(A_IR, section.P));
        v3 arm = v3_sub(P, base->r), v = v3_add(base->v, v3_cross(base->w, arm));
        v3 off = v3_sub(m3_apply_transposed(base->A, arm), v3_make(x, 0, 0));
        *place = fmax(*place, v3_norm(off));
        *speed = fmax(*speed, v3_norm(v3_sub(m3_apply(A_IR, section.v), v)));
    }
}

// Displacements of the supports are some millimetres either way: off the front stop and on it, half
// of those out of it at the end of the stroke.
static void let_recoil(ld_model *model)
{
    for (int i = 0; i < 2; i++)
        model->tubes.support[i].recoil = (ld_recoil){.present = true,
                                                     .preload = 2e3 * (1 + i),
                                                     .stiffness = 4e4,
                                                     .damping = 900,
                                                     .quadratic_damping = 300,
                                                     .friction = 250,
                                                     .friction_speed = 0.5,
                                                     .stroke = i ? NAN : 5e-4};
}

// Bending draws the sections along x, and what acts along x works on that.
static void geometric_stiffness_equals_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    model.tubes.modes.geometric_stiffness = LD_GEOMETRIC_YES;
    check_agreement(&model, launching_evaluate, 100, "geometric stiffness");
    check_agreement(&model, overall, 100, "geometric stiffness, overall");
    let_recoil(&model);
    model.tubes.point_mass_count = 1;
    model.tubes.point_mass[0] = (ld_point_mass){.at = 1.5, .mass = 0.4};
    model.tubes.modes.axial = 2;
    check_agreement(&model, launching_evaluate, 60, "the same, axial modes, recoil, point mass");
    split_planes(&model.tubes);
    model.tubes.support[0].clamped = 0x2a; // y, roll, pitch
    model.tubes.support[1].clamped = 0x05; // x, z
    model.tubes.support[1].recoil.present = false;
    check_agreement(&model, launching_evaluate, 60, "the same, clamped, planes out of proportion");
    model.rocket.adaptor_count = 2;
    model.rocket.adaptor[1] = model.rocket.adaptor[2];
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    check_agreement(&model, launching_evaluate, 60, "the same, ideal adaptors");
    model.tubes.support[0].clamped = model.tubes.support[1].clamped = 0;
    check_agreement(&model, overall, 60, "the same without clamps, overall");
    reference_model_free(&model);
}

// Sections that turn by less than the slope, with rotary inertia.
static void shear_equals_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    model.tubes.modes.shear_coefficient = 1e-3; // soft: 0.53 is that of a thin tube
    check_agreement(&model, launching_evaluate, 100, "shear");
    check_agreement(&model, overall, 100, "shear, overall");
    model.rocket.adaptor_count = 2;
    model.rocket.adaptor[1] = model.rocket.adaptor[2];
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    check_agreement(&model, overall, 60, "shear, ideal adaptors, overall");
    split_planes(&model.tubes);
    model.tubes.modes.geometric_stiffness = LD_GEOMETRIC_YES;
    model.tubes.modes.axial = 2;
    model.tubes.support[0].clamped = 0x2a; // y, roll, pitch
    model.tubes.support[1].clamped = 0x05; // x, z
    check_agreement(&model, launching_evaluate, 60, "shear and all other options, clamped");
    reference_model_free(&model);
}

// Two stations held along x, which a tube with axial modes alone can follow: its stretch takes part
// in what puts it back.
static void projection_stretches_the_tube(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    reference_model(&model);
    model.tubes.modes.axial = 3;
    model.tubes.support[0].clamped = 0x3f;
    model.tubes.support[1].clamped = 0x07;
    launching_system *system = aligned_alloc(64, (sizeof *system + 63) / 64 * 64);
    assert_int_equal(launching_build(system, &model, NULL, &error), LD_OK);
    uint64_t seed = 20261122;
    double place = 0, speed = 0;
    for (int k = 0; k < 20; k++) {
        launching_case c;
        draw_state(system, &seed, false, &c); // projected: from centimetres off by 1e-6 of it
        launching_project(system, &c.input, &c.phase, c.state);
        off_clamps(system, &c, &place, &speed);
    }
    CHECK_BELOW("clamped stations off their places [m]", place, 1e-13);
    CHECK_BELOW("their speed against the base [m/s]", speed, 1e-12);
    launching_free(system);
    free(system);
    reference_model_free(&model);
}

static void air_on_the_emerged_part_equals_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    model.rocket.aerodynamics.present = true;
    model.rocket.aerodynamics.emerged.present = true;
    model.rocket.aerodynamics.emerged.nose = 2.55;
    model.rocket.aerodynamics.emerged.drag = 1.2;
    model.rocket.aerodynamics.emerged.diameter = 0.3;
    check_agreement(&model, launching_evaluate, 200, "air, reduced");
    check_agreement(&model, launching_evaluate_general, 200,
                    "air, reduced from the general matrix");
    check_agreement(&model, overall, 200, "air, overall");
    reference_model_free(&model);
}

static void pressure_and_recoil_equal_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    let_recoil(&model);
    check_agreement(&model, launching_evaluate, 60, "recoil, reduced");
    ld_pressure *pressure = &model.tubes.pressure;
    *pressure = (ld_pressure){.present = true,
                              .form = LD_PRESSURE_OF_GAS,
                              .pressure = 2e6,
                              .volume = 0.03,
                              .exponent = 1.4,
                              .ambient = 1e5,
                              .scale = 1.2};
    check_agreement(&model, launching_evaluate, 60, "gas and recoil, reduced");
    check_agreement(&model, launching_evaluate_general, 60,
                    "gas and recoil, reduced from the general matrix");
    check_agreement(&model, overall, 60, "gas and recoil, overall");
    pressure->form = LD_PRESSURE_OVER_TRAVEL;
    pressure->scale = 1.1;
    pressure->over_travel = reference_table(2, 2, (double[]){0, 3e6, 2.9, 1e6});
    model.tubes.slot.kind = LD_SLOT_NONE;
    model.tubes.modes.axial = 2;
    check_agreement(&model, launching_evaluate, 60, "pressure over travel, axial modes, no slot");
    pressure->form = LD_PRESSURE_OVER_TIME;
    pressure->over_time = reference_table(3, 2, (double[]){0, 1e6, 0.01, 4e6, 0.02, 0});
    check_agreement(&model, launching_evaluate, 60, "pressure over time");
    free(pressure->over_travel.data);
    free(pressure->over_time.data);
    pressure->over_travel = pressure->over_time = (ld_table){0};
    reference_model_free(&model);
}

// A guide that is not straight, of two to four rows, with and without twist, ending beyond the tip.
static void shape_guide(int rows, int columns, ld_model *model)
{
    static const double given[4][4] = {{-0.2, 3e-3, -1e-3, 0.02},
                                       {0.8, -2e-3, 4e-3, -0.03},
                                       {2.1, 5e-3, 1e-3, 0.05},
                                       {3.3, -1e-3, -6e-3, -0.01}};
    double row[16];
    ld_initial_shape *shape = &model->tubes.initial_shape;
    free(shape->offsets.data);
    for (int i = 0; i < rows; i++)
        memcpy(row + i * columns, given[i + 1 < rows ? i : 3], (size_t)columns * sizeof *row);
    *shape = (ld_initial_shape){.present = true,
                                .scale = {1.5, -0.7},
                                .twist_scale = 0.9,
                                .offsets = reference_table((size_t)rows, (size_t)columns, row)};
}

static void initial_shape_equals_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.tubes.modes.bending = 4;
    shape_guide(4, 4, &model);
    check_agreement(&model, launching_evaluate, 200, "initial shape");
    check_agreement(&model, launching_evaluate_general, 60, "initial shape, general");
    check_agreement(&model, overall, 200, "initial shape, overall");
    shape_guide(3, 3, &model);
    model.tubes.slot.kind = LD_SLOT_NONE;
    model.rocket.contact.law = LD_CONTACT_BILATERAL;
    check_agreement(&model, launching_evaluate, 60, "initial shape, bilateral, no slot");
    model.tubes.slot.kind = LD_SLOT_HELIX;
    model.rocket.adaptor_count = 2;
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    shape_guide(4, 4, &model);
    check_agreement(&model, launching_evaluate, 60, "initial shape, ideal");
    check_agreement(&model, overall, 60, "initial shape, ideal, overall");
    model.tubes.support[0].clamped = 0x3f;
    check_agreement(&model, launching_evaluate, 60, "initial shape, ideal, clamped");
    model.tubes.support[0].clamped = 0;
    model.tubes.modes.geometric_stiffness = LD_GEOMETRIC_YES;
    model.tubes.modes.shear_coefficient = 0.5;
    check_agreement(&model, launching_evaluate_general, 60, "initial shape, ideal, shear, P-delta");
    reference_model_free(&model);
}

static void wind_on_the_guide_equals_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    ld_tubes *tubes = &model.tubes;
    tubes->modes.bending = 4;
    tubes->wind_drag_count = 3;
    tubes->wind_drag[0] = (ld_wind_drag){0, 1.3, 0.4, 1.2};
    tubes->wind_drag[1] = (ld_wind_drag){1.3, 3, 0.2, 0.7};
    tubes->wind_drag[2] = (ld_wind_drag){2.5, 2.6, 6, 2};
    check_agreement(&model, launching_evaluate, 100, "wind on the guide");
    check_agreement(&model, launching_evaluate_general, 60, "wind on the guide, general");
    check_agreement(&model, overall, 60, "wind on the guide, overall");
    tubes->section[0].form = LD_SECTION_PLANES;
    tubes->section[0].bending_stiffness_y = tubes->section[0].bending_stiffness;
    tubes->section[0].bending_stiffness_z = 0.4 * tubes->section[0].bending_stiffness;
    tubes->section[0].bending_stiffness = NAN;
    model.rocket.aerodynamics.present = model.rocket.aerodynamics.emerged.present = true;
    model.rocket.aerodynamics.emerged.nose = 2.55;
    model.rocket.aerodynamics.emerged.drag = 1.2;
    model.rocket.aerodynamics.emerged.diameter = 0.3;
    shape_guide(4, 4, &model);
    check_agreement(&model, launching_evaluate, 60, "wind, bent guide, planes that differ, air");
    reference_model_free(&model);
    reference_model(&model);
    tubes->modes.bending = 4;
    tubes->modes.shear_coefficient = 0.05;
    tubes->wind_drag_count = 1;
    tubes->wind_drag[0] = (ld_wind_drag){0.3, 2.6, 0.4, 1.2};
    check_agreement(&model, launching_evaluate, 60, "wind, shear");
    tubes->modes.shear_coefficient = 0;
    tubes->modes.geometric_stiffness = LD_GEOMETRIC_YES;
    tubes->modes.axial = 2;
    check_agreement(&model, launching_evaluate, 60, "wind, P-delta, axial");
    reference_model_free(&model);
}

// The wider instructions give the same bits.
static void wide_instructions_give_the_same_bits(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    launching_system *system = aligned_alloc(64, (sizeof *system + 63) / 64 * 64);
    reference_model(&model);
    assert_int_equal(launching_build(system, &model, NULL, &error), LD_OK);
    if (!system->wide_instructions)
        printf("    this processor has none: nothing to compare\n");
    uint64_t seed = 7;
    for (int k = 0; k < 300; k++) {
        launching_case c;
        launching_output wide, plain;
        bool has = system->wide_instructions;
        memset(&wide, 0, sizeof wide);
        memset(&plain, 0, sizeof plain);
        draw_state(system, &seed, k % 4 == 0, &c);
        launching_evaluate(system, &c.input, &c.phase, c.state, &wide);
        system->wide_instructions = false;
        launching_evaluate(system, &c.input, &c.phase, c.state, &plain);
        system->wide_instructions = has;
        assert_memory_equal(&wide, &plain, sizeof wide);
    }
    launching_free(system);
    free(system);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reduced_equals_dense),
        cmocka_unit_test(planes_equal_dense),
        cmocka_unit_test(overall_equals_dense),
        cmocka_unit_test(options_equal_dense),
        cmocka_unit_test(ideal_adaptors_equal_dense),
        cmocka_unit_test(clamped_supports_equal_dense),
        cmocka_unit_test(geometric_stiffness_equals_dense),
        cmocka_unit_test(shear_equals_dense),
        cmocka_unit_test(projection_stretches_the_tube),
        cmocka_unit_test(air_on_the_emerged_part_equals_dense),
        cmocka_unit_test(pressure_and_recoil_equal_dense),
        cmocka_unit_test(initial_shape_equals_dense),
        cmocka_unit_test(wind_on_the_guide_equals_dense),
        cmocka_unit_test(wide_instructions_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
