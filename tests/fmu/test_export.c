// FMUs for co-simulation, by an importer of our own: what they report is what the library reports,
// to the bit, in steps of any length; states come back to the bit; early returns stand at the
// events; what is wrong is refused with a line of the log.
// link: -ldl -lz
#include <pthread.h>

#include <zlib.h>

#include "fmu/fmi2_interface.h"
#include "fmu/fmi3_interface.h"
#include "launchdyn/summary.h"
#include "support/fmu.h"
#include "support/library_run.h"

#define EXAMPLE(name) LD_SOURCE_DIR "/examples/" name ".yaml"
#define MULTIBODY LD_SOURCE_DIR "/tests/data/multibody/launcher.yaml"

// ---- the library ----

// With one override, or NULL.
static library begin_with(const char *scenario, const char *set, const ld_base_frame *base)
{
    return library_begin(scenario, &set, set != NULL, base);
}

static double told(library *self, const char *name)
{
    double value;
    ld_error error;
    ld_base_wrench wrench;
    if (strncmp(name, "summary.", 8) == 0) {
        assert_int_equal(ld_summary_number(ld_run_summary(self->run), name + 8, &value, &error),
                         LD_OK);
    } else if (strcmp(name, "wrench.moment.z") == 0) {
        assert_int_equal(ld_run_base_wrench(self->run, &wrench, &error), LD_OK);
        value = wrench.moment[2];
    } else {
        assert_int_equal(ld_run_number(self->run, name, &value, &error), LD_OK);
    }
    return value;
}

// ---- FMI 3 ----

static char logged[2048];

static void keep_log(void *environment, fmi3Status status, const char *category,
                     const char *message)
{
    (void)environment;
    assert_int_equal(status, fmi3Error);
    assert_string_equal(category, "logStatusError");
    snprintf(logged, sizeof logged, "%s", message);
}

static void *begin_3(const unpacked_fmu *fmu, bool at_events)
{
    void *instance = FMU_FUNCTION(fmu, fmi3InstantiateCoSimulation)(
        "one", fmu->token, fmu->resources, false, false, at_events, at_events, NULL, 0, NULL,
        keep_log, NULL);
    assert_non_null(instance);
    return instance;
}

static void start_3(const unpacked_fmu *fmu, void *instance, double start)
{
    assert_int_equal(
        FMU_FUNCTION(fmu, fmi3EnterInitializationMode)(instance, false, 0, start, false, 0),
        fmi3OK);
    assert_int_equal(FMU_FUNCTION(fmu, fmi3ExitInitializationMode)(instance), fmi3OK);
}

typedef struct taken_step {
    bool event, terminate, early;
    double t;
} taken_step;

static taken_step step_3(const unpacked_fmu *fmu, void *instance, double t, double size)
{
    taken_step s;
    assert_int_equal(FMU_FUNCTION(fmu, fmi3DoStep)(instance, t, size, true, &s.event, &s.terminate,
                                                   &s.early, &s.t),
                     fmi3OK);
    return s;
}

static double value_3(const unpacked_fmu *fmu, void *instance, const char *name)
{
    uint32_t reference = reference_of(fmu, name);
    double value;
    assert_int_equal(FMU_FUNCTION(fmu, fmi3GetFloat64)(instance, &reference, 1, &value, 1), fmi3OK);
    return value;
}

static fmi3Status set_3(const unpacked_fmu *fmu, void *instance, const char *name, double value)
{
    uint32_t reference = reference_of(fmu, name);
    return FMU_FUNCTION(fmu, fmi3SetFloat64)(instance, &reference, 1, &value, 1);
}

static fmi3Status set_count_3(const unpacked_fmu *fmu, void *instance, const char *name,
                              int32_t value)
{
    uint32_t reference = reference_of(fmu, name);
    return FMU_FUNCTION(fmu, fmi3SetInt32)(instance, &reference, 1, &value, 1);
}

static const char *const outputs[] = {"rocket.s",
                                      "tip.y",
                                      "rocket.pitch_rate",
                                      "energy.kinetic",
                                      "wrench.moment.z",
                                      "summary.rocket.1.t_release",
                                      "summary.rocket.1.exit_speed"};
enum { OUTPUTS = sizeof outputs / sizeof *outputs };

static bool same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static int count_unequal(const unpacked_fmu *fmu, void *instance, library *by)
{
    int unequal = 0;
    for (int i = 0; i < OUTPUTS; i++)
        unequal += !same(value_3(fmu, instance, outputs[i]), told(by, outputs[i]));
    return unequal;
}

static void tells_what_the_library_tells(void **state)
{
    (void)state;
    static const char *const scenarios[] = {EXAMPLE("fixed"), EXAMPLE("ship"), EXAMPLE("smooth"),
                                            MULTIBODY};
    for (int i = 0; i < 4; i++) {
        unpacked_fmu fmu = fmu_open(scenarios[i], 3);
        library by = begin_with(scenarios[i], NULL, NULL);
        void *instance = begin_3(&fmu, false);
        double t = ld_run_time(by.run);
        int unequal = 0, steps = 0;
        start_3(&fmu, instance, t);
        for (; steps < 60; steps++) {
            double size = 1e-4 * (1 + steps * 7 % 60);
            unequal += count_unequal(&fmu, instance, &by);
            assert_true(same(value_3(&fmu, instance, "time"), t));
            taken_step s = step_3(&fmu, instance, t, size);
            assert_int_equal(ld_run_advance(by.run, t + size, NULL), LD_OK);
            if (s.terminate)
                break;
            t += size;
            assert_true(same(s.t, t));
        }
        CHECK_BELOW("outputs that differ from the library's", unequal, 0);
        FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
        library_end(&by);
        fmu_close(&fmu);
    }
}

static void returns_at_events(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("fixed"), 3);
    library by = begin_with(EXAMPLE("fixed"), NULL, NULL);
    void *instance = begin_3(&fmu, true);
    double t = 0, worst = 0;
    int events = 0;
    bool ended = false;
    start_3(&fmu, instance, t);
    while (!ended) {
        ld_event event;
        bool again, terminate, nominals, values, defined;
        double next;
        taken_step s = step_3(&fmu, instance, t, 0.05);
        t = s.t;
        ended = s.terminate;
        if (!s.event)
            continue;
        do
            assert_int_equal(ld_run_advance_to_event(by.run, INFINITY, &event, NULL), LD_OK);
        while (event.kind != LD_EVENT_RELEASE && event.kind != LD_EVENT_EXIT &&
               event.kind != LD_EVENT_END && event.kind != LD_EVENT_IGNITION);
        worst = fmax(worst, fabs(event.t - t));
        events++;
        assert_int_equal(FMU_FUNCTION(&fmu, fmi3EnterEventMode)(instance), fmi3OK);
        assert_int_equal(FMU_FUNCTION(&fmu, fmi3UpdateDiscreteStates)(
                             instance, &again, &terminate, &nominals, &values, &defined, &next),
                         fmi3OK);
        assert_true(!again && !values && !defined && terminate == ended);
        assert_int_equal(FMU_FUNCTION(&fmu, fmi3EnterStepMode)(instance), fmi3OK);
    }
    CHECK_BELOW("instants of release, exits and end [s]", worst, 0);
    assert_int_equal(events, 5);
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
    library_end(&by);
    fmu_close(&fmu);
}

