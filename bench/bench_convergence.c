// The tables of docs/convergence.md: what a launch still changes when modes, elements or tolerance
// are refined, one at a time from the defaults, and all at once. With the argument N instead: error
// for cost of modes with and without a cut, over N random launchers of each kind.
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "bench_sample.h"
#include "model/model.h"
#include "quantities/summary.h"
#include "scenario/scenario.h"

enum { MOST = 12 };

typedef struct series {
    const char *what, *key;
    int count;
    double value[MOST]; // the last is the measure of the others
} series;

static ld_rocket_summary launch(const ld_model *model, long long *steps)
{
    ld_simulation *simulation;
    ld_summary summary;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, &summary, &error)) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    ld_simulation_free(simulation);
    *steps = summary.statistics.steps;
    return summary.rocket[0];
}

static void print_head(const char *what)
{
    printf("\n| %s | t_release [us] | t_front [us] | t_middle [us] | t_rear [us] | speed [mm/s] | "
           "pitch rate [mrad/s] | yaw rate [mrad/s] | spin [mrad/s] | steps |\n"
           "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
           what);
}

static void print_row(const char *name, const ld_rocket_summary *a, const ld_rocket_summary *b,
                      long long steps)
{
    const double difference[8] = {
        1e6 * (a->t_release - b->t_release),   1e6 * (a->t_front - b->t_front),
        1e6 * (a->t_middle - b->t_middle),     1e6 * (a->t_rear - b->t_rear),
        1e3 * (a->exit_speed - b->exit_speed), 1e3 * (a->pitch_rate - b->pitch_rate),
        1e3 * (a->yaw_rate - b->yaw_rate),     1e3 * (a->spin_rate - b->spin_rate)};
    printf("| %s ", name);
    for (int i = 0; i < 8; i++)
        printf("| %.1g ", fabs(difference[i]));
    printf("| %lld |\n", steps);
    fflush(stdout);
}

static void set(ld_model *model, int which, double value)
{
    ld_modes *modes = &model->tubes.modes;
    if (which == 0)
        modes->bending = (int)value;
    else if (which == 1)
        modes->torsion = (int)value;
    else if (which == 2)
        modes->elements = (int)value;
    else
        model->run.tolerance = value;
}

static const series all[] = {
    {"bending modes", "%g", 9, {3, 4, 5, 6, 8, 10, 12, 16, 24}},
    {"torsion modes", "%g", 7, {0, 1, 2, 3, 4, 6, 8}},
    {"elements", "%g", 7, {10, 20, 30, 40, 60, 90, 120}},
    {"tolerance", "%.0e", 7, {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}},
};

static void print_series(const ld_model *model, int which)
{
    const series *s = &all[which];
    ld_rocket_summary result[MOST];
    long long steps[MOST];
    for (int i = 0; i < s->count; i++) {
        ld_model varied = *model;
        set(&varied, 3, 1e-8); // so that the steps do not show in the other series
        set(&varied, which, s->value[i]);
        result[i] = launch(&varied, &steps[i]);
    }
    print_head(s->what);
    for (int i = 0; i + 1 < s->count; i++) {
        char name[32];
        snprintf(name, sizeof name, s->key, s->value[i]);
        print_row(name, &result[i], &result[s->count - 1], steps[i]);
    }
}

// Coarser choices at the default tolerance against everything fine.
static void print_all_at_once(const ld_model *model)
{
    static const int modes[][2] = {{5, 4}, {6, 2}, {7, 4}, {8, 4}, {12, 8}};
    long long steps;
    ld_model fine = *model;
    set(&fine, 0, 24);
    set(&fine, 1, 8);
    set(&fine, 2, 120);
    set(&fine, 3, 1e-8);
    ld_rocket_summary truth = launch(&fine, &steps);
    print_head("bending, torsion modes");
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++) {
        char name[48];
        ld_model varied = *model;
        set(&varied, 0, modes[i][0]);
        set(&varied, 1, modes[i][1]);
        ld_rocket_summary result = launch(&varied, &steps);
        snprintf(name, sizeof name, "%d, %d", modes[i][0], modes[i][1]);
        print_row(name, &result, &truth, steps);
    }
}

// ---- modes with and without a cut

enum { MOST_LAUNCHERS = 200, RESAMPLES = 1000, TIMES = 3 };

