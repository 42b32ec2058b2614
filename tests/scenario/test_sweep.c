// Sweeps: each point is the scenario with its values laid over it, as by overrides.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "scenario/scenario.h"
#include "support/model_compare.h"

static ld_status read_point(const char *text, const char *const *sets, size_t count, int point,
                            ld_model *model, ld_messages *messages)
{
    return scenario_read_text_point(text, strlen(text), "text", LD_SOURCE_DIR "/examples", sets,
                                    count, point, model, messages);
}

static ld_model read_good(const char *text, const char *const *sets, size_t count, int point)
{
    ld_model model;
    ld_messages messages;
    ld_status status = read_point(text, sets, count, point, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    return model;
}

static char *print_model(const ld_model *model)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ld_model_print(model, stream);
    fclose(stream);
    return text;
}

// Whether the models are the same but for their sweeps, which `a` and `b` lose.
static bool same_but_sweep(ld_model *a, ld_model *b)
{
    ld_model left = *a, right = *b;
    left.sweep_count = right.sweep_count = 0;
    left.sweep = right.sweep = NULL;
    return same_model(&left, &right);
}

#define PLAIN                                                                                      \
    "include: marching/stationary.yaml\n"                                                          \
    "firing: {order: [1, 2, 3], interval: 1 s}\n"
static const char plain[] = PLAIN;
static const char swept[] = PLAIN "sweep:\n"
                                  "  base.speed: [0 km/h, 15 km/h, \"30 km/h\"]\n"
                                  "  firing.order: [[1, 2, 3], [8]]\n"
                                  "  rocket.lock: [none, {release_force: 6 kN}]\n"
                                  "  rocket.adaptors.1.clearance: [0.2 mm, 0.25 mm]\n";
enum { AXES = 4, POINTS = 24 };
static const char *const values[AXES][3] = {{"0 km/h", "15 km/h", "30 km/h"},
                                            {"[1, 2, 3]", "[8]"},
                                            {"none", "{release_force: 6 kN}"},
                                            {"0.2 mm", "0.25 mm"}};
static const char *const paths[AXES] = {"base.speed", "firing.order", "rocket.lock",
                                        "rocket.adaptors.rear.clearance"};

static void test_axes(void **state)
{
    (void)state;
    ld_model model = read_good(swept, NULL, 0, 0);
    assert_int_equal(ld_scenario_points(&model), POINTS);
    assert_int_equal(model.sweep_count, AXES);
    for (int i = 0; i < AXES; i++) {
        assert_string_equal(model.sweep[i].path, paths[i]);
        for (int k = 0; k < model.sweep[i].count; k++)
            assert_string_equal(model.sweep[i].value[k], values[i][k]);
    }
    // the first axis varies most slowly
    for (int point = 1; point <= POINTS; point++) {
        int number = 0;
        for (int i = 0; i < AXES; i++)
            number = number * model.sweep[i].count + ld_scenario_value(&model, point, i);
        assert_int_equal(number, point - 1);
    }
    model_clear(&model);
}

// Each point against the plain scenario with overrides, and against the printed sweep's.
static void test_points(void **state)
{
    (void)state;
    ld_model nominal = read_good(swept, NULL, 0, 0), alone = read_good(plain, NULL, 0, 0);
    assert_true(same_but_sweep(&nominal, &alone));
    char *printed = print_model(&nominal);
    for (int point = 1; point <= POINTS; point++) {
        char text[AXES][64];
        const char *sets[AXES];
        for (int i = 0; i < AXES; i++) {
            snprintf(text[i], sizeof text[i], "%s=%s", paths[i],
                     values[i][ld_scenario_value(&nominal, point, i)]);
            sets[i] = text[i];
        }
        ld_model one = read_good(swept, NULL, 0, point), again = read_good(printed, NULL, 0, point);
        ld_model other = read_good(plain, sets, AXES, 0);
        assert_true(same_model(&one, &again));
        assert_true(same_but_sweep(&one, &other));
        assert_int_equal(one.firing_count, ld_scenario_value(&nominal, point, 1) ? 1 : 3);
        model_clear(&one);
        model_clear(&again);
        model_clear(&other);
    }
    free(printed);
    model_clear(&nominal);
    model_clear(&alone);
}

