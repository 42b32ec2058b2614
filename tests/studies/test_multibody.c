// Studies over the numbers of a base of kind multibody, with measures of its columns: each sample
// is the run of the scenario with its numbers. Such a scenario is printed as one that reads alike.
#include "launchdyn/output.h"
#include "launchdyn/study_data.h"
#include "launchdyn/summary.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "support/recorded_run.h"
#include "support/study_run.h"

#define BASE                                                                                       \
    "include: ../tests/data/multibody/launcher.yaml\n"                                             \
    "firing: [{tube: 1, at: 0 s}]\n"                                                               \
    "measures:\n"                                                                                  \
    "  - {name: foot, of: foot.fl.fy, take: peak, from: t_ignition, to: t_rear}\n"                 \
    "  - {name: eye, of: joint.eye.fx, take: rms, from: start, to: end}\n"                         \
    "  - {name: turn, of: drive.yaw.error, take: value, at: t_rear}\n"

#define SCATTER                                                                                    \
    "scatter:\n"                                                                                   \
    "  seed: 5\n"                                                                                  \
    "  samples: 3\n"                                                                               \
    "  factors:\n"                                                                                 \
    "    base.bodies.cradle.mass: {normal: 2 kg}\n"                                                \
    "    base.bodies.frame.inertia.y: {normal: 3 kg.m2}\n"                                         \
    "    base.struts.prop.stiffness: {uniform: 5e4 2e5 N/m}\n"                                     \
    "    base.feet.fr.at.x: {normal: 2 cm}\n"                                                      \
    "    base.joints.pivot.angle: {uniform: 29.9 30.1 deg}\n"                                      \
    "    base.drives.yaw.angle.kp: {normal: 5e4 N.m/rad}\n"                                        \
    "    base.bushings.cushion.clearance.y: {normal: 0.02 mm}\n"

static const char *const factors[] = {
    "base.bodies.cradle.mass",          "base.bodies.frame.inertia.y",
    "base.struts.prop.stiffness",       "base.feet.fr.at.x",
    "base.joints.pivot.angle",          "base.drives.yaw.angle.kp",
    "base.bushings.cushion.clearance.y"};
enum { FACTORS = sizeof factors / sizeof *factors, SAMPLES = 3 };

static ld_model read_text(const char *text)
{
    ld_model model;
    ld_messages messages = {0};
    if (scenario_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples", NULL, 0, &model,
                           &messages)) {
        ld_messages_print(&messages, stdout);
        fail_msg("the scenario cannot be read");
    }
    return model;
}

// Puts a sample's numbers, in the order of `factors`, into the model.
static void set_factors(ld_mechanism *given, const double *number)
{
    given->body[5].mass = number[0];
    given->body[0].inertia[1] = number[1];
    given->strut[0].stiffness = number[2];
    given->foot[1].at[0] = number[3];
    given->joint[2].angle = number[4];
    given->drive[1].angle.kp = number[5];
    given->bushing[0].clearance[1] = number[6];
}

static double number_of(const ld_summary *summary, const char *name)
{
    double value;
    ld_error error;
    char path[64];
    snprintf(path, sizeof path, "rocket.1.%s", name);
    if (ld_summary_number(summary, path, &value, &error))
        fail_msg("%s", error.text);
    return value;
}

static void each_sample_is_a_run(void **state)
{
    (void)state;
    static const char *const results[] = {"exit_speed", "pitch_rate", "measure.foot", "measure.eye",
                                          "measure.turn"};
    enum { RESULTS = sizeof results / sizeof *results };
    ld_study *study = study_of(BASE SCATTER);
    ld_study_counts counts = study_run(study, "study", 1);
    assert_true(counts.done == SAMPLES && counts.failed == 0);
    ld_study_data *data;
    ld_error error;
    const ld_study_values *values = NULL;
    const char *names[FACTORS + RESULTS];
    memcpy(names, factors, sizeof factors);
    memcpy(names + FACTORS, results, sizeof results);
    if (ld_study_data_open(in("study"), &data, &error) ||
        ld_study_data_values(data, 1, names, FACTORS + RESULTS, &values, &error))
        fail_msg("%s", error.text);
    assert_int_equal(values->count, SAMPLES);
    double worst = 0, spread = INFINITY;
    for (int i = 0; i < SAMPLES; i++) {
        double number[FACTORS];
        for (int k = 0; k < FACTORS; k++)
            number[k] = values->value[k][i];
        ld_model model = read_text(BASE);
        set_factors(&model.base.mechanism, number);
        recorded_run run;
        recorded_run_make(&run, &model);
        for (int k = 0; k < RESULTS; k++) {
            double kept = values->value[FACTORS + k][i],
                   alone = number_of(&run.summary, results[k]);
            double other = values->value[FACTORS + k][(i + 1) % SAMPLES];
            worst = fmax(worst, fabs(kept / alone - 1));
            spread = fmin(spread, fabs(kept / other - 1));
        }
        recorded_run_free(&run);
        model_clear(&model);
    }
    CHECK_BELOW("results of samples and of runs (relative)", worst, 1e-12);
    CHECK_WITHIN("samples differ by (relative)", spread, 1e-8, 1e3);
    ld_study_data_close(data);
    ld_study_free(study);
}

static char *print_model(const ld_model *model)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ld_model_print(model, stream);
    fclose(stream);
    return text;
}

static void reads_alike_when_printed(void **state)
{
    (void)state;
    ld_model model = read_text(BASE SCATTER);
    char *text = print_model(&model);
    ld_model again = read_text(text);
    char *other = print_model(&again);
    assert_string_equal(text, other);
    printf("    %zu bytes\n", strlen(text));
    free(text);
    free(other);
    model_clear(&model);
    model_clear(&again);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_sample_is_a_run),
                                       cmocka_unit_test(reads_alike_when_printed)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
