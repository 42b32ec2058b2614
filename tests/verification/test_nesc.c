// NESC atmospheric check-cases 1, 2, 3, 5, 6, 9 (AIAA 2015-1810) as scenario files, against the
// sharpest published simulation (04) and against another program's integration of the same
// definitions ("re", printed to 11 digits), every half second.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "quantities/summary.h"
#include "scenario/scenario.h"

static const double degree = 0.017453292519943295;

enum { ROWS = 61, VALUES = 12 };

// Altitude [m], latitude, longitude [deg], velocity north, east, down [m/s], heading, pitch, roll
// [deg], rates p, q, r of the body with y right, z down [deg/s]; at t = 0, 0.5, .. 30 s.
typedef struct course {
    int rows;
    double value[ROWS][VALUES];
} course;

// ---- what the simulation gives

typedef struct receiver {
    course *course;
    size_t at[VALUES]; // columns
    double unit[VALUES];
} receiver;

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)error;
    static const char *const names[VALUES] = {"altitude",   "latitude",  "longitude", "v_north",
                                              "v_east",     "v_down",    "heading",   "local_pitch",
                                              "local_roll", "rocket.wx", "rocket.wz", "rocket.wy"};
    receiver *to = self;
    for (int k = 0; k < VALUES; k++) {
        size_t i = 0;
        while (i < count && strcmp(columns[i].name, names[k]) != 0)
            i++;
        assert_true(i < count);
        to->at[k] = i;
        to->unit[k] = strncmp(columns[i].unit, "rad", 3) == 0 ? 1 / degree : 1;
    }
    to->unit[11] = -to->unit[11]; // r = -w_y
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)count, (void)error;
    receiver *to = self;
    int i = (int)floor(values[0] / 0.5 + 0.5);
    if (fabs(values[0] - 0.5 * i) > 1e-12)
        return LD_OK; // an apex
    assert_true(i == to->course->rows && i < ROWS);
    for (int k = 0; k < VALUES; k++)
        to->course->value[i][k] = to->unit[k] * values[to->at[k]];
    to->course->rows++;
    return LD_OK;
}

static void simulate(int number, course *out)
{
    char name[128];
    ld_model model;
    ld_messages messages;
    ld_simulation *simulation;
    ld_summary summary;
    ld_error error;
    snprintf(name, sizeof name, LD_SOURCE_DIR "/tests/data/nesc/case%02d.yaml", number);
    if (scenario_read(name, NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    receiver to = {.course = out};
    const ld_sink sink = {.self = &to, .begin = begin, .row = row};
    const ld_run_options options = {.sink = &sink};
    *out = (course){0};
    assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, &options, &summary, &error), LD_OK);
    assert_int_equal(out->rows, ROWS);
    ld_simulation_free(simulation);
    model_clear(&model);
}

// ---- what was published

static void read_published(int number, const char *simulation, course *out)
{
    char name[128], line[512];
    snprintf(name, sizeof name, LD_SOURCE_DIR "/tests/data/nesc/case%02d.csv", number);
    FILE *file = fopen(name, "r");
    assert_non_null(file);
    size_t length = strlen(simulation);
    out->rows = 0;
    while (fgets(line, sizeof line, file)) {
        if (strncmp(line, simulation, length) != 0 || line[length] != ',')
            continue;
        char *at = line + length + 1;
        double t = strtod(at, &at);
        assert_true(out->rows < ROWS && t == 0.5 * out->rows);
        for (int k = 0; k < VALUES; k++)
            out->value[out->rows][k] = strtod(at + 1, &at);
        out->rows++;
    }
    fclose(file);
    assert_int_equal(out->rows, ROWS);
}

// Largest difference of the values from .. to; angles in degrees are wrapped. Roll and heading mean
// nothing where the pitch is 90 deg, which none of the cases comes near.
static double difference(const course *a, const course *b, int from, int to)
{
    double worst = 0;
    for (int i = 0; i < ROWS; i++)
        for (int k = from; k <= to; k++) {
            double d = a->value[i][k] - b->value[i][k];
            if (k >= 6 && k <= 8)
                d = remainder(d, 360);
            worst = fmax(worst, fabs(d));
        }
    return worst;
}

typedef struct bounds {
    double altitude, velocity, attitude, rate; // [m], [m/s], [deg], [deg/s]
} bounds;

static void compare(int number, const char *simulation, bounds bound)
{
    static course ours, theirs;
    simulate(number, &ours);
    read_published(number, simulation, &theirs);
    printf("    case %d against %s\n", number, simulation);
    CHECK_BELOW("altitude [m]", difference(&ours, &theirs, 0, 0), bound.altitude);
    CHECK_BELOW("latitude, longitude [deg]", difference(&ours, &theirs, 1, 2),
                bound.altitude / 1e5 + 1e-12);
    CHECK_BELOW("velocity [m/s]", difference(&ours, &theirs, 3, 5), bound.velocity);
    CHECK_BELOW("attitude [deg]", difference(&ours, &theirs, 6, 8), bound.attitude);
    CHECK_BELOW("rate [deg/s]", difference(&ours, &theirs, 9, 11), bound.rate);
}

static void test_integrated_anew(void **state)
{
    (void)state;
    compare(1, "re", (bounds){2e-7, 1e-8, 1e-8, 1e-9});
    compare(2, "re", (bounds){2e-7, 1e-8, 5e-8, 2e-8});
    compare(3, "re", (bounds){2e-7, 1e-8, 5e-8, 2e-8});
    compare(5, "re", (bounds){2e-7, 1e-8, 5e-8, 2e-8});
    compare(6, "re", (bounds){2e-7, 1e-8, 1e-8, 1e-9});
    compare(9, "re", (bounds){5e-7, 1e-8, 1e-8, 1e-9});
}

static void test_published(void **state)
{
    (void)state;
    compare(1, "04", (bounds){1e-5, 1e-6, 1e-6, 1e-6});
    compare(2, "04", (bounds){1e-5, 1e-6, 1e-6, 1e-6});
    compare(5, "04", (bounds){3e-5, 1e-5, 1e-6, 1e-6});
    compare(6, "04", (bounds){3e-5, 1e-5, 1e-6, 1e-6});
    compare(9, "04", (bounds){2e-3, 1e-4, 1e-6, 1e-6});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_integrated_anew),
        cmocka_unit_test(test_published),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
