// Random trees with all kinds of hinges: the reduced sweep against the dense equations of
// support/dense_tree.h, which no kinematics of the library enters.
#include "launchdyn/mstmm.h"

#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/dense_tree.h"

enum { TREES = 1000 };

static moving unit[SPEEDS][BODIES];
static real M[SPEEDS][SPEEDS];

// Largest differences over a number of random trees.
typedef struct differences {
    double conditioned, plain;     // of the accelerations, over the condition and as they are
    double back, back_conditioned; // of the forces that inverse dynamics gives back
    double condition;              // the largest one
    int largest;                   // speeds of the largest tree
} differences;

static differences compare_trees(int kinds, uint64_t seed)
{
    static specimen s;
    int hinges[KINDS] = {0};
    differences all = {0};
    for (int tree = 0; tree < TREES; tree++) {
        ld_mstmm *system;
        ld_error error = {0};
        real h[SPEEDS], expected[SPEEDS];
        double u_dot[SPEEDS], tau[SPEEDS], size = 0, off = 0, force = 0, back = 0;
        tree_draw(&s, kinds, &seed);
        for (int i = 0; i < s.count; i++)
            hinges[s.element[i].hinge]++;
        if (ld_mstmm_create(s.element, s.count, s.gravity, &system, &error))
            fail_msg("%s", error.text);
        assert_int_equal(ld_mstmm_coordinate_count(system), s.q_count);
        assert_int_equal(ld_mstmm_speed_count(system), s.u_count);
        if (ld_mstmm_accelerations(system, s.q, s.u, s.tau, s.wrench, u_dot, &error))
            fail_msg("%s", error.text);
        ld_mstmm_forces(system, s.q, s.u, u_dot, s.wrench, tau);
        tree_assemble(&s, unit, M, h);
        double condition =
            s.u_count ? (double)tree_solve(s.u_count, SPEEDS, &M[0][0], h, expected) : 1;
        for (int k = 0; k < s.u_count; k++) {
            size = fmax(size, fabs((double)expected[k]));
            off = fmax(off, fabs((double)(u_dot[k] - expected[k])));
            force = fmax(force, fabs(s.tau[k]));
            back = fmax(back, fabs(tau[k] - s.tau[k]));
        }
        ld_mstmm_free(system);
        if (!s.u_count)
            continue;
        all.largest = s.u_count > all.largest ? s.u_count : all.largest;
        all.conditioned = fmax(all.conditioned, off / size / condition);
        all.plain = fmax(all.plain, off / size);
        all.back = fmax(all.back, back / force);
        all.back_conditioned = fmax(all.back_conditioned, back / force / condition);
        all.condition = fmax(all.condition, condition);
    }
    for (int i = 0; i < kinds; i++)
        assert_true(hinges[i] > 300);
    printf("    %d trees, up to %d speeds, condition up to %.1e\n", TREES, all.largest,
           all.condition);
    return all;
}

static void test_reduced_sweep_is_the_dense_solve(void **state)
{
    (void)state;
    differences seven = compare_trees(7, 2026);
    CHECK_BELOW("accelerations, relative, over the condition", seven.conditioned, 6e-15);
    CHECK_BELOW("accelerations, relative", seven.plain, 2e-13);
    CHECK_BELOW("inverse(forward) gives the forces back, relative", seven.back, 1e-12);
    differences all = compare_trees(KINDS, 2027);
    CHECK_BELOW("planar hinges too: accelerations, over the condition", all.conditioned, 6e-15);
    CHECK_BELOW("planar hinges too: forces, over the condition", all.back_conditioned, 6e-15);
}

// Some hinges prescribed: with their accelerations given the others' are those of the dense
// equations' free rows, and the forces found are what the prescribed rows need.
static void test_prescribed_hinges(void **state)
{
    (void)state;
    static specimen s;
    static real reduced[SPEEDS][SPEEDS];
    uint64_t seed = 77;
    double worst = 0, worst_force = 0;
    int given_kinds[KINDS] = {0};
    for (int tree = 0; tree < TREES / 4; tree++) {
        ld_mstmm *system, *copy;
        real h[SPEEDS], b[SPEEDS], x[SPEEDS], expected[SPEEDS];
        double u_dot[SPEEDS], again[SPEEDS], tau[SPEEDS], size = 0, off = 0, force = 0, missed = 0;
        int open[SPEEDS], count = 0;
        tree_draw(&s, KINDS, &seed);
        for (int i = 0; i < s.count; i++) {
            s.element[i].prescribed = tree_pick(3, &seed) == 0;
            given_kinds[s.element[i].hinge] += s.element[i].prescribed;
            for (int k = 0; k < tree_speeds[s.element[i].hinge] && !s.element[i].prescribed; k++)
                open[count++] = s.u_at[i] + k;
        }
        assert_int_equal(ld_mstmm_create(s.element, s.count, s.gravity, &system, NULL), LD_OK);
        assert_int_equal(ld_mstmm_copy(system, &copy, NULL), LD_OK);
        assert_int_equal(ld_mstmm_accelerations(system, s.q, s.u, s.tau, s.wrench, u_dot, NULL),
                         LD_OK);
        ld_mstmm_free(system);
        assert_int_equal(ld_mstmm_accelerations(copy, s.q, s.u, s.tau, s.wrench, again, NULL),
                         LD_OK);
        assert_memory_equal(u_dot, again, (size_t)s.u_count * sizeof *u_dot);
        ld_mstmm_forces(copy, s.q, s.u, u_dot, s.wrench, tau);
        ld_mstmm_free(copy);

        // h holds tau: what stands there for the prescribed rows is an acceleration
        tree_assemble(&s, unit, M, h);
        for (int k = 0; k < s.u_count; k++)
            expected[k] = s.tau[k];
        for (int k = 0; k < count; k++)
            expected[open[k]] = 0;
        for (int k = 0; k < count; k++) {
            b[k] = h[open[k]];
            for (int l = 0; l < s.u_count; l++)
                b[k] -= M[open[k]][l] * expected[l];
            for (int l = 0; l < count; l++)
                reduced[k][l] = M[open[k]][open[l]];
        }
        real condition = count ? tree_solve(count, SPEEDS, &reduced[0][0], b, x) : 1;
        for (int k = 0; k < count; k++)
            expected[open[k]] = x[k];
        for (int k = 0; k < s.u_count; k++) {
            real need = s.tau[k] - h[k];
            for (int l = 0; l < s.u_count; l++)
                need += M[k][l] * expected[l];
            size = fmax(size, fabs((double)expected[k]));
            off = fmax(off, fabs((double)(u_dot[k] - expected[k])));
            force = fmax(force, fabs((double)need));
            missed = fmax(missed, fabs((double)(tau[k] - need)));
        }
        if (s.u_count) {
            worst = fmax(worst, off / size / (double)condition);
            worst_force = fmax(worst_force, missed / force / (double)condition);
        }
    }
    for (int i = 0; i < KINDS; i++)
        assert_true(given_kinds[i] > 20);
    CHECK_BELOW("prescribed hinges: accelerations, over the condition", worst, 6e-15);
    CHECK_BELOW("prescribed hinges: forces, over the condition", worst_force, 6e-15);
}

