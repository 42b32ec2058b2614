// A vehicle and its launcher as two FMUs, exchanged by a simple master of our own (Jacobi: both
// report, then both step; inputs stay as they were set): as all together, with order two in its
// step.
// ctest: slow
// link: -ldl
#include <math.h>

#include "fmu/fmi2_interface.h"
#include "fmu/fmi3_interface.h"
#include "launchdyn/run.h"
#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"
#include "support/fmu.h"

#define EXAMPLE(name) LD_SOURCE_DIR "/examples/" name ".yaml"

// ---- one FMU ----

enum { FRAME = 13, WRENCH = 6 };

static const char *const frame_names[FRAME] = {
    "position.x",   "position.y",   "position.z", "quaternion.0", "quaternion.1",
    "quaternion.2", "quaternion.3", "velocity.x", "velocity.y",   "velocity.z",
    "rate.x",       "rate.y",       "rate.z"};
static const char *const wrench_names[WRENCH] = {"force.x",  "force.y",  "force.z",
                                                 "moment.x", "moment.y", "moment.z"};

typedef struct side {
    unpacked_fmu fmu;
    void *instance;
    uint32_t told[FRAME], tells[FRAME];
    size_t input_count, output_count;
    bool ended;
} side;

static char logged[2048];

static void keep_log(void *environment, fmi3Status status, const char *category,
                     const char *message)
{
    (void)environment, (void)status, (void)category;
    snprintf(logged, sizeof logged, "%s", message);
}

static void find_references(const unpacked_fmu *fmu, const char *prefix, const char *const *names,
                            size_t count, uint32_t *references)
{
    char name[64];
    for (size_t i = 0; i < count; i++) {
        snprintf(name, sizeof name, "%s.%s", prefix, names[i]);
        references[i] = reference_of(fmu, name);
    }
}

static void *instance_of(const unpacked_fmu *fmu)
{
    logged[0] = '\0';
    void *instance = FMU_FUNCTION(fmu, fmi3InstantiateCoSimulation)(
        "one", fmu->token, fmu->resources, false, false, false, false, NULL, 0, NULL, keep_log,
        NULL);
    if (!instance)
        fail_msg("%s", logged);
    return instance;
}

static side side_open(const char *scenario, bool vehicle)
{
    char line[400];
    side self = {0};
    snprintf(line, sizeof line, "%s --part %s", scenario, vehicle ? "vehicle" : "launcher");
    self.fmu = fmu_open(line, 3);
    self.instance = instance_of(&self.fmu);
    self.input_count = vehicle ? WRENCH : FRAME;
    self.output_count = vehicle ? FRAME : WRENCH;
    find_references(&self.fmu, vehicle ? "input.wrench" : "input.base",
                    vehicle ? wrench_names : frame_names, self.input_count, self.told);
    find_references(&self.fmu, vehicle ? "base" : "wrench", vehicle ? frame_names : wrench_names,
                    self.output_count, self.tells);
    return self;
}

static void side_close(side *self)
{
    FMU_FUNCTION(&self->fmu, fmi3FreeInstance)(self->instance);
    fmu_close(&self->fmu);
}

static void side_tells(const side *self, double *values)
{
    assert_int_equal(FMU_FUNCTION(&self->fmu, fmi3GetFloat64)(self->instance, self->tells,
                                                              self->output_count, values,
                                                              self->output_count),
                     fmi3OK);
}

static void side_tell(const side *self, const double *values)
{
    assert_int_equal(FMU_FUNCTION(&self->fmu, fmi3SetFloat64)(
                         self->instance, self->told, self->input_count, values, self->input_count),
                     fmi3OK);
}

static double side_value(const side *self, const char *name)
{
    uint32_t reference = reference_of(&self->fmu, name);
    double value;
    assert_int_equal(
        FMU_FUNCTION(&self->fmu, fmi3GetFloat64)(self->instance, &reference, 1, &value, 1), fmi3OK);
    return value;
}

static void side_enter(const side *self, double start)
{
    assert_int_equal(FMU_FUNCTION(&self->fmu, fmi3EnterInitializationMode)(self->instance, false, 0,
                                                                           start, false, 0),
                     fmi3OK);
}