static void parameters_are_overrides(void **state)
{
    (void)state;
    static const char *const sets[] = {"rocket.mass=61 kg", "rocket.inertia=0.22 23.9 24 kg.m2",
                                       "rocket.motor.misalignment=0 2 mrad",
                                       "tubes.modes.elements=48"};
    unpacked_fmu fmu = fmu_open(EXAMPLE("fixed"), 3);
    library by = library_begin(EXAMPLE("fixed"), sets, 4, NULL);
    void *instance = begin_3(&fmu, false);
    uint32_t law = reference_of(&fmu, "scenario.rocket.contact.law"),
             elements = reference_of(&fmu, "scenario.tubes.modes.elements");
    const char *word;
    int32_t count;
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetInt32)(instance, &elements, 1, &count, 1), fmi3OK);
    assert_int_equal(count, 60);
    assert_int_equal(set_count_3(&fmu, instance, "scenario.tubes.modes.elements", 48), fmi3OK);
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.inertia.y", 23.9), fmi3OK);
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.motor.misalignment.z", 0.002), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetString)(instance, &law, 1, &word, 1), fmi3OK);
    assert_string_equal(word, "hunt-crossley");
    CHECK_BELOW("start of a parameter", value_3(&fmu, instance, "scenario.rocket.mass") - 60, 0);
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.mass", 61), fmi3OK);
    start_3(&fmu, instance, 0);
    step_3(&fmu, instance, 0, 0.1);
    assert_int_equal(ld_run_advance(by.run, 0.1, NULL), LD_OK);
    CHECK_BELOW("outputs that differ from those of the override",
                count_unequal(&fmu, instance, &by), 0);
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.mass", 62), fmi3Error);
    assert_string_equal(logged, "scenario.rocket.mass is fixed once the run has begun");

    assert_int_equal(FMU_FUNCTION(&fmu, fmi3Reset)(instance), fmi3OK);
    CHECK_BELOW("a parameter after a reset", value_3(&fmu, instance, "scenario.rocket.mass") - 60,
                0);
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
    library_end(&by);
    fmu_close(&fmu);
}

static void states_come_back(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("ship"), 3);
    void *instance = begin_3(&fmu, false), *other = begin_3(&fmu, false), *saved = NULL,
         *back = NULL;
    size_t size;
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.mass", 61), fmi3OK);
    start_3(&fmu, instance, 0);
    step_3(&fmu, instance, 0, 0.0307);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetFMUState)(instance, &saved), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SerializedFMUStateSize)(instance, saved, &size),
                     fmi3OK);
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SerializeFMUState)(instance, saved, bytes, size - 1),
                     fmi3Error);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SerializeFMUState)(instance, saved, bytes, size),
                     fmi3OK);

    double first[OUTPUTS];
    int unequal = 0;
    step_3(&fmu, instance, 0.0307, 0.05);
    for (int i = 0; i < OUTPUTS; i++)
        first[i] = value_3(&fmu, instance, outputs[i]);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetFMUState)(instance, saved), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3DeserializeFMUState)(other, bytes, size, &back),
                     fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetFMUState)(other, back), fmi3OK);
    void *const again[] = {instance, other};
    for (int k = 0; k < 2; k++) {
        step_3(&fmu, again[k], 0.0307, 0.05);
        for (int i = 0; i < OUTPUTS; i++)
            unequal += !same(first[i], value_3(&fmu, again[k], outputs[i]));
    }
    CHECK_BELOW("outputs that differ after a state came back", unequal, 0);

    // bytes damaged in the run and in what stands before it, and too few; the run continues
    const size_t damaged[] = {size / 2, 20};
    for (int k = 0; k < 3; k++) {
        if (k < 2)
            bytes[damaged[k]] ^= 4;
        FMU_FUNCTION(&fmu, fmi3FreeFMUState)(other, &back);
        assert_int_equal(FMU_FUNCTION(&fmu, fmi3DeserializeFMUState)(
                             other, bytes, k < 2 ? size : size / 3, &back),
                         fmi3OK);
        if (k < 2)
            bytes[damaged[k]] ^= 4;
        assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetFMUState)(other, back), fmi3Error);
    }
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetFMUState)(other, NULL), fmi3Error);
    unequal = 0;
    for (int k = 0; k < 2; k++) {
        step_3(&fmu, again[k], 0.0807, 0.04);
        for (int i = 0; i < OUTPUTS; i++)
            first[i] = k == 0 ? value_3(&fmu, again[k], outputs[i]) : first[i];
        for (int i = 0; i < OUTPUTS; i++)
            unequal += !same(first[i], value_3(&fmu, again[k], outputs[i]));
    }
    CHECK_BELOW("outputs that differ after a state was refused", unequal, 0);
    FMU_FUNCTION(&fmu, fmi3FreeFMUState)(other, &back);
    FMU_FUNCTION(&fmu, fmi3FreeFMUState)(instance, &saved);
    assert_null(saved);
    free(bytes);
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(other);
    fmu_close(&fmu);
}

// ---- an externally driven base ----

static ld_base_frame swaying(double t)
{
    double angle = 0.3 + 0.02 * sin(3 * t);
    return (ld_base_frame){.position = {8 * t, 0.05 * sin(5 * t), 0},
                           .quaternion = {cos(angle / 2), 0, 0, sin(angle / 2)},
                           .velocity = {8, 0.25 * cos(5 * t), 0},
                           .rate = {0, 0, 0.06 * cos(3 * t)}};
}

static void tell_3(const unpacked_fmu *fmu, void *instance, const ld_base_frame *base)
{
    static const char *const axis[] = {"x", "y", "z"};
    char name[64];
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof name, "input.base.position.%s", axis[i]);
        assert_int_equal(set_3(fmu, instance, name, base->position[i]), fmi3OK);
        snprintf(name, sizeof name, "input.base.velocity.%s", axis[i]);
        assert_int_equal(set_3(fmu, instance, name, base->velocity[i]), fmi3OK);
        snprintf(name, sizeof name, "input.base.rate.%s", axis[i]);
        assert_int_equal(set_3(fmu, instance, name, base->rate[i]), fmi3OK);
    }
    for (int i = 0; i < 4; i++) {
        snprintf(name, sizeof name, "input.base.quaternion.%d", i);
        assert_int_equal(set_3(fmu, instance, name, base->quaternion[i]), fmi3OK);
    }
}

// A scenario in the shell's folder.
static const char *make_external(void)
{
    assert_int_equal(run("sed -e 's/kind: fixed/kind: external/; /elevation:/d' -e "
                         "'s/^run:/run:\\n  lead_in: 0.1 s/' examples/fixed.yaml >external.yaml"),
                     0);
    return "external.yaml";
}