// Accelerations of points against the second derivatives of their positions, reactions against
// Newton's law of what hangs on a hinge.
static void test_points_and_reactions(void **state)
{
    (void)state;
    static specimen s;
    static moving now[BODIES];
    uint64_t seed = 5;
    double worst = 0, worst_force = 0;
    for (int tree = 0; tree < TREES / 4; tree++) {
        ld_mstmm *system;
        const double none[SPEEDS] = {0};
        double reaction[6 * BODIES], carried[BODIES][3] = {{0}}, size = 1e-9, at[3];
        tree_draw(&s, KINDS, &seed);
        tree_fill(at, 3, 1, &seed);
        assert_int_equal(ld_mstmm_create(s.element, s.count, s.gravity, &system, NULL), LD_OK);
        // with u_dot = 0 the speeds are constant: the path of tree_trace()
        tree_trace(&s, s.u, now);
        ld_mstmm_reactions(system, s.q, s.u, none, s.wrench, reaction);
        for (int i = s.count - 1; i >= 0; i--) {
            double linear[3], angular[3];
            real w[3], alpha[3];
            jet3 point = jet3_add(now[i].origin, jet33_apply(now[i].R, jet3_constant(at)));
            tree_rates(&now[i].R, w, alpha);
            ld_mstmm_point_acceleration(system, s.q, s.u, none, i, at, linear, angular);
            for (int a = 0; a < 3; a++) {
                worst = fmax(worst, fabs(linear[a] - (double)(2 * point.a[a].c[2])));
                worst = fmax(worst, fabs(angular[a] - (double)alpha[a]));
                carried[i][a] +=
                    s.element[i].mass * ((double)(2 * now[i].center.a[a].c[2]) - s.gravity[a]) -
                    s.wrench[6 * i + a];
                size = fmax(size, fabs(carried[i][a]));
                worst_force = fmax(worst_force, fabs(reaction[6 * i + a] - carried[i][a]) / size);
                if (s.parent[i] >= 0)
                    carried[s.parent[i]][a] += carried[i][a];
            }
        }
        ld_mstmm_free(system);
    }
    CHECK_BELOW("accelerations of points [m/s2, rad/s2]", worst, 1e-12);
    CHECK_BELOW("forces in the hinges, relative", worst_force, 1e-13);
}

// Places of all at once are those of one at a time; an evaluation after them has the same bits.
static void test_places(void **state)
{
    (void)state;
    static specimen s;
    uint64_t seed = 8;
    for (int tree = 0; tree < 20; tree++) {
        ld_mstmm *system;
        ld_mstmm_point all[BODIES];
        const double origin[3] = {0, 0, 0};
        double u_dot[SPEEDS] = {0}, again[SPEEDS] = {0};
        tree_draw(&s, KINDS, &seed);
        assert_int_equal(ld_mstmm_create(s.element, s.count, s.gravity, &system, NULL), LD_OK);
        ld_mstmm_accelerations(system, s.q, s.u, s.tau, s.wrench, u_dot, NULL);
        ld_mstmm_places(system, s.q, s.u, all);
        for (int pass = 0; pass < 3; pass++) {
            // at once, a second time, after something else
            memset(again, 0, sizeof again);
            if (pass == 2)
                ld_mstmm_locate(system, s.q, s.tau, 0, origin);
            ld_mstmm_accelerations(system, NULL, NULL, s.tau, s.wrench, again, NULL);
            assert_memory_equal(u_dot, again, sizeof u_dot);
        }
        for (int i = 0; i < s.count; i++) {
            ld_mstmm_point one = ld_mstmm_locate(system, s.q, s.u, i, origin);
            assert_memory_equal(&one, &all[i], sizeof one);
        }
        ld_mstmm_free(system);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reduced_sweep_is_the_dense_solve),
        cmocka_unit_test(test_prescribed_hinges),
        cmocka_unit_test(test_points_and_reactions),
        cmocka_unit_test(test_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
