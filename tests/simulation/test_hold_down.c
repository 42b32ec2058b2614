// The lock's hold_down: under whatever force it opens no sooner, and from then on as without.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "quantities/summary.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

// The instant of ignition.
static double lit_at;

// Thrust that comes, goes again at 0.2 s and comes back from 0.4 s on.
static double release_of(double hold_down, double elevation, double release_force, double *force)
{
    static const double thrust[] = {0, 0, 0.01, 15e3, 0.15, 15e3, 0.2, 0, 0.4, 0, 0.5, 15e3, 2, 0};
    ld_model model;
    recorded_run run;
    reference_model(&model);
    free(model.rocket.motor.thrust.data);
    model.rocket.motor.thrust = reference_table(7, 2, thrust);
    model.base.elevation = elevation;
    model.rocket.lock.hold_down = hold_down;
    model.rocket.lock.release_force = release_force;
    model.firing[0].at = lit_at;
    recorded_run_make(&run, &model);
    double t = run.summary.rocket[0].t_release, last = 0;
    size_t clock = recorded_column(&run, "t"), column = recorded_column(&run, "lock.force");
    for (size_t i = 0; i < run.rows && recorded_value(&run, i, clock) < lit_at + t; i++)
        last = recorded_value(&run, i, column);
    if (force)
        *force = last;
    recorded_run_free(&run);
    model_clear(&model);
    return t;
}

static void test_release(void **state)
{
    (void)state;
    const double up = 0.3456;
    double force, free_of = release_of(0, up, 5000, NULL);
    assert_true(free_of > 0.002 && free_of < 0.01);
    CHECK_NEAR("ends before: as without [s]", release_of(0.002, up, 5000, NULL), free_of, 1e-9);
    CHECK_NEAR("under more than the force: at once [s]", release_of(0.1, up, 5000, &force), 0.1, 0);
    assert_true(force > 14e3);
    // the force is less than that when it ends, and comes there on its way up from 0.4 s
    double later = release_of(0.3, up, 5000, &force);
    assert_true(later > 0.43 && later < 0.44);
    CHECK_NEAR("force there [N]", force, 5000, 150);
}

// Nose down the weight alone opens it at the start, but not while it is held.
static void test_before_ignition(void **state)
{
    (void)state;
    const double down = -0.35;
    assert_true(release_of(0, down, 100, NULL) <= 0);
    CHECK_NEAR("held under the weight [s]", release_of(0.05, down, 100, NULL), 0.05, 0);
}

// It counts from the rocket's own ignition.
static void test_later_ignition(void **state)
{
    (void)state;
    double force;
    lit_at = 0.25;
    double t = release_of(0.1, 0.3456, 5000, &force);
    lit_at = 0;
    CHECK_NEAR("lit at 0.25 s: at once when it ends, from then [s]", t, 0.1, 1e-15);
    assert_true(force > 14e3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_release),
        cmocka_unit_test(test_before_ignition),
        cmocka_unit_test(test_later_ignition),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
