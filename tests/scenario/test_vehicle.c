// Scenarios with a vehicle: every key of road, wheels, drive, suspension, tyre, platforms,
// coupling.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "scenario/scenario.h"
#include "support/model_compare.h"

static const double pi = 3.14159265358979323846;

// Reads a file of the source folder with overrides; messages fail the test.
static ld_model read_model(const char *name, const char *const *sets, size_t count)
{
    char path[512];
    ld_model model;
    ld_messages messages;
    snprintf(path, sizeof path, "%s/%s", LD_SOURCE_DIR, name);
    ld_status status = scenario_read(path, sets, count, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    return model;
}

#define READ(...)                                                                                  \
    read_model("examples/reference.yaml", (const char *const[]){__VA_ARGS__},                      \
               sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))

static void write_file(const char *path, const char *content)
{
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs(content, stream);
    fclose(stream);
}

// Prints the model, reads it again: the same bits, and the checks of hand-filled models agree.
static void check_round_trip(const ld_model *model)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ld_model_print(model, stream);
    fclose(stream);
    ld_model again;
    ld_messages messages;
    ld_error error = {0};
    ld_status status = scenario_read_text(text, length, "printed", "", NULL, 0, &again, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    assert_true(same_model(model, &again));
    if (model_check(&again, &error) != LD_OK)
        fail_msg("%s", error.text);
    model_clear(&again);
    free(text);
}

static void assert_vector(const double v[3], double x, double y, double z)
{
    assert_true(v[0] == x && v[1] == y && v[2] == z);
}

// The example's values, as written in it.
static void test_reference(void **state)
{
    (void)state;
    ld_model m = read_model("examples/reference.yaml", NULL, 0);
    const ld_vehicle *v = &m.base.vehicle;
    assert_int_equal(m.base.kind, LD_BASE_VEHICLE);
    CHECK_BELOW("speed, 30 km/h", v->speed - 30 / 3.6, 2e-15);
    assert_true(v->road.form == LD_ROAD_SUM && v->road.iso_class == 0);
    assert_true(v->road.tracks == LD_TRACKS_SAME && v->road.seed == 1 && v->road.harmonics == 400);
    assert_true(v->road.wavelengths[0] == 0.3 && v->road.wavelengths[1] == 100);
    assert_true(v->road.sine_count == 0 && v->road.bump_count == 0 && v->road.profile.rows == 0);
    assert_true(v->drive.kp == 4e4 && v->drive.ki == 1e4 && v->wheel_count == 6);
    assert_string_equal(v->wheel[4].name, "rear-left");
    assert_vector(v->wheel[4].mount, -2.5, -0.7, -1.05);
    for (int i = 0; i < 6; i++)
        assert_true(v->wheel[i].driven && v->wheel[i].mass == 220);
    assert_vector(v->suspension.stiffness, 2e6, 4e5, 2e6);
    assert_vector(v->suspension.damping, 2e4, 2.5e4, 2e4);
    assert_true(isnan(v->suspension.bump_stop.compression));
    assert_true(isnan(v->suspension.bump_stop.extension));
    assert_true(v->tyre.radius == 0.55 && v->tyre.relaxation_length == 0.3);
    assert_true(v->tyre.friction == 0.8);
    assert_vector(v->tyre.stiffness, 4e5, 1.1e6, 5e5);
    assert_vector(v->tyre.damping, 4e3, 4e3, 4e3);
    assert_true(m.platform.chassis_mass == 11000);
    assert_vector(m.platform.chassis_inertia, 9e3, 4.5e4, 4.2e4);
    const ld_turret *azimuth = &m.platform.azimuth, *elevation = &m.platform.elevation;
    assert_vector(azimuth->hinge_at, -1.2, 0.6, 0);
    assert_vector(azimuth->center, 0, 0.3, 0);
    assert_vector(azimuth->inertia, 250, 400, 250);
    assert_vector(elevation->hinge_at, -0.6, 0.7, 0);
    assert_vector(elevation->center, 0.7, 0.3, 0);
    assert_vector(elevation->inertia, 230, 470, 360);
    assert_true(azimuth->mass == 700 && elevation->mass == 900);
    const ld_stabiliser *s = &elevation->stabiliser;
    assert_true(s->command.rows == 1 && s->command.columns == 2);
    CHECK_BELOW("commanded pitch, 19.8 deg", s->command.data[1] - 19.8 * pi / 180, 1e-16);
    assert_true(s->kp == 6e6 && s->ki == 6e6 && s->kd == 4e5 && s->torque_limit == 8e4);
    assert_true(azimuth->stabiliser.kp == 4e6 && azimuth->stabiliser.command.data[1] == 0);
    assert_true(elevation->friction.viscous == 800 && elevation->friction.coulomb == 300);
    assert_true(elevation->friction.rate == 1e-3);
    assert_false(azimuth->lock.present || elevation->lock.present);
    assert_true(m.tubes.empty_count == 0 && m.run.coupling_step == 0 && m.run.lead_in == 3);
    check_round_trip(&m);
    model_clear(&m);
}

