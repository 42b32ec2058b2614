// Values of a model by path: set as by --set, reported as numbers, texts and tables.
#include "model/fields/source.h"
#include "support/check.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "launchdyn/scenario.h"
#include "model/model.h"

#define FIXED LD_SOURCE_DIR "/examples/fixed.yaml"

static ld_model *read_fixed(const char *set)
{
    ld_model *model;
    ld_messages messages;
    assert_int_equal(ld_scenario_read(FIXED, &set, set != NULL, &model, &messages), LD_OK);
    return model;
}

// What the model prints, to be freed.
static char *print(const ld_model *model)
{
    char *text = NULL;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    ld_model_print(model, stream);
    fclose(stream);
    return text;
}

static void check_same(const ld_model *model, const ld_model *expected)
{
    char *text = print(model), *other = print(expected);
    assert_string_equal(text, other);
    free(text);
    free(other);
}

static void set(ld_model *model, const char *path, const char *value)
{
    ld_messages messages;
    if (ld_model_set(model, path, value, &messages))
        ld_messages_print(&messages, stderr);
    assert_int_equal(messages.count, 0);
}

static double number(const ld_model *model, const char *path)
{
    double value;
    ld_error error = {.text = ""};
    assert_int_equal(ld_model_number(model, path, &value, &error), LD_OK);
    return value;
}

static void check_text(const ld_model *model, const char *path, const char *expected)
{
    char text[128];
    ld_error error = {.text = ""};
    assert_int_equal(ld_model_text(model, path, text, sizeof text, &error), LD_OK);
    assert_string_equal(text, expected);
}

static void test_set_is_as_an_override(void **state)
{
    (void)state;
    ld_model *model = read_fixed(NULL), *expected = read_fixed("rocket.mass=61.5 kg");
    set(model, "rocket.mass", "61500 g");
    CHECK_BELOW("mass set in grams [kg]", number(model, "rocket.mass") - 61.5, 0);
    set(model, "rocket.mass", "61.5 kg");
    check_same(model, expected);
    // what follows from a key follows: the thrust table's end gives the time that counts as stuck
    set(model, "rocket.motor.thrust", "[[0 s, 10 kN], [3 s, 10 kN]]");
    CHECK_BELOW("stuck time [s]", number(model, "run.stuck_time") - 4, 0);
    ld_model_free(expected);
    ld_model_free(model);
}

// Refuses and leaves the model as it was.
static void check_refused(ld_model *model, const char *path, const char *value, const char *text)
{
    ld_messages messages;
    char *before = print(model);
    assert_int_equal(ld_model_set(model, path, value, &messages), LD_ERR_INPUT);
    char *after = print(model);
    assert_string_equal(after, before);
    printf("%s: %s\n", messages.item[0].path, messages.item[0].text);
    assert_non_null(strstr(messages.item[0].text, text));
    ld_messages_free(&messages);
    free(before);
    free(after);
}

static void test_wrong_values_are_refused(void **state)
{
    (void)state;
    ld_model *model = read_fixed(NULL);
    check_refused(model, "rocket.mas", "61 kg", "did you mean \"mass\"?");
    check_refused(model, "rocket.mass", "61", "without a unit");
    check_refused(model, "rocket.mass", "61 m", "wrong dimension");
    check_refused(model, "rocket.mass", "-1 kg", "> 0 kg");
    check_refused(model, "rocket.adaptors.raer.at", "1 m", "no entry \"raer\"");
    ld_model_free(model);
}

// The first message of overrides laid over a model: its source and place.
static void check_place(const ld_model *model, const char *const *sets, size_t count,
                        const char *file, int line, const char *source)
{
    ld_messages messages;
    ld_model *none;
    assert_int_equal(ld_model_derive(model, sets, count, &none, &messages), LD_ERR_INPUT);
    assert_string_equal(messages.item[0].file, file);
    assert_int_equal(messages.item[0].line, line);
    assert_string_equal(messages.item[0].source, source);
    ld_messages_free(&messages);
}

// Overrides are numbered as they were given at once; of those before, the text says which it is.
static void test_messages_number_what_was_set_at_once(void **state)
{
    (void)state;
    ld_model *model = read_fixed("tubes.length=5 m");
    const char *wrong[] = {"rocket.mass=64 kg", "rocket.mass=65 kg", "rocket.mas=61 kg"};
    set(model, "rocket.mass", "62 kg");
    set(model, "rocket.mass", "63 kg");
    check_place(model, wrong + 2, 1, "--set", 1, "rocket.mas=61 kg");
    check_place(model, wrong, 3, "--set", 3, "rocket.mas=61 kg");
    // what follows makes an earlier one wrong: a speed, of a base that stands now
    const char *prescribed[] = {"base.kind=prescribed", "base.velocity=3 0 0 m/s"};
    ld_messages messages;
    assert_int_equal(ld_model_set_all(model, prescribed, 2, &messages), LD_OK);
    const char *fixed = "base.kind=fixed";
    check_place(model, &fixed, 1, "set before", 1, "base.velocity=3 0 0 m/s");
    ld_model_free(model);
}

