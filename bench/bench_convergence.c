// The tables of docs/convergence.md: what a launch still changes when modes, elements or tolerance
// are refined, one at a time from the defaults, and all at once.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

int main(void)
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
    for (int i = 0; i < 4; i++) {
        ld_model model;
        ld_messages messages = {0};
        if (scenario_read(launches[i].file, &launches[i].set, launches[i].set != NULL, &model,
                          &messages)) {
            ld_messages_print(&messages, stderr);
            return 1;
        }
        printf("\n## %s\n", launches[i].name);
        for (int which = launches[i].first; which < 4; which++)
            print_series(&model, which);
        print_all_at_once(&model);
        model_clear(&model);
    }
    return 0;
}