// An override takes the axis of its key away, and is laid over the points otherwise.
// Several keys under one name: a point is the scenario with overrides of each; printed and read
// again it is the same; an override of one of them takes all out.
static void test_several_keys(void **state)
{
    (void)state;
    static const char text[] = PLAIN
        "sweep:\n"
        "  gap: {paths: [rocket.adaptors.1.clearance, rocket.adaptors.front.clearance], values: "
        "[0.2 mm, 0.25 mm, 0.3 mm]}\n"
        "  base.speed: [0 km/h, 15 km/h]\n";
    static const char *const sets[] = {"rocket.adaptors.rear.clearance=0.25 mm",
                                       "rocket.adaptors.front.clearance=0.25 mm",
                                       "base.speed=15 km/h"};
    ld_model nominal = read_good(text, NULL, 0, 0), other = read_good(plain, sets, 3, 0);
    char *printed = print_model(&nominal), name[64];
    ld_model one = read_good(text, NULL, 0, 4), again = read_good(printed, NULL, 0, 4);
    assert_int_equal(ld_scenario_points(&nominal), 6);
    assert_string_equal(nominal.sweep[0].path, "gap");
    assert_int_equal(nominal.sweep[0].together.count, 2);
    assert_string_equal(nominal.sweep[0].together.path[0], "rocket.adaptors.rear.clearance");
    assert_true(same_but_sweep(&one, &other));
    assert_true(same_model(&one, &again));
    ld_scenario_point_name(&nominal, 4, name, sizeof name);
    assert_string_equal(name, "gap 0.25 mm, base.speed 15 km/h");
    model_clear(&one);
    one = read_good(text, sets, 1, 0);
    assert_int_equal(ld_scenario_points(&one), 2);
    free(printed);
    model_clear(&nominal);
    model_clear(&other);
    model_clear(&one);
    model_clear(&again);
}

static void test_overrides(void **state)
{
    (void)state;
    static const char *const sets[] = {"base.speed=20 km/h", "rocket.mass=61 kg",
                                       "rocket.adaptors.1.clearance=0.22 mm",
                                       "rocket.lock.release_force=7 kN"};
    ld_model model = read_good(swept, sets, 3, 0);
    assert_int_equal(model.sweep_count, 2);
    assert_int_equal(ld_scenario_points(&model), 4);
    assert_string_equal(model.sweep[0].path, "firing.order");
    model_clear(&model);
    model = read_good(swept, sets, 4, 3);
    CHECK_NEAR("speed [m/s]", model.base.vehicle.speed, 20 / 3.6, 1e-15);
    assert_true(model.rocket.full.mass == 61 && model.rocket.adaptor[0].clearance == 0.22e-3);
    assert_true(model.firing_count == 1 && model.rocket.lock.release_force == 7000);
    model_clear(&model);
    static const char *const without[] = {"sweep="};
    model = read_good(swept, without, 1, 1);
    assert_true(model.sweep_count == 0 && ld_scenario_points(&model) == 1);
    model_clear(&model);
}