static void test_several_at_once(void **state)
{
    (void)state;
    ld_messages messages;
    ld_model *model = read_fixed(NULL);
    // a prescribed base without a motion, and a motion without such a base
    const char *both[] = {"base.kind=prescribed", "base.velocity=3 0 0 m/s"};
    assert_int_equal(ld_model_set(model, "base.velocity", "3 0 0 m/s", &messages), LD_ERR_INPUT);
    ld_messages_free(&messages);
    assert_int_equal(ld_model_set_all(model, both, 2, &messages), LD_OK);
    check_text(model, "base.velocity", "3 0 0 m/s");
    ld_model_free(model);
}

static void test_a_derived_model_leaves_the_first_one(void **state)
{
    (void)state;
    ld_messages messages;
    ld_model *model = read_fixed("rocket.mass=61 kg"), *derived, *same, *none;
    const char *sets[] = {"rocket.mass=62 kg", "tubes.length=2.9 m"}, *wrong = "rocket.mas=1 kg";
    assert_int_equal(ld_model_derive(model, sets, 2, &derived, &messages), LD_OK);
    assert_int_equal(ld_model_derive(model, NULL, 0, &same, &messages), LD_OK);
    check_same(same, model);
    CHECK_BELOW("the first one's mass [kg]", number(model, "rocket.mass") - 61, 0);
    ld_model_free(model);
    CHECK_BELOW("the derived one's mass [kg]", number(derived, "rocket.mass") - 62, 0);
    CHECK_BELOW("and length of tube [m]", number(derived, "tubes.length") - 2.9, 0);
    assert_int_equal(ld_model_derive(same, &wrong, 1, &none, &messages), LD_ERR_INPUT);
    assert_null(none);
    char name[16];
    assert_string_equal(ld_suggested_name(messages.item[0].text, name, sizeof name), "mass");
    ld_messages_free(&messages);
    ld_model_free(same);
    ld_model_free(derived);
}

static void test_a_key_set_often_is_kept_once(void **state)
{
    (void)state;
    ld_model *model = read_fixed("tubes.length=5 m");
    char value[32];
    for (int i = 0; i < 20; i++) {
        snprintf(value, sizeof value, "%d kg", 60 + i);
        set(model, "rocket.mass", value);
        set(model, "rocket.lock.release_force", "9 kN");
    }
    const char *twice[] = {"rocket.mass=78 kg", "rocket.mass=79 kg"};
    ld_messages messages;
    for (int i = 0; i < 3; i++)
        assert_int_equal(ld_model_set_all(model, twice, 2, &messages), LD_OK);
    CHECK_NEAR("overrides kept", (double)model->source->set_count, 4, 0);
    CHECK_BELOW("the last mass [kg]", number(model, "rocket.mass") - 79, 0);
    CHECK_BELOW("another override stays [m]", number(model, "tubes.length") - 5, 0);
    ld_model_free(model);
}

static void test_values_are_told(void **state)
{
    (void)state;
    ld_model *model = read_fixed(NULL);
    const double *table;
    size_t rows, columns;
    ld_error error;
    char text[64];
    double value;
    check_text(model, "base.kind", "fixed");
    check_text(model, "rocket.adaptors.1.name", "rear");
    CHECK_BELOW("second adaptor by name and number [m]",
                number(model, "rocket.adaptors.2.at") - number(model, "rocket.adaptors.middle.at"),
                0);
    assert_int_equal(ld_model_table(model, "rocket.motor.thrust", &table, &rows, &columns, &error),
                     LD_OK);
    assert_ptr_equal(table, model->rocket.motor.thrust.data);
    CHECK_BELOW("columns of the thrust table", (double)columns - 2, 0);
    assert_true(rows > 1);

    assert_int_equal(ld_model_text(model, "rocket", text, sizeof text, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "rocket does not fit on one line");
    assert_int_equal(ld_model_text(model, "rocket.motor.thrust", text, sizeof text, &error),
                     LD_ERR_INPUT);
    assert_int_equal(ld_model_text(model, "rocket.mas", text, sizeof text, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "did you mean \"mass\"?"));
    assert_int_equal(ld_model_number(model, "rocket.center", &value, &error), LD_ERR_INPUT);
    assert_true(isnan(value));
    assert_int_equal(ld_model_table(model, "rocket.mass", &table, &rows, &columns, &error),
                     LD_ERR_INPUT);
    assert_null(table);
    ld_model_free(model);
}

// A dot needs a key behind it; in an override too.
static void test_a_dot_at_the_end_is_no_path(void **state)
{
    (void)state;
    ld_model *model = read_fixed(NULL);
    static const char *const paths[] = {
        "rocket.mass.", "rocket.center.y.",         "rocket.center.",
        "base.kind.",   "rocket.adaptors.rear.at.", "rocket.motor."};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        char text[64];
        double value;
        ld_error error;
        assert_int_equal(ld_model_number(model, paths[i], &value, &error), LD_ERR_INPUT);
        printf("%s %s\n", paths[i], error.text);
        assert_int_equal(ld_model_text(model, paths[i], text, sizeof text, &error), LD_ERR_INPUT);
        printf("%s %s\n", paths[i], error.text);
        check_refused(model, paths[i], "1", "expected a path of keys joined by dots");
    }
    ld_model_free(model);
}

