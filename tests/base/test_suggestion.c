// The name that a text suggests, taken out of it.
#include "support/check.h"

#include <string.h>

#include "launchdyn/status.h"

static void check_name(const char *text, size_t size, const char *expected)
{
    char name[32];
    memset(name, '#', sizeof name);
    const char *found = ld_suggested_name(text, name, size);
    if (!expected) {
        assert_null(found);
        return;
    }
    assert_ptr_equal(found, name);
    assert_string_equal(name, expected);
}

static void test_names_are_taken_out(void **state)
{
    (void)state;
    check_name("unknown key, did you mean \"mass\"?", 32, "mass");
    check_name("found \"reduce\", did you mean \"reduced\"? expected a word", 32, "reduced");
    check_name("no statistic, did you mean \"range.mean\" or \"range.deviation\"?", 32,
               "range.mean");
    check_name("unknown key, did you mean \"mass\"?", 4, "mas");
}

static void test_others_suggest_none(void **state)
{
    (void)state;
    check_name("", 32, NULL);
    check_name("found \"mass\"; expected a number", 32, NULL);
    check_name("unknown key, did you mean \"mas", 32, NULL); // cut
}

// A quantity that was renamed is reported by its name of now, behind a prefix too, however far that
// is.
static void test_renamed_names(void **state)
{
    (void)state;
    static const char *const names[] = {"tip.yaw_rate", "since_ignition.yaw_rate",
                                        "since_ignition.yaw", "rocket.1.since_ignition.vy",
                                        "rocket.2.since_ignition.vy"};
    const size_t count = sizeof names / sizeof *names;
    assert_string_equal(ld_nearest_name("aim.yaw", names, count), "since_ignition.yaw");
    assert_string_equal(ld_nearest_name("aim.yaw_rate", names, count), "since_ignition.yaw_rate");
    assert_string_equal(ld_nearest_name("rocket.2.aim.vy", names, count),
                        "rocket.2.since_ignition.vy");
    char now[32];
    assert_string_equal(ld_current_name("rocket.2.aim.vy", now, sizeof now),
                        "rocket.2.since_ignition.vy");
    assert_string_equal(ld_current_name("rocket.1.muzzle_speed", now, sizeof now),
                        "rocket.1.exit_speed");
    assert_string_equal(ld_current_name("muzzle_speed", now, 5), "exit"); // cut
    static const char *const present[] = {
        "exit_speed", "claim.yaw", "muzzle_speeds", "muzzle_speed.x", "my_muzzle_speed", "aim", ""};
    for (size_t i = 0; i < sizeof present / sizeof *present; i++)
        assert_null(ld_current_name(present[i], now, sizeof now));
    assert_null(ld_nearest_name("claim.yaw", names, count));
    assert_null(ld_nearest_name("aim.spin", names, count));
}

// What was found may look like a suggestion itself: the one that counts is the last.
static void test_what_was_found_is_not_what_is_meant(void **state)
{
    (void)state;
    check_name("found \"did you mean \"x\"?\", did you mean \"fixed\"?", 32, "fixed");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_are_taken_out),
        cmocka_unit_test(test_others_suggest_none),
        cmocka_unit_test(test_renamed_names),
        cmocka_unit_test(test_what_was_found_is_not_what_is_meant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