static void side_go(const side *self)
{
    if (FMU_FUNCTION(&self->fmu, fmi3ExitInitializationMode)(self->instance))
        fail_msg("%s", logged);
}

static void side_step(side *self, double t, double size)
{
    bool event, early;
    double reached;
    if (FMU_FUNCTION(&self->fmu, fmi3DoStep)(self->instance, t, size, true, &event, &self->ended,
                                             &early, &reached))
        fail_msg("%s", logged);
}

// ---- the two ----

typedef struct coupling {
    side vehicle, launcher;
} coupling;

static void coupling_open(coupling *self, const char *scenario)
{
    self->vehicle = side_open(scenario, true);
    self->launcher = side_open(scenario, false);
}

// Both stand at the same time: the launcher's wrench follows the frame that it is given.
static void exchange(coupling *self)
{
    double frame[FRAME], wrench[WRENCH];
    side_tells(&self->vehicle, frame);
    side_tell(&self->launcher, frame);
    side_tells(&self->launcher, wrench);
    side_tell(&self->vehicle, wrench);
}

static void coupling_begin(coupling *self, double start)
{
    side_enter(&self->vehicle, start);
    side_enter(&self->launcher, start);
    exchange(self);
    side_go(&self->vehicle);
    side_go(&self->launcher);
}

static void coupling_advance(coupling *self, double step, int i, double start)
{
    double t = start + i * step, end = start + (i + 1) * step;
    if (i > 0)
        exchange(self);
    side_step(&self->launcher, t, end - t);
    side_step(&self->vehicle, t, end - t);
}

static void coupling_close(coupling *self)
{
    side_close(&self->vehicle);
    side_close(&self->launcher);
}

// ---- together ----

// Exit figures [rad/s], and of the work over the interface the largest and what it misses [J].
typedef struct outcome {
    double pitch_rate, yaw_rate, work, missing;
} outcome;

// The reference launcher at 30 km/h on its road. LD_LEAD_IN in the environment: a longer one.
static void write_sets(const char *more, char *sets[3])
{
    static char lead_in[64];
    const char *given = getenv("LD_LEAD_IN");
    snprintf(lead_in, sizeof lead_in, "run.lead_in=%s", given ? given : "0.3 s");
    sets[0] = lead_in;
    sets[1] = (char *)"run.tolerance=1e-8";
    sets[2] = (char *)more;
}

static outcome in_process(const char *scenario, const char *more, double *start)
{
    ld_model *model;
    ld_simulation *simulation;
    ld_run *run;
    ld_messages messages;
    ld_error error;
    char *sets[3];
    outcome found = {0};
    write_sets(more, sets);
    assert_int_equal(
        ld_scenario_read(scenario, (const char *const *)sets, more ? 3 : 2, &model, &messages),
        LD_OK);
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_run_begin(simulation, NULL, &run, &error), LD_OK);
    *start = ld_run_time(run);
    assert_int_equal(ld_run_advance(run, INFINITY, &error), LD_OK);
    const ld_summary *summary = ld_run_summary(run);
    ld_summary_number(summary, "rocket.1.pitch_rate", &found.pitch_rate, &error);
    ld_summary_number(summary, "rocket.1.yaw_rate", &found.yaw_rate, &error);
    ld_run_end(run, NULL, NULL);
    ld_simulation_free(simulation);
    ld_model_free(model);
    return found;
}

static outcome as_two(double step, double start)
{
    char *sets[3], scenario[256];
    coupling two;
    outcome found = {0};
    write_sets(NULL, sets);
    snprintf(scenario, sizeof scenario, "examples/reference.yaml --set '%s' --set '%s'", sets[0],
             sets[1]);
    coupling_open(&two, scenario);
    coupling_begin(&two, start);
    for (int i = 0; !two.launcher.ended; i++) {
        double told = side_value(&two.launcher, "work.base");
        double given = side_value(&two.vehicle, "work.tube");
        found.work = fmax(found.work, fabs(told));
        found.missing = fmax(found.missing, fabs(told + given));
        coupling_advance(&two, step, i, start);
    }
    found.pitch_rate = side_value(&two.launcher, "summary.rocket.1.pitch_rate");
    found.yaw_rate = side_value(&two.launcher, "summary.rocket.1.yaw_rate");
    coupling_close(&two);
    return found;
}

