// Launches that cannot happen: each ends with the right status, one clear sentence, and the history
// up to there.
#include "support/expected_launch.h"

static const double degree = 3.14159265358979323846 / 180;

#define STOPS(name, t_end, status, sentence, ...)                                                  \
    static void name(void **state)                                                                 \
    {                                                                                              \
        (void)state;                                                                               \
        ld_model model;                                                                            \
        listener ear = {0};                                                                        \
        reference_model(&model);                                                                   \
        __VA_ARGS__;                                                                               \
        check_stopped(&model, &ear, status, sentence, t_end);                                      \
    }

STOPS(thrust_below_the_release_force, 0.5, LD_ERR_LAUNCH,
      "the lock never released: it carried at most # N of the release force 20000 N by # s after "
      "ignition",
      model.rocket.lock.release_force = 2e4;
      model.run.stuck_time = 0.5)

STOPS(too_little_thrust, 0.3, LD_ERR_LAUNCH,
      "the rocket is stuck in the tube: its rear adaptor is at # m of 3 m, # s after ignition",
      model.rocket.motor.thrust_scale = 0.015;
      model.rocket.lock.release_force = 1; model.run.stuck_time = 0.3)

STOPS(no_thrust_and_no_lock, 0.3, LD_ERR_LAUNCH,
      "the rocket is stuck in the tube: its rear adaptor is at # m of 3 m, # s after ignition",
      model.rocket.motor.thrust_scale = 1e-9;
      model.rocket.lock.present = false; model.run.stuck_time = 0.3)

STOPS(breech_like_butter, 0.430877, LD_ERR_LAUNCH,
      "the rocket is # m behind the breech at t = # s: a contact of 100 N/m does not hold it",
      model.tubes.slot.kind = LD_SLOT_NONE;
      model.rocket.motor.thrust_scale = 1e-9; model.rocket.contact.law = LD_CONTACT_BILATERAL;
      model.rocket.contact.stiffness = 100; model.rocket.contact.damping = 0;
      model.run.start = LD_START_UNDEFORMED; model.rocket.lock.present = false)

STOPS(steep_rough_slot, 0.0038138, LD_ERR_LAUNCH,
      "the knob jams in the slot at t = # s: with this angle and friction no slot force fulfils "
      "the constraint",
      model.tubes.slot.angle.data[1] = 60 * degree;
      model.tubes.slot.friction = 1)

STOPS(steep_rough_slot_in_the_overall_form, 0.0038138, LD_ERR_LAUNCH,
      "the knob jams in the slot at t = # s: with this angle and friction no slot force fulfils "
      "the constraint",
      model.tubes.slot.angle.data[1] = 60 * degree;
      model.tubes.slot.friction = 1; model.run.formulation = LD_FORMULATION_OVERALL)

STOPS(tube_like_rubber, 0.0655223, LD_ERR_NUMERIC,
      "the tube bends beyond small deflections at t = # s: 3 m from its rear end it is # m off its "
      "axis",
      model.tubes.section[0].bending_stiffness *= 1e-4)

STOPS(tube_like_rope, 0.0838698, LD_ERR_NUMERIC,
      "the tube bends beyond small deflections at t = # s: # m from its rear end it is # m off its "
      "axis",
      model.tubes.section[0].bending_stiffness *= 1e-6;
      model.run.start = LD_START_UNDEFORMED)

STOPS(violent_base, 0.001, LD_ERR_NUMERIC,
      "the tube bends beyond small deflections at t = # s: 3 m from its rear end it is # m off its "
      "axis",
      model.base.kind = LD_BASE_PRESCRIBED;
      model.base.pitch = (ld_sines){1, {{3, 50, 0}}})

STOPS(contacts_like_tar, 0.0002, LD_ERR_NUMERIC,
      "the steps became too short to continue: more than 20000 steps within a millisecond, up to t "
      "= # s",
      model.rocket.contact.reference_speed = 1e-7)

STOPS(contacts_like_honey, 0.00458, LD_ERR_NUMERIC,
      "the steps are too short to continue: # steps for # s, up to t = # s; check for a contact, "
      "damper or friction that is far too stiff",
      model.rocket.contact.reference_speed = 3e-6)

STOPS(thrust_not_a_number, 0.01, LD_ERR_NUMERIC,
      "the equations of motion gave no finite result at t = # s",
      model.rocket.motor.thrust.data[5] = NAN)

