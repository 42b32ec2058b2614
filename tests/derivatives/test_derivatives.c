// Derivatives against closed forms, against differences of order 6 of launches that choose their
// own steps, on a fixed base and on the march; that strikes are told.
#include "support/check.h"

#include "integration/step_course.h"
#include "launchdyn/derivatives.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"

static ld_model *read_example(const char *file, const char *const *sets, size_t count)
{
    char path[256];
    ld_messages messages = {0};
    ld_model *model;
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, file);
    if (ld_scenario_read(path, sets, count, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail_msg("%s", file);
    }
    return model;
}

static ld_derivatives *find(const ld_model *model, const ld_derivative_key *keys, size_t count,
                            int threads)
{
    const ld_derivative_options options = {.threads = threads};
    ld_derivatives *found;
    ld_error error;
    if (ld_derivatives_find(model, keys, count, &options, &found, &error))
        fail_msg("%s", error.text);
    return found;
}

static ld_derivative get(const ld_derivatives *of, const char *result, size_t key)
{
    ld_derivative value;
    ld_error error;
    if (ld_derivatives_get(of, result, key, &value, &error))
        fail_msg("%s", error.text);
    return value;
}

// ---- closed forms

// Without weight and slot: the mass m(t) = m - (m - 40 kg) t / t_b burns off, F / m(t) accelerates
// it along s = length - start, after which the rear adaptor leaves.
static void ideal_exit(double m, double s, double *t, double *v)
{
    const double F = 15e3, b = (m - 40) / 2.5;
    *t = sqrt(2 * m * s / F);
    for (int i = 0; i < 20; i++) {
        double left = m - b * *t;
        double x = F / b * (*t + left / b * log(left / m));
        *v = F / b * log(m / left);
        *t -= (x - s) / *v;
    }
}

// Of these, d/dm by differences of order 4 with steps of a gram; the rest as they stand.
static void closed_forms(void **state)
{
    (void)state;
    const double m = 60, s = 2.9, h = 1e-3, a = 15e3;
    const char *const sets[] = {"environment.gravity=0 m/s2",
                                "rocket.contact.friction=0",
                                "tubes.slot=none",
                                "rocket.lock.release_force=1 mN",
                                "rocket.motor.thrust=[[0 s, 15 kN], [2.5 s, 15 kN]]",
                                "run.tolerance=1e-8"};
    const ld_derivative_key keys[] = {
        {"rocket.mass", NULL}, {"rocket.start_at", NULL}, {"tubes.length", "1 um"}};
    ld_model *model = read_example("fixed.yaml", sets, sizeof sets / sizeof *sets);
    ld_derivatives *of = find(model, keys, 3, 2);
    double t[4], v[4], t_0, v_0;
    ideal_exit(m, s, &t_0, &v_0);
    for (int i = 0; i < 4; i++)
        ideal_exit(m + (i < 2 ? i - 2 : i - 1) * h, s, &t[i], &v[i]);
    double t_m = (8 * (t[2] - t[1]) - (t[3] - t[0])) / (12 * h);
    double v_m = (8 * (v[2] - v[1]) - (v[3] - v[0])) / (12 * h);
    double left = m - (m - 40) / 2.5 * t_0;
    CHECK_NEAR("speed [m/s]", get(of, "exit_speed", 0).value, v_0, 1e-10);
    CHECK_NEAR("instant by mass [s/kg]", get(of, "t_rear", 0).derivative, t_m, 1e-11);
    CHECK_NEAR("speed by mass [m/s/kg]", get(of, "exit_speed", 0).derivative, v_m, 1e-8);
    CHECK_NEAR("instant by start [s/m]", get(of, "t_rear", 1).derivative, -1 / v_0, 1e-11);
    CHECK_NEAR("speed by start [1/s]", get(of, "exit_speed", 1).derivative, -a / left / v_0, 1e-8);
    CHECK_NEAR("speed by length [1/s]", get(of, "exit_speed", 2).derivative, a / left / v_0, 3e-8);
    ld_derivatives_free(of);
    ld_model_free(model);
}

// ---- launches that choose their own steps

enum { RESULTS = 2, MOST_SETS = 8 };

typedef struct case_of_key {
    const char *file;
    const char *sets[MOST_SETS];
    const char *tolerance, *reference; // of the derivatives, of the differences
    const char *key, *unit;
    double value, step; // of the key; those of the differences, of the value
    const char *result[RESULTS];
    double bound[RESULTS]; // of the derivative
} case_of_key;

static ld_model *read_case(const case_of_key *of, const char *tolerance, const char *key)
{
    const char *sets[MOST_SETS + 2];
    char set[64];
    size_t count = 0;
    for (; count < MOST_SETS && of->sets[count]; count++)
        sets[count] = of->sets[count];
    snprintf(set, sizeof set, "run.tolerance=%s", tolerance);
    sets[count++] = set;
    if (key)
        sets[count++] = key;
    return read_example(of->file, sets, count);
}

