// Values that are allowed but implausible, and their exact warnings: the cases are in warnings.txt.
// The project's own scenarios have none.
#include "model/model.h"
#include "support/check.h"

#include <glob.h>
#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include "model/warnings/plausible.h"
#include "scenario/scenario.h"

enum { MAX_SETS = 24, MAX_TEXT = 8192, MAX_RULES = 256 };

typedef struct note_case {
    const char *title, *base;
    const char *fires[MAX_SETS], *silent[MAX_SETS];
    size_t fire_count, silent_count;
    char expected[MAX_TEXT];
} note_case;

// The lines of a case up to the next title, which is returned; NULL at the end.
static char *take_case(note_case *c, char *title)
{
    char *line;
    *c = (note_case){.title = title + 3, .base = "base.yaml"};
    while ((line = strtok(NULL, "\n")) && strncmp(line, "## ", 3) != 0) {
        if (line[0] == '<') {
            c->base = line + 2;
        } else if (line[0] == '$') {
            c->fires[c->fire_count++] = line + 2;
        } else if (line[0] == '~') {
            c->silent[c->silent_count++] = line + 2;
        } else if (line[0] == '>') {
            strcat(c->expected, line + 2);
            strcat(c->expected, "\n");
        }
    }
    return line;
}

// Rules that have had a warning.
static const plausible_rule *fired[MAX_RULES];
static int fired_count;

static void remember(void *self, const plausible_note *note)
{
    (void)self;
    for (int i = 0; i < fired_count; i++)
        if (fired[i] == note->rule)
            return;
    fired[fired_count++] = note->rule;
}

// What gives a warning of the points of a scenario, as printed.
static char *notes_of(const char *file, const char *const *sets, size_t count, bool points)
{
    ld_model model;
    ld_messages messages;
    char *printed = NULL;
    size_t length = 0;
    ld_status status = scenario_read(file, sets, count, &model, &messages);
    ld_messages_print(&messages, stdout);
    if (status)
        fail_msg("%s is not read", file);
    plausible_check(&model, remember, NULL);
    int last = points ? ld_scenario_points(&model) : 0;
    assert_int_equal(ld_scenario_notes(model.source, 0, last, &messages), LD_OK);
    FILE *stream = open_memstream(&printed, &length);
    ld_notes_print(&messages, stream);
    fclose(stream);
    ld_messages_free(&messages);
    model_clear(&model);
    return printed;
}

static char *read_cases(void)
{
    FILE *stream = fopen("notes.txt", "rb");
    char *text = calloc(1, 1 << 18);
    assert_non_null(stream);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 18) - 1, stream) > 0);
    fclose(stream);
    return text;
}

// Whether a case prints what it says, and its neighbour nothing.
static bool is_as_said(const note_case *c)
{
    char *printed = notes_of(c->base, c->fires, c->fire_count, false);
    char *silence = notes_of(c->base, c->silent, c->silent_count, false);
    bool good = strcmp(printed, c->expected) == 0 && silence[0] == '\0' && c->silent_count > 0;
    if (!good)
        printf("%s: expected\n%sprinted\n%sof its neighbour\n%s", c->title, c->expected, printed,
               silence);
    free(printed);
    free(silence);
    return good;
}

static int count_rules(void)
{
    static const plausible_rule *const tables[] = {
        plausible_of_tube,       plausible_of_base,      plausible_of_rocket, plausible_of_vehicle,
        plausible_of_stabiliser, plausible_of_mechanism, plausible_of_run};
    int count = 0;
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
        for (const plausible_rule *rule = tables[i]; rule->path; rule++)
            count++;
    return count;
}

// Every case prints what warnings.txt says, its neighbour nothing; every rule has its case.
static void test_notes_are_exact(void **state)
{
    (void)state;
    static note_case c;
    int count = 0, wrong = 0;
    assert_int_equal(chdir(LD_SOURCE_DIR "/tests/faults"), 0);
    char *cases = read_cases(), *line = strtok(cases, "\n");
    fired_count = 0;
    while (line && strncmp(line, "## ", 3) != 0)
        line = strtok(NULL, "\n");
    for (; line; count++) {
        line = take_case(&c, line);
        wrong += !is_as_said(&c);
    }
    free(cases);
    CHECK_BELOW("values hardly meant with another note, or neighbours with one", wrong, 0);
    CHECK_WITHIN("values hardly meant", count, 100, 1000);
    CHECK_WITHIN("rules of plausibility", count_rules(), 100, MAX_RULES - 1);
    CHECK_BELOW("rules without a case", count_rules() - fired_count, 0);
}

