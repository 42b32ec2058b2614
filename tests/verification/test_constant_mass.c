// A rocket whose mass does not change: the limit of one that burns ever less, v = I/m in empty
// space, and a balance of energy without what burnt mass carries off.
#include "support/check.h"

#include <stdlib.h>

#include "elements/exchange.h"
#include "scenario/scenario.h"
#include "support/flight_text.h"

#define TIGHT "run.tolerance=1e-9", "run.flight_tolerance=1e-10"

static ld_rocket_summary run_of(const char *const *set, size_t count, ld_summary *summary)
{
    ld_model model;
    ld_messages messages;
    if (scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", set, count, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    *summary = summary_of_run(&model);
    model_clear(&model);
    return summary->rocket[0];
}

// Without `empty`, or with the full values there: the same bits; a gramme of propellant, all burnt
// after 2.5 s, changes as much as its share of the mass does, a tenth of a gramme a tenth of it: of
// less, the last bits of two runs would show.
static void limit_of_little_propellant(void **state)
{
    (void)state;
    static ld_summary none, same, gramme, tenth;
    static const char *const left_out[] = {"rocket.empty=", TIGHT};
    static const char *const equal[] = {
        "rocket.empty={mass: 60 kg, center: 1.1 0 0 m, inertia: 0.22 24 24 kg.m2}", TIGHT};
    static const char *const one[] = {
        "rocket.empty={mass: 59.999 kg, center: 1.1 0 0 m, inertia: 0.22 24 24 kg.m2}", TIGHT};
    static const char *const little[] = {
        "rocket.empty={mass: 59.9999 kg, center: 1.1 0 0 m, inertia: 0.22 24 24 kg.m2}", TIGHT};
    double speed = run_of(left_out, 3, &none).exit_speed;
    assert_true(run_of(equal, 3, &same).exit_speed == speed);
    // an acceleration that grows by the share b from start to exit adds b/3 to the speed over the
    // same way, less where the thrust has to build up first
    double change = (run_of(one, 3, &gramme).exit_speed - speed) / speed;
    double burnt = none.rocket[0].t_rear / 2.53;
    printf("    exit speed %.9f m/s, a gramme changes it by %.3g\n", speed, change);
    CHECK_WITHIN("of a gramme, over a third of its burnt share", change / (burnt / 3 * 1e-3 / 60),
                 0.97, 1);
    double less = (run_of(little, 3, &tenth).exit_speed - speed) / speed;
    CHECK_WITHIN("of a tenth of a gramme, over that of a gramme", less / change, 0.099, 0.101);
    assert_true(none.energy.work[POWER_MASS_CHANGE] == 0);
    CHECK_BELOW("energy balance, relative", none.energy.residual_relative, 2e-13);
}

// The flight to the ground, alike.
static void flies_on(void **state)
{
    (void)state;
    static ld_summary constant, little;
    static const char *const left_out[] = {"rocket.empty=", "run.end=landing", TIGHT};
    static const char *const milligramme[] = {
        "rocket.empty={mass: 59.999999 kg, center: 1.1 0 0 m, inertia: 0.22 24 24 kg.m2}",
        "run.end=landing", TIGHT};
    ld_rocket_summary a = run_of(left_out, 4, &constant), b = run_of(milligramme, 4, &little);
    printf("    range %.3f m, apogee %.3f m\n", a.flight.range, a.flight.apogee);
    CHECK_BELOW("range, relative", b.flight.range / a.flight.range - 1, 5e-8);
    CHECK_BELOW("apogee, relative", b.flight.apogee / a.flight.apogee - 1, 5e-8);
}

// Empty space: v = I/m and x = its integral, to rounding.
static void impulse_over_mass(void **state)
{
    (void)state;
    static const char text[] =
        "launchdyn: 1\n"
        "environment: {atmosphere: none, gravity: 0 m/s2, ground: none}\n"
        "rocket: {mass: 50 kg, inertia: 0.2 24 24 kg.m2,\n"
        "         motor: {thrust: [[0 s, 10 kN], [2 s, 10 kN], [2 s, 0 kN]]}}\n"
        "flight: {position: 0 0 0 m, velocity: 0 0 0 m/s}\n"
        "run: {end: 3 s}\n";
    ld_model model = read_text(text);
    ld_summary summary = summary_of_run(&model);
    model_clear(&model);
    CHECK_NEAR("speed [m/s]", summary.rocket[0].final.velocity[0], 400, 1e-12);
    CHECK_NEAR("way [m]", summary.rocket[0].final.position[0], 800, 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(limit_of_little_propellant),
        cmocka_unit_test(flies_on),
        cmocka_unit_test(impulse_over_mass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
