// Natural frequencies of bases of kind multibody against closed forms: a parallelogram of links (a
// closed loop with redundant constraints), a body on a bushing, a lever held by a strut, a slider
// crank at rest on its spring. By the displacements of the linearised equations.
#include "support/check.h"

#include "model/model.h"
#include "support/reference_model.h"
#include "systems/bases/base.h"
#include "systems/bases/mechanism_base.h"

enum { MOST = 16 };

static void begin(ld_model *model, double gravity)
{
    reference_vehicle(model, 0);
    model->gravity = gravity;
    model->base.kind = LD_BASE_MULTIBODY;
    model->base.vehicle.wheel_count = 0;
    model->tubes.layout.rows = model->tubes.layout.columns = model->firing[0].tube = 1;
}

static void add_body(ld_model *model, const char *name, double mass, v3 center, v3 inertia)
{
    ld_mechanism *given = &model->base.mechanism;
    ld_body *body = &given->body[given->body_count++];
    snprintf(body->name, sizeof body->name, "%s", name);
    body->mass = mass;
    v3_store(body->center, center);
    v3_store(body->inertia, inertia);
}

// About or along z; more by what is returned.
static ld_joint *add_joint(ld_model *model, ld_joint_kind kind, const char *parent,
                           const char *body, v3 at)
{
    ld_mechanism *given = &model->base.mechanism;
    ld_joint *joint = &given->joint[given->joint_count];
    snprintf(joint->name, sizeof joint->name, "j%d", given->joint_count++);
    snprintf(joint->parent, sizeof joint->parent, "%s", parent);
    snprintf(joint->body, sizeof joint->body, "%s", body);
    joint->kind = kind;
    v3_store(joint->at, at);
    joint->axis[2] = joint->axis_2[0] = 1;
    joint->body_at[0] = joint->stops.low = joint->stops.high = joint->lock.from = NAN;
    return joint;
}

// Accelerations of the displacements at a state.
static void accelerate(const base_system *base, const double *state, double *a)
{
    static base_output out;
    base_frame tube;
    base_found found;
    base_load load = {.linear = true};
    base->kind->find_frame(base, 0, state, &tube, &found);
    assert_int_equal(base->kind->dynamics->evaluate(base, &found, &load, state, &out), 0);
    for (int i = 0; i < base->displacement_count; i++)
        a[i] = out.rate[base->kind->dynamics->speed_of(base, i)];
}

// Squares of the frequencies of displacements that do not couple [rad2/s2]; how much they do.
static int squares_of(const ld_model *model, double *square, double *coupled)
{
    ld_error error;
    base_system base;
    const double h = 1e-6;
    if (base_build(&base, model, NULL, &error))
        fail_msg("%s", error.text);
    const mechanism_base *own = base.own;
    int n = base.displacement_count;
    assert_true(n <= MOST);
    *coupled = 0;
    for (int j = 0; j < n; j++) {
        double plus[MOST], minus[MOST], state[BASE_MOST_STATES];
        for (int side = 0; side < 2; side++) {
            memcpy(state, own->rest, (size_t)base.state_count * sizeof *state);
            base.kind->dynamics->displace_slightly(&base, j, side ? -h : h, state);
            accelerate(&base, state, side ? minus : plus);
        }
        for (int i = 0; i < n; i++) {
            double k = (minus[i] - plus[i]) / (2 * h);
            if (i == j)
                square[j] = k;
            else
                *coupled = fmax(*coupled, fabs(k));
        }
    }
    base_free(&base);
    return n;
}

// Two links of length L hang from the ground and carry a coupler: it swings as a pendulum.
static void parallelogram(void **state)
{
    (void)state;
    const double L = 1.7, D = 1.1, m = 90, m_link = 14, J = 3.1, g = 9.81;
    ld_model model;
    double square[MOST], coupled;
    begin(&model, g);
    for (int i = 0; i < 2; i++)
        add_body(&model, i ? "right" : "left", m_link, v3_make(0, -L / 2, 0), v3_make(J, 1, J));
    add_body(&model, "coupler", m, v3_make(D / 2, 0, 0), v3_make(3, 5, 7));
    snprintf(model.tubes.on, sizeof model.tubes.on, "coupler");
    add_joint(&model, LD_JOINT_REVOLUTE, "ground", "left", v3_zero());
    add_joint(&model, LD_JOINT_REVOLUTE, "ground", "right", v3_make(D, 0, 0));
    add_joint(&model, LD_JOINT_REVOLUTE, "left", "coupler", v3_make(0, -L, 0));
    ld_joint *loop = add_joint(&model, LD_JOINT_REVOLUTE, "right", "coupler", v3_make(0, -L, 0));
    v3_store(loop->body_at, v3_make(D, 0, 0));
    assert_int_equal(squares_of(&model, square, &coupled), 1);
    double expected = g * (m * L + m_link * L) / (m * L * L + 2 * (m_link * L * L / 4 + J));
    CHECK_BELOW("parallelogram's frequency (relative)", sqrt(square[0] / expected) - 1, 5e-10);
    reference_model_free(&model);
}