// What a walk over all keys finds.
typedef struct key_walk {
    ld_model *model;
    const char *printed;
    int keys, set, vectors;
} key_walk;

// A key's text, set again, leaves the model as it is.
static void set_again(void *self, const ld_key *key)
{
    key_walk *walk = self;
    char text[512];
    walk->keys++;
    assert_true(key->path[0] && key->description[0] && key->expected[0]);
    // a single output step counts for all three, one of the three leaves the others to the default
    if (strstr(key->path, ".N") || strncmp(key->path, "run.output_step.", 16) == 0 ||
        ld_model_text(walk->model, key->path, text, sizeof text, NULL) || !text[0])
        return;
    double value;
    if (ld_model_number(walk->model, key->path, &value, NULL) == LD_OK && !isnan(value))
        assert_true(value >= key->low && value <= key->high);
    set(walk->model, key->path, text);
    char *printed = print(walk->model);
    if (strcmp(printed, walk->printed) != 0)
        fail_msg("%s: set again to %s the model is another:\n%s", key->path, text, printed);
    free(printed);
    walk->set++;
}

static void test_every_text_can_be_set_again(void **state)
{
    (void)state;
    ld_model *model = read_fixed(NULL);
    char *printed = print(model);
    key_walk walk = {.model = model, .printed = printed};
    ld_scenario_keys(set_again, &walk);
    printf("%d keys, %d with a text in this scenario\n", walk.keys, walk.set);
    assert_true(walk.keys > 200 && walk.set > 40);
    free(printed);
    ld_model_free(model);
}

static void test_a_model_of_overrides_alone(void **state)
{
    (void)state;
    ld_model *model;
    ld_messages messages;
    assert_int_equal(ld_model_new(NULL, 0, &model, &messages), LD_ERR_INPUT);
    assert_null(model);
    assert_true(messages.count > 0);
    ld_messages_free(&messages);
    const char *flight[] = {"rocket.mass=10 kg", "rocket.inertia=1 1 1 kg.m2",
                            "flight={position: 0 1 0 km, velocity: 100 0 0 m/s}"};
    if (ld_model_new(flight, 3, &model, &messages))
        ld_messages_print(&messages, stdout);
    assert_int_equal(messages.count, 0);
    CHECK_BELOW("mass of the body [kg]", number(model, "rocket.mass") - 10, 0);
    assert_false(ld_model_has_launcher(model));
    ld_model_free(model);
}

// A fault of the calling program ends it with a name, not by a bad access.
static void expect_assertion(void (*call)(void), const char *named)
{
    char text[512] = "";
    int ends[2], status;
    assert_int_equal(pipe(ends), 0);
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        signal(SIGABRT, SIG_DFL);
        dup2(ends[1], STDERR_FILENO);
        call();
        _exit(0);
    }
    close(ends[1]);
    for (ssize_t more, used = 0;
         (more = read(ends[0], text + used, sizeof text - 1 - (size_t)used)) > 0; used += more)
        ;
    close(ends[0]);
    waitpid(child, &status, 0);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT);
    assert_non_null(strstr(text, named));
}

static void read_nothing(void)
{
    ld_model *model;
    ld_messages messages;
    ld_scenario_read(NULL, NULL, 0, &model, &messages);
}

static void ask_no_model(void)
{
    double value;
    ld_model_number(NULL, "rocket.mass", &value, NULL);
}

static void test_null(void **state)
{
    (void)state;
    expect_assertion(read_nothing, "path && model && messages");
    expect_assertion(ask_no_model, "model && path && value");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_set_is_as_an_override),
        cmocka_unit_test(test_wrong_values_are_refused),
        cmocka_unit_test(test_messages_number_what_was_set_at_once),
        cmocka_unit_test(test_several_at_once),
        cmocka_unit_test(test_a_derived_model_leaves_the_first_one),
        cmocka_unit_test(test_a_key_set_often_is_kept_once),
        cmocka_unit_test(test_values_are_told),
        cmocka_unit_test(test_a_dot_at_the_end_is_no_path),
        cmocka_unit_test(test_every_text_can_be_set_again),
        cmocka_unit_test(test_a_model_of_overrides_alone),
        cmocka_unit_test(test_null),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
