// ctest: slow
// What a run says of how far its rates at the exit may be from those of steps without error,
// against the same launch at a tolerance of 1e-10: random bores, T-slots, channels and towers in
// which rockets rattle, and vehicles on the march.
//   LD_EXIT_ERRORS           how many launches
//   LD_EXIT_ERRORS_MARCHING  how many from vehicles
//   LD_EXIT_ERRORS_FIRST     number of the first, to repeat one (1)
//   LD_EXIT_ERRORS_TOLERANCE of the runs, to see what another one leaves (the scenario's)
#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/draw.h"
#include "support/random_model.h"

// ---- launches ----

enum { BORE, T_SLOT, CHANNEL, TOWER, KINDS };
static const char *const kind_names[KINDS] = {"bore", "T-slot", "channel", "tower"};

static void set(ld_model *model, const char *format, ...) LD_PRINTF(2, 3);

static void set(ld_model *model, const char *format, ...)
{
    char text[1024];
    const char *given = text;
    ld_messages messages = {0};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (ld_model_set_all(model, &given, 1, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
}

// Its logarithm uniform.
static double spread(uint64_t *seed, double low, double high)
{
    return exp(between(seed, log(low), log(high)));
}

static void draw_guide(uint64_t *seed, int kind, ld_model *model)
{
    double gap = spread(seed, 0.1, 2), side = spread(seed, 0.1, 2), at = between(seed, 60, 120);
    switch (kind) {
    case T_SLOT:
        set(model,
            "tubes.guide={line: %g 0 m, t_slot: {at: -%g 0 mm, lips: %g mm, gap: %g mm, "
            "side_gap: %g mm}}",
            1e-3 * at + 0.08, at, between(seed, 20, 80), gap, side);
        break;
    case CHANNEL:
        set(model,
            "tubes.guide={t_slot: , line: 200 0 mm, surfaces: [{name: left-floor, at: -%g -40 mm, "
            "normal: "
            "180 deg, gap: %g mm}, {name: right-floor, at: -%g 40 mm, normal: 180 deg, gap: %g "
            "mm}, {name: ceiling, at: 40 0 mm, normal: 0 deg, gap: %g mm}, {name: left, at: 0 -80 "
            "mm, normal: -90 deg, gap: %g mm}, {name: right, at: 0 80 mm, normal: 90 deg, gap: %g "
            "mm}]}",
            at, gap, at, gap, between(seed, 1, 2) * gap, side, side);
        break;
    case TOWER:
        set(model,
            "tubes.guide={t_slot: , line: 0 0 m, tower: {rails: %d, first: %g deg, gap: %g mm, "
            "radius: 80 mm}}",
            3 + choice(seed, 3), between(seed, 0, 90), gap);
        break;
    default:
        break;
    }
}

// Mass, balance, shoes, contact and drive; `length`: of the guide.
static void draw_rocket(uint64_t *seed, int kind, double length, ld_model *model)
{
    double mass = spread(seed, 20, 200), span = between(seed, 0.1, 0.4) * length;
    double radius = 0.08, inertia = mass * span * span * between(seed, 0.2, 0.5);
    double center = between(seed, 0.35, 0.8) * span;
    set(model, "rocket.empty=");
    set(model, "rocket.mass=%g kg", mass);
    set(model, "rocket.center=%g 0 0 m", center);
    set(model, "rocket.inertia=%g %g %g kg.m2", 0.5 * mass * radius * radius, inertia, inertia);
    set(model, "rocket.eccentricity=%g %g mm", 2 * draw(seed), 2 * draw(seed));
    set(model, "rocket.motor.misalignment=%g %g mrad", 3 * draw(seed), 3 * draw(seed));
    set(model, "rocket.start_at=%g m", 0.05 * length);
    char adaptors[256];
    bool middle = chance(seed, 0.3);
    double play[3];
    for (int i = 0; i < 3; i++)
        play[i] = kind == BORE ? spread(seed, 0.1, 2) : 0;
    int at = 0;
    const char *word = kind == BORE ? ", clearance: " : "";
    at += snprintf(adaptors, sizeof adaptors, "{name: rear, at: 0 m");
    if (kind == BORE)
        at += snprintf(adaptors + at, sizeof adaptors - (size_t)at, "%s%g mm", word, play[0]);
    if (middle)
        at += snprintf(adaptors + at, sizeof adaptors - (size_t)at, "}, {name: middle, at: %g m",
                       between(seed, 0.3, 0.7) * span);
    if (middle && kind == BORE)
        at += snprintf(adaptors + at, sizeof adaptors - (size_t)at, "%s%g mm", word, play[1]);
    at += snprintf(adaptors + at, sizeof adaptors - (size_t)at, "}, {name: front, at: %g m", span);
    if (kind == BORE)
        at += snprintf(adaptors + at, sizeof adaptors - (size_t)at, "%s%g mm", word, play[2]);
    set(model, "rocket.adaptors=[%s}]", adaptors);
    set(model,
        "rocket.contact={law: hunt-crossley, stiffness: %g N/m, restitution: %g, friction: "
        "%g}",
        spread(seed, 1e7, 2e8), between(seed, 0.2, 0.9), between(seed, 0, 0.3));
    double thrust = mass * 9.8 * spread(seed, 3, 60);
    set(model, "rocket.lock.release_force=%g N", 0.3 * thrust);
    set(model, "rocket.motor.thrust=[[0 s, 0 kN], [%g ms, %g N], [4 s, %g N], [4.1 s, 0 kN]]",
        between(seed, 5, 40), thrust, thrust);
}

static ld_model *draw_launch(uint64_t number, int *kind)
{
    uint64_t seed = number;
    ld_messages messages = {0};
    ld_model *model;
    for (int i = 0; i < 5; i++)
        draw(&seed);
    *kind = (int)(number % KINDS);
    const char *file = LD_SOURCE_DIR "/examples/rail/pad.yaml";
    if (*kind == BORE)
        file = LD_SOURCE_DIR "/examples/fixed.yaml";
    assert_int_equal(ld_scenario_read(file, NULL, 0, &model, &messages), LD_OK);
    set(model, "base.elevation=%g deg", between(&seed, 15, 89));
    double length = *kind == BORE ? 3 : between(&seed, 3, 7);
    if (*kind == BORE) {
        set(model, "run.lead_in=50 ms");
        if (chance(&seed, 0.6))
            set(model, "tubes.slot=none");
    } else {
        set(model, "tubes.length=%g m", length);
        double stiff = spread(&seed, 1e5, 1e7);
        set(model,
            "tubes.sections=[{from: 0 m, mass_per_length: %g kg/m, axial_stiffness: 1e9 N, "
            "bending_stiffness_y: %g N.m2, bending_stiffness_z: %g N.m2, torsion_stiffness: "
            "%g N.m2, polar_inertia: %g kg.m}]",
            between(&seed, 8, 60), stiff, stiff * between(&seed, 0.5, 2), stiff,
            spread(&seed, 0.05, 1));
        set(model, "environment.wind={speed: %g m/s, heading: %g deg}", between(&seed, 0, 8),
            between(&seed, 0, 180));
    }
    draw_guide(&seed, *kind, model);
    draw_rocket(&seed, *kind, length, model);
    set(model, "run.output_step=5 ms");
    set(model, "run.end=tip");
    return model;
}

// From a vehicle that drives: the reference launcher or the firm one, with other gaps, contacts and
// rockets, on other roads.
static ld_model *draw_marching(uint64_t number)
{
    uint64_t seed = number + 1000000;
    ld_messages messages = {0};
    ld_model *model;
    for (int i = 0; i < 5; i++)
        draw(&seed);
    const char *file = number % 2 ? LD_SOURCE_DIR "/examples/marching/30-kmh.yaml"
                                  : LD_SOURCE_DIR "/examples/marching/firm-30-kmh.yaml";
    assert_int_equal(ld_scenario_read(file, NULL, 0, &model, &messages), LD_OK);
    set(model, "base.speed=%g km/h", between(&seed, 0, 50));
    set(model,
        "base.road={class: %c, tracks: same, seed: %d, harmonics: 200, wavelengths: 0.3 100 m}",
        'A' + choice(&seed, 3), 1 + choice(&seed, 1000));
    if (chance(&seed, 0.5))
        set(model, "tubes.slot=none");
    set(model, "rocket.mass=%g kg", between(&seed, 50, 75));
    for (int i = 0; i < model->rocket.adaptor_count; i++)
        set(model, "rocket.adaptors.%d.clearance=%g mm", i + 1, spread(&seed, 0.05, 1));
    set(model, "rocket.contact.restitution=%g", between(&seed, 0.2, 0.9));
    set(model, "rocket.contact.friction=%g", between(&seed, 0, 0.3));
    set(model, "rocket.contact.stiffness=%g N/m", spread(&seed, 3e6, 1e8));
    set(model, "run.lead_in=0.1 s");
    set(model, "run.output_step=10 ms");
    set(model, "run.end=tip");
    return model;
}

// ---- runs ----

static bool run_at(ld_model *model, double tolerance, ld_summary *summary)
{
    ld_simulation *simulation = NULL;
    ld_error error = {0};
    set(model, "run.tolerance=%g", tolerance);
    ld_status status = ld_simulation_create(model, &simulation, &error);
    if (!status)
        status = ld_simulation_run(simulation, NULL, summary, &error);
    ld_simulation_free(simulation);
    if (status)
        printf("  ended early: %s\n", error.text);
    return status == LD_OK && summary->rocket_count == 1;
}

static int from_environment(const char *name, int otherwise)
{
    const char *text = getenv(name);
    return text ? atoi(text) : otherwise;
}

// The scenario's tolerance, or that asked for, and a finer one.
enum { USUAL, FINER, TOLERANCES };
static const char *const tolerance_names[TOLERANCES] = {"", ", a tenth of the tolerance"};

typedef struct tally {
    int launches, beyond[TOLERANCES];
} tally;

// How far the rates at the exit are off, against what is reported of them; of launches that get
// out.
static void count_launch(int number, ld_model *model, const char *kind, tally *count)
{
    static ld_summary fine, run[TOLERANCES];
    const char *asked = getenv("LD_EXIT_ERRORS_TOLERANCE");
    double tolerance = asked ? atof(asked) : model->run.tolerance;
    if (!run_at(model, tolerance, &run[USUAL]) || !run_at(model, 0.1 * tolerance, &run[FINER]) ||
        !run_at(model, 1e-10, &fine))
        return;
    const ld_tip_off *exact = &fine.rocket[0].tip_off;
    double rates = hypot(exact->pitch_rate, exact->yaw_rate);
    printf("  %4d %-8s rates %9.3f mrad/s", number, kind, 1e3 * rates);
    for (int k = 0; k < TOLERANCES; k++) {
        const ld_rocket_summary *told = &run[k].rocket[0];
        double off = hypot(told->tip_off.pitch_rate - exact->pitch_rate,
                           told->tip_off.yaw_rate - exact->yaw_rate);
        bool beyond = !(off <= 3 * told->exit_error.rates);
        printf(", off by %.1e, told %.1e%s, %lld evaluations", off / rates,
               told->exit_error.rates / rates, beyond ? " !" : "",
               (long long)run[k].statistics.rhs_evaluations);
        count->beyond[k] += beyond;
    }
    printf("\n");
    count->launches++;
}

static void check_tally(const tally *count, const char *of)
{
    printf("  %d launches%s\n", count->launches, of);
    for (int k = 0; k < TOLERANCES; k++) {
        char name[96];
        snprintf(name, sizeof name, "share off by more than 3 x what is told%s",
                 tolerance_names[k]);
        CHECK_BELOW(name, (double)count->beyond[k] / count->launches, 0.05);
    }
}

static void rates_are_off_by_no_more_than_is_told(void **state)
{
    (void)state;
    int most = from_environment("LD_EXIT_ERRORS", OF_ALL(60, 8));
    tally count = {0};
    for (int i = from_environment("LD_EXIT_ERRORS_FIRST", 1); count.launches < most; i++) {
        int kind;
        ld_model *model = draw_launch((uint64_t)i, &kind);
        count_launch(i, model, kind_names[kind], &count);
        ld_model_free(model);
    }
    check_tally(&count, "");
}

// The same of rockets that leave a vehicle on the march.
static void rates_from_vehicles_too(void **state)
{
    (void)state;
    int most = from_environment("LD_EXIT_ERRORS_MARCHING", OF_ALL(12, 2));
    tally count = {0};
    for (int i = from_environment("LD_EXIT_ERRORS_FIRST", 1); count.launches < most; i++) {
        ld_model *model = draw_marching((uint64_t)i);
        count_launch(i, model, "vehicle", &count);
        ld_model_free(model);
    }
    check_tally(&count, " from vehicles");
}

// The run itself is the same to the bit with the estimate and without, which then reports nothing.
static void run_stays_as_it_is(void **state)
{
    (void)state;
    static ld_summary with, without;
    for (uint64_t i = 1; i <= KINDS; i++) {
        int kind;
        ld_model *model = draw_launch(i, &kind);
        assert_true(run_at(model, 1e-5, &with));
        set(model, "run.exit_error=no");
        assert_true(run_at(model, 1e-5, &without));
        const ld_rocket_summary *a = &with.rocket[0], *b = &without.rocket[0];
        assert_memory_equal(&a->exit, &b->exit, sizeof a->exit);
        assert_memory_equal(&a->tip_off, &b->tip_off, sizeof a->tip_off);
        assert_memory_equal(&with.energy, &without.energy, sizeof with.energy);
        assert_int_equal(with.statistics.steps, without.statistics.steps);
        assert_true(isfinite(a->exit_error.rates) && isnan(b->exit_error.rates));
        ld_model_free(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(run_stays_as_it_is),
        cmocka_unit_test(rates_are_off_by_no_more_than_is_told),
        cmocka_unit_test(rates_from_vehicles_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