typedef struct mode_choice {
    int bending, torsion;
    double cut; // [Hz]
} mode_choice;

static const mode_choice choices[] = {{6, 2, 0},     {7, 4, 0},     {8, 6, 2000},  {10, 8, 2500},
                                      {12, 8, 2500}, {24, 8, 2500}, {24, 8, 5000}, {6, 2, 2500},
                                      {12, 4, 2500}, {10, 8, 1500}, {12, 4, 1500}, {24, 8, 1500}};
enum { CHOICES = sizeof choices / sizeof *choices, DEFAULT_CHOICE = 1 };

// Of a launcher with a choice of modes: what its exit rates are off [rad/s], CPU time of a launch.
typedef struct launch_cost {
    double off[2], cpu, evaluations;
} launch_cost;

static void choose(ld_model *model, mode_choice with, double tolerance)
{
    model->tubes.modes.bending = with.bending;
    model->tubes.modes.torsion = with.torsion;
    model->tubes.modes.cut = with.cut;
    model->run.tolerance = tolerance;
    model->run.exit_error = LD_EXIT_ERROR_NO;
}

// Number k of launcher i, between a and b.
static double between(int i, int k, double a, double b)
{
    uint64_t stream = random_stream("bench_convergence");
    return a + (b - a) * random_uniform(1, stream, (uint64_t)i, (uint64_t)k, 0);
}

// Another rocket in another tube on other supports, each within what is usual.
static void vary(ld_model *model, int i)
{
    ld_rocket *rocket = &model->rocket;
    ld_tubes *tubes = &model->tubes;
    double stiffness = between(i, 0, 0.7, 1.4), supports = between(i, 1, 0.5, 2);
    tubes->material.youngs_modulus *= stiffness;
    for (int k = 0; k < tubes->section_count; k++) {
        tubes->section[k].bending_stiffness_y *= stiffness;
        tubes->section[k].bending_stiffness_z *= stiffness;
    }
    for (int k = 0; k < tubes->support_count; k++)
        for (int axis = 0; axis < 3; axis++)
            tubes->support[k].stiffness[axis] *= supports;
    tubes->modes.damping = between(i, 2, 0.005, 0.02);
    for (int axis = 0; axis < 2; axis++) {
        rocket->eccentricity[axis] = between(i, 3 + axis, -5e-4, 5e-4);
        rocket->motor.misalignment[axis] = between(i, 5 + axis, -1e-3, 1e-3);
    }
    rocket->motor.thrust_scale = between(i, 7, 0.85, 1.15);
    rocket->contact.friction = between(i, 8, 0.05, 0.2);
    rocket->mass_error = between(i, 9, -0.05, 0.05) * rocket->full.mass;
}

static ld_rocket_summary run_of(const ld_model *model, int times, launch_cost *cost)
{
    ld_simulation *simulation;
    ld_summary summary = {0};
    ld_error error;
    cost->cpu = INFINITY;
    if (ld_simulation_create(model, &simulation, &error)) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    for (int i = 0; i < times; i++) {
        double start = now();
        if (ld_simulation_run(simulation, NULL, &summary, &error)) {
            fprintf(stderr, "%s\n", error.text);
            exit(1);
        }
        cost->cpu = fmin(cost->cpu, now() - start);
    }
    ld_simulation_free(simulation);
    cost->evaluations = (double)summary.statistics.rhs_evaluations;
    return summary.rocket[0];
}

static double mean_square(const launch_cost *cost, int i)
{
    return 0.5 * (cost[i].off[0] * cost[i].off[0] + cost[i].off[1] * cost[i].off[1]);
}

// Root mean square [mrad/s] of pitch and yaw rate over the launchers, with the range that 95 % of
// draws of as many of them with replacement have.
static void print_rates(const launch_cost *cost, int count)
{
    double drawn[RESAMPLES], sum = 0, most = 0;
    for (int i = 0; i < count; i++) {
        sum += mean_square(cost, i);
        most = fmax(most, fmax(fabs(cost[i].off[0]), fabs(cost[i].off[1])));
    }
    for (int r = 0; r < RESAMPLES; r++) {
        double again = 0;
        for (int i = 0; i < count; i++)
            again += mean_square(cost, (int)between(r, 100 + i, 0, count));
        drawn[r] = 1e3 * sqrt(again / count);
    }
    qsort(drawn, RESAMPLES, sizeof *drawn, ascending);
    printf("| %.2g (%.2g to %.2g) | %.2g ", 1e3 * sqrt(sum / count), drawn[RESAMPLES / 40],
           drawn[RESAMPLES - RESAMPLES / 40], 1e3 * most);
}

