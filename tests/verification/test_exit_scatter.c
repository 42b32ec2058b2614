// By what a road scatters the exit, from the linear response, against whole runs: on a road so low
// that a launch is linear in it, and on the very roads that are sampled; and the states in which
// these launches begin.
// ctest: slow
#include <stdlib.h>

#include "base/random.h"
#include "environment/road.h"
#include "launchdyn/response.h"
#include "launchdyn/summary.h"
#include "model/model.h"
#include "state/linearise.h"
#include "support/check.h"
#include "support/fresh_launch.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double quarter = 1.5707963267948966;

static const char *const names[] = {
    "t_rear",     "exit_speed", "pitch",         "pitch_rate",
    "tip_off.vy", "tip.y",      "tip_off.pitch", "tip_off.pitch_rate_relative",
};
enum { FIGURES = sizeof names / sizeof *names, SPEED = 5 };

static void numbers_of(const ld_summary *summary, const char *const *wanted, int count,
                       double *value)
{
    ld_error error;
    for (int i = 0; i < count; i++) {
        char name[64];
        snprintf(name, sizeof name, "rocket.1.%s", wanted[i]);
        if (ld_summary_number(summary, name, &value[i], &error))
            fail_msg("%s", error.text);
    }
}

// One low sine of 8 Hz on both tracks, its phase at the ignition being `phase`.
static void put_on_sine(ld_model *model, double phase)
{
    ld_road *under = &model->base.vehicle.road;
    under->form = LD_ROAD_SUM;
    under->sine_count = 1;
    under->sine[0] = (ld_road_sine){1e-5, SPEED / 8.0, phase};
}