static void moves_with_its_base(void **state)
{
    (void)state;
    const char *scenario = make_external();
    char path[128];
    snprintf(path, sizeof path, "%s/%s", shell.folder, scenario);
    unpacked_fmu fmu = fmu_open(scenario, 3);
    ld_base_frame base = swaying(-0.1);
    library by = begin_with(path, NULL, &base);
    void *instance = begin_3(&fmu, false);
    int unequal = 0;
    tell_3(&fmu, instance, &base);
    start_3(&fmu, instance, -0.1);
    for (int i = 0; i < 200; i++) {
        double t = -0.1 + i * 1e-3, size = -0.1 + (i + 1) * 1e-3 - t;
        base = swaying(t);
        tell_3(&fmu, instance, &base);
        if (i > 0)
            assert_int_equal(ld_run_set_base(by.run, &base, NULL), LD_OK);
        step_3(&fmu, instance, t, size);
        assert_int_equal(ld_run_advance(by.run, t + size, NULL), LD_OK);
        unequal += count_unequal(&fmu, instance, &by);
    }
    CHECK_BELOW("outputs that differ, on a base that is told", unequal, 0);
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
    library_end(&by);
    fmu_close(&fmu);
}

// ---- ignition by the input ----

static void waits_for_the_input(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("fixed"), 3);
    void *instance = begin_3(&fmu, false);
    uint32_t wait = reference_of(&fmu, "ignition_by_input"),
             light = reference_of(&fmu, "input.ignition");
    bool yes = true;
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetBoolean)(instance, &wait, 1, &yes, 1), fmi3OK);
    assert_int_equal(set_3(&fmu, instance, "scenario.run.lead_in", 0.02), fmi3OK);
    start_3(&fmu, instance, 10); // the importer's clock is another one
    step_3(&fmu, instance, 10, 0.05);
    CHECK_BELOW("thrust before the input [N]", value_3(&fmu, instance, "thrust"), 0);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetBoolean)(instance, &light, 1, &yes, 1), fmi3OK);
    step_3(&fmu, instance, 10.05, 0.1);
    step_3(&fmu, instance, 10.05 + 0.1, 0.05); // the input is still true
    const double ahead = 10 - -0.02;
    library by = begin_with(EXAMPLE("fixed"), "run.lead_in=0.02 s", NULL);
    assert_int_equal(ld_run_ignite(by.run, INFINITY, NULL), LD_OK);
    assert_int_equal(ld_run_advance(by.run, 10.05 - ahead, NULL), LD_OK);
    assert_int_equal(ld_run_ignite(by.run, ld_run_time(by.run), NULL), LD_OK);
    assert_int_equal(ld_run_advance(by.run, 10.05 + 0.1 + 0.05 - ahead, NULL), LD_OK);
    CHECK_BELOW("outputs that differ, lit by the input", count_unequal(&fmu, instance, &by), 0);
    CHECK_WITHIN("travel then [m]", value_3(&fmu, instance, "rocket.s"), 1, 4);
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
    library_end(&by);
    fmu_close(&fmu);
}

// ---- FMI 2, and what is wrong ----

static void keep_log_2(void *environment, const char *name, fmi2Status status, const char *category,
                       const char *message, ...)
{
    va_list arguments;
    (void)environment, (void)category;
    assert_int_equal(status, fmi2Error);
    assert_string_equal(name, "two");
    va_start(arguments, message);
    vsnprintf(logged, sizeof logged, message, arguments);
    va_end(arguments);
}

static void speaks_version_2(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("fixed"), 2);
    library by = begin_with(EXAMPLE("fixed"), NULL, NULL);
    const fmi2CallbackFunctions call = {.logger = keep_log_2};
    char uri[256];
    snprintf(uri, sizeof uri, "file://localhost%s", fmu.resources);
    char *at = strstr(uri, "unpacked"); // its first letter as %75
    memmove(at + 3, at + 1, strlen(at));
    memcpy(at, "%75", 3);
    void *c =
        FMU_FUNCTION(&fmu, fmi2Instantiate)("two", fmi2CoSimulation, fmu.token, uri, &call, 0, 0);
    assert_non_null(c);
    assert_string_equal(FMU_FUNCTION(&fmu, fmi2GetVersion)(), "2.0");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetupExperiment)(c, 0, 0, 0, 0, 0), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2EnterInitializationMode)(c), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2ExitInitializationMode)(c), fmi2OK);
    double t = 0, value;
    int unequal = 0, ended = 0;
    while (!ended) {
        fmi2Status status = FMU_FUNCTION(&fmu, fmi2DoStep)(c, t, 0.02, 1);
        assert_int_equal(ld_run_advance(by.run, t + 0.02, NULL), LD_OK);
        assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetBooleanStatus)(c, fmi2Terminated, &ended),
                         fmi2OK);
        assert_int_equal(status, ended ? fmi2Discard : fmi2OK);
        assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetRealStatus)(c, fmi2LastSuccessfulTime, &t),
                         fmi2OK);
        for (int i = 0; i < OUTPUTS; i++) {
            unsigned reference = reference_of(&fmu, outputs[i]);
            assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetReal)(c, &reference, 1, &value), fmi2OK);
            unequal += !same(value, told(&by, outputs[i]));
        }
    }
    CHECK_BELOW("outputs that differ from the library's, FMI 2", unequal, 0);
    CHECK_BELOW("where the launch ends [s]", t - ld_run_time(by.run), 0);

    assert_int_equal(FMU_FUNCTION(&fmu, fmi2DoStep)(c, t + 1, 0.02, 1), fmi2Error);
    assert_non_null(strstr(logged, "; the run is at"));
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetTime)(c, 0), fmi2Error);
    assert_string_equal(logged, "this is a co-simulation instance: it has its own integrator");
    unsigned none = 100000, output = reference_of(&fmu, "tip.y");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetReal)(c, &none, 1, &value), fmi2Error);
    assert_string_equal(logged, "variable 100000 does not exist");
    value = 1;
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetReal)(c, &output, 1, &value), fmi2Error);
    assert_string_equal(logged, "tip.y is neither an input nor a parameter");
    int truth;
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetBoolean)(c, &output, 1, &truth), fmi2Error);
    assert_string_equal(logged, "tip.y is of another type");
    FMU_FUNCTION(&fmu, fmi2FreeInstance)(c);
    assert_null(
        FMU_FUNCTION(&fmu, fmi2Instantiate)("two", fmi2CoSimulation, "{other}", uri, &call, 0, 0));
    assert_non_null(strstr(logged, "found the token {other}, expected {launchdyn-"));
    library_end(&by);
    fmu_close(&fmu);
}