static void print_costs(const launch_cost *cost, const launch_cost *usual, int count)
{
    double evaluations = 0, cpu = 0, of_usual = 0;
    for (int i = 0; i < count; i++) {
        evaluations += cost[i].evaluations / count;
        cpu += cost[i].cpu / count;
        of_usual += usual[i].cpu / count;
    }
    printf("| %.0f | %.1f | %.2f |\n", evaluations, 1e3 * cpu, cpu / of_usual);
}

static void print_choices(const char *name, const ld_model *model, int count)
{
    static launch_cost cost[CHOICES][MOST_LAUNCHERS];
    for (int i = 0; i < count; i++) {
        ld_model varied = *model;
        launch_cost unused;
        vary(&varied, i);
        choose(&varied, (mode_choice){24, 8, 0}, 1e-8);
        ld_rocket_summary truth = run_of(&varied, 1, &unused);
        for (int c = 0; c < CHOICES; c++) {
            choose(&varied, choices[c], 1e-5);
            ld_rocket_summary found = run_of(&varied, TIMES, &cost[c][i]);
            cost[c][i].off[0] = found.pitch_rate - truth.pitch_rate;
            cost[c][i].off[1] = found.yaw_rate - truth.yaw_rate;
        }
    }
    printf("\n## %s, %d launchers\n\n| bending, torsion, cut [kHz] | exit rates, rms (95 %%) "
           "[mrad/s] | largest | evaluations | CPU [ms] | of that of 7, 4 |\n"
           "| --- | --- | --- | --- | --- | --- |\n",
           name, count);
    for (int c = 0; c < CHOICES; c++) {
        printf("| %d, %d, %g ", choices[c].bending, choices[c].torsion, choices[c].cut / 1e3);
        print_rates(cost[c], count);
        print_costs(cost[c], cost[DEFAULT_CHOICE], count);
    }
    fflush(stdout);
}

static void read_or_exit(const char *file, const char *const *set, int sets, ld_model *model)
{
    ld_messages messages = {0};
    if (!scenario_read(file, set, sets, model, &messages))
        return;
    ld_messages_print(&messages, stderr);
    exit(1);
}

static void print_random_launchers(int count)
{
    static const char *const kinds[][2] = {{"Slot", LD_SOURCE_DIR "/examples/fixed.yaml"},
                                           {"Smooth bore", LD_SOURCE_DIR "/examples/smooth.yaml"},
                                           {"T-slot", LD_SOURCE_DIR "/examples/rail/pad.yaml"},
                                           {"Tower", LD_SOURCE_DIR "/examples/rail/tower.yaml"}};
    for (int i = 0; i < 4; i++) {
        ld_model model;
        read_or_exit(kinds[i][1], NULL, 0, &model);
        print_choices(kinds[i][0], &model, count);
        model_clear(&model);
    }
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name, *file, *set;
        int first; // series, of those above
    } launches[] = {
        {"Fixed base", LD_SOURCE_DIR "/examples/fixed.yaml", NULL, 0},
        {"Mass centre 0.5 mm off the axis", LD_SOURCE_DIR "/examples/fixed.yaml",
         "rocket.eccentricity=0.5 0 mm", 0},
        {"Moving base", LD_SOURCE_DIR "/examples/prescribed.yaml", NULL, 0},
        {"Marching at 30 km/h", LD_SOURCE_DIR "/examples/marching/30-kmh.yaml", "run.end=tip", 3},
    };
    int count = argc > 1 ? atoi(argv[1]) : 0;
    if (count > 0) {
        print_random_launchers(count < MOST_LAUNCHERS ? count : MOST_LAUNCHERS);
        return 0;
    }
    for (int i = 0; i < 4; i++) {
        ld_model model;
        read_or_exit(launches[i].file, &launches[i].set, launches[i].set != NULL, &model);
        printf("\n## %s\n", launches[i].name);
        for (int which = launches[i].first; which < 4; which++)
            print_series(&model, which);
        print_all_at_once(&model);
        model_clear(&model);
    }
    return 0;
}
