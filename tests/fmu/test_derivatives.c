// Directional derivatives of FMUs against differences that an importer takes, against eigenvalues
// of the linearised launcher, and where a contact is at a corner.
// link: -ldl -lsundials_cvode -lsundials_nvecserial
#include "launchdyn/simulation.h"
#include "math/matrices/general_eigen.h"
#include "support/fmu_importer.h"
#include "support/library_run.h"

enum { MOST = 1200, FMU_INPUTS = 13 };

// Variables that are chosen, by value reference.
typedef struct list {
    size_t count;
    unsigned reference[MOST];
    char name[MOST][64];
} list;

static void choose(const unpacked_fmu *fmu, const char *causality, const char *prefix, list *self)
{
    const char *end = strstr(fmu->description, "</ModelVariables>");
    const char *real = strstr(fmu->description, "<ScalarVariable") ? "<ScalarV" : "<Float64";
    for (const char *at = strstr(fmu->description, "<ModelVariables>");
         (at = strchr(at + 1, '<')) && at < end;) {
        char is[16], name[64], reference[16];
        const char *inside = strchr(at, '>');
        if (strncmp(at, real, 8) != 0 || (*real == '<' && real[1] == 'S' && inside[2] != 'R'))
            continue;
        attribute_after(at, "causality", is, sizeof is);
        attribute_after(at, "name", name, sizeof name);
        if (strcmp(is, causality) != 0 || strncmp(name, prefix, strlen(prefix)) != 0 ||
            strcmp(name, "input.ignition") == 0)
            continue;
        assert_true(self->count < MOST);
        attribute_after(at, "valueReference", reference, sizeof reference);
        strcpy(self->name[self->count], name);
        self->reference[self->count++] = (unsigned)atoi(reference);
    }
}

static void values(const importer *by, const list *of, double *value)
{
    if (by->version == 2)
        OK_2(by, fmi2GetReal, of->reference, of->count, value);
    else
        OK_3(by, fmi3GetFloat64, of->reference, of->count, value, of->count);
}

// One column of the Jacobian; the status.
static int along(const importer *by, const list *unknown, const list *known, const double *seed,
                 double *value)
{
    if (by->version == 2)
        return FMU_FUNCTION(by->fmu, fmi2GetDirectionalDerivative)(by->instance, unknown->reference,
                                                                   unknown->count, known->reference,
                                                                   known->count, seed, value);
    return FMU_FUNCTION(by->fmu, fmi3GetDirectionalDerivative)(
        by->instance, unknown->reference, unknown->count, known->reference, known->count, seed,
        known->count, value, unknown->count);
}

// ---- against differences

// Where an importer's knowns are moved: states of model exchange, or inputs.
typedef struct mover {
    importer *by;
    const list *known;
    bool states;
    double at[IMPORTER_MOST], size[IMPORTER_MOST];
} mover;

static void move(const mover *self, size_t k, double step)
{
    double x[IMPORTER_MOST];
    memcpy(x, self->at, self->known->count * sizeof *x);
    x[k] += step;
    if (self->states)
        importer_place(self->by, self->by->t, x);
    else if (self->by->version == 2)
        OK_2(self->by, fmi2SetReal, self->known->reference, self->known->count, x);
    else
        OK_3(self->by, fmi3SetFloat64, self->known->reference, self->known->count, x,
             self->known->count);
}

// By known k, of order six.
static void differ(const mover *self, const list *unknown, size_t k, double step, double *slope)
{
    static const double weight[] = {45, -9, 1};
    static double ahead[MOST], behind[MOST];
    memset(slope, 0, unknown->count * sizeof *slope);
    for (int m = 0; m < 3; m++) {
        move(self, k, (m + 1) * step);
        values(self->by, unknown, ahead);
        move(self, k, -(m + 1) * step);
        values(self->by, unknown, behind);
        for (size_t i = 0; i < unknown->count; i++)
            slope[i] += weight[m] * (ahead[i] - behind[i]) / (60 * step);
    }
    move(self, k, 0);
}

static double column[IMPORTER_MOST][MOST], stencil[IMPORTER_MOST][MOST];

// All columns; those that are discarded are left at NaN. At a corner both are the slopes' mean.
static void find_columns(const mover *self, const list *unknown, double step, int *warned,
                         int *discarded)
{
    for (size_t k = 0; k < self->known->count; k++) {
        double seed[IMPORTER_MOST] = {0};
        seed[k] = 1;
        int status = along(self->by, unknown, self->known, seed, column[k]);
        *warned += status == fmi3Warning;
        *discarded += status == fmi3Discard;
        assert_true(status <= (int)fmi3Discard);
        for (size_t i = 0; i < unknown->count && status == fmi3Discard; i++)
            column[k][i] = NAN;
        differ(self, unknown, k, step * self->size[k], stencil[k]);
    }
}

