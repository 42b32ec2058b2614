// FMUs for model exchange: CVODE takes their steps and comes to what the library's own integrator
// comes to; rates are the library's to the bit; states come back to the bit; what is called at the
// wrong time is refused with a sentence.
// link: -ldl -lsundials_cvode -lsundials_nvecserial
#include "launchdyn/summary.h"
#include "support/fmu_importer.h"
#include "support/library_run.h"

// ---- against the library ----

// By the scenario and overrides, of which the last one is NULL; in the shell's folder.
static library begin_in_shell(const char *scenario, const char *const *set,
                              const ld_base_frame *base)
{
    char path[256];
    size_t sets = 0;
    snprintf(path, sizeof path, "%s/%s.yaml", shell.folder, scenario);
    while (set[sets])
        sets++;
    return library_begin(path, set, sets, base);
}

static double library_value(const library *self, const char *name)
{
    double value;
    ld_error error;
    assert_int_equal(
        ld_summary_number(ld_run_summary(self->run), name + strlen("summary."), &value, &error),
        LD_OK);
    return value;
}

#define CLAMPS "tubes.supports=[{at: 0.4 m, clamped: all}, {at: 1.8 m, clamped: [y, z]}]"
#define HELD "rocket.contact.law=ideal"
#define BY_TOUCH "rocket.contact.law=lankarani-nikravesh"
#define TWO "firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.5 s}]"

enum { MOST_SETS = 8 };

typedef struct launch_case {
    const char *scenario;
    const char *set[MOST_SETS];
    int version, rocket;
    bool rates, instants; // what is checked: rates at 1e-8, instants (and rates) at 1e-10
} launch_case;

static unpacked_fmu open_case(const launch_case *self)
{
    char line[400];
    int length = snprintf(line, sizeof line, "%s.yaml", self->scenario);
    for (int i = 0; self->set[i]; i++)
        length +=
            snprintf(line + length, sizeof line - (size_t)length, " --set '%s'", self->set[i]);
    return fmu_open(line, self->version);
}

static const char *const times[] = {"t_release", "t_front", "t_rear"};
static const char *const exit_rates[] = {"pitch_rate", "yaw_rate"};

// The largest difference of numbers of a rocket's summary; one that has no value has none in both.
static double differ(importer *by, const library *from, int rocket, const char *const *number,
                     int count)
{
    double worst = 0;
    char name[64];
    for (int i = 0; i < count; i++) {
        snprintf(name, sizeof name, "summary.rocket.%d.%s", rocket, number[i]);
        double a = importer_value(by, name), b = library_value(from, name);
        assert_int_equal(isnan(a), isnan(b));
        worst = fmax(worst, isnan(a) ? 0 : fabs(a - b));
    }
    return worst;
}

// A launch by CVODE and by the library, both at this tolerance: how far exits and rates differ.
static void compare(const launch_case *self, double tolerance, double *instants, double *rates)
{
    char own[64];
    launch_case tight = *self;
    int sets = 0;
    importer by;
    unpacked_fmu fmu = open_case(self);
    while (self->set[sets])
        sets++;
    snprintf(own, sizeof own, "run.tolerance=%g", tolerance);
    tight.set[sets] = own;
    library from = begin_in_shell(self->scenario, tight.set, NULL);
    double start = ld_run_time(from.run);
    assert_int_equal(ld_run_advance(from.run, INFINITY, NULL), LD_OK);
    importer_open(&by, &fmu, self->version);
    importer_start(&by, start);
    importer_integrate(&by, tolerance);
    importer_go(&by, INFINITY);
    *instants = differ(&by, &from, self->rocket, times, 3);
    *rates = differ(&by, &from, self->rocket, exit_rates, 2);
    printf("    %s %s, %g: %d steps, %d events\n", self->scenario, self->set[0] ? self->set[0] : "",
           tolerance, by.steps, by.events);
    assert_true(by.ended);
    // few: two to twelve of the launch, and none by steps that end as they should
    CHECK_BELOW("events", by.events, 12);
    importer_close(&by);
    library_end(&from);
    fmu_close(&fmu);
}

