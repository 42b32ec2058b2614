// Broken scenarios and their exact messages: the cases are in cases.txt and starts.txt.
#include "support/check.h"
#include "support/expected_launch.h"

#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include "launchdyn/run.h"
#include "launchdyn/simulation.h"
#include "scenario/scenario.h"

enum { MAX_TEXT = 8192, MAX_SETS = 8 };

typedef struct fault_case {
    char title[256], base[64];
    char find[MAX_TEXT], replace[MAX_TEXT], whole[MAX_TEXT], expected[MAX_TEXT];
    char set[MAX_SETS][4096];
    int sets, wholes;
} fault_case;

static char *read_file(const char *name)
{
    FILE *stream = fopen(name, "rb");
    assert_non_null(stream);
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    size_t length = fread(text, 1, (1 << 20) - 1, stream);
    assert_true(length > 0);
    fclose(stream);
    return text;
}

// Adds a line, without the mark and the blank before it, to a text.
static void add_line(char *text, const char *line, const char *between)
{
    const char *content = line[1] == ' ' ? line + 2 : line + 1;
    strcat(text, between);
    strcat(text, content);
}

// Reads one case from the lines after its title; returns the next title's line or NULL.
static char *take_case(fault_case *c, char *line)
{
    memset(c, 0, sizeof *c);
    snprintf(c->title, sizeof c->title, "%s", line + 3);
    snprintf(c->base, sizeof c->base, "base.yaml");
    bool finds = false, replaces = false;
    while ((line = strtok(NULL, "\n")) && strncmp(line, "## ", 3) != 0) {
        if (line[0] == '<') {
            snprintf(c->base, sizeof c->base, "%s", line + 2);
        } else if (line[0] == '-') {
            add_line(c->find, line, finds ? "\n" : "");
            finds = true;
        } else if (line[0] == '+') {
            add_line(c->replace, line, replaces ? "\n" : "");
            replaces = true;
        } else if (line[0] == '=') {
            add_line(c->whole, line, c->wholes++ ? "\n" : "");
        } else if (line[0] == '$') {
            add_line(c->set[c->sets++], line, "");
        } else if (line[0] == '>') {
            add_line(c->expected, line, "");
            strcat(c->expected, "\n");
        }
    }
    return line;
}

// The scenario of a case; the text to replace must stand in the base exactly once.
static char *scenario_text(const fault_case *c)
{
    char *base = read_file(c->base), *text = calloc(1, strlen(base) + 2 * MAX_TEXT);
    assert_non_null(text);
    const char *place = c->find[0] ? strstr(base, c->find) : base + strlen(base);
    if (!place || (c->find[0] && strstr(place + 1, c->find)))
        fail_msg("%s: the text to replace is not there exactly once", c->title);
    if (c->wholes > 0)
        strcpy(text, c->whole);
    else
        sprintf(text, "%.*s%s%s", (int)(place - base), base, c->replace, place + strlen(c->find));
    free(base);
    return text;
}

// What keeps a run of a good scenario from its first step, as a message.
static ld_status start(const ld_model *model, ld_messages *messages)
{
    ld_simulation *simulation = NULL;
    ld_run *run = NULL;
    ld_error error;
    ld_status status = ld_simulation_create(model, &simulation, &error);
    if (!status)
        status = ld_run_begin(simulation, NULL, &run, &error);
    ld_run_end(run, NULL, NULL);
    ld_simulation_free(simulation);
    if (status && !ld_scenario_explain(model, &error, messages))
        fail_msg("no place: %s", error.text);
    return status;
}

// What is printed about a case.
static char *messages_of(const fault_case *c, const char *text)
{
    const char *sets[MAX_SETS];
    ld_model model;
    ld_messages messages;
    char *printed = NULL;
    size_t length = 0;
    for (int i = 0; i < c->sets; i++)
        sets[i] = c->set[i];
    ld_status status = scenario_read_text(text, strlen(text), "case.yaml", "", sets,
                                          (size_t)c->sets, &model, &messages);
    if (!status) {
        status = start(&model, &messages);
        model_clear(&model);
    }
    if (!status)
        fail_msg("%s: nothing is wrong", c->title);
    FILE *stream = open_memstream(&printed, &length);
    ld_messages_print(&messages, stream);
    fclose(stream);
    ld_messages_free(&messages);
    return printed;
}

static void write_case(FILE *record, const fault_case *c, const char *printed)
{
    fprintf(record, "## %s\n", c->title);
    for (const char *line = printed; *line; line = strchr(line, '\n') + 1)
        fprintf(record, "> %.*s", (int)(strchr(line, '\n') + 1 - line), line);
}

// Every case of the file prints what it says, a # there standing for a number; what was printed is
// recorded in the build folder.
static void check_cases(const char *file, int least)
{
    assert_int_equal(chdir(LD_SOURCE_DIR "/tests/faults"), 0);
    static fault_case c;
    char *cases = read_file(file), name[256];
    snprintf(name, sizeof name, "%s/faults-%s", LD_BINARY_DIR, file);
    FILE *record = fopen(name, "w");
    assert_non_null(record);
    int count = 0, wrong = 0;
    char *line = strtok(cases, "\n");
    while (line && strncmp(line, "## ", 3) != 0)
        line = strtok(NULL, "\n");
    while (line) {
        line = take_case(&c, line);
        char *text = scenario_text(&c), *printed = messages_of(&c, text);
        write_case(record, &c, printed);
        if (!matches(printed, c.expected)) {
            printf("%s: expected\n%sprinted\n%s", c.title, c.expected, printed);
            wrong++;
        }
        count++;
        free(text);
        free(printed);
    }
    fclose(record);
    free(cases);
    CHECK_BELOW("broken scenarios with another message", wrong, 0);
    CHECK_WITHIN("broken scenarios", count, least, 1000);
}

static void test_messages_are_exact(void **state)
{
    (void)state;
    check_cases("cases.txt", 150);
}

// What only the start of a run shows.
static void test_starts_are_exact(void **state)
{
    (void)state;
    check_cases("starts.txt", 15);
}

// The scenarios that the cases change are good.
static void test_bases_are_good(void **state)
{
    (void)state;
    const char *const bases[] = {LD_SOURCE_DIR "/tests/faults/base.yaml",
                                 LD_SOURCE_DIR "/tests/faults/vehicle.yaml"};
    for (int i = 0; i < 2; i++) {
        ld_model model;
        ld_messages messages;
        ld_status status = scenario_read(bases[i], NULL, 0, &model, &messages);
        ld_messages_print(&messages, stdout);
        assert_int_equal(status, LD_OK);
        model_clear(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bases_are_good),
        cmocka_unit_test(test_messages_are_exact),
        cmocka_unit_test(test_starts_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