// The largest difference, of the largest entry of its unknown, each scaled by its known's size; of
// forces that are rounding alone, of 1 kN.
static double compare_columns(const mover *self, const list *unknown)
{
    double worst = 0;
    for (size_t i = 0; i < unknown->count; i++) {
        double row = strncmp(unknown->name[i], "joint.", 6) == 0 ? 1e3 : 0, off = 0;
        for (size_t k = 0; k < self->known->count; k++)
            if (!isnan(column[k][i]) && self->size[k] < 1e6) { // works feed their sums
                row = fmax(row, fabs(column[k][i]) * self->size[k]);
                off = fmax(off, fabs(column[k][i] - stencil[k][i]) * self->size[k]);
            }
        worst = fmax(worst, off > 0 ? off / row : 0);
    }
    return worst;
}

typedef struct launch {
    const char *scenario;
    double start, at[3];
    int times, version;
    double step; // of the differences, of the states' nominals
    int warned;  // columns at an instant, at most
} launch;

static void they_are_differences(void **state)
{
    (void)state;
    static const launch launches[] = {
        {"examples/fixed.yaml", 0, {0.03, 0.12}, 2, 2, 1e-5, 0},
        {"examples/smooth.yaml", 0, {0.005, 0.02}, 2, 3, 1e-5, 0},
        {"examples/spin-rig.yaml", 0, {0.02}, 1, 3, 1e-5, 0},
        {"examples/rail/truck.yaml", -0.2, {-0.1, 0.05}, 2, 3, 3e-7, 0},
        {"examples/reference.yaml --set run.lead_in=0.1s "
         "--set 'platform.azimuth.stabiliser.command=20 deg'",
         -0.1,
         {-0.05, 0.08},
         2,
         2,
         1e-5,
         1},
        {"examples/multibody/sled.yaml --set run.lead_in=0.1s", -0.1, {0.05}, 1, 3, 1e-5, 0},
    };
    static list unknown, known;
    for (int c = 0; c < OF_ALL((int)(sizeof launches / sizeof *launches), 2); c++) {
        const launch *one = &launches[c];
        unpacked_fmu fmu = fmu_open(one->scenario, one->version);
        importer by;
        mover self = {.by = &by, .known = &known, .states = true};
        double before[MOST], after[MOST], worst = 0;
        int warned = 0, discarded = 0, unequal = 0;
        unknown.count = known.count = 0;
        choose(&fmu, "local", "state.", &known);
        choose(&fmu, "local", "der(", &unknown);
        choose(&fmu, "local", "indicator.", &unknown);
        choose(&fmu, "output", "", &unknown);
        importer_open(&by, &fmu, one->version);
        importer_start(&by, one->start);
        importer_integrate(&by, 1e-6);
        assert_int_equal(by.states, known.count);
        if (by.version == 2)
            OK_2(&by, fmi2GetNominalsOfContinuousStates, self.size, by.states);
        else
            OK_3(&by, fmi3GetNominalsOfContinuousStates, self.size, by.states);
        for (int m = 0; m < OF_ALL(one->times, 1); m++) {
            importer_go(&by, one->at[m]);
            memcpy(self.at, by.x, by.states * sizeof *by.x);
            values(&by, &unknown, before);
            find_columns(&self, &unknown, one->step, &warned, &discarded);
            values(&by, &unknown, after);
            for (size_t i = 0; i < unknown.count; i++)
                unequal += memcmp(&before[i], &after[i], sizeof *after) != 0;
            worst = fmax(worst, compare_columns(&self, &unknown));
        }
        printf("    %.60s: %zu unknowns of %zu states\n", one->scenario, unknown.count,
               known.count);
        CHECK_BELOW("against differences, of an unknown's largest", worst, 1e-6);
        CHECK_BELOW("columns with a warning, at each instant", warned, one->warned * one->times);
        CHECK_BELOW("columns that are discarded", discarded, 0);
        CHECK_BELOW("unknowns that are others afterwards", unequal, 0);
        importer_close(&by);
        fmu_close(&fmu);
    }
}

// ---- against the linearised launcher