static void comes_to_what_the_library_comes_to(void **state)
{
    (void)state;
    static const launch_case cases[] = {
        {"examples/fixed", {"tubes.modes.cut=900 Hz"}, 2, 1, true, true},
        {"examples/ship", {"run.lead_in=0.1 s"}, 3, 1, true, false},
        {"examples/reference", {"run.lead_in=0.1 s"}, 3, 1, true, true},
        {"examples/line-thrower", {NULL}, 3, 1, true, false},
        {"examples/line-thrower", {HELD, "rocket.contact.friction=0"}, 2, 1, true, false},
        {"examples/fixed", {BY_TOUCH}, 3, 1, true, true},
        {"examples/fixed", {CLAMPS}, 3, 1, false, true}, // whose high modes CVODE follows to 0.03
                                                         // at 1e-8
        // which spins so fast that a launch of the library itself is exact to 0.2 at 1e-8
        {"examples/spin-rig", {"run.end=40 ms"}, 2, 1, false, true},
        {"examples/sequence", {TWO, "run.lead_in=0 s"}, 3, 2, true, false},
    };
    for (int i = 0; i < OF_ALL((int)(sizeof cases / sizeof *cases), 3); i++) {
        double instants, rates;
        if (cases[i].rates) {
            compare(&cases[i], 1e-8, &instants, &rates);
            CHECK_BELOW("rates at the exit, at 1e-8 [mrad/s]", 1e3 * rates, 1e-2);
        }
        if (cases[i].instants) {
            compare(&cases[i], 1e-10, &instants, &rates);
            CHECK_BELOW("rates at the exit, at 1e-10 [mrad/s]", 1e3 * rates, 1e-2);
            CHECK_BELOW("instants of release and exits, at 1e-10 [s]", instants, 1e-9);
        }
    }
}

// ---- the end ----

static bool same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

enum { EXIT_FIGURES = 4 };
static const char *const exit_figures[EXIT_FIGURES] = {"summary.rocket.1.t_rear",
                                                       "summary.rocket.1.exit_speed",
                                                       "summary.rocket.1.yaw_rate", "rocket.s"};
static double recorded[EXIT_FIGURES];

static void record_exit(importer *self)
{
    for (int i = 0; i < EXIT_FIGURES; i++)
        recorded[i] = importer_value(self, exit_figures[i]);
}

// An importer that stops at once where it is asked to, and records no more then, has what is known
// at the end alone: that is reported a step later. Until then all stands still.
static void the_end_is_recorded(void **state)
{
    (void)state;
    static double x[IMPORTER_MOST], rate[IMPORTER_MOST];
    for (int version = 2; version <= 3; version++) {
        unpacked_fmu fmu = fmu_open("examples/fixed.yaml", version);
        importer by;
        importer_open(&by, &fmu, version);
        by.sample = record_exit;
        importer_start(&by, 0);
        importer_integrate(&by, 1e-6);
        importer_go(&by, INFINITY);
        assert_true(by.ended);
        for (int i = 0; i < EXIT_FIGURES; i++)
            assert_true(same(recorded[i], importer_value(&by, exit_figures[i])));
        CHECK_WITHIN("rear adaptor out, as recorded [s]", recorded[0], 0.1594, 0.1595);
        CHECK_WITHIN("speed then, as recorded [m/s]", recorded[1], 30, 50);
        memcpy(x, by.x, by.states * sizeof *x);
        importer_place(&by, by.t + 1, x);
        importer_rates(&by, rate);
        for (size_t i = 0; i < by.states; i++)
            assert_true(rate[i] == 0);
        assert_false(importer_complete(&by));
        by.ended = false;
        importer_event(&by); // one that asks then is reported there
        assert_true(by.ended);
        importer_get_states(&by);
        assert_memory_equal(x, by.x, by.states * sizeof *x);
        importer_close(&by);
        fmu_close(&fmu);
    }
}

// ---- rates, states, outputs of one point ----

static const char *const outputs[] = {"rocket.s",          "tip.y",
                                      "rocket.pitch_rate", "energy.kinetic",
                                      "wrench.moment.z",   "summary.rocket.1.t_release"};
enum { OUTPUTS = sizeof outputs / sizeof *outputs };

// The names of states, in their order: of a rate it is in brackets.
static int state_names(const unpacked_fmu *fmu, char name[][64], int most)
{
    int count = 0;
    for (const char *at = fmu->description; (at = strstr(at, " name=\"state.")) && count < most;
         at++)
        attribute_after(at, "name", name[count++], 64);
    return count;
}

