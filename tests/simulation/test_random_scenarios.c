// Random scenarios that are accepted, to the start of their run: then the run ends well, or with a
// sentence about physics, and without much work, as none was asked for.
//   LD_RANDOM_SCENARIOS   how many
//   LD_RANDOM_FIRST       number of the first, to repeat one (2)
//   LD_RANDOM_PRINT       print the scenarios, too
//   LD_RANDOM_SECONDS     CPU time that none may take [s], in the overall form five times (none)
#include "support/check.h"
#include "support/draw.h"
#include "support/random_model.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "launchdyn/run.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"

enum { MOST_KEYS = 1024 };

typedef struct language {
    int count;
    ld_key key[MOST_KEYS];
} language;

// Keys that ask for work, or for more runs, are set below.
static bool asks_for_work(const char *path)
{
    static const char *const apart[] = {"run.",      "scatter", "sweep", "firing",
                                        "launchdyn", "include", "title", "flight.ignition"};
    for (size_t i = 0; i < sizeof apart / sizeof *apart; i++)
        if (strncmp(path, apart[i], strlen(apart[i])) == 0)
            return true;
    return false;
}

static void take_key(void *self, const ld_key *key)
{
    language *all = self;
    if (asks_for_work(key->path))
        return;
    assert_true(all->count < MOST_KEYS);
    ld_key *kept = &all->key[all->count++];
    *kept = *key;
    kept->path = strdup(key->path);
    kept->unit = strdup(key->unit);
    kept->expected = strdup(key->expected);
}

