// Damping of the tube's modes, of random round tubes on supports whose stiffness is the same in
// both planes: their bending modes come in pairs of equal frequency, in which any two shapes are
// modes.
#include "math/matrices/lapack.h"
#include <stdlib.h>

#include "state/simulation.h"
#include "support/check.h"
#include "support/launching_state.h"
#include "support/random_model.h"
#include "support/reference_model.h"

enum { TUBES = 25, POSES = 4, MOST = 2 * LD_MAX_STATES };
static const double TWO_PI = 6.283185307179586476925286766559;

// A random launcher without wind on the guide and drag over the speed, which damp; its adaptors
// leave at the tip.
static void draw_launcher(uint64_t seed, ld_model *model)
{
    draw_random_model(seed, model);
    model->tubes.wind_drag_count = 0;
    free(model->rocket.contact.drag_over_speed.data);
    model->rocket.contact.drag_over_speed = (ld_table){0};
    for (int i = 0; i < model->rocket.adaptor_count; i++)
        model->rocket.adaptor[i].leaves_at = NAN;
}

// A tube of the same stiffness in both planes, its dampers as they fall or the same.
static void draw_round_tube(uint64_t *seed, ld_model *model)
{
    draw_launcher(*seed, model);
    model->base = (ld_base){.kind = LD_BASE_FIXED};
    ld_tubes *tubes = &model->tubes;
    tubes->guide.present = tubes->initial_shape.present = false;
    bool same_dampers = chance(seed, 0.5);
    tubes->tail.inertia[2] = tubes->tail.inertia[1];
    for (int i = 0; i < tubes->section_count; i++)
        if (tubes->section[i].form == LD_SECTION_PLANES)
            tubes->section[i].bending_stiffness_y = tubes->section[i].bending_stiffness_z;
    for (int k = 0; k < tubes->support_count; k++) {
        ld_support *support = &tubes->support[k];
        support->stiffness[2] = support->stiffness[1];
        support->rotational_stiffness[2] = support->rotational_stiffness[1];
        support->recoil.present = false; // whose friction and stop are not linear
        support->clamped = 0;
        if (same_dampers) {
            support->damping[2] = support->damping[1];
            support->rotational_damping[2] = support->rotational_damping[1];
        }
    }
}

static void draw_pose(uint64_t *seed, ld_base *base)
{
    *base = (ld_base){.kind = LD_BASE_FIXED, .elevation = between(seed, -1.57, 1.57)};
    if (chance(seed, 0.3))
        return;
    base->kind = LD_BASE_PRESCRIBED;
    base->azimuth = between(seed, -3.1, 3.1);
    ld_sines *motion[6] = {&base->surge, &base->heave, &base->sway,
                           &base->yaw,   &base->pitch, &base->roll};
    for (int i = 0; i < 6; i++) {
        motion[i]->count = 1;
        motion[i]->term[0] =
            (ld_sine){i < 3 ? 30 : 0.3, between(seed, 0, 0.3), between(seed, -3, 3)};
    }
    for (int i = 0; i < 3; i++)
        base->velocity[i] = 20 * draw(seed);
}

static ld_simulation *simulation_of(const ld_model *model)
{
    ld_simulation *simulation = NULL;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    return simulation;
}

static int tube_modes(const ld_model *model, ld_mode *modes)
{
    ld_simulation *simulation = simulation_of(model);
    int count = ld_simulation_tube_modes(simulation, modes, MOST);
    ld_simulation_free(simulation);
    return count;
}

// By frequency, those of one frequency by damping.
static int by_frequency(const void *a, const void *b)
{
    const ld_mode *p = a, *q = b;
    if (fabs(p->frequency - q->frequency) > 2e-7 * q->frequency)
        return p->frequency > q->frequency ? 1 : -1;
    return (p->damping > q->damping) - (p->damping < q->damping);
}

typedef struct differences {
    double frequency, damping; // relative
} differences;

