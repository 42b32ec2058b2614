// Models filled by hand: the checks that the scenario reader makes hold for them too.
#include "model/model.h"
#include "support/check.h"

#include <string.h>

#include "scenario/scenario.h"

static ld_model good_model(const char *file)
{
    ld_model model;
    ld_messages messages;
    assert_int_equal(scenario_read(file, NULL, 0, &model, &messages), LD_OK);
    return model;
}

#define FIXED LD_SOURCE_DIR "/tests/faults/base.yaml"
#define VEHICLE LD_SOURCE_DIR "/tests/faults/vehicle.yaml"
#define REFUSED(change, text_) REFUSED_OF(FIXED, change, text_)
#define REFUSED_OF(file, change, text_)                                                            \
    do {                                                                                           \
        ld_model m = good_model(file);                                                             \
        ld_error error;                                                                            \
        change;                                                                                    \
        assert_int_equal(model_check(&m, &error), LD_ERR_INPUT);                                   \
        assert_string_equal(error.text, text_);                                                    \
        m.rocket.contact.law = LD_CONTACT_HUNT_CROSSLEY;                                           \
        model_clear(&m);                                                                           \
    } while (0)

static void test_good(void **state)
{
    (void)state;
    const char *const files[] = {FIXED, VEHICLE};
    for (int i = 0; i < 2; i++) {
        ld_model m = good_model(files[i]);
        ld_error error = {0};
        assert_int_equal(model_check(&m, &error), LD_OK);
        model_clear(&m);
    }
}

static void test_values(void **state)
{
    (void)state;
    REFUSED(m.rocket.full.mass = -1, "rocket.mass: -1 kg is not allowed; expected > 0 kg");
    REFUSED(m.rocket.full.mass = NAN, "rocket.mass: nan kg is not allowed; expected > 0 kg");
    REFUSED(m.gravity = INFINITY,
            "environment.gravity: inf m/s2 is not allowed; expected from 0 to 100 m/s2");
    REFUSED(m.tubes.support[1].stiffness[2] = -5,
            "tubes.supports.2.stiffness: -5 N/m is not allowed; expected >= 0 N/m");
    REFUSED(m.tubes.modes.bending = 25, "tubes.modes.bending: 25 is not from 1 to 24");
    REFUSED(m.rocket.contact.law = (ld_contact_law)9,
            "rocket.contact.law: not a value of this choice");
    REFUSED(m.tubes.slot.kind = (ld_slot_kind)7, "tubes.slot: not a value of this choice");
    REFUSED(m.tubes.section[0].form = (ld_section_form)5,
            "tubes.sections.1: not a value of this choice");
    REFUSED(m.rocket.adaptor_count = 9, "rocket.adaptors: 9 entries, not 2 to 8");
    REFUSED(m.rocket.motor.thrust.data[3] = NAN, "rocket.motor.thrust: nan N is not allowed");
    REFUSED(m.run.end = LD_END_TIME, "run.end: 0 s is not allowed; expected > 0 and <= 10000 s");
    REFUSED(memset(m.rocket.adaptor[0].name, 'a', LD_MAX_NAME),
            "rocket.adaptors.1.name: not terminated by a zero");
}

static void test_rules(void **state)
{
    (void)state;
    REFUSED(m.rocket.empty.mass = 60.5,
            "rocket.empty.mass: 60.5 kg is more than the full mass, 60 kg");
    REFUSED(m.rocket.adaptor[1].clearance = 0, "rocket.adaptors.2.clearance: must be > 0 m; "
                                               "without clearance use the contact law bilateral");
    REFUSED(m.rocket.adaptor[1].clearance = NAN,
            "rocket.adaptors.2.clearance: missing; expected a number with a unit of m, > 0 m");
    REFUSED(m.tubes.section[0].mass_per_length = NAN,
            "tubes.sections.1: its stiffnesses and masses are not computed; call "
            "model_complete()");
    REFUSED(m.rocket.propellant = NAN, "rocket.propellant: not computed; call model_complete()");
    REFUSED(m.run.stuck_time = NAN, "run.stuck_time: not computed; call model_complete()");
    REFUSED(m.run.max_step = NAN, "run.max_step: not computed; call model_complete()");
}