static void two_are_the_whole(void **state)
{
    (void)state;
    enum { STEPS = 4 };
    static const char *const step[STEPS] = {"1", "0.5", "0.25", "0.1"};
    double start, error[STEPS], missing[STEPS], apart[STEPS];
    const outcome whole = in_process(EXAMPLE("reference"), NULL, &start);
    for (int i = 0; i < STEPS; i++) {
        char set[64];
        snprintf(set, sizeof set, "run.coupling.step=%s ms", step[i]);
        const outcome two = as_two(1e-3 * atof(step[i]), start),
                      split = in_process(EXAMPLE("reference"), set, &start);
        error[i] = 1e3 * fabs(two.pitch_rate - whole.pitch_rate);
        apart[i] = 1e3 * fabs(two.pitch_rate - split.pitch_rate);
        missing[i] = two.missing / two.work;
        printf("    %s ms: pitch rate %.4g, yaw rate %.4g mrad/s, pitch rate of run.coupling %.4g, "
               "of the work %.3g is missed\n",
               step[i], 1e3 * (two.pitch_rate - whole.pitch_rate),
               1e3 * (two.yaw_rate - whole.yaw_rate), 1e3 * (split.pitch_rate - whole.pitch_rate),
               missing[i]);
    }
    for (int i = 1; i < STEPS; i++) {
        double ratio = log(atof(step[i - 1]) / atof(step[i]));
        CHECK_WITHIN("order of the pitch rate", log(error[i - 1] / error[i]) / ratio, 1.8, 2.2);
        CHECK_WITHIN("order of the work", log(missing[i - 1] / missing[i]) / ratio, 1.8, 2.2);
    }
    CHECK_BELOW("pitch rate at 1 ms [mrad/s]", error[0], 0.15);
    CHECK_BELOW("pitch rate at 0.1 ms [mrad/s]", error[STEPS - 1], 0.002);
    CHECK_BELOW("against run.coupling at 1 ms [mrad/s]", apart[0], 0.01);
    CHECK_BELOW("against run.coupling at 0.1 ms [mrad/s]", apart[STEPS - 1], 2e-4);
}

// The vehicle's FMU as base.kind: fmu, which continues with the wrench on its own.
static void vehicle_as_a_base(void **state)
{
    (void)state;
    static const char *const steps[] = {"base.step=0.25 ms", "base.step=0.125 ms"};
    char *sets[3], line[512], path[128];
    double start, pitch[2], yaw[2];
    write_sets(NULL, sets);
    snprintf(line, sizeof line,
             "launchdyn fmu export examples/reference.yaml --part vehicle --set '%s' --set '%s' "
             "--out vehicle.fmu && cp examples/reference-aero.csv .",
             sets[0], sets[1]);
    assert_int_equal(run(line), 0);
    assert_int_equal(run("{ sed -e '/^base:/,/^tubes:/{/^tubes:/!d}' -e '/^  layout:/d' -e "
                         "'s/tube: 8/tube: 1/' examples/reference.yaml; echo 'base: {kind: fmu, "
                         "file: vehicle.fmu, step: 1 ms, inputs: extrapolated}'; } >carried.yaml"),
                     0);
    const outcome whole = in_process(EXAMPLE("reference"), NULL, &start);
    snprintf(path, sizeof path, "%s/carried.yaml", shell.folder);
    for (int i = 0; i < 2; i++) {
        const outcome carried = in_process(path, steps[i], &start);
        pitch[i] = 1e3 * fabs(carried.pitch_rate - whole.pitch_rate);
        yaw[i] = 1e3 * fabs(carried.yaw_rate - whole.yaw_rate);
    }
    CHECK_BELOW("pitch rate at 0.25 ms [mrad/s]", pitch[0], 8e-3);
    CHECK_BELOW("pitch rate at 0.125 ms [mrad/s]", pitch[1], 2e-3);
    CHECK_BELOW("yaw rate at 0.25 ms [mrad/s]", yaw[0], 6e-3);
    CHECK_WITHIN("order of the pitch rate", log2(pitch[0] / pitch[1]), 1.8, 2.2);
    CHECK_WITHIN("order of the yaw rate", log2(yaw[0] / yaw[1]), 1.8, 2.2);
}