// What may be left out, and what it is then.
static void test_defaults(void **state)
{
    (void)state;
    ld_model m =
        READ("base.road=", "base.road={class: C}", "base.drive.ki=", "base.suspension.damping=",
             "base.tyre.damping=", "platform.azimuth.friction=", "platform.azimuth.stabiliser.ki=");
    const ld_vehicle *v = &m.base.vehicle;
    assert_true(v->road.iso_class == 2 && v->road.tracks == LD_TRACKS_SAME && v->road.seed == 1);
    assert_true(v->road.harmonics == 400 && v->road.wavelengths[0] == 0.3);
    assert_true(v->road.wavelengths[1] == 100 && v->drive.ki == 0 && v->wheel[5].driven);
    assert_vector(v->suspension.damping, 0, 0, 0);
    assert_vector(v->tyre.damping, 0, 0, 0);
    const ld_turret *azimuth = &m.platform.azimuth;
    assert_true(azimuth->friction.viscous == 0 && azimuth->friction.coulomb == 0);
    assert_true(azimuth->friction.rate == 1e-3 && azimuth->stabiliser.ki == 0);
    check_round_trip(&m);
    model_clear(&m);
}

static void test_roads(void **state)
{
    (void)state;
    ld_model m = READ("base.road=", "base.road={flat: true}");
    assert_true(m.base.vehicle.road.form == LD_ROAD_FLAT);
    assert_true(m.base.vehicle.road.iso_class == LD_ROAD_SMOOTH);
    check_round_trip(&m);
    model_clear(&m);
    m = READ("base.road=",
             "base.road={class: D, tracks: coherent, coherence: [[0.01 1/m, 1], [5 m-1, 20 %]], "
             "seed: 9, harmonics: 50, wavelengths: 50 2000 cm, "
             "sines: [{amplitude: 10 mm, wavelength: 2 m, phase: 90 deg}, "
             "{amplitude: -1 mm, wavelength: 50 cm}], "
             "bumps: [{at: 20 m, length: 1 m, height: 30 mm, tracks: left}, "
             "{at: -3 m, length: 50 cm, height: -10 mm, tracks: right}, "
             "{at: 2 m, length: 2 m, height: 5 mm}], "
             "table: [[-40 m, 0 mm, 1 mm], [0 m, 2 mm, 3 mm], [9 m, 0 mm, -1 mm]], "
             "places: -90 110 cm}");
    const ld_road *road = &m.base.vehicle.road;
    assert_true(road->form == LD_ROAD_SUM && road->iso_class == 3 && road->seed == 9);
    assert_true(road->tracks == LD_TRACKS_COHERENT && road->harmonics == 50);
    assert_true(road->wavelengths[0] == 0.5 && road->wavelengths[1] == 20);
    assert_true(road->coherence.rows == 2 && road->coherence.columns == 2);
    assert_true(road->coherence.data[0] == 0.01 && road->coherence.data[2] == 5);
    assert_true(road->coherence.data[1] == 1 && road->coherence.data[3] == 0.2);
    assert_true(road->sine_count == 2 && road->sine[0].amplitude == 0.01);
    assert_true(road->sine[1].wavelength == 0.5 && road->sine[1].phase == 0);
    CHECK_BELOW("phase of a sine, 90 deg", road->sine[0].phase - pi / 2, 1e-16);
    assert_true(road->bump_count == 3 && road->bump[0].at == 20 && road->bump[0].length == 1);
    assert_true(road->bump[0].height == 0.03 && road->bump[1].height == -0.01);
    assert_true(road->bump[0].tracks == LD_TRACK_LEFT && road->bump[1].tracks == LD_TRACK_RIGHT);
    assert_true(road->bump[2].tracks == LD_TRACK_BOTH);
    assert_true(road->profile.rows == 3 && road->profile.columns == 3);
    assert_true(road->profile.data[3] == 0 && road->profile.data[5] == 0.003);
    assert_true(road->places[0] == -0.9 && road->places[1] == 1.1);
    check_round_trip(&m);
    model_clear(&m);
    m = READ("base.road=",
             "base.road={tracks: independent, class: none, table: [[-40 m, 0 mm], [9 m, 2 mm]]}");
    assert_true(m.base.vehicle.road.profile.columns == 2);
    assert_true(m.base.vehicle.road.profile.data[3] == 0.002);
    assert_true(isnan(m.base.vehicle.road.places[0]) && isnan(m.base.vehicle.road.places[1]));
    check_round_trip(&m);
    model_clear(&m);
}