// Other kinds of things than the examples have, each laid over some.
static const char *const kinds[] = {
    "rocket.contact.law=lankarani-nikravesh",
    "rocket.contact={law: kelvin-voigt, exponent: 1, damping: 1e4 N.s/m}",
    "rocket.contact={law: bilateral, exponent: 1, friction: 0, damping: 1e3 N.s/m}",
    "rocket={contact: {law: ideal, exponent: 1, friction: 0}, adaptors: [{name: rear, at: 0 m}, "
    "{name: front, at: 1.9 m}]}",
    "tubes.supports=[{at: 0.4 m, clamped: all}, {at: 1.8 m, clamped: [y, z]}]",
    "tubes.slot=none",
    "tubes.slot.angle=[[0 m, 2 deg], [1.5 m, 6 deg], [3 m, 3 deg]]",
    "tubes.modes={bending: 3, torsion: 1, axial: 2, span: clamped}",
    "tubes.modes={bending: 8, span: free-free, elements: 20, cut: 2 kHz}",
    "tubes.point_masses=[{at: 1 m, mass: 2 kg}, {at: 2.9 m, mass: 1 kg}]",
    "tubes.tail=",
    "tubes.initial_shape.offsets=[[0 m, 0 mm, 0 mm, 0 deg], [1 m, 0.3 mm, -0.1 mm, 0.1 deg], [100 "
    "m, "
    "1 mm, 2 mm, 1 deg]]",
    "rocket.adaptors=[{name: rear, at: 0 m, clearance: 0.3 mm, leaves_at: 2 m}, {name: front, at: "
    "1.9 m, clearance: 0.4 mm, leaves_at: 2.9 m, falls_off: {mass: 1 kg, center: 5 0 mm}}]",
    "tubes.loads=[{at: 0 m}, {at: 1.2 m}, {at: 2.9 m}]",
    "tubes={jet: [[0 m, 3 kN], [1 m, 2 kN], [4 m, 0 kN]], jet_scale: 1.2}",
    "tubes.wind_drag=[{from: 0 m, to: 1.5 m, width: 30 cm, coefficient: 1.2}, {from: 1 m, to: 2.9 "
    "m, "
    "width: 0.1 m, coefficient: 0.8}]",
    "tubes.pressure={pressure: 2 MPa, volume: 0.03 m3, exponent: 1.4, ambient: 0.1 MPa}",
    "tubes.pressure={over_time: [[0 s, 0 MPa], [10 ms, 1 MPa], [0.1 s, 0.5 MPa]]}",
    "tubes={pressure: {over_travel: [[0 m, 2 MPa], [1 m, 1 MPa], [3 m, 0.3 MPa]]}, slot: none}",
    "tubes.supports=[{at: 0.4 m, stiffness: 2e7 2e7 2e7 N/m, damping: 1e4 1e4 1e4 N.s/m, "
    "rotational_stiffness: 2e5 2e5 2e5 N.m/rad, recoil: {preload: 2 kN, stiffness: 20 kN/m, "
    "damping: 500 N.s/m, friction: 100 N, stroke: 0.3 m}}, {at: 1.8 m, stiffness: 0 2e7 2e7 N/m}]",
    "tubes.supports=[{at: 0.3 m, clamped: [x, y, z, roll]}, {at: 1.5 m, stiffness: 0 2e7 2e7 N/m}]",
    "tubes.supports=[{at: 0.2 m, clamped: all}]",
    "tubes.sections=[{from: 0 m, bore_radius: 80 mm, mass_per_length: 20 kg/m, axial_stiffness: "
    "3e8 N, bending_stiffness_y: 5e5 N.m2, bending_stiffness_z: 2e6 N.m2, torsion_stiffness: 3e5 "
    "N.m2, polar_inertia: 0.1 kg.m}]",
    "tubes={slot: none, guide: {line: 150 10 mm, t_slot: {at: -80 0 mm, lips: 40 mm, gap: 0.4 mm, "
    "side_gap: 0.3 mm}}}",
    "tubes={slot: none, guide: {t_slot: {at: 0 0 mm, lips: 60 mm, gap: 0 mm, side_gap: 0 mm}}}",
    "tubes={slot: none, guide: {tower: {rails: 4, first: 45 deg, gap: 0.5 mm, radius: 80 mm}}}",
    "tubes={slot: none, guide: {line: -20 100 mm, tower: {rails: 3, gap: 0.2 mm, radius: 80 mm}}}",
    "tubes={slot: none, guide: {line: 0 200 mm, surfaces: [{name: left-floor, at: -40 -40 mm, "
    "normal: 180 deg, gap: 0.2 mm}, {name: right-floor, at: -40 40 mm, normal: 180 deg, gap: 0.2 "
    "mm}, {name: ceiling, at: 40 0 mm, normal: 0 deg, gap: 0.2 mm, shape: round}, {name: left, at: "
    "0 -80 mm, normal: -90 deg, gap: 0.3 mm}, {name: right, at: 0 80 mm, normal: 90 deg, gap: 0.3 "
    "mm, shape: round}]}}",
    "rocket.adaptors=[{name: rear, at: 0 m, clearance: 0.1 mm}, {name: middle, at: 0.7 m}, {name: "
    "front, at: 1.5 m, clearance: 0.2 mm}]",
    "rocket.lock.holds_roll=yes",
    "rocket.lock.holds_roll=no",
    "rocket.motor=none",
    "rocket.lock=none",
    "rocket.empty=",
    "rocket.aerodynamics=none",
    "rocket.aerodynamics={model: body, area: 0.02 m2, drag: 0.4}",
    "run.start=undeformed",
    "run.formulation=overall",
    "run.end=tip",
    "run.end=landing",
    "run.end=0.2 s",
    "run.tolerance=1e-4",
    "base={kind: fixed, elevation: 89 deg}",
    "base={kind: fixed, elevation: -10 deg}",
    "base.motion={heave: [{amplitude: 0.2 m, frequency: 2 Hz}], roll: [{amplitude: 3 deg, "
    "frequency: 1 Hz}]}",
    "base.speed=0 m/s",
    "base.road={flat: true}",
    "base.road={class: E, tracks: independent}",
    "base.road={sines: [{amplitude: 30 mm, wavelength: 2 m}], bumps: [{at: 0 m, length: 1 m, "
    "height: 0.1 m}]}",
    "platform.azimuth.lock={stiffness: 1e8 N.m/rad, damping: 1e5 N.m.s/rad}",
    "platform.elevation.lock={stiffness: 1e8 N.m/rad, damping: 1e5 N.m.s/rad}",
    "platform.azimuth.stabiliser.cascade={kp: 12 1/s, rate_kp: 3e5 N.m.s/rad, rate_ki: 3e5 "
    "N.m/rad}",
    "platform.azimuth.stabiliser={bandwidth: 60 Hz, slew: 5e6 N.m/s}",
    "platform.azimuth.stabiliser={sample: 2 ms, sensor_resolution: {angle: 0.02 mrad, rate: 1 "
    "mrad/s}}",
    "platform.azimuth.stabiliser.gear={stiffness: 2e8 N.m/rad, damping: 2e5 N.m.s/rad, inertia: "
    "80 kg.m2, backlash: 0.3 mrad}",
    "platform.elevation.stabiliser={feedforward: 0.1, bandwidth: 60 Hz}",
    "platform.elevation.stabiliser={cascade: {kp: 15 1/s, rate_kp: 4e5 N.m.s/rad}, sample: 1 ms}",
    "platform.elevation.stabiliser={sample: 2 ms, delay: 1 ms, sensor_noise: {angle: 0.01 mrad, "
    "rate: 1 mrad/s}}",
    "platform.elevation.stabiliser.gear={stiffness: 2e8 N.m/rad, damping: 2e5 N.m.s/rad, inertia: "
    "80 kg.m2}",
    "platform={jet: [[0 m, 3 kN], [1 m, 2 kN], [4 m, 0 kN]], jet_scale: 1.2}",
    "rocket.lock.at={x: 0.3 m, radius: 82.5 mm, angle: 30 deg}",
    "rocket.dynamic_imbalance=1 -1 mrad",
    "rocket.aerodynamics.emerged={nose: 2.5 m, drag: 1.2, diameter: 164 mm}",
    "measures=[{name: a, of: tip.y, take: rms, from: t_ignition, to: t_rear}, {name: b, of: "
    "rocket.pitch_rate, take: value, at: t_rear}, {name: c, of: tip.pitch_rate, take: peak, from: "
    "t_front, to: end}]",
    "base.suspension.bump_stop={compression: 0.1 m, stiffness: 1e6 N/m}",
    "firing={order: [1, 3, 2], interval: 0.3 s}",
    "firing=[{tube: 2, at: 0.01 s}]",
    "environment.earth=round",
    "environment={earth: wgs84, site: {latitude: 45 deg}}",
    "environment.atmosphere=none",
    "environment.ground=none",
    "environment.wind={speed: 10 m/s, turbulence: {wind_at_6m: 5 m/s}}",
    "environment.wind={gust: [{start: 0.1 s, rise: 0.2 s, speed: 15 m/s}]}",
    "run.coupling.step=0.5 ms",
};