// The project's own scenarios, at all points of their sweeps, have no warnings.
static void test_own_scenarios_are_silent(void **state)
{
    (void)state;
    static const char *const patterns[] = {"examples/*.yaml",
                                           "examples/marching/*.yaml",
                                           "examples/stabilisers/*.yaml",
                                           "examples/rail/*.yaml",
                                           "examples/student-rocket/student-rocket.yaml",
                                           "tests/data/nesc/*.yaml",
                                           "examples/multibody/*.yaml",
                                           "tests/faults/base.yaml",
                                           "tests/faults/vehicle.yaml",
                                           "tests/faults/multibody.yaml",
                                           "tests/data/multibody/launcher.yaml"};
    glob_t found = {0};
    int noted = 0;
    assert_int_equal(chdir(LD_SOURCE_DIR), 0);
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++)
        assert_int_equal(glob(patterns[i], i > 0 ? GLOB_APPEND : 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++) {
        char *printed = notes_of(found.gl_pathv[i], NULL, 0, true);
        noted += printed[0] != '\0';
        printf("%s", printed);
        free(printed);
    }
    CHECK_WITHIN("scenarios of the project", found.gl_pathc, 24, 100);
    CHECK_BELOW("of them with notes", noted, 0);
    globfree(&found);
}

// Of a sweep each point is checked, and what is the same at several gives a warning once, in the
// sweep.
static void test_points_of_a_sweep(void **state)
{
    (void)state;
    const char *sets[] = {"sweep={rocket.mass: [60 kg, 61 kg], tubes.slot.radius: [80 mm, 8 mm]}",
                          "tubes.slot.friction=2"};
    assert_int_equal(chdir(LD_SOURCE_DIR "/tests/faults"), 0);
    char *nominal = notes_of("base.yaml", sets, 2, false);
    char *points = notes_of("base.yaml", sets, 2, true);
    assert_null(strstr(nominal, "radius"));
    assert_non_null(strstr(nominal, "--set:2:21: warning: tubes.slot.friction"));
    const char *radius = strstr(points, "tubes.slot.radius: found \"8 mm\"");
    assert_non_null(radius);
    assert_null(strstr(radius + 1, "tubes.slot.radius: found"));
    const char *friction = strstr(points, "tubes.slot.friction: found");
    assert_non_null(friction);
    assert_null(strstr(friction + 1, "tubes.slot.friction: found"));
    free(nominal);
    free(points);
}

// A place in an included file, and in a table that a file holds.
static void test_places(void **state)
{
    (void)state;
    static const char text[] = "include: base.yaml\nrocket:\n  adaptors:\n"
                               "    front: {clearance: 40 mm}\n  motor: {thrust: [[0 s, 15 kN], "
                               "[2.5 s, 15 kN]]}\n";
    ld_model model;
    ld_messages messages;
    assert_int_equal(chdir(LD_SOURCE_DIR "/tests/faults"), 0);
    assert_int_equal(
        scenario_read_text(text, strlen(text), "case.yaml", "", NULL, 0, &model, &messages), LD_OK);
    assert_int_equal(ld_scenario_notes(model.source, 0, 0, &messages), LD_OK);
    assert_int_equal(messages.count, 2);
    const ld_message *first = &messages.item[0], *second = &messages.item[1];
    assert_string_equal(first->file, "case.yaml");
    assert_string_equal(first->path, "rocket.adaptors.front.clearance");
    assert_int_equal(first->line, 4);
    assert_int_equal(first->column, 24);
    assert_string_equal(second->path, "rocket.motor.thrust.2");
    assert_int_equal(second->line, 5);
    assert_int_equal(second->column, 34);
    ld_messages_free(&messages);
    assert_int_equal(ld_scenario_notes(model.source, 2, 2, &messages), LD_ERR_INPUT);
    assert_int_equal(messages.count, 1);
    ld_messages_free(&messages);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_own_scenarios_are_silent),
        cmocka_unit_test(test_notes_are_exact),
        cmocka_unit_test(test_points_of_a_sweep),
        cmocka_unit_test(test_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
