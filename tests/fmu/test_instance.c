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
        assert_int_equal(fmu_get_number(self, v->reference, FMU_REAL, &value, &error), LD_OK);
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
    size_t place = fmu_group_begin(&self->variables, FMU_COLUMN);
    unsigned first = self->variables.item[place].reference;
    ld_error error;
    double value;
    assert_int_equal(fmu_go(self, &error), LD_OK);
    rows = 0;
    fails = true;
    assert_int_equal(fmu_get_number(self, first, FMU_REAL, &value, &error), LD_ERR_NUMERIC);
    fails = false;
    assert_int_equal(fmu_get_number(self, first, FMU_REAL, &value, &error), LD_OK);
    assert_int_equal(rows, 2);
    fmu_instance_free(self);
    fmu_close(&fmu);
}

static fmu_instance *open_with(const unpacked_fmu *fmu, bool set_all)
{
    ld_error error;
    fmu_step step;
    fmu_instance *self = fmu_instance_new(fmu->resources, fmu->token, false, &error);
    assert_non_null(self);
    int count[4] = {0};
    for (size_t i = 0; set_all && i < self->variables.count; i++) {
        const fmu_variable *v = &self->variables.item[i];
        fmu_type type = fmu_type_of(v);
        if (!fmu_is_parameter(v))
            continue;
        ld_status status = type == FMU_STRING
                               ? fmu_set_text(self, v->reference, v->text, &error)
                               : fmu_set_number(self, v->reference, type, v->start, &error);
        assert_int_equal(status, LD_OK);
        count[type]++;
    }
    if (set_all)
        printf("    %d numbers, %d counts, %d texts\n", count[FMU_REAL], count[FMU_INTEGER],
               count[FMU_STRING]);
    if (fmu_go(self, &error))
        fail_msg("%s", error.text);
    assert_int_equal(fmu_step_on(self, self->variables.start, 0.12, false, &step, &error), LD_OK);
    return self;
}

// Every parameter set to its start, numbers, counts and texts, is a scenario that says the same.
static void takes_every_parameter(void **state)
{
    (void)state;
    static const char *const scenarios[] = {"examples/reference.yaml", "examples/ship.yaml",
                                            "examples/smooth.yaml"};
    for (int k = 0; k < 3; k++) {
        unpacked_fmu fmu = fmu_open(scenarios[k], 3);
        fmu_instance *plain = open_with(&fmu, false), *set = open_with(&fmu, true);
        int unequal = 0;
        for (size_t i = 0; i < plain->variables.count; i++) {
            const fmu_variable *v = &plain->variables.item[i];
            double a, b;
            ld_error error;
            if (!fmu_is_output(v))
                continue;
            assert_int_equal(fmu_get_number(plain, v->reference, FMU_REAL, &a, &error), LD_OK);
            assert_int_equal(fmu_get_number(set, v->reference, FMU_REAL, &b, &error), LD_OK);
            unequal += memcmp(&a, &b, sizeof a) != 0;
        }
        CHECK_BELOW("outputs that differ with every parameter set", unequal, 0);
        fmu_instance_free(plain);
        fmu_instance_free(set);
        fmu_close(&fmu);
    }
}

// As many names as share some numbers of 31 bits: each, and each vector, has a reference of its
// own, by which it is found, and all but those few that which it has alone.
static void shares_no_reference(void **state)
{
    (void)state;
    enum { NAMES = 200001 };
    fmu_variables all = {.count = NAMES, .item = calloc(NAMES, sizeof *all.item)};
    char name[32], array[FMU_ARRAY_NAME];
    int moved = 0, arrays_moved = 0;
    assert_non_null(all.item);
    for (size_t i = 0; i < NAMES; i++) {
        snprintf(name, sizeof name, "scenario.%zu.%c", i / 3, "xyz"[i % 3]);
        all.item[i] = (fmu_variable){.index = (int)i, .name = strdup(name), .unit = strdup("m")};
    }
    assert_true(fmu_variables_refer(&all));
    for (size_t i = 0; i < NAMES; i++) {
        assert_int_equal(fmu_variables_find(&all, all.item[i].reference), i);
        moved += all.item[i].reference != reference_by(all.item[i].name);
    }
    for (size_t i = 0; i < NAMES; i += 3) {
        assert_int_equal(fmu_variables_find_array(&all, all.item[i].array), i);
        assert_int_equal(fmu_variables_find(&all, all.item[i].array), NAMES);
        fmu_array_name(&all.item[i], array);
        arrays_moved += all.item[i].array != reference_by(array);
    }
    printf("    %d of %d moved, %d of %d vectors\n", moved, NAMES, arrays_moved, NAMES / 3);
    assert_in_range(moved, 1, 40);        // NAMES^2 / 2^32 = 9.3 expected
    assert_in_range(arrays_moved, 1, 30); // NAMES^2 / 3 / 2^31 + NAMES^2 / 9 / 2^32 = 7.3
    fmu_variables_free(&all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(asks_once, shell_make, shell_remove),
        cmocka_unit_test(shares_no_reference),
        cmocka_unit_test_setup_teardown(takes_every_parameter, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(asks_again_after_a_failure, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
