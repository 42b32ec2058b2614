// A run that is stepped: the steps, rows and summary are those of a run in one go, to the bit,
// however it is advanced, saved and loaded; what is read between steps is what the rows say there;
// events come one by one; an input makes a step end at its instant.
#include <stdlib.h>

#include "launchdyn/run.h"
#include "launchdyn/summary.h"
#include "model/model.h"
#include "quantities/summary.h"
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

// Gas drives the tube back into the stop behind, which throws it forwards again.
static void recoiling_model(ld_model *model)
{
    fixed_model(model);
    reference_by_pressure(model);
    reference_recoil(model);
    model->tubes.support[0].recoil.stroke = 0.02;
    model->run.end = LD_END_TIME;
    model->run.end_time = 0.2;
}

static void free_model(ld_model *model)
{
    model->salvo = NULL;
    reference_model_free(model);
}

// ---- what has no effect

// A pressure of nothing adds its work, an element and columns; lead-in by exponentials, launch by
// explicit steps, on a fixed base and on a vehicle whose subsystems step apart.
static int bits_that_differ(ld_model *model)
{
    ld_rocket_summary bare = summary_of_run(model).rocket[0];
    model->tubes.pressure = (ld_pressure){.present = true,
                                          .form = LD_PRESSURE_OF_GAS,
                                          .pressure = 1e5,
                                          .volume = 1,
                                          .exponent = 1,
                                          .scale = 0};
    ld_rocket_summary beside = summary_of_run(model).rocket[0];
    beside.max_pressure = bare.max_pressure;
    return memcmp((const char *)&beside, (const char *)&bare, sizeof bare) != 0;
}

static void what_has_no_effect_changes_no_bit(void **state)
{
    (void)state;
    ld_model model;
    ld_rocket rocket[2];
    fixed_model(&model);
    CHECK_WITHIN("fixed: bits that differ", bits_that_differ(&model), 0, 0);
    free_model(&model);
    for (int apart = 0; apart < 2; apart++) {
        vehicle_model(&model, rocket, apart * 1e-3);
        CHECK_WITHIN("vehicle: bits that differ", bits_that_differ(&model), 0, 0);
        free_model(&model);
    }
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
    rows->differ +=
        rows->row >= expected->rows ||
        memcmp(values, expected->values + rows->row * count, count * sizeof *values) != 0;
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

// Saves the run, ends it, and continues with what was saved.
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
    CHECK_WITHIN(
        "summaries that differ",
        memcmp((const char *)&summary, (const char *)&expected.summary, sizeof summary) != 0, 0, 0);
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
        recoiling_model(&model);
        check_pieces("recoil into stops", &model, saved);
        free_model(&model);
        vehicle_model(&model, rocket, 0);
        check_pieces("two rockets from a vehicle", &model, saved);
        free_model(&model);
        vehicle_model(&model, rocket, 1e-3);
        check_pieces("the same, subsystems apart", &model, saved);
        free_model(&model);
    }
}

// ---- events

enum { MOST = 400 };

typedef struct told {
    int count;
    ld_event event[MOST];
} told;