static void compare(const ld_mode *a, const ld_mode *b, int count, differences *most)
{
    for (int i = 0; i < count; i++) {
        most->frequency = fmax(most->frequency, fabs(a[i].frequency / b[i].frequency - 1));
        most->damping = fmax(most->damping, fabs(a[i].damping / b[i].damping - 1));
    }
}

static void the_pose_of_the_base_does_not_count(void **state)
{
    (void)state;
    differences most = {0};
    double least = INFINITY;
    int both = 0;
    ld_mode level[MOST], posed[MOST];
    for (uint64_t tube = 1; tube <= TUBES; tube++) {
        ld_model model;
        uint64_t seed = 1000 * tube;
        draw_round_tube(&seed, &model);
        model.firing[0].at = between(&seed, 0, 20);
        int count = tube_modes(&model, level);
        for (int pose = 0; pose < POSES; pose++) {
            draw_pose(&seed, &model.base);
            assert_int_equal(tube_modes(&model, posed), count);
            compare(posed, level, count, &most);
            for (int i = 0; i < count; i++) {
                least = fmin(least, posed[i].damping);
                both += strstr(posed[i].shape, "vertical") && strstr(posed[i].shape, "lateral");
            }
        }
        reference_model_free(&model);
    }
    CHECK_WITHIN("shapes that move in both planes", both, 0, 0);
    CHECK_BELOW("frequencies, any pose against level, relative", most.frequency, 1e-12);
    CHECK_BELOW("damping, any pose against level, relative", most.damping, 1e-12);
    CHECK_WITHIN("smallest damping ratio of a passive tube", least, 0, 1);
}

// ---- light dampers: the complex eigenvalues say what they do, to the square of the damping ---

static void lighten(ld_tubes *tubes, double light)
{
    tubes->modes.damping *= light;
    for (int k = 0; k < tubes->support_count; k++) {
        tubes->support[k].recoil.damping *= light;
        tubes->support[k].recoil.quadratic_damping *= light; // differences see it: c2 h
        for (int i = 0; i < 3; i++) {
            tubes->support[k].damping[i] *= light;
            tubes->support[k].rotational_damping[i] *= light;
        }
    }
}

static int modes_of_matrix(double *J, int n, ld_mode *modes)
{
    double real[2 * DENSE_MAX_COORDINATES], imaginary[2 * DENSE_MAX_COORDINATES];
    int count = 0;
    assert_int_equal(
        LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, J, n, real, imaginary, NULL, 1, NULL, 1), 0);
    for (int i = 0; i < n; i++)
        if (imaginary[i] > 0) {
            double omega = hypot(real[i], imaginary[i]);
            modes[count++] = (ld_mode){.frequency = omega / TWO_PI, .damping = -real[i] / omega};
        }
    qsort(modes, (size_t)count, sizeof *modes, by_frequency);
    return count;
}

// Rates of the tube's coordinates [place of R in I, turn in R, q] and speeds, the rocket out of it.
static void dense_rates_at(const dense_launch *dense, const dense_conditions *conditions,
                           dense_state at, int unknown, double change, double *out)
{
    int n = 6 + dense->mode_count, k = unknown % n;
    dense_rates rates;
    double *place[] = {at.r, NULL, at.q, at.v, at.w, at.q_dot};
    int part = (unknown < n ? 0 : 3) + (k < 3 ? 0 : k < 6 ? 1 : 2);
    if (part == 1) {
        double axis[3] = {0};
        axis[k - 3] = sin(change / 2);
        m3 turned = m3_mul((m3){{{at.A_R[0][0], at.A_R[0][1], at.A_R[0][2]},
                                 {at.A_R[1][0], at.A_R[1][1], at.A_R[1][2]},
                                 {at.A_R[2][0], at.A_R[2][1], at.A_R[2][2]}}},
                           q_matrix((quat){cos(change / 2), axis[0], axis[1], axis[2]}));
        copy_matrix(at.A_R, turned);
    } else {
        place[part][k < 3 ? k : k < 6 ? k - 3 : k - 6] += change;
    }
    assert_true(dense_launch_rates(dense, &at, conditions, &rates, NULL));
    memcpy(out, at.v, sizeof at.v);
    memcpy(out + 3, at.w, sizeof at.w);
    memcpy(out + 6, at.q_dot, (size_t)dense->mode_count * sizeof *out);
    memcpy(out + n, rates.x_ddot, (size_t)n * sizeof *out);
}