// An instance for co-simulation of the same FMU goes its way; where it is, states, rates, outputs
// of one that is placed there are its own. Its states change by its rates.
static void tells_the_same_at_a_point(void **state)
{
    (void)state;
    static char name[IMPORTER_MOST][64];
    static double x[3][IMPORTER_MOST], rate[IMPORTER_MOST], there[IMPORTER_MOST];
    const double h = 2e-6, t = 2e-3;
    unpacked_fmu fmu =
        fmu_open("examples/reference.yaml --set run.lead_in=0s --set run.tolerance=1e-11", 3);
    importer by, steps = {.fmu = &fmu, .version = 3};
    int count = state_names(&fmu, name, IMPORTER_MOST), unequal = 0;
    steps.instance = FMU_FUNCTION(&fmu, fmi3InstantiateCoSimulation)(
        "steps", fmu.token, fmu.resources, false, false, false, false, NULL, 0, NULL,
        importer_log_3, NULL);
    assert_non_null(steps.instance);
    OK_3(&steps, fmi3EnterInitializationMode, false, 0, 0, false, 0);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3ExitInitializationMode)(steps.instance), fmi3OK);
    importer_open(&by, &fmu, 3);
    importer_start(&by, 0);
    assert_int_equal(by.states, count);
    double told[OUTPUTS];
    const double ends[] = {0, t - h, t, t + h};
    for (int k = 0; k < 3; k++) {
        bool event, terminate, early;
        double reached;
        OK_3(&steps, fmi3DoStep, ends[k], ends[k + 1] - ends[k], true, &event, &terminate, &early,
             &reached);
        for (int i = 0; i < count; i++)
            x[k][i] = importer_value(&steps, name[i]);
        for (int i = 0; i < count && k == 1; i++) {
            char der[80];
            snprintf(der, sizeof der, "der(%.63s)", name[i]);
            rate[i] = importer_value(&steps, der);
        }
        for (int i = 0; i < OUTPUTS && k == 1; i++)
            told[i] = importer_value(&steps, outputs[i]);
    }
    importer_place(&by, t, x[1]);
    importer_rates(&by, there);
    for (int i = 0; i < count; i++)
        unequal += !same(rate[i], there[i]) + !same(x[1][i], importer_value(&by, name[i]));
    for (int i = 0; i < OUTPUTS; i++)
        unequal += !same(told[i], importer_value(&by, outputs[i]));
    printf("    %d states\n", count);
    CHECK_BELOW("rates, states and outputs that differ", unequal, 0);
    double worst = 0;
    for (int i = 0; i < count; i++) {
        double difference = (x[2][i] - x[0][i]) / (2 * h);
        worst = fmax(worst, fabs(difference - rate[i]) / (1 + fabs(rate[i])));
    }
    CHECK_BELOW("rates against differences of the states", worst, 2e-5);
    importer_close(&steps);
    importer_close(&by);
    fmu_close(&fmu);
}

// Rates of the point that was left for another's event, where the importer goes back to it.
static void goes_back_from_an_event(void **state)
{
    (void)state;
    static double rate[2][IMPORTER_MOST];
    unpacked_fmu fmu = fmu_open("examples/fixed.yaml", 3);
    importer by;
    int unequal = 0;
    importer_open(&by, &fmu, 3);
    importer_start(&by, 0);
    for (int k = 0; k < 2; k++) {
        importer_place(&by, 0.005, by.x);
        importer_rates(&by, rate[k]);
        if (k == 0) {
            importer_place(&by, by.next, by.x);
            assert_true(importer_complete(&by));
        }
    }
    for (size_t i = 0; i < by.states; i++)
        unequal += !same(rate[0][i], rate[1][i]);
    CHECK_BELOW("rates that differ, after an event was left", unequal, 0);
    importer_close(&by);
    fmu_close(&fmu);
}

// References of the variables whose names begin so, in the description's order.
static size_t listed(const unpacked_fmu *fmu, const char *prefix, uint32_t reference[IMPORTER_MOST])
{
    char wanted[64], value[32];
    size_t count = 0;
    snprintf(wanted, sizeof wanted, " name=\"%s", prefix);
    for (const char *at = fmu->description; (at = strstr(at, wanted)); at++) {
        attribute_after(at, "valueReference", value, sizeof value);
        reference[count++] = (uint32_t)strtoul(value, NULL, 10);
    }
    return count;
}

// States and rates, vectors as arrays, are those that the integrator has, in their order.
static void states_are_arrays_by_a_choice(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open("examples/fixed.yaml --arrays", 3);
    importer by;
    uint32_t states[IMPORTER_MOST], rates[IMPORTER_MOST];
    double rate[IMPORTER_MOST], got[IMPORTER_MOST], along[3];
    size_t count = listed(&fmu, "state.", states);
    assert_int_equal(listed(&fmu, "der(state.", rates), count);
    importer_open(&by, &fmu, 3);
    importer_start(&by, 0);
    importer_integrate(&by, 1e-6);
    importer_go(&by, 0.02);
    assert_true(count + 12 <
                by.states); // six vectors of three are 12 variables less, quaternions 3
    OK_3(&by, fmi3GetFloat64, states, count, got, by.states);
    assert_memory_equal(got, by.x, by.states * sizeof *got);
    importer_rates(&by, rate);
    OK_3(&by, fmi3GetFloat64, rates, count, got, by.states);
    assert_memory_equal(got, rate, by.states * sizeof *got);
    // a position's rate is the velocity's, turned into I: of the seeds' size
    const uint32_t unknown = reference_of(&fmu, "der(state.tube.position)"),
                   known = reference_of(&fmu, "state.tube.velocity");
    const double seed[3] = {0.3, -0.4, 1.2};
    OK_3(&by, fmi3GetDirectionalDerivative, &unknown, 1, &known, 1, seed, 3, along, 3);
    CHECK_NEAR("rate of a place along a velocity",
               sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]), 1.3, 1e-9);
    importer_close(&by);
    fmu_close(&fmu);
}