// All events, each in its order; the run is ended.
static told events_of_run(const ld_model *model, ld_summary *summary)
{
    ld_simulation *simulation;
    ld_error error;
    told all = {0};
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    ld_run *run = begin_run(simulation, NULL);
    double t = ld_run_time(run);
    ld_event next = {0};
    while (next.kind != LD_EVENT_END) {
        // now and then no event comes before the time asked for
        t = fmax(t, ld_run_time(run)) + 5e-3;
        if (ld_run_advance_to_event(run, t, &next, &error))
            fail_msg("%s", error.text);
        assert_true(next.t == ld_run_time(run) && next.t <= t);
        assert_true(next.kind == LD_EVENT_NONE ? next.t == t : all.count < MOST);
        if (next.kind != LD_EVENT_NONE)
            all.event[all.count++] = next;
    }
    if (ld_run_end(run, summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return all;
}

// The only one of its kind, rocket and part.
static double instant(const told *all, ld_event_kind kind, int rocket, int part)
{
    double t = NAN;
    int count = 0;
    for (int i = 0; i < all->count; i++) {
        const ld_event *one = &all->event[i];
        if (one->kind != kind || one->rocket != rocket || one->part != part)
            continue;
        t = one->t;
        count++;
    }
    assert_int_equal(count, 1);
    return t;
}

static int number_of(const told *all, ld_event_kind kind)
{
    int count = 0;
    for (int i = 0; i < all->count; i++)
        count += all->event[i].kind == kind;
    return count;
}

static void events_are_those_of_the_summary(void **state)
{
    (void)state;
    ld_model model;
    ld_rocket rocket[2];
    static ld_summary summary;
    vehicle_model(&model, rocket, 0);
    told all = events_of_run(&model, &summary);
    double off = 0;
    for (int i = 0; i < 2; i++) {
        const ld_rocket_summary *wanted = &summary.rocket[i];
        double lit = wanted->t_ignition;
        off = fmax(off, fabs(instant(&all, LD_EVENT_IGNITION, i + 1, 0) - lit));
        off = fmax(off, fabs(instant(&all, LD_EVENT_RELEASE, i + 1, 0) - lit - wanted->t_release));
        for (int k = 0; k < model.rocket.adaptor_count; k++)
            off = fmax(off,
                       fabs(instant(&all, LD_EVENT_EXIT, i + 1, k + 1) - lit - wanted->t_exit[k]));
    }
    off = fmax(off, fabs(instant(&all, LD_EVENT_TUBE, 2, 0) - (model.firing[1].at - 0.2)));
    off = fmax(off, fabs(instant(&all, LD_EVENT_END, 2, 0) - summary.t_end));
    CHECK_BELOW("instants of events against the summary's [s]", off, 1e-14);
    for (int i = 1; i < all.count; i++)
        assert_true(all.event[i].t >= all.event[i - 1].t);
    // two rows of the thrust table lie between ignition and exit
    CHECK_WITHIN("corners of the thrust", number_of(&all, LD_EVENT_CORNER), 2, 12);
    CHECK_WITHIN("touches, which this contact law does not tell", number_of(&all, LD_EVENT_TOUCH),
                 0, 0);
    free_model(&model);
    touching_model(&model);
    all = events_of_run(&model, &summary);
    CHECK_WITHIN("touches of the law that tells them", number_of(&all, LD_EVENT_TOUCH), 1, MOST);
    free_model(&model);
}

// The tube is at a stop where it comes to it, and nothing holds it there where it leaves.
static void stops_are_events(void **state)
{
    (void)state;
    ld_model model;
    recoiling_model(&model);
    const ld_support *support = &model.tubes.support[0];
    ld_simulation *simulation;
    ld_error error;
    if (ld_simulation_create(&model, &simulation, &error))
        fail_msg("%s", error.text);
    ld_run *run = begin_run(simulation, NULL);
    ld_event next = {0};
    double off = 0, press = 0;
    int came[2] = {0}, left[2] = {0};
    while (next.kind != LD_EVENT_END) {
        if (ld_run_advance_to_event(run, INFINITY, &next, &error))
            fail_msg("%s", error.text);
        if (next.kind != LD_EVENT_STOP && next.kind != LD_EVENT_LEAVE)
            continue;
        double back, rate;
        assert_true(next.part == 1 || next.part == 2);
        ld_run_number(run, "recoil.1.travel", &back, &error);
        ld_run_number(run, "recoil.1.rate", &rate, &error);
        double in = next.part == 1 ? -back : back - support->recoil.stroke;
        double in_rate = next.part == 1 ? -rate : rate;
        if (next.kind == LD_EVENT_STOP) {
            off = fmax(off, fabs(in));
            came[next.part - 1]++;
        } else {
            press =
                fmax(press, fabs(support->stiffness[0] * in + support->damping[0] * in_rate) / 1e3);
            left[next.part - 1]++;
        }
    }
    static ld_summary unused;
    ld_run_end(run, &unused, &error);
    ld_simulation_free(simulation);
    free_model(&model);
    printf("  front stop: %d times left, %d come to; behind: %d, %d\n", left[0], came[0], left[1],
           came[1]);
    assert_true(left[0] > 0 && came[1] > 0 && left[1] > 0);
    CHECK_BELOW("place of the tube where it comes to a stop [m]", off, 1e-11);
    CHECK_BELOW("force of a stop that the tube leaves [kN]", press, 1e-6);
}

// ---- reading

static bool happens_at(const told *all, double t)
{
    for (int i = 0; i < all->count; i++)
        if (all->event[i].t == t)
            return true;
    return false;
}

// At an output instant the run says what the row says that was written there.
static void reading_is_the_row(void **state)
{
    (void)state;
    ld_model model;
    fixed_model(&model);
    recorded_run expected;
    recorded_run_make(&expected, &model);
    ld_run *run = begin_run(expected.simulation, NULL);
    const ld_column *columns;
    size_t count = ld_simulation_columns(expected.simulation, &columns);
    double *values = calloc(count, sizeof *values);
    int differ = 0, read = 0;
    static ld_summary unused;
    told all = events_of_run(&model, &unused);
    for (size_t i = 0; i + 1 < expected.rows; i += 3) {
        const double *wanted = expected.values + i * count;
        if (happens_at(&all, wanted[0]))
            continue; // that row says what was before
        advance(run, wanted[0]);
        assert_int_equal(ld_run_row(run, values, NULL), LD_OK);
        differ += memcmp(values, wanted, count * sizeof *values) != 0;
        read++;
        double one;
        assert_int_equal(ld_run_number(run, "tip.pitch_rate", &one, NULL), LD_OK);
        assert_true(one == wanted[recorded_column(&expected, "tip.pitch_rate")]);
    }
    CHECK_WITHIN("rows read", read, 80, 1000);
    CHECK_WITHIN("of them others than those written", differ, 0, 0);
    ld_run_end(run, NULL, NULL);
    free(values);
    recorded_run_free(&expected);
    free_model(&model);
}

// ---- inputs

// Reported at the start that it `waits`, then when.
static ld_rocket_summary lit_at(const ld_model *model, double when, double inputs_at, bool waits)
{
    static ld_summary summary;
    ld_simulation *simulation;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    ld_run *run = begin_run(simulation, NULL);
    if (waits && ld_run_ignite(run, INFINITY, &error))
        fail_msg("%s", error.text);
    advance(run, inputs_at);
    if (ld_run_ignite(run, when, &error))
        fail_msg("%s", error.text);
    assert_int_equal(ld_run_ignite(run, inputs_at - 1e-3, &error), LD_ERR_INPUT);
    advance(run, INFINITY);
    if (ld_run_end(run, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary.rocket[0];
}

// Reported later, at once, or from infinity: the launch of a scenario that is ignited then.
static void ignition_is_an_input(void **state)
{
    (void)state;
    ld_model model;
    fixed_model(&model);
    model.run.tolerance = 1e-8;
    model.firing[0].at = 0.0133;
    ld_rocket_summary wanted = summary_of_run(&model).rocket[0];
    model.firing[0].at = 0.02;
    ld_rocket_summary before = lit_at(&model, 0.0133, -0.02, false);
    CHECK_WITHIN("told at the start: bits that differ",
                 memcmp((const char *)&before, (const char *)&wanted, sizeof wanted) != 0, 0, 0);
    model.firing[0].at = 1;
    ld_rocket_summary between = lit_at(&model, 0.0133, 0.0007, false);
    ld_rocket_summary now = lit_at(&model, 0.0133, 0.0133, true);
    CHECK_BELOW("told between: t_rear [s]", between.t_rear - wanted.t_rear, 5e-11);
    CHECK_BELOW("told between: pitch rate [rad/s]", between.pitch_rate - wanted.pitch_rate, 1e-7);
    CHECK_BELOW("told at its instant: t_rear [s]", now.t_rear - wanted.t_rear, 5e-11);
    CHECK_BELOW("told at its instant: pitch rate [rad/s]", now.pitch_rate - wanted.pitch_rate,
                1e-7);
    CHECK_BELOW("its ignition in the summary [s]", now.t_ignition - 0.0133, 0);
    free_model(&model);
}

// ---- the summary so far, flights

static void the_summary_grows(void **state)
{
    (void)state;
    ld_model model;
    ld_simulation *simulation;
    ld_event next = {0};
    double t_release, t_rear;
    fixed_model(&model);
    assert_int_equal(ld_simulation_create(&model, &simulation, NULL), LD_OK);
    ld_run *run = begin_run(simulation, NULL);
    const ld_summary *summary = ld_run_summary(run);
    assert_true(isnan(summary->rocket[0].t_release));
    while (next.kind != LD_EVENT_RELEASE)
        assert_int_equal(ld_run_advance_to_event(run, INFINITY, &next, NULL), LD_OK);
    assert_int_equal(ld_summary_number(summary, "rocket.1.t_release", &t_release, NULL), LD_OK);
    assert_int_equal(ld_summary_number(summary, "rocket.1.t_rear", &t_rear, NULL), LD_OK);
    CHECK_NEAR("release in the summary so far [s]", t_release, next.t, 0);
    assert_true(isnan(t_rear));
    ld_run_end(run, NULL, NULL);
    ld_simulation_free(simulation);
    free_model(&model);
}

// What flies is flown at the end; a flight alone is nothing else.
static void flights_are_flown_at_the_end(void **state)
{
    (void)state;
    ld_model model;
    fixed_model(&model);
    model.run.end = LD_END_LANDING;
    static recorded_run expected;
    recorded_run_make(&expected, &model);
    ld_run *run = begin_run(expected.simulation, NULL);
    advance(run, INFINITY);
    assert_false(ld_run_summary(run)->rocket[0].flown);
    static ld_summary summary;
    assert_int_equal(ld_run_end(run, &summary, NULL), LD_OK);
    CHECK_BELOW("impact against a run in one go [m]",
                summary.rocket[0].flight.range - expected.summary.rocket[0].flight.range, 0);
    recorded_run_free(&expected);

    model.base.kind = LD_BASE_NONE;
    model.flight = (ld_flight){
        .position = {0, 100, 0}, .speed = 50, .velocity_ned = {NAN}, .quaternion = {NAN}};
    recorded_run_make(&expected, &model);
    run = begin_run(expected.simulation, NULL);
    assert_true(ld_run_is_finished(run));
    double value;
    size_t size;
    ld_error error;
    assert_int_equal(ld_run_number(run, "t", &value, &error), LD_ERR_INPUT);
    printf("    %s\n", error.text);
    assert_int_equal(ld_run_save(run, NULL, 0, &size, &error), LD_ERR_INPUT);
    assert_int_equal(ld_run_end(run, &summary, NULL), LD_OK);
    CHECK_BELOW("flight alone: impact against a run in one go [m]",
                summary.rocket[0].flight.range - expected.summary.rocket[0].flight.range, 0);
    recorded_run_free(&expected);
    free_model(&model);
}

// ---- what is refused

static void wrong_uses_are_refused(void **state)
{
    (void)state;
    ld_model model;
    fixed_model(&model);
    ld_simulation *simulation;
    ld_error error;
    double value;
    static ld_summary summary;
    assert_int_equal(ld_simulation_create(&model, &simulation, NULL), LD_OK);
    ld_run *run = begin_run(simulation, NULL);
    advance(run, 1e-3);
    assert_int_equal(ld_run_advance(run, 0, &error), LD_ERR_INPUT);
    printf("    %s\n", error.text);
    assert_int_equal(ld_run_advance(run, NAN, &error), LD_ERR_INPUT);
    assert_int_equal(ld_run_number(run, "rocket.weight", &value, &error), LD_ERR_INPUT);
    printf("    %s\n", error.text);
    assert_int_equal(ld_run_ignite(run, 5e-3, &error), LD_ERR_INPUT); // it burns
    printf("    %s\n", error.text);
    // nothing of that has ended the run
    advance(run, 2e-3);
    assert_int_equal(ld_run_end(run, &summary, &error), LD_ERR_INTERRUPTED);
    printf("    %s\n", summary.stopped);
    assert_false(summary.complete);
    CHECK_BELOW("where a run ended early ends [s]", summary.t_end - 2e-3, 0);
    assert_int_equal(ld_run_end(NULL, &summary, &error), LD_OK);
    ld_simulation_free(simulation);
    free_model(&model);
}

static void load_refuses(const ld_simulation *simulation, const unsigned char *bytes, size_t size,
                         const char *why)
{
    ld_run *run;
    ld_error error = {0};
    assert_int_equal(ld_run_load(simulation, NULL, bytes, size, &run, &error), LD_ERR_INPUT);
    assert_null(run);
    if (!strstr(error.text, why))
        fail_msg("%s", error.text);
}

static void other_bytes_are_refused(void **state)
{
    (void)state;
    static unsigned char bytes[1 << 16], other[1 << 16];
    ld_model model;
    fixed_model(&model);
    ld_simulation *simulation, *foreign;
    ld_error error;
    size_t size;
    assert_int_equal(ld_simulation_create(&model, &simulation, NULL), LD_OK);
    ld_run *run = begin_run(simulation, NULL);
    advance(run, 0.01);
    assert_int_equal(ld_run_save(run, bytes, 100, &size, &error), LD_ERR_INPUT);
    printf("    %s\n", error.text);
    assert_int_equal(ld_run_save(run, bytes, sizeof bytes, &size, &error), LD_OK);
    ld_run_end(run, NULL, NULL);
    for (size_t cut = 0; cut < size; cut += 61)
        load_refuses(simulation, bytes, cut, cut < 8 ? "not a saved run" : "");
    int accepted = 0;
    for (size_t at = 0; at < size; at += 7) {
        memcpy(other, bytes, size);
        other[at] ^= (unsigned char)(1 << at % 8);
        accepted += ld_run_load(simulation, NULL, other, size, &run, &error) == LD_OK;
    }
    CHECK_WITHIN("loads of bytes with one bit flipped", accepted, 0, 0);
    load_refuses(simulation, bytes, size - 1, "truncated or damaged");
    other[0] = 0;
    load_refuses(simulation, other, size, "not a saved run");
    memcpy(other, bytes, size);
    other[8]++;
    load_refuses(simulation, other, size, "another version");
    model.rocket.contact.friction *= 1 + 1e-15;
    assert_int_equal(ld_simulation_create(&model, &foreign, NULL), LD_OK);
    load_refuses(foreign, bytes, size, "another model");
    ld_simulation_free(foreign);
    ld_simulation_free(simulation);
    free_model(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_has_no_effect_changes_no_bit),
        cmocka_unit_test(pieces_make_the_whole),
        cmocka_unit_test(events_are_those_of_the_summary),
        cmocka_unit_test(stops_are_events),
        cmocka_unit_test(reading_is_the_row),
        cmocka_unit_test(ignition_is_an_input),
        cmocka_unit_test(the_summary_grows),
        cmocka_unit_test(flights_are_flown_at_the_end),
        cmocka_unit_test(wrong_uses_are_refused),
        cmocka_unit_test(other_bytes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