static void refuses_wrong_values(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("fixed"), 3);
    void *instance = begin_3(&fmu, false);
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.mass", -1), fmi3OK);
    assert_int_equal(
        FMU_FUNCTION(&fmu, fmi3EnterInitializationMode)(instance, false, 0, 0, false, 0), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3ExitInitializationMode)(instance), fmi3Error);
    assert_string_equal(
        logged, "rocket.mass: found \"-1 kg\"; expected a number with a unit of kg, > 0 kg");
    assert_int_equal(
        FMU_FUNCTION(&fmu, fmi3EnterInitializationMode)(instance, true, 1e-6, 0, false, 0), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3ExitInitializationMode)(instance), fmi3Error);
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.mass", NAN), fmi3Error);
    assert_string_equal(logged, "scenario.rocket.mass cannot be nan");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3Reset)(instance), fmi3OK);
    assert_int_equal(set_3(&fmu, instance, "scenario.tubes.modes.bending", 5), fmi3Error);
    assert_string_equal(logged, "scenario.tubes.modes.bending is of another type");
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.inertia.y", -24), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3ExitInitializationMode)(instance), fmi3Error);
    assert_string_equal(
        logged,
        "rocket.inertia.y: found \"-24 kg.m2\"; expected a number with a unit of kg.m2, > 0 kg.m2");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3Reset)(instance), fmi3OK);
    assert_int_equal(set_count_3(&fmu, instance, "scenario.tubes.modes.elements", 0), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3ExitInitializationMode)(instance), fmi3Error);
    assert_string_equal(logged,
                        "tubes.modes.elements: found \"0\"; expected a whole number from 2 to 400");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3Reset)(instance), fmi3OK);
    assert_int_equal(set_count_3(&fmu, instance, "scenario.tubes.modes.bending", 5), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3ExitInitializationMode)(instance), fmi3Error);
    assert_non_null(strstr(logged, "export the FMU with them"));
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
    fmu_close(&fmu);

    assert_int_equal(run("launchdyn fmu export examples/flight.yaml --out x.fmu"), 2);
    assert_int_equal(run("launchdyn fmu export examples/fixed.yaml --fmi 1 --out x.fmu"), 2);
    assert_string_equal(shell.err, "launchdyn: found FMI 1, expected 2 or 3\n");
    assert_int_equal(run("launchdyn fmu export examples/fixed.yaml"), 2);
    assert_int_equal(run("launchdyn fmu export examples/fixed.yaml --out none/x.fmu"), 3);
    assert_int_equal(run("ls | grep -c '[.]part$'"), 1);
}

#define REFUSES_3(sentence, name, ...)                                                             \
    do {                                                                                           \
        logged[0] = '\0';                                                                          \
        assert_int_equal(FMU_FUNCTION(&fmu, name)(__VA_ARGS__), fmi3Error);                        \
        assert_string_equal(logged, sentence);                                                     \
    } while (0)
#define NO_POINTER_3(name, ...) REFUSES_3(#name ": a pointer is null", name, __VA_ARGS__)
#define REFUSES_2(sentence, name, ...)                                                             \
    do {                                                                                           \
        logged[0] = '\0';                                                                          \
        assert_int_equal(FMU_FUNCTION(&fmu, name)(__VA_ARGS__), fmi2Error);                        \
        assert_string_equal(logged, sentence);                                                     \
    } while (0)
#define NO_POINTER_2(name, ...) REFUSES_2(#name ": a pointer is null", name, __VA_ARGS__)

// Without an instance there is no log.
static void refuses_null_pointers(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("fixed"), 3);
    void *one = begin_3(&fmu, false), *saved = NULL;
    uint32_t law = reference_of(&fmu, "scenario.rocket.contact.law");
    double value = 0;
    bool a;
    size_t size;
    const char *text = NULL;
    REFUSES_3("", fmi3ExitInitializationMode, NULL);
    REFUSES_3("", fmi3GetFloat64, NULL, &law, 1, &value, 1);
    REFUSES_3("", fmi3GetInt8, NULL, &law, 1, NULL, 1);
    REFUSES_3("", fmi3UpdateDiscreteStates, NULL, &a, &a, &a, &a, &a, &value);
    REFUSES_3("", fmi3Terminate, NULL);
    REFUSES_3("", fmi3Reset, NULL);
    NO_POINTER_3(fmi3GetFloat64, one, NULL, 1, &value, 1);
    NO_POINTER_3(fmi3GetFloat64, one, &law, 1, NULL, 1);
    NO_POINTER_3(fmi3SetFloat64, one, &law, 1, NULL, 1);
    NO_POINTER_3(fmi3SetBoolean, one, NULL, 1, &a, 1);
    NO_POINTER_3(fmi3GetInt32, one, &law, 1, NULL, 1);
    NO_POINTER_3(fmi3GetString, one, &law, 1, NULL, 1);
    REFUSES_3("the text of scenario.rocket.contact.law is a null pointer", fmi3SetString, one, &law,
              1, &text, 1);
    NO_POINTER_3(fmi3DoStep, one, 0, 0.1, true, NULL, &a, &a, &value);
    NO_POINTER_3(fmi3GetFMUState, one, NULL);
    NO_POINTER_3(fmi3SerializedFMUStateSize, one, NULL, &size);
    NO_POINTER_3(fmi3SerializeFMUState, one, NULL, NULL, 0);
    NO_POINTER_3(fmi3DeserializeFMUState, one, NULL, 0, &saved);
    NO_POINTER_3(fmi3GetNumberOfContinuousStates, one, NULL);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetFloat64)(one, NULL, 0, NULL, 0), fmi3OK);
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(one);
    fmu_close(&fmu);
}

// Values and states can be had, and it can begin again.
static void has_ended_when_terminated(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("fixed"), 3);
    void *one = begin_3(&fmu, false), *saved = NULL;
    taken_step s;
    start_3(&fmu, one, 0);
    step_3(&fmu, one, 0, 0.1);
    double travel = value_3(&fmu, one, "rocket.s");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetFMUState)(one, &saved), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3Terminate)(one), fmi3OK);
    REFUSES_3("fmi3DoStep: the instance has been terminated", fmi3DoStep, one, 0.1, 0.01, true,
              &s.event, &s.terminate, &s.early, &s.t);
    REFUSES_3("fmi3Terminate: the instance has been terminated", fmi3Terminate, one);
    assert_int_equal(set_3(&fmu, one, "scenario.rocket.mass", 61), fmi3Error);
    assert_true(same(value_3(&fmu, one, "rocket.s"), travel));
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3SetFMUState)(one, saved), fmi3OK);
    step_3(&fmu, one, 0.1, 0.01);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3Terminate)(one), fmi3OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3Reset)(one), fmi3OK);
    start_3(&fmu, one, 0);
    step_3(&fmu, one, 0, 0.1);
    assert_true(same(value_3(&fmu, one, "rocket.s"), travel));
    FMU_FUNCTION(&fmu, fmi3FreeFMUState)(one, &saved);
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(one);
    fmu_close(&fmu);
}

