// Launches that are expected to end in a certain way: a receiver of rows that watches, and checks
// of status, sentence and rows.
#ifndef LD_TESTS_SUPPORT_EXPECTED_LAUNCH_H
#define LD_TESTS_SUPPORT_EXPECTED_LAUNCH_H

#include <stdlib.h>

#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/reference_model.h"

// A sink that counts rows and can be made to fail.
typedef struct listener {
    int begun, rows, fail_at;
    ld_status failure;
    bool silent;
    double last, first;
    bool ascending;
    double stop_at; // share at which the progress callback says no
} listener;

static inline ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)columns, (void)count, (void)error;
    ((listener *)self)->begun++;
    return LD_OK;
}

static inline ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    listener *ear = self;
    (void)count;
    if (ear->rows == 0)
        ear->first = values[0];
    else
        ear->ascending = ear->ascending && values[0] > ear->last;
    ear->last = values[0];
    if (++ear->rows == ear->fail_at)
        return ear->silent ? ear->failure : ld_fail(error, ear->failure, "the disk is full");
    return LD_OK;
}

static inline bool go_on(void *self, double share)
{
    return share < ((listener *)self)->stop_at;
}

typedef struct outcome {
    ld_status status;
    ld_summary summary;
    ld_error error;
} outcome;

// Runs the model (which is freed) without the checks that the reader makes.
static inline void run(ld_model *model, listener *ear, outcome *out)
{
    ld_sink sink = {.self = ear, .begin = begin, .row = row};
    ld_run_options options = {.sink = &sink, .self = ear};
    ld_simulation *simulation;
    if (ear->stop_at > 0)
        options.progress = go_on;
    ear->ascending = true;
    if (ld_simulation_create(model, &simulation, &out->error))
        fail_msg("%s", out->error.text);
    out->status = ld_simulation_run(simulation, &options, &out->summary, &out->error);
    ld_simulation_free(simulation);
    reference_model_free(model);
}

// Whether `text` is `pattern`, in which each # stands for a number.
static inline bool matches(const char *text, const char *pattern)
{
    for (; *pattern; pattern++) {
        if (*pattern != '#') {
            if (*text++ != *pattern)
                return false;
            continue;
        }
        char *end;
        strtod(text, &end);
        if (end == text)
            return false;
        text = end;
    }
    return *text == '\0';
}

// The run stopped with this status and sentence after rows up to t_end [s], in order.
static inline void check_stopped(ld_model *model, listener *ear, ld_status status,
                                 const char *sentence, double t_end)
{
    outcome out;
    double lead_in = model->run.lead_in;
    run(model, ear, &out);
    printf("    %s\n", out.error.text);
    assert_int_equal(out.status, status);
    assert_int_equal(out.error.status, status);
    assert_true(matches(out.error.text, sentence));
    assert_string_equal(out.summary.stopped, out.error.text);
    assert_false(out.summary.complete);
    // a tube that whips does so a millisecond earlier or later with the bits of its modes, which
    // LAPACK makes differently on other processors
    CHECK_BELOW("ended [s]", out.summary.t_end - t_end, 2e-3);
    assert_int_equal(ear->begun, 1);
    assert_true(ear->ascending);
    assert_true(ear->first == -lead_in);
    if (ear->fail_at)
        assert_int_equal(ear->rows, ear->fail_at);
    else
        assert_true(ear->last == out.summary.t_end);
    assert_true(isnan(out.summary.rocket[0].t_rear));
    assert_true(isfinite(out.summary.energy.kinetic));
}

// The launch does not begin: no rows, nothing but the sentence.
static inline void check_no_start(ld_model *model, ld_status status, const char *sentence)
{
    outcome out;
    listener ear = {0};
    run(model, &ear, &out);
    printf("    %s\n", out.error.text);
    assert_int_equal(out.status, status);
    assert_true(matches(out.error.text, sentence));
    assert_string_equal(out.summary.stopped, out.error.text);
    assert_false(out.summary.complete);
    assert_int_equal(ear.rows, 0);
    assert_true(isnan(out.summary.rocket[0].t_release));
}

// Not a failure: a launch that looks odd but happens.
static inline void check_happens(const char *name, ld_model *model)
{
    listener ear = {0};
    outcome out;
    run(model, &ear, &out);
    printf("    %s: exit speed %.4f m/s%s\n", name, out.summary.rocket[0].exit_speed,
           out.status ? out.error.text : "");
    assert_int_equal(out.status, LD_OK);
    assert_true(out.summary.complete);
    assert_string_equal(out.summary.stopped, "");
    assert_true(ear.last == out.summary.t_end);
    CHECK_WITHIN("exit speed [m/s]", out.summary.rocket[0].exit_speed, 37, 40);
    CHECK_BELOW("acceleration at the start [m/s2, rad/s2]", out.summary.equilibrium.residual, 1e-5);
}

#endif