// The longest step follows a swept tolerance, unless it is given; also in the printed sweep.
static void test_longest_step(void **state)
{
    (void)state;
    static const char text[] = "include: fixed.yaml\nsweep: {run.tolerance: [1e-6, 1e-3]}\n";
    static const char *const given[] = {"run.max_step=0.2 ms"};
    static const double expected[] = {2e-4, 2e-4, 5.0237728630191603e-4}; // nominal, points
    for (int point = 0; point < 3; point++) {
        ld_model model = read_good(text, NULL, 0, point), other = read_good(text, given, 1, point);
        CHECK_NEAR("longest step [s]", model.run.max_step, expected[point], 1e-18);
        assert_true(other.run.max_step == 2e-4);
        char *printed = print_model(&model);
        if (point > 0)
            assert_non_null(strstr(printed, point == 2 ? "  max_step: 0.0005023772863019"
                                                       : "  max_step: 0.0002 s"));
        else
            for (int i = 1; i < 3; i++) {
                ld_model again = read_good(printed, NULL, 0, i);
                CHECK_NEAR("of the printed sweep [s]", again.run.max_step, expected[i], 1e-18);
                model_clear(&again);
            }
        free(printed);
        model_clear(&model);
        model_clear(&other);
    }
}

static void expect_message(const char *text, int point, const char *path, int line, int column,
                           const char *part)
{
    ld_model model;
    ld_messages messages;
    assert_int_equal(read_point(text, NULL, 0, point, &model, &messages), LD_ERR_INPUT);
    assert_int_equal(messages.count, 1);
    const ld_message *m = &messages.item[0];
    ld_messages_print(&messages, stdout);
    assert_string_equal(m->path, path);
    assert_true(m->line == line && m->column == column && strstr(m->text, part));
    ld_messages_free(&messages);
}

// What only one point has wrong is said at the value in the sweep.
static void test_messages(void **state)
{
    (void)state;
    static const char text[] = "include: marching/stationary.yaml\n"
                               "firing: [{tube: 1}]\n"
                               "sweep:\n"
                               "  firing: [[{tube: 2}], {order: [3, 19], interval: 1 s}]\n"
                               "  tubes.modes.elements: [10, 5]\n";
    ld_model model = read_good(text, NULL, 0, 0);
    assert_int_equal(ld_scenario_points(&model), 4);
    char name[128];
    ld_scenario_point_name(&model, 3, name, sizeof name);
    assert_string_equal(name, "firing {order: [3, 19], interval: 1 s}, tubes.modes.elements 10");
    model_clear(&model);
    model = read_good(text, NULL, 0, 1);
    assert_true(model.tubes.modes.elements == 10 && model.firing[0].tube == 2);
    model_clear(&model);
    expect_message(text, 2, "tubes.modes.bending", 50, 20, "need at least 6 elements, not 5");
    expect_message(text, 3, "firing.order.2", 4, 37, "the layout has tubes 1 to 18");
    expect_message(text, 5, "sweep", 0, 0, "found point 5, expected 1 to 4");
}

// Texts that would mean something else in a list of YAML without their quotes.
static void test_texts(void **state)
{
    (void)state;
    static const char text[] = "include: fixed.yaml\n"
                               "sweep:\n"
                               "  title:\n"
                               "    - a, [b] {c}\n"
                               "    - \"null\"\n"
                               "    - '- ? :'\n"
                               "    - \"\\x01 \\\" \\\\ \\u00e4 \\u0085 \\u2028 \\uFEFF\"\n"
                               "    - \"-\"\n"
                               "    - ~\n"
                               "    - plain text\n";
    ld_model model = read_good(text, NULL, 0, 0);
    char *printed = print_model(&model);
    for (int point = 1; point <= 7; point++) {
        ld_model one = read_good(text, NULL, 0, point), again = read_good(printed, NULL, 0, point);
        printf("    %s\n", model.sweep[0].value[point - 1]);
        assert_true(same_model(&one, &again));
        assert_true((point == 6) == (one.title == NULL));
        model_clear(&one);
        model_clear(&again);
    }
    assert_string_equal(model.sweep[0].value[6], "plain text");
    free(printed);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_axes),         cmocka_unit_test(test_points),
        cmocka_unit_test(test_several_keys), cmocka_unit_test(test_longest_step),
        cmocka_unit_test(test_overrides),    cmocka_unit_test(test_messages),
        cmocka_unit_test(test_texts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