static int dense_modes(const ld_model *model, const flexible_tube *tube, m3 pose, ld_mode *modes)
{
    static double J[4 * DENSE_MAX_COORDINATES * DENSE_MAX_COORDINATES];
    double plus[2 * DENSE_MAX_COORDINATES], minus[2 * DENSE_MAX_COORDINATES];
    dense_launch dense;
    dense_conditions conditions = {
        .mass = 1, .inertia = {1, 1, 1}, .frictionless = true, .breech = -INFINITY};
    dense_state at = {.r_O1 = {1}};
    for (int i = 0; i < LD_MAX_ADAPTORS; i++)
        conditions.passed[i] = true;
    copy_matrix(conditions.base.A, pose);
    copy_matrix(at.A_R, pose);
    copy_matrix(at.A_B, pose);
    dense_launch_create(&dense, model, tube);
    int n = 2 * (6 + dense.mode_count);
    for (int j = 0; j < n; j++) {
        const double step = 1e-6;
        dense_rates_at(&dense, &conditions, at, j, step, plus);
        dense_rates_at(&dense, &conditions, at, j, -step, minus);
        for (int i = 0; i < n; i++)
            J[i + n * j] = (plus[i] - minus[i]) / (2 * step);
    }
    dense_launch_free(&dense);
    return modes_of_matrix(J, n, modes);
}

// The independent equations of the tube, in any pose.
static void complex_eigenvalues_of_a_dense_program_agree(void **state)
{
    (void)state;
    differences most = {0};
    for (uint64_t tube = 1; tube <= 5; tube++) {
        ld_model model;
        ld_mode modes[MOST], expected[MOST];
        uint64_t seed = 1000 * tube;
        draw_round_tube(&seed, &model);
        draw_pose(&seed, &model.base);
        lighten(&model.tubes, 1e-4);
        model.gravity = 0;
        model.tubes.slot.kind = LD_SLOT_NONE;
        ld_simulation *simulation = simulation_of(&model);
        int count = ld_simulation_tube_modes(simulation, modes, MOST);
        const flexible_tube *of = &simulation->launcher.launching.tube.flexible;
        assert_int_equal(dense_modes(&model, of, draw_rotation(&seed), expected), count);
        compare(modes, expected, count, &most);
        ld_simulation_free(simulation);
        reference_model_free(&model);
    }
    CHECK_BELOW("frequencies against dense eigenvalues, relative", most.frequency, 3e-8);
    CHECK_BELOW("damping against dense eigenvalues, relative", most.damping, 5e-7);
}

// -1: without an equilibrium there are none.
static int system_modes(const ld_model *model, ld_mode *modes, ld_mode *poles, int *pole_count)
{
    ld_simulation *simulation = simulation_of(model);
    ld_pole pole[MOST];
    int count, found;
    if (ld_simulation_system_modes(simulation, modes, MOST, &count, pole, MOST, &found, NULL))
        count = -1;
    *pole_count = 0;
    for (int i = 0; i < found; i++)
        if (pole[i].imaginary > 0) {
            double omega = hypot(pole[i].real, pole[i].imaginary);
            poles[(*pole_count)++] =
                (ld_mode){.frequency = omega / TWO_PI, .damping = -pole[i].real / omega};
        }
    qsort(poles, (size_t)*pole_count, sizeof *poles, by_frequency);
    ld_simulation_free(simulation);
    return count;
}