static void refuses_the_same_in_version_2(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("fixed"), 2);
    const fmi2CallbackFunctions call = {.logger = keep_log_2};
    void *c = FMU_FUNCTION(&fmu, fmi2Instantiate)("two", fmi2CoSimulation, fmu.token, fmu.resources,
                                                  &call, 0, 0);
    unsigned tip = reference_of(&fmu, "tip.y"), law = reference_of(&fmu, "scenario.title");
    const char *text = NULL;
    double value;
    size_t size;
    assert_non_null(c);
    REFUSES_2("", fmi2DoStep, NULL, 0, 0.1, 1);
    REFUSES_2("", fmi2GetReal, NULL, &tip, 1, &value);
    REFUSES_2("", fmi2GetInteger, NULL, &tip, 1, NULL);
    unsigned rows = reference_of(&fmu, "scenario.tubes.layout.rows");
    int whole = 0;
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetInteger)(c, &rows, 1, &whole), fmi2OK);
    assert_int_equal(whole, 3);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetInteger)(c, &rows, 1, &whole), fmi2OK);
    REFUSES_2("tip.y is of another type", fmi2SetInteger, c, &tip, 1, &whole);
    NO_POINTER_2(fmi2SetInteger, c, &rows, 1, NULL);
    REFUSES_2("", fmi2NewDiscreteStates, NULL, NULL);
    NO_POINTER_2(fmi2GetReal, c, &tip, 1, NULL);
    NO_POINTER_2(fmi2SetReal, c, NULL, 1, &value);
    NO_POINTER_2(fmi2GetRealStatus, c, fmi2LastSuccessfulTime, NULL);
    NO_POINTER_2(fmi2GetFMUstate, c, NULL);
    NO_POINTER_2(fmi2SerializedFMUstateSize, c, NULL, &size);
    REFUSES_2("the text of scenario.title is a null pointer", fmi2SetString, c, &law, 1, &text);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetupExperiment)(c, 0, 0, 0, 0, 0), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2ExitInitializationMode)(c), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2Terminate)(c), fmi2OK);
    REFUSES_2("fmi2DoStep: the instance has been terminated", fmi2DoStep, c, 0, 0.1, 1);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetReal)(c, &tip, 1, &value), fmi2OK);
    FMU_FUNCTION(&fmu, fmi2FreeInstance)(c);
    fmu_close(&fmu);
}

// ---- the description ----

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

// Every variable has a name of its own and the reference that follows from it, every output stands
// in the structure as an output and as an unknown of the start, every unit is defined.
static void check_description(const char *scenario, int version)
{
    enum { MOST = 4096 };
    static char *name[MOST];
    unpacked_fmu fmu = fmu_open(scenario, version);
    const char *structure = strstr(fmu.description, "<ModelStructure>"),
               *units = strstr(fmu.description, "<UnitDefinitions>");
    size_t count = 0, outputs_there = 0;
    const char *head = version == 2 ? "<ScalarVariable name=" : " name=\"";
    for (const char *at = strstr(fmu.description, "<ModelVariables>");
         (at = strstr(at + 1, head)) && at < structure;) {
        char text[256], wanted[300];
        name[count] = calloc(1, 256);
        assert_non_null(name[count]);
        attribute_after(at, "name", name[count], 256);
        attribute_after(at, "valueReference", text, sizeof text);
        unsigned reference = reference_by(name[count]);
        assert_int_equal(atoi(text), reference);
        attribute_after(at, "causality", text, sizeof text);
        snprintf(wanted, sizeof wanted,
                 version == 2 ? "<Unknown index=\"%zu\"" : "<Output valueReference=\"%zu\"",
                 version == 2 ? count + 1 : reference);
        bool listed = strstr(structure, wanted) != NULL;
        bool is_state = strncmp(name[count], "state.", 6) == 0,
             is_rate = strncmp(name[count], "der(", 4) == 0;
        // FMI 2 lists outputs, rates and unknowns of the start by the same element
        assert_true(listed ==
                    (strcmp(text, "output") == 0 || (version == 2 && (is_state || is_rate))));
        assert_true((strcmp(text, "local") == 0) ==
                    (is_state || is_rate || strncmp(name[count], "indicator.", 10) == 0));
        snprintf(wanted, sizeof wanted,
                 version == 2 ? "<InitialUnknowns>" : "<InitialUnknown valueReference=\"%zu\"",
                 (size_t)reference);
        assert_true(!listed || strstr(structure, wanted));
        outputs_there += listed;
        const char *end = strstr(at, "/>"), *unit = strstr(at, " unit=\"");
        if (unit && unit < end) {
            attribute_after(unit, "unit", text, sizeof text);
            snprintf(wanted, sizeof wanted, "<Unit name=\"%s\">", text);
            assert_non_null(strstr(units, wanted));
        }
        count++;
    }
    printf("    %zu variables, %zu outputs\n", count, outputs_there);
    assert_non_null(strstr(units, "<Unit name=\"m/s2\"><BaseUnit m=\"1\" s=\"-2\"/></Unit>"));
    assert_non_null(strstr(units, "<Unit name=\"N.s/m\"><BaseUnit kg=\"1\" s=\"-1\"/></Unit>"));
    if (strstr(fmu.description, "name=\"q1_dot\"")) // no whole powers
        assert_non_null(strstr(units, "<Unit name=\"kg0.5.m/s\"></Unit>"));
    assert_true(count > 250 && outputs_there > 100);
    qsort(name, count, sizeof *name, compare_names);
    for (size_t i = 1; i < count; i++)
        assert_true(strcmp(name[i - 1], name[i]) < 0);
    for (size_t i = 0; i < count; i++)
        free(name[i]);
    fmu_close(&fmu);
}

static void is_described(void **state)
{
    (void)state;
    for (int version = 2; version <= 3; version++) {
        check_description("examples/reference.yaml", version);
        check_description("examples/spin-rig.yaml", version);
        check_description(MULTIBODY, version);
        check_description("examples/reference.yaml --part vehicle", version);
        check_description("examples/reference.yaml --part launcher", version);
    }
}

static double experiment_of(const unpacked_fmu *fmu, const char *name)
{
    char text[64];
    attribute_after(strstr(fmu->description, "<DefaultExperiment"), name, text, sizeof text);
    return atof(text);
}

// Its name is the title, its binary's a name of C made of that, a part's another; the experiment
// ends soon after the launch does.
static void is_named_and_timed(void **state)
{
    (void)state;
    static const char *const part[] = {"", " --part vehicle", " --part launcher"},
                             *const after[] = {"", ": vehicle", ": launcher"},
                             *const behind[] = {"", "_vehicle", "_launcher"};
    char line[256], name[128], wanted[128];
    for (int i = 0; i < 3; i++) {
        snprintf(line, sizeof line,
                 "examples/reference.yaml --set run.lead_in=0.1s --set 'title=Its 2 & <b>'%s",
                 part[i]);
        unpacked_fmu fmu = fmu_open(line, 2 + i % 2);
        attribute_after(fmu.description, "modelName", name, sizeof name);
        snprintf(wanted, sizeof wanted, "Its 2 &amp; &lt;b&gt;%s", after[i]);
        assert_string_equal(name, wanted);
        attribute_after(fmu.description, "modelIdentifier", name, sizeof name);
        snprintf(wanted, sizeof wanted, "launchdyn_its_2_b%s_", behind[i]);
        assert_memory_equal(name, wanted, strlen(wanted));
        assert_int_equal(strspn(name + strlen(wanted), "0123456789abcdef"), 8);
        assert_int_equal(strlen(name), strlen(wanted) + 8);
        CHECK_BELOW("start [s]", experiment_of(&fmu, "startTime") + 0.1, 0);
        // the rocket is out at 0.1595 s, 0.2595 s after the start
        CHECK_BELOW("stop [s]", experiment_of(&fmu, "stopTime") - 0.16, 1e-12);
        fmu_close(&fmu);
    }
    unpacked_fmu stuck = fmu_open("examples/fixed.yaml --set run.end=0.3s --set title=none", 3);
    CHECK_BELOW("stop of one that ends when it is told to [s]",
                experiment_of(&stuck, "stopTime") - 0.3, 1e-12);
    fmu_close(&stuck);
}

