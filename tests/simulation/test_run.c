// A run that is stepped: the steps, rows and summary are those of a run in one go, to the bit,
// however it is advanced, saved and loaded; what is read between steps is what the rows say there;
// events come one by one; an input makes a step end at its instant.
#include <stdlib.h>

#include "launchdyn/run.h"
#include "simulation/summary.h"
#include "support/check.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

// ---- models: the tube alone, so that they are short

static void fixed_model(ld_model *model)
{
    reference_model(model);
    model->run.end = LD_END_TIP;
    model->run.lead_in = 0.02;
    model->run.output_step_lead_in = 1e-3;
}

// Two rockets that differ from a vehicle; the subsystems together or (`apart`) each by its own.
static void vehicle_model(ld_model *model, ld_rocket rocket[2], double apart)
{
    reference_vehicle(model, 8);
    model->run.end = LD_END_TIP;
    model->run.lead_in = 0.02;
    model->run.coupling_step = apart;
    model->firing_count = 2;
    model->firing[1] = (ld_firing){.tube = 7, .at = 0.5};
    rocket[0] = rocket[1] = model->rocket;
    rocket[1].full.mass += 1;
    model->salvo = rocket;
}

// Lankarani and Nikravesh's contact, whose touches are events.
static void touching_model(ld_model *model)
{
    fixed_model(model);
    model->rocket.contact.law = LD_CONTACT_LANKARANI_NIKRAVESH;
    model->rocket.contact.exponent = 1.5;
}

static void free_model(ld_model *model)
{
    model->salvo = NULL;
    reference_model_free(model);
}

// ---- a run in pieces beside one in one go

typedef struct recorder {
    const recorded_run *expected; // rows of the run in one go
    size_t row;
    int differ;
} recorder;

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)self, (void)columns, (void)count, (void)error;
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    recorder *rows = self;
    (void)error;
    const recorded_run *expected = rows->expected;
    rows->differ += rows->row >= expected->rows ||
                    memcmp(values, expected->values + rows->row * count, count * sizeof *values);
    rows->row++;
    return LD_OK;
}

static ld_run *begin_run(const ld_simulation *simulation, const ld_run_options *options)
{
    ld_run *run;
    ld_error error;
    if (ld_run_begin(simulation, options, &run, &error))
        fail_msg("%s", error.text);
    return run;
}

static void advance(ld_run *run, double t)
{
    ld_error error;
    if (ld_run_advance(run, t, &error))
        fail_msg("%s", error.text);
}

// Saves the run, ends it, and goes on with what was saved.
static ld_run *exchange(ld_run *run, const ld_simulation *simulation, const ld_run_options *options,
                        size_t *most)
{
    static unsigned char bytes[1 << 16];
    size_t size;
    ld_error error;
    if (ld_run_save(run, bytes, sizeof bytes, &size, &error))
        fail_msg("%s", error.text);
    *most = size > *most ? size : *most;
    assert_int_equal(ld_run_end(run, NULL, &error), LD_OK);
    if (ld_run_load(simulation, options, bytes, size, &run, &error))
        fail_msg("%s", error.text);
    return run;
}

// Steps of time that fall anywhere: 0 to 2 ms, and now and then none.
static double next_step(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 28 ? 2e-3 * (*state >> 8) / (1 << 24) : 0;
}

static void check_pieces(const char *what, const ld_model *model, bool saved)
{
    printf("  %s%s\n", what, saved ? ", saved and loaded on its way" : "");
    static recorded_run expected;
    recorded_run_make(&expected, model);
    recorder rows = {.expected = &expected};
    const ld_sink sink = {.self = &rows, .begin = begin, .row = row};
    const ld_run_options options = {.sink = &sink};
    ld_run *run = begin_run(expected.simulation, &options);
    unsigned random = 1;
    size_t most = 0;
    int reads = 0;
    double *values = calloc(expected.columns, sizeof *values);
    for (double t = ld_run_time(run); !ld_run_is_finished(run); reads++) {
        t += next_step(&random);
        advance(run, t);
        assert_int_equal(ld_run_row(run, values, NULL), LD_OK); // reading changes nothing
        assert_true(ld_run_is_finished(run) || (values[0] == t && ld_run_time(run) == t));
        if (saved)
            run = exchange(run, expected.simulation, &options, &most);
    }
    free(values);
    static ld_summary summary;
    assert_int_equal(ld_run_end(run, &summary, NULL), LD_OK);
    summary.statistics.cpu_seconds = expected.summary.statistics.cpu_seconds;
    CHECK_WITHIN("times looked at", reads, 100, 2000);
    CHECK_WITHIN("rows that differ from those of a run in one go", rows.differ, 0, 0);
    CHECK_WITHIN("rows too few or too many", fabs((double)rows.row - (double)expected.rows), 0, 0);
    CHECK_WITHIN("summaries that differ", memcmp(&summary, &expected.summary, sizeof summary) != 0,
                 0, 0);
    if (saved)
        CHECK_WITHIN("bytes of the state, at most", (double)most, 1000, 65535);
    recorded_run_free(&expected);
}

static void pieces_make_the_whole(void **state)
{
    (void)state;
    ld_model model;
    ld_rocket rocket[2];
    for (int saved = 0; saved < 2; saved++) {
        fixed_model(&model);
        check_pieces("fixed base", &model, saved);
        free_model(&model);
        touching_model(&model);
        check_pieces("contact with touches", &model, saved);
        free_model(&model);
        vehicle_model(&model, rocket, 0);
        check_pieces("two rockets from a vehicle", &model, saved);
        free_model(&model);
        vehicle_model(&model, rocket, 1e-3);
        check_pieces("the same, subsystems apart", &model, saved);
        free_model(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_make_the_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