// Adaptors held on the axis: a step that ends off it asks for event mode, which puts it back.
static void asks_for_a_place_on_the_axis(void **state)
{
    (void)state;
    static const launch_case held = {
        "examples/line-thrower", {HELD, "rocket.contact.friction=0"}, 3, 1, true, false};
    static double x[IMPORTER_MOST];
    unpacked_fmu fmu = open_case(&held);
    int asked = 0;
    double put_back = 0;
    void *saved = NULL;
    importer by;
    importer_open(&by, &fmu, 3);
    importer_start(&by, 0);
    OK_3(&by, fmi3GetFMUState, &saved);
    for (size_t i = 0; i < by.states; i++) {
        OK_3(&by, fmi3SetFMUState, saved);
        importer_get_states(&by);
        memcpy(x, by.x, by.states * sizeof *x);
        x[i] += 1e-4;
        importer_place(&by, 1e-6, x);
        if (!importer_complete(&by))
            continue;
        asked++;
        importer_event(&by);
        put_back = fmax(put_back, fabs(by.x[i] - x[i]));
    }
    printf("    of %zu states %d ask\n", by.states, asked);
    assert_in_range(asked, 1, by.states - 1);
    CHECK_WITHIN("put back by [m, m/s]", put_back, 0.5e-4, 2e-4);
    OK_3(&by, fmi3FreeFMUState, &saved);
    importer_close(&by);
    fmu_close(&fmu);
}

// ---- inputs ----

// A deck that sways and turns.
static ld_base_frame swaying(double t)
{
    const double f = 2 * 3.141592653589793 * 0.3, angle = 0.1 * sin(f * t);
    return (ld_base_frame){
        .position = {0, 0.5 * sin(f * t), 0.2 * cos(f * t)},
        .quaternion = {cos(0.5 * angle), 0, 0, sin(0.5 * angle)},
        .velocity = {0, 0.5 * f * cos(f * t), -0.2 * f * sin(f * t)},
        .rate = {0, 0, 0.1 * f * cos(f * t)},
    };
}

static void tell_swaying(importer *self, double t)
{
    const ld_base_frame base = swaying(t);
    static const char *const of[] = {"position.x",   "position.y",   "position.z",   "quaternion.0",
                                     "quaternion.1", "quaternion.2", "quaternion.3", "velocity.x",
                                     "velocity.y",   "velocity.z",   "rate.x",       "rate.y",
                                     "rate.z"};
    uint32_t reference[13];
    double value[13];
    for (uint32_t i = 0; i < 13; i++) {
        char name[32];
        snprintf(name, sizeof name, "input.base.%s", of[i]);
        reference[i] = reference_by(name);
        value[i] = i < 3    ? base.position[i]
                   : i < 7  ? base.quaternion[i - 3]
                   : i < 10 ? base.velocity[i - 7]
                            : base.rate[i - 10];
    }
    OK_3(self, fmi3SetFloat64, reference, 13, value, 13);
}

static void write_external(void)
{
    assert_int_equal(run("sed -e 's/kind: fixed/kind: external/; /elevation:/d' -e "
                         "'s/^run:/run:\\n  lead_in: 0.1 s/' examples/fixed.yaml >external.yaml"),
                     0);
}

// The library is reported each 0.1 ms where the base is, and continues by accelerations.
static void moves_with_its_base(void **state)
{
    (void)state;
    static const launch_case outside = {"external", {NULL}, 3, 1, true, false};
    const char *const set[] = {"run.tolerance=1e-8", NULL};
    write_external();
    unpacked_fmu fmu = open_case(&outside);
    ld_base_frame base = swaying(-0.1);
    library from = begin_in_shell("external", set, &base);
    for (int i = 1; !ld_run_is_finished(from.run); i++) {
        double t = -0.1 + i * 1e-4;
        base = swaying(t);
        assert_int_equal(ld_run_advance(from.run, t, NULL), LD_OK);
        if (!ld_run_is_finished(from.run))
            assert_int_equal(ld_run_set_base(from.run, &base, NULL), LD_OK);
    }
    importer by;
    importer_open(&by, &fmu, 3);
    by.input = tell_swaying;
    tell_swaying(&by, -0.1);
    importer_start(&by, -0.1);
    // no work is done yet: behind the states of the base stand those
    assert_true(importer_value(&by, "state.work.thrust") == 0);
    assert_true(importer_value(&by, "state.work.base") == 0);
    // an input alone moves it
    static double rate[3][IMPORTER_MOST];
    importer_rates(&by, rate[0]);
    tell_swaying(&by, 0.4);
    importer_rates(&by, rate[1]);
    tell_swaying(&by, -0.1);
    importer_rates(&by, rate[2]);
    assert_memory_equal(rate[0], rate[2], by.states * sizeof(double));
    assert_memory_not_equal(rate[0], rate[1], by.states * sizeof(double));
    importer_integrate(&by, 1e-8);
    importer_go(&by, INFINITY);
    CHECK_BELOW("rates at the exit, on a base that is told [mrad/s]",
                1e3 * differ(&by, &from, 1, exit_rates, 2), 1e-2);
    importer_close(&by);
    library_end(&from);
    fmu_close(&fmu);
}

