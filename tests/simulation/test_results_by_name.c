// What a program gets of a run: numbers of its summary by name, rows column by column.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "launchdyn/history.h"
#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"
#include "quantities/summary.h"

static ld_model *read_example(const char *name, const char *const *sets, size_t count)
{
    char path[512];
    ld_model *model;
    ld_messages messages;
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, name);
    if (ld_scenario_read(path, sets, count, &model, &messages))
        ld_messages_print(&messages, stderr);
    assert_int_equal(messages.count, 0);
    return model;
}

static ld_status run(const ld_model *model, const ld_sink *sink, ld_summary *summary,
                     ld_error *error)
{
    ld_simulation *simulation;
    assert_int_equal(ld_simulation_create(model, &simulation, error), LD_OK);
    ld_status status =
        ld_simulation_run(simulation, &(ld_run_options){.sink = sink}, summary, error);
    ld_simulation_free(simulation);
    return status;
}

static double number(const ld_summary *summary, const char *name)
{
    double value;
    ld_error error = {.text = ""};
    if (ld_summary_number(summary, name, &value, &error))
        fail_msg("%s", error.text);
    return value;
}

// Every number that is handed out is found under its name, no name twice.
typedef struct name_book {
    const ld_summary *summary;
    int count;
    char name[512][128];
} name_book;

static void look_up(void *self, const ld_quantity *quantity)
{
    name_book *book = self;
    double found = number(book->summary, quantity->name);
    assert_memory_equal(&found, &quantity->value, sizeof found);
    assert_true(quantity->unit && quantity->description[0]);
    for (int i = 0; i < book->count; i++)
        assert_string_not_equal(book->name[i], quantity->name);
    assert_true(book->count < 512);
    snprintf(book->name[book->count++], sizeof *book->name, "%s", quantity->name);
}

static void check_each(const ld_summary *summary)
{
    name_book *book = calloc(1, sizeof *book);
    assert_non_null(book);
    book->summary = summary;
    ld_summary_each(summary, look_up, book);
    CHECK_WITHIN("numbers handed out and found by name", book->count, 150, 512);
    free(book);
}

static void test_numbers_of_a_summary(void **state)
{
    (void)state;
    const char *sets[] = {"firing=[{tube: 1, at: 0 s}, {tube: 2, at: 0.4 s}]"};
    ld_model *model = read_example("fixed.yaml", sets, 1);
    ld_summary *summary = ld_summary_new();
    ld_error error;
    assert_non_null(summary);
    assert_int_equal(run(model, NULL, summary, &error), LD_OK);
    const ld_rocket_summary *second = &summary->rocket[1];
    CHECK_BELOW("rocket.2.t_rear [s]", number(summary, "rocket.2.t_rear") - second->t_rear, 0);
    CHECK_BELOW("rocket.2.relative.gamma [rad]",
                number(summary, "rocket.2.relative.gamma") - second->relative.gamma, 0);
    CHECK_BELOW("rocket.2.max_contact_force.front [N]",
                number(summary, "rocket.2.max_contact_force.front") - second->max_contact_force[2],
                0);
    CHECK_BELOW("energy.residual [J]",
                number(summary, "energy.residual") - summary->energy.residual, 0);
    CHECK_BELOW("statistics.steps",
                number(summary, "statistics.steps") - (double)summary->statistics.steps, 0);
    CHECK_BELOW("mode.3.frequency [Hz]",
                number(summary, "mode.3.frequency") - summary->mode[2].frequency, 0);
    CHECK_WITHIN("rockets fired", ld_summary_rockets(summary), 2, 2);
    assert_true(isnan(number(summary, "rocket.1.apogee"))); // it has not flown
    assert_null(ld_summary_stopped(summary));
    check_each(summary);

    double value;
    assert_int_equal(ld_summary_number(summary, "rocket.2.t_raer", &value, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "there is no result \"rocket.2.t_raer\", did you mean "
                                    "\"rocket.2.t_rear\"?");
    assert_true(isnan(value));
    assert_int_equal(ld_summary_number(summary, "rocket.3.t_rear", &value, &error), LD_ERR_INPUT);
    assert_int_equal(ld_summary_number(summary, "t_rear", &value, &error), LD_ERR_INPUT);
    assert_int_equal(ld_summary_number(summary, "mode.999.frequency", &value, &error),
                     LD_ERR_INPUT);
    ld_summary_free(summary);
    ld_model_free(model);
}

static void test_a_run_that_stops(void **state)
{
    (void)state;
    const char *sets[] = {"rocket.lock.release_force=1 GN", "run.stuck_time=10 ms"};
    ld_model *model = read_example("fixed.yaml", sets, 2);
    ld_summary *summary = ld_summary_new();
    ld_error error;
    double value;
    assert_non_null(summary);
    assert_int_equal(ld_summary_number(summary, "rocket.1.t_rear", &value, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "the summary is empty: nothing has run");
    assert_int_equal(run(model, NULL, summary, &error), LD_ERR_LAUNCH);
    assert_string_equal(ld_summary_stopped(summary), error.text);
    assert_true(isnan(number(summary, "rocket.1.t_rear")));
    assert_true(isfinite(number(summary, "rocket.1.t_ignition")));
    assert_null(ld_summary_note(summary, summary->note_count));
    assert_null(ld_summary_note(summary, -1));
    ld_summary_free(summary);
    ld_model_free(model);
}

// The same rows by a sink of one's own: a sum over each column, and what is reported of it.
enum { MOST = 400 };
typedef struct row_sums {
    const ld_column *columns;
    double sum[MOST], flown[MOST];
    double *to;
    size_t rows, flights;
} row_sums;

static ld_status sums_begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)error;
    row_sums *sums = self;
    assert_true(count < MOST);
    *sums = (row_sums){.columns = columns};
    sums->to = sums->sum;
    return LD_OK;
}

