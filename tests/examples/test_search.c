// The search of examples/c against minima in closed form.
// link: example_search
#include "support/check.h"

#include "../../examples/c/search.h"

// Quadratic functions of two variables, x + y bounded; what is asked for is counted.
typedef struct quadratic {
    double x, y, sum; // where it is least, the greatest x + y
    int asked, fails_at;
} quadratic;

static int evaluate(void *data, const double *x, double *value, double *constraint)
{
    quadratic *self = data;
    double dx = x[0] - self->x, dy = x[1] - self->y;
    *value = dx * dx + 2 * dy * dy;
    *constraint = x[0] + x[1] - self->sum;
    return ++self->asked == self->fails_at ? 7 : 0;
}

static int seek(quadratic *of, int evaluations, double *x)
{
    static const double low[] = {-3, -3}, high[] = {3, 3};
    const search sought = {.variables = 2,
                           .constraints = 1,
                           .low = low,
                           .high = high,
                           .evaluations = evaluations,
                           .precision = 1e-9,
                           .self = of,
                           .evaluate = evaluate};
    of->asked = 0;
    return search_minimum(&sought, x);
}

static void inside(void **state)
{
    (void)state;
    double x[2] = {2, -1};
    quadratic of = {.x = 0.5, .y = -0.7, .sum = 1};
    assert_int_equal(seek(&of, 500, x), 0);
    CHECK_BELOW("x", x[0] - 0.5, 1e-6);
    CHECK_BELOW("y", x[1] + 0.7, 1e-6);
}

// Of x + y <= 2 by Lagrange: x = 1/3, y = 5/3; it holds where it ends, not nearly.
static void at_a_constraint(void **state)
{
    (void)state;
    double x[2] = {-1, -1};
    quadratic of = {.x = 1, .y = 2, .sum = 2};
    assert_int_equal(seek(&of, 500, x), 0);
    CHECK_BELOW("x", x[0] - 1.0 / 3, 1e-6);
    CHECK_BELOW("y", x[1] - 5.0 / 3, 1e-6);
    assert_true(x[0] + x[1] <= 2);
}

static void at_a_bound(void **state)
{
    (void)state;
    double x[2] = {0, 0};
    quadratic of = {.x = 5, .y = -1, .sum = 9};
    assert_int_equal(seek(&of, 500, x), 0);
    CHECK_BELOW("x", x[0] - 3, 1e-6);
    CHECK_BELOW("y", x[1] + 1, 1e-6);
}

// From where no constraint holds to where it does; where none can, to what breaks it least.
static void from_outside(void **state)
{
    (void)state;
    double x[2] = {2.5, 2.5};
    quadratic of = {.x = 1, .y = 2, .sum = 2};
    assert_int_equal(seek(&of, 500, x), 0);
    CHECK_BELOW("x", x[0] - 1.0 / 3, 1e-6);
    of.sum = -7;
    assert_int_equal(seek(&of, 500, x), 0);
    CHECK_BELOW("nowhere: x + y", x[0] + x[1] + 6, 1e-6);
}

static void it_ends_when_told(void **state)
{
    (void)state;
    double x[2] = {2, -1};
    quadratic of = {.x = 0.5, .y = -0.7, .sum = 1};
    assert_int_equal(seek(&of, 12, x), 0);
    assert_in_range(of.asked, 1, 12);
    of.fails_at = 5;
    assert_int_equal(seek(&of, 500, x), 7);
    assert_int_equal(of.asked, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inside),
        cmocka_unit_test(at_a_constraint),
        cmocka_unit_test(at_a_bound),
        cmocka_unit_test(from_outside),
        cmocka_unit_test(it_ends_when_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