// What keeps the work small; the first that do not go with a scenario are left out.
static const char *const small[] = {
    "run.lead_in=0.05 s",     "run.stuck_time=0.5 s", "run.output_step=5 ms",
    "run.flight_limit=100 s", "run.max_step=0.2 ms",
};

static bool set(ld_model *model, const char *text)
{
    ld_messages messages = {0};
    ld_status status = ld_model_set_all(model, &text, 1, &messages);
    ld_messages_free(&messages);
    assert_true(status == LD_OK || status == LD_ERR_INPUT);
    return status == LD_OK;
}

// Between the ends of the key's range, its logarithm uniform.
static double draw_in_range(uint64_t *seed, const ld_key *key)
{
    double low = fmax(key->low, 1e-9), high = fmin(key->high, 1e12);
    double size = low < high ? exp(between(seed, log(low), log(high))) : low;
    return key->low < 0 && chance(seed, 0.5) ? fmax(-size, key->low) : size;
}

// The path of a key with numbers of lists' members in it.
static void draw_path(uint64_t *seed, const char *key, char path[128])
{
    snprintf(path, 128, "%s", key);
    for (char *place = path; (place = strstr(place, ".N")); place++)
        place[1] = (char)('1' + choice(seed, 3));
}

// Changes the numbers of a value by factors, or draws new ones; false: it has none.
static bool draw_value(uint64_t *seed, const ld_key *key, char *text, size_t size)
{
    char was[256];
    bool whole = strstr(key->expected, "whole number") != NULL, new = chance(seed, 0.2);
    snprintf(was, sizeof was, "%s", text);
    char *rest = was, *end;
    *text = '\0';
    for (double value = strtod(rest, &end); end != rest; value = strtod(rest, &end)) {
        if (new)
            value = draw_in_range(seed, key);
        else
            scale(seed, &value);
        size_t used = strlen(text);
        snprintf(text + used, size - used, whole ? "%.0f " : "%.6g ", value);
        rest = end;
    }
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s", new ? key->unit : rest + strspn(rest, " "));
    return used > 0;
}

static void change_key(uint64_t *seed, const language *all, ld_model *model)
{
    const ld_key *key = &all->key[choice(seed, all->count)];
    char path[128], text[256], whole[400];
    draw_path(seed, key->path, path);
    if (ld_model_text(model, path, text, sizeof text, NULL))
        return;
    if (!draw_value(seed, key, text, sizeof text))
        return;
    snprintf(whole, sizeof whole, "%s=%s", path, text);
    set(model, whole);
}

