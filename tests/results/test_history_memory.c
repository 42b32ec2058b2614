// A history kept in memory against the one that is read from history.h5 of the same run.
#include <string.h>

#include "launchdyn/output.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"
#include "results/history.h"
#include "support/check.h"
#include "support/scratch.h"

static void run_into(const ld_simulation *simulation, const ld_sink *sink, ld_summary *summary)
{
    ld_error error;
    const ld_run_options options = {.sink = sink};
    assert_int_equal(ld_simulation_run(simulation, &options, summary, &error), LD_OK);
}

// By their bits, for NaN is equal to itself here.
static void check_number(double kept, double read)
{
    assert_memory_equal(&kept, &read, sizeof kept);
}

static void check_instants(const history_data *kept, const history_data *read)
{
    check_number(kept->t_ignition, read->t_ignition);
    check_number(kept->t_release, read->t_release);
    check_number(kept->t_front, read->t_front);
    check_number(kept->t_middle, read->t_middle);
    check_number(kept->t_rear, read->t_rear);
    check_number(kept->t_apogee, read->t_apogee);
    check_number(kept->t_impact, read->t_impact);
    assert_int_equal(kept->tube, read->tube);
    assert_int_equal(kept->number, read->number);
    assert_int_equal(kept->openings, read->openings);
    for (int i = 0; i < read->openings; i++) {
        assert_string_equal(kept->opening[i].name, read->opening[i].name);
        check_number(kept->opening[i].t, read->opening[i].t);
    }
}

static void check_table(const history_data *kept, const history_data *read)
{
    assert_int_equal(kept->rows, read->rows);
    assert_int_equal(kept->columns, read->columns);
    for (size_t i = 0; i < read->columns; i++) {
        assert_string_equal(kept->name[i], read->name[i]);
        assert_string_equal(kept->unit[i], read->unit[i]);
    }
    for (size_t i = 0; i < read->columns * read->rows; i++)
        check_number(kept->value[i], read->value[i]);
}

static void check_geometry(const history_data *kept, const history_data *read)
{
    assert_int_equal(kept->arrays, read->arrays);
    for (size_t i = 0; i < read->arrays; i++) {
        const history_array *a = &kept->geometry[i], *b = &read->geometry[i];
        assert_string_equal(a->name, b->name);
        assert_int_equal(a->rows, b->rows);
        assert_int_equal(a->columns, b->columns);
        assert_memory_equal(a->value, b->value, a->rows * a->columns * sizeof *a->value);
    }
}

static void check_history(const history_data *kept, const history_data *read)
{
    assert_string_equal(kept->title, read->title);
    assert_string_equal(kept->stopped, read->stopped);
    assert_int_equal(kept->complete, read->complete);
    check_instants(kept, read);
    check_table(kept, read);
    check_geometry(kept, read);
    assert_int_equal(kept->rockets, read->rockets);
    for (int i = 0; i < read->rockets; i++)
        check_instants(&kept->rocket[i], &read->rocket[i]);
    assert_int_equal(kept->flights, read->flights);
    for (size_t i = 0; i < read->flights; i++) {
        check_instants(&kept->flight[i], &read->flight[i]);
        check_table(&kept->flight[i], &read->flight[i]);
    }
}

// Of an example: rockets that have fired, flights, parachutes that have opened, arrays.
typedef struct counts {
    int rockets, flights, openings;
    bool arrays;
} counts;

static void check_example(const char *file, const char *const *sets, size_t count, counts expected)
{
    ld_model *model;
    ld_simulation *simulation;
    ld_output *output;
    ld_messages messages;
    ld_error error;
    history_data kept, read;
    ld_summary *summary = ld_summary_new();
    history_memory *memory = history_memory_new();
    assert_int_equal(ld_scenario_read(file, sets, count, &model, &messages), LD_OK);
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_output_open(in("run"), model, false, &output, &error), LD_OK);
    run_into(simulation, ld_output_sink(output), summary);
    assert_int_equal(ld_output_finish(output, summary, &error), LD_OK);
    run_into(simulation, history_memory_sink(memory), summary);
    assert_int_equal(history_memory_take(memory, summary, &kept, &error), LD_OK);
    history_memory_free(memory);
    assert_int_equal(history_read(in("run/history.h5"), &read, &error), LD_OK);
    check_history(&kept, &read);
    assert_int_equal(read.rockets, expected.rockets);
    assert_int_equal((int)read.flights, expected.flights);
    assert_int_equal(read.flights ? read.flight[0].openings : 0, expected.openings);
    assert_int_equal(read.arrays > 0, expected.arrays);
    printf("    %s: %zu rows of %zu columns, %zu flights, %zu arrays, equal to the bit\n",
           strrchr(file, '/') + 1, read.rows, read.columns, read.flights, read.arrays);
    history_free(&kept);
    history_free(&read);
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    ld_model_free(model);
}

static void test_launch_and_flights(void **state)
{
    static const char *const coarse[] = {"run.output_step=5 ms"};
    static const char *const two[] = {"run.output_step=20 ms",
                                      "firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.3 s}]"};
    (void)state;
    check_example(LD_SOURCE_DIR "/examples/fixed.yaml", coarse, 1, (counts){1, 0, 0, true});
    check_example(LD_SOURCE_DIR "/examples/sequence.yaml", two, 2, (counts){2, 2, 0, true});
}

static void test_flight_alone(void **state)
{
    static const char *const sets[] = {"run.output_step=50 ms"};
    (void)state;
    check_example(LD_SOURCE_DIR "/examples/parachutes.yaml", sets, 1, (counts){1, 1, 2, false});
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_launch_and_flights),
                                       cmocka_unit_test(test_flight_alone)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
