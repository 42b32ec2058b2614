// Models filled by hand: the checks that the scenario reader makes hold for them too.
#include "support/check.h"

#include <string.h>

#include "launchdyn/scenario.h"

static ld_model good_model(void)
{
    ld_model model;
    ld_messages messages;
    assert_int_equal(
        ld_scenario_read(LD_SOURCE_DIR "/tests/faults/base.yaml", NULL, 0, &model, &messages),
        LD_OK);
    return model;
}

#define REFUSED(change, text_)                                                                     \
    do {                                                                                           \
        ld_model m = good_model();                                                                 \
        ld_error error;                                                                            \
        change;                                                                                    \
        assert_int_equal(ld_model_check(&m, &error), LD_ERR_INPUT);                                \
        assert_string_equal(error.text, text_);                                                    \
        m.rocket.contact.law = LD_CONTACT_HUNT_CROSSLEY;                                           \
        ld_model_free(&m);                                                                         \
    } while (0)

static void test_good(void **state)
{
    (void)state;
    ld_model m = good_model();
    ld_error error = {0};
    assert_int_equal(ld_model_check(&m, &error), LD_OK);
    ld_model_free(&m);
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
    REFUSED(m.tubes.modes.bending = 25, "tubes.modes.bending: 25 is not from 0 to 24");
    REFUSED(m.rocket.contact.law = (ld_contact_law)9,
            "rocket.contact.law: no value of this choice");
    REFUSED(m.tubes.slot.kind = (ld_slot_kind)7, "tubes.slot: no value of this choice");
    REFUSED(m.tubes.section[0].form = (ld_section_form)5,
            "tubes.sections.1: no value of this choice");
    REFUSED(m.rocket.adaptor_count = 9, "rocket.adaptors: 9 entries, not 2 to 8");
    REFUSED(m.rocket.motor.thrust.data[3] = NAN,
            "rocket.motor.thrust: nan N is not allowed; expected >= 0 N");
    REFUSED(m.run.end = LD_END_TIME, "run.end: 0 s is not allowed; expected > 0 and <= 10000 s");
    REFUSED(memset(m.rocket.adaptor[0].name, 'a', LD_MAX_NAME),
            "rocket.adaptors.1.name: not ended by a zero");
}

static void test_rules(void **state)
{
    (void)state;
    REFUSED(m.rocket.empty.mass = 60,
            "rocket.empty.mass: 60 kg must be less than the full mass, 60 kg");
    REFUSED(m.rocket.adaptor[1].clearance = 0,
            "rocket.adaptors.2.clearance: must be > 0 m; without clearance take the contact law "
            "bilateral");
    REFUSED(m.rocket.adaptor[1].clearance = NAN,
            "rocket.adaptors.2.clearance: missing; expected a number with a unit of m, > 0 m");
    REFUSED(m.tubes.section[0].mass_per_length = NAN,
            "tubes.sections.1: its stiffnesses and masses are not computed; call "
            "ld_model_complete()");
    REFUSED(m.rocket.propellant = NAN, "rocket.propellant: not computed; call ld_model_complete()");
    REFUSED(m.run.stuck_time = NAN, "run.stuck_time: not computed; call ld_model_complete()");
}

// A fresh model lacks what has no default, and says so.
static void test_defaults(void **state)
{
    (void)state;
    ld_model m;
    ld_error error;
    ld_model_init(&m);
    assert_int_equal(m.tubes.modes.bending, 6);
    assert_int_equal(m.tubes.modes.torsion, 2);
    assert_int_equal(m.tubes.modes.elements, 60);
    assert_true(m.run.tolerance == 1e-5 && m.run.output_step_tube == 1e-4);
    assert_true(m.gravity == 9.80665 && m.firing_count == 1 && m.firing[0].tube == 1);
    assert_true(isnan(m.rocket.full.mass));
    assert_int_equal(ld_model_check(&m, &error), LD_ERR_INPUT);
    assert_string_equal(error.text,
                        "tubes.length: nan m is not allowed; expected > 0 and <= 100 m");
    ld_model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_rules),
        cmocka_unit_test(test_defaults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