static void test_vehicle(void **state)
{
    (void)state;
    REFUSED_OF(VEHICLE, m.base.vehicle.speed = -1,
               "base.speed: -1 m/s is not allowed; expected from 0 to 1000 m/s");
    REFUSED_OF(VEHICLE, m.base.vehicle.wheel[1].mount[2] = NAN,
               "base.wheels.2.mount: nan m is not allowed; expected from -1000 to 1000 m");
    REFUSED_OF(VEHICLE, m.base.vehicle.road.iso_class = -2,
               "base.road.class: not a value of this choice");
    REFUSED_OF(VEHICLE, m.base.vehicle.road.iso_class = 8,
               "base.road.class: not a value of this choice");
    REFUSED_OF(VEHICLE, m.base.vehicle.road.form = (ld_road_form)2,
               "base.road: not a value of this choice");
    REFUSED_OF(VEHICLE, m.base.vehicle.road.iso_class = LD_ROAD_SMOOTH,
               "base.road: it has no height: give class, sines, bumps or table, or flat: true");
    REFUSED_OF(VEHICLE, m.base.vehicle.road.tracks = LD_TRACKS_COHERENT,
               "base.road.coherence: missing; coherent tracks require the table of g over spatial "
               "frequency");
    REFUSED_OF(VEHICLE, m.base.vehicle.road.wavelengths[1] = 0.1,
               "base.road.wavelengths: the shortest, 0.3 m, must be less than the longest, 0.1 m");
    REFUSED_OF(VEHICLE, for (int i = 0; i < 4; i++) m.base.vehicle.wheel[i].driven = false,
               "base.drive.wheels: no wheel is driven; a speed of 10 m/s requires one");
    REFUSED_OF(VEHICLE, m.platform.elevation.mass = NAN,
               "platform.elevation.mass: nan kg is not allowed; expected > 0 kg");
    REFUSED_OF(VEHICLE, m.platform.elevation.stabiliser.command.data[1] = 1.56,
               "platform.elevation.stabiliser.command: 89.3814 deg; a pitch command must lie "
               "between -89 and 89 deg");
    REFUSED_OF(VEHICLE, m.platform.azimuth.stabiliser.command.columns = 3,
               "platform.azimuth.stabiliser.command: does not have the required columns");
    REFUSED_OF(VEHICLE, m.platform.azimuth.stabiliser.kd = NAN,
               "platform.azimuth.stabiliser: missing: kd; only a hinge with a lock does without");
    REFUSED_OF(VEHICLE, m.platform.azimuth.lock.present = true,
               "platform.azimuth.lock.stiffness: nan N.m/rad is not allowed; expected > 0 N.m/rad");
    REFUSED_OF(VEHICLE, m.tubes.empty_count = 513, "tubes.empty: 513 numbers, not 0 to 512");
    REFUSED_OF(VEHICLE, (m.tubes.empty_count = 1, m.tubes.empty[0] = 0),
               "tubes.empty: 0 is not from 1 to 10000");
    REFUSED_OF(VEHICLE, (m.tubes.empty_count = 1, m.tubes.empty[0] = 1),
               "firing.1.tube: 1 has no rocket: tubes.empty lists it");
    REFUSED_OF(VEHICLE, m.run.coupling_step = 0.02,
               "run.coupling.step: 0.02 s is not allowed; expected from 0 to 0.01 s");
    REFUSED(m.run.coupling_step = 1e-4,
            "run.coupling: requires base.kind: vehicle or multibody; other bases have no "
            "subsystems to couple");
}

// A fresh model lacks what has no default, and says so.
static void test_defaults(void **state)
{
    (void)state;
    ld_model m;
    ld_error error;
    model_init(&m);
    assert_int_equal(m.tubes.modes.bending, 7);
    assert_int_equal(m.tubes.modes.torsion, 4);
    assert_int_equal(m.tubes.modes.elements, 60);
    assert_true(m.run.tolerance == 1e-5 && m.run.output_step_tube == 1e-4);
    assert_true(m.gravity == 9.80665 && m.firing_count == 1 && m.firing[0].tube == 1);
    assert_true(isnan(m.rocket.full.mass));
    assert_int_equal(model_check(&m, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "environment.ground: not computed; call model_complete()");
    model_complete(&m);
    assert_int_equal(model_check(&m, &error), LD_ERR_INPUT);
    assert_string_equal(error.text,
                        "tubes.length: nan m is not allowed; expected > 0 and <= 100 m");
    model_clear(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good),     cmocka_unit_test(test_values),
        cmocka_unit_test(test_rules),    cmocka_unit_test(test_vehicle),
        cmocka_unit_test(test_defaults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