static void results_at(const case_of_key *of, double value, double result[RESULTS])
{
    char set[128], name[64];
    ld_summary *summary = ld_summary_new();
    ld_simulation *simulation;
    ld_error error;
    snprintf(set, sizeof set, "%s=%.17g %s", of->key, value, of->unit);
    ld_model *model = read_case(of, of->reference, set);
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, summary, &error))
        fail_msg("%s", error.text);
    for (int i = 0; i < RESULTS && of->result[i]; i++) {
        snprintf(name, sizeof name, "rocket.1.%s", of->result[i]);
        if (ld_summary_number(summary, name, &result[i], &error))
            fail_msg("%s", error.text);
    }
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    ld_model_free(model);
}

// Of order 6, with longer steps than those of the derivatives and more digits of tolerance.
static void differences(const case_of_key *of, double found[RESULTS])
{
    static const double weight[] = {45, -9, 1};
    double h = of->step * of->value, left[RESULTS] = {0}, right[RESULTS] = {0};
    memset(found, 0, RESULTS * sizeof *found);
    for (int k = 0; k < 3; k++) {
        results_at(of, of->value - (k + 1) * h, left);
        results_at(of, of->value + (k + 1) * h, right);
        for (int i = 0; i < RESULTS; i++)
            found[i] += weight[k] * (right[i] - left[i]) / (60 * h);
    }
}

// The shapes of the tube's elements meet with a jump of curvature, and adaptors touch and leave the
// wall: steps end there. Without strikes, then with them, then at the usual tolerance, also on a
// rail.
static void differences_of_order_6(void **state)
{
    (void)state;
    static const char bilateral[] = "rocket.contact={law: bilateral, stiffness: 5e7 N/m, "
                                    "friction: 0.12, friction_speed: 10 mm/s}";
#define HELD                                                                                       \
    {                                                                                              \
        bilateral, "rocket.adaptors.rear.clearance=0 mm", "rocket.adaptors.middle.clearance=0 mm", \
            "rocket.adaptors.front.clearance=0 mm"                                                 \
    }
    static const case_of_key cases[] = {{"smooth.yaml",
                                         HELD,
                                         "1e-8",
                                         "1e-12",
                                         "rocket.mass",
                                         "kg",
                                         60,
                                         5e-3,
                                         {"exit_speed", "pitch_rate"},
                                         {1e-8, 1e-6}},
                                        {"smooth.yaml",
                                         HELD,
                                         "1e-8",
                                         "1e-12",
                                         "tubes.tail.mass",
                                         "kg",
                                         8,
                                         2e-2,
                                         {"pitch_rate", "t_release"},
                                         {2e-6, 1e-7}},
                                        {"fixed.yaml",
                                         {NULL},
                                         "1e-8",
                                         "1e-12",
                                         "rocket.mass",
                                         "kg",
                                         60,
                                         3e-5,
                                         {"exit_speed", "pitch_rate"},
                                         {2e-7, 3e-6}},
                                        {"fixed.yaml",
                                         {NULL},
                                         "1e-5",
                                         "1e-12",
                                         "rocket.adaptors.middle.clearance",
                                         "m",
                                         5e-4,
                                         1e-4,
                                         {"exit_speed", "pitch_rate"},
                                         {6e-3, 3e-3}},
                                        {"rail/deck.yaml",
                                         {NULL},
                                         "1e-5",
                                         "1e-9",
                                         "rocket.motor.thrust_scale",
                                         "",
                                         1,
                                         1e-3,
                                         {"exit_speed", "pitch_rate"},
                                         {1e-4, 3e-4}}};
#undef HELD
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const case_of_key *one = &cases[i];
        ld_model *model = read_case(one, one->tolerance, NULL);
        const ld_derivative_key key = {one->key, NULL};
        ld_derivatives *of = find(model, &key, 1, 1);
        double expected[RESULTS];
        differences(one, expected);
        for (int j = 0; j < RESULTS; j++) {
            ld_derivative found = get(of, one->result[j], 0);
            printf("  %s: %s by %s: %.12g\n", one->file, one->result[j], one->key, expected[j]);
            CHECK_BELOW("apart, of the derivative", found.derivative / expected[j] - 1,
                        one->bound[j]);
            assert_true(found.same_events);
        }
        ld_derivatives_free(of);
        ld_model_free(model);
    }
}

// On the march the lead-in's long steps are taken again, too: changes a hundred times apart agree.
static void on_the_march(void **state)
{
    (void)state;
    static const char *const sets[] = {"run.lead_in=2 s"};
    static const ld_derivative_key wide = {"rocket.mass", "6 g"}, near = {"rocket.mass", "0.06 g"};
    ld_model *model = read_example("marching/30-kmh.yaml", sets, 1);
    ld_derivatives *of = find(model, &wide, 1, 2), *again = find(model, &near, 1, 2);
    ld_derivative a = get(of, "pitch_rate", 0), b = get(again, "pitch_rate", 0);
    assert_true(a.same_events && b.same_events);
    printf("  pitch rate by mass %.9g, %.9g (rad/s)/kg\n", a.derivative, b.derivative);
    CHECK_BELOW("changes a hundred times apart", a.derivative / b.derivative - 1, 6e-6);
    ld_derivatives_free(of);
    ld_derivatives_free(again);
    ld_model_free(model);
}