static int count_of(const char *text, const char *word)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, word)); at++)
        count++;
    return count;
}

// What is chosen is there, with the references that all of it has, and reports the same; it is
// found nowhere else in the description.
static void has_what_is_chosen(void **state)
{
    (void)state;
    unpacked_fmu all = fmu_open(EXAMPLE("fixed"), 3);
    char names[4][128];
    static const char *const chosen[] = {"", " --parameters ''",
                                         " --outputs 'rocket.s,tip.*,summary.*.exit_speed'",
                                         (" --outputs 'rocket.s,tip.*,summary.*.exit_speed' "
                                          "--parameters 'rocket.*,tubes.modes.bend*'")};
    for (int i = 0; i < 4; i++) {
        char line[256];
        snprintf(line, sizeof line, EXAMPLE("fixed") "%s --set title=\"$(printf %%0200d)\"",
                 chosen[i]);
        unpacked_fmu fmu = fmu_open(line, 2 + i % 2);
        attribute_after(fmu.description, "modelIdentifier", names[i], sizeof names[i]);
        assert_true(strlen(names[i]) < 64);
        for (int k = 0; k < i; k++)
            assert_string_not_equal(names[k], names[i]);
        fmu_close(&fmu);
    }

    unpacked_fmu fmu = fmu_open("examples/fixed.yaml --outputs 'rocket.s,tip.*,*.exit_speed' "
                                "--parameters 'rocket.mass,scenario.tubes.modes.bend*'",
                                3);
    assert_int_equal(count_of(fmu.description, "name=\"scenario."), 2);
    assert_int_equal(count_of(fmu.description, "name=\"tip."),
                     count_of(all.description, "name=\"tip."));
    int outputs_there = count_of(fmu.description, "causality=\"output\"");
    assert_int_equal(outputs_there, 2 + count_of(all.description, "name=\"tip."));
    assert_int_equal(count_of(fmu.description, "<Output "), outputs_there);
    assert_int_equal(count_of(fmu.description, "<ContinuousStateDerivative "),
                     count_of(all.description, "<ContinuousStateDerivative "));
    void *instance = begin_3(&fmu, false), *whole = begin_3(&all, false);
    static const char *const common[] = {"rocket.s", "tip.y", "summary.rocket.1.exit_speed"};
    assert_int_equal(set_3(&fmu, instance, "scenario.rocket.mass", 61), fmi3OK);
    assert_int_equal(set_3(&all, whole, "scenario.rocket.mass", 61), fmi3OK);
    start_3(&fmu, instance, 0);
    start_3(&all, whole, 0);
    step_3(&fmu, instance, 0, 0.15);
    step_3(&all, whole, 0, 0.15);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(reference_of(&fmu, common[i]), reference_of(&all, common[i]));
        assert_true(same(value_3(&fmu, instance, common[i]), value_3(&all, whole, common[i])));
    }
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
    FMU_FUNCTION(&all, fmi3FreeInstance)(whole);
    fmu_close(&fmu);
    fmu_close(&all);

    fmu = fmu_open("examples/reference.yaml --part launcher --outputs '' --parameters ''", 2);
    assert_int_equal(count_of(fmu.description, "causality=\"output\""), 6); // the wrench
    assert_int_equal(count_of(fmu.description, "name=\"scenario."), 0);
    fmu_close(&fmu);

    assert_int_equal(run("launchdyn fmu export examples/fixed.yaml --outputs tip.q --out x.fmu"),
                     2);
    assert_string_equal(shell.err,
                        "launchdyn: found no output \"tip.q\"; did you mean \"tip.y\"?\n");
    // of an archive, what one of the parts has
    assert_int_equal(run("launchdyn fmu export examples/reference.yaml --set run.lead_in=0s "
                         "--outputs chassis.x,tip.y --ssp x.ssp"),
                     0);
    assert_int_equal(
        run("test $(unzip -p x.ssp SystemStructure.ssd | grep -c 'kind=.output') = 21"), 0);
    assert_int_equal(run("launchdyn fmu export examples/reference.yaml --set run.lead_in=0s "
                         "--outputs chassis.x,tip.q --ssp x.ssp"),
                     2);
    assert_int_equal(run("launchdyn fmu export examples/fixed.yaml --parameters 'rocket.mas,tip.y' "
                         "--out x.fmu"),
                     2);
    assert_string_equal(shell.err, "launchdyn: found no parameter \"rocket.mas\"; did you mean "
                                   "\"rocket.mass\"?\n");
}

// ---- vectors as arrays ----

static fmi3Status get_array(const unpacked_fmu *fmu, void *instance, const char *name,
                            double *value, size_t count)
{
    unsigned reference = reference_of(fmu, name);
    assert_int_equal(reference, reference_by(name));
    return FMU_FUNCTION(fmu, fmi3GetFloat64)(instance, &reference, 1, value, count);
}

static fmi3Status set_array(const unpacked_fmu *fmu, void *instance, const char *name,
                            const double *value, size_t count)
{
    unsigned reference = reference_of(fmu, name);
    return FMU_FUNCTION(fmu, fmi3SetFloat64)(instance, &reference, 1, value, count);
}

// On a base that moves in all directions.
static ld_base_frame tumbling(double t)
{
    ld_base_frame frame = swaying(t);
    frame.velocity[2] = -0.5;
    frame.position[2] = -0.5 * t;
    frame.rate[0] = 0.02;
    frame.rate[1] = -0.01;
    return frame;
}

static void tell_by_arrays(const unpacked_fmu *fmu, void *instance, const ld_base_frame *base)
{
    const double *numbers[] = {base->position, base->quaternion, base->velocity, base->rate};
    static const char *const names[] = {"input.base.position", "input.base.quaternion",
                                        "input.base.velocity", "input.base.rate"};
    for (int i = 0; i < 4; i++)
        assert_int_equal(set_array(fmu, instance, names[i], numbers[i], i == 1 ? 4 : 3), fmi3OK);
}

// Together the elements that the other description lists one by one, in their order.
static void check_listed(const unpacked_fmu *arrays, const unpacked_fmu *scalars)
{
    int elements = 0, there = 0;
    for (const char *at = arrays->description; (at = strstr(at, "<Dimension start=\"")); at++) {
        elements += atoi(at + strlen("<Dimension start=\"")) - 1;
        there++;
    }
    assert_true(there > 30);
    assert_int_equal(count_of(arrays->description, " causality=\"") + elements,
                     count_of(scalars->description, " causality=\""));
    assert_int_equal(count_of(arrays->description, "<Output "),
                     count_of(arrays->description, " causality=\"output\""));
    assert_int_equal(count_of(arrays->description, "name=\"wrench.force.x\""), 0);
    char text[128];
    snprintf(text, sizeof text, " derivative=\"%u\"><Dimension start=\"4\"/></Float64>",
             reference_by("state.tube.quaternion"));
    assert_non_null(strstr(arrays->description, text));
    assert_non_null(
        strstr(arrays->description, " start=\"1 0 0 0\"><Dimension start=\"4\"/></Float64>"));
    assert_null(strstr(scalars->description, "<Dimension"));
}