// The eigenvalue of a matrix that is the nearest to a pole, relative to it.
static double nearest(const double *re, const double *im, size_t count, const ld_pole *pole)
{
    double best = INFINITY;
    for (size_t i = 0; i < count; i++)
        best = fmin(best, hypot(re[i] - pole->real, fabs(im[i]) - pole->imaginary));
    return best / hypot(pole->real, pole->imaginary);
}

// Rates by states of a launcher at rest, its tubes across the vehicle: each pole of the linearised
// launcher is an eigenvalue. Poles are from differences in other coordinates, by fixed steps.
static void their_eigenvalues_are_the_poles(void **state)
{
    (void)state;
    enum { SETS = 9, POLES = 256 };
    static const char *const set[SETS] = {"base.speed=0 km/h",
                                          "base.road=",
                                          "base.road.flat=true",
                                          "run.lead_in=0.1 s",
                                          "platform.azimuth.stabiliser.command=20 deg",
                                          "platform.azimuth.friction.coulomb=0 N.m",
                                          "platform.elevation.friction.coulomb=0 N.m",
                                          "rocket.contact.friction=0",
                                          "tubes.slot.friction=0"};
    static double J[IMPORTER_MOST * IMPORTER_MOST], re[IMPORTER_MOST], im[IMPORTER_MOST];
    static ld_pole pole[POLES];
    static list unknown, known;
    char line[400];
    int length = snprintf(line, sizeof line, "examples/reference.yaml"), modes, poles;
    for (int i = 0; i < SETS; i++)
        length += snprintf(line + length, sizeof line - (size_t)length, " --set '%s'", set[i]);
    library from = library_begin(LD_SOURCE_DIR "/examples/reference.yaml", set, SETS, NULL);
    ld_mode unused[POLES];
    assert_int_equal(ld_simulation_system_modes(from.simulation, unused, POLES, &modes, pole, POLES,
                                                &poles, NULL),
                     LD_OK);
    unpacked_fmu fmu = fmu_open(line, 3);
    importer by;
    unknown.count = known.count = 0;
    choose(&fmu, "local", "state.", &known);
    choose(&fmu, "local", "der(", &unknown);
    importer_open(&by, &fmu, 3);
    importer_start(&by, -0.1);
    for (size_t k = 0; k < known.count; k++) {
        double seed[IMPORTER_MOST] = {0};
        seed[k] = 1;
        assert_true(along(&by, &unknown, &known, seed, J + k * known.count) <= (int)fmi3Warning);
    }
    assert_int_equal(general_eigenvalues((int)known.count, J, re, im), 0);
    double worst = 0;
    for (int i = 0; i < poles; i++)
        worst = fmax(worst, nearest(re, im, known.count, &pole[i]));
    printf("    %d poles, %zu eigenvalues\n", poles, known.count);
    assert_true(poles > 30);
    CHECK_BELOW("poles against the nearest eigenvalues, relative", worst, 1e-5);
    importer_close(&by);
    fmu_close(&fmu);
    library_end(&from);
}

// ---- at a corner

// Moves the rocket at its start until its middle adaptor is pressed in by so much, and asks for the
// derivatives of that and of the contact's force.
static int press_by(importer *by, double depth, double slope[2])
{
    static list unknown, known, states;
    const double one = 1;
    double x[IMPORTER_MOST], is[2];
    unknown.count = known.count = 0;
    choose(by->fmu, "output", "contact.middle.penetration", &unknown);
    choose(by->fmu, "output", "contact.middle.normal", &unknown);
    choose(by->fmu, "local", "state.rocket.y", &known);
    size_t at = 0;
    states.count = 0;
    choose(by->fmu, "local", "state.", &states);
    while (states.reference[at] != known.reference[0])
        at++;
    memcpy(x, by->x, by->states * sizeof *x);
    for (int i = 0; i < 8; i++) {
        const list penetration = {.count = 1, .reference = {unknown.reference[0]}};
        importer_place(by, by->t, x);
        values(by, &penetration, is);
        assert_true(along(by, &penetration, &known, &one, slope) <= (int)fmi3Warning);
        x[at] += (depth - is[0]) / slope[0];
    }
    importer_place(by, by->t, x);
    values(by, &unknown, is);
    assert_true(fabs(is[0] - depth) < 1e-15);
    return along(by, &unknown, &known, &one, slope);
}