// ---- at rest ----

#define PARKED                                                                                     \
    "examples/reference.yaml --set base.speed='0 m/s' --set run.lead_in='2 s' --set "              \
    "run.tolerance=1e-8"

static void rest_stays(void **state)
{
    (void)state;
    static const char *const at[] = {"tip.inertial_x", "tip.inertial_y", "tip.inertial_z",
                                     "rocket.s"};
    enum { PLACES = sizeof at / sizeof *at };
    double place[PLACES], moved = 0;
    coupling two;
    bool yes = true;
    coupling_open(&two, PARKED);
    uint32_t wait = reference_of(&two.launcher.fmu, "ignition_by_input");
    assert_int_equal(
        FMU_FUNCTION(&two.launcher.fmu, fmi3SetBoolean)(two.launcher.instance, &wait, 1, &yes, 1),
        fmi3OK);
    coupling_begin(&two, -2);
    for (int k = 0; k < PLACES; k++)
        place[k] = side_value(&two.launcher, at[k]);
    for (int i = 0; i < 1000; i++) {
        coupling_advance(&two, 1e-3, i, -2);
        for (int k = 0; k < PLACES; k++)
            moved = fmax(moved, fabs(side_value(&two.launcher, at[k]) - place[k]));
    }
    CHECK_BELOW("way of tip and rocket in 1 s of rest [m]", moved, 2e-11);
    coupling_close(&two);
}

// The vehicle on its own rests under the wrench that no one has reported it; parameters change
// that.
static void begins_under_its_load(void **state)
{
    (void)state;
    side vehicle = side_open(PARKED, true);
    uint32_t mass = reference_of(&vehicle.fmu, "scenario.rocket.mass");
    double heavier = 70, told[WRENCH], light[WRENCH];
    assert_int_equal(FMU_FUNCTION(&vehicle.fmu, fmi3GetFloat64)(vehicle.instance, vehicle.told,
                                                                WRENCH, told, WRENCH),
                     fmi3OK);
    memcpy(light, told, sizeof light);
    assert_int_equal(
        FMU_FUNCTION(&vehicle.fmu, fmi3SetFloat64)(vehicle.instance, &mass, 1, &heavier, 1),
        fmi3OK);
    side_enter(&vehicle, -2);
    side_go(&vehicle);
    double begun = side_value(&vehicle, "chassis.y");
    assert_int_equal(FMU_FUNCTION(&vehicle.fmu, fmi3GetFloat64)(vehicle.instance, vehicle.told,
                                                                WRENCH, told, WRENCH),
                     fmi3OK);
    CHECK_NEAR("weight of 10 kg more [N]", light[1] - told[1], 98.0665, 1e-6);
    CHECK_NEAR("its moment about the tube's rear end [N m]", light[5] - told[5],
               98.0665 * 1.2 * cos(19.8 * acos(-1) / 180), 0.1);
    side_step(&vehicle, -2, 1);
    CHECK_BELOW("way of the chassis in 1 s [m]", side_value(&vehicle, "chassis.y") - begun, 1e-12);
    side_close(&vehicle);
}