// The same launch on the same base, said to one by vectors, to the other by numbers.
static void vectors_are_arrays_by_a_choice(void **state)
{
    (void)state;
    const char *scenario = make_external();
    unpacked_fmu arrays = fmu_open("external.yaml --arrays", 3), scalars = fmu_open(scenario, 3);
    void *by_vector = begin_3(&arrays, false), *by_number = begin_3(&scalars, false);
    check_listed(&arrays, &scalars);
    double center[3] = {1.125, 2e-3, -1e-3}, got[9], one[3];
    static const char *const centers[] = {"scenario.rocket.center.x", "scenario.rocket.center.y",
                                          "scenario.rocket.center.z"};
    assert_int_equal(set_array(&arrays, by_vector, "scenario.rocket.center", center, 3), fmi3OK);
    for (int i = 0; i < 3; i++)
        assert_int_equal(set_3(&scalars, by_number, centers[i], center[i]), fmi3OK);
    for (int k = 0; k < 20; k++) {
        double t = -0.1 + 0.01 * k;
        ld_base_frame frame = tumbling(t);
        tell_3(&scalars, by_number, &frame);
        tell_by_arrays(&arrays, by_vector, &frame);
        if (k == 0) {
            start_3(&arrays, by_vector, t);
            start_3(&scalars, by_number, t);
        }
        step_3(&arrays, by_vector, t, -0.1 + 0.01 * (k + 1) - t);
        step_3(&scalars, by_number, t, -0.1 + 0.01 * (k + 1) - t);
    }
    // arrays and a number between them at once
    const unsigned mixed[] = {reference_of(&arrays, "wrench.moment"),
                              reference_of(&arrays, "rocket.s"), reference_of(&arrays, "center")};
    static const char *const names[] = {"wrench.moment.x", "wrench.moment.y", "wrench.moment.z",
                                        "rocket.s",        "center.x",        "center.y",
                                        "center.z"};
    assert_int_equal(FMU_FUNCTION(&arrays, fmi3GetFloat64)(by_vector, mixed, 3, got, 7), fmi3OK);
    for (int i = 0; i < 7; i++)
        assert_true(got[i] == value_3(&scalars, by_number, names[i]) && got[i] != 0);
    // what does not fit
    assert_int_equal(FMU_FUNCTION(&arrays, fmi3GetFloat64)(by_vector, mixed, 3, got, 9), fmi3Error);
    assert_string_equal(logged, "found 9 values, expected 7 for 3 variables");
    assert_int_equal(get_array(&arrays, by_vector, "center", one, 1), fmi3Error);
    assert_non_null(strstr(logged, "is an array: found 1 value, expected 3"));
    assert_int_equal(set_array(&arrays, by_vector, "input.base.rate", one, 2), fmi3Error);
    FMU_FUNCTION(&arrays, fmi3FreeInstance)(by_vector);
    FMU_FUNCTION(&scalars, fmi3FreeInstance)(by_number);
    fmu_close(&arrays);
    fmu_close(&scalars);
}

// Seeds and values by elements.
static void arrays_have_derivatives(void **state)
{
    (void)state;
    make_external();
    unpacked_fmu fmu = fmu_open("external.yaml --arrays", 3);
    void *instance = begin_3(&fmu, false);
    start_3(&fmu, instance, -0.1);
    const unsigned unknown[] = {reference_of(&fmu, "rocket.s"), reference_of(&fmu, "wrench.force")},
                   known[] = {reference_of(&fmu, "input.base.velocity"),
                              reference_of(&fmu, "input.base.rate")};
    double seed[6], column[4], whole[4], sum[4] = {0}, back[6] = {0}, seed_back[4] = {1, 2, 3, 4};
    for (int i = 0; i < 6; i++)
        seed[i] = 1 + 0.5 * i;
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetDirectionalDerivative)(instance, unknown, 2, known,
                                                                      2, seed, 6, whole, 4),
                     fmi3OK);
    for (int i = 0; i < 6; i++) {
        double unit[6] = {0};
        unit[i] = 1;
        assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetDirectionalDerivative)(
                             instance, unknown, 2, known, 2, unit, 6, column, 4),
                         fmi3OK);
        for (int k = 0; k < 4; k++) {
            sum[k] += seed[i] * column[k];
            back[i] += seed_back[k] * column[k];
        }
    }
    double worst = 0, largest = 0, adjoint[6];
    for (int k = 0; k < 4; k++) {
        worst = fmax(worst, fabs(whole[k] - sum[k]));
        largest = fmax(largest, fabs(whole[k]));
    }
    CHECK_BELOW("derivative along a seed of arrays, of the largest", worst / largest, 1e-12);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetAdjointDerivative)(instance, unknown, 2, known, 2,
                                                                  seed_back, 4, adjoint, 6),
                     fmi3OK);
    worst = largest = 0;
    for (int i = 0; i < 6; i++) {
        worst = fmax(worst, fabs(adjoint[i] - back[i]));
        largest = fmax(largest, fabs(adjoint[i]));
    }
    CHECK_BELOW("adjoint, against columns", worst / largest, 1e-12);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetDirectionalDerivative)(instance, unknown, 2, known,
                                                                      2, seed, 2, whole, 4),
                     fmi3Error);
    assert_non_null(strstr(logged, "expected a seed for each known, a value for each unknown"));
    FMU_FUNCTION(&fmu, fmi3FreeInstance)(instance);
    fmu_close(&fmu);
}

static void arrays_are_refused_where_there_are_none(void **state)
{
    (void)state;
    assert_int_equal(run("launchdyn fmu export examples/fixed.yaml --arrays --fmi 2 --out x.fmu"),
                     2);
    assert_string_equal(shell.err, "launchdyn: found arrays with FMI 2, expected FMI 3\n");
    assert_int_equal(run("launchdyn fmu export examples/reference.yaml --arrays --ssp x.ssp"), 2);
    assert_string_equal(shell.err,
                        "launchdyn: found arrays, which connectors of SSP 1.0 cannot be\n");
    // of what is chosen, a vector that is there in part stands by its numbers
    unpacked_fmu fmu =
        fmu_open("examples/fixed.yaml --arrays --outputs 'base.y,wrench.force.*,wrench.moment.x' "
                 "--parameters 'rocket.center.x'",
                 3);
    assert_int_equal(count_of(fmu.description, "causality=\"output\""), 3);
    assert_non_null(strstr(fmu.description, " name=\"base.y\""));
    assert_non_null(strstr(fmu.description, " name=\"wrench.force\""));
    assert_non_null(strstr(fmu.description, " name=\"wrench.moment.x\""));
    assert_non_null(strstr(fmu.description, " name=\"scenario.rocket.center.x\""));
    fmu_close(&fmu);
}

// ---- what importers demand (docs/fmi.md) ----

static unsigned char *read_file_of(const unpacked_fmu *fmu, const char *name, long *size)
{
    static unsigned char bytes[1 << 18];
    char path[512];
    snprintf(path, sizeof path, "%s/%s", fmu->folder, name);
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    *size = (long)fread(bytes, 1, sizeof bytes - 1, stream);
    bytes[*size] = '\0';
    fclose(stream);
    return bytes;
}