// Rocket and tube together, a rocket as round as the tube in a smooth bore without weight.
static void nor_does_it_with_the_rocket(void **state)
{
    (void)state;
    differences most = {0}, against_poles = {0};
    ld_mode level[MOST], posed[MOST], poles[MOST];
    for (uint64_t tube = 1; tube <= TUBES; tube++) {
        ld_model model;
        uint64_t seed = 1000 * tube;
        draw_round_tube(&seed, &model);
        lighten(&model.tubes, 1e-4);
        model.gravity = 0;
        model.tubes.slot.kind = LD_SLOT_NONE;
        ld_rocket *rocket = &model.rocket;
        rocket->contact = (ld_contact){.law = LD_CONTACT_BILATERAL,
                                       .stiffness = 5e6,
                                       .exponent = 1,
                                       .damping = 1,
                                       .reference_penetration = 1e-3,
                                       .reference_speed = 0.5,
                                       .friction_speed = 0.01};
        rocket->full.inertia[2] = rocket->full.inertia[1];
        rocket->start_at = 0.05 * model.tubes.length;
        rocket->adaptor_count = 2;
        rocket->adaptor[1].at = 0.5 * model.tubes.length;
        for (int i = 0; i < 2; i++)
            rocket->eccentricity[i] = rocket->products[i] = rocket->dynamic_imbalance[i] = 0;
        rocket->lock.radius = 0;
        rocket->aerodynamics.emerged.present = false; // it damps where the base moves
        int pole_count, count = system_modes(&model, level, poles, &pole_count);
        assert_int_equal(pole_count, count);
        compare(level, poles, count, &against_poles);
        for (int pose = 0; pose < POSES; pose++) {
            draw_pose(&seed, &model.base);
            assert_int_equal(system_modes(&model, posed, poles, &pole_count), count);
            compare(posed, level, count, &most);
        }
        reference_model_free(&model);
    }
    CHECK_BELOW("with the rocket: frequencies, any pose, relative", most.frequency, 1e-8);
    CHECK_BELOW("with the rocket: damping, any pose, relative", most.damping, 1e-7);
    CHECK_BELOW("frequencies against complex eigenvalues", against_poles.frequency, 1e-7);
    // rounding: 1.2e-7 to 7.2e-7 over twelve strengths of the dampers, 0.3 % apart
    CHECK_BELOW("damping against complex eigenvalues, relative", against_poles.damping, 1.5e-6);
}

// Random launchers with all their dampers, none negative, and tubes that have none.
static void no_passive_launcher_is_damped_negatively(void **state)
{
    (void)state;
    double least = INFINITY, undamped = 0;
    int found = 0;
    ld_mode modes[MOST], poles[MOST];
    for (uint64_t seed = 1; seed <= TUBES; seed++) {
        ld_model model;
        int unused, count;
        draw_launcher(seed, &model);
        model.tubes.guide.present = false;
        model.rocket.start_at = 0.1;
        count = system_modes(&model, modes, poles, &unused);
        for (int i = 0; i < count; i++)
            least = fmin(least, modes[i].damping);
        found += count > 0;
        lighten(&model.tubes, 0);
        model.rocket.contact.restitution = 1;
        model.rocket.contact.damping = 0;
        model.rocket.aerodynamics.emerged.present = false;
        count = system_modes(&model, modes, poles, &unused);
        for (int i = 0; i < count; i++)
            undamped = fmax(undamped, fabs(modes[i].damping));
        count = tube_modes(&model, modes);
        for (int i = 0; i < count; i++)
            undamped = fmax(undamped, fabs(modes[i].damping));
        reference_model_free(&model);
    }
    CHECK_WITHIN("random launchers that have an equilibrium", found, 12, TUBES);
    CHECK_WITHIN("smallest damping ratio of theirs", least, 0, 1);
    CHECK_BELOW("largest damping ratio without dampers", undamped, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_pose_of_the_base_does_not_count),
        cmocka_unit_test(complex_eigenvalues_of_a_dense_program_agree),
        cmocka_unit_test(nor_does_it_with_the_rocket),
        cmocka_unit_test(no_passive_launcher_is_damped_negatively),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