// Profiles and commands from files, for both tracks or each.
static void test_files(void **state)
{
    (void)state;
    write_file(LD_BINARY_DIR "/both.csv", "# measured\nx [m], h [mm]\n-40, 1\n0, 2.5\n50, 3\n");
    write_file(LD_BINARY_DIR "/each.csv", "x [km],left [mm],right [cm]\n-0.04,1,2\n0.05,3,4\n");
    write_file(LD_BINARY_DIR "/command.csv", "t [ms], angle [deg]\n-500, 10\n1500, 30\n");
    ld_model m = READ("base.road=", "base.road={table: " LD_BINARY_DIR "/both.csv}",
                      "platform.elevation.stabiliser.command=" LD_BINARY_DIR "/command.csv");
    const ld_table *profile = &m.base.vehicle.road.profile;
    const ld_table *command = &m.platform.elevation.stabiliser.command;
    assert_true(profile->rows == 3 && profile->columns == 2 && profile->data[3] == 0.0025);
    assert_true(command->rows == 2 && command->data[0] == -0.5 && command->data[2] == 1.5);
    CHECK_BELOW("command in a file, 30 deg", command->data[3] - pi / 6, 1e-16);
    check_round_trip(&m);
    model_clear(&m);
    m = READ("base.road=", "base.road={table: " LD_BINARY_DIR "/each.csv}");
    profile = &m.base.vehicle.road.profile;
    assert_true(profile->rows == 2 && profile->columns == 3 && profile->data[0] == -40);
    assert_true(profile->data[1] == 0.001 && profile->data[2] == 0.02 && profile->data[5] == 0.04);
    check_round_trip(&m);
    model_clear(&m);
}

static void test_wheels(void **state)
{
    (void)state;
    ld_model m = READ("base.drive.wheels=[rear-left, rear-right]",
                      "base.suspension.bump_stop={compression: 90 mm, stiffness: 2e6 N/m}",
                      "base.wheels.middle-left.mass=250 kg");
    const ld_vehicle *v = &m.base.vehicle;
    for (int i = 0; i < 6; i++)
        assert_int_equal(v->wheel[i].driven, i >= 4);
    assert_true(v->wheel[2].mass == 250 && v->suspension.bump_stop.stiffness == 2e6);
    assert_true(v->suspension.bump_stop.compression == 0.09);
    assert_true(isnan(v->suspension.bump_stop.extension));
    check_round_trip(&m);
    model_clear(&m);
    m = READ("base.speed=0 m/s", "base.drive.wheels=[]");
    assert_true(m.base.vehicle.speed == 0 && !m.base.vehicle.wheel[0].driven);
    check_round_trip(&m);
    model_clear(&m);
}

static void test_platforms(void **state)
{
    (void)state;
    ld_model m =
        READ("platform.azimuth.stabiliser.command=[[0 s, 0 deg], [2 s, 180 deg]]",
             "platform.elevation.stabiliser=", "platform.elevation.stabiliser.command=15 deg",
             "platform.elevation.lock={stiffness: 1e8 N.m/rad, damping: 1e5 N.m.s/rad}",
             "tubes.empty=[1, 18, 7]", "run.coupling={step: 0.1 ms}");
    const ld_turret *azimuth = &m.platform.azimuth, *elevation = &m.platform.elevation;
    assert_true(azimuth->stabiliser.command.rows == 2);
    CHECK_BELOW("commanded yaw, 180 deg", azimuth->stabiliser.command.data[3] - pi, 1e-15);
    assert_true(elevation->lock.present && elevation->lock.stiffness == 1e8);
    assert_true(elevation->lock.damping == 1e5 && isnan(elevation->stabiliser.kp));
    assert_true(m.tubes.empty_count == 3 && m.tubes.empty[1] == 18 && m.tubes.empty[2] == 7);
    assert_true(m.run.coupling_step == 1e-4);
    check_round_trip(&m);
    model_clear(&m);
}

// The marching examples are the reference launcher but for speed and title.
static void test_marching(void **state)
{
    (void)state;
    const char *const names[] = {"stationary", "15-kmh", "30-kmh"};
    for (int i = 0; i < 3; i++) {
        char name[64];
        ld_model reference = read_model("examples/reference.yaml", NULL, 0);
        snprintf(name, sizeof name, "examples/marching/%s.yaml", names[i]);
        ld_model m = read_model(name, NULL, 0);
        CHECK_BELOW("speed", m.base.vehicle.speed - i * 15 / 3.6, 2e-15);
        m.base.vehicle.speed = reference.base.vehicle.speed;
        free(m.title);
        m.title = strdup(reference.title);
        assert_true(same_model(&m, &reference));
        model_clear(&m);
        model_clear(&reference);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference), cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_roads),     cmocka_unit_test(test_files),
        cmocka_unit_test(test_wheels),    cmocka_unit_test(test_platforms),
        cmocka_unit_test(test_marching),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