// On a clock of its own the importer ignites the rocket in event mode, between two steps of its
// own.
static void lights_by_the_input(void **state)
{
    (void)state;
    const char *const set[] = {"run.lead_in=0.02 s", "run.tolerance=1e-8", NULL};
    const double ahead = 10 - -0.02;
    const bool yes = true;
    unpacked_fmu fmu = fmu_open("examples/fixed.yaml --set run.lead_in=0.02s", 3);
    uint32_t wait = reference_of(&fmu, "ignition_by_input"),
             light = reference_of(&fmu, "input.ignition");
    importer by;
    importer_open(&by, &fmu, 3);
    OK_3(&by, fmi3SetBoolean, &wait, 1, &yes, 1);
    importer_start(&by, 10);
    assert_true(isinf(by.next)); // no one knows when
    importer_integrate(&by, 1e-8);
    importer_go(&by, 10.05);
    CHECK_BELOW("thrust before the input [N]", importer_value(&by, "thrust"), 0);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3EnterEventMode)(by.instance), fmi3OK);
    OK_3(&by, fmi3SetBoolean, &light, 1, &yes, 1);
    importer_update(&by);
    CHECK_BELOW("the next corner of the thrust [s]", by.next - 10.06, 1e-12);
    assert_int_equal(CVodeReInit(by.cvode, by.t, by.y), 0);
    importer_go(&by, 10.15);
    library from = begin_in_shell("examples/fixed", set, NULL);
    assert_int_equal(ld_run_ignite(from.run, INFINITY, NULL), LD_OK);
    assert_int_equal(ld_run_advance(from.run, 10.05 - ahead, NULL), LD_OK);
    assert_int_equal(ld_run_ignite(from.run, ld_run_time(from.run), NULL), LD_OK);
    assert_int_equal(ld_run_advance(from.run, 10.15 - ahead, NULL), LD_OK);
    double s;
    assert_int_equal(ld_run_number(from.run, "rocket.s", &s, NULL), LD_OK);
    CHECK_BELOW("travel, lit by the input [m]", importer_value(&by, "rocket.s") - s, 1e-8);
    CHECK_WITHIN("travel then [m]", s, 1, 4);
    importer_close(&by);
    library_end(&from);
    fmu_close(&fmu);
}

// ---- states ----

static void take_states(importer *self, int count, double *value)
{
    for (int i = 0; i < count; i++)
        value[i] = importer_value(self, outputs[i]);
}

// Saved before the release, with a step of CVODE under way; both instances continue to beyond it.
static void states_come_back(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open("examples/fixed.yaml", 3);
    importer by, other;
    void *saved = NULL, *back = NULL;
    size_t size;
    double value[2][OUTPUTS];
    importer_open(&by, &fmu, 3);
    importer_open(&other, &fmu, 3);
    importer_start(&by, 0);
    importer_start(&other, 0);
    importer_integrate(&by, 1e-7);
    importer_integrate(&other, 1e-7);
    importer_go(&by, 2.5e-3);
    OK_3(&by, fmi3GetFMUState, &saved);
    OK_3(&by, fmi3SerializedFMUStateSize, saved, &size);
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    OK_3(&by, fmi3SerializeFMUState, saved, bytes, size);
    OK_3(&other, fmi3DeserializeFMUState, bytes, size, &back);
    OK_3(&other, fmi3SetFMUState, back);
    importer_get_states(&other);
    other.t = by.t;
    other.next = by.next;
    importer *const both[] = {&by, &other};
    int unequal = 0, events = by.events;
    for (int k = 0; k < 2; k++) {
        assert_int_equal(CVodeReInit(both[k]->cvode, both[k]->t, both[k]->y), 0);
        importer_go(both[k], 0.02);
        take_states(both[k], OUTPUTS, value[k]);
    }
    for (int i = 0; i < OUTPUTS; i++)
        unequal += !same(value[0][i], value[1][i]);
    CHECK_BELOW("outputs that differ after a state came back", unequal, 0);
    assert_int_equal(by.events - events, 2); // the release, a corner of the thrust
    CHECK_WITHIN("release [s]", value[0][OUTPUTS - 1], 3.8e-3, 3.82e-3);
    OK_3(&by, fmi3SetFMUState, saved);
    importer_get_states(&by);
    CHECK_BELOW("release, before it [-]", !isnan(importer_value(&by, outputs[OUTPUTS - 1])), 0);
    // a state that is refused leaves the run where it is
    static double rate[2][IMPORTER_MOST];
    importer_rates(&other, rate[0]);
    bytes[size / 2] ^= 4;
    OK_3(&other, fmi3FreeFMUState, &back);
    OK_3(&other, fmi3DeserializeFMUState, bytes, size, &back);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetFMUState)(other.instance, back), fmi3Error);
    importer_rates(&other, rate[1]);
    assert_memory_equal(rate[0], rate[1], other.states * sizeof(double));
    importer_complete(&other);
    OK_3(&by, fmi3FreeFMUState, &saved);
    OK_3(&other, fmi3FreeFMUState, &back);
    free(bytes);
    importer_close(&by);
    importer_close(&other);
    fmu_close(&fmu);
}