// ---- what is told and refused

// Stretches that a run does not reach, or has besides, make it another's.
static void stretches_are_counted(void **state)
{
    (void)state;
    step_course of = {0};
    for (int i = 0; i < 6; i++)
        step_course_add(&of, &(course_step){.begins = i % 3 == 0, .size = i + 1});
    for (int reached = 1; reached <= 3; reached++) {
        step_course along = step_course_of(&of);
        double sum = 0;
        for (int i = 0; i < reached; i++) {
            const course_step *first = step_course_next(&along, true, false);
            const course_step *next = first ? step_course_next(&along, false, false) : NULL;
            sum += next ? first->size + next->size : 0;
        }
        assert_true(sum == (reached == 1 ? 3 : 12));
        assert_int_equal(step_course_differs(&along), reached != 2);
    }
    step_course_free(&of);
}

// So wide a step that touches come and go, under a law that locates them.
static void other_events_are_told(void **state)
{
    (void)state;
    static const char *const sets[] = {"rocket.contact.law=lankarani-nikravesh"};
    static const ld_derivative_key keys[] = {{"rocket.adaptors.rear.clearance", "0.29 mm"},
                                             {"rocket.adaptors.rear.clearance", "1 nm"}};
    ld_model *model = read_example("fixed.yaml", sets, 1);
    for (int i = 0; i < 2; i++) {
        ld_derivatives *of = find(model, &keys[i], 1, 1);
        assert_int_equal(get(of, "pitch_rate", 0).same_events, i == 1);
        ld_derivatives_free(of);
    }
    ld_model_free(model);
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    static const ld_derivative_key keys[] = {
        {"rocket.mass", NULL}, {"base.elevation", NULL}, {"tubes.tail.mass", NULL}};
    ld_model *model = read_example("fixed.yaml", NULL, 0);
    ld_derivatives *one = find(model, keys, 3, 1), *five = find(model, keys, 3, 5);
    for (size_t key = 0; key < 3; key++) {
        ld_derivative a = get(one, "yaw_rate", key), b = get(five, "yaw_rate", key);
        assert_true(a.derivative == b.derivative && a.left == b.left && a.right == b.right);
    }
    ld_derivatives_free(one);
    ld_derivatives_free(five);
    ld_model_free(model);
}

static void count_launches(void *user, int launches, int of)
{
    int *counted = user;
    assert_int_equal(of, 5);
    *counted = launches;
}

static bool fewer_than_three(void *user)
{
    return *(int *)user < 3;
}

static void interruption_says_after_what(void **state)
{
    (void)state;
    int counted = 0;
    const ld_derivative_options options = {
        .self = &counted, .progress = count_launches, .go_on = fewer_than_three};
    static const ld_derivative_key keys[] = {{"rocket.mass", NULL}, {"base.elevation", NULL}};
    ld_model *model = read_example("fixed.yaml", NULL, 0);
    ld_derivatives *of;
    ld_error error;
    assert_int_equal(ld_derivatives_find(model, keys, 2, &options, &of, &error),
                     LD_ERR_INTERRUPTED);
    assert_string_equal(error.text, "interrupted after 3 of 5 launches");
    ld_model_free(model);
}

static void refusals(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        ld_derivative_key key;
        const char *text, *set;
    } cases[] = {
        {"fixed.yaml", {"rocket.mas", NULL}, "mass", NULL},
        {"fixed.yaml", {"tubes.modes.bending", NULL}, "a whole number has no derivatives", NULL},
        {"fixed.yaml", {"base.azimuth", NULL}, "base.azimuth is 0: expected the step", NULL},
        {"fixed.yaml", {"rocket.mass", "1 m"}, "rocket.mass: step: ", NULL},
        {"fixed.yaml", {"rocket.mass", "-1 g"}, "expected a step > 0", NULL},
        {"fixed.yaml",
         {"rocket.contact.restitution", "0.6"},
         "leaves its range, from 0 to 1",
         NULL},
        {"salvo.yaml", {"rocket.mass", NULL}, "derivatives are of single launches", NULL},
        {"marching/15-kmh.yaml",
         {"rocket.mass", NULL},
         "run.coupling: ",
         "run.coupling={step: 1 ms}"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ld_model *model = read_example(cases[i].file, &cases[i].set, cases[i].set != NULL);
        ld_derivatives *of;
        ld_error error;
        assert_int_equal(ld_derivatives_find(model, &cases[i].key, 1, NULL, &of, &error),
                         LD_ERR_INPUT);
        printf("  %s\n", error.text);
        assert_null(of);
        assert_non_null(strstr(error.text, cases[i].text));
        ld_model_free(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(closed_forms),
                                       cmocka_unit_test(differences_of_order_6),
                                       cmocka_unit_test(stretches_are_counted),
                                       cmocka_unit_test(on_the_march),
                                       cmocka_unit_test(other_events_are_told),
                                       cmocka_unit_test(threads_change_no_bit),
                                       cmocka_unit_test(interruption_says_after_what),
                                       cmocka_unit_test(refusals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
