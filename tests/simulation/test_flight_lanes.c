// Flights side by side: whatever their options and in whatever lane, each has the bits that it has
// alone.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "flight/flight_alone.h"
#include "flight/flight_lanes.h"
#include "scenario/scenario.h"
#include "state/simulation.h"

enum { FLIGHTS = 11, MOST_SETTINGS = 7 };

// The air by surface, four of them with slopes, to which more may be added.
#define SURFACES                                                                                   \
    "rocket.aerodynamics.table=", "rocket.aerodynamics.fin_cant=",                                 \
        "rocket.aerodynamics={model: surfaces, reference_diameter: 164 mm, axial: "                \
        "[[0, 0.5], [1, 0.7], [3, 0.5]], beyond_table: hold, surfaces: [{name: nose, kind: nose, " \
        "shape: ogive, at: 2.4 m, length: 0.5 "                                                    \
        "m, radius: 82 mm, body_lift: 1.1}, {name: body, kind: body, at: 1.9 m, length: 1.9 m, "   \
        "radius: 82 mm, body_lift: 1.1}, {name: tail, kind: tail, at: 0.1 m, length: 0.1 m, "      \
        "front_radius: 82 mm, rear_radius: 60 mm}, {name: canards, at: 2 m, slope: [[0, 1], "      \
        "[0.8, "                                                                                   \
        "1.3], [1.5, 0.9], [3, 0.7]]}, {name: fins, kind: fins, at: 0.3 m, fin_count: 4, "         \
        "root_chord: 0.2 "                                                                         \
        "m, tip_chord: 0.1 m, span: 0.15 m, sweep_length: 0.1 m, radius: 82 mm, cant: 0.5 deg}"

// Three rows of what burns, of which one lies within a piece of the thrust.
#define MASSES                                                                                     \
    "rocket.empty=",                                                                               \
        "rocket.motor.masses=[[0 s, 20 kg, 0.9 m, 0.06 kg.m2, 2 kg.m2], [1 s, 13 kg, 0.8 m, 0.04 " \
        "kg.m2, 1 kg.m2], [2.5 s, 1 kg, 0.7 m, 0.01 kg.m2, 0.1 kg.m2]]"