static void make_model(ld_model *model)
{
    reference_vehicle(model, SPEED);
    model->tubes.modes.bending = 2;
    model->tubes.modes.torsion = 1;
    model->platform.azimuth.friction.coulomb = model->platform.elevation.friction.coulomb = 0;
    model->rocket.contact.friction = 0;
    model->run.tolerance = 1e-10;
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

// The exit's figures are y + Re(Y e^(i phase)): runs at four phases report |Y|, the deviation over
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
    model.run.lead_in = 4;
    for (int k = 0; k < 4; k++) {
        put_on_sine(&model, k * quarter);
        ld_summary summary = summary_of_run(&model);
        numbers_of(&summary, names, FIGURES, value[k]);
    }
    for (int i = 0; i < FIGURES; i++) {
        double whole = hypot(value[0][i] - value[2][i], value[1][i] - value[3][i]) / 2 / sqrt(2);
        double rest = (value[0][i] + value[1][i] + value[2][i] + value[3][i]) / 4;
        printf("    %-28s %12.6g %12.6g, runs %12.6g %12.6g\n", names[i], mean[i], deviation[i],
               rest, whole);
        worst = fmax(worst, fabs(deviation[i] / whole - 1));
        whole_of_t_rear = i == 0 ? whole : whole_of_t_rear;
    }
    CHECK_BELOW("8 deviations against runs, relative", worst, 5e-4);
    CHECK_BELOW("that of t_rear", deviation[0] / whole_of_t_rear - 1, 1e-5);
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

// ---- a rough road

static const char *const rough_names[] = {
    "t_release", "t_rear",        "exit_speed",  "pitch",      "yaw",       "pitch_rate",
    "yaw_rate",  "tip_off.pitch", "tip_off.yaw", "tip_off.vy", "tip_off.vz"};
enum { ROUGH = sizeof rough_names / sizeof *rough_names, ROUGH_DRAWS = 6 };

static void make_rough(ld_model *model)
{
    ld_road *under = &model->base.vehicle.road;
    reference_vehicle(model, SPEED);
    *under = (ld_road){.form = LD_ROAD_SUM,
                       .iso_class = 1,
                       .tracks = LD_TRACKS_INDEPENDENT,
                       .seed = 7,
                       .harmonics = 40,
                       .wavelengths = {0.5, 60},
                       .places = {NAN, NAN}};
    model->platform.azimuth.friction.coulomb = model->platform.elevation.friction.coulomb = 0;
    model->run.lead_in = 4;
    model->run.end = LD_END_TIP;
}

// The road of a draw as a profile: each sine of variance `square` has its drawn phase on each
// track.
static void put_drawn_road(ld_model *model, const road_line *line, size_t lines, int draw,
                           double *point, size_t points)
{
    ld_road *under = &model->base.vehicle.road;
    uint64_t seed = (uint64_t)under->seed, stream = random_stream("exit");
    for (size_t i = 0; i < points; i++) {
        double x = -SPEED * model->run.lead_in - 4 + 0.04 * (double)i, h[2] = {0};
        for (size_t k = 0; k < lines; k++)
            for (int track = 0; track < 2; track++) {
                uint64_t column = 4 * k + 2 * (uint64_t)track;
                double phase = random_uniform(seed, stream, (uint64_t)draw, column, 0);
                h[track] += sqrt(2 * line[k].square) * cos(4 * quarter * (line[k].n * x + phase));
            }
        memcpy(point + 3 * i, (double[]){x, h[0], h[1]}, 3 * sizeof *point);
    }
    under->iso_class = LD_ROAD_SMOOTH;
    under->profile = (ld_table){points, 3, point};
}

// Each draw against the run that marches over its road for 4 s: their means, and the deviations.
static void draws_are_the_runs_on_their_roads(void **state)
{
    (void)state;
    enum { POINTS = 750 };
    ld_model model;
    ld_error error;
    size_t lines;
    road_line *line;
    double point[3 * POINTS], value[ROUGH_DRAWS][ROUGH], mean[ROUGH], deviation[ROUGH];
    double worst = 0, off = 0;
    make_rough(&model);
    ld_response *response = respond(&model);
    if (ld_response_exit(response, SPEED, ROUGH_DRAWS, rough_names, ROUGH, mean, deviation,
                         &error) ||
        road_lines(&model.base.vehicle.road, &line, &lines, &error))
        fail_msg("%s", error.text);
    ld_response_free(response);
    for (int k = 0; k < ROUGH_DRAWS; k++) {
        put_drawn_road(&model, line, lines, k, point, POINTS);
        ld_summary summary = summary_of_run(&model);
        numbers_of(&summary, rough_names, ROUGH, value[k]);
    }
    for (int i = 0; i < ROUGH; i++) {
        double sum = 0, square = 0;
        for (int k = 0; k < ROUGH_DRAWS; k++)
            sum += value[k][i] / ROUGH_DRAWS;
        for (int k = 0; k < ROUGH_DRAWS; k++)
            square += pow(value[k][i] - sum, 2) / (ROUGH_DRAWS - 1);
        double whole = sqrt(square);
        printf("    %-28s %12.6g %12.6g, runs %12.6g %12.6g\n", rough_names[i], mean[i],
               deviation[i], sum, whole);
        worst = fmax(worst, fabs(deviation[i] / whole - 1));
        off = fmax(off, fabs(mean[i] - sum) / whole);
    }
    CHECK_BELOW("11 deviations against runs on the same roads, relative", worst, 4e-3);
    CHECK_BELOW("their means, of a deviation", off, 3e-3);
    free(line);
    model.base.vehicle.road.profile = (ld_table){0};
    reference_model_free(&model);
}

// ---- states beside the equilibrium

// Chassis, tube and rocket turned by one unit about the chassis' x axis as one rigid body, to the
// first order.
static void rigid_roll(const launch_state *state, const linear_system *system, double *change)
{
    const launching_layout *at = &state->launcher.launching.layout;
    const double *y = system->y;
    v3 axis = v3_make(1, 0, 0);
    v3 arm = v3_sub(v3_from(y + at->r), v3_from(y + state->launcher.base_at + VEHICLE_R));
    memset(change, 0, (size_t)system->count * sizeof *change);
    v3_store(change, v3_cross(axis, arm));
    v3_store(change + 3, m3_apply_transposed(q_matrix(q_from(y + at->quaternion)), axis));
    change[system->tube + system->rocket + 3] = 1;
}

// Supports feel nothing of a roll: what tube and rocket are accelerated by bends only by gravity's
// turning, by some g angle^2.
static void a_rolled_launcher_strains_no_support(void **state)
{
    (void)state;
    const double roll = 4e-3;
    ld_model model;
    ld_error error;
    fresh_launch fresh;
    linear_system system;
    double change[2 * LD_MAX_STATES], y[LD_MAX_STATES], rate[3][2 * LD_MAX_STATES], bend = 0;
    reference_vehicle(&model, SPEED);
    fresh_launch_make(&fresh, &model);
    assert_int_equal(linear_rest(&fresh.state, &system, &error), LD_OK);
    rigid_roll(&fresh.state, &system, change);
    for (int k = 0; k < 3; k++) {
        linear_displace_all(&fresh.state, &system, change, (k - 1) * roll, y);
        assert_int_equal(linear_rates(&fresh.state, &system, y, rate[k]), 0);
    }
    for (int i = system.half; i < system.half + system.tube + system.rocket; i++)
        bend = fmax(bend, fabs(rate[0][i] - 2 * rate[1][i] + rate[2][i]) / 2);
    CHECK_BELOW("bend of accelerations by a roll of 4 mrad [m/s2, ...]", bend, 2e-4);
    fresh_launch_free(&fresh);
    reference_model_free(&model);
}

// A launcher that is rolled and rolls on, its tube displaced on the supports: tube and rocket move
// with the chassis as one rigid body, to the second order, too.
static void a_rolling_launcher_moves_as_one(void **state)
{
    (void)state;
    const double share = 4e-3; // [rad], [rad/s], [m]
    ld_model model;
    ld_error error;
    fresh_launch fresh;
    linear_system system;
    double change[2 * LD_MAX_STATES], y[LD_MAX_STATES];
    reference_vehicle(&model, SPEED);
    fresh_launch_make(&fresh, &model);
    assert_int_equal(linear_rest(&fresh.state, &system, &error), LD_OK);
    const launcher_system *launcher = &fresh.state.launcher;
    const launching_layout *at = &launcher->launching.layout;
    rigid_roll(&fresh.state, &system, change);
    change[1] += 1; // [m] up
    m3 A = q_matrix(q_from(system.y + at->quaternion));
    v3 center = v3_from(system.y + launcher->base_at + VEHICLE_R), axis = v3_make(1, 0, 0);
    v3 nozzle = launching_rocket_point(&launcher->launching, system.y, v3_zero());
    v3 places[2] = {v3_from(system.y + at->r), nozzle};
    int first[2] = {system.half, system.half + system.tube};
    for (int i = 0; i < 2; i++) {
        v3 v = v3_cross(axis, v3_sub(places[i], center));
        v3_store(change + first[i], m3_apply_transposed(A, v));
        v3_store(change + first[i] + 3, m3_apply_transposed(A, axis));
    }
    change[system.half + system.tube + system.rocket + 3] = 1;
    linear_displace_all(&fresh.state, &system, change, share, y);
    A = q_matrix(q_from(y + at->quaternion));
    v3 along = v3_from(y + launcher->base_at + VEHICLE_V), w = v3_scale(share, axis);
    nozzle = launching_rocket_point(&launcher->launching, y, v3_zero());
    center = v3_from(y + launcher->base_at + VEHICLE_R);
    v3 now[2] = {v3_from(y + at->r), nozzle}, told[2] = {v3_from(y + at->v), v3_from(y + at->V)};
    for (int i = 0; i < 2; i++) {
        v3 v = m3_apply_transposed(A, v3_add(along, v3_cross(w, v3_sub(now[i], center))));
        CHECK_BELOW(i ? "speed of the rocket [m/s]" : "speed of the tube [m/s]",
                    v3_norm(v3_sub(told[i], v)), 5e-8);
    }
    fresh_launch_free(&fresh);
    reference_model_free(&model);
}

// All unknowns at once are the unknowns one by one but for what is of the second order.
static void all_at_once_are_each_to_the_first_order(void **state)
{
    (void)state;
    const double share[2] = {1e-3, 5e-4};
    ld_model model;
    ld_error error;
    fresh_launch fresh;
    linear_system system;
    double change[2 * LD_MAX_STATES], all[LD_MAX_STATES], each[LD_MAX_STATES], off[2] = {0};
    reference_vehicle(&model, SPEED);
    fresh_launch_make(&fresh, &model);
    assert_int_equal(linear_rest(&fresh.state, &system, &error), LD_OK);
    for (int i = 0; i < system.count; i++)
        change[i] = sin(1.7 * i + 1);
    for (int k = 0; k < 2; k++) {
        linear_displace_all(&fresh.state, &system, change, share[k], all);
        memcpy(each, system.y, sizeof each);
        for (int i = 0; i < system.count; i++)
            linear_displace(&fresh.state, &system, i, share[k] * change[i], each);
        for (int i = 0; i < fresh.state.launcher.state_count; i++)
            off[k] = fmax(off[k], fabs(all[i] - each[i]));
    }
    CHECK_NEAR("half the change: a quarter of the difference", off[0] / off[1], 4, 0.005);
    fresh_launch_free(&fresh);
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
    assert_string_equal(error.text, "\"range\" is a result of the flight, not of the exit");
    assert_int_equal(ld_response_exit(response, SPEED, 1, &name, 1, &mean, &deviation, &error),
                     LD_ERR_INPUT);
    assert_string_equal(error.text, "found 1 draws, expected 0 (none) or at least 2");
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
        cmocka_unit_test(draws_are_the_runs_on_their_roads),
        cmocka_unit_test(a_rolled_launcher_strains_no_support),
        cmocka_unit_test(a_rolling_launcher_moves_as_one),
        cmocka_unit_test(all_at_once_are_each_to_the_first_order),
        cmocka_unit_test(what_there_is_not_is_told),
        cmocka_unit_test(who_watches_may_stop_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
