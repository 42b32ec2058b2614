// By what a road scatters the exit, from the linear response, against whole runs on a road so low
// that a launch is linear in it.
// ctest: slow
#include <stdlib.h>

#include "launchdyn/response.h"
#include "launchdyn/summary.h"
#include "support/check.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double quarter = 1.5707963267948966;

static const char *const names[] = {
    "t_rear",     "muzzle_speed", "pitch",         "pitch_rate",
    "tip_off.vy", "tip.y",        "tip_off.pitch", "tip_off.pitch_rate_relative",
};
enum { FIGURES = sizeof names / sizeof *names, SPEED = 5 };

static void figures_of(const ld_summary *summary, double value[FIGURES])
{
    ld_error error;
    for (int i = 0; i < FIGURES; i++) {
        char name[64];
        snprintf(name, sizeof name, "rocket.1.%s", names[i]);
        if (ld_summary_number(summary, name, &value[i], &error))
            fail_msg("%s", error.text);
    }
}

// One low sine of 8 Hz on both tracks, its phase at the ignition being `phase`.
static void put_on_sine(ld_model *model, double phase)
{
    ld_road *road = &model->base.vehicle.road;
    road->form = LD_ROAD_SUM;
    road->sine_count = 1;
    road->sine[0] = (ld_road_sine){1e-6, SPEED / 8.0, phase};
}

static void make_model(ld_model *model)
{
    reference_vehicle(model, SPEED);
    model->tubes.modes.bending = 2;
    model->tubes.modes.torsion = 1;
    model->platform.azimuth.friction.coulomb = model->platform.elevation.friction.coulomb = 0;
    model->rocket.contact.friction = 0;
    model->run.tolerance = 1e-9;
    model->run.end = LD_END_TIP;
    put_on_sine(model, 0);
}

static ld_response *respond(const ld_model *model)
{
    ld_error error;
    ld_response *response;
    if (ld_response_create(model, NAN, NAN, &response, &error))
        fail_msg("%s", error.text);
    return response;
}

// The exit's figures are y + Re(Y e^(i phase)): runs at four phases tell |Y|, the deviation over
// all of them is |Y|/sqrt(2).
static void a_sine_scatters_the_exit(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    double value[4][FIGURES], mean[FIGURES], deviation[FIGURES], worst = 0;
    double whole_of_t_rear = 0;
    make_model(&model);
    ld_response *response = respond(&model);
    if (ld_response_exit(response, SPEED, 0, names, FIGURES, mean, deviation, &error))
        fail_msg("%s", error.text);
    ld_response_free(response);
    model.run.lead_in = 2.5;
    for (int k = 0; k < 4; k++) {
        put_on_sine(&model, k * quarter);
        ld_summary summary = summary_of_run(&model);
        figures_of(&summary, value[k]);
    }
    for (int i = 0; i < FIGURES; i++) {
        double whole = hypot(value[0][i] - value[2][i], value[1][i] - value[3][i]) / 2 / sqrt(2);
        double rest = (value[0][i] + value[1][i] + value[2][i] + value[3][i]) / 4;
        printf("    %-28s %12.6g %12.6g, runs %12.6g %12.6g\n", names[i], mean[i], deviation[i],
               rest, whole);
        worst = fmax(worst, fabs(deviation[i] / whole - 1));
        whole_of_t_rear = i == 0 ? whole : whole_of_t_rear;
    }
    CHECK_BELOW("8 deviations against runs, relative", worst, 2e-2);
    CHECK_BELOW("that of t_rear", deviation[0] / whole_of_t_rear - 1, 1e-4);
    reference_model_free(&model);
}

// Draws: mean and deviation of a sine with an even phase, whose fourth moment is 3/2.
static void draws_find_what_patterns_find(void **state)
{
    (void)state;
    enum { DRAWS = 24 };
    ld_model model;
    ld_error error;
    double rest[FIGURES], mean[FIGURES], deviation[2][FIGURES], worst = 0, off = 0;
    make_model(&model);
    model.run.tolerance = 1e-8;
    ld_response *response = respond(&model);
    assert_int_equal(
        ld_response_exit(response, SPEED, 0, names, FIGURES, rest, deviation[0], &error), LD_OK);
    assert_int_equal(
        ld_response_exit(response, SPEED, DRAWS, names, FIGURES, mean, deviation[1], &error),
        LD_OK);
    for (int i = 0; i < FIGURES; i++) {
        printf("    %-28s %12.6g, drawn %12.6g\n", names[i], deviation[0][i], deviation[1][i]);
        worst = fmax(worst, fabs(deviation[1][i] / deviation[0][i] - 1));
        off = fmax(off, fabs(mean[i] - rest[i]) / deviation[0][i]);
    }
    // one deviation of these in 24: 7 % and 20 %
    CHECK_BELOW("deviations of 24 draws, relative", worst, 0.25);
    CHECK_BELOW("their means, of a deviation", off, 0.6);
    ld_response_free(response);
    reference_model_free(&model);
}

static void what_there_is_not_is_told(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    double mean, deviation;
    const char *name = "pich_rate", *range = "range";
    make_model(&model);
    ld_response *response = respond(&model);
    assert_int_equal(ld_response_exit(response, SPEED, 0, &name, 1, &mean, &deviation, &error),
                     LD_ERR_INPUT);
    assert_string_equal(error.text,
                        "unknown result of a launch \"pich_rate\", did you mean \"pitch_rate\"?");
    assert_int_equal(ld_response_exit(response, SPEED, 0, &range, 1, &mean, &deviation, &error),
                     LD_ERR_INPUT);
    assert_string_equal(error.text, "\"range\" comes of the flight: it is none of the exit");
    assert_int_equal(ld_response_exit(response, SPEED, 1, &name, 1, &mean, &deviation, &error),
                     LD_ERR_INPUT);
    assert_string_equal(error.text, "1 draws: there are 2 or more, or 0: none");
    assert_int_equal(ld_response_exit(response, 0, 0, &name, 1, &mean, &deviation, &error),
                     LD_ERR_INPUT);
    ld_response_free(response);
    reference_model_free(&model);
}

typedef struct patience {
    int asked, most; // times
} patience;

static bool is_patient(void *self)
{
    patience *of = self;
    return ++of->asked <= of->most;
}

static void who_watches_may_stop_it(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    double mean, deviation;
    const char *name = "pitch_rate";
    patience most = {0, 2};
    const ld_watch watch = {is_patient, &most};
    make_model(&model);
    ld_response *response = respond(&model);
    ld_response_watch(response, &watch);
    for (int draws = 0; draws <= 4; draws += 4) {
        most.asked = 0;
        assert_int_equal(
            ld_response_exit(response, SPEED, draws, &name, 1, &mean, &deviation, &error),
            LD_ERR_INTERRUPTED);
        assert_string_equal(error.text, "interrupted after 2 launches");
        assert_int_equal(most.asked, 3);
    }
    ld_response_watch(response, NULL);
    assert_int_equal(ld_response_exit(response, SPEED, 2, &name, 1, &mean, &deviation, &error),
                     LD_OK);
    assert_int_equal(most.asked, 3);
    ld_response_free(response);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sine_scatters_the_exit),
        cmocka_unit_test(draws_find_what_patterns_find),
        cmocka_unit_test(what_there_is_not_is_told),
        cmocka_unit_test(who_watches_may_stop_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