// ---- what is wrong ----

static char logged[2048];

static void keep_log(void *environment, fmi3Status status, const char *category,
                     const char *message)
{
    (void)environment, (void)category;
    assert_true(status == fmi3Error || status == fmi3Discard);
    snprintf(logged, sizeof logged, "%s", message);
}

static void *open_logged(const unpacked_fmu *fmu)
{
    return FMU_FUNCTION(fmu, fmi3InstantiateModelExchange)("one", fmu->token, fmu->resources, false,
                                                           false, NULL, keep_log);
}

#define REFUSED(call, sentence)                                                                    \
    do {                                                                                           \
        assert_int_equal(call, fmi3Error);                                                         \
        assert_string_equal(logged, sentence);                                                     \
    } while (0)

static void refuses_wrong_calls(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open("examples/fixed.yaml", 3);
    importer by = {.fmu = &fmu, .version = 3, .instance = open_logged(&fmu)};
    void *one = by.instance;
    bool a, b;
    double t, x[IMPORTER_MOST];
    assert_non_null(one);
    REFUSED(FMU_FUNCTION(&fmu, fmi3SetTime)(one, 0), "the run has not begun");
    REFUSED(FMU_FUNCTION(&fmu, fmi3EnterEventMode)(one), "the run has not begun");
    importer_start(&by, 0);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3EnterEventMode)(one), fmi3OK);
    REFUSED(FMU_FUNCTION(&fmu, fmi3SetContinuousStates)(one, by.x, by.states),
            "the instance is in event mode: enter continuous-time mode first");
    REFUSED(FMU_FUNCTION(&fmu, fmi3CompletedIntegratorStep)(one, true, &a, &b),
            "the instance is in event mode: enter continuous-time mode first");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3EnterContinuousTimeMode)(one), fmi3OK);
    REFUSED(FMU_FUNCTION(&fmu, fmi3UpdateDiscreteStates)(one, &a, &b, &a, &b, &a, &t),
            "the instance is in continuous-time mode: enter event mode first");
    REFUSED(FMU_FUNCTION(&fmu, fmi3DoStep)(one, 0, 0.1, true, &a, &b, &a, &t),
            "this is a model-exchange instance: its importer integrates it");
    REFUSED(FMU_FUNCTION(&fmu, fmi3SetTime)(one, NAN), "the time is not a number");
    REFUSED(FMU_FUNCTION(&fmu, fmi3GetContinuousStates)(one, x, 3),
            "found 3 numbers for 64 continuous states");
    REFUSED(FMU_FUNCTION(&fmu, fmi3GetEventIndicators)(one, x, 3),
            "found 3 numbers for 8 event indicators");
    memcpy(x, by.x, by.states * sizeof *x);
    x[1] = NAN;
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetContinuousStates)(one, x, by.states), fmi3Discard);
    assert_string_equal(logged, "a state is not a number");
    for (size_t i = 0; i < by.states; i++)
        x[i] = 1e200;
    importer_place(&by, 0, x);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetContinuousStateDerivatives)(one, x, by.states),
                     fmi3Discard);
    assert_string_equal(logged, "the equations of motion gave no finite result at t = 0 s");
    // the thrust has a corner at 10 ms; by rounding a step may miss it
    assert_float_equal(by.next, 0.01, 0);
    importer_place(&by, 0.01 + 1e-6, by.x);
    REFUSED(FMU_FUNCTION(&fmu, fmi3CompletedIntegratorStep)(one, true, &a, &b),
            "found a step that ends at 0.010000999999999999 s after one that ended at 0 s; "
            "expected at most the next event, at 0.01 s");
    importer_place(&by, 0.01 - 1e-15, by.x);
    assert_true(importer_complete(&by));
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(one);
    fmu_close(&fmu);
}