// What is set beside examples/flight.yaml; "body": a plain body in the place of its table.
static const char *const options[][MOST_SETTINGS] = {
    {NULL},
    {"rocket.eccentricity=0.3 -0.2 mm", "rocket.motor.misalignment=0.4 -0.3 mrad"},
    {"rocket.products_of_inertia=0.02 0.01 0 kg.m2", "rocket.dynamic_imbalance=1 -1 mrad"},
    {"rocket.aerodynamics.interpolation=spline", "rocket.aerodynamics.cn_scale=1.1"},
    {"rocket.aerodynamics.interpolation=linear", "rocket.aerodynamics.x_cp_shift=2 mm"},
    {"body"},
    {"rocket.aerodynamics=none"},
    {SURFACES "]}"},
    {SURFACES ", {name: strake, at: 1 m, slope: 0.4}]}", "rocket.eccentricity=0.3 -0.2 mm"},
    {SURFACES "], crossflow: {drag: 5, at: 1.2 m}}",
     "environment.wind={profile: [[0 m, 1 m/s, 2 m/s], [400 m, 5 m/s, -3 m/s], [2 km, 9 m/s, 4 "
     "m/s]]}"},
    {SURFACES ", {name: strake, at: 1 m, slope: 0.4}]}", "rocket.eccentricity=0.3 -0.2 mm",
     "environment={earth: wgs84, site: {latitude: 45 deg}, wind: {axes: geographic, profile: [[0 "
     "m, 1 m/s, 2 m/s], [2 km, 9 m/s, 4 m/s]], turbulence: {wind_at_6m: 5 m/s, harmonics: 20}}}"},
    {"rocket.motor.jet_damping=yes", "rocket.motor.exit_radius=50 mm"},
    {"rocket.motor.jet_damping=yes", "rocket.eccentricity=0.3 -0.2 mm"},
    {"rocket.motor.side_force={force: [[0.2 s, 10 N, 5 N], [1 s, -8 N, 2 N], [2 s, 0 N, 0 N]], "
     "fluctuation: {deviation: [[0 s, 20 N], [1.5 s, 0 N]], corner: 20 Hz, harmonics: 10}}",
     "rocket.motor.delay=0.05 s", "rocket.motor.rise_scale=2"},
    {"rocket.motor.nozzle=[[0 s, 0 rad, 0 rad, 0 m, 1 mm], [1 s, 1 mrad, -1 mrad, 1 mm, 0 m]]",
     "rocket.motor.jet_damping=yes", "rocket.motor.misalignment=0.4 -0.3 mrad"},
    {"environment.atmosphere={density: 1.2 kg/m3, speed_of_sound: 340 m/s}"},
    {"environment.atmosphere=none"},
    {"environment.atmosphere={profile: [[0 m, 100 kPa, 290 K], [300 m, 96.5 kPa, 287 K], [2 km, "
     "78.5 kPa, 280 K]]}",
     "environment.density_scale=0.97", "environment.temperature_offset=3 K"},
    {"environment.atmosphere={profile: [[200 m, 100 kPa, 290 K, 0.8]]}",
     "environment.wind={speed: 8 m/s, heading: 60 deg}"},
    {"environment.wind={speed: 8 m/s, heading: 60 deg}"},
    {"environment.wind={profile: [[0 m, 1 m/s, 2 m/s], [400 m, 5 m/s, -3 m/s], [2 km, 9 m/s, 4 "
     "m/s]]}"},
    {"environment.wind={speed: 4 m/s, turbulence: {wind_at_6m: 8 m/s, harmonics: 20}}"},
    {"environment.wind={gust: [{start: 1 s, rise: 0.5 s, hold: 2 s, speed: 12 m/s, heading: 90 "
     "deg}]}"},
    {"environment.earth=round"},
    {"environment={earth: wgs84, site: {latitude: 45 deg, longitude: 7 deg, azimuth: 30 deg}}"},
    {"environment={earth: wgs84, site: {latitude: 45 deg}, wind: {axes: geographic, profile: [[0 "
     "m, "
     "1 m/s, 2 m/s], [2 km, 9 m/s, 4 m/s]], turbulence: {wind_at_6m: 5 m/s, harmonics: 20}}}"},
    {"flight.velocity=330 1800 0 m/s", "flight.attitude.pitch=80 deg"},
    {"run.end=1 s"},
    {"flight.rate=32 0 20 rad/s"},
    {"flight.attitude.pitch=-5 deg", "flight.position=0 500 0 m"},
    {"flight.position=0 -5 0 m"},
    {"run.flight_limit=3 s"},
    {"run.end=apogee"},
    {"rocket.parachutes=[{name: drogue, drag_area: 0.5 m2, trigger: apogee, lag: 0.7 s, filling: "
     "0.3 "
     "s}, {name: main, drag_area: 8 m2, trigger: height, height: 300 m, filling: 1 s}]"},
    {"rocket.parachutes=[{name: only, drag_area: 3 m2, trigger: time, time: 2 s}]",
     "environment={earth: wgs84, site: {latitude: 45 deg}, wind: {speed: 4 m/s, turbulence: "
     "{wind_at_6m: 8 m/s, harmonics: 20}}}",
     "rocket.aerodynamics=none"},
    {"rocket.parachutes=[{name: low, drag_area: 3 m2, trigger: height, height: 400 m}, {name: top, "
     "drag_area: 0.2 m2, trigger: apogee}]",
     "rocket.eccentricity=0.3 -0.2 mm", "environment.earth=round"},
    {"rocket.parachutes=[{name: main, drag_area: 8 m2, trigger: apogee, filling: 0.5 s, canopy: "
     "{mass: 1 kg, line_length: 6 m, line_stiffness: 20 kN, at: 1.5 0 0 m, ejection: 8 0 0 m/s}}]"},
    {"rocket.parachutes=[{name: drogue, drag_area: 0.5 m2, trigger: apogee, filling_distance: 9 m, "
     "filling_power: 2}, {name: main, drag_area: 8 m2, trigger: height, height: 300 m, "
     "filling_distance: 20 m}]"},
    {"rocket.parachutes=[{name: main, drag_area: 8 m2, trigger: apogee, filling: 1 s, "
     "filling_power: 3}]"},
    {MASSES},
    {MASSES, "rocket.motor.jet_damping=yes", "rocket.eccentricity=0.3 -0.2 mm"},
    {MASSES, SURFACES "]}",
     "environment={earth: wgs84, site: {latitude: -33 deg}, atmosphere: {profile: [[0 m, 100 kPa, "
     "290 K], [300 m, 96.5 kPa, 287 K], [2 km, 78.5 kPa, 280 K]]}, wind: {axes: geographic, "
     "profile: [[0 m, 1 m/s, 2 m/s], [400 m, 5 m/s, -3 m/s], [900 m, 9 m/s, 4 m/s]]}}",
     "rocket.parachutes=[{name: drogue, drag_area: 0.5 m2, trigger: apogee}, {name: main, "
     "drag_area: 8 m2, trigger: height, height: 300 m, lag: 1 s}]"},
    {"rocket.air_brakes={over_time: [[3 s, 0 m2], [3.5 s, 0.02 m2], [8 s, 0.02 m2]]}"},
    {"rocket.air_brakes={over_height: [[100 m, 0 m2], [300 m, 0.02 m2]], scale: 0.9}",
     "environment={earth: wgs84, ground: -5 m, site: {latitude: 45 deg}, wind: {speed: 4 m/s, "
     "turbulence: {wind_at_6m: 8 m/s, harmonics: 20}}}",
     "rocket.aerodynamics=none"},
    {"measures=[{name: fastest, of: airspeed, take: peak, from: start, to: t_apogee}]"},
    {"measures={a: mean(mach * airspeed) / apogee, b: measure.a + largest(mach) / 1 s}"},
};