// A frame whose quaternion is zero is none: as if no one had reported anything, until one is
// reported.
static void a_frame_of_zeros_is_not_told(void **state)
{
    (void)state;
    coupling two;
    double zero[FRAME] = {0}, frame[FRAME], wrench[2][WRENCH];
    uint32_t y, wait;
    bool yes = true;
    coupling_open(&two, PARKED);
    side *const launcher = &two.launcher;
    wait = reference_of(&launcher->fmu, "ignition_by_input");
    y = reference_of(&launcher->fmu, "input.base.position.y");
    for (int told = 0; told < 2; told++) {
        if (told) {
            FMU_FUNCTION(&launcher->fmu, fmi3FreeInstance)(launcher->instance);
            launcher->instance = instance_of(&launcher->fmu);
        }
        assert_int_equal(
            FMU_FUNCTION(&launcher->fmu, fmi3SetBoolean)(launcher->instance, &wait, 1, &yes, 1),
            fmi3OK);
        if (told)
            side_tell(launcher, zero);
        side_enter(launcher, -2);
        if (told)
            side_tell(launcher, zero);
        side_go(launcher);
        for (int i = 0; i < 20; i++) {
            if (told)
                side_tell(launcher, zero);
            side_step(launcher, -2 + 1e-3 * i, 1e-3);
        }
        side_tells(launcher, wrench[told]);
    }
    assert_memory_equal(wrench[0], wrench[1], sizeof wrench[0]);
    // from the first frame on each is one
    side_enter(&two.vehicle, -2);
    side_go(&two.vehicle);
    side_tells(&two.vehicle, frame);
    frame[1] += 1e-6;
    side_tell(launcher, frame);
    side_step(launcher, -1.98, 1e-3);
    assert_int_equal(
        FMU_FUNCTION(&launcher->fmu, fmi3GetFloat64)(launcher->instance, &y, 1, wrench[0], 1),
        fmi3OK);
    assert_true(wrench[0][0] == frame[1]);
    side_tell(launcher, zero);
    bool event, early;
    double reached;
    assert_int_equal(FMU_FUNCTION(&launcher->fmu, fmi3DoStep)(launcher->instance, -1.979, 1e-3,
                                                              true, &event, &yes, &early, &reached),
                     fmi3Error);
    expect_in(logged, "the base received a position or a motion that is not finite");
    coupling_close(&two);
}

// ---- states, version 2, what is refused ----

static void states_come_back(void **state)
{
    (void)state;
    coupling two;
    double first[FRAME + WRENCH], again[FRAME + WRENCH];
    void *saved[2] = {NULL, NULL};
    coupling_open(&two, "examples/reference.yaml --set run.lead_in='0.3 s'");
    side *sides[] = {&two.vehicle, &two.launcher};
    coupling_begin(&two, -0.3);
    for (int i = 0; i < 310; i++)
        coupling_advance(&two, 1e-3, i, -0.3);
    for (int k = 0; k < 2; k++)
        assert_int_equal(
            FMU_FUNCTION(&sides[k]->fmu, fmi3GetFMUState)(sides[k]->instance, &saved[k]), fmi3OK);
    for (int round = 0; round < 2; round++) {
        double *values = round ? again : first;
        for (int i = 310; i < 330; i++)
            coupling_advance(&two, 1e-3, i, -0.3);
        side_tells(&two.vehicle, values);
        side_tells(&two.launcher, values + FRAME);
        for (int k = 0; k < 2 && round == 0; k++)
            assert_int_equal(
                FMU_FUNCTION(&sides[k]->fmu, fmi3SetFMUState)(sides[k]->instance, saved[k]),
                fmi3OK);
    }
    assert_memory_equal(first, again, sizeof first);
    for (int k = 0; k < 2; k++)
        FMU_FUNCTION(&sides[k]->fmu, fmi3FreeFMUState)(sides[k]->instance, &saved[k]);
    coupling_close(&two);
}

// The vehicle by FMI 2 and 3 under the same wrench.
static void speaks_version_2(void **state)
{
    (void)state;
    side three = side_open(PARKED, true);
    unpacked_fmu fmu = fmu_open(PARKED " --part vehicle", 2);
    const fmi2CallbackFunctions call = {0};
    double wrench[WRENCH] = {500, -2000, 100, 20, -300, 900}, frame[2][FRAME];
    unsigned told[FRAME], tells[FRAME];
    void *two = FMU_FUNCTION(&fmu, fmi2Instantiate)("two", fmi2CoSimulation, fmu.token,
                                                    fmu.resources, &call, 0, 0);
    assert_non_null(two);
    find_references(&fmu, "input.wrench", wrench_names, WRENCH, told);
    find_references(&fmu, "base", frame_names, FRAME, tells);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetupExperiment)(two, 0, 0, -2, 0, 0), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2EnterInitializationMode)(two), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2ExitInitializationMode)(two), fmi2OK);
    side_enter(&three, -2);
    side_go(&three);
    for (int i = 0; i < 10; i++) {
        double t = -2 + 0.01 * i;
        wrench[1] += 10 * i;
        side_tell(&three, wrench);
        assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetReal)(two, told, WRENCH, wrench), fmi2OK);
        side_step(&three, t, 0.01);
        assert_int_equal(FMU_FUNCTION(&fmu, fmi2DoStep)(two, t, 0.01, 1), fmi2OK);
    }
    side_tells(&three, frame[0]);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetReal)(two, tells, FRAME, frame[1]), fmi2OK);
    assert_memory_equal(frame[0], frame[1], sizeof frame[0]);
    FMU_FUNCTION(&fmu, fmi2FreeInstance)(two);
    fmu_close(&fmu);
    side_close(&three);
}