STOPS(base_table_too_short, 0.1, LD_ERR_LAUNCH,
      "base.motion.table: goes from 0 s to # s, which does not cover the launch (now at t = # s)",
      model.base.kind = LD_BASE_PRESCRIBED;
      model.base.motion = reference_table(3, 7, (double[]){0, 0, 0, 0,   0, 0, 0, 0.05, 0, 0, 0,
                                                           0, 0, 0, 0.1, 0, 0, 0, 0,    0, 0}))

STOPS(caller_says_no, 0.0525, LD_ERR_INTERRUPTED, "interrupted at t = # s", ear.stop_at = 0.3)

STOPS(receiver_of_rows_fails, 0.0097, LD_ERR_FILE, "the disk is full",
      (ear.fail_at = 100, ear.failure = LD_ERR_FILE))

STOPS(receiver_of_rows_fails_silently, 0, LD_ERR_FILE, "the receiver of the rows stopped the run",
      (ear.fail_at = 1, ear.failure = LD_ERR_FILE, ear.silent = true))

// Turned so hard by the air that its flight would continue by nanoseconds; the launch is reported.
static void rocket_like_a_parachute(void **state)
{
    (void)state;
    ld_model model;
    listener ear = {0};
    outcome out;
    reference_model(&model);
    model.run.end = LD_END_LANDING;
    model.rocket.aerodynamics = (ld_aerodynamics){.present = true,
                                                  .model = LD_AERODYNAMICS_BODY,
                                                  .area = 1000,
                                                  .damping = {-400, -400, -400},
                                                  .lengths = {40, 40, 40}};
    run(&model, &ear, &out);
    printf("    %s\n", out.error.text);
    assert_int_equal(out.status, LD_ERR_NUMERIC);
    assert_true(matches(out.error.text, "the flight's steps are too short to continue: # steps for "
                                        "# s, up to t = # s; check aerodynamics and inertia"));
    assert_string_equal(out.summary.stopped, out.error.text);
    CHECK_BELOW("rear adaptor out [s]", out.summary.rocket[0].t_rear - 0.1595, 1e-3);
}

static void base_table_begins_too_late(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.base.kind = LD_BASE_PRESCRIBED;
    model.base.motion =
        reference_table(2, 7, (double[]){0.01, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0});
    check_no_start(&model, LD_ERR_LAUNCH,
                   "base.motion.table: goes from 0.01 s to 1 s, which does not cover the launch "
                   "(now at t = 0 s)");
}

static void one_adaptor_holds_no_rocket(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.rocket.start_at = 2.9;
    check_no_start(&model, LD_ERR_LAUNCH,
                   "rocket.start_at: no static equilibrium at the start: only the rear adaptor is "
                   "in the tube; \"run.start: undeformed\" starts without it");
}

// The first rocket starts without an equilibrium; the next tube must find one.
static void one_adaptor_holds_no_next_rocket(void **state)
{
    (void)state;
    ld_model model;
    listener ear = {0};
    outcome out;
    reference_model(&model);
    model.rocket.start_at = 2.9;
    model.run.start = LD_START_UNDEFORMED;
    model.firing[1] = (ld_firing){2, 0.3};
    model.firing_count = 2;
    run(&model, &ear, &out);
    printf("    %s\n", out.error.text);
    assert_int_equal(out.status, LD_ERR_LAUNCH);
    assert_true(matches(out.error.text,
                        "rocket.start_at: tube 2 has no static equilibrium when it "
                        "takes over, t = # s: only the rear adaptor is in the tube"));
    assert_true(isfinite(out.summary.rocket[0].t_rear));
    assert_true(ear.ascending && ear.last == out.summary.t_end);
}

static void no_equilibrium_of_a_rope(void **state)
{
    (void)state;
    ld_model model;
    listener ear = {0};
    outcome out;
    reference_model(&model);
    model.tubes.section[0].bending_stiffness *= 1e-6;
    run(&model, &ear, &out);
    printf("    %s\n", out.error.text);
    assert_int_equal(out.status, LD_ERR_NUMERIC);
    assert_non_null(strstr(out.summary.stopped, "run.start: no static equilibrium was found"));
    assert_int_equal(ear.rows, 0);
}

