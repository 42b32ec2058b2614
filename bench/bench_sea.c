// Speed of a ship's motion in its sea: set-up for 6 s with 200 waves, and one evaluation of place,
// velocity and acceleration; of a measured motion.
#include "bench_sample.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "systems/bases/motion_table.h"
#include "systems/bases/sea_motion.h"

enum { REPEATS = 15, STEPS = 20000 };

static sea_motion build(const ld_model *model)
{
    sea_motion self;
    ld_error error;
    if (sea_motion_build(&self, model, -2, 4, &error)) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    return self;
}

static void bench_setup(const ld_model *model)
{
    double sample[REPEATS];
    for (int i = 0; i < REPEATS; i++) {
        double start = now();
        sea_motion self = build(model);
        sea_motion_free(&self);
        sample[i] = now() - start;
    }
    print("set-up of 6 s", sample, REPEATS, 1e-3, "ms");
}

// The sum, returned, keeps the calls alive.
static double bench_evaluation(const char *what, const sea_motion *self, double from)
{
    double sample[REPEATS], sum = 0;
    for (int i = 0; i < REPEATS; i++) {
        double start = now();
        for (int step = 0; step < STEPS; step++) {
            double x[6] = {0}, u[6] = {0}, a[6] = {0};
            sea_motion_add(self, from + 1e-4 * step, x, u, a);
            sum += x[1] + u[2] + a[3];
        }
        sample[i] = (now() - start) / STEPS;
    }
    print(what, sample, REPEATS, 1e-9, "ns");
    return sum;
}

// Of a table of 2000 rows.
static double bench_table(void)
{
    enum { ROWS = 2000, COLUMNS = 7 };
    static double rows[ROWS * COLUMNS];
    ld_base model = {.kind = LD_BASE_PRESCRIBED, .motion = {ROWS, COLUMNS, rows}};
    motion_table self;
    double sample[REPEATS], sum = 0;
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < COLUMNS; k++)
            rows[i * COLUMNS + k] = k ? sin(0.07 * i + k) : 0.01 * i - 2;
    if (motion_table_build(&self, &model, NULL))
        exit(1);
    for (int i = 0; i < REPEATS; i++) {
        double start = now();
        for (int step = 0; step < STEPS; step++) {
            double x[6] = {0}, u[6] = {0}, a[6] = {0};
            motion_table_add(&self, 1e-4 * step, x, u, a);
            sum += x[1] + u[2] + a[3];
        }
        sample[i] = (now() - start) / STEPS;
    }
    print("place, velocity, acceleration, of a table of 2000 rows", sample, REPEATS, 1e-9, "ns");
    motion_table_free(&self);
    return sum;
}

int main(void)
{
    ld_model model;
    ld_messages messages;
    if (scenario_read(LD_SOURCE_DIR "/examples/ship-sea.yaml", NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        return 1;
    }
    bench_setup(&model);
    sea_motion self = build(&model);
    printf("%zu of %d waves move it\n", self.count, model.base.sea.waves);
    double sum = bench_evaluation("place, velocity, acceleration, tabulated", &self, 0);
    sum += bench_evaluation("the same, wave by wave", &self, 10);
    sum += bench_table();
    sea_motion_free(&self);
    model_clear(&model);
    return sum == 0;
}
