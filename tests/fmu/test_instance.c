// An instance of an FMU asks its run for rows, wrenches and results once for each present, however
// many outputs are read, and again after all that changes them. Counted, not timed.
// link: -ldl
#include "fmu/fmu_instance.c" // which stands in the binary of an FMU alone
#include "support/fmu.h"

static int rows, wrenches, summaries;
static const fmu_runner *real;
static bool fails;

static ld_status counted_row(void *run, double *values, ld_error *error)
{
    rows++;
    return fails ? ld_fail(error, LD_ERR_NUMERIC, "no row") : real->get_row(run, values, error);
}

static ld_status counted_outputs(void *run, double *numbers, ld_error *error)
{
    wrenches++;
    return real->get_outputs(run, numbers, error);
}

static const ld_summary *counted_summary(const void *run)
{
    summaries++;
    return real->summary(run);
}

static fmu_instance *open_counted(const unpacked_fmu *fmu, fmu_runner *counted)
{
    ld_error error;
    fmu_instance *self = fmu_instance_new(fmu->resources, fmu->token, false, &error);
    if (!self)
        fail_msg("%s", error.text);
    real = self->variables.runner;
    *counted = *real;
    counted->get_row = counted_row;
    counted->get_outputs = counted_outputs;
    counted->summary = counted_summary;
    self->variables.runner = counted;
    return self;
}

// All outputs; whether results are those that the summary has by their names.
static void read_all(fmu_instance *self)
{
    ld_error error;
    double value, named;
    rows = wrenches = summaries = 0;
    for (unsigned i = 0; i < self->variables.count; i++) {
        const fmu_variable *v = &self->variables.item[i];
        if (!fmu_is_output(v))
            continue;
        assert_int_equal(fmu_get_number(self, i, false, &value, &error), LD_OK);
        if (v->group != FMU_RESULT)
            continue;
        ld_summary_number(real->summary(self->run), v->name + strlen("summary."), &named, &error);
        assert_true(value == named || (isnan(value) && isnan(named)));
    }
}

static void expect_asked(int times)
{
    assert_int_equal(rows, times);
    assert_int_equal(wrenches, times);
    assert_int_equal(summaries, times);
}

static void asks_once(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open("examples/sequence.yaml --set run.lead_in=0s "
                                "--set 'firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.3 s}]'",
                                3);
    fmu_runner counted;
    fmu_instance *self = open_counted(&fmu, &counted);
    ld_error error;
    fmu_step step;
    fmu_state *saved;
    assert_int_equal(fmu_go(self, &error), LD_OK);
    for (int k = 0; k < 4; k++) { // on both rockets' ways
        read_all(self);
        expect_asked(1);
        read_all(self);
        expect_asked(0);
        assert_int_equal(fmu_step_on(self, 0.1 * k, 0.1 * (k + 1) - 0.1 * k, false, &step, &error),
                         LD_OK);
    }
    read_all(self);
    assert_int_equal(fmu_save(self, &saved, &error), LD_OK);
    assert_int_equal(fmu_load(self, saved, &error), LD_OK);
    read_all(self);
    expect_asked(1);
    free(saved);
    fmu_instance_free(self);
    fmu_close(&fmu);
}

// A row that could not be made is asked for again.
static void asks_again_after_a_failure(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open("examples/fixed.yaml", 3);
    fmu_runner counted;
    fmu_instance *self = open_counted(&fmu, &counted);
    unsigned first = (unsigned)fmu_group_begin(&self->variables, FMU_COLUMN);
    ld_error error;
    double value;
    assert_int_equal(fmu_go(self, &error), LD_OK);
    rows = 0;
    fails = true;
    assert_int_equal(fmu_get_number(self, first, false, &value, &error), LD_ERR_NUMERIC);
    fails = false;
    assert_int_equal(fmu_get_number(self, first, false, &value, &error), LD_OK);
    assert_int_equal(rows, 2);
    fmu_instance_free(self);
    fmu_close(&fmu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(asks_once, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(asks_again_after_a_failure, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