// What cannot be taken so is not offered so.
static void refuses_what_it_cannot(void **state)
{
    (void)state;
    static const char *const scenarios[] = {"examples/reference.yaml --set run.coupling.step=1ms",
                                            "external.yaml --set '" CLAMPS "'"},
                             *const sentences[] = {"run.coupling: ", "tubes.supports.clamped: "};
    write_external();
    for (int i = 0; i < 2; i++) {
        unpacked_fmu fmu = fmu_open(scenarios[i], 3);
        assert_null(strstr(fmu.description, "<ModelExchange"));
        assert_null(strstr(fmu.description, "EventIndicator"));
        assert_non_null(strstr(fmu.description, "<CoSimulation"));
        assert_null(open_logged(&fmu));
        assert_memory_equal(logged, sentences[i], strlen(sentences[i]));
        fmu_close(&fmu);
    }
}

// ---- vehicle and launcher, each for model exchange

enum { FRAME = 13, WRENCH = 6 };

typedef struct halves {
    importer vehicle, launcher;
    uint32_t frame[FRAME], wrench[WRENCH], told_frame[FRAME], told_wrench[WRENCH];
} halves;

static void refer(const unpacked_fmu *fmu, const char *prefix, int count, uint32_t *reference)
{
    static const char *const of_wrench[] = {"force.x",  "force.y",  "force.z",
                                            "moment.x", "moment.y", "moment.z"};
    static const char *const of_frame[] = {
        "position.x",   "position.y",   "position.z", "quaternion.0", "quaternion.1",
        "quaternion.2", "quaternion.3", "velocity.x", "velocity.y",   "velocity.z",
        "rate.x",       "rate.y",       "rate.z"};
    for (int i = 0; i < count; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%s", prefix, count == WRENCH ? of_wrench[i] : of_frame[i]);
        reference[i] = reference_of(fmu, name);
    }
}

// Both are where their states say: the frame follows from the vehicle's, the wrench from both.
static void place_halves(halves *self, double t, const double *y)
{
    double frame[FRAME], wrench[WRENCH];
    importer_place(&self->vehicle, t, y);
    importer_place(&self->launcher, t, y + self->vehicle.states);
    OK_3(&self->vehicle, fmi3GetFloat64, self->frame, FRAME, frame, FRAME);
    OK_3(&self->launcher, fmi3SetFloat64, self->told_frame, FRAME, frame, FRAME);
    OK_3(&self->launcher, fmi3GetFloat64, self->wrench, WRENCH, wrench, WRENCH);
    OK_3(&self->vehicle, fmi3SetFloat64, self->told_wrench, WRENCH, wrench, WRENCH);
}

static int halves_f(double t, N_Vector y, N_Vector y_dot, void *user)
{
    halves *self = user;
    place_halves(self, t, N_VGetArrayPointer(y));
    importer_rates(&self->vehicle, N_VGetArrayPointer(y_dot));
    importer_rates(&self->launcher, N_VGetArrayPointer(y_dot) + self->vehicle.states);
    return 0;
}

static int halves_g(double t, N_Vector y, double *value, void *user)
{
    halves *self = user;
    place_halves(self, t, N_VGetArrayPointer(y));
    importer_indicators(&self->vehicle, value);
    importer_indicators(&self->launcher, value + self->vehicle.indicators);
    return 0;
}

// The states of both stand one after the other in `both`, which has their integrator alone.
static void integrate_halves(halves *self, importer *both, double tolerance)
{
    double *atol;
    *both =
        (importer){.t = self->launcher.t, .states = self->vehicle.states + self->launcher.states};
    memcpy(both->x, self->vehicle.x, self->vehicle.states * sizeof *both->x);
    memcpy(both->x + self->vehicle.states, self->launcher.x,
           self->launcher.states * sizeof *both->x);
    assert_int_equal(SUNContext_Create(NULL, &both->context), 0);
    both->y = N_VMake_Serial((sunindextype)both->states, both->x, both->context);
    both->tolerance = N_VNew_Serial((sunindextype)both->states, both->context);
    atol = N_VGetArrayPointer(both->tolerance);
    OK_3(&self->vehicle, fmi3GetNominalsOfContinuousStates, atol, self->vehicle.states);
    OK_3(&self->launcher, fmi3GetNominalsOfContinuousStates, atol + self->vehicle.states,
         self->launcher.states);
    for (size_t i = 0; i < both->states; i++)
        atol[i] *= tolerance;
    both->cvode = CVodeCreate(CV_ADAMS, both->context);
    assert_int_equal(CVodeInit(both->cvode, halves_f, both->t, both->y), 0);
    assert_int_equal(CVodeSetUserData(both->cvode, self), 0);
    assert_int_equal(CVodeSVtolerances(both->cvode, tolerance, both->tolerance), 0);
    assert_int_equal(CVodeRootInit(both->cvode,
                                   (int)(self->vehicle.indicators + self->launcher.indicators),
                                   halves_g),
                     0);
    assert_int_equal(CVodeSetNoInactiveRootWarn(both->cvode), 0);
    assert_int_equal(CVodeSetMaxNumSteps(both->cvode, 1000000), 0);
    both->solver = SUNNonlinSol_FixedPoint(both->y, 0, both->context);
    assert_int_equal(CVodeSetNonlinearSolver(both->cvode, both->solver), 0);
}

