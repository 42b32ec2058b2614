// Motion in time: published trajectories of a pendulum and a heavy top, conservation in a free
// tree.
// ctest: slow
#include "launchdyn/mstmm.h"

#include <string.h>

#include "support/check.h"
#include "support/draw.h"

static ld_mstmm *create(const ld_mstmm_element *elements, int count, const double gravity[3])
{
    ld_mstmm *system = NULL;
    ld_error error = {0};
    if (ld_mstmm_create(elements, count, gravity, &system, &error))
        fail_msg("%s", error.text);
    return system;
}

static void integrate(ld_mstmm *system, double tolerance, double t_0, double t_1, double *q,
                      double *u)
{
    ld_error error = {0};
    ld_mstmm_settings settings = {.rtol = tolerance, .atol = tolerance};
    if (ld_mstmm_integrate(system, &settings, t_0, t_1, q, u, NULL, &error))
        fail_msg("%s", error.text);
}

// Point mass 1 kg on a massless rod of 1 m, from the horizontal at rest (multibody benchmark
// library of IFToMM: simple pendulum).
static void test_pendulum(void **state)
{
    (void)state;
    const ld_mstmm_element bob = {.name = "bob",
                                  .hinge = LD_HINGE_REVOLUTE,
                                  .axis = {0, 0, 1},
                                  .mass = 1,
                                  .center = {-1, 0, 0}};
    const double gravity[3] = {0, -9.81, 0}, at[3] = {-1, 0, 0};
    const double expected[3][3] = {{1, 0.986291751, -0.165010853},
                                   {5, -0.942305435, -0.334754338},
                                   {10, -0.275087463, -0.961419205}};
    ld_mstmm *system = create(&bob, 1, gravity);
    double q = 0, u = 0, t = 0, worst = 0;
    for (int i = 0; i < 3; i++) {
        integrate(system, 1e-13, t, expected[i][0], &q, &u);
        t = expected[i][0];
        ld_mstmm_point p = ld_mstmm_locate(system, &q, &u, 0, at);
        worst = fmax(worst, fabs(p.position[0] - expected[i][1]));
        worst = fmax(worst, fabs(p.position[1] - expected[i][2]));
    }
    CHECK_BELOW("pendulum at 1, 5 and 10 s [m] (nine digits given)", worst, 5.5e-10);
    ld_mstmm_free(system);
}

// Heavy top: spherical hinge, quaternion at 0.2 s.
static void test_heavy_top(void **state)
{
    (void)state;
    const ld_mstmm_element top = {.name = "top",
                                  .hinge = LD_HINGE_SPHERICAL,
                                  .mass = 15,
                                  .center = {0, 1, 0},
                                  .inertia = {0.234375, 0.46875, 0.234375}};
    const double gravity[3] = {0, 0, -9.81};
    const double expected[4] = {-0.70827915, 0.43878109, 0.54572840, 0.08939975};
    ld_mstmm *system = create(&top, 1, gravity);
    double q[4] = {1, 0, 0, 0}, u[3] = {0, 150, -4.61538}, plus = 0, minus = 0;
    integrate(system, 1e-12, 0, 0.2, q, u);
    double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) {
        plus = fmax(plus, fabs(q[i] / n - expected[i]));
        minus = fmax(minus, fabs(q[i] / n + expected[i]));
    }
    CHECK_BELOW("heavy top's quaternion at 0.2 s (eight digits given)", fmin(plus, minus), 6e-9);
    ld_mstmm_free(system);
}

// 24 bodies on hinges of all kinds, the root free, no gravity: energy and both momenta stay.
static void test_free_tree_conserves(void **state)
{
    (void)state;
    enum { N = 24 };
    static const ld_hinge kinds[] = {LD_HINGE_REVOLUTE,   LD_HINGE_SPHERICAL, LD_HINGE_UNIVERSAL,
                                     LD_HINGE_REVOLUTE,   LD_HINGE_PRISMATIC, LD_HINGE_WELD,
                                     LD_HINGE_CYLINDRICAL};
    static char name[N][8];
    ld_mstmm_element element[N];
    const double gravity[3] = {0, 0, 0};
    uint64_t seed = 7;
    memset(element, 0, sizeof element);
    for (int i = 0; i < N; i++) {
        ld_mstmm_element *e = &element[i];
        snprintf(name[i], sizeof name[i], "b%d", i);
        e->name = name[i];
        e->parent = i ? name[(i - 1) / 2] : NULL;
        e->hinge = i ? kinds[i % 7] : LD_HINGE_FREE;
        v3_store(e->at, draw_v3(&seed, 0.5));
        v3_store(e->axis, draw_v3(&seed, 1));
        v3_store(e->axis_2, draw_v3(&seed, 1));
        v3_store(e->center, draw_v3(&seed, 0.2));
        e->mass = 2 + draw(&seed);
        m3 J = draw_inertia(&seed, e->mass);
        double six[6] = {J.a[0][0], J.a[1][1], J.a[2][2], J.a[0][1], J.a[0][2], J.a[1][2]};
        memcpy(e->inertia, six, sizeof six);
        // slides stay near by springs; their energy is in the balance
        if (e->hinge == LD_HINGE_PRISMATIC || e->hinge == LD_HINGE_CYLINDRICAL)
            e->stiffness[0] = 200;
    }
    ld_mstmm *system = create(element, N, gravity);
    double q[200], u[100], p_0[3], l_0[3], p_1[3], l_1[3], p_off = 0, l_off = 0, p = 0, l = 0;
    ld_mstmm_reference(system, q);
    for (int i = 0; i < ld_mstmm_speed_count(system); i++)
        u[i] = 0.3 * draw(&seed);
    ld_mstmm_energies before = ld_mstmm_energy(system, q, u);
    ld_mstmm_momentum(system, q, u, p_0, l_0);
    integrate(system, 3e-13, 0, 100, q, u);
    ld_mstmm_energies after = ld_mstmm_energy(system, q, u);
    ld_mstmm_momentum(system, q, u, p_1, l_1);
    for (int i = 0; i < 3; i++) {
        p = fmax(p, fabs(p_0[i]));
        l = fmax(l, fabs(l_0[i]));
        p_off = fmax(p_off, fabs(p_1[i] - p_0[i]));
        l_off = fmax(l_off, fabs(l_1[i] - l_0[i]));
    }
    double drift = (after.kinetic + after.elastic) / (before.kinetic + before.elastic) - 1;
    CHECK_BELOW("free tree of 24 bodies, 100 s: energy, relative", drift, 1e-10);
    CHECK_BELOW("free tree: linear momentum, relative", p_off / p, 1e-10);
    CHECK_BELOW("free tree: angular momentum, relative", l_off / l, 1e-10);
    ld_mstmm_free(system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pendulum),
        cmocka_unit_test(test_heavy_top),
        cmocka_unit_test(test_free_tree_conserves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