// The archive of both: the structure connects every number, the FMUs are those of the parts.
static void archive_holds_both(void **state)
{
    (void)state;
    assert_int_equal(
        run("launchdyn fmu export examples/reference.yaml --ssp both.ssp && "
            "launchdyn fmu export examples/reference.yaml --part vehicle --fmi 2 --out "
            "v.fmu && mkdir x && cd x && unzip -q ../both.ssp && "
            "cmp resources/vehicle.fmu ../v.fmu && ls . resources && "
            "grep -c '<ssd:Connection start' SystemStructure.ssd && "
            "grep -o 'startConnector=\"base.position.y\".*' SystemStructure.ssd && "
            "for part in vehicle launcher; do unzip -qp resources/$part.fmu modelDescription.xml | "
            "grep -c 'causality=\"\\(input\\|output\\)\"'; done && "
            "grep -c '<ssd:Connector ' SystemStructure.ssd && "
            "grep -o '<ssd:Connector name=\"\\(input.ignition\\|summary.rocket.1.yaw\\)\".*' "
            "SystemStructure.ssd"),
        0);
    assert_string_equal(
        shell.out, ".:\nSystemStructure.ssd\nresources\n\nresources:\nlauncher.fmu\n"
                   "vehicle.fmu\n19\nstartConnector=\"base.position.y\" endElement=\"launcher\" "
                   "endConnector=\"input.base.position.y\"/>\n"
                   "137\n249\n386\n"
                   "<ssd:Connector name=\"input.ignition\" kind=\"input\"><ssc:Boolean/>"
                   "</ssd:Connector>\n"
                   "<ssd:Connector name=\"summary.rocket.1.yaw\" kind=\"output\"><ssc:Real/>"
                   "</ssd:Connector>\n");
    assert_int_equal(run("ls | grep both"), 0);
    assert_string_equal(shell.out, "both.ssp\n");
}

static void refused(const char *line, const char *why)
{
    assert_int_equal(run(line), 2);
    if (!strstr(shell.err, why))
        fail_msg("%s: %s", line, shell.err);
}

static void refuses(void **state)
{
    (void)state;
    refused("launchdyn fmu export examples/fixed.yaml --part vehicle --out x.fmu",
            "base.kind: a vehicle-only run requires kind: vehicle or multibody");
    refused("launchdyn fmu export examples/fixed.yaml --part launcher --out x.fmu",
            "base.kind: a vehicle-only run");
    refused("launchdyn fmu export examples/salvo-marching.yaml --part launcher --out x.fmu",
            "firing: found ");
    refused("launchdyn fmu export examples/reference.yaml --part vehicel --out x.fmu",
            "launchdyn: --part: found \"vehicel\", expected all, vehicle or launcher; did you mean "
            "\"vehicle\"?");
    refused("launchdyn fmu export examples/fixed.yaml --ssp x.ssp",
            "base.kind: a vehicle-only run");
    refused("launchdyn fmu export examples/reference.yaml --ssp x.ssp --part vehicle",
            "--ssp exports both parts; it excludes --out and --part");
    assert_int_equal(run("ls | grep -c x[.]"), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(two_are_the_whole, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(vehicle_as_a_base, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(rest_stays, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(begins_under_its_load, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(a_frame_of_zeros_is_not_told, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(states_come_back, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(speaks_version_2, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(archive_holds_both, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(refuses, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