static void go_halves(halves *self, importer *both)
{
    importer *half[] = {&self->vehicle, &self->launcher};
    while (!self->launcher.ended) {
        double stop = fmin(fmin(self->vehicle.next, self->launcher.next), both->t + 1);
        CVodeSetStopTime(both->cvode, stop);
        int flag = CVode(both->cvode, stop, both->y, &both->t, CV_ONE_STEP);
        assert_true(flag >= 0);
        both->steps++;
        place_halves(self, both->t, both->x);
        bool asked = importer_complete(half[0]);
        asked |= importer_complete(half[1]);
        if (!asked && flag != CV_ROOT_RETURN && both->t != stop)
            continue;
        double *x = both->x;
        for (int i = 0; i < 2; x += half[i]->states, i++) {
            importer_event(half[i]);
            memcpy(x, half[i]->x, half[i]->states * sizeof *x);
        }
        if (!self->launcher.ended)
            assert_int_equal(CVodeReInit(both->cvode, both->t, both->y), 0);
    }
}

// One integrator takes both as one system without an algebraic loop: as the library's launch.
static void a_vehicle_and_its_launcher_are_one_launch(void **state)
{
    (void)state;
    static const struct {
        const char *scenario;
        const char *more;
    } cases[] = {
        {"examples/reference", "platform.elevation.stabiliser.sample=7 ms"},
        {"examples/multibody/sled", "run.end=0.5 s"},
    };
    static halves self;
    static importer both;
    for (int i = 0; i < OF_ALL(2, 1); i++) {
        char line[200];
        const char *set[] = {"run.lead_in=0.1 s", cases[i].more, "run.tolerance=1e-8", NULL};
        snprintf(line, sizeof line, "%s.yaml --set '%s' --set '%s' --part vehicle",
                 cases[i].scenario, set[0], set[1]);
        unpacked_fmu vehicle = fmu_open(line, 3);
        snprintf(line, sizeof line, "%s.yaml --set '%s' --set '%s' --part launcher",
                 cases[i].scenario, set[0], set[1]);
        unpacked_fmu launcher = fmu_open(line, 3);
        library from = begin_in_shell(cases[i].scenario, set, NULL);
        double start = ld_run_time(from.run);
        assert_int_equal(ld_run_advance(from.run, INFINITY, NULL), LD_OK);
        importer_open(&self.vehicle, &vehicle, 3);
        importer_open(&self.launcher, &launcher, 3);
        importer_start(&self.vehicle, start);
        importer_start(&self.launcher, start);
        refer(&vehicle, "base", FRAME, self.frame);
        refer(&vehicle, "input.wrench", WRENCH, self.told_wrench);
        refer(&launcher, "input.base", FRAME, self.told_frame);
        refer(&launcher, "wrench", WRENCH, self.wrench);
        integrate_halves(&self, &both, 1e-8);
        go_halves(&self, &both);
        printf("    %s: %zu and %zu states, %d steps\n", cases[i].scenario, self.vehicle.states,
               self.launcher.states, both.steps);
        CHECK_BELOW("exit rates of two FMUs by one integrator [mrad/s]",
                    1e3 * differ(&self.launcher, &from, 1, exit_rates, 2), 1e-4);
        CHECK_BELOW("release and exits [s]", differ(&self.launcher, &from, 1, times, 3), 2e-9);
        CVodeFree(&both.cvode);
        SUNNonlinSolFree(both.solver);
        N_VDestroy(both.y);
        N_VDestroy(both.tolerance);
        SUNContext_Free(&both.context);
        importer_close(&self.vehicle);
        importer_close(&self.launcher);
        library_end(&from);
        fmu_close(&vehicle);
        fmu_close(&launcher);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_vehicle_and_its_launcher_are_one_launch, shell_make,
                                        shell_remove),
        cmocka_unit_test_setup_teardown(comes_to_what_the_library_comes_to, shell_make,
                                        shell_remove),
        cmocka_unit_test_setup_teardown(the_end_is_recorded, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(tells_the_same_at_a_point, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(goes_back_from_an_event, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(states_are_arrays_by_a_choice, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(asks_for_a_place_on_the_axis, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(moves_with_its_base, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(lights_by_the_input, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(states_come_back, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(refuses_wrong_calls, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(refuses_what_it_cannot, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