// Before its ignition a rocket that nothing locks slides out of a tube that points down.
static void falls_out_of_the_tube(void **state)
{
    (void)state;
    ld_model model;
    outcome out;
    listener ear = {0};
    reference_model(&model);
    model.base.elevation = -60 * degree;
    model.rocket.lock.present = false;
    model.run.lead_in = 2;
    run(&model, &ear, &out);
    printf("    %s\n", out.error.text);
    assert_int_equal(out.status, LD_ERR_LAUNCH);
    assert_true(matches(out.error.text, "the rocket slid out of the tube's tip at t = # s, # s "
                                        "before its ignition"));
    assert_true(ear.last == out.summary.t_end);
    CHECK_WITHIN("left the tube at [s]", out.summary.rocket[0].t_rear, -1.4, -1);
}

// Not failures: launches that look odd but happen.
#define HAPPENS(name, ...)                                                                         \
    static void name(void **state)                                                                 \
    {                                                                                              \
        (void)state;                                                                               \
        ld_model model;                                                                            \
        reference_model(&model);                                                                   \
        __VA_ARGS__;                                                                               \
        check_happens(#name, &model);                                                              \
    }

HAPPENS(without_gravity, model.gravity = 0)
// its equilibrium presses the contacts in by less than a nanometre
HAPPENS(with_contacts_like_rock, model.rocket.contact.stiffness = 1e12)
HAPPENS(straight_up, model.base.elevation = 90 * degree)
HAPPENS(downwards, model.base.elevation = -30 * degree)
HAPPENS(mass_centre_before_the_front_adaptor,
        model.rocket.full.center[0] = model.rocket.empty.center[0] = 2.2)
HAPPENS(mass_centre_behind_the_rear_adaptor,
        model.rocket.full.center[0] = model.rocket.empty.center[0] = -0.3)

static void adaptors_in_any_order(void **state)
{
    (void)state;
    ld_model model;
    outcome out[2];
    for (int i = 0; i < 2; i++) {
        listener ear = {0};
        reference_model(&model);
        if (i) {
            ld_adaptor swap = model.rocket.adaptor[1];
            model.rocket.adaptor[1] = model.rocket.adaptor[2];
            model.rocket.adaptor[2] = swap;
        }
        run(&model, &ear, &out[i]);
        assert_int_equal(out[i].status, LD_OK);
    }
    const ld_rocket_summary *a = &out[0].summary.rocket[0], *b = &out[1].summary.rocket[0];
    CHECK_BELOW("t_front [s]", a->t_front - b->t_front, 1e-10);
    CHECK_BELOW("t_middle [s]", a->t_middle - b->t_middle, 1e-10);
    CHECK_BELOW("t_rear [s]", a->t_rear - b->t_rear, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thrust_below_the_release_force),
        cmocka_unit_test(too_little_thrust),
        cmocka_unit_test(no_thrust_and_no_lock),
        cmocka_unit_test(breech_like_butter),
        cmocka_unit_test(steep_rough_slot),
        cmocka_unit_test(steep_rough_slot_in_the_overall_form),
        cmocka_unit_test(tube_like_rubber),
        cmocka_unit_test(tube_like_rope),
        cmocka_unit_test(violent_base),
        cmocka_unit_test(contacts_like_tar),
        cmocka_unit_test(contacts_like_honey),
        cmocka_unit_test(one_adaptor_holds_no_next_rocket),
        cmocka_unit_test(rocket_like_a_parachute),
        cmocka_unit_test(thrust_not_a_number),
        cmocka_unit_test(base_table_too_short),
        cmocka_unit_test(caller_says_no),
        cmocka_unit_test(receiver_of_rows_fails),
        cmocka_unit_test(receiver_of_rows_fails_silently),
        cmocka_unit_test(base_table_begins_too_late),
        cmocka_unit_test(one_adaptor_holds_no_rocket),
        cmocka_unit_test(no_equilibrium_of_a_rope),
        cmocka_unit_test(falls_out_of_the_tube),
        cmocka_unit_test(without_gravity),
        cmocka_unit_test(with_contacts_like_rock),
        cmocka_unit_test(straight_up),
        cmocka_unit_test(downwards),
        cmocka_unit_test(mass_centre_before_the_front_adaptor),
        cmocka_unit_test(mass_centre_behind_the_rear_adaptor),
        cmocka_unit_test(adaptors_in_any_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