static void a_corner_is_discarded(void **state)
{
    (void)state;
    const double stiffness = 5e7; // [N/m], of examples/fixed.yaml, whose law is linear
    double slope[2];
    unpacked_fmu fmu = fmu_open("examples/fixed.yaml", 3);
    importer by;
    importer_open(&by, &fmu, 3);
    importer_start(&by, 0);
    assert_int_equal(press_by(&by, 1e-6, slope), fmi3OK);
    CHECK_BELOW("pressed in by 1 um: stiffness, relative", slope[1] / (stiffness * slope[0]) - 1,
                1e-7);
    assert_int_equal(press_by(&by, -1e-6, slope), fmi3OK);
    CHECK_BELOW("1 um apart: stiffness [N/m]", slope[1], 0);
    assert_int_equal(press_by(&by, 0, slope), fmi3Discard);
    importer_close(&by);
    fmu_close(&fmu);
}

// ---- inputs

static void *begin_steps(const unpacked_fmu *fmu, int version)
{
    static const fmi2CallbackFunctions call = {.logger = importer_quiet_2};
    char uri[256];
    snprintf(uri, sizeof uri, "file://%s", fmu->resources);
    if (version == 3)
        return FMU_FUNCTION(fmu, fmi3InstantiateCoSimulation)("steps", fmu->token, fmu->resources,
                                                              false, false, false, false, NULL, 0,
                                                              NULL, importer_log_3, NULL);
    return FMU_FUNCTION(fmu, fmi2Instantiate)("steps", fmi2CoSimulation, fmu->token, uri, &call, 0,
                                              0);
}

static void start_steps(const importer *by, double start)
{
    if (by->version == 2) {
        OK_2(by, fmi2SetupExperiment, 0, 0, start, 0, 0);
        assert_int_equal(FMU_FUNCTION(by->fmu, fmi2EnterInitializationMode)(by->instance), 0);
        assert_int_equal(FMU_FUNCTION(by->fmu, fmi2ExitInitializationMode)(by->instance), 0);
    } else {
        OK_3(by, fmi3EnterInitializationMode, false, 0, start, false, 0);
        assert_int_equal(FMU_FUNCTION(by->fmu, fmi3ExitInitializationMode)(by->instance), 0);
    }
}

static void step_on(importer *by, double size)
{
    bool event, terminate, early;
    if (by->version == 2)
        OK_2(by, fmi2DoStep, by->t, size, 1);
    else
        OK_3(by, fmi3DoStep, by->t, size, true, &event, &terminate, &early, &by->next);
    by->t += size;
}

// A frame that is carried on, turned a little, and faster.
static void carry_on(const mover *self, int step, double *frame)
{
    memcpy(frame, self->at, FMU_INPUTS * sizeof *frame);
    frame[1] += 1e-5 * step;
    frame[5] += 1e-5 * step;
    frame[8] += 1e-3 * step;
}

// Two instances of a launcher on an externally driven base, of which one is asked.
static void outputs_follow_a_frame(void **state)
{
    (void)state;
    static list unknown, known;
    const double start = -0.1;
    for (int version = 2; version <= 3; version++) {
        unpacked_fmu fmu = fmu_open("examples/reference.yaml --part launcher --set "
                                    "run.lead_in=0.1s --set 'base.speed=0 km/h' --set "
                                    "'platform.azimuth.stabiliser.command=20 deg'",
                                    version);
        importer by = {.fmu = &fmu, .version = version, .t = start}, other = by;
        mover self = {.by = &by, .known = &known}, twin = {.by = &other, .known = &known};
        double before[MOST], after[MOST], worst = 0;
        int warned = 0, discarded = 0, unequal = 0;
        unknown.count = known.count = 0;
        choose(&fmu, "input", "input.base", &known);
        choose(&fmu, "output", "", &unknown);
        assert_int_equal(known.count, FMU_INPUTS);
        for (size_t k = 0; k < known.count; k++)
            self.size[k] = k < 7 ? 0.01 : 1;
        assert_non_null(by.instance = begin_steps(&fmu, version));
        assert_non_null(other.instance = begin_steps(&fmu, version));
        start_steps(&by, start);
        start_steps(&other, start);
        values(&by, &known, self.at);
        memcpy(twin.at, self.at, sizeof self.at);
        for (int step = 0; step < 8; step++) {
            double frame[IMPORTER_MOST];
            carry_on(&self, step, frame);
            mover at_present = self;
            memcpy(at_present.at, frame, FMU_INPUTS * sizeof *frame);
            move(&at_present, 0, 0);
            if (step == 3 || step == 7) {
                find_columns(&at_present, &unknown, 1e-5, &warned, &discarded);
                worst = fmax(worst, compare_columns(&at_present, &unknown));
            }
            memcpy(twin.at, frame, FMU_INPUTS * sizeof *frame);
            move(&twin, 0, 0);
            step_on(&by, 0.02);
            step_on(&other, 0.02);
        }
        values(&by, &unknown, before);
        values(&other, &unknown, after);
        for (size_t i = 0; i < unknown.count; i++)
            unequal += memcmp(&before[i], &after[i], sizeof *after) != 0;
        CHECK_BELOW("outputs of a frame, against differences", worst, 1e-6);
        CHECK_BELOW("columns with a warning", warned, 0);
        CHECK_BELOW("columns that are discarded", discarded, 0);
        CHECK_BELOW("outputs that differ from those of one that was not asked", unequal, 0);
        by.cvode = other.cvode = NULL;
        importer_close(&by);
        importer_close(&other);
        fmu_close(&fmu);
    }
}