static void body_on_a_bushing(void **state)
{
    (void)state;
    const double m = 40, J[3] = {1, 2, 3}, k[3] = {1e4, 2e5, 3e4}, k_turn[3] = {700, 5e3, 2e4};
    ld_model model;
    double square[MOST], coupled, worst = 0;
    begin(&model, 0);
    add_body(&model, "body", m, v3_zero(), v3_from(J));
    snprintf(model.tubes.on, sizeof model.tubes.on, "body");
    add_joint(&model, LD_JOINT_FREE, "ground", "body", v3_make(1, 2, 3));
    ld_bushing *bushing = &model.base.mechanism.bushing[model.base.mechanism.bushing_count++];
    *bushing = (ld_bushing){.name = "b", .from = "ground", .to = "body", .at = {1, 2, 3}};
    bushing->to_at[0] = bushing->to_at[1] = bushing->to_at[2] = NAN;
    for (int i = 0; i < 3; i++) {
        bushing->stiffness[i] = k[i];
        bushing->rotational_stiffness[i] = k_turn[i];
        bushing->stop[i] = NAN;
    }
    assert_int_equal(squares_of(&model, square, &coupled), 6);
    for (int i = 0; i < 3; i++) {
        worst = fmax(worst, fabs(sqrt(square[i] * m / k[i]) - 1));
        worst = fmax(worst, fabs(sqrt(square[3 + i] * J[i] / k_turn[i]) - 1));
    }
    CHECK_BELOW("six frequencies on a bushing (relative)", worst, 5e-10);
    CHECK_BELOW("what couples them [1/s2]", coupled, 1e-4);
    reference_model_free(&model);
}

// A lever with a strut from its arm a at an angle to it, whose preload turns with it, too.
static void lever_on_a_strut(void **state)
{
    (void)state;
    const double m = 25, J = 4, c = 0.9, a = 1.2, k = 5e5;
    ld_model model;
    double square[MOST], coupled;
    begin(&model, 0);
    add_body(&model, "lever", m, v3_make(c, 0, 0), v3_make(1, J, J));
    snprintf(model.tubes.on, sizeof model.tubes.on, "lever");
    add_joint(&model, LD_JOINT_REVOLUTE, "ground", "lever", v3_zero());
    ld_strut *strut = &model.base.mechanism.strut[model.base.mechanism.strut_count++];
    *strut = (ld_strut){.name = "s",
                        .from = "ground",
                        .to = "lever",
                        .at = {0.5, -0.8, 0},
                        .to_at = {a, 0, 0},
                        .stiffness = k,
                        .length = NAN};
    assert_int_equal(squares_of(&model, square, &coupled), 1);
    double length = hypot(a - 0.5, 0.8), lever = a * 0.8 / length;
    double expected = k * lever * lever / (J + m * c * c);
    CHECK_BELOW("lever's frequency on a strut (relative)", sqrt(square[0] / expected) - 1, 5e-10);
    reference_model_free(&model);
}

// A crank r, a rod l, and a block that a spring in its slide holds, crank across the slide: turning
// by d moves the block by r d, the rod does not turn (r, l along and across: l along the slide).
static void slider_crank(void **state)
{
    (void)state;
    const double r = 0.4, l = 1.5, J = 0.6, m_rod = 9, m_block = 30, k = 2e4;
    ld_model model;
    double square[MOST], coupled;
    begin(&model, 0);
    add_body(&model, "crank", 5, v3_zero(), v3_make(1, 1, J));
    add_body(&model, "rod", m_rod, v3_make(l / 2, 0, 0), v3_make(1, 2, 2));
    add_body(&model, "block", m_block, v3_zero(), v3_make(1, 1, 1));
    snprintf(model.tubes.on, sizeof model.tubes.on, "block");
    add_joint(&model, LD_JOINT_REVOLUTE, "ground", "crank", v3_zero());
    add_joint(&model, LD_JOINT_REVOLUTE, "crank", "rod", v3_make(0, r, 0));
    ld_joint *slide = add_joint(&model, LD_JOINT_PRISMATIC, "ground", "block", v3_make(l, r, 0));
    v3_store(slide->axis, v3_make(1, 0, 0));
    slide->stiffness = k;
    ld_joint *loop = add_joint(&model, LD_JOINT_REVOLUTE, "rod", "block", v3_make(l, 0, 0));
    v3_store(loop->body_at, v3_zero());
    assert_int_equal(squares_of(&model, square, &coupled), 1);
    double expected = k * r * r / (J + (m_rod + m_block) * r * r);
    CHECK_BELOW("slider crank's frequency (relative)", sqrt(square[0] / expected) - 1, 5e-10);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parallelogram),
        cmocka_unit_test(body_on_a_bushing),
        cmocka_unit_test(lever_on_a_strut),
        cmocka_unit_test(slider_crank),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