static ld_model *draw_scenario(uint64_t *seed, const language *all)
{
    static const char *const files[] = {"fixed",      "prescribed",   "reference", "aircraft",
                                        "ship",       "flight",       "sequence",  "smooth",
                                        "firm",       "rail/pad",     "rail/deck", "rail/tower",
                                        "rail/truck", "line-thrower", "spin-rig"};
    char name[256];
    ld_messages messages;
    ld_model *model;
    for (int i = 0; i < 5; i++)
        draw(seed);
    snprintf(name, sizeof name, "%s/examples/%s.yaml", LD_SOURCE_DIR,
             files[choice(seed, (int)(sizeof files / sizeof *files))]);
    assert_int_equal(ld_scenario_read(name, NULL, 0, &model, &messages), LD_OK);
    for (size_t i = 0; i < sizeof small / sizeof *small; i++)
        set(model, small[i]);
    int changes = choice(seed, 30);
    for (int i = choice(seed, 4); i > 0; i--)
        set(model, kinds[choice(seed, (int)(sizeof kinds / sizeof *kinds))]);
    for (int i = 0; i < changes; i++)
        change_key(seed, all, model);
    return model;
}

typedef struct clock_watch {
    double until; // [s] CPU
} clock_watch;

static bool go_on(void *self, double share)
{
    (void)share;
    return (double)clock() / CLOCKS_PER_SEC < ((clock_watch *)self)->until;
}

// A sentence, without numbers that are none.
static void check_sentence(const char *text)
{
    assert_true(strlen(text) > 20);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, " inf"));
}

enum { REFUSED, STOPPED, WENT_WELL, WRONG, ENDS };

// Whether it can start is what `check` asks; an error of it has a place.
static int run_scenario(int number, const ld_model *model, double seconds, double *longest)
{
    ld_simulation *simulation = NULL;
    ld_run *run = NULL;
    ld_error error = {0};
    ld_messages messages = {0};
    double begun = (double)clock() / CLOCKS_PER_SEC;
    clock_watch watch = {begun + seconds};
    const ld_run_options options = {.self = &watch, .progress = go_on};
    ld_status status = ld_simulation_create(model, &simulation, &error);
    if (!status)
        status = ld_run_begin(simulation, &options, &run, &error);
    if (status) {
        printf("  %4d refused: %s\n", number, error.text);
        check_sentence(error.text);
        assert_true(ld_scenario_explain(model, &error, &messages));
        ld_messages_free(&messages);
        ld_run_end(run, NULL, NULL);
        ld_simulation_free(simulation);
        return REFUSED;
    }
    ld_summary *summary = ld_summary_new();
    ld_run_advance(run, INFINITY, &error);
    status = ld_run_end(run, summary, &error);
    double spent = (double)clock() / CLOCKS_PER_SEC - begun;
    *longest = fmax(*longest, spent);
    printf("  %4d %s%s (%.2f s)\n", number,
           status == LD_OK            ? "went well"
           : status == LD_ERR_LAUNCH  ? "stopped: "
           : status == LD_ERR_NUMERIC ? "stopped, numerics: "
                                      : "wrong: ",
           status ? error.text : "", spent);
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    if (!status)
        return WENT_WELL;
    check_sentence(error.text);
    return status == LD_ERR_LAUNCH || status == LD_ERR_NUMERIC ? STOPPED : WRONG;
}

// The overall form, which takes several times the work, is asked for.
static double seconds_of(const ld_model *model, double seconds)
{
    char form[32] = "";
    ld_model_text(model, "run.formulation", form, sizeof form, NULL);
    return strcmp(form, "overall") == 0 ? 5 * seconds : seconds;
}

static int from_environment(const char *name, int otherwise)
{
    const char *text = getenv(name);
    return text ? atoi(text) : otherwise;
}

static void every_scenario_ends(void **state)
{
    (void)state;
    static language all;
    int count = from_environment("LD_RANDOM_SCENARIOS", 10), ends[ENDS] = {0};
    int first = from_environment("LD_RANDOM_FIRST", 2);
    double seconds = from_environment("LD_RANDOM_SECONDS", 0), longest = 0;
    ld_scenario_keys(take_key, &all);
    for (int i = first; ends[STOPPED] + ends[WENT_WELL] + ends[WRONG] < count; i++) {
        uint64_t seed = (uint64_t)i;
        ld_model *model = draw_scenario(&seed, &all);
        if (getenv("LD_RANDOM_PRINT"))
            ld_model_print(model, stdout);
        double most = seconds > 0 ? seconds_of(model, seconds) : INFINITY;
        ends[run_scenario(i, model, most, &longest)]++;
        ld_model_free(model);
    }
    printf(
        "  %d accepted scenarios: %d went well, %d stopped; %d refused; the longest took %.2f s\n",
        count, ends[WENT_WELL], ends[STOPPED], ends[REFUSED], longest);
    CHECK_BELOW("that end otherwise, or take too long", ends[WRONG], 0);
    for (int i = 0; i < all.count; i++) {
        free((char *)all.key[i].path);
        free((char *)all.key[i].unit);
        free((char *)all.key[i].expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scenario_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