// Its head's width, height, 8 bits of red, green, blue, alpha; its rows, and what is seen in the
// middle of the tube and in the upper left corner.
static void check_icon(const unsigned char *png, long size, bool has_tube)
{
    enum { SIDE = 128, ROW = 1 + 4 * SIDE };
    static unsigned char row[SIDE * ROW + 1];
    static const unsigned char head[] = {0, 0, 0, SIDE, 0, 0, 0, SIDE, 8, 6, 0, 0, 0};
    assert_memory_equal(png, "\x89PNG\r\n\x1a\n", 8);
    uLongf length = sizeof row;
    for (long at = 8; at < size;) {
        uLong data =
            (uLong)png[at] << 24 | (uLong)png[at + 1] << 16 | (uLong)png[at + 2] << 8 | png[at + 3];
        const unsigned char *type = png + at + 4, *sum = type + 4 + data;
        assert_int_equal(crc32(crc32(0, NULL, 0), type, (uInt)(4 + data)),
                         (uLong)sum[0] << 24 | (uLong)sum[1] << 16 | (uLong)sum[2] << 8 | sum[3]);
        if (memcmp(type, "IHDR", 4) == 0)
            assert_memory_equal(type + 4, head, sizeof head);
        if (memcmp(type, "IDAT", 4) == 0)
            assert_int_equal(uncompress(row, &length, type + 4, data), Z_OK);
        at += 12 + (long)data;
    }
    assert_int_equal(length, SIDE * ROW);
    const unsigned char *corner = row + 1, *tube = row + 72 * ROW + 1 + 4 * 56;
    assert_int_equal(corner[3], 0);
    assert_int_equal(tube[3], 255);
    assert_int_equal(tube[0], has_tube ? 0x8a : 0x54);
}

static void check_demands(const char *scenario, int version)
{
    unpacked_fmu fmu = fmu_open(scenario, version);
    const char *structure = strstr(fmu.description, "<ModelStructure>");
    char word[1024];
    int parameters = 0, texts = 0;
    size_t longest = 0;
    for (const char *at = strstr(fmu.description, "<ModelVariables>");
         (at = strstr(at + 1, " name=\"")) && at < structure;) {
        const char *end = strstr(at, version == 2 ? "</ScalarVariable>" : "\n");
        attribute_after(at, "name", word, sizeof word);
        longest = strlen(word) > longest ? strlen(word) : longest;
        // letters, digits, dots, hyphens; rates in brackets
        assert_int_equal(strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                      "0123456789._-()"),
                         strlen(word));
        attribute_after(at, "description", word, sizeof word);
        assert_true(word[0] && !strchr(word, '\n'));
        attribute_after(at, "causality", word, sizeof word);
        bool parameter = strcmp(word, "parameter") == 0, input = strcmp(word, "input") == 0;
        const char *start = strstr(at, " start=\""), *value = strstr(at, "<Start value=\""),
                   *text = strstr(at, "<String");
        bool has_start = (start && start < end) || (value && value < end);
        assert_true(has_start == (parameter || input));
        bool is_text =
            version == 2 ? text && text < end : memcmp(at - strlen("<String"), "<String", 7) == 0;
        texts += is_text;
        assert_true(!is_text || parameter);
        parameters += parameter;
    }
    assert_true(parameters > texts && texts > 10);
    assert_null(strstr(fmu.description, "unit=\"1\""));
    assert_int_equal(strstr(fmu.description, "name=\"time\"") != NULL, version == 3);
    CHECK_WITHIN("longest name [letters]", (double)longest, 30, 63);

    long size;
    const unsigned char *page = read_file_of(&fmu, "documentation/index.html", &size);
    assert_non_null(page);
    assert_non_null(strstr((const char *)page, "How to couple it"));
    assert_non_null(strstr((const char *)page, "<td><code>scenario.rocket.mass</code></td><td>kg"
                                               "</td><td>60</td>"));
    assert_null(strstr((const char *)page, "<script"));
    for (const char *at = (const char *)page; (at = strstr(at, "<td><code>")); at++) {
        char quoted[300];
        snprintf(quoted, sizeof quoted, " name=\"%.*s\"", (int)strcspn(at + 10, "<"), at + 10);
        assert_non_null(strstr(fmu.description, quoted));
    }
    const unsigned char *png =
        read_file_of(&fmu, version == 2 ? "model.png" : "terminalsAndIcons/icon.png", &size);
    assert_non_null(png);
    check_icon(png, size, !strstr(scenario, "--part vehicle"));
    const unsigned char *svg = read_file_of(&fmu, "terminalsAndIcons/icon.svg", &size);
    assert_true((svg != NULL) == (version == 3));
    assert_true(!svg || memcmp(svg, "<svg xmlns=", 11) == 0);
    fmu_close(&fmu);
}

static void has_what_importers_demand(void **state)
{
    (void)state;
    check_demands("examples/fixed.yaml", 2);
    check_demands("examples/ship.yaml", 3);
    check_demands("examples/reference.yaml --set run.lead_in=0s --part vehicle", 3);
    check_demands("examples/reference.yaml --set run.lead_in=0s --part launcher", 2);
}

// ---- two at a time ----

typedef struct side {
    const unpacked_fmu *fmu;
    void *instance;
    double value[OUTPUTS];
} side;

static void *go_side(void *data)
{
    side *self = data;
    for (int i = 0; i < 50; i++)
        step_3(self->fmu, self->instance, i * 2e-3, (i + 1) * 2e-3 - i * 2e-3);
    for (int i = 0; i < OUTPUTS; i++)
        self->value[i] = value_3(self->fmu, self->instance, outputs[i]);
    return NULL;
}

static void go_side_by_side(void **state)
{
    (void)state;
    unpacked_fmu fmu = fmu_open(EXAMPLE("ship"), 3);
    side sides[3];
    pthread_t thread[2];
    int unequal = 0;
    for (int k = 0; k < 3; k++) {
        sides[k] = (side){.fmu = &fmu, .instance = begin_3(&fmu, false)};
        start_3(&fmu, sides[k].instance, 0);
    }
    for (int k = 0; k < 2; k++)
        assert_int_equal(pthread_create(&thread[k], NULL, go_side, &sides[k]), 0);
    for (int k = 0; k < 2; k++)
        pthread_join(thread[k], NULL);
    go_side(&sides[2]);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < OUTPUTS; i++)
            unequal += !same(sides[0].value[i], sides[k].value[i]);
        FMU_FUNCTION(&fmu, fmi3FreeInstance)(sides[k].instance);
    }
    CHECK_BELOW("outputs that differ between threads", unequal, 0);
    fmu_close(&fmu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(tells_what_the_library_tells, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(returns_at_events, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(parameters_are_overrides, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(states_come_back, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(moves_with_its_base, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(waits_for_the_input, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(speaks_version_2, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(refuses_wrong_values, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(refuses_null_pointers, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(has_ended_when_terminated, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(refuses_the_same_in_version_2, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(is_described, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(is_named_and_timed, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(has_what_importers_demand, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(has_what_is_chosen, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(vectors_are_arrays_by_a_choice, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(arrays_have_derivatives, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(arrays_are_refused_where_there_are_none, shell_make,
                                        shell_remove),
        cmocka_unit_test_setup_teardown(go_side_by_side, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