// ---- what is refused, and the transposed

static void wrong_calls_are_refused(void **state)
{
    (void)state;
    static list rates, states, output, parameter, time;
    static double seed[MOST], value[MOST], back[MOST], weight[MOST];
    unpacked_fmu fmu = fmu_open("examples/fixed.yaml", 3);
    importer by;
    rates.count = states.count = output.count = parameter.count = time.count = 0;
    choose(&fmu, "local", "der(", &rates);
    choose(&fmu, "local", "state.", &states);
    choose(&fmu, "output", "tip.y", &output);
    choose(&fmu, "parameter", "scenario.rocket.mass", &parameter);
    choose(&fmu, "independent", "time", &time);
    importer_open(&by, &fmu, 3);
    for (size_t k = 0; k < states.count; k++)
        seed[k] = k % 3 - 0.7;
    assert_int_equal(along(&by, &rates, &states, seed, value), fmi3Error); // the run has not begun
    importer_start(&by, 0);
    assert_int_equal(along(&by, &output, &parameter, seed, value), fmi3Error);
    assert_int_equal(along(&by, &parameter, &states, seed, value), fmi3Error);
    assert_int_equal(along(&by, &rates, &output, seed, value), fmi3Error);
    assert_int_equal(along(&by, &rates, &states, NULL, value), fmi3Error);
    seed[2] = NAN;
    assert_int_equal(along(&by, &rates, &states, seed, value), fmi3Error);
    seed[2] = 1;
    assert_int_equal(FMU_FUNCTION(&fmu, fmi3GetDirectionalDerivative)(
                         by.instance, rates.reference, rates.count, states.reference, states.count,
                         seed, states.count - 1, value, rates.count),
                     fmi3Error);

    // w^T (J v) = (J^T w)^T v, of a point off the start, and by time from differences
    double x[IMPORTER_MOST], forward = 0, backward = 0, worst = 0, ahead[MOST], behind[MOST];
    const double one = 1, h = 1e-5;
    memcpy(x, by.x, by.states * sizeof *x);
    importer_place(&by, 0.004, x);
    for (size_t i = 0; i < rates.count; i++)
        weight[i] = 1.0 / (double)(2 + i);
    assert_true(along(&by, &rates, &states, seed, value) <= (int)fmi3Warning);
    assert_true(FMU_FUNCTION(&fmu, fmi3GetAdjointDerivative)(
                    by.instance, rates.reference, rates.count, states.reference, states.count,
                    weight, rates.count, back, states.count) <= fmi3Warning);
    for (size_t i = 0; i < rates.count; i++)
        forward += weight[i] * value[i];
    for (size_t k = 0; k < states.count; k++)
        backward += back[k] * seed[k];
    CHECK_BELOW("adjoint against directional, relative", backward / forward - 1, 2e-9);
    assert_int_equal(along(&by, &rates, &time, &one, value), fmi3OK);
    importer_place(&by, 0.004 + h, x);
    importer_rates(&by, ahead);
    importer_place(&by, 0.004 - h, x);
    importer_rates(&by, behind);
    for (size_t i = 0; i < rates.count; i++)
        worst = fmax(worst, fabs((ahead[i] - behind[i]) / (2 * h) - value[i]));
    double most = 0;
    for (size_t i = 0; i < rates.count; i++)
        most = fmax(most, fabs(value[i]));
    CHECK_WITHIN("the largest rate by time, of work [W/s]", most, 1, 1e9);
    CHECK_BELOW("rates by time, against differences [W/s]", worst, 2e-5);
    importer_close(&by);
    fmu_close(&fmu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(they_are_differences, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(their_eigenvalues_are_the_poles, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(a_corner_is_discarded, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(outputs_follow_a_frame, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(wrong_calls_are_refused, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