typedef struct flown {
    const ld_model *model;
    ld_simulation *simulation;
    ld_summary summary;
    ld_status status;
    ld_error error;
} flown;

typedef struct fleet {
    ld_model model[FLIGHTS];
    flown alone[FLIGHTS], beside[FLIGHTS];
    int given, done;
    flown *in_lane[FLIGHT_MOST_LANES];
} fleet;

static void take_body(ld_model *model)
{
    ld_aerodynamics *drag = &model->rocket.aerodynamics;
    drag->model = LD_AERODYNAMICS_BODY;
    drag->area = 0.02;
    drag->drag = 0.8;
    for (int i = 0; i < 3; i++) {
        drag->damping[i] = i ? -2 : -1;
        drag->lengths[i] = 2;
    }
}

// A flight that differs from the others in numbers only.
static bool vary(ld_model *model, const char *const *settings, int i)
{
    const char *set[MOST_SETTINGS] = {NULL};
    size_t count = 0;
    ld_messages messages = {0};
    bool body = settings[0] && strcmp(settings[0], "body") == 0;
    while (!body && count < MOST_SETTINGS && settings[count]) {
        set[count] = settings[count];
        count++;
    }
    if (scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", set, count, model, &messages)) {
        ld_messages_print(&messages, stderr);
        ld_messages_free(&messages);
        return false;
    }
    ld_messages_free(&messages);
    if (body)
        take_body(model);
    model->run.flight_tolerance = 1e-4;
    model->rocket.mass_error += 0.1 * i;
    model->rocket.motor.thrust_scale += 0.004 * i;
    model->rocket.aerodynamics.ca_scale += 0.01 * i;
    model->flight.pitch += 0.01 * i;
    model->flight.rate[1] += 0.05 * i;
    return true;
}

static bool next(void *self, int lane, lane_flight *flight)
{
    fleet *all = self;
    if (all->given == FLIGHTS)
        return false;
    flown *one = all->in_lane[lane] = &all->beside[all->given++];
    flight_alone_prepare(one->simulation, NULL, &flight->job, flight->state, &one->summary);
    flight->rocket = &one->summary.rocket[0];
    flight->summary = &one->summary;
    flight->error = &one->error;
    return true;
}

static void done(void *self, int lane, lane_flight *flight, ld_status status)
{
    fleet *all = self;
    all->in_lane[lane]->status = status;
    all->done++;
    (void)flight;
}