static ld_status sums_row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)error;
    row_sums *sums = self;
    sums->rows += sums->to == sums->sum;
    for (size_t i = 0; i < count; i++)
        sums->to[i] += values[i];
    return LD_OK;
}

static ld_status sums_flight(void *self, int rocket, const ld_column *columns, size_t count,
                             ld_error *error)
{
    (void)rocket, (void)columns, (void)count, (void)error;
    row_sums *sums = self;
    sums->to = sums->flown;
    sums->flights++;
    return LD_OK;
}

// Every column of the history has the sum that was found row by row.
static void check_sums(const ld_history *history, const double *expected)
{
    size_t columns;
    const ld_column *column = ld_history_columns(history, &columns);
    assert_true(columns > 10);
    for (size_t i = 0; i < columns; i++) {
        size_t rows;
        const double *value = ld_history_column(history, column[i].name, &rows);
        double sum = 0;
        assert_int_equal(rows, ld_history_rows(history));
        for (size_t k = 0; k < rows; k++)
            sum += value[k];
        assert_true(sum == expected[i] || (isnan(sum) && isnan(expected[i])));
    }
}

static void test_rows_are_kept(void **state)
{
    (void)state;
    const char *sets[] = {"run.end=landing"};
    ld_model *model = read_example("fixed.yaml", sets, 1);
    ld_summary *summary = ld_summary_new();
    row_sums sums = {0};
    const ld_sink sink = {
        .self = &sums, .begin = sums_begin, .row = sums_row, .flight = sums_flight};
    ld_history *history = ld_history_new(&sink);
    ld_error error;
    assert_null(ld_history_column(history, "t", NULL));
    for (int again = 0; again < 2; again++) { // the second run takes the place of the first
        assert_int_equal(run(model, ld_history_sink(history), summary, &error), LD_OK);
        CHECK_WITHIN("rows kept more than once", (double)ld_history_rows(history),
                     (double)sums.rows, (double)sums.rows);
        check_sums(history, sums.sum);
        assert_non_null(ld_history_flight(history, 1));
        assert_null(ld_history_flight(history, 2));
        check_sums(ld_history_flight(history, 1), sums.flown);
    }
    size_t rows;
    const double *t = ld_history_column(history, "t", &rows);
    assert_true(rows > 512); // its room has grown, twice
    for (size_t k = 1; k < rows; k++)
        assert_true(t[k] > t[k - 1]);
    assert_null(ld_history_column(history, "tip.w", NULL));
    ld_history_free(history);
    ld_summary_free(summary);
    ld_model_free(model);
}

// A sink that requires no flights gets none of their rows.
static void test_rows_of_flights_only_where_wanted(void **state)
{
    (void)state;
    const char *sets[] = {"run.end=landing"};
    ld_model *model = read_example("fixed.yaml", sets, 1);
    ld_summary *summary = ld_summary_new();
    row_sums sums = {0};
    const ld_sink sink = {.self = &sums, .begin = sums_begin, .row = sums_row};
    ld_history *history = ld_history_new(&sink);
    ld_error error;
    assert_int_equal(run(model, ld_history_sink(history), summary, &error), LD_OK);
    CHECK_WITHIN("rows handed on", (double)sums.rows, (double)ld_history_rows(history),
                 (double)ld_history_rows(history));
    assert_true(ld_history_rows(ld_history_flight(history, 1)) > 1);
    ld_history_free(history);
    ld_summary_free(summary);
    ld_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_of_a_summary),
        cmocka_unit_test(test_a_run_that_stops),
        cmocka_unit_test(test_rows_are_kept),
        cmocka_unit_test(test_rows_of_flights_only_where_wanted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