static void check_same(const flown *alone, const flown *beside, const char *how)
{
    const ld_rocket_summary *a = &alone->summary.rocket[0], *b = &beside->summary.rocket[0];
    bool same = alone->status == beside->status &&
                strcmp(alone->error.text, beside->error.text) == 0 &&
                memcmp(&a->flight, &b->flight, sizeof a->flight) == 0 &&
                memcmp(a->measure, b->measure, sizeof a->measure) == 0 &&
                memcmp(a->parachute, b->parachute, sizeof a->parachute) == 0 &&
                memcmp(a->final.center, b->final.center, sizeof a->final.center) == 0 &&
                memcmp(a->final.quaternion, b->final.quaternion, sizeof a->final.quaternion) == 0 &&
                memcmp(a->final.rate, b->final.rate, sizeof a->final.rate) == 0 &&
                alone->summary.statistics.steps == beside->summary.statistics.steps &&
                alone->summary.note_count == beside->summary.note_count &&
                strcmp(alone->summary.note[0], beside->summary.note[0]) == 0;
    if (!same)
        print_message("%s: range %.17g alone, %.17g; \"%s\", \"%s\"\n", how, a->flight.range,
                      b->flight.range, alone->error.text, beside->error.text);
    assert_true(same);
}

static ld_status take_begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)self, (void)columns, (void)count, (void)error;
    return LD_OK;
}

static ld_status take_row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)self, (void)values, (void)count, (void)error;
    return LD_OK;
}

// Of a flight with rows every step is checked, of others those that may hold something.
static void check_with_rows(const flown *alone, flown *looked)
{
    const ld_sink sink = {.begin = take_begin, .row = take_row};
    const ld_run_options wanted = {.sink = &sink};
    memset(looked, 0, sizeof *looked);
    looked->status =
        ld_simulation_run(alone->simulation, &wanted, &looked->summary, &looked->error);
    check_same(alone, looked, "with rows");
}

// Alone by ld_simulation_run, then in each width that there is.
static void check_fleet(fleet *all)
{
    const lane_source source = {next, done, all, NULL};
    for (int i = 0; i < FLIGHTS; i++) {
        flown *one = &all->alone[i];
        assert_int_equal(ld_simulation_create(&all->model[i], &one->simulation, NULL), LD_OK);
        one->status = ld_simulation_run(one->simulation, NULL, &one->summary, &one->error);
    }
    for (int i = 0; i < FLIGHTS; i += 4)
        check_with_rows(&all->alone[i], &all->beside[0]);
    for (int lanes = flight_lanes_here(); lanes > 0; lanes = lanes == 4 ? 1 : lanes / 2) {
        memset(all->beside, 0, sizeof all->beside);
        all->given = all->done = 0;
        for (int i = 0; i < FLIGHTS; i++)
            all->beside[i].simulation = all->alone[i].simulation;
        assert_int_equal(flight_lanes_fly(lanes, &source, NULL), LD_OK);
        assert_int_equal(all->done, FLIGHTS);
        for (int i = 0; i < FLIGHTS; i++) {
            const flown *alone = &all->alone[i], *beside = &all->beside[i];
            check_same(alone, beside, lanes == 1 ? "1 lane" : lanes == 4 ? "4 lanes" : "8 lanes");
            assert_int_equal(alone->summary.statistics.rhs_evaluations,
                             beside->summary.statistics.rhs_evaluations);
        }
    }
    for (int i = 0; i < FLIGHTS; i++) {
        ld_simulation_free(all->alone[i].simulation);
        model_clear(&all->model[i]);
    }
}

static void test_options(void **state)
{
    fleet *all = calloc(1, sizeof *all);
    for (size_t k = 0; k < sizeof options / sizeof *options; k++) {
        for (int i = 0; i < FLIGHTS; i++)
            assert_true(vary(&all->model[i], options[k], i));
        check_fleet(all);
    }
    free(all);
    (void)state;
}

// Flights that ask for other functions than those in the air are flown alone.
static void test_mixed(void **state)
{
    fleet *all = calloc(1, sizeof *all);
    for (int i = 0; i < FLIGHTS; i++)
        assert_true(vary(&all->model[i], options[i], i));
    check_fleet(all);
    free(all);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_options),
                                       cmocka_unit_test(test_mixed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
